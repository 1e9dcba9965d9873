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
    """A list of values of a parameter.

    Parameters
    ----------
    values : tuple of float or str
        At least one: numbers in SI, or names of materials.

    Raises
    ------
    ValueError
        If there is none.

    Examples
    --------
    >>> import cuefem as cf
    >>> cf.Vary("shaft material", cf.Levels(("hard maple", "ash"))).range.levels
    ('hard maple', 'ash')
    """

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
    """An interval of a parameter, both ends included; a random sample is uniform in it.

    Parameters
    ----------
    low, high : float
        Its ends, SI.
    count : int
        Number of values in a grid, from `low` to `high`; of one, the middle.
    logarithmic : bool
        Equal ratios instead of equal differences.

    Raises
    ------
    ValueError
        If an end is not finite; ``low`` is not below ``high``, or not above 0 where it is logarithmic; or ``count`` is
        out of bounds.

    Examples
    --------
    >>> import cuefem as cf
    >>> cf.Span(0.011, 0.013, count=3).levels, cf.Span(1.0, 4.0, count=3, logarithmic=True).levels
    ((0.011, 0.012, 0.013), (1.0, 2.0, 4.0))
    """

    low: float
    high: float
    count: int = 1
    logarithmic: bool = False

    def __post_init__(self) -> None:
        check_count("count", self.count, 1, MAX_LEVELS)
        if not self.low < self.high:
            raise ValueError(f"low must be below high; got the empty range {self.low} to {self.high}")
        if not (math.isfinite(self.low) and math.isfinite(self.high)):
            raise ValueError(f"low and high must be finite; got {self.low} and {self.high}")
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
    """A normal distribution of a parameter, truncated at four standard deviations; a grid has its median alone.

    Parameters
    ----------
    median : float
        SI.
    sd : float
        Standard deviation, SI, above 0; of the natural logarithm where that is normal.
    logarithmic : bool
        The natural logarithm is normal: ``sd`` is then nearly the coefficient of variation.

    Raises
    ------
    ValueError
        If a number is not finite, ``sd`` is not above 0, or the median of a logarithmic one is not.

    Examples
    --------
    >>> import cuefem as cf
    >>> round(cf.Normal(700.0, 35.0).quantile(0.975)), round(cf.Normal(700.0, 0.05, logarithmic=True).quantile(0.975))
    (769, 772)
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
    """A quasi-random sample of designs instead of the grid: a scrambled Sobol sequence.

    Parameters
    ----------
    count : int
        Number of designs, at least 1.
    seed : int
        At least 0.

    Examples
    --------
    >>> import cuefem as cf
    >>> [[round(number, 2) for number in point] for point in cf.Sample(2, seed=1).points(2)]
    [[0.29, 0.16], [0.58, 0.94]]
    """

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
