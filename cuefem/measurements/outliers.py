"""Estimation with outliers: each measurement has its stated error or, with a small probability, a far larger one.

The error of an outlier is `OUTLIER_FACTOR` times the stated one. A value that agrees with the others has full weight, a
contradictory one nearly none, and where the outlier cannot be identified, the posterior widens (the good-and-bad data
model: W. H. Press, in Unsolved Problems in Astrophysics, Princeton 1997, 49; D. S. Sivia, Data Analysis, 2006, ch. 8).
"""

from __future__ import annotations

from itertools import combinations
from typing import NamedTuple

import numpy as np

from cuefem.cue import Array

OUTLIER_FACTOR = 10.0  # times the stated error: that of a wrong number
OUTLIER_SHARE = 1e-3  # share of measurements that are wrong: contradictions of `DETECTABLE` errors outweigh it
DETECTABLE = float(np.sqrt(2 * np.log(OUTLIER_FACTOR / OUTLIER_SHARE)))
MAX_OUTLIERS = 2  # outliers at once, at most


class Posterior(NamedTuple):
    """Posterior of parameters whose priors are 0 ± 1; outlier_probability: of each measurement."""

    mean: Array
    covariance: Array
    outlier_probability: Array


def posterior(slopes: Array, residuals: Array) -> Posterior:
    """The posterior of a linear problem with at most `MAX_OUTLIERS` outliers.

    slopes: (measurements, parameters) and residuals: (measurements,), both in units of the measurements' errors. Every
    set of possible outliers, their errors `OUTLIER_FACTOR` times the stated ones, is a separate problem; the
    problems are weighted by their evidence.
    """
    count, parameters = slopes.shape
    sets = [each for size in range(min(MAX_OUTLIERS, count) + 1) for each in combinations(range(count), size)]
    outliers = np.zeros((len(sets), count))
    for row, each in zip(outliers, sets, strict=True):
        row[list(each)] = 1.0
    weights = np.where(outliers, OUTLIER_FACTOR**-2, 1.0)
    inverse = np.einsum("sm,mi,mj->sij", weights, slopes, slopes) + np.eye(parameters)
    covariance = np.linalg.inv(inverse)
    rhs = (weights * residuals) @ slopes
    means = np.einsum("sij,sj->si", covariance, rhs)
    fit = (weights * residuals) @ residuals - np.einsum("si,si->s", means, rhs)
    odds = outliers.sum(axis=1) * np.log(OUTLIER_SHARE / (1 - OUTLIER_SHARE) / OUTLIER_FACTOR)
    level = odds - fit / 2 - np.linalg.slogdet(inverse)[1] / 2
    share = np.exp(level - level.max())
    share /= share.sum()
    mean = share @ means
    shift = means - mean
    return Posterior(
        mean, np.einsum("s,sij->ij", share, covariance + shift[:, :, None] * shift[:, None, :]), share @ outliers
    )
