"""Ranges of values and sampling of designs: lists, intervals, distributions, quasi-random samples."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from statistics import NormalDist

import numpy as np

from cuefem.quantity.fields import check_count

MAX_POINTS = 2**30  # points of a Sobol sequence of 30 bits
MAX_LEVELS = 2**20  # of an interval
BLOCK = 256  # points computed at a time
CUT_DEVIATIONS = 4.0  # standard deviations at which a normal distribution is truncated: reduces its sd by 0.05 %
STANDARD = NormalDist()

Value = float | str


@dataclass(frozen=True)
class Levels:
    """A list of values: numbers in SI, or names of materials."""

    values: tuple[Value, ...]

    def __post_init__(self) -> None:
        if not self.values:
            raise ValueError("values must hold at least one; got an empty range")

    @property
    def levels(self) -> tuple[Value, ...]:
        """The values of a grid."""
        return self.values

    def quantile(self, u: float) -> Value:
        """The value at ``u`` in [0, 1) of the list."""
        return self.values[min(int(u * len(self.values)), len(self.values) - 1)]

    @property
    def ends(self) -> tuple[Value, ...]:
        """All values: any may be the extreme one."""
        return self.values


@dataclass(frozen=True)
class Span:
    """An interval of numbers in SI, both ends included; a grid has ``count`` values, in equal ratios if logarithmic."""

    low: float
    high: float
    count: int = 1
    logarithmic: bool = False

    def __post_init__(self) -> None:
        check_count("count", self.count, 1, MAX_LEVELS)
        if not self.low < self.high:
            raise ValueError(f"low must be below high; got the empty range {self.low} to {self.high}")
        if self.logarithmic and self.low <= 0:
            raise ValueError(f"low must be above 0 where the spacing is logarithmic; got {self.low}")

    @property
    def levels(self) -> tuple[float, ...]:
        """The ``count`` values of a grid; the middle if there is only one."""
        last = self.count - 1
        return tuple(self.quantile(i / last) for i in range(self.count)) if last else (self.quantile(0.5),)

    def quantile(self, u: float) -> float:
        """The value at ``u`` in [0, 1] of the interval."""
        if u in (0.0, 1.0):  # exactly
            return self.ends[int(u)]
        if self.logarithmic:
            return math.exp((1 - u) * math.log(self.low) + u * math.log(self.high))
        return (1 - u) * self.low + u * self.high

    def share(self, value: float) -> float:
        """The inverse of `quantile`, clipped to [0, 1]."""
        low, high, at = (math.log(x) if self.logarithmic else x for x in (self.low, self.high, value))
        return min(max((at - low) / (high - low), 0.0), 1.0)

    @property
    def ends(self) -> tuple[float, ...]:
        """The two ends."""
        return self.low, self.high


@dataclass(frozen=True)
class Normal:
    """A normal distribution of numbers in SI, truncated at `CUT_DEVIATIONS` standard deviations; a grid has its median.

    logarithmic: the number's natural logarithm is normal. Then ``median`` is its own, and ``sd`` a pure number, that
    of the logarithm: nearly the coefficient of variation.
    """

    median: float
    sd: float
    logarithmic: bool = False

    def __post_init__(self) -> None:
        if not (math.isfinite(self.median) and math.isfinite(self.sd) and self.sd > 0):
            raise ValueError(f"sd must be above 0, and it and the median finite; got {self.median} and {self.sd}")
        if self.logarithmic and self.median <= 0:
            raise ValueError(f"median must be above 0 where the spacing is logarithmic; got {self.median}")

    @property
    def levels(self) -> tuple[float, ...]:
        """The median: the only value of a grid."""
        return (self.median,)

    def quantile(self, u: float) -> float:
        """The value below which a share ``u`` in [0, 1] of all lies."""
        if u in (0.0, 1.0):  # exactly
            return self.ends[int(u)]
        tail = STANDARD.cdf(-CUT_DEVIATIONS)
        return self._at(STANDARD.inv_cdf(tail + u * (1 - 2 * tail)))

    @property
    def ends(self) -> tuple[float, ...]:
        """The truncation limits."""
        return self._at(-CUT_DEVIATIONS), self._at(CUT_DEVIATIONS)

    def _at(self, deviations: float) -> float:
        deviation = self.sd * deviations
        return self.median * math.exp(deviation) if self.logarithmic else self.median + deviation


@dataclass(frozen=True)
class Sample:
    """A quasi-random sample of ``count`` designs instead of the grid: a scrambled Sobol sequence."""

    count: int
    seed: int

    def __post_init__(self) -> None:
        check_count("count", self.count, 1, MAX_POINTS)
        check_count("seed", self.seed, 0)

    def points(self, dimensions: int) -> Iterator[list[float]]:
        """The points of the designs, each of numbers in [0, 1)."""
        from scipy.stats import qmc  # loaded when used: half a second

        engine = qmc.Sobol(dimensions, seed=np.random.default_rng(self.seed))
        for start in range(0, self.count, BLOCK):  # whole blocks: powers of two keep the points balanced
            yield from engine.random(BLOCK)[: self.count - start].tolist()
