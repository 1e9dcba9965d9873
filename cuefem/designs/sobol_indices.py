"""Sobol indices: the part of each response's variance due to each factor, with intervals, where there are any."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from cuefem.cue import Array
from cuefem.quantity.equality import equal_fields

CONFIDENCE, RESAMPLES = 0.95, 400  # of the bootstrapped intervals
CONSTANT = 1e-12  # relative range of a response that no parameter changes


@dataclass(frozen=True, eq=False)
class SobolIndices:
    """Sobol indices: the part of each response's variance due to each factor.

    Parameters
    ----------
    factors : tuple of str
        Names of groups and of single parameters.
    first, total : ndarray
        First-order and total indices, (factors, responses).
    first_interval, total_interval : ndarray
        Ends of their 95 % intervals by bootstrap, (2, factors, responses).
    """

    factors: tuple[str, ...]
    first: Array
    total: Array
    first_interval: Array
    total_interval: Array

    __eq__ = equal_fields

    @property
    def are_valid(self) -> NDArray[np.bool_]:
        """Whether each response has indices, (responses,)."""
        return np.asarray(np.isfinite(self.total).all(axis=0))

    @property
    def is_any_outside(self) -> bool:
        """Whether an estimate is below 0 or above 1, which no share is."""
        estimates = np.stack([self.first, self.total])
        return bool(((estimates < 0) | (estimates > 1)).any())


def is_constant(values: Array) -> NDArray[np.bool_]:
    """Whether each column of numbers (designs, n) is the same in all designs that have it, to round-off."""
    low, high = np.fmin.reduce(values), np.fmax.reduce(values)
    return np.asarray(high - low <= CONSTANT * np.fmax(abs(low), abs(high)))


def sobol_indices_of(factors: tuple[str, ...], count: int, seed: int, values: Array) -> SobolIndices:
    """Sobol indices from numbers (designs, n): of two samples of ``count`` designs, and of a mixed one for each factor.

    Estimators of Saltelli et al. (Comput. Phys. Commun. 181 (2010) 259, table 2 b, f) as scipy.stats has them; error
    about 1/sqrt(count) or less, see the intervals. nan for a constant number, and for one that a design lacks: the
    factors of the other designs are not independent.
    """
    found = np.flatnonzero(np.isfinite(values).all(axis=0) & ~is_constant(values))
    shape = len(factors), values.shape[1]
    parts = [np.full(shape, np.nan), np.full(shape, np.nan), np.full((2, *shape), np.nan), np.full((2, *shape), np.nan)]
    if len(found):
        samples = values[:, found].reshape(-1, count, len(found)).swapaxes(1, 2)
        for part, estimate in zip(parts, bootstrap_sobol_indices(samples, seed=seed), strict=True):
            part[..., found] = estimate
    return SobolIndices(factors, *parts)


def bootstrap_sobol_indices(values: Array, *, seed: int) -> tuple[Array, Array, Array, Array]:
    """First-order and total Sobol indices with their intervals.

    Parameters
    ----------
    values : ndarray
        Responses of both samples and of the mixed ones, (2 + factors, responses, count).
    seed : int
        Of the bootstrap.

    Returns
    -------
    first, total : ndarray
        (factors, responses).
    first_interval, total_interval : ndarray
        (2, factors, responses).
    """
    from scipy.stats import bootstrap, sobol_indices

    count = values.shape[-1]
    # scipy fails for one factor and one response: with the first response once more there are at least two
    twice = np.concatenate([values, values[:, :1]], axis=1)

    def indices_of(rows: Any) -> Array:
        """(2, factors, responses): first-order and total indices from some designs of each sample."""
        A, B, *mixed = twice[:, :, rows]
        shares = sobol_indices(func={"f_A": A, "f_B": B, "f_AB": np.array(mixed)}, n=count)
        # scipy drops axes of length 1
        parts = (part.reshape(len(A), len(mixed)).T for part in (shares.first_order, shares.total_order))
        return np.stack([part[:, :-1] for part in parts])

    # scipy's own bootstrap of the indices takes no seed
    resampled = bootstrap(
        (np.arange(count),),
        indices_of,
        vectorized=False,
        method="percentile",
        n_resamples=RESAMPLES,
        confidence_level=CONFIDENCE,
        random_state=np.random.default_rng(seed),
    ).confidence_interval
    (first, total), low, high = indices_of(np.arange(count)), resampled.low, resampled.high
    return first, total, np.stack([low[0], high[0]]), np.stack([low[1], high[1]])
