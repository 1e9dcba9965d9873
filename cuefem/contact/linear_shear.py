"""The contact with a tangential spring in the tip (the effect TipShear)."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from cuefem.contact.flow import Flow, Pushes
from cuefem.contact.history import F_T
from cuefem.contact.linear import SIDE, Contact, Grip, Press
from cuefem.contact.ringing_tip import RINGING
from cuefem.cue import Array

# Of the phases and cells that a contact may take, those of a nearly dead tip: a second or so.
HASTE = 0.02
SLIDE = 4  # the output that the base model has not: the velocity at which the massless patch slides


@dataclass
class ShearContact(Contact):
    """A contact whose patch hangs on a tangential spring: in stick the spring gives F_t, in slip friction does.

    compliance: of the spring, m/N. One state more, the spring's force times sqrt(compliance), so that half its square
    is the spring's energy.
    """

    compliance: float = 0.0
    lost: float = 0.0

    extra_states: ClassVar[int] = 1
    slide: ClassVar[int] = SLIDE
    outputs: ClassVar[int] = 5

    @property
    def patience(self) -> float:
        """Its ringing is not averaged: a nearly dead tip that rings on is given up soon."""
        return HASTE if 0 < self.laws.restitution <= RINGING else 1.0

    @property
    def shear(self) -> int:
        """Index of the spring's state."""
        return self.spring + 1

    def _sheared(self) -> tuple[Array, Pushes]:
        """The row that reads the spring's force, and how the spring pushes and is wound up."""
        tangent = np.zeros_like(self.c_t)
        tangent[self.shear] = self.compliance**-0.5
        return tangent, [(self.c_t, tangent), (-tangent, self.c_t)]

    def _held(self, pushes: Pushes, normal: Array, rate: float) -> Flow:
        tangent, sheared = self._sheared()
        rows = [self.c_t, self.c_n, normal, tangent, np.zeros_like(normal)]
        return self._flow(pushes + sheared, rows, rate + float(np.linalg.norm(self.c_t)) * self.compliance**-0.5)

    def _rigidly_held(self) -> Flow:
        tangent, sheared = self._sheared()
        normal = self._slope(self.c_n, sheared) / -float(self.c_n @ self.c_n)
        rows = [self.c_t, self.c_n, normal, tangent, np.zeros_like(normal)]
        return self._flow([*sheared, (self.c_n, normal)], rows)

    def _sliding(self, grip: Grip, pushes: Pushes, normal: Array, rate: float = 0.0) -> Flow:
        # nothing winds the spring, it follows friction: its state is set when the patch grips again
        tangent = SIDE[grip] * self.laws.friction * normal
        slide = self.c_t + self.compliance * self._slope(tangent, pushes)
        return self._flow(pushes, [self.c_t, self.c_n, normal, tangent, slide], rate)

    def _enter(self, grip: Grip, press: Press) -> None:
        """A sliding patch's spring follows friction; where the tip's force jumps (e = 0), the patch slides at once."""
        if grip != "stick":
            self.friction_loss += float(self.z[self.shear]) ** 2 / 2
            self._follow(grip, press)
            self.friction_loss -= float(self.z[self.shear]) ** 2 / 2

    def _follow(self, grip: Grip, press: Press) -> None:
        self.z = self.z.copy()
        self.z[self.shear] = self.compliance**0.5 * float(self.flow(grip, press).rows[F_T] @ self.z)

    def _leave(self, grip: Grip, press: Press) -> None:
        """Stick holds the spring and not the velocity; after a slip the spring is where friction left it."""
        if grip != "stick":
            self._follow(grip, press)

    def first_grip(self, press: Press = "load") -> Grip:
        """The patch sticks from a touch on where the spring's force grows more slowly than friction's bound."""
        v_t, v_n = self.c_t @ self.z, self.c_n @ self.z
        stiffness = self.laws.stiffness / (self.laws.restitution**2 if press == "unload" else 1.0)
        pull = -v_t / (self.compliance * stiffness)
        if np.isinf(self.laws.friction) or abs(pull) <= -self.laws.friction * v_n:
            return "stick"
        return "slip" if pull > 0 else "slip back"

    def let_go(self) -> None:
        """Ball and tip part: the spring loses what it holds."""
        self.lost += float(self.z[self.shear]) ** 2 / 2
        self.z = self.z.copy()
        self.z[self.shear] = 0.0

    def grip_at_rest(self, press: Press) -> Grip:
        """A patch that stops sliding holds: the spring's force is continuous."""
        return "stick"

    def other_losses(self) -> dict[str, float]:
        """What is left in the spring when the ball leaves (only endless friction leaves anything) is lost."""
        return {**super().other_losses(), "tip shear": self.lost + float(self.z[self.shear]) ** 2 / 2}
