"""The stepped contact with a tangential spring in the tip (the effect TipShear beside a nonlinear one)."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any, ClassVar

from cuefem.contact.linear import SIDE, Grip, Press
from cuefem.contact.stepped import Hold, SteppedContact
from cuefem.cue import Array


@dataclass
class SteppedShearContact(SteppedContact):
    """A stepped contact whose patch hangs on a tangential spring: in stick the spring gives F_t, in slip friction does.

    compliance: of the spring, m/N. lost: energy that it held as the ball left, J. One state more, the spring's force.
    """

    compliance: float = 0.0
    lost: float = 0.0

    extra_states: ClassVar[int] = 6

    def __post_init__(self) -> None:
        super().__post_init__()
        self.shear = len(self.z) - 1
        self.sizes[self.shear] = self.scale

    def _stored(self) -> float:
        return self.compliance * float(self.z[self.shear]) ** 2 / 2

    def _forces(
        self, z: Array, hold: Hold, *, directions: tuple[Array, Array, Array], free: Array
    ) -> tuple[float, float]:
        if hold.grip != "stick":
            return super()._forces(z, hold, directions=directions, free=free)
        F_t = float(z[self.shear])
        if hold.press != "rigid":
            return F_t, self._pressing(float(z[self.depth]), hold)
        c_t, c_n, _ = directions
        _, free_n = self._falling(z, directions=directions, free=free)
        return F_t, -(free_n + float(c_t @ c_n) * F_t) / float(c_n @ c_n)

    def change(self, z: Array, hold: Hold | None) -> Array:
        """Rate of change of the state, 1/s; hold: None where ball and tip are apart."""
        rate = super().change(z, hold)
        if hold is not None and hold.grip == "stick":
            rate[self.shear] = -float(self.directions(z)[0] @ z) / self.compliance
        return rate

    def sliding(self, z: Array, hold: Hold) -> float:
        """Velocity at which the massless patch slides on the ball, m/s."""
        v_t, v_n, _, _ = self.reading(z, hold)
        if hold.press == "rigid":  # F_n follows the motion; a central difference along it is enough to find an end
            step = 1e-5 * self.clock * self.change(z, hold)
            rise = (self.reading(z + step, hold)[3] - self.reading(z - step, hold)[3]) / (2e-5 * self.clock)
        else:
            rise = -self._stiffness(float(z[self.depth]), hold) * v_n
        return v_t + self.compliance * SIDE[hold.grip] * self.laws.friction * rise

    def _stiffness(self, compression: float, hold: Hold) -> float:
        return self.law.slope(compression, None if hold.press == "load" else hold.deepest)

    def _follow(self, hold: Hold | None, end: float, z: Array, solution: Any) -> None:
        before = self._stored()
        if hold is not None and hold.grip != "stick":
            z[self.shear] = self.reading(z, hold)[2]  # a sliding patch's spring follows friction
        super()._follow(hold, end, z, solution)
        self.friction_loss -= self._stored() - before  # of the work against F_t, what the spring took

    def _settle(self, hold: Hold | None) -> None:
        """Nothing is held but by the spring."""

    def fly(self, until: float, near: float) -> bool:
        """Let ball and tip fly; the spring loses what it holds."""
        self.lost += self._stored()
        self.z = self.z.copy()
        self.z[self.shear] = 0.0
        return super().fly(until, near)

    def first_grip(self, press: Press = "load") -> Grip:
        """The patch sticks where its force grows more slowly than friction's bound."""
        hold = Hold("stick", press, self.deepest)
        v_t, v_n, _, _ = self.reading(self.z, hold)
        pull = -v_t / self.compliance
        bound = -self.laws.friction * v_n * self._stiffness(float(self.z[self.depth]), hold)
        if math.isinf(self.laws.friction) or abs(pull) <= bound:
            return "stick"
        return "slip" if pull > 0 else "slip back"

    def grip_at_rest(self, press: Press) -> Grip:
        """A patch that stops sliding holds: the spring's force is continuous."""
        return "stick"

    def other_losses(self) -> dict[str, float]:
        """What is left in the spring when the ball leaves (only endless friction leaves anything) is lost."""
        return {**super().other_losses(), "tip shear": self.lost + self._stored()}
