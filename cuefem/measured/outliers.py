"""Numbers of which some may be wrong: each has its stated error or, in a small share of cases, a far larger one.

A wrong number's error is `WIDER` times the stated one, or, among repeated readings, Cauchy's, which has no end. A
number that agrees with the others counts in full, one that contradicts them hardly at all, and where the numbers cannot
tell which of them is wrong, the error grows (the good-and-bad data model: W. H. Press, in Unsolved Problems in
Astrophysics, Princeton 1997, 49; D. S. Sivia, Data Analysis, Oxford 2006, ch. 8).
"""

from __future__ import annotations

from itertools import combinations
from typing import NamedTuple

import numpy as np

from cuefem.cue import Array

WIDER = 10.0  # times the stated error: that of a wrong number
MISREAD = 0.1  # share of readings by eye that are wrong
MISTAKEN = 1e-3  # share of measurements that are wrong: contradictions of `NOTICED` errors outweigh it
NOTICED = float(np.sqrt(2 * np.log(WIDER / MISTAKEN)))
TOGETHER = 2  # measurements that are wrong at once, at most
HOLDS_95 = 1.959964  # standard deviations either way that hold 95 %
FINE = 20  # points a standard deviation


def log_density(residuals: Array, wrong: float) -> Array:
    """ln of the density of residuals in units of their errors, but for a constant; ``wrong``: share of wrong ones."""
    bad = np.log(wrong / WIDER) - np.log1p((residuals / WIDER) ** 2)
    return np.asarray(np.logaddexp(np.log1p(-wrong) - residuals**2 / 2, bad))


def middle_of(values: Array, errors: Array) -> tuple[float, float]:
    """The number that repeated readings tell, some of which may be wrong, and its error.

    The middle of its 68 % interval; the error is half of that, or as much as its 95 % interval asks for. A single
    reading is taken as it is.
    """
    if len(values) == 1:
        return float(values[0]), float(errors[0])
    steps = np.linspace(-8, 8, 16 * FINE + 1)
    x = np.unique((values[:, None, None] + errors[:, None, None] * np.outer((1.0, WIDER), steps)).ravel())
    level = sum(log_density((x - value) / error, MISREAD) for value, error in zip(values, errors, strict=True))
    density = np.exp(level - np.max(level))
    share = np.concatenate([[0.0], np.cumsum(np.diff(x) * (density[1:] + density[:-1]) / 2)])
    far, low, high, farther = np.interp((0.025, 0.1586553, 0.8413447, 0.975), share / share[-1], x)
    return float(low + high) / 2, float(max((high - low) / 2, (farther - far) / 2 / HOLDS_95))


class Linear(NamedTuple):
    """What measurements tell of unknowns whose priors are 0 ± 1; wrong: the chance of each measurement to be so."""

    mean: Array
    covariance: Array
    wrong: Array


def solved(slopes: Array, residuals: Array) -> Linear:
    """The unknowns of a linear problem, of whose measurements `TOGETHER` at most are wrong.

    slopes: (measurements, unknowns) and residuals: (measurements,), both in units of the measurements' errors. Every
    set of measurements that may be wrong, their errors `WIDER` times the stated ones, is a problem of its own; the
    problems count by how likely they make what was measured.
    """
    count, unknowns = slopes.shape
    sets = [each for size in range(min(TOGETHER, count) + 1) for each in combinations(range(count), size)]
    bad = np.zeros((len(sets), count))
    for row, each in zip(bad, sets, strict=True):
        row[list(each)] = 1.0
    weights = np.where(bad, WIDER**-2, 1.0)
    inverse = np.einsum("sm,mi,mj->sij", weights, slopes, slopes) + np.eye(unknowns)
    covariance = np.linalg.inv(inverse)
    right = (weights * residuals) @ slopes
    means = np.einsum("sij,sj->si", covariance, right)
    fit = (weights * residuals) @ residuals - np.einsum("si,si->s", means, right)
    odds = bad.sum(axis=1) * np.log(MISTAKEN / (1 - MISTAKEN) / WIDER)
    level = odds - fit / 2 - np.linalg.slogdet(inverse)[1] / 2
    share = np.exp(level - level.max())
    share /= share.sum()
    mean = share @ means
    apart = means - mean
    return Linear(mean, np.einsum("s,sij->ij", share, covariance + apart[:, :, None] * apart[:, None, :]), share @ bad)
