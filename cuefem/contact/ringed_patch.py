"""The forces of a tip of leather whose patch slips ring by ring (partial slip); elsewhere as in `TipForces`.

Where a patch grows from the compression x to x + dx while the surfaces shift by d(delta), the tractions of a stuck
punch of that size are added, times d(delta). The force along the surface is therefore a sum over rings, each strained
by what the surfaces have shifted since it touched: F_t = integral of u dk, with the energy integral of u^2 dk/2, in any
linear elastic tip (k: the stiffness of a stuck patch; of two punches, one within the other, the smaller does the work
that they exchange). The normal force is such a sum too, N = integral of (d - x) dS, with the slope S of the force. A
ring slides where |u| dk would be above mu (d - x) dS: the partial slip of Cattaneo, Mindlin and Deresiewicz where k is
in proportion to S (Jaeger's superposition). The bound of a ring that is about to let go is zero, so that all of what
the patch loses is friction's; with endless friction a ring loses what it holds. The tip slides as a whole where all
rings do, and then |F_t| = mu F_n. An independent solution: studies/leather_release.py.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from cuefem.contact.marched import Motion, Piece
from cuefem.contact.state import SIDE, Press
from cuefem.contact.tip_forces import Hold, TipForces
from cuefem.cue import Array

RINGS = 160  # even in the root of the compression, up to the law's greatest


@dataclass
class RingForces(TipForces):
    """held_by: the force along the surface that each ring holds at the end of the last step, (RINGS,), N."""

    tolerance: ClassVar[float] = 1e-6  # rings that touch, slide and let go make forces with many small kinks
    whole_account: ClassVar[bool] = True

    def __post_init__(self) -> None:
        self.edges = self.law.most * np.linspace(0.0, 1.0, RINGS + 1) ** 2
        self.force_to, self.stiffness_to = self.law.at(self.edges)
        self.slope_to = self.law.slopes(self.edges)[0]
        self.held_by = np.zeros(RINGS)
        self.first_gain = float(self.slope_to[1] / self.stiffness_to[1])

    def rings(self, depth: Array) -> tuple[Array, Array]:
        """Stiffness along the surface and normal force of each ring at virtual compressions (n,): (n, RINGS) each."""
        F, k = self.law.at(depth)
        inside = self.edges < depth[:, None]
        stiffness = np.where(inside, self.stiffness_to, k[:, None])
        force = np.where(inside, self.slope_to * (depth[:, None] - self.edges) + self.force_to, F[:, None])
        return np.diff(stiffness, axis=1), np.diff(force, axis=1)

    def holds(self, hold: Hold, v_t: Array, depth: Array, integral: Array) -> Array:
        """The force that each ring holds at the nodes of a step, (n, RINGS), N."""
        k, N = self.rings(self.virtual(hold.press, depth))
        if hold.grip != "stick":
            return np.asarray(SIDE[hold.grip] * self.friction * N)
        shift = np.diff(-(integral @ v_t))
        grown = (k[1:] + k[:-1]) / 2 * shift[:, None]
        left = np.minimum(np.divide(k[1:], k[:-1], out=np.ones_like(k[1:]), where=k[:-1] > 0), 1.0)
        bound = self.friction * N if np.isfinite(self.friction) else np.full_like(N, np.inf)
        found = np.empty_like(k)
        found[0] = self.held_by
        for i in range(len(shift)):
            found[i + 1] = np.clip(found[i] * left[i] + grown[i], -bound[i + 1], bound[i + 1])
        return found

    def at(self, hold: Hold, held: float, v_t: Array, depth: Array, integral: Array) -> tuple[Array, Array]:
        """(F_t, F_n) at the nodes of a step, N."""
        F_n, _ = self.law.at(self.virtual(hold.press, depth))
        if hold.grip != "stick":
            return SIDE[hold.grip] * self.friction * F_n, F_n
        return self.holds(hold, v_t, depth, integral).sum(axis=1), F_n

    def go(self, hold: Hold, piece: Piece) -> float:
        """Take the rings to the end of a step; the force along the surface there, N."""
        motion, rule, part = piece.motion, piece.rule, piece.part
        nodes = np.flatnonzero(rule.times < part * (1 - 1e-12))
        ends = rule.polynomials(part)
        depth = np.append(motion.depth[nodes], ends @ motion.depth)
        integral = np.vstack([piece.response.integral[nodes], piece.sums(part)])
        self.held_by = self.holds(hold, motion.v_t, depth, integral)[-1]
        return float(self.held_by.sum())

    def let_go(self) -> None:
        """Ball and tip are apart."""
        self.held_by = np.zeros(RINGS)

    def slides(self, hold: Hold, motion: Motion) -> Array:
        """Velocity at which the innermost ring slides on the ball, m/s: the last to hold, and the first to slide."""
        gain = SIDE[hold.grip] * self.friction * self.first_gain
        return np.asarray(motion.v_t - gain * motion.v_n / self._scale(hold))

    def stored(self, press: Press, depth: float, held: float) -> float:
        """Energy that the rings hold, J."""
        k, _ = self.rings(self.virtual(press, np.array([depth])))
        held_by = self.held_by
        return float(np.sum(np.divide(held_by**2, 2 * k[0], out=np.zeros_like(held_by), where=k[0] > 0)))
