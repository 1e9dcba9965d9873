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

# Durations of the half-sine pulses, in contact times. Each response is sampled SAMPLES times from the first touch up to
# SAMPLED_TIME contact times.
PULSE_LENGTHS, SAMPLES, SAMPLED_TIME = (0.5, 0.75, 1.0), 16, 1.5
# The decomposition drops rows whose share of the largest row's q'Gq is smaller, and all beyond MAX_ROWS.
MIN_SHARE, MAX_ROWS = 1e-12, 12


class SlopeOutOfRange(ValueError):
    """The axial force bends the shaft beyond the range of the second-order theory."""


def half_octave(time: float) -> float:
    """The nearest power of the square root of two: contacts of similar duration share their rows."""
    return float(2.0 ** (round(2 * math.log2(time)) / 2))


def slope_rows(tip: TipModes, time: float, until: float) -> Array:
    """Rows over the modes, (rows, n), 1/sqrt(m kg), and as the last one the tip's rotation, 1/(m sqrt(kg)).

    time: approximate contact time, s. until: end of the simulated time, s, where that is later than the contact. (0, n)
    without geometric stiffness.
    """
    if tip.geometric is None:
        return np.zeros((0, len(tip.omega)))
    times = np.linspace(0.0, max(SAMPLED_TIME * time, until), SAMPLES + 1)[1:]
    moved = [_pushed(tip.omega, part * time, times) for part in PULSE_LENGTHS]
    shapes = [load[:, None] * each for load in (tip.amplitude[:, 1], tip.rotation) for each in moved]
    shapes = [shape / math.sqrt(np.sum(shape * (tip.geometric @ shape))) for shape in shapes if shape.any()]
    together = np.concatenate(shapes, axis=1)
    onto = tip.geometric @ together
    parts, ways = np.linalg.eigh(together.T @ onto)
    strongest = np.flatnonzero(parts > MIN_SHARE * parts[-1])[-MAX_ROWS:]
    return np.concatenate([(onto @ (ways[:, strongest] / np.sqrt(parts[strongest]))).T[::-1], tip.rotation[None]])


def _pushed(omega: Array, span: float, times: Array) -> Array:
    """Displacement of each mode at ``times``, (n, times), under sin(pi t/span) up to ``span``, from rest."""
    rate = math.pi / span
    nearest = np.abs(omega / rate - 1).min()
    rate *= 1.0 if nearest > 1e-6 else 1 + 3e-6  # at resonance the quotient below is 0/0
    return np.asarray(_begun(omega, rate, times) + _begun(omega, rate, times - math.pi / rate))


def _begun(omega: Array, rate: float, times: Array) -> Array:
    """Displacement of each mode under sin(rate t) from t = 0 on, (n, times)."""
    t, flexible = np.maximum(times, 0.0), np.where(omega > 0, omega, 1.0)[:, None]
    swung = np.sin(flexible * t) / flexible
    return np.asarray(
        (np.sin(rate * t) - rate * np.where(omega[:, None] > 0, swung, t)) / (omega[:, None] ** 2 - rate**2)
    )
