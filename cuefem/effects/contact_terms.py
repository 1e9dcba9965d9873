"""Terms that effects add to the contact of tip and ball."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, NamedTuple

from cuefem.effects.force_law import LeatherLaw


@dataclass(frozen=True)
class TipModel:
    """A complete tip model: the position of the contact on the cue, and its forces.

    diameter: m. dome_radius: m; 0 for a flat tip. rim: the contact's angle at which the dome ends, rad; beyond it the
    ball rolls on an edge. surface_restitution: square root of the part of the tangential strain energy that the leather
    returns. moment_arm: displacement (u, w) of the contact per unit rotation of the tip's end section, m, at an angle
    >= 0, rad. law: the forces on a ball by its radius, m, the offset b/R >= 0 and the restitution.
    """

    diameter: float
    dome_radius: float
    rim: float
    surface_restitution: float
    moment_arm: Callable[[float], tuple[float, float]]
    law: Callable[[float, float, float], LeatherLaw]


class PowerLaw(NamedTuple):
    """The exponent of a tip's force, and the speed, m/s, of the head-on stroke that has the tip's contact time."""

    exponent: float
    speed: float


class BilliardTable(NamedTuple):
    """The table under the ball of a cue that points down by ``angle``, rad, and its friction with the ball."""

    angle: float
    friction: float


class ContactTerms:
    """Terms of the contact; each effect of a scene adds its own (`Effect.add_to_contact`), in any order.

    tip_diameter: of the cue's end, m; None for a lumped cue. law: of the force over the indentation, by default linear.
    tip: a complete tip model. turns: whether the normal turns as the contact rolls over ball and tip. table: under the
    ball of a raised cue. window: simulated time after the first separation, s. They become the kernel's input in
    `cuefem.contact.contact_model`.
    """

    def __init__(self, tip_diameter: float | None = None) -> None:
        self.tip_diameter = tip_diameter
        self.dome_radii: list[float] = []
        self.compliances: list[float] = []
        self.law: PowerLaw | None = None
        self.tip: TipModel | None = None
        self.turns: bool | None = None
        self.table: BilliardTable | None = None
        self.window: float | None = None

    def add_dome(self, radius: float) -> None:
        """Add a rigid dome of ``radius``, m, on the end section; radii add, and so do their moment arms."""
        self.dome_radii.append(radius)

    def add_compliance(self, value: float) -> None:
        """Add tangential compliance, relative to the normal loading compliance; compliances in series add."""
        self.compliances.append(value)

    def set_law(self, law: PowerLaw) -> None:
        """Set the force-indentation law of the tip; ValueError the second time."""
        _check_first(self.law, "law of the tip")
        self.law = law

    def set_tip(self, tip: TipModel) -> None:
        """Set the model of the whole tip; ValueError the second time."""
        _check_first(self.tip, "whole tip")
        self.tip = tip

    def turn_normal(self) -> None:
        """Let the normal turn as the contact rolls over ball and tip; ValueError the second time."""
        _check_first(self.turns, "turning normal")
        self.turns = True

    def set_table(self, table: BilliardTable) -> None:
        """Set the table under the ball of a raised cue; ValueError the second time."""
        _check_first(self.table, "table")
        self.table = table

    def set_window(self, window: float) -> None:
        """Set the time simulated after the first separation, s; ValueError the second time."""
        _check_first(self.window, "window for a double hit")
        self.window = window

    @property
    def dome_radius(self) -> float:
        """Radius of the tip's dome, m; 0 without one."""
        return math.fsum(self.dome_radii) + (0.0 if self.tip is None else self.tip.dome_radius)

    @property
    def compliance(self) -> float:
        """Tangential compliance of the tip over its normal loading compliance; 0 for a rigid patch."""
        return math.fsum(self.compliances)

    def moment_arm(self, phi: float) -> tuple[float, float]:
        """Displacement (u, w) of the contact per unit rotation of the tip's section, m; phi: the contact's angle, rad.

        On a dome of radius r the contact is r (1 - cos(phi)) along x and -r sin(phi) along w from its apex.
        """
        if self.tip is not None:
            return self.tip.moment_arm(phi)
        radius = math.fsum(self.dome_radii)
        return -radius * math.sin(phi), radius * (1 - math.cos(phi))


def _check_first(present: Any, label: str) -> None:
    """ValueError if a term that a contact has once is present."""
    if present is not None:
        raise ValueError(f"Scene.effects must add one {label} to the contact; got a second one")
