"""The base classes of effects, and the checks of a scene's effects together."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, is_dataclass
from functools import lru_cache
from types import MappingProxyType
from typing import TYPE_CHECKING, Any, ClassVar, NamedTuple

from cuefem.cue import POSITION_TOLERANCE, Array, Cue, LumpedCue
from cuefem.effects.contact_terms import ONCE, ContactTerms
from cuefem.quantity.fields import OutOfBounds, Quantity, check_fields, check_kind

if TYPE_CHECKING:
    from cuefem.beam.axial_modes import RodModes
    from cuefem.beam.modes import Modes
    from cuefem.beam.point_terms import PointTerms
    from cuefem.beam.tip_modes import TipModes


class TrialValues(NamedTuple):
    """Values, SI, at which commands try an effect on a scene that does not list it, and their source."""

    values: dict[str, float]
    source: str


@dataclass(frozen=True)
class Effect:
    """An effect: its fields are checked quantities, and it may add axial mass."""

    # Whether it needs a finite-element cue, whether a scene may list it only once, and the names of effects that cannot
    # act beside it.
    needs_beam: ClassVar[bool] = False
    once: ClassVar[bool] = False
    excludes: ClassVar[tuple[str, ...]] = ()
    # Values at which commands try the effect on a scene that does not list it. None for an effect whose fields all have
    # defaults, and for one that describes an individual cue, such as a point mass: it is not tried.
    trial_values: ClassVar[TrialValues | None] = None
    # Whether it acts at the tip (`Scene.without_tip_effects` removes it).
    at_tip: ClassVar[bool] = False
    # Whether it is part of a freely suspended cue.
    part_of_cue: ClassVar[bool] = False
    # Whether it changes the cue's bending vibration without axial force.
    changes_bending: ClassVar[bool] = True
    # Whether it defines the tip's force-indentation law, so that `Tip` has no contact time of its own.
    defines_tip: ClassVar[bool] = False
    # Keys of a file that set several fields: for each key its names, for each name the fields, SI.
    presets: ClassVar[Mapping[str, Mapping[str, Mapping[str, float]]]] = MappingProxyType({})

    def __post_init__(self) -> None:
        check_fields(self)

    @property
    def axial_mass(self) -> float:
        """Axial mass that the effect adds to the cue, kg, at its first position."""
        return 0.0

    @property
    def positions(self) -> tuple[float, ...]:
        """Positions on the cue that must be mesh nodes, m from the tip."""
        return ()

    def mass_on(self, cue: Cue) -> float:
        """Axial mass that the effect adds to this cue, kg."""
        return self.axial_mass

    def without_tip(self, cue: Cue) -> tuple[Effect, ...]:
        """The effects that remain of it in `Scene.without_tip_effects`."""
        return () if self.at_tip else (self,)

    def on_other_cue(self, own: Cue, other: Cue) -> Effect:
        """The effect, which is on its own cue, for another one."""
        return self

    def check_on(self, cue: Cue, name: str) -> None:
        """ValueError, which begins with ``name``, unless the effect's positions lie on the cue."""
        for x in self.positions:
            if not 0 <= x <= cue.length * (1 + POSITION_TOLERANCE):
                raise OutOfBounds(f"{name}.position", Quantity("m", f"[0, {cue.length}]"), x, ", on the cue")

    def add_to_contact(self, terms: ContactTerms) -> None:
        """Add the effect's terms to the contact's."""


@dataclass(frozen=True)
class CueEffect(Effect):
    """An effect that acts on the cue: it adds terms to the beam (see `cuefem.beam.point_terms`) or to its modes."""

    needs_beam: ClassVar[bool] = True

    @property
    def joint_positions(self) -> tuple[float, ...]:
        """Positions where deflection and rotation may jump, m from the tip."""
        return ()

    def add_to(self, terms: PointTerms) -> None:
        """Add the effect's point terms to the beam's."""

    def mass_on_face(self, cue: Cue) -> float | None:
        """Mass that the effect adds to the tip's face, kg, if it does nothing else; otherwise None."""
        return None

    def axial_modes(self, bending: Modes, cue: Cue, effects: Sequence[CueEffect]) -> tuple[RodModes, ...]:
        """Families of modes beside the ``bending`` modes; effects: all that act on the cue."""
        return ()

    def geometric_stiffness(self, bending: Modes, cue: Cue, effects: Sequence[CueEffect]) -> Array | None:
        """Geometric stiffness of the ``bending`` modes, rigid-body modes first (`TipModes.geometric`)."""
        return None

    def damp(self, tip: TipModes, families: Sequence[tuple[Cue, Modes | RodModes]]) -> TipModes:
        """The tip modes with the effect's damping; their vibrating modes are the families', one after the other."""
        return tip


@dataclass(frozen=True)
class TipEffect(Effect):
    """An effect at the contact between tip and ball."""

    at_tip: ClassVar[bool] = True


def acting_on_cue(effects: Iterable[Effect]) -> tuple[CueEffect, ...]:
    """The effects that act on the cue, sorted, so that sums over them do not depend on the order of the list."""
    return tuple(sorted((effect for effect in effects if isinstance(effect, CueEffect)), key=repr))


@lru_cache(maxsize=256)
def terms_at_contact(effects: tuple[Effect, ...], tip_diameter: float | None) -> ContactTerms:
    """The terms of all these effects together at the contact, shared by all scenes; tip_diameter: see `ContactTerms`.

    ValueError if two of them set what a contact has once.
    """
    terms = ContactTerms(tip_diameter)
    for i, effect in enumerate(effects):
        before = {name: getattr(terms, name) for name in ONCE}
        effect.add_to_contact(terms)
        again = [name for name in ONCE if before[name] is not None and getattr(terms, name) is not before[name]]
        if again:
            raise ValueError(
                f"effects[{i}] must be an effect that goes with those before it, one of which sets the contact's "
                f"{again[0]}; got {type(effect).__name__}, which sets it again"
            )
    return terms


def effect_kinds() -> dict[str, type[Effect]]:
    """Every effect by its name, the ``type`` in a file; without base classes."""

    def subclasses(kind: type[Effect]) -> Iterator[type[Effect]]:
        children = kind.__subclasses__()
        for child in children:
            yield from subclasses(child)
        if not children and is_dataclass(kind):
            yield kind

    return {kind.__name__: kind for kind in sorted(subclasses(Effect), key=lambda kind: kind.__name__)}


def check_effects(cue: Cue | LumpedCue, effects: Any, scene: str = "Scene") -> tuple[Effect, ...]:
    """The effects of a scene as a tuple.

    TypeError or ValueError unless they are effects, on the cue or at its tip, and go together.
    """
    if isinstance(effects, Effect):
        raise TypeError(f"{scene}.effects must be a sequence of effects; got one, {effects!r}")
    effects = tuple(effects)
    names = [type(effect).__name__ for effect in effects]
    for i, effect in enumerate(effects):
        check_kind(f"{scene}.effects[{i}]", effect, Effect)
        if isinstance(cue, Cue):
            effect.check_on(cue, f"{scene}.effects[{i}]")
        elif effect.needs_beam:
            raise ValueError(
                f"{scene}.effects[{i}] must be an effect that a LumpedCue can have, one at its tip alone; "
                f"got {names[i]}, which needs a finite-element Cue"
            )
        if effect.once and names[i] in names[:i]:
            raise ValueError(f"{scene}.effects[{i}] must be another effect, {names[i]} acts once; got {effect}")
        excluded = next((name for name in effect.excludes if name in names), None)
        if excluded is not None:
            raise ValueError(
                f"{scene}.effects[{i}] must be an effect that goes with effects[{names.index(excluded)}], {excluded}; "
                f"got {names[i]}, which does not"
            )
    return effects
