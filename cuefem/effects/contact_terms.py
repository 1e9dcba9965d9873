"""Terms that effects add to the contact of tip and ball."""

from __future__ import annotations

import math
from typing import NamedTuple, Protocol


class WholeTip(Protocol):
    """An effect that models the whole tip, such as `LeatherTip`; diameter: of the tip, m. phi: contact's angle, rad."""

    @property
    def dome_radius(self) -> float:
        """m; inf of a flat tip."""

    def rim(self, diameter: float) -> float:
        """The contact's angle at which the dome ends, rad; beyond it the ball rolls on an edge."""

    def moment_arm(self, phi: float, diameter: float) -> tuple[float, float]:
        """Displacement (u, w) of the contact per unit rotation of the tip's end section, m."""


class PowerLaw(NamedTuple):
    """The exponent of a tip's force, and the speed, m/s, of the head-on stroke that has the tip's contact time."""

    exponent: float
    speed: float


class BilliardTable(NamedTuple):
    """The table under the ball of a cue that points down by ``angle``, rad, and its friction with the ball."""

    angle: float
    friction: float


ONCE = ("law", "tip", "table", "window")  # what a contact has once: a second effect that sets it is rejected


class ContactTerms:
    """Terms of the contact; each effect of a scene adds its own (`Effect.add_to_contact`), in any order.

    Radii and compliances add; of `ONCE` each is set by one effect.

    tip_diameter: of the cue's end or of the leather tip on it, m; None for a lumped cue. law: of the force over the
    indentation, by default linear. tip: a whole tip, which replaces law, domes and compliances. turns: whether the
    normal turns as the contact rolls over ball and tip. table: under the ball of a raised cue. window: simulated time
    after the first separation, s. They become the kernel's input in `cuefem.contact.contact_model`.
    """

    def __init__(self, tip_diameter: float | None = None) -> None:
        self.tip_diameter = tip_diameter
        self.dome_radii: list[float] = []
        self.compliances: list[float] = []
        self.law: PowerLaw | None = None
        self.tip: WholeTip | None = None
        self.turns = False
        self.table: BilliardTable | None = None
        self.window: float | None = None

    def add_dome(self, radius: float) -> None:
        """Add a rigid dome of ``radius``, m, on the end section; radii add, and so do their moment arms."""
        self.dome_radii.append(radius)

    def add_compliance(self, value: float) -> None:
        """Add tangential compliance, relative to the normal loading compliance; compliances in series add."""
        self.compliances.append(value)

    @property
    def dome_radius(self) -> float:
        """Radius of the tip's dome, m; 0 without one."""
        radii = self.dome_radii if self.tip is None else [self.tip.dome_radius]
        return math.fsum(filter(math.isfinite, radii))

    @property
    def rim(self) -> float:
        """The contact's angle at which the tip's dome ends, rad; beyond it the ball rolls on an edge."""
        return math.inf if self.tip is None else self.tip.rim(self.tip_diameter or 0.0)

    @property
    def compliance(self) -> float:
        """Tangential compliance of the tip over its normal loading compliance; 0 for a rigid patch."""
        return math.fsum(self.compliances)

    def moment_arm(self, phi: float) -> tuple[float, float]:
        """Displacement (u, w) of the contact per unit rotation of the tip's section, m; phi: the contact's angle, rad.

        On a dome of radius r the contact is r (1 - cos(phi)) along x and -r sin(phi) along w from its apex.
        """
        if self.tip is not None:
            return self.tip.moment_arm(phi, self.tip_diameter or 0.0)
        radius = math.fsum(self.dome_radii)
        return -radius * math.sin(phi), radius * (1 - math.cos(phi))
