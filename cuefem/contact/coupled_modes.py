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
        """Matrix of x' = system x of x and the integral of v, (4 m, 4 m)."""
        m = len(self.omega)
        matrix = np.zeros((4 * m, 4 * m))
        v, a, f, integral = (slice(k * m, (k + 1) * m) for k in range(4))
        matrix[v, v], matrix[v, a], matrix[v, f] = -self.damping, -np.diag(self.omega), np.eye(m)
        matrix[a, v], matrix[integral, v] = np.diag(self.omega), np.eye(m)
        return matrix

    def after(self, t: float) -> tuple[Array, Array]:
        """The state (v, a) after a time t, s, (2 m, 3 m), and the mean of v over it, (m, 3 m), from x.

        omega must not be 0: the mean of v is the increase of a, over omega t.
        """
        m = len(self.omega)
        state = self.state_after(t)
        increase = state[m:] - np.eye(m, 3 * m, m)
        return state, increase / (self.omega * t)[:, None]

    def state_after(self, t: float) -> Array:
        """The state (v, a) after a time t, s, (2 m, 3 m), from x."""
        n = 3 * len(self.omega)
        return np.asarray(expm(self.system[:n, :n] * t)[: 2 * len(self.omega)])
