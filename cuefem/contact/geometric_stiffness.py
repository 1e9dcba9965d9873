"""The reduced slope basis that carries a cue's geometric stiffness during the contact.

With G the geometric stiffness of all modes (`TipModes.geometric`), the contact needs rows g_a over the modes with
q'Gq = sum of (g_a q)^2 for every modal displacement q that an impact at the tip causes. They come from a proper
orthogonal decomposition in G of the modal responses to half-sine pulses at the tip, a lateral force and a couple.
"""

from __future__ import annotations

import math

import numpy as np

from cuefem.beam.tip_modes import TipModes
from cuefem.cue import Array

# Durations of the half-sine pulses, in contact times. Each response is sampled SAMPLES times up to SAMPLED_TIME contact
# times from the first touch.
PULSE_LENGTHS, SAMPLES, SAMPLED_TIME = (0.5, 0.75, 1.0), 16, 1.5
# The decomposition drops rows whose share of the largest row's q'Gq is smaller, and all beyond MAX_ROWS.
MIN_SHARE, MAX_ROWS = 1e-12, 12


class SlopeOutOfRange(ValueError):
    """The axial force bends the shaft beyond the range of the second-order theory."""


def half_octave(time: float) -> float:
    """The nearest power of the square root of two, s: contacts of similar duration share their rows."""
    return float(2.0 ** (round(2 * math.log2(time)) / 2))


def slope_rows(tip: TipModes, time: float, end: float) -> Array:
    """Rows over the modes, (rows, n), 1/sqrt(m kg), and as the last one the tip's rotation, 1/(m sqrt(kg)).

    time: approximate contact time, s. end: end of the simulated time, s, where that is later than the contact. (0, n)
    without geometric stiffness.
    """
    if tip.geometric is None:
        return np.zeros((0, len(tip.omega)))
    times = np.linspace(0.0, max(SAMPLED_TIME * time, end), SAMPLES + 1)[1:]
    responses = [_half_sine_response(tip.omega, length * time, times) for length in PULSE_LENGTHS]
    shapes = [load[:, None] * response for load in (tip.amplitude[:, 1], tip.rotation) for response in responses]
    shapes = [shape / math.sqrt(np.sum(shape * (tip.geometric @ shape))) for shape in shapes if shape.any()]
    basis = np.concatenate(shapes, axis=1)
    loads = tip.geometric @ basis
    squares, directions = np.linalg.eigh(basis.T @ loads)
    retained = np.flatnonzero(squares > MIN_SHARE * squares[-1])[-MAX_ROWS:]
    return np.concatenate(
        [(loads @ (directions[:, retained] / np.sqrt(squares[retained]))).T[::-1], tip.rotation[None]]
    )


def _half_sine_response(omega: Array, duration: float, times: Array) -> Array:
    """Displacement of each mode at ``times``, (n, times), under sin(pi t/duration) up to ``duration``, from rest."""
    rate = math.pi / duration
    detuning = np.abs(omega / rate - 1).min()
    rate *= 1.0 if detuning > 1e-6 else 1 + 3e-6  # at resonance the quotient below is 0/0
    return np.asarray(_sine_response(omega, rate, times) + _sine_response(omega, rate, times - math.pi / rate))


def _sine_response(omega: Array, rate: float, times: Array) -> Array:
    """Displacement of each mode under sin(rate t) from t = 0 on, (n, times)."""
    t, nonzero_omega = np.maximum(times, 0.0), np.where(omega > 0, omega, 1.0)[:, None]
    free = np.sin(nonzero_omega * t) / nonzero_omega
    return np.asarray(
        (np.sin(rate * t) - rate * np.where(omega[:, None] > 0, free, t)) / (omega[:, None] ** 2 - rate**2)
    )
