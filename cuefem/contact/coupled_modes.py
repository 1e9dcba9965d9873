"""Modes that a damping matrix couples, by matrix exponentials."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from scipy.linalg import expm

from cuefem.cue import Array


class CoupledModes(NamedTuple):
    """Modes that a damping matrix couples, (m,), with constant modal loads f: x = (v, a, f), (3 m,).

    omega: rad/s. damping: (m, m), 1/s.
    """

    omega: Array
    damping: Array

    @property
    def system(self) -> Array:
        """Matrix of x' = system x, (3 m, 3 m)."""
        m = len(self.omega)
        matrix = np.zeros((3 * m, 3 * m))
        v, a, f = (slice(k * m, (k + 1) * m) for k in range(3))
        matrix[v, v], matrix[v, a], matrix[v, f] = -self.damping, -np.diag(self.omega), np.eye(m)
        matrix[a, v] = np.diag(self.omega)
        return matrix

    def after(self, t: float) -> tuple[Array, Array]:
        """The state (v, a) after a time t, s, (2 m, 3 m), and the mean of v over it, (m, 3 m), from x.

        omega must not be 0: the mean of v is the increase of a, over omega t.
        """
        m = len(self.omega)
        state = np.asarray(expm(self.system * t)[: 2 * m])
        increase = state[m:] - np.eye(m, 3 * m, m)
        return state, increase / (self.omega * t)[:, None]
