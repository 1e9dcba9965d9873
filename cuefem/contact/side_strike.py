"""The side strike: a ball or a hammer meets a vibrating beam across its axis (handbook: The side strike).

The contact is the centre-ball impact of `cuefem.contact` with the beam's deflection at the struck position instead
of the cue's axial motion.
"""

from __future__ import annotations

import math
from dataclasses import KW_ONLY, dataclass
from typing import Annotated, Any

import numpy as np

from cuefem.beam.assembly import assemble
from cuefem.beam.modes import solve
from cuefem.beam.tip_modes import TipModes, side_modes
from cuefem.contact.contact_model import ContactModel
from cuefem.contact.outcome import Phase
from cuefem.contact.ports import FirstTouch, LevelPorts
from cuefem.contact.step_records import SolvedContact, solve_contact
from cuefem.contact.tips import STEPS, check_restitution
from cuefem.cue import POSITION_TOLERANCE, Cue
from cuefem.effects.effect import (
    CueEffect,
    Effect,
    acting_on_cue,
    check_effects,
    terms_at_contact,
)
from cuefem.effects.force_law import TipLaw, loading_time
from cuefem.quantity.equality import equal_fields
from cuefem.quantity.fields import CONTACT_TIME, Quantity, check_fields, check_kind
from cuefem.scene import Resolution
from cuefem.scene.solved_scene import mode_count_for

# Exponent of Hertz's law F = 4/3 E* sqrt(R) d^(3/2).
HERTZ_EXPONENT = 1.5


@dataclass(frozen=True)
class Striker:
    """A ball or hammer that strikes a beam from the side, with its force-indentation law.

    It has exactly one law: a ``stiffness``, a ``contact_time``, or Hertz's law by ``modulus`` and ``radius``.

    Parameters
    ----------
    mass
        kg.
    restitution
        Energetic coefficient of restitution e of the contact, in [0, 1]: the part e^2 of the work of compression is
        recovered. The striker rebounds from a rigid wall at e times its speed.
    stiffness
        Loading stiffness of a linear contact, N/m.
    contact_time
        Contact time of a linear contact on a rigid wall, s. With a restitution of 1 the stiffness is mass
        (pi/contact_time)^2. On a beam the contact is shorter.
    modulus
        Hertz's E* of 1/E* = (1 - nu1^2)/E1 + (1 - nu2^2)/E2 of striker and beam, Pa.
    radius
        Hertz's R of 1/R = 1/R1 + 1/R2 at the contact, m. For a ball of radius R1 on a flat side it is R1; on a round
        side about sqrt(R1^2 R2/(R1 + R2)) (handbook: The side strike).

    Raises
    ------
    ValueError
        If a number is out of bounds, or unless it has exactly one law.

    Examples
    --------
    >>> import cuefem as cf
    >>> hammer = cf.Striker(mass=0.1, restitution=0.9, stiffness=1e6)
    >>> ball = cf.Striker(mass=0.02, restitution=0.8, contact_time=1e-3)
    >>> steel = cf.Striker(mass=0.028, restitution=1.0, modulus=12e9, radius=9.5e-3)
    >>> round(1e3 * steel.wall_time(speed=1.0), 3)  # ms
    0.162
    """

    mass: Annotated[float, Quantity("kg", "(0, inf)")]
    restitution: Annotated[float, Quantity("", "[0, 1]")]
    _: KW_ONLY
    stiffness: Annotated[float | None, Quantity("N/m", "(0, inf)")] = None
    contact_time: Annotated[float | None, CONTACT_TIME] = None
    modulus: Annotated[float | None, Quantity("Pa", "(0, inf)")] = None
    radius: Annotated[float | None, Quantity("m", "(0, inf)")] = None

    def __post_init__(self) -> None:
        check_fields(self)
        units = (("stiffness", "N/m"), ("contact_time", "s"), ("modulus", "Pa"), ("radius", "m"))
        values = [(name, getattr(self, name), unit) for name, unit in units if getattr(self, name) is not None]
        if [name for name, _, _ in values] not in (["stiffness"], ["contact_time"], ["modulus", "radius"]):
            got = ", ".join(f"{name} {value} {unit}" for name, value, unit in values) or "none of them"
            raise ValueError(
                "Striker takes one law of contact: stiffness (N/m), contact_time (s), "
                f"or modulus (Pa) with radius (m); got {got}"
            )

    @property
    def law(self) -> TipLaw:
        """Force-indentation law of the contact, a power law."""
        if self.modulus is not None and self.radius is not None:
            return TipLaw(4 / 3 * self.modulus * math.sqrt(self.radius), HERTZ_EXPONENT, self.restitution)
        if self.stiffness is not None:
            return TipLaw(self.stiffness, 1.0, self.restitution)
        assert self.contact_time is not None
        return TipLaw.for_contact_time(
            1.0,
            self.restitution,
            mass=self.mass,
            speed=1.0,  # any: a linear law has one contact time
            time=self.contact_time,
        )

    def wall_time(self, speed: float) -> float:
        """Contact time on a rigid wall, s, at ``speed``, m/s, on which only that of Hertz's law depends."""
        return self.contact_time_on(math.inf, speed)

    def contact_time_on(self, mass: float, speed: float) -> float:
        """Contact time on a free rigid body of ``mass``, kg, head-on at ``speed``, m/s: s."""
        law, reduced_mass = self.law, 1 / (1 / self.mass + 1 / mass)
        power = law.exponent + 1
        depth = (power * reduced_mass * speed**2 / (2 * law.stiffness)) ** (1 / power)
        return (1 + self.restitution) * loading_time(law.exponent) * depth / speed


@dataclass(frozen=True)
class SideStrike:
    """A strike from the side: a ball or hammer hits a free beam across its axis.

    Parameters
    ----------
    cue
        The beam: a `Cue` of segments, or a bat, a stick or a club drawn as one. Its ``body_mass`` has no influence,
        because it moves only along the axis.
    striker
        The ball or hammer.
    position
        Position of the impact, m from the tip.
    speed
        Of the striker, across the axis, m/s. The beam is at rest.
    effects
        Effects that act on the cue (`PointMass`, `Support`, `Joint`, `StructuralDamping`), and `SecondHit`, which
        simulates further contacts. `AxialWaves` has no influence. Effects of the cue's tip are rejected: the striker
        does not touch it.

    Raises
    ------
    TypeError
        If a field is of another kind.
    ValueError
        If the position is off the cue, or an effect cannot act in a strike from the side.

    Examples
    --------
    >>> import cuefem as cf
    >>> wood = cf.Material(E=12.6e9, G=0.84e9, rho=700.0)
    >>> shaft = cf.Cue((cf.Segment(0.7, 0.012, 0.021, wood),))
    >>> ball = cf.Striker(mass=0.02, restitution=0.8, contact_time=1e-3)
    >>> scene = cf.SideStrike(shaft, ball, position=0.01, effects=[cf.PointMass(position=0.1, mass=2e-3)])
    >>> round(cf.side_strike(scene).apparent_restitution, 3)
    -0.721
    """

    cue: Cue
    striker: Striker
    position: Annotated[float, Quantity("m", "[0, inf)")] = 0.0
    speed: Annotated[float, Quantity("m/s", "(0, inf)")] = 1.0
    effects: tuple[Effect, ...] = ()

    def __post_init__(self) -> None:
        check_kind("SideStrike.cue", self.cue, Cue)
        check_kind("SideStrike.striker", self.striker, Striker)
        check_fields(self)
        if self.position > self.cue.length * (1 + POSITION_TOLERANCE):
            bounds = f"[0, {self.cue.length}] m, on the cue"
            raise ValueError(f"SideStrike.position must be in {bounds}; got {self.position}")
        object.__setattr__(self, "effects", check_effects(self.cue, self.effects, "SideStrike"))
        for i, effect in enumerate(self.effects):
            if effect.at_tip and terms_at_contact((effect,), self.cue.segments[0].tip_diameter).window is None:
                raise ValueError(
                    f"SideStrike.effects[{i}] must be an effect on the cue or SecondHit: the striker does not touch "
                    f"the cue's tip; got {type(effect).__name__}"
                )

    @property
    def cue_effects(self) -> tuple[CueEffect, ...]:
        """The effects that act on the cue, sorted."""
        return acting_on_cue(self.effects)

    @property
    def window(self) -> float | None:
        """Time simulated after separation, s; None without `SecondHit`."""
        return terms_at_contact(self.effects, self.cue.segments[0].tip_diameter).window

    @property
    def rigid_mass(self) -> float:
        """Effective mass at the position if the beam were rigid and free, kg."""
        inertial = tuple(effect for effect in self.cue_effects if effect.mass_on(self.cue))
        system = assemble(self.cue, Resolution(1, 4, 1), inertial, positions=[self.position])
        modes = solve(system, 1, position=self.position)
        motion = side_modes(modes).amplitude[: modes.rigid, 0]
        return 1 / float(motion @ motion)

    @property
    def contact_time(self) -> float:
        """Contact time if the beam were rigid and free, s: the time scale for the choice of modes."""
        return self.striker.contact_time_on(self.rigid_mass, self.speed)


@dataclass(frozen=True, eq=False)
class SideOutcome:
    """Outcome of a strike from the side.

    Attributes
    ----------
    rebound_speed : float
        Of the striker, m/s; negative if it continues in its initial direction.
    apparent_restitution : float
        e_A, the rebound speed over the initial speed.
    impulse : float
        Between striker and beam, N s.
    duration : float
        End of the contact, with `SecondHit` of the last one, s from first touch.
    effective_mass : float
        m_e = m (1 + e_A)/(e - e_A), kg: the free mass on which the rebound would be the same. Infinite if the striker
        rebounds as from a rigid wall, negative if faster.
    contact_point_speed : float
        Of the struck position at the end of the contact, m/s, in the direction of the strike.
    phases : tuple
        Phases of the contact (`cuefem.contact.outcome.Phase`); impulses are (0, along the strike), N s.
    energy : dict
        J by name: "initial", and the parts that add up to it: "striker", "cue" (rigid-body modes), "cue
        vibration", "tip loss" (of the striker's contact), "friction loss" (none), and what effects add.
    unknowns : int
        Number of state variables of the model.
    history : History
        Force and velocity at any time of the contact: called with times, s, it returns a dict of arrays, of which
        "force_n" is the force, N, and "velocity_n" the velocity of the striker relative to the beam, m/s, negative
        during approach.
    """

    rebound_speed: float
    apparent_restitution: float
    impulse: float
    duration: float
    effective_mass: float
    contact_point_speed: float
    phases: tuple[Phase, ...]
    energy: dict[str, float]
    unknowns: int = 0
    history: Any = None

    __eq__ = equal_fields
    __hash__ = None  # type: ignore[assignment]


def side_strike(scene: SideStrike, at: Resolution | None = None) -> SideOutcome:
    """Strike a beam from the side and compute the contact in time.

    Parameters
    ----------
    scene : SideStrike
        Beam, striker, position, speed and effects.
    at : Resolution, optional
        A truncated sum over the requested modes. By default modes are retained by frequency and the truncated ones
        corrected, so that the error of e_A is below 1e-4.

    Returns
    -------
    SideOutcome

    Raises
    ------
    ValueError
        If the contact time would be below 1e-6 s or above 10 s.
    RuntimeError
        If the striker does not leave the beam.

    Notes
    -----
    Striker, contact and the beam's modes are one system, stepped as in `cuefem.strike`. Handbook: The side strike.

    Examples
    --------
    The effective mass at the end of a free rigid rod is a quarter of its mass, apart from the rotary inertia of its
    sections:

    >>> import cuefem as cf
    >>> rigid = cf.Material(E=1e16, G=1e16, rho=700.0)
    >>> rod = cf.Cue((cf.Segment(0.7, 0.012, 0.012, rigid),))
    >>> ball = cf.Striker(mass=0.02, restitution=0.8, contact_time=1e-3)
    >>> outcome = cf.side_strike(cf.SideStrike(rod, ball), cf.Resolution(elements=1, order=6, modes=2))
    >>> round(rod.mass / outcome.effective_mass, 3)
    3.999
    """
    check_kind("side_strike scene", scene, SideStrike)
    contact = solve_side_contact(scene, at)
    m, e = scene.striker.mass, scene.striker.restitution
    rebound_speed = float(contact.ball[1])
    e_app = rebound_speed / scene.speed
    return SideOutcome(
        rebound_speed=rebound_speed,
        apparent_restitution=e_app,
        impulse=m * (rebound_speed + scene.speed),
        duration=contact.time,
        effective_mass=m * (1 + e_app) / (e - e_app) if e != e_app else math.inf,
        contact_point_speed=contact.velocity[1] - rebound_speed,
        phases=contact.phases,
        energy=contact.energies({"initial": m * scene.speed**2 / 2, "striker": m * rebound_speed**2 / 2}),
        unknowns=contact.model.unknowns,
        history=contact.history,
    )


def solve_side_contact(scene: SideStrike, at: Resolution | None = None) -> SolvedContact:
    """Solve the contact of a side strike: normal force only, with a striker at the strike's speed."""
    striker, time = scene.striker, scene.contact_time
    if not CONTACT_TIME.contains(time):
        raise ValueError(f"SideStrike must make a contact time in {CONTACT_TIME.bounds}; got {time:.3g} s")
    check_restitution("Striker.restitution", striker.restitution)
    ports = LevelPorts(FirstTouch(phi=0.0))
    model = ContactModel(
        propagator=ports.propagator(_position_modes(scene, at)),
        ports=ports,
        tip=striker.law,
        ball=np.array([0.0, -scene.speed, 0.0]),
        ball_mass=striker.mass,
        inertia=1.0,
        restitution=striker.restitution,
        friction=math.inf,
        speed=scene.speed,
        time=time,
        steps=STEPS,
        window=scene.window,
    )
    return solve_contact(model, steps=None if at is None else at.steps)


def _position_modes(scene: SideStrike, at: Resolution | None) -> TipModes:
    """Frequencies of the beam, and the struck point's displacement in each mode; truncation is corrected by default."""
    resolution = at or mode_count_for(scene.cue, scene.contact_time)
    system = assemble(scene.cue, resolution, scene.cue_effects, positions=[scene.position])
    count = (resolution if isinstance(resolution, int) else resolution.modes) + 2 - system.rigid_basis.shape[1]
    modes = solve(system, count, n_corrected=int(at is None), position=scene.position)
    tip = side_modes(modes)
    for effect in scene.cue_effects:
        tip = effect.damp(tip, ((scene.cue, modes),))
    return tip
