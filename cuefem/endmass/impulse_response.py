"""The tip's transverse response to a force, and the force for a prescribed tip velocity, over equal steps.

The impulse response is h(t) = sum of Re(weight exp(rate t)), 1/kg, of modes that are undamped, damped or radiate. A
lower triangular Toeplitz matrix maps forces, constant over each step, to mean velocities of the tip over the steps.
One solve determines the impulse for a velocity step of the tip; every other velocity follows by superposition (a
Volterra equation of the first kind).
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from cuefem.beam.tip_modes import TipModes
from cuefem.contact.modal_response import Complex, phi_functions, propagator_of
from cuefem.cue import Array

# Steps of a contact. Against closed forms at the same 120 modes (100 random cues, 0.5 to 3 ms, free and damped, "stick"
# and "offset"): relative error 1e-6 (median), 9e-5 (maximum); with half the steps 1e-3 (maximum).
STEPS = 2048
DECAY = 2e-5  # factor of the last term of a power series on the circle of evaluation
TABLE_ROW = 32  # steps in a row of the table of exponentials, an outer product of its first row and column


class ImpulseResponse(NamedTuple):
    """Weights, 1/kg, and rates, 1/s, of h(t), (n,)."""

    weights: Complex
    rates: Complex

    @classmethod
    def of(cls, tip: TipModes) -> ImpulseResponse:
        """The response of tip modes; ValueError if the tip is clamped."""
        propagator = propagator_of(tip.without_geometric_stiffness)
        weights = propagator.output_rows[1] * propagator.input_rows[1]
        active = weights != 0
        if not active.any():
            raise ValueError("end_mass: the tip is clamped transversely, so its end mass is infinite")
        return cls(weights[active], propagator.eigenvalues[active])

    def velocity_step_impulse(self, c: float, T: float) -> Array:
        """Impulse on the tip that moves it at 1 m/s from t = 0, at the edges of the steps of 0..T, kg, (`STEPS` + 1,).

        It begins with a jump, and also moves a ball of inertia 1/c, kg.
        """
        after_jump, column = self.mean_velocities_with_ball(c, T)
        jump = 1 / (self.weights.real.sum() + c)
        force = solve_toeplitz(column, 1 - jump * after_jump)
        return np.append(jump, jump + np.cumsum(force) * T / STEPS)

    def mean_velocities_with_ball(self, c: float, T: float) -> tuple[Array, Array]:
        """Mean relative velocities of tip and ball over the steps of 0..T, (`STEPS`,), m/s.

        After an impulse of 1 N s at the start, and after a force of 1 N over the first step.
        """
        h = T / STEPS
        z = self.rates * h
        _, phi_1, phi_2 = phi_functions(z)
        columns, rows = np.exp(z[:, None] * np.arange(TABLE_ROW)), np.exp(z * np.arange(0, STEPS, TABLE_ROW)[:, None])

        def modal_sum(weights: Complex) -> Array:
            return np.asarray(((rows * weights) @ columns).real.ravel())

        first = (self.weights * h * phi_2).real.sum() + c * h / 2
        later = modal_sum(self.weights * h * phi_1**2)[:-1] + c * h
        return modal_sum(self.weights * phi_1) + c, np.append(first, later)

    def smooth_start_impulse(self, T: float) -> float:
        """Impulse for the tip velocity (1 - cos(pi t/T))/2 from 0 to T, N s per m/s."""
        prescribed = (1 - np.cos(np.pi * np.linspace(0.0, 1.0, STEPS + 1))) / 2
        return float(step_means(self.velocity_step_impulse(0.0, T)) @ np.diff(prescribed)[::-1])

    def half_sine_velocity(self, T: float) -> float:
        """Velocity of the tip at the end of a half-sine force of amplitude 1 N and duration T, m/s per N."""
        lower, upper = (phi_functions((self.rates + side * 1j * np.pi / T) * T)[1] for side in (-1, 1))
        return float((self.weights * T * (upper - lower) / 2j).real.sum())


def step_means(edges: Array) -> Array:
    """Means over the steps of values at their edges."""
    return (edges[1:] + edges[:-1]) / 2


def solve_toeplitz(column: Array, right_side: Array) -> Array:
    """x of L x = right_side, L lower triangular and Toeplitz with the first ``column``, (n,).

    It is a quotient of power series, evaluated at 4 n points of the circle on which the last of the n terms has fallen
    to `DECAY`. The column is the response of a passive body and has no zero there, except near z = -1 from the mean
    over steps: the factor 1 + z is divided out first and multiplied back.
    """
    n = len(column)
    decay = DECAY ** (np.arange(n) / n)
    numerator, denominator = (np.fft.rfft(series * decay, 4 * n) for series in (right_side, _over_one_plus_z(column)))
    return _over_one_plus_z(np.fft.irfft(numerator / denominator)[:n] / decay)


def _over_one_plus_z(series: Array) -> Array:
    """The coefficients of a power series over 1 + z."""
    signs = 1.0 - 2.0 * (np.arange(len(series)) % 2)
    return np.asarray(signs * np.cumsum(signs * series))
