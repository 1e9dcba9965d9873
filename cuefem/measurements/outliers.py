"""Predictions of which some may be wrong: each has its stated error or, in a small share of cases, a far larger one.

A wrong number's error is `WIDER` times the stated one. A number that agrees with the others counts in full, one that
contradicts them hardly at all, and where the numbers cannot tell which of them is wrong, the error grows (the
good-and-bad data model: W. H. Press, in Unsolved Problems in Astrophysics, Princeton 1997, 49; D. S. Sivia, Data
Analysis, Oxford 2006, ch. 8).
"""

from __future__ import annotations

from itertools import combinations
from typing import NamedTuple

import numpy as np

from cuefem.cue import Array

WIDER = 10.0  # times the stated error: that of a wrong number
MISTAKEN = 1e-3  # share of measurements that are wrong: contradictions of `NOTICED` errors outweigh it
NOTICED = float(np.sqrt(2 * np.log(WIDER / MISTAKEN)))
TOGETHER = 2  # measurements that are wrong at once, at most


class Linear(NamedTuple):
    """What measurements tell of parameters whose priors are 0 ± 1; wrong: the chance of each measurement to be so."""

    mean: Array
    covariance: Array
    wrong: Array


def solved(slopes: Array, residuals: Array) -> Linear:
    """The parameters of a linear problem, of whose measurements `TOGETHER` at most are wrong.

    slopes: (measurements, parameters) and residuals: (measurements,), both in units of the measurements' errors. Every
    set of measurements that may be wrong, their errors `WIDER` times the stated ones, is a problem of its own; the
    problems count by how likely they make what was measured.
    """
    count, parameters = slopes.shape
    sets = [each for size in range(min(TOGETHER, count) + 1) for each in combinations(range(count), size)]
    bad = np.zeros((len(sets), count))
    for row, each in zip(bad, sets, strict=True):
        row[list(each)] = 1.0
    weights = np.where(bad, WIDER**-2, 1.0)
    inverse = np.einsum("sm,mi,mj->sij", weights, slopes, slopes) + np.eye(parameters)
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
