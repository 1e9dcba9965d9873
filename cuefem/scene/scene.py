"""Scene (cue, ball, tip, stroke, effects), resolution of its computation, and outcome of its strike."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from copy import copy
from dataclasses import dataclass, field, replace
from functools import cached_property, lru_cache
from itertools import chain
from typing import TYPE_CHECKING, Annotated, Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from cuefem.cue import Array, Cue, LumpedCue
from cuefem.effects.contact_terms import ContactTerms
from cuefem.effects.effect import CueEffect, Effect, acting_on_cue, check_effects, terms_at_contact
from cuefem.effects.force_law import IndentationOutOfRange, LeatherLaw
from cuefem.effects.leather_tip import LeatherTip
from cuefem.quantity.display import brief_repr
from cuefem.quantity.equality import equal_fields
from cuefem.quantity.fields import (
    CONTACT_TIME,
    Quantity,
    check_fields,
    check_kind,
    quote,
)
from cuefem.quantity.frames import frame_of
from cuefem.quantity.unit_checks import warn_light_cue

if TYPE_CHECKING:
    import pandas as pd

DEFAULT_CONTACT_TIME = 2e-3  # s, [Kim] sec. 4


@dataclass(frozen=True)
class Ball:
    """A billiard ball; by default a carom ball.

    Parameters
    ----------
    mass
        M, kg.
    radius
        R, m.
    inertia
        The factor nu of the moment of inertia nu M R^2; 2/5 for a solid ball.

    Raises
    ------
    ValueError
        If a number is out of bounds.

    Examples
    --------
    >>> import cuefem as cf
    >>> pool = cf.Ball(mass=0.170, radius=0.028575)
    """

    mass: Annotated[float, Quantity("kg", "(0, inf)").with_typical_range(0.08, 0.4)] = 0.210
    radius: Annotated[float, Quantity("m", "(0, inf)").with_typical_range(0.02, 0.04)] = 0.03075
    inertia: Annotated[float, Quantity("", "(0, 1]")] = 0.4

    def __post_init__(self) -> None:
        check_fields(self)


@dataclass(frozen=True)
class Tip:
    """Contact parameters of the tip.

    Parameters
    ----------
    restitution
        Energetic coefficient of restitution e ([Stronge]), in [0, 1].
    friction
        Coulomb's mu between tip and ball; inf for a tip that never slips.
    contact_time
        Contact time of a central impact, s. By default 2 ms ([Kim] sec. 4), unless a stiffness is given.
    stiffness
        Loading stiffness of the tip, N/m, instead of a contact time: each determines the other.

    Raises
    ------
    ValueError
        If a number is out of bounds, or if both contact_time and stiffness are given.

    Notes
    -----
    `cuefem.strike` takes a restitution of 0.05 or more; `cuefem.impulse` takes any.

    Examples
    --------
    >>> import cuefem as cf
    >>> tip = cf.Tip(restitution=0.75, friction=0.6, contact_time=1e-3)
    """

    restitution: Annotated[float, Quantity("", "[0, 1]")] = 0.75
    friction: Annotated[float, Quantity("", "[0, inf]")] = 0.7
    contact_time: Annotated[float | None, CONTACT_TIME.with_typical_range(2e-4, 0.01)] = None
    stiffness: Annotated[float | None, Quantity("N/m", "(0, inf)")] = None

    def __post_init__(self) -> None:
        check_fields(self)
        if self.contact_time is not None and self.stiffness is not None:
            raise ValueError(
                "Tip takes contact_time (s) or stiffness (N/m), each determines the other; "
                f"got both, {self.contact_time} s and {self.stiffness} N/m"
            )


@dataclass(frozen=True)
class Stroke:
    """The cue at first touch.

    Parameters
    ----------
    speed
        Speed of the cue along its axis, m/s.
    offset
        Tip offset b/R: distance b of the contact from the ball's centre line over the ball's radius R, in (-1, 1).

    Raises
    ------
    ValueError
        If a number is out of bounds.

    Examples
    --------
    >>> import cuefem as cf
    >>> stroke = cf.Stroke(speed=2.0, offset=0.3)
    >>> round(stroke.angle, 4)  # phi = asin(b/R), rad
    0.3047
    """

    speed: Annotated[float, Quantity("m/s", "(0, inf)").with_typical_range(0.01, 30.0)] = 1.0
    offset: Annotated[float, Quantity("", "(-1, 1)")] = 0.0

    def __post_init__(self) -> None:
        check_fields(self)

    @property
    def angle(self) -> float:
        """The phi of sin(phi) = b/R, rad: the angle between the cue's axis and the normal of the contact."""
        return math.asin(self.offset)


class Assumed(NamedTuple):
    """A scene as it was made, and what was assumed then. A later change of the scene ends some.

    listed: of a scene's file, an `Assumption` each. warnings: of its drawing. game: of the default stroke of a cue
    alone. given: keys of its values that were chosen.
    """

    scene: Scene
    listed: tuple[Any, ...] = ()
    warnings: tuple[str, ...] = ()
    game: str = ""
    given: frozenset[str] = frozenset()


@dataclass(frozen=True)
class Scene:
    """A scene: cue, ball, tip, stroke, and the effects beyond the base model.

    Parameters
    ----------
    cue
        A `Cue` of segments, which vibrates, or a `LumpedCue`.
    ball, tip, stroke
        By default those of Kim's paper: a carom ball, a tip with a contact time of 2 ms, and a central impact at 1 m/s.
        `cuefem.usual_scene` has those of a game.
    effects
        Effects such as `TipDome` or `PointMass`, in any order.
    assumed
        What a file left open, set by `cuefem.load`, or what `cuefem.usual_scene` chose: answers list what the scene
        still has of it.

    Raises
    ------
    TypeError
        If a field is of another kind.
    ValueError
        If an effect cannot act on the cue, or beside another effect.

    Examples
    --------
    >>> import cuefem as cf
    >>> wood = cf.Material(E=12.6e9, G=0.84e9, rho=700.0)
    >>> cue = cf.Cue((cf.Segment(0.7, 0.012, 0.021, wood),), body_mass=0.43)
    >>> scene = cf.Scene(cue, tip=cf.Tip(contact_time=1e-3), stroke=cf.Stroke(offset=0.3), effects=[cf.TipDome(0.01)])
    >>> round(scene.stiffness)  # of the tip, N/m, from the contact time
    1140968
    """

    cue: Cue | LumpedCue
    ball: Ball = field(default_factory=Ball)
    tip: Tip = field(default_factory=Tip)
    stroke: Stroke = field(default_factory=Stroke)
    effects: tuple[Effect, ...] = ()
    assumed: Assumed | None = field(default=None, compare=False, repr=False)

    def __post_init__(self) -> None:
        check_kind("Scene.cue", self.cue, (Cue, LumpedCue))
        check_kind("Scene.ball", self.ball, Ball)
        check_kind("Scene.tip", self.tip, Tip)
        check_kind("Scene.stroke", self.stroke, Stroke)
        object.__setattr__(self, "effects", check_effects(self.cue, self.effects))
        if isinstance(self.cue, Cue) and self.cue.segments and self.cue.body_mass == 0:
            warn_light_cue(self.cue.mass, self.cue.length)
        has_tip_model = self.contact_terms.tip is not None
        for name, unit in (("contact_time", "s"), ("stiffness", "N/m")):
            value = getattr(self.tip, name)
            if has_tip_model and value is not None:
                raise ValueError(
                    f"Tip.{name} must be omitted with an effect that models the whole tip, which determines it; "
                    f"got {value} {unit}"
                )

    def assuming(self, **what: Any) -> Scene:
        """The scene with what was assumed of it as it is now: the fields of `Assumed`."""
        made = copy(self)  # without the checks and warnings of a new scene
        object.__setattr__(made, "assumed", Assumed(self, **what))
        return made

    @property
    def shaft(self) -> Cue:
        """The finite-element cue; ValueError for a lumped cue, which has neither modes nor shape."""
        if isinstance(self.cue, LumpedCue):
            raise ValueError("Scene.cue must be a Cue of segments: its modes or its shape are needed; got a LumpedCue")
        return self.cue

    @property
    def file_warnings(self) -> tuple[str, ...]:
        """Warnings of the files that cue and scene were loaded from."""
        drawing = self.cue.assumed if isinstance(self.cue, Cue) else None
        return tuple(line for each in (drawing, self.assumed) if each for line in each.warnings)

    @property
    def lumped(self) -> LumpedCue | None:
        """The lumped cue; None if the cue is of finite elements."""
        return self.cue if isinstance(self.cue, LumpedCue) else None

    @property
    def cue_effects(self) -> tuple[CueEffect, ...]:
        """The effects that act on the cue, sorted; effects at the tip do not change its modes."""
        return acting_on_cue(self.effects)

    @property
    def at_tip(self) -> tuple[Effect, ...]:
        """The effects at the contact of tip and ball."""
        return tuple(effect for effect in self.effects if effect.at_tip)

    @property
    def without_tip_effects(self) -> Scene:
        """The scene without its effects at the tip; mass and contact time of a leather tip remain."""
        if self.lumped is not None:
            return replace(self, effects=tuple(effect for effect in self.effects if not effect.at_tip))
        effects = tuple(chain.from_iterable(effect.without_tip(self.shaft) for effect in self.effects))
        tip = self.tip if self.contact_terms.tip is None else replace(self.tip, contact_time=self.contact_time)
        return replace(self, tip=tip, effects=effects)

    @property
    def contact_terms(self) -> ContactTerms:
        """Terms that the effects add to the contact."""
        return terms_at_contact(self.effects, self._end_diameter)

    @property
    def tip_diameter(self) -> float:
        """Diameter of the leather tip, or else of the shaft's end, m; ValueError for a lumped cue."""
        diameter = self.contact_terms.tip_diameter
        return self.shaft.segments[0].tip_diameter if diameter is None else diameter

    @property
    def _end_diameter(self) -> float | None:
        return None if self.lumped is not None else self.shaft.segments[0].tip_diameter

    @cached_property
    def axial_mass(self) -> float:
        """Axial mass m_a, kg: the cue's mass and that of its effects."""
        added = (effect.axial_mass if self.lumped else effect.mass_on(self.shaft) for effect in self.effects)
        return self.cue.mass + math.fsum(added)

    @property
    def dome_radius(self) -> float:
        """Radius of the tip's dome, m: the sum over all effects; 0 without a dome."""
        return self.contact_terms.dome_radius

    @property
    def reduced_mass(self) -> float:
        """Reduced mass m_n of a central impact, 1/m_n = 1/M + 1/m_a, kg."""
        return 1 / (1 / self.ball.mass + 1 / self.axial_mass)

    @cached_property
    def contact_time(self) -> float:
        """Contact time T of a central impact, s: the tip's, or from its stiffness (handbook: The strike).

        For a `LeatherTip` it follows from the force-indentation law, at the stroke's speed, on an axially rigid cue.
        With the stiffness it defines the equivalent linear tip for end masses, the choice of modes, and reports.
        """
        if self.contact_terms.tip is not None:
            return (1 + self.tip.restitution) * self._loading_phase[1]
        if self.tip.stiffness is None:
            return DEFAULT_CONTACT_TIME if self.tip.contact_time is None else self.tip.contact_time
        return math.pi / 2 * (1 + self.tip.restitution) * math.sqrt(self.reduced_mass / self.tip.stiffness)

    @property
    def valid_contact_time(self) -> float | None:
        """The `contact_time`, s; None if the impact indents the leather beyond the range of its law."""
        try:
            return self.contact_time
        except IndentationOutOfRange:
            return None

    @property
    def stiffness(self) -> float:
        """Loading stiffness k of the tip, N/m: the tip's, or from its contact time (handbook: The strike)."""
        if self.tip.stiffness is not None:
            return self.tip.stiffness
        return (math.pi / 2 * (1 + self.tip.restitution) / self.contact_time) ** 2 * self.reduced_mass

    @property
    def leather_tip(self) -> LeatherTip:
        """The scene's `LeatherTip`; ValueError without one."""
        leather = next((effect for effect in self.effects if isinstance(effect, LeatherTip)), None)
        if leather is None:
            raise ValueError("Scene.effects must hold a LeatherTip; got none")
        return leather

    @property
    def tip_is_cached(self) -> bool:
        """Whether the tip's elasticity is cached; False if the first strike takes seconds to compute it."""
        tips = [] if self._end_diameter is None else [e for e in self.effects if isinstance(e, LeatherTip)]
        return all(tip.is_cached(tip.diameter_on(self._end_diameter or 0.0)) for tip in tips)

    def tip_law(self, restitution: float = 1.0, offset: float = 0.0) -> LeatherLaw:
        """The force-indentation law of the `LeatherTip` on this cue and ball; ValueError without one."""
        return self.leather_tip.law(self.tip_diameter, self.ball.radius, abs(offset), restitution)

    @property
    def max_indentation(self) -> float:
        """Maximum indentation of the `LeatherTip` in a central impact, m; ValueError without one."""
        return self._loading_phase[0]

    @property
    def _loading_phase(self) -> tuple[float, float]:
        """Maximum indentation of the `LeatherTip` in a central impact, m, and the time to it, s."""
        return _loading_phase(self.tip_law(), self.reduced_mass, self.stroke.speed)


def check_scene(name: str, scene: Any) -> None:
    """TypeError unless ``scene`` is a `Scene`; of a cue, as `cuefem.load` gives it, the message names its scene."""
    if isinstance(scene, Cue):
        raise TypeError(f"{name} must be a Scene; got a Cue: cuefem.usual_scene(cue) makes its scene")
    check_kind(name, scene, Scene)


def as_scenes(name: str, scenes: Any) -> tuple[Scene, ...]:
    """A sequence of scenes, one or more, as a tuple."""
    if isinstance(scenes, Cue):
        check_scene(name, scenes)
    if isinstance(scenes, Scene) or not isinstance(scenes, Iterable):
        got = "one Scene: write [scene]" if isinstance(scenes, Scene) else quote(scenes)
        raise TypeError(f"{name} must be a sequence of Scene; got {got}")
    scenes = tuple(scenes)
    for scene in scenes:
        check_scene(name, scene)
    if not scenes:
        raise ValueError(f"{name} must be one scene or more; got none")
    return scenes


@lru_cache(maxsize=256)
def _loading_phase(law: LeatherLaw, mass: float, speed: float) -> tuple[float, float]:
    """Maximum indentation, m, and the time to it, s; cached for all strokes of a sweep at one speed."""
    return law.central_impact(mass, speed)


@dataclass(frozen=True, eq=False)
class Outcome:
    """Result of a strike. `cuefem.batch_strike` has those of many as `Outcomes`.

    Attributes
    ----------
    squirt : float
        Angle between the ball's path and the cue's, rad; positive when the ball leaves on the far side of the cue's
        line from the side that is struck.
    ball_velocity : (2,) array
        Velocity of the ball (t, n), m/s: t tangential, n normal into the ball at the contact.
    ball_speed : float
        m/s.
    spin : float
        Angular velocity of the ball, p_t/(nu M R), rad/s.
    cue_speed : float
        Speed of the cue along its axis after the stroke, m/s.
    impulse : (2,) array
        Impulse on the ball (t, n), N s.
    duration : float or None
        Of the contact, s; None from the impulse solver.
    regime : str
        State of the contact: "stick" (at once, or after slip while the tip was being compressed), "late stick" (past
        the maximum indentation), "slip reversal", "partial slip" (friction took more than 5 % of the ball's energy
        while the patch as a whole stuck), "gross slip" (through more than a quarter of the normal impulse), "miscue"
        (slip through more than half of it, or through its last third). The impulse solver has "stick", "late stick",
        "slip reversal", and "miscue" where slip never ends.
    jam : bool
        Whether friction increased the normal approach speed of ball and tip at first: usual for a light end mass.
    phases : tuple
        Phases of the contact.
    energy : dict
        J by name: "initial", and the parts that add up to it.
    unknowns : int
        Number of state variables of the model.
    error : float or None
        Estimated relative error; None without an estimate.
    history : History or None
        Forces and velocities during the contact, at any time (`cuefem.contact.outcome.History`); None from the impulse
        solver.
    """

    squirt: float
    ball_velocity: Array
    ball_speed: float
    spin: float
    cue_speed: float
    impulse: Array
    duration: Any  # float, or None: a union would ask every program on strikes for a check
    regime: str
    jam: bool
    phases: tuple[Any, ...] = field(repr=False)
    energy: dict[str, float]
    unknowns: int = 0
    error: float | None = None
    history: Any = None

    __eq__ = equal_fields
    __hash__ = None  # type: ignore[assignment]

    def __repr__(self) -> str:
        names = ("squirt", "ball_speed", "spin", "cue_speed", "duration", "regime", "error")
        return brief_repr("Outcome", ((name, getattr(self, name)) for name in names if getattr(self, name) is not None))


OUTCOME_UNITS = {
    "squirt": "rad",
    "ball_velocity": "m/s",
    "ball_speed": "m/s",
    "spin": "rad/s",
    "cue_speed": "m/s",
    "impulse": "N s",
    "duration": "s",
}
OUTCOME_COLUMNS = (*OUTCOME_UNITS, "regime", "jam")


@dataclass(frozen=True, eq=False)
class Outcomes:
    """Results of many strikes: arrays with one entry a strike. ``len`` counts them, ``outcomes[i]`` is one `Outcome`.

    Attributes
    ----------
    squirt, ball_speed, spin, cue_speed : (strikes,) array
        As in `Outcome`: rad, m/s, rad/s, m/s.
    ball_velocity, impulse : (strikes, 2) array
        (t, n), m/s and N s.
    duration : (strikes,) array or None
        s; None from the impulse solver.
    regime : (strikes,) array of str
        State of the contact.
    jam : (strikes,) array of bool
        Whether friction increased the normal approach speed of ball and tip at first.
    energy : dict of str to (strikes,) array
        J, by the names of all strikes; zero where a strike lacks one.
    unknowns : int
        Number of state variables, the largest of all strikes.
    phases : tuple
        Of the impulse solver its events, with an array of normal impulses each; () of strikes in time.

    Examples
    --------
    >>> import cuefem as cf
    >>> cue = cf.LumpedCue(0.54, 0.01)
    >>> outcomes = cf.batch_strike([cf.Scene(cue, stroke=cf.Stroke(2.0, offset)) for offset in (0.1, 0.3)])
    >>> len(outcomes), outcomes.squirt.shape, outcomes[1].regime
    (2, (2,), 'stick')
    >>> outcomes.to_frame().attrs["units"]["squirt"]
    'rad'
    """

    squirt: Array
    ball_velocity: Array
    ball_speed: Array
    spin: Array
    cue_speed: Array
    impulse: Array
    duration: Array | None
    regime: NDArray[np.str_]
    jam: NDArray[np.bool_]
    energy: dict[str, Array]
    unknowns: int = 0
    phases: tuple[Any, ...] = field(default=(), repr=False)

    __eq__ = equal_fields
    __hash__ = None  # type: ignore[assignment]

    @classmethod
    def of(cls, outcomes: Sequence[Outcome]) -> Outcomes:
        """The results of strikes as arrays."""
        names = dict.fromkeys(name for outcome in outcomes for name in outcome.energy)
        energy = {name: np.array([outcome.energy.get(name, 0.0) for outcome in outcomes]) for name in names}
        columns: Any = {name: np.array([getattr(outcome, name) for outcome in outcomes]) for name in OUTCOME_COLUMNS}
        return cls(**columns, energy=energy, unknowns=max(outcome.unknowns for outcome in outcomes))

    def __len__(self) -> int:
        return len(self.squirt)

    def __getitem__(self, number: int) -> Outcome:
        """One strike, without phases and history."""
        columns: Any = {name: self._entry(name, number) for name in OUTCOME_COLUMNS}
        energy = {name: float(values[number]) for name, values in self.energy.items()}
        return Outcome(**columns, phases=(), energy=energy, unknowns=self.unknowns)

    def _entry(self, name: str, number: int) -> Any:
        values = getattr(self, name)
        entry = None if values is None else values[number]
        return entry.item() if isinstance(entry, np.generic) else entry

    def __repr__(self) -> str:
        names = ("squirt", "ball_speed", "spin", "cue_speed", "duration", "regime")
        given = ((name, getattr(self, name)) for name in names if getattr(self, name) is not None)
        return brief_repr("Outcomes", [("n", len(self)), *given])

    def to_frame(self) -> pd.DataFrame:
        """A row for each strike, SI units; ``attrs["units"]`` has them by column. RuntimeError without pandas."""
        columns, units = {name: getattr(self, name) for name in OUTCOME_COLUMNS}, dict(OUTCOME_UNITS)
        if self.duration is None:
            del columns["duration"]
        for name in ("ball_velocity", "impulse"):
            components = dict(zip((f"{name}_t", f"{name}_n"), columns.pop(name).T, strict=True))
            columns |= components
            units |= dict.fromkeys(components, OUTCOME_UNITS[name])
        return frame_of(columns, units)
