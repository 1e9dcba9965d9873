"""Tolerance analysis: uncertainty propagation from wood, turning and strokes to responses, with Sobol indices.

The ranges of a study are distributions: `Normal`, `Span` (uniform; of the logarithm if logarithmic), `Levels` (equally
likely). Normal scores z = L n, with n independent standard normal and L L' the correlation matrix (a Gaussian copula),
determine the parameters: each is the quantile of its range at the cumulative probability of its score. Sobol indices
need independent factors, so correlated parameters form one factor, a group, and are drawn together. A group's
first-order index is the part of the variance that would vanish if all its parameters were known; its total index is the
part that would remain if all others were known. Single parameters of a group have no indices.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Any, ClassVar

import numpy as np
from scipy.special import ndtr, ndtri

from cuefem.cue import Array
from cuefem.designs.evaluation import Response, shortfalls
from cuefem.designs.many_designs import Columns
from cuefem.designs.sampling import Levels
from cuefem.designs.study import Study, check_column_name
from cuefem.designs.study_result import CHART_HEIGHT, ROW_HEIGHT, ROWS_END, StudyResult
from cuefem.designs.study_table import shown
from cuefem.quantity.display_units import display_unit, to_display
from cuefem.quantity.equality import equal_fields
from cuefem.quantity.fields import check_count
from cuefem.results.records import Record, Table
from cuefem.show.charts import Axis, Chart, Curve, Dots, Tick, chart

CONFIDENCE, RESAMPLES = 0.95, 400  # of the bootstrapped intervals
CHUNK = 256  # points computed at a time
MIN_SHARE = 0.01  # of the variance, of a factor that is named among the strongest
MAX_BINS = 40  # of a histogram
QUANTILES = ("5 %", "50 %", "95 %")  # marked in it
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
    def all_designs(self) -> Study:
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
    """Sobol indices from the responses of the designs of `Scatter.all_designs`.

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


@dataclass(frozen=True, repr=False)
class ScatterResult(StudyResult):
    """The result of a tolerance analysis: the spread of each response, and the share of each factor in it.

    Parameters
    ----------
    sobol_indices : SobolIndices
        Sobol indices of each response.
    """

    sobol_indices: SobolIndices = field(repr=False)
    definition: Scatter
    kind: ClassVar[str] = "scatter"

    def _independent(self) -> int:
        """The two independent samples; the other designs mix them."""
        return 2 * self.definition.count

    def values(self) -> Record:
        """The distribution of each response, and the shares of its factors."""
        about = {"count": self.definition.count, "seed": self.definition.seed}
        return about | {"responses": scatter_record(self.study, self.spread, self.sobol_indices)}

    def charts(self) -> list[Chart]:
        """The distribution of each response, and the share of each factor in its variance."""
        return scatter_charts(self.study.responses, self.finite_samples, self.spread, self.sobol_indices)

    def tables(self) -> list[Table | str]:
        """Varied parameters, spreads, and the shares of the factors."""
        return [*super().tables(), *tabulate_scatter(self.definition, self.spread, self.sobol_indices)]


def scatter_record(study: Study, spread: Mapping[str, Mapping[str, float]], drivers: SobolIndices) -> Record:
    """The distribution of each response, and the shares of its factors in the variance."""
    parts = ("first", "first_interval", "total", "total_interval")
    return {
        response.name: {
            "unit": response.unit,
            **spread[response.name],
            "factors": {
                factor: {part: getattr(drivers, part)[..., i, k] for part in parts}
                for i, factor in enumerate(drivers.factors)
            },
        }
        for k, response in enumerate(study.responses)
    }


def tabulate_scatter(
    scatter: Scatter, spread: Mapping[str, Mapping[str, float]], drivers: SobolIndices
) -> list[Table | str]:
    """The spread of each response, the shares of its factors, and a sentence on both."""
    spreads, rows, bold, lines = list[tuple[str, ...]](), list[tuple[str, ...]](), dict[int, str](), list[str]()
    for k, response in enumerate(scatter.study.responses):
        numbers = {name: shown(value, response.display_key) for name, value in spread[response.name].items()}
        spreads.append((response.heading, *numbers.values()))
        bold[len(rows)] = "bold"
        rows.append((response.label, "", ""))
        strongest = drivers.total[:, k].argsort()[::-1]
        for i in strongest:
            both = ((drivers.first, drivers.first_interval), (drivers.total, drivers.total_interval))
            rows.append((f"  {drivers.factors[i]}", *(_share(value[i, k], ends[:, i, k]) for value, ends in both)))
        total = np.clip(drivers.total[:, k], 0.0, 1.0)  # an estimate may be outside
        most = [f"{drivers.factors[i]} ({100 * total[i]:.0f} %)" for i in strongest[:2] if total[i] >= MIN_SHARE]
        unit = display_unit(response.display_key).name
        ends = f"{response.label}: 90 % of the designs from {numbers['5 %']} to {numbers['95 %']} {unit}".rstrip()
        named = f"the strongest factor{'s are' if len(most) > 1 else ' is'} {' and '.join(most)}"
        lines.append(f"{ends}; {named if most else 'no factor stands out'}")
    quantiles = "column 5 %: 5 % of the designs are below this value; sd: standard deviation"
    notes = (
        "first-order: share of the variance that disappears if this factor is known; total: share that remains if all "
        "other factors are known",
        "in parentheses 95 % intervals by bootstrap",
        *(f"{factor}: {', '.join(names)}" for factor, names in scatter.groups.items()),
    )
    return [
        Table(
            f"Spread of {2 * scatter.count} designs, the two independent samples",
            ("response", *numbers),
            tuple(spreads),
            (quantiles,),
        ),
        Table(
            "Sensitivity: share of the variance, %",
            ("response, factor", "first-order", "total"),
            tuple(rows),
            notes,
            styles=bold,
        ),
        *lines,
    ]


def _share(value: float, ends: Any) -> str:
    low, high = (100 * float(end) for end in ends)
    return f"{100 * value:.1f} ({low:.1f} to {high:.1f})"


def scatter_charts(
    responses: Sequence[Response],
    samples: Mapping[str, Array],
    spread: Mapping[str, Mapping[str, float]],
    drivers: SobolIndices,
) -> list[Chart]:
    """The distribution of each response, and the share of each factor in its variance.

    samples: finite responses of the two independent samples, by name.
    """
    charts = []
    for k, response in enumerate(responses):
        if response.name in spread:
            charts += [
                _histogram(response, samples[response.name], spread[response.name]),
                _factors_chart(response, drivers, k),
            ]
    return charts


def _histogram(response: Response, sample: Array, spread: Mapping[str, float]) -> Chart:
    """The share of the designs in equal intervals of a response."""
    values = to_display(sample, response.display_key)
    bins = min(MAX_BINS, len(np.histogram_bin_edges(values, "auto")) - 1)
    counts, edges = np.histogram(values, bins)
    outline = np.r_[0.0, np.repeat(100 * counts / len(values), 2), 0.0]
    marks = [Tick(float(to_display(spread[name], response.display_key)), name) for name in QUANTILES]
    return chart(
        f"Distribution: {response.label}",
        [Curve("share of the designs", np.repeat(edges, 2), outline, "c1 bars")],
        x=Axis(response.heading, from_zero=False),
        y=Axis("designs in %", 0.0),
        marks=marks,
        height=CHART_HEIGHT,
    )


def _factors_chart(response: Response, drivers: SobolIndices, k: int) -> Chart:
    """The total index of each factor with its interval, the strongest on top."""
    order = drivers.total[:, k].argsort()
    share, interval = 100 * drivers.total[order, k], 100 * drivers.total_interval[:, order, k]
    rows = np.arange(len(order))
    gaps = np.full(len(order), np.nan)
    lines = Curve("95 % interval", np.stack([*interval, gaps]).T, np.stack([rows, rows, gaps]).T, "c1")
    return chart(
        f"Factors: {response.label}",
        [lines],
        x=Axis("total share of the variance, %", 0.0),
        y=Axis("factor", names=tuple(drivers.factors[i] for i in order)),
        points=[Dots("share", share, rows, "c1")],
        height=ROW_HEIGHT * len(order) + ROWS_END,
    )
