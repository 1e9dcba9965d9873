"""Phases of the bending waves on each segment: the mesh that resolves them, and the number of modes."""

from __future__ import annotations

import functools
import math

import numpy as np
from numpy.typing import ArrayLike, NDArray

from cuefem.cue import Array, Cue, Section

# Interpolation error of the shape of the highest mode. The error of its frequency is the square of it, and lower modes
# are far more accurate.
SHAPE_ERROR = 3e-4
# Few long elements need the fewest degrees of freedom.
MAX_PHASE = 150.0  # phase of the waves on an element, rad
MAX_ORDER = 110
_FREQUENCIES = np.geomspace(1e0, 1e9, 100)  # angular frequencies between which `mode_phases` interpolates, rad/s


@functools.lru_cache(maxsize=32)
def segment_sections(cue: Cue) -> Section:
    """Section properties of each segment at its tip end, three Gauss points, and its butt end, (segments, 5)."""
    fractions = np.array([0.0, 0.5 - 0.15**0.5, 0.5, 0.5 + 0.15**0.5, 1.0])
    return cue.section_in(np.arange(len(cue.segments))[:, None], cue.lengths[:, None] * fractions)


def wave_phase(cue: Cue, omega: ArrayLike) -> Array:
    """Phase of bending waves of angular frequency ``omega`` over each segment, rad: (2, segments, *omega.shape).

    The integral of the local wave numbers of Timoshenko's beam (the two branches, the second above its cut-off), at
    three points a segment: the sum over branches and segments, over pi, is nearly the number of modes below omega.
    """
    omega, sections = np.asarray(omega, float)[..., None, None], segment_sections(cue)
    _, EI, kGA, rhoA, rhoI = (values[:, 1:4] for values in sections)
    shear, rotary = rhoA / kGA, rhoI / EI
    root = np.hypot(shear - rotary, 2 * np.sqrt(rhoA / EI) / np.maximum(omega, 1e-9))
    branches = np.array([shear + rotary + root, np.maximum(shear + rotary - root, 0)])
    phase = omega * np.sqrt(branches / 2) @ (np.array([5, 8, 5]) / 18) * cue.lengths
    return np.moveaxis(phase, -1, 1)


def modes_below(cue: Cue, omega: float) -> int:
    """Estimated number of flexible modes of a free cue below ``omega`` rad/s, at most one too few."""
    return math.ceil(float(wave_phase(cue, omega).sum()) / np.pi)


@functools.lru_cache(maxsize=32)
def _log_phases(cue: Cue) -> Array:
    """Logarithm of the total phase of all waves at `_FREQUENCIES`; cached: a sweep meshes one cue many times."""
    return np.asarray(np.log(wave_phase(cue, _FREQUENCIES).sum(axis=(0, 1))))


def mode_phases(cue: Cue, count: int) -> Array:
    """Phase over each segment, rad, of the shortest waves in the ``count`` lowest flexible modes."""
    highest = math.exp(np.interp(math.log((count + 1) * math.pi), _log_phases(cue), np.log(_FREQUENCIES)))
    return np.asarray(wave_phase(cue, highest)[0])  # the first branch has the shortest waves


def orders_for(phase: Array, taper: Array) -> NDArray[np.intp]:
    """Polynomial orders with an interpolation error of `SHAPE_ERROR` for waves of ``phase`` rad, (elements,).

    The error of degree p is 2 J_{p+1}(phase/2), by Debye's expansion of the Bessel function.

    taper: ratio of the largest to the smallest EA in an element. A cone, extended beyond its thin end to zero width,
    makes the shapes singular there, (taper + 1)/(taper - 1) half lengths from the middle: order p has the error rho^-p,
    rho = (sqrt taper + 1)/(sqrt taper - 1).
    """
    n = np.arange(2, MAX_ORDER + 2)[:, None]
    ratio = np.maximum(2 * n / np.maximum(phase, 1e-9), 1 + 1e-9)
    slope = np.sqrt(1 - 1 / ratio**2)
    error = 2 * np.exp(n * (slope - np.arccosh(ratio))) / np.sqrt(2 * np.pi * n * slope)
    order = 1 + np.argmax(error < SHAPE_ERROR, axis=0)
    root = np.sqrt(taper)
    cone_order = np.ceil(-math.log(SHAPE_ERROR) / np.log((root + 1) / np.maximum(root - 1, 1e-9)))
    return np.minimum(np.maximum(order, cone_order), MAX_ORDER).astype(np.intp)
