"""Statistics of a sweep: which parameter explains which response, and where two responses trade off."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from cuefem.cue import Array
from cuefem.designs.evaluation import Response
from cuefem.designs.study import Study
from cuefem.quantity.equality import equal_fields

MAX_LEVELS = 24  # maximum number of values of a parameter that are separate groups
MAX_GROUPS = 12  # maximum number of groups, each a range, of a parameter with more values
MAX_FRONT_ROWS = 7  # designs of a Pareto front in a table
MIN_TREND = 0.2  # minimum rank correlation of a trend


@dataclass(frozen=True, eq=False)
class SweepStatistics:
    """Designs with any response, and the responses that any of them has.

    names, units: of the parameters. numbers: of the designs. values: of each parameter, numbers or names.
    results: (designs, responses), nan where one is missing. Each statistic is of the designs that have its responses.
    """

    names: tuple[str, ...]
    units: tuple[str, ...]
    responses: tuple[Response, ...]
    numbers: NDArray[np.int_]
    values: tuple[np.ndarray, ...]
    results: Array

    __eq__ = equal_fields

    @cached_property
    def shares(self) -> Array:
        """Part of the variance of each response that each parameter explains alone, (parameters, responses)."""
        shares = [
            [explained_variance(column[rows], self.results[rows, k]) for k, rows in enumerate(self.rows)]
            for column in self.values
        ]
        return np.array(shares)

    def having(self, *responses: int) -> NDArray[np.int_]:
        """Rows of the designs that have all of some responses."""
        return np.flatnonzero(np.isfinite(self.results[:, responses]).all(axis=1))

    @cached_property
    def rows(self) -> list[NDArray[np.int_]]:
        """Rows of the designs that have each response."""
        return [self.having(k) for k in range(len(self.responses))]

    @cached_property
    def trends(self) -> list[list[str]]:
        """ "rises", "falls" or nothing, by parameter and response; squirt by its size."""
        columns = zip(self.responses, self.results.T, strict=True)
        sizes = [response.size(column) for response, column in columns]
        return [
            [_trend(column[rows], size[rows]) for rows, size in zip(self.rows, sizes, strict=True)]
            for column in self.values
        ]

    @cached_property
    def ranked(self) -> list[int]:
        """The responses with a preferred direction, or all responses if none has one."""
        indices = range(len(self.responses))
        return [k for k in indices if self.responses[k].result.better] or [*indices]

    @cached_property
    def losses(self) -> Array:
        """The results as losses, (designs, responses): the lowest is best."""
        columns = zip(self.responses, self.results.T, strict=True)
        return np.stack([response.loss(column) for response, column in columns], axis=1)

    def best(self, k: int) -> int:
        """The row of the best design for a response."""
        return int(np.nanargmin(self.losses[:, k]))

    @cached_property
    def pair(self) -> tuple[int, int] | None:
        """The first ranked response and the one with the strongest trade-off; None if no design has both."""
        first, *ranked = self.ranked
        common = {k: rows for k in ranked if len(rows := self.having(first, k))}
        correlations = {k: _rank_correlation(*self.losses[rows][:, [first, k]].T) for k, rows in common.items()}
        return (first, min(correlations, key=correlations.__getitem__)) if correlations else None

    @cached_property
    def front(self) -> list[int]:
        """Rows on the Pareto front of the pair of responses, in order of the first."""
        if self.pair is None:
            return []
        rows = self.having(*self.pair)
        first, second = self.losses[rows][:, self.pair].T
        order = np.lexsort((second, first))
        least = np.minimum.accumulate(second[order])
        return rows[order[np.r_[True, least[1:] < least[:-1]]]].tolist()

    @cached_property
    def shown_front(self) -> list[int]:
        """At most `MAX_FRONT_ROWS` rows of the front, evenly spaced."""
        count = len(self.front)
        picked = np.unique(np.linspace(0, count - 1, min(MAX_FRONT_ROWS, count)).round().astype(int))
        return [self.front[j] for j in picked]


def sweep_statistics(study: Study, designs: Mapping[str, np.ndarray], results: Array) -> SweepStatistics | None:
    """The statistics of a sweep; None if no design has a response.

    designs: values of each parameter by its name. results: (designs, responses), nan where one is missing.
    """
    finite = np.isfinite(results)
    numbers, found = np.flatnonzero(finite.any(axis=1)), np.flatnonzero(finite.any(axis=0))
    if len(numbers) == 0:
        return None
    columns = tuple(column[numbers] for column in designs.values())
    names, units = (texts[: len(columns)] for texts in (study.columns, study.units))
    responses = tuple(study.responses[k] for k in found)
    return SweepStatistics(names, units, responses, numbers, columns, results[np.ix_(numbers, found)])


def explained_variance(column: np.ndarray, results: Array) -> float:
    """Variance of the means over equal values, or over ranges of values, over the total variance.

    For ranges it is corrected for the share expected by chance.
    """
    group, chance = groups_of(column)
    member = np.eye(group.max() + 1)[group]
    between = np.var(member @ ((member.T @ results) / member.sum(axis=0)))
    total = np.var(results)
    share = float(between / total) if total > 0 else 0.0
    count, groups = member.shape
    return min(max(1 - (1 - share) * (count - 1) / (count - groups), 0.0), 1.0) if chance else share


def groups_of(column: np.ndarray) -> tuple[NDArray[np.int_], bool]:
    """The number of the group of each value, and whether groups are ranges of values: else of equal ones."""
    levels, group = np.unique(column, return_inverse=True)
    if len(levels) <= MAX_LEVELS or column.dtype.kind not in "fi":
        return group, False
    count = max(2, min(MAX_GROUPS, len(column) // 8))
    edges = np.quantile(column, np.arange(1, count) / count)
    return np.unique(np.searchsorted(edges, column, side="right"), return_inverse=True)[1], True


def _rank_correlation(first: Array, other: Array) -> float:
    ranks = [np.unique(values, return_inverse=True)[1] for values in (first, other)]
    return float(np.asarray(np.corrcoef(ranks))[0, 1]) if all(rank.any() for rank in ranks) else 0.0


def _trend(column: np.ndarray, result: Array) -> str:
    correlation = _rank_correlation(column, result) if column.dtype.kind in "fi" else 0.0
    return "rises" if correlation > MIN_TREND else "falls" if correlation < -MIN_TREND else ""
