"""The forces of a tip of leather over a stretch of time, and what it loses (its contact: `cuefem.contact.leather`).

Along the normal the force follows the law (`cuefem.effects.leather_law`) over the compression d, d' = -v_n. Along the
surface the patch hangs on a spring of stiffness k_t, which grows and shrinks with the patch:

    F_t' = -k_t (v_t - s) while the patch grows,    (F_t/k_t)' = -(v_t - s) while it shrinks,

where s is the velocity at which the patch slides: zero in stick; in slip, what keeps F_t equal to +-mu F_n. New
ground joins the patch without a strain; a patch that shrinks lets its part of the force go. Either way the spring's
energy F_t^2/(2 k_t) loses |k_t'| F_t^2/(2 k_t^2), so that no closed path gives back more than was put in. Were F_t held
while k_t falls, one would (Elata and Berryman, Mech. Mater. 24 (1996) 229).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar, NamedTuple

import numpy as np

from cuefem.contact.marched import Motion, Piece
from cuefem.contact.state import SIDE, Grip, Press
from cuefem.cue import Array
from cuefem.effects.leather_law import LeatherLaw


class Hold(NamedTuple):
    """How the contact holds: its grip and press, whether the patch grows, and whether ball and tip are apart."""

    grip: Grip
    press: Press
    grows: bool
    apart: bool = False


@dataclass
class TipForces:
    """A law with friction; deepest: the compression at the last peak, m."""

    law: LeatherLaw
    friction: float
    deepest: float = 0.0
    # what the last terms of a step's forces may add to an impulse, beside the whole one of a head-on blow: the outcome
    # is then exact to about a hundredth of that
    tolerance: ClassVar[float] = 1e-9
    whole_account: ClassVar[bool] = False  # whether what is lost along the surface is what is missing in its account

    def virtual(self, press: Press, depth: Array) -> Array:
        """The virtual compression (`LeatherLaw`), m."""
        return np.asarray(self.law.virtual(depth, None if press == "load" else self.deepest))

    def at(self, hold: Hold, held: float, v_t: Array, depth: Array, integral: Array) -> tuple[Array, Array]:
        """(F_t, F_n) at the nodes of a step, N.

        held: F_t at its start, N. integral: from values at the nodes to their integrals up to each of them, s.
        """
        F_n, k = self.law.at(self.virtual(hold.press, depth))
        if hold.grip != "stick":
            return SIDE[hold.grip] * self.friction * F_n, F_n
        if hold.grows:
            return held - integral @ (k * v_t), F_n
        return k * ((held / float(k[0]) if held else 0.0) - integral @ v_t), F_n

    def go(self, hold: Hold, piece: Piece) -> float:
        """Go to the end of a step; the force along the surface there, N."""
        return float(piece.rule.polynomials(piece.part) @ piece.motion.F_t)

    def let_go(self) -> None:
        """Ball and tip are apart: there is nothing to keep."""

    def slides(self, hold: Hold, motion: Motion) -> Array:
        """Velocity at which the patch slides on the ball in slip, m/s."""
        virtual = self.virtual(hold.press, motion.depth)
        F, k = self.law.at(virtual)
        dF, dk = self.law.slopes(virtual)
        part = np.divide(dF, k, out=np.full_like(k, 1 / self.law.first_ratio), where=k > 0)
        if not hold.grows:
            part = part - np.divide(F * dk, 2 * virtual * k**2, out=np.zeros_like(k), where=(virtual > 0) & (k > 0))
        return np.asarray(motion.v_t - SIDE[hold.grip] * self.friction * part * motion.v_n / self._scale(hold))

    def wasted(self, hold: Hold, motion: Motion) -> Array:
        """Power that the spring along the surface loses because its stiffness changes, W."""
        virtual = self.virtual(hold.press, motion.depth)
        _, k = self.law.at(virtual)
        _, dk = self.law.slopes(virtual)
        rise = motion.v_n * (-1.0 if hold.grows else 1.0) / self._scale(hold)
        lost = dk * rise * motion.F_t**2
        return np.divide(lost, 4 * virtual * k**2, out=np.zeros_like(k), where=(virtual > 0) & (k > 0))

    def stored(self, press: Press, depth: float, held: float) -> float:
        """Energy that the spring along the surface holds, J."""
        k = float(self.law.at(self.virtual(press, np.array([depth])))[1][0])
        return held**2 / (2 * k) if k else 0.0

    def _scale(self, hold: Hold) -> float:
        """By how much less the compression changes than the virtual one."""
        return 1.0 if hold.press == "load" else self.law.restitution**2
