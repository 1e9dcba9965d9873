"""Modes that a damping matrix couples, by matrix exponentials."""

from __future__ import annotations

import math
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

    def energy_lost(self, t: float, state: Array, mean: Array) -> Array:
        """The energy that the damping takes in a time t, s: a quadratic form in x, (3 m, 3 m).

        state, mean: of `after`. It is the work of the loads, minus the increase of the modes' energy (v^2 + a^2)/2: a
        strike's energy balance therefore does not check it (tests/contact/test_modal_response.py integrates the power).
        """
        m = len(self.omega)
        energy = np.diag(np.repeat([0.5, 0.5, 0.0], m)) - state.T @ state / 2
        energy[2 * m :] += t * mean
        return np.asarray(energy)

    def energy_lost_to(self, part: Array, t: float) -> Array:
        """The energy that a part of the damping, (m, m), takes in a time t, s: a quadratic form in x, (3 m, 3 m).

        C. F. Van Loan, Computing integrals involving the matrix exponential, IEEE Trans. Automat. Control 23 (1978)
        395. His matrix also grows where x decays: it is used for a time without much decay, which is then doubled.
        """
        m = len(self.omega)
        n = 3 * m
        doublings = max(0, math.frexp(t * float(np.abs(self.damping).max(initial=0.0)))[1])
        joint = np.zeros((2 * n, 2 * n))
        joint[n:, n:] = self.system[:n, :n]
        joint[:n, :n] = -joint[n:, n:].T
        joint[:m, n : n + m] = part
        exponential = expm(joint * t / 2**doublings)
        propagated = exponential[n:, n:]
        energy = propagated.T @ exponential[:n, n:]
        for _ in range(doublings):
            energy = energy + propagated.T @ energy @ propagated
            propagated = propagated @ propagated
        return np.asarray(energy)
