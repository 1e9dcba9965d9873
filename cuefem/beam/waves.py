"""How fine a mesh must be, judged by the bending waves on each segment; and how many modes lie below a frequency."""

from __future__ import annotations

import functools
import math

import numpy as np
from numpy.typing import ArrayLike, NDArray

from cuefem.cue import Array, Cue

# The error that the polynomials of an element may leave in the shape of the highest mode. The error of its frequency is
# the square of it, and lower modes are far more accurate.
SHAPE_ERROR = 3e-4
# The longest element, as the phase of the waves on it, rad, and the highest order. Few long elements need the fewest
# unknowns; a `Resolution` of one order for all segments takes shorter ones.
LONGEST, LONGEST_EVEN, HIGHEST_ORDER = 150.0, 36.0, 110
_GUESSES = np.geomspace(1e0, 1e9, 100)  # angular frequencies between which `mode_phases` interpolates, rad/s


def wave_phase(cue: Cue, omega: ArrayLike) -> Array:
    """Phase of bending waves of angular frequency ``omega`` over each segment, rad: (2, segments, *omega.shape).

    The integral of the local wave numbers of Timoshenko's beam (the two branches, the second above its cut-off), at
    three points a segment: the sum over branches and segments, over pi, is nearly the number of modes below omega.
    """
    omega = np.asarray(omega, float)[..., None, None]
    lengths = np.diff(cue.nodes)
    piece = np.arange(len(lengths))[:, None]
    s = cue.section_in(piece, lengths[:, None] * np.array([0.5 - 0.15**0.5, 0.5, 0.5 + 0.15**0.5]))
    shear, rotary = s.rhoA / s.kGA, s.rhoI / s.EI
    split = np.sqrt((shear - rotary) ** 2 + 4 * s.rhoA / (s.EI * np.maximum(omega, 1e-9) ** 2))
    branches = np.array([shear + rotary + split, np.maximum(shear + rotary - split, 0)])
    phase = omega * np.sqrt(branches / 2) @ (np.array([5, 8, 5]) / 18) * lengths
    return np.moveaxis(phase, -1, 1)


def modes_below(cue: Cue, omega: float) -> int:
    """About how many flexible modes of a free cue lie below ``omega`` rad/s (never too few by more than one)."""
    return math.ceil(float(wave_phase(cue, omega).sum()) / np.pi)


@functools.lru_cache(maxsize=32)
def _log_phases(cue: Cue) -> Array:
    """Logarithm of the phase of all waves together at `_GUESSES`; kept, for a sweep of strokes meshes one cue often."""
    return np.asarray(np.log(wave_phase(cue, _GUESSES).sum(axis=(0, 1))))


def mode_phases(cue: Cue, count: int) -> Array:
    """Phase over each segment, rad, of the shortest waves in the ``count`` lowest flexible modes."""
    highest = math.exp(np.interp(math.log((count + 1) * math.pi), _log_phases(cue), np.log(_GUESSES)))
    return np.asarray(wave_phase(cue, highest)[0])  # the first branch has the shortest waves


def orders_for(phase: Array, taper: Array) -> NDArray[np.intp]:
    """Polynomial orders that leave `SHAPE_ERROR` of waves of ``phase`` rad over an element, (elements,).

    Polynomials of degree p leave 2 J_{p+1}(phase/2) of a wave, here by Debye's expansion of the Bessel function.

    taper: ratio of the largest to the smallest EA in an element. Where a cone or its wall goes on to zero beyond its
    thin end, the shapes are singular there, (taper + 1)/(taper - 1) half lengths from the middle, and order p leaves
    rho^-p, with rho = (sqrt taper + 1)/(sqrt taper - 1).
    """
    n = np.arange(2, HIGHEST_ORDER + 2)[:, None]
    ratio = np.maximum(2 * n / np.maximum(phase, 1e-9), 1 + 1e-9)
    slope = np.sqrt(1 - 1 / ratio**2)
    left = 2 * np.exp(n * (slope - np.arccosh(ratio))) / np.sqrt(2 * np.pi * n * slope)
    waves = 1 + np.argmax(left < SHAPE_ERROR, axis=0)
    root = np.sqrt(taper)
    cone = np.ceil(-math.log(SHAPE_ERROR) / np.log((root + 1) / np.maximum(root - 1, 1e-9)))
    return np.minimum(np.maximum(waves, cone), HIGHEST_ORDER).astype(np.intp)


def even_mesh_for(cue: Cue, count: int) -> tuple[int, int]:
    """(elements, order): the same in every segment, for the ``count`` lowest modes."""
    phases = mode_phases(cue, count)
    elements = math.ceil(float(phases.max()) / LONGEST_EVEN)
    EA = cue.section_in(np.arange(len(phases))[:, None], np.diff(cue.nodes)[:, None] * np.array([0.0, 1.0])).EA
    return elements, int(orders_for(phases / elements, EA.max(axis=1) / EA.min(axis=1)).max())
