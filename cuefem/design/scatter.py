"""Tolerance analysis: uncertainty propagation from wood, turning and strokes to responses, with Sobol indices.

The ranges of a study (`cuefem.design`) are distributions: `Normal`, `Span` (uniform), `Levels` (equally likely). Normal
scores z = L n, n independent and L L' their correlations (a Gaussian copula), determine the numbers: the quantile of
each range at the cumulative probability of z. Sobol indices need independent causes, so correlated numbers are one
cause, a group, and are drawn together. A group's first-order index is the part of the variance that would vanish if all
its numbers were known; its total index is the part that would remain if all other numbers were known. Single numbers of
a group have no index of their own.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Any

import numpy as np
from scipy.special import ndtr, ndtri

from cuefem.cue import Array
from cuefem.design.sampling import Levels
from cuefem.design.study import Study
from cuefem.design.sweep import Row
from cuefem.quantity.fields import check_count

CONFIDENCE, RESAMPLES = 0.95, 400  # of the bootstrapped intervals
HALF_CELL = 2.0**-31  # of scipy's Sobol points, so that none is 0


@dataclass(frozen=True)
class Scatter:
    """A study whose ranges are distributions, with correlations and groups.

    Parameters
    ----------
    study : Study
        Its ranges are the distributions; its own sample is not used.
    correlations : mapping, optional
        {(name, name): r}, with r in (-1, 1) between the normal scores of two numbers. For normal numbers, and for the
        logarithms of logarithmic ones, r is the correlation itself; other numbers have the rank correlation
        6/pi asin(r/2).
    groups : mapping, optional
        {name: names of parameters}, each one cause. Correlated numbers must share a group; without one
        they form a group of their own.
    count : int
        Designs of a sample, a power of two.
    seed : int
        Of the samples.

    Raises
    ------
    ValueError
        If a name is unknown, the correlation matrix is not positive definite, or a group separates correlated numbers.
    """

    study: Study
    correlations: Mapping[tuple[str, str], float] = field(default_factory=dict)
    groups: Mapping[str, tuple[str, ...]] = field(default_factory=dict)
    count: int = 256
    seed: int = 0

    def __post_init__(self) -> None:
        check_count("count", self.count, 2)
        check_count("seed", self.seed, 0)
        if self.count & (self.count - 1):
            near = 1 << (self.count.bit_length() - 1)
            raise ValueError(f"count must be a power of two; got {self.count}: take {near} or {2 * near}")
        pairs: set[frozenset[str]] = set()
        for pair, r in self.correlations.items():
            self._check_names("a correlation", pair)
            lists = [name for name in pair if isinstance(self.study.vary[self.names.index(name)].range, Levels)]
            if lists:
                raise ValueError(f"a correlation must be between numbers; got {lists[0]!r}, which is a list of values")
            if frozenset(pair) in pairs or len(set(pair)) != 2:
                raise ValueError(f"a correlation must be of two numbers, listed once; got {' and '.join(pair)}")
            if not -1 < r < 1:
                raise ValueError(f"the correlation of {' and '.join(pair)} must be in (-1, 1); got {r}")
            pairs.add(frozenset(pair))
        if np.linalg.eigvalsh(self.matrix)[0] < 1e-9:
            raise ValueError("the correlations must have a positive definite matrix: some contradict others")
        self._check_groups()

    def _check_groups(self) -> None:
        grouped = [name for names in self.groups.values() for name in names]
        for group, names in self.groups.items():
            self._check_names(f"group {group!r}", names)
        twice = [name for name in grouped if grouped.count(name) > 1]
        if twice:
            raise ValueError(f"a parameter must be in one group; got {twice[0]!r} in two")
        for members in self.members:
            own = {self.names[i] for i in members}
            for group, names in self.groups.items():
                if own & set(names) and own != set(names):
                    missing = ", ".join(sorted(own - set(names)))
                    raise ValueError(f"group {group!r} must include all correlated parameters; it lacks {missing}")
        if len(set(self.causes)) < len(self.members):
            raise ValueError(f"causes must have different names; got {', '.join(self.causes)}")

    def _check_names(self, what: str, names: tuple[str, ...]) -> None:
        for name in names:
            if name not in self.names:
                known = ", ".join(self.names)
                raise ValueError(f"{what} must name parameters of the study, {known}; got {name!r}")

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the parameters."""
        return tuple(vary.name for vary in self.study.vary)

    @cached_property
    def matrix(self) -> Array:
        """Correlations of the normal scores, (vary, vary)."""
        matrix = np.eye(len(self.names))
        for (first, other), r in self.correlations.items():
            i, j = self.names.index(first), self.names.index(other)
            matrix[i, j] = matrix[j, i] = r
        return matrix

    @cached_property
    def members(self) -> tuple[tuple[int, ...], ...]:
        """Parameter indices of each cause, in order of the first."""
        joined = self.matrix != 0
        for names in self.groups.values():
            rows = [self.names.index(name) for name in names]
            joined[np.ix_(rows, rows)] = True
        for _ in self.names:  # transitive closure
            joined = joined @ joined
        return tuple(dict.fromkeys(tuple(int(i) for i in np.flatnonzero(row)) for row in joined))

    @property
    def causes(self) -> tuple[str, ...]:
        """Names of the independent causes: groups and single parameters."""
        groups = {self.names.index(name): group for group, names in self.groups.items() for name in names}
        return tuple(groups.get(each[0], " + ".join(self.names[i] for i in each)) for each in self.members)

    @property
    def designs(self) -> Study:
        """The study of the designs for Sobol indices: two independent samples, and the first with each cause in turn
        from the second."""
        return replace(self.study, sample=_Points(self))


@dataclass(frozen=True)
class _Points:
    """Cumulative probabilities of the parameters: a scrambled Sobol sequence for both samples, then the mixed ones."""

    scatter: Scatter

    @property
    def count(self) -> int:
        return (len(self.scatter.causes) + 2) * self.scatter.count

    def points(self, dimensions: int) -> Iterator[list[float]]:
        from scipy.stats import qmc  # loaded when used: half a second

        engine = qmc.Sobol(2 * dimensions, seed=np.random.default_rng(self.scatter.seed))
        first, other = np.split(ndtri(engine.random(self.scatter.count) + HALF_CELL), 2, axis=1)
        drawn = (np.isin(np.arange(dimensions), cause) for cause in self.scatter.members)
        scores = np.concatenate([first, other, *(np.where(cause, other, first) for cause in drawn)])
        yield from ndtr(scores @ np.linalg.cholesky(self.scatter.matrix).T).tolist()


@dataclass(frozen=True)
class SobolIndices:
    """Sobol indices: the part of each response's variance due to each cause.

    first, total: (causes, responses). first_interval, total_interval: (2, causes, responses), bootstrapped, 95 %.
    """

    causes: tuple[str, ...]
    first: Array
    total: Array
    first_interval: Array
    total_interval: Array


def sobol_indices_of(scatter: Scatter, rows: Sequence[Row]) -> SobolIndices:
    """Sobol indices from the rows of `Scatter.designs`.

    Estimators of Saltelli et al. (Comput. Phys. Commun. 181 (2010) 259, table 2 b, f) as scipy.stats has them; error
    about 1/sqrt(count) or less, see the intervals. ValueError if a design has no response, with the first reason, or
    if a response is constant.
    """
    failed = [row.failure for row in rows if row.failure]
    if failed:
        raise ValueError(f"{len(failed)} of {len(rows)} designs failed: narrow the ranges; first: {failed[0]}")
    results = np.array([row.responses for row in rows]).reshape(-1, scatter.count, len(scatter.study.responses))
    for response, column in zip(scatter.study.responses, np.moveaxis(results[:2], -1, 0), strict=True):
        if column.std() <= 1e-12 * abs(column.mean()):
            raise ValueError(f"{response.name} is constant: no parameter of the study changes it")
    return SobolIndices(scatter.causes, *indices(results.swapaxes(1, 2), seed=scatter.seed))


def indices(values: Array, *, seed: int) -> tuple[Array, Array, Array, Array]:
    """(first, total, interval of the first, of the total) from the values (2 + causes, responses, count) of the two
    samples and the mixed ones: each (causes, responses), intervals with low and high before."""
    from scipy.stats import bootstrap, sobol_indices

    count = values.shape[-1]

    def both(rows: Any) -> Array:
        A, B, *mixed = values[:, :, rows]
        shares = sobol_indices(func={"f_A": A, "f_B": B, "f_AB": np.array(mixed)}, n=count)
        # scipy drops axes of length 1
        return np.stack([part.reshape(len(A), len(mixed)).T for part in (shares.first_order, shares.total_order)])

    # scipy's own bootstrap of the indices takes no seed
    resampled = bootstrap(
        (np.arange(count),),
        both,
        vectorized=False,
        method="percentile",
        n_resamples=RESAMPLES,
        confidence_level=CONFIDENCE,
        random_state=np.random.default_rng(seed),
    ).confidence_interval
    (first, total), low, high = both(np.arange(count)), resampled.low, resampled.high
    return first, total, np.stack([low[0], high[0]]), np.stack([low[1], high[1]])
