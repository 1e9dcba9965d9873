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
from typing import Any, ClassVar, NamedTuple

import numpy as np
from scipy.special import ndtr, ndtri

from cuefem.cue import Array
from cuefem.designs.evaluation import Response
from cuefem.designs.many_designs import Columns
from cuefem.designs.sampling import Levels
from cuefem.designs.sobol_indices import CONFIDENCE, SobolIndices, is_constant, sobol_indices_of
from cuefem.designs.study import Study, check_column_name
from cuefem.designs.study_result import CHART_HEIGHT, ROW_HEIGHT, ROWS_END, SHARES, StudyResult
from cuefem.designs.study_table import shown
from cuefem.quantity.display_units import display_unit, to_display, with_unit
from cuefem.quantity.fields import check_count
from cuefem.results.records import Record, Table
from cuefem.show.charts import Axis, Chart, Curve, Dots, Tick, chart

CHUNK = 256  # points computed at a time
MIN_SHARE = 0.01  # of the variance, of a factor that is named among the strongest
MAX_BINS = 40  # of a histogram
QUANTILES = ("5 %", "50 %", "95 %")  # marked in it
QUANTILE_NAMES = tuple(f"{100 * share:g} %" for share in SHARES)
QUANTILE_NOTE = "column 5 %: 5 % of the designs are below this value; sd: standard deviation"
INDEX_NOTES = (
    "first-order: share of the variance that disappears if this factor is known; total: share that remains if all "
    "other factors are known",
    "in parentheses 95 % intervals by bootstrap",
)
NO_SHARES = "no shares of factors, since designs lack it"
OUTSIDE_NOTE = "a share below 0 or above 100 % is the error of its estimate: a larger count reduces it"
MIN_LACKING = 10  # designs without a response, of whose lack there are Sobol indices
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

    def calibrated(self, squirt_factor: float) -> Scatter:
        """The same with another squirt factor."""
        return replace(self, study=self.study.calibrated(squirt_factor))

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

    def sobol_indices(self, values: Array) -> SobolIndices:
        """Sobol indices of numbers of all designs, (designs, n)."""
        return sobol_indices_of(self.factors, self.count, self.seed, values)


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


class Missing(NamedTuple):
    """The designs that lack a response: its column, their share of the two independent samples with its 95 % interval
    (Wilson), and the Sobol indices of the lack, a number 1 or 0 (nan if fewer than `MIN_LACKING` lack or have it).
    """

    column: int
    share: float
    interval: tuple[float, float]
    indices: SobolIndices


def missing_responses(scatter: Scatter, values: Array) -> list[Missing]:
    """The responses that designs lack, from the responses of all designs, (designs, responses)."""
    from scipy.stats import binomtest  # loaded when used: half a second

    found, n = list[Missing](), 2 * scatter.count
    for k in np.flatnonzero(np.isnan(values).any(axis=0)).tolist():
        lacks = np.isnan(values[:, [k]]).astype(float)
        count = int(lacks[:n].sum())
        interval = binomtest(count, n).proportion_ci(CONFIDENCE, method="wilson")
        is_rare = not MIN_LACKING <= count <= n - MIN_LACKING
        indices = scatter.sobol_indices(np.full_like(lacks, np.nan) if is_rare else lacks)
        found.append(Missing(k, count / n, (interval.low, interval.high), indices))
    return found


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
    why_no_best: ClassVar[str] = "a tolerance analysis has no best one"

    @classmethod
    def of(cls, scatter: Scatter, columns: Columns) -> ScatterResult:
        """The result for the responses of all designs; ValueError if none has any."""
        if np.isnan(columns.values).all():
            first = columns.failures[min(columns.failures)]
            raise ValueError(f"no design has a response: narrow the ranges; first: {first}")
        return cls(scatter.study.base, scatter, columns, scatter.sobol_indices(columns.values))

    def _independent(self) -> int:
        """The two independent samples; the other designs mix them."""
        return 2 * self.definition.count

    def values(self) -> Record:
        """The distribution of each response, and the shares of its factors."""
        about = {"count": self.definition.count, "seed": self.definition.seed}
        return about | {"responses": scatter_record(self)}

    def charts(self) -> list[Chart]:
        """The distribution of each response, and the share of each factor in its variance."""
        return scatter_charts(self)

    def tables(self) -> list[Table | str]:
        """Varied parameters, spreads, and the shares of the factors."""
        return [*super().tables(), *tabulate_scatter(self)]

    @cached_property
    def missing(self) -> list[Missing]:
        """The share of designs that lack a response, and the factors that decide it."""
        return missing_responses(self.definition, self.columns.values)

    def sentence(self, k: int) -> str:
        """The range of a response and its strongest factors, or why there are none; empty if no design has it."""
        response = self.study.responses[k]
        spread, unit = self.spread.get(response.name), response.display_key
        if spread is None:
            return ""
        if is_constant(self.columns.values[:, k]):
            return f"{response.label}: {with_unit(spread['50 %'], unit)} in all designs: no parameter changes it"
        ends = f"{shown(spread['5 %'], unit)} to {shown(spread['95 %'], unit)} {display_unit(unit).name}".rstrip()
        factors = _strongest(self.sobol_indices, k) if self.sobol_indices.are_valid[k] else NO_SHARES
        return f"{response.label}: 90 % of the designs from {ends}; {factors}"


def scatter_record(result: ScatterResult) -> Record:
    """The distribution of each response, the shares of its factors in the variance, and of designs that lack it."""
    record: Record = {
        response.name: {
            "unit": response.unit,
            **result.spread.get(response.name, {}),
            "factors": _factors(result.sobol_indices, k),
        }
        for k, response in enumerate(result.study.responses)
    }
    for each in result.missing:
        lack = {"share": each.share, "interval": each.interval, "factors": _factors(each.indices, 0)}
        record[result.study.responses[each.column].name]["missing"] = lack
    return record


def _factors(drivers: SobolIndices, k: int) -> Record | None:
    """The indices of a response by factor, None if there are none."""
    if not drivers.are_valid[k]:
        return None
    parts = ("first", "first_interval", "total", "total_interval")
    return {
        factor: {part: getattr(drivers, part)[..., i, k] for part in parts} for i, factor in enumerate(drivers.factors)
    }


def tabulate_scatter(result: ScatterResult) -> list[Table | str]:
    """The spread of each response, the shares of its factors, and sentences on both and on designs that lack it."""
    scatter, drivers = result.definition, result.sobol_indices
    spreads, rows, bold = list[tuple[str, ...]](), list[tuple[str, ...]](), dict[int, str]()
    for k, response in enumerate(scatter.study.responses):
        spread = result.spread.get(response.name)
        if spread is not None:
            spreads.append((response.heading, *(shown(value, response.display_key) for value in spread.values())))
        if drivers.are_valid[k]:
            bold[len(rows)] = "bold"
            rows.append((response.label, "", ""))
            rows += [_factor_row(drivers, i, k) for i in drivers.total[:, k].argsort()[::-1]]
    tables = list[Table | str]()
    if spreads:
        title = f"Spread of {2 * scatter.count} designs, the two independent samples"
        few = ("of a response that designs lack: of the designs that have it",) if result.missing else ()
        tables.append(Table(title, ("response", "mean", "sd", *QUANTILE_NAMES), tuple(spreads), (QUANTILE_NOTE, *few)))
    if rows:
        groups = [f"{factor}: {', '.join(names)}" for factor, names in scatter.groups.items()]
        outside = (OUTSIDE_NOTE,) if drivers.is_any_outside else ()
        head = ("response, factor", "first-order", "total")
        notes = (*INDEX_NOTES, *outside, *groups)
        tables.append(Table("Sensitivity: share of the variance, %", head, tuple(rows), notes, styles=bold))
    return [*tables, *filter(None, map(result.sentence, range(len(scatter.study.responses)))), *_lacks(result)]


def _factor_row(drivers: SobolIndices, i: int, k: int) -> tuple[str, ...]:
    """The shares of a factor in the variance of a response."""
    first = _share(drivers.first[i, k], drivers.first_interval[:, i, k])
    return f"  {drivers.factors[i]}", first, _share(drivers.total[i, k], drivers.total_interval[:, i, k])


def _lacks(result: ScatterResult) -> list[str]:
    """How many designs lack which response, and the factors that decide it."""
    return [
        f"{result.study.responses[each.column].label}: missing in {_share(each.share, each.interval, ' %')} of the "
        f"designs; {_strongest(each.indices, 0) if each.indices.are_valid[0] else 'too few to name a factor'}"
        for each in result.missing
    ]


def _strongest(drivers: SobolIndices, k: int) -> str:
    """The strongest factors of a response, at most two."""
    total = np.clip(drivers.total[:, k], 0.0, 1.0)  # an estimate may be outside
    strongest = drivers.total[:, k].argsort()[::-1][:2]
    most = [f"{drivers.factors[i]} ({100 * total[i]:.0f} %)" for i in strongest if total[i] >= MIN_SHARE]
    named = f"the strongest factor{'s are' if len(most) > 1 else ' is'} {' and '.join(most)}"
    return named if most else "no factor stands out"


def _share(value: float, ends: Any, unit: str = "") -> str:
    low, high = (100 * float(end) for end in ends)
    return f"{100 * value:.1f}{unit} ({low:.1f} to {high:.1f})"


def scatter_charts(result: ScatterResult) -> list[Chart]:
    """The distribution of each response, and the share of each factor in its variance, or in that of its lack."""
    charts, samples = list[Chart](), result.finite_samples
    lacks = {each.column: each.indices for each in result.missing if each.indices.are_valid[0]}
    for k, response in enumerate(result.study.responses):
        spread = result.spread.get(response.name)
        if spread is not None and not is_constant(samples[response.name]):
            charts.append(_histogram(response, samples[response.name], spread))
        if result.sobol_indices.are_valid[k]:
            charts.append(_factors_chart(response.label, result.sobol_indices, k))
        if k in lacks:
            charts.append(_factors_chart(f"designs without {response.label}", lacks[k], 0))
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


def _factors_chart(label: str, drivers: SobolIndices, k: int) -> Chart:
    """The total index of each factor with its interval, the strongest on top, within what a share can be."""
    order = drivers.total[:, k].argsort()
    share, interval = (100 * np.clip(values, 0.0, 1.0) for values in (drivers.total, drivers.total_interval))
    share, interval = share[order, k], interval[:, order, k]
    rows = np.arange(len(order))
    gaps = np.full(len(order), np.nan)
    lines = Curve("95 % interval", np.stack([*interval, gaps]).T, np.stack([rows, rows, gaps]).T, "c1")
    return chart(
        f"Factors: {label}",
        [lines],
        x=Axis("total share of the variance, %", 0.0, 100.0),
        y=Axis("factor", names=tuple(drivers.factors[i] for i in order)),
        points=[Dots("share", share, rows, "c1")],
        height=ROW_HEIGHT * len(order) + ROWS_END,
    )
