"""The tip's answer across the cue to a force, and the force that a velocity of the tip takes, over equal steps.

The impulse response is h(t) = sum of Re(weight exp(rate t)), 1/kg, of modes that are free, damped or radiate. Forces
that are constant over each step give the tip mean velocities over the steps by a lower triangular Toeplitz matrix.
Solving that once gives the impulse that a velocity step of the tip takes; every other velocity follows by superposition
(a Volterra equation of the first kind).
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from cuefem.beam.tip import TipModes
from cuefem.contact.modal_response import Complex, propagator_of, responses
from cuefem.cue import Array

# Steps of a contact. Against closed forms at the same 120 modes (100 random cues, 0.5 to 3 ms, free and damped, "stick"
# and "offset"): relative error 1e-6 in the median and 9e-5 at most; 1e-3 at most with half of them.
STEPS = 2048
FADED = 2e-5  # factor of the last term of a power series on the circle where series are divided
ROW = 32  # steps in a row of the table of exponentials, which is a product of what its rows and its columns begin with


class ImpulseResponse(NamedTuple):
    """Weights, 1/kg, and rates, 1/s, of h(t), (n,)."""

    weights: Complex
    rates: Complex

    @classmethod
    def of(cls, tip: TipModes) -> ImpulseResponse:
        """The response of tip modes; ValueError if a clamp holds the tip."""
        propagator = propagator_of(tip.straight)
        weights = propagator.readings[1] * propagator.drives[1]
        felt = weights != 0
        if not felt.any():
            raise ValueError("end_mass: a clamp holds the tip across the cue, so its end mass is infinite")
        return cls(weights[felt], propagator.rates[felt])

    def held(self, c: float, T: float) -> Array:
        """Impulse that a tip has taken at the edges of the steps of 0..T, kg, (`STEPS` + 1,), to move at 1 m/s.

        It begins with a blow, and moves a ball of inertia 1/c, kg, along.
        """
        after_blow, column = self.means_with_ball(c, T)
        blow = 1 / (self.weights.real.sum() + c)
        force = toeplitz_solution(column, 1 - blow * after_blow)
        return np.append(blow, blow + np.cumsum(force) * T / STEPS)

    def means_with_ball(self, c: float, T: float) -> tuple[Array, Array]:
        """Mean velocities of tip and ball from each other over the steps of 0..T, (`STEPS`,), m/s.

        After an impulse of 1 N s at the start, and after a force of 1 N over the first step.
        """
        h = T / STEPS
        z = self.rates * h
        _, mean, own = responses(z)
        within, rows = np.exp(z[:, None] * np.arange(ROW)), np.exp(z * np.arange(0, STEPS, ROW)[:, None])

        def summed(weights: Complex) -> Array:
            return np.asarray(((rows * weights) @ within).real.ravel())

        first = (self.weights * h * own).real.sum() + c * h / 2
        later = summed(self.weights * h * mean**2)[:-1] + c * h
        return summed(self.weights * mean) + c, np.append(first, later)

    def smooth_start_impulse(self, T: float) -> float:
        """Impulse that makes the tip follow the velocity (1 - cos(pi t/T))/2 from 0 to T, N s per m/s."""
        led = (1 - np.cos(np.pi * np.linspace(0.0, 1.0, STEPS + 1))) / 2
        return float(means(self.held(0.0, T)) @ np.diff(led)[::-1])

    def half_sine_velocity(self, T: float) -> float:
        """Velocity of the tip at the end of a half-sine force of unit height and length T, m/s per N."""
        lower, upper = (responses((self.rates + side * 1j * np.pi / T) * T)[1] for side in (-1, 1))
        return float((self.weights * T * (upper - lower) / 2j).real.sum())


def means(edges: Array) -> Array:
    """Means over the steps of values at their edges."""
    return (edges[1:] + edges[:-1]) / 2


def toeplitz_solution(column: Array, wanted: Array) -> Array:
    """x of L x = wanted, L lower triangular and Toeplitz with the first ``column``, (n,).

    It is a quotient of power series, evaluated in 4 n points of the circle on which the last of the n terms has fallen
    to `FADED`: the column answers a passive body, so that it has no zero there. The factor 1 + z, which a mean over
    steps has, is divided out and brought back, for its zero lies beside the circle.
    """
    n = len(column)
    fade = FADED ** (np.arange(n) / n)
    above, below = (np.fft.rfft(series * fade, 4 * n) for series in (wanted, _over_one_plus_z(column)))
    return _over_one_plus_z(np.fft.irfft(above / below)[:n] / fade)


def _over_one_plus_z(series: Array) -> Array:
    """The coefficients of a power series over 1 + z."""
    signs = 1.0 - 2.0 * (np.arange(len(series)) % 2)
    return np.asarray(signs * np.cumsum(signs * series))
