"""What effects add at the contact of tip and ball, and what they make of the stroke there."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import NamedTuple, Protocol

from cuefem.effects.law import TipLaw
from cuefem.effects.leather_law import LeatherLaw

# Displacement (u, w) of the contact per unit rotation of the tip's end section, m, over the contact's angle, rad.
Lever = Callable[[float], tuple[float, float]]


class HeadOn(NamedTuple):
    """A head-on blow: reduced mass, kg; restitution; the base model's contact time, s; the stroke's speed, m/s."""

    mass: float
    restitution: float
    time: float
    speed: float


@dataclass(frozen=True)
class WholeTip:
    """A tip that gives everything at the contact: where this is on the cue, and the forces there.

    diameter: m. dome_radius: m; 0 for a flat tip. rim: the contact's angle at which the dome ends, rad; beyond it the
    ball rolls on an edge. shear: a constant stiffness along the surface, N/m; None where the patch has its own.
    surface_restitution: the root of what the leather gives back of the work that strains it along the surface. lever:
    for angles >= 0. law: the forces on a ball by its radius, m, the offset b/R >= 0 and the restitution.
    """

    diameter: float
    dome_radius: float
    rim: float
    shear: float | None
    surface_restitution: float
    lever: Lever
    law: Callable[[float, float, float], LeatherLaw]


# Makes a tip's law along the normal from its head-on blow, and tells about how long the contact takes, s.
MakeLaw = Callable[[HeadOn], tuple[TipLaw, float]]


class Table(NamedTuple):
    """The table under the ball of a cue that points down by ``angle``, rad, and its friction with the ball."""

    angle: float
    friction: float


class ActsAtContact(Protocol):
    """An effect that may add to the contact."""

    def add_to_contact(self, terms: ContactTerms) -> None:
        """Add the effect's terms to the contact's."""


class ContactTerms:
    """Terms of the contact; each effect of a scene adds its own (`Effect.add_to_contact`), in any order.

    What may be given only once (law, turning normal, table, window) is refused the second time. `cuefem.contact.laws`
    makes of them the law that the contact follows. tip_diameter: of the cue's end, m; None for a
    lumped cue, which has none.
    """

    def __init__(self, tip_diameter: float | None = None) -> None:
        self.tip_diameter = tip_diameter
        self.levers: list[Lever] = []
        self.dome_radii: list[float] = []
        self.compliances: list[float] = []
        self.law: MakeLaw | None = None
        self.tip: WholeTip | None = None
        self.turns = False
        self.table: Table | None = None
        self.window: float | None = None

    @classmethod
    def of(cls, effects: Iterable[ActsAtContact], tip_diameter: float | None = None) -> ContactTerms:
        """The terms of all these effects together."""
        terms = cls(tip_diameter)
        for effect in effects:
            effect.add_to_contact(terms)
        return terms

    def add_lever(self, lever: Lever) -> None:
        """Move the contact off the end of the cue's axis; levers add."""
        self.levers.append(lever)

    def add_dome(self, radius: float) -> None:
        """Round the tip: a dome of ``radius``, m, tied to the end section; radii add, as their levers do."""
        self.dome_radii.append(radius)

    def add_compliance(self, part: float) -> None:
        """Let the tip give sideways, by ``part`` of what it gives along the normal while it is loaded; parts add."""
        self.compliances.append(part)

    def set_law(self, law: MakeLaw) -> None:
        """Replace the tip's linear law along the normal by the one that ``law`` makes for its head-on blow."""
        self._refuse_twice("law of the tip", self.law is not None)
        self.law = law

    def set_tip(self, tip: WholeTip) -> None:
        """Give the tip as a whole: where the contact is on it, and the forces there."""
        self._refuse_twice("whole tip", self.tip is not None)
        self.tip = tip

    def turn(self) -> None:
        """Let the normal turn as the contact moves over ball and tip."""
        self._refuse_twice("turning normal", self.turns)
        self.turns = True

    def set_table(self, table: Table) -> None:
        """Raise the cue, and put a table under the ball."""
        self._refuse_twice("table", self.table is not None)
        self.table = table

    def set_window(self, window: float) -> None:
        """Follow cue and ball for ``window``, s, after their first separation, and through every further contact."""
        self._refuse_twice("window for a second hit", self.window is not None)
        self.window = window

    def _refuse_twice(self, what: str, present: bool) -> None:
        if present:
            raise ValueError(f"Scene.effects must give the contact one {what}; got a second one")

    @property
    def dome_radius(self) -> float:
        """Radius of the tip's dome, m; 0 without one."""
        return math.fsum(self.dome_radii) + (0.0 if self.tip is None else self.tip.dome_radius)

    @property
    def compliance(self) -> float:
        """Give of the tip sideways, as a part of 1/(loading stiffness); 0 for a rigid patch."""
        return math.fsum(self.compliances)

    def lever(self, phi: float) -> tuple[float, float]:
        """Displacement (u, w) of the contact per unit rotation of the tip's section, m; phi: the contact's angle, rad.

        On a dome of radius r the contact is r (1 - cos(phi)) along x and -r sin(phi) along w from its apex.
        """
        s, c = math.sin(phi), math.cos(phi)
        domes = [(-radius * s, radius * (1 - c)) for radius in self.dome_radii]
        whole = [] if self.tip is None else [self.tip.lever(phi)]
        parts = [*domes, *whole, *(lever(phi) for lever in self.levers)]
        return math.fsum(u for u, _ in parts), math.fsum(w for _, w in parts)
