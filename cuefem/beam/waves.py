"""How fine a mesh must be, judged by the bending waves on each segment; and how many modes lie below a frequency."""

from __future__ import annotations

import functools
import math

import numpy as np
from numpy.typing import ArrayLike

from cuefem.cue import Array, Cue

# A sparse eigenproblem costs in proportion to the modes wanted, a dense one to the cube of the unknowns. They cost the
# same when the number of modes is (unknowns/EVEN)^3. Measured: 6 modes of 270 unknowns, 30 of 450, 150 of 780.
EVEN = 145


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


# Orders of an element beyond half the phase of the waves on it, and the highest order of `mesh_for`.
SPARE, HIGHEST_ORDER = 8, 26

# The same for `ended_mesh_for`, whose modes end in a tail: the highest of them need no more accuracy than the tail has,
# and elements may be longer, up to the order WIDEST. Against a finer mesh squirt differs by up to 3e-6 and a stick end
# mass by 1e-5, in the median by 3e-8 (tests/test_default_verification.py). TAPERED: the error in the tip's amplitudes
# that the taper of a cone may cause; that in the frequencies is its square.
SPARE_ENDED, WIDEST, TAPERED = 6, 42, 1e-7

_GUESSES = np.geomspace(1e0, 1e9, 100)  # angular frequencies between which `mesh_for` interpolates, rad/s


@functools.lru_cache(maxsize=32)
def _log_phases(cue: Cue) -> tuple[Array, Array]:
    """Logarithms of the phase of all waves together, and of the shortest over each segment, at `_GUESSES`.

    Kept, because a ladder or a sweep of strokes meshes one cue many times.
    """
    phases = wave_phase(cue, _GUESSES)
    return np.log(phases.sum(axis=(0, 1))), np.log(phases[0])  # the first branch has the shortest waves


def mesh_for(cue: Cue, count: int) -> tuple[int | tuple[int, ...], int]:
    """(elements, order) that hold the ``count`` lowest flexible modes to 2e-7 in frequency, the first five to 1e-9.

    A polynomial of degree p follows a wave of phase P over its element once p > P/2; the error then falls faster than
    exponentially, and SPARE more orders give that accuracy. Every order up to HIGHEST_ORDER is tried, with as many
    elements in each segment as its waves need, and the one with the fewest unknowns is taken.
    """
    phases = _phases(cue, count)
    orders = np.arange(SPARE + 1, HIGHEST_ORDER + 1)
    # where one element is enough, a lower order is cheaper; argmin finds the lowest order
    elements = np.ceil(phases / (2 * (orders - SPARE))[:, None]).astype(int)
    best = int(np.argmin(elements.sum(axis=1) * orders))
    counts = tuple(map(int, elements[best]))
    return counts if len(counts) > 1 else counts[0], int(orders[best])


def ended_mesh_for(cue: Cue, count: int, *, spare: int = SPARE_ENDED) -> tuple[tuple[int, ...], tuple[int, ...]]:
    """(elements, orders), one number a segment each, for the ``count`` lowest modes ended by a tail.

    spare: orders beyond half the phase of the waves on an element. A short steep cone has little phase, but its shapes
    are no polynomials: it takes the orders of `taper_orders`.
    """
    phases = _phases(cue, count)
    elements = np.ceil(phases / (2 * (WIDEST - spare)))
    orders = np.maximum(np.ceil(phases / (2 * elements)) + spare, np.minimum(taper_orders(cue, elements), WIDEST))
    return tuple(map(int, elements)), tuple(map(int, orders))


def taper_orders(cue: Cue, elements: ArrayLike) -> Array:
    """The order by which the taper of a segment's elements leaves `TAPERED`, (segments,).

    Where the wall of a cone, or the sum of its diameters, goes on to zero beyond its thin end, the shapes are singular.
    For the ratio r of that wall at an element's two ends the singularity is at (r + 1)/(r - 1) of its half length, and
    polynomials of order p leave an error of rho^-p, with rho = (sqrt r + 1)/(sqrt r - 1).
    """
    outer = np.array([(s.tip_diameter, s.butt_diameter) for s in cue.segments])
    bore = np.array([(s.tip_bore, s.butt_bore) for s in cue.segments])
    thin, thick = np.sort([outer - bore, outer + bore]).transpose(2, 0, 1)
    root = np.sqrt(1 + ((thick / thin).max(axis=0) - 1) / np.asarray(elements))  # of the element at the thin end
    return np.ceil(-math.log(TAPERED) / np.log((root + 1) / np.maximum(root - 1, 1e-9)))


def even_mesh_for(cue: Cue, count: int) -> tuple[int, int]:
    """(elements, order) as from `mesh_for`, but with the same number of elements in every segment, for many cues."""
    longest = float(_phases(cue, count).max())
    elements = math.ceil(longest / 2 / (HIGHEST_ORDER - SPARE))
    return elements, math.ceil(longest / elements / 2) + SPARE


def _phases(cue: Cue, count: int) -> Array:
    """Phase over each segment, rad, of the shortest waves in the ``count`` lowest flexible modes."""
    whole, shortest = _log_phases(cue)
    return np.exp([np.interp(math.log((count + 1) * math.pi), whole, own) for own in shortest])
