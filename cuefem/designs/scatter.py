"""Tolerance analysis: uncertainty propagation from wood, turning and strokes to responses, with Sobol indices.

The ranges of a study are distributions: `Normal`, `Span` (uniform; of the logarithm if logarithmic), `Levels` (equally
likely). Normal scores z = L n, with n independent standard normal and L L' the correlation matrix (a Gaussian copula),
determine the parameters: each is the quantile of its range at the cumulative probability of its score. Sobol indices
need independent factors, so correlated parameters form one factor, a group, and are drawn together. A group's
first-order index is the part of the variance that would vanish if all its parameters were known; its total index is the
part that would remain if all others were known. Single parameters of a group have no indices.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Any

import numpy as np
from scipy.special import ndtr, ndtri

from cuefem.cue import Array
from cuefem.designs.evaluation import shortfalls
from cuefem.designs.sampling import Levels
from cuefem.designs.study import Study, check_column_name
from cuefem.designs.many_designs import Columns
from cuefem.quantity.equality import equal_fields
from cuefem.quantity.fields import check_count

CONFIDENCE, RESAMPLES = 0.95, 400  # of the bootstrapped intervals
CHUNK = 256  # points computed at a time
HALF_CELL = 2.0**-31  # half the spacing of scipy's Sobol points: added, so that no point is 0


@dataclass(frozen=True)
class Scatter:
    """A study whose ranges are distributions, with correlations and groups.

    Parameters
    ----------
    study : Study
        Its ranges are the distributions; its own sample is not used.
    correlations : mapping, optional
        {(name, name): r}, r: correlation of the normal scores, in (-1, 1). A normal range has correlation r (a
        logarithmic one, of its logarithm), apart from truncation. Every range has rank correlation 6/pi asin(r/2).
    groups : mapping, optional
        {name: names of parameters}, each one factor. Correlated parameters must share a group; without one they form a
        group of their own.
    count : int
        Designs per base sample: a power of two, at least 2. The analysis evaluates (factors + 2) count designs.
    seed : int
        Of the samples, at least 0.

    Raises
    ------
    TypeError
        If count or seed is no whole number.
    ValueError
        If count or seed is out of bounds; a name is unknown; a correlation is out of bounds, listed twice, or of a list
        of values; the correlation matrix is not positive definite; a parameter is in two groups; a group separates
        correlated parameters; or two factors have one name.

    Examples
    --------
    >>> import cuefem as cf
    >>> cue = cf.Cue((cf.Segment(0.7, 0.012, 0.021, cf.material("hard maple")),), body_mass=0.42)
    >>> E, rho = (cf.Vary(f"wood.{name}", cf.Normal(1.0, 0.1), factor=True) for name in ("E", "rho"))
    >>> study = cf.Study(cf.Scene(cue), (E, rho), (cf.Response("end_mass"),))
    >>> cf.Scatter(study, correlations={("wood.E", "wood.rho"): 0.6}, count=64).factors
    ('wood.E + wood.rho',)
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
            power = 1 << (self.count.bit_length() - 1)
            raise ValueError(f"count must be a power of two; got {self.count}: take {power} or {2 * power}")
        pairs: set[frozenset[str]] = set()
        for pair, r in self.correlations.items():
            self._check_names("a correlation", pair)
            levels = [name for name in pair if isinstance(self.study.vary[self.names.index(name)].range, Levels)]
            if levels:
                raise ValueError(f"a correlation must be between numbers; got {levels[0]!r}, which is a list of values")
            if frozenset(pair) in pairs or len(set(pair)) != 2:
                raise ValueError(f"a correlation must be of two numbers, listed once; got {' and '.join(pair)}")
            if not -1 < r < 1:
                raise ValueError(f"the correlation of {' and '.join(pair)} must be in (-1, 1); got {r}")
            pairs.add(frozenset(pair))
        if np.linalg.eigvalsh(self.correlation_matrix)[0] < 1e-9:
            raise ValueError("the correlations must have a positive definite matrix: some contradict others")
        self._check_groups()

    def _check_groups(self) -> None:
        grouped = [name for names in self.groups.values() for name in names]
        for group, names in self.groups.items():
            check_column_name("a group", group)
            self._check_names(f"group {group!r}", names)
        repeated = [name for name in grouped if grouped.count(name) > 1]
        if repeated:
            raise ValueError(f"a parameter must be in one group; got {repeated[0]!r} in two")
        for indices in self.factor_indices:
            correlated = {self.names[i] for i in indices}
            for group, names in self.groups.items():
                if correlated & set(names) and correlated != set(names):
                    missing = ", ".join(sorted(correlated - set(names)))
                    raise ValueError(f"group {group!r} must include all correlated parameters; it lacks {missing}")
        if len(set(self.factors)) < len(self.factor_indices):
            raise ValueError(f"factors must have different names; got {', '.join(self.factors)}")

    def _check_names(self, owner: str, names: tuple[str, ...]) -> None:
        for name in names:
            if name not in self.names:
                valid = ", ".join(self.names)
                raise ValueError(f"{owner} must name parameters of the study, {valid}; got {name!r}")

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the parameters."""
        return tuple(vary.name for vary in self.study.vary)

    @cached_property
    def correlation_matrix(self) -> Array:
        """Correlations of the normal scores, (parameters, parameters)."""
        matrix = np.eye(len(self.names))
        for (first, other), r in self.correlations.items():
            i, j = self.names.index(first), self.names.index(other)
            matrix[i, j] = matrix[j, i] = r
        return matrix

    @cached_property
    def factor_indices(self) -> tuple[tuple[int, ...], ...]:
        """Parameter indices of each factor, in order of the first parameter."""
        connected = self.correlation_matrix != 0  # (i, j): in one factor
        for names in self.groups.values():
            rows = [self.names.index(name) for name in names]
            connected[np.ix_(rows, rows)] = True
        for _ in self.names:  # transitive closure
            connected = connected @ connected
        return tuple(dict.fromkeys(tuple(int(i) for i in np.flatnonzero(row)) for row in connected))

    @property
    def factors(self) -> tuple[str, ...]:
        """Names of the independent factors: groups and single parameters."""
        groups = {self.names.index(name): group for group, names in self.groups.items() for name in names}
        return tuple(groups.get(each[0], " + ".join(self.names[i] for i in each)) for each in self.factor_indices)

    @property
    def sobol_study(self) -> Study:
        """The study of (factors + 2) ``count`` designs: two independent samples, and for each factor the first sample
        with the factor's parameters from the second."""
        return replace(self.study, sample=_Points(self))


@dataclass(frozen=True)
class _Points:
    """Cumulative probabilities of the parameters: two samples of a scrambled Sobol sequence, then the mixed ones."""

    scatter: Scatter

    @property
    def count(self) -> int:
        return (len(self.scatter.factors) + 2) * self.scatter.count

    def points(self, dimensions: int) -> Iterator[list[float]]:
        from scipy.stats import qmc  # loaded when used: half a second

        engine = qmc.Sobol(2 * dimensions, seed=np.random.default_rng(self.scatter.seed))
        first, second = np.split(ndtri(engine.random(self.scatter.count) + HALF_CELL), 2, axis=1)
        from_second = (np.isin(np.arange(dimensions), indices) for indices in self.scatter.factor_indices)
        root = np.linalg.cholesky(self.scatter.correlation_matrix)
        for scores in (first, second, *(np.where(columns, second, first) for columns in from_second)):
            for start in range(0, len(scores), CHUNK):
                yield from ndtr(scores[start : start + CHUNK] @ root.T).tolist()


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


def sobol_indices_of(scatter: Scatter, columns: Columns) -> SobolIndices:
    """Sobol indices from the responses of the designs of `Scatter.sobol_study`.

    Estimators of Saltelli et al. (Comput. Phys. Commun. 181 (2010) 259, table 2 b, f) as scipy.stats has them; error
    about 1/sqrt(count) or less, see the intervals. ValueError if a design has no response, with the first reason, or
    if a response is constant.
    """
    failed = columns.failures
    if failed:
        lacks = "; ".join(text for text, _ in shortfalls(scatter.study.responses, columns.values))
        raise ValueError(f"{lacks}: narrow the ranges; first: {failed[min(failed)]}")
    results = columns.values.reshape(-1, scatter.count, len(scatter.study.responses))
    for response, column in zip(scatter.study.responses, np.moveaxis(results[:2], -1, 0), strict=True):
        if column.std() <= 1e-12 * abs(column.mean()):
            raise ValueError(f"{response.name} is constant: no parameter of the study changes it")
    return SobolIndices(scatter.factors, *bootstrap_sobol_indices(results.swapaxes(1, 2), seed=scatter.seed))


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

    def estimate(rows: Any) -> Array:
        """(2, factors, responses): first-order and total indices from some designs of each sample."""
        A, B, *mixed = twice[:, :, rows]
        shares = sobol_indices(func={"f_A": A, "f_B": B, "f_AB": np.array(mixed)}, n=count)
        # scipy drops axes of length 1
        parts = (part.reshape(len(A), len(mixed)).T for part in (shares.first_order, shares.total_order))
        return np.stack([part[:, :-1] for part in parts])

    # scipy's own bootstrap of the indices takes no seed
    resampled = bootstrap(
        (np.arange(count),),
        estimate,
        vectorized=False,
        method="percentile",
        n_resamples=RESAMPLES,
        confidence_level=CONFIDENCE,
        random_state=np.random.default_rng(seed),
    ).confidence_interval
    (first, total), low, high = estimate(np.arange(count)), resampled.low, resampled.high
    return first, total, np.stack([low[0], high[0]]), np.stack([low[1], high[1]])
