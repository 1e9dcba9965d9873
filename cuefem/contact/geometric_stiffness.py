"""How a cue bends while it is struck: the few rows of slopes that carry its geometric stiffness.

With G the geometric stiffness of all modes (`TipModes.geometric`), what the contact needs of it are rows g_a over the
modes with q'Gq = sum of (g_a q)^2 for every q that a blow at the tip brings about. They come from a proper orthogonal
decomposition in G of the modes' motion under half-sine pushes of the tip, across and as a couple.
"""

from __future__ import annotations

import math

import numpy as np

from cuefem.beam.tip import TipModes
from cuefem.cue import Array

# The half-sine pushes last these parts of the contact time. The modes' motion under each is sampled LOOKS times from
# the first touch up to UNTIL contact times.
PUSHES, LOOKS, UNTIL = (0.5, 0.75, 1.0), 16, 1.5
# Of the decomposition, rows that carry less than this part of the greatest one's q'Gq are dropped, and all beyond MOST.
LEAST_PART, MOST = 1e-12, 12


class BentTooFar(ValueError):
    """The thrust bends the shaft further than its second-order theory holds."""


def half_octave(time: float) -> float:
    """The nearest power of the root of two: strokes of about the same length share their rows."""
    return float(2.0 ** (round(2 * math.log2(time)) / 2))


def slope_rows(tip: TipModes, time: float, until: float) -> Array:
    """Rows over the modes, (rows, n), 1/sqrt(m kg), and as the last one the tip's rotation, 1/(m sqrt(kg)).

    time: about how long the contact lasts, s. until: how long cue and ball are followed, s, where that is longer than
    the contact. (0, n) for a cue without thrust.
    """
    if tip.geometric is None:
        return np.zeros((0, len(tip.omega)))
    times = np.linspace(0.0, max(UNTIL * time, until), LOOKS + 1)[1:]
    moved = [_pushed(tip.omega, part * time, times) for part in PUSHES]
    shapes = [load[:, None] * each for load in (tip.amplitude[:, 1], tip.rotation) for each in moved]
    shapes = [shape / math.sqrt(np.sum(shape * (tip.geometric @ shape))) for shape in shapes if shape.any()]
    together = np.concatenate(shapes, axis=1)
    onto = tip.geometric @ together
    parts, ways = np.linalg.eigh(together.T @ onto)
    strongest = np.flatnonzero(parts > LEAST_PART * parts[-1])[-MOST:]
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
