"""A sweep: the result of a grid or sample of designs, with its best designs, main parameters and trade-off.

Which parameter explains which response, and where two responses trade off: statistics, record, tables and charts.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import pairwise
from typing import ClassVar

import numpy as np
from numpy.typing import NDArray

from cuefem.cue import Array
from cuefem.designs.design_differences import design_differences, squirt_error
from cuefem.designs.evaluation import Response
from cuefem.designs.study import Study, StudyDesign
from cuefem.designs.study_result import CHART_HEIGHT, ROW_HEIGHT, ROWS_END, StudyResult
from cuefem.designs.study_table import column_label, shown
from cuefem.quantity.display_units import to_display, with_heading, with_unit
from cuefem.quantity.equality import equal_fields
from cuefem.results.records import Record, Table
from cuefem.show.charts import Axis, Chart, Curve, Dots, chart

MAX_LEVELS = 24  # maximum number of values of a parameter that are separate groups
MAX_GROUPS = 12  # maximum number of groups, each a range, of a parameter with more values
MAX_FRONT_ROWS = 7  # designs of a Pareto front in a table
MAX_POINTS = 2000  # designs of a chart: of more an evenly spaced part is drawn
MIN_TREND = 0.2  # minimum rank correlation of a trend
TREND_NOTE = (
    "falls: a larger value of the parameter gives a smaller result (a larger bore, less squirt); rises: a larger one; "
    "the shares exclude interactions of parameters"
)
SQUIRT_NOTE = (
    "squirt ±: 1σ, of the model and of unmeasured wood and tip; all designs share most of it, so that differences are "
    "surer"
)
NOT_DISTINCT_FROM_ROW_ABOVE = (
    "* ±: 1σ of the difference from the row above, which is smaller: the two designs are not distinct in this result."
)


@dataclass(frozen=True, repr=False)
class SweepResult(StudyResult):
    """The result of a sweep: the best designs, the main parameter of each response, and a trade-off."""

    kind: ClassVar[str] = "sweep"

    @cached_property
    def best(self) -> dict[str, StudyDesign]:
        """Of the designs with a response the best for it, if one direction is preferred; without any, the lowest."""
        statistics = self.statistics
        if statistics is None:
            return {}
        return {
            statistics.responses[k].name: self._design(int(statistics.numbers[statistics.best(k)]))
            for k in statistics.ranked
        }

    def _design(self, i: int) -> StudyDesign:
        values = {name: column[i].item() for name, column in self.designs.items()}
        numbers = {name: float(column[i]) for name, column in self.responses.items()}
        return StudyDesign(self.study.scene(tuple(values.values())), values, numbers, failure=self.failures.get(i))

    @cached_property
    def statistics(self) -> SweepStatistics | None:
        """Its statistics; None if no design has a response."""
        return sweep_statistics(self.study, self.designs, self.columns.values)

    @cached_property
    def errors(self) -> dict[str, float]:
        """Uncertainty (1 sigma) of the squirt of the best design for each squirt, rad, by response."""
        return {
            response.name: squirt_error(self.study, self.best[response.name], response)
            for response in self.study.responses
            if response.kind == "squirt" and response.name in self.best
        }

    @property
    def front(self) -> list[int]:
        """The designs of the Pareto front by number, in order of the first of its two responses."""
        return [] if self.statistics is None else self.statistics.numbers[self.statistics.front].tolist()

    @cached_property
    def front_steps(self) -> list[dict[str, Record]]:
        """Differences of each design of the front in the table from the one above, as of `design_differences`.

        Of the two responses that trade off; what remains of the errors that both designs share is left out.
        """
        statistics = self.statistics
        if statistics is None or statistics.pair is None:
            return []
        two = replace(self.study, responses=tuple(statistics.responses[k] for k in statistics.pair))
        names = [response.name for response in two.responses]
        designs = [self._design(int(statistics.numbers[i])) for i in statistics.shown_front]
        designs = [replace(design, responses={name: design.responses[name] for name in names}) for design in designs]
        return design_differences(two, designs, with_shared=False)

    def values(self) -> Record:
        """Counts of designs, and the summary: best designs, sensitivities, Pareto front."""
        first_failure = next(iter(self.failures.values()), None)
        lacking = np.isnan(self.columns.values)
        counts = {
            "designs": self.count,
            "failed": np.all(lacking, axis=1).sum(),
            "lacking": dict(zip(self.responses, lacking.sum(axis=0), strict=True)),
            "first_failure": first_failure,
        }
        return counts | {"summary": self.statistics and sweep_record(self.statistics, self.front_steps, self.errors)}

    def charts(self) -> list[Chart]:
        """The trade-off with its Pareto front, and the first response against each parameter."""
        return [] if self.statistics is None else sweep_charts(self.statistics)

    def tables(self) -> list[Table | str]:
        """Varied parameters, best designs, sensitivities, and the Pareto front."""
        found = [] if self.statistics is None else tabulate_sweep(self.statistics, self.front_steps, self.errors)
        return [*super().tables(), *found]


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


def sweep_record(sweep: SweepStatistics, steps: Sequence[Mapping[str, Record]], errors: Mapping[str, float]) -> Record:
    """Best designs, sensitivities and the Pareto front of a sweep.

    steps: differences of each shown design of the front from the one before. errors: of the squirt of best designs.
    """
    names = [response.name for response in sweep.responses]

    def design(i: int) -> Record:
        values = {name: column[i].item() for name, column in zip(sweep.names, sweep.values, strict=True)}
        responses = dict(zip(names, sweep.results[i], strict=True))
        return {"design": sweep.numbers[i], "values": values, "responses": responses}

    record: Record = {
        "best": {
            names[k]: {"better": sweep.responses[k].result.better, **design(sweep.best(k))}
            | ({"error": errors[names[k]]} if names[k] in errors else {})
            for k in sweep.ranked
        },
        "sensitivities": {
            name: {
                column: {"share": sweep.shares[j, k], "trend": sweep.trends[j][k] or None}
                for j, column in enumerate(sweep.names)
            }
            for k, name in enumerate(names)
        },
    }
    if sweep.pair is not None:
        ends = pairwise(sweep.numbers[sweep.shown_front].tolist())
        record["front"] = {
            "of": [names[k] for k in sweep.pair],
            "designs": [design(i) for i in sweep.front],
            "steps": [{"from": i, "to": j, "changes": step} for (i, j), step in zip(ends, steps, strict=True)],
        }
    return record


def tabulate_sweep(
    sweep: SweepStatistics, steps: Sequence[Mapping[str, Record]], errors: Mapping[str, float]
) -> list[Table | str]:
    """The best design for each response, the sensitivities, and evenly spaced designs of the Pareto front.

    Of a single design its responses alone. steps, errors: as of `sweep_record`.
    """
    labels = [*map(column_label, sweep.names)]
    heads = [*map(with_heading, labels, sweep.units)]

    def cells(i: int, responses: Iterable[int]) -> list[str]:
        results = [shown(sweep.results[i, k], sweep.responses[k].display_key) for k in responses]
        return [*results, *(shown(column[i], unit) for column, unit in zip(sweep.values, sweep.units, strict=True))]

    if len(sweep.numbers) == 1:
        only = tuple((response.heading, *cells(0, [k])) for k, response in enumerate(sweep.responses))
        return [Table(f"Responses of design {sweep.numbers[0]}", ("response", "value", *heads), only)]
    best, sensitivities = list[tuple[str, ...]](), list[tuple[str, ...]]()
    for k in sweep.ranked:
        response, i = sweep.responses[k], sweep.best(k)
        ends = " to ".join(shown(end(sweep.results[:, k]), response.display_key) for end in (np.nanmin, np.nanmax))
        which = f"{response.result.better} is better" if response.result.better else "the lowest"
        which += ", by size" if response.result.odd else ""
        value, *rest = cells(i, [k])
        error = errors.get(response.name, math.nan)
        if not math.isnan(error):
            value = with_unit(sweep.results[i, k], response.display_key, error=error)
        best.append((f"{response.heading} ({which})", value, ends, str(sweep.numbers[i]), *rest))
    for k, response in enumerate(sweep.responses):
        parts = (
            f"{100 * share:.0f} % {trend[k]}".strip()
            for share, trend in zip(sweep.shares[:, k], sweep.trends, strict=True)
        )
        sensitivities.append((response.label, *parts))
    about = (SQUIRT_NOTE,) if errors else ()
    sheets: list[Table | str] = [
        Table("Best designs", ("best for", "value", "all designs", "design", *heads), tuple(best), about),
        Table(
            "Sensitivity: share of a result's variance between designs by one parameter alone",
            ("result", *labels),
            tuple(sensitivities),
            (TREND_NOTE,) if any(cell.endswith(("falls", "rises")) for row in sensitivities for cell in row) else (),
        ),
    ]
    if sweep.pair is None:
        return sheets
    count, two = len(sweep.front), [sweep.responses[k] for k in sweep.pair]
    rows = []
    for i, step in zip(sweep.shown_front, [{}, *steps], strict=True):
        results, values = cells(i, sweep.pair)[:2], cells(i, ())
        marked = (_with_step(text, step.get(response.name)) for text, response in zip(results, two, strict=True))
        rows.append((str(sweep.numbers[i]), *marked, *values))
    is_marked = any(not change["distinct"] for step in steps for change in step.values())
    few = f"; {MAX_FRONT_ROWS} of them, evenly spaced" if count > MAX_FRONT_ROWS else ""
    title = (
        f"{two[0].label} against {two[1].label}: Pareto front of {count} designs{few}"
        if count > 1
        else f"{two[0].label} and {two[1].label}: one design is the best for both"
    )
    head = ("design", *(response.heading for response in two), *heads)
    notes = (NOT_DISTINCT_FROM_ROW_ABOVE,) if is_marked else ()
    return [*sheets, Table(f"Trade-off, {title}", head, tuple(rows), notes)]


def _with_step(text: str, change: Record | None) -> str:
    """A result of the front, with the uncertainty of its difference from the row above if the two are not distinct."""
    if change is None or change["distinct"]:
        return text
    return f"{text} ± {100 * change['error']:.2g} % *"


def sweep_charts(sweep: SweepStatistics) -> list[Chart]:
    """The trade-off, and the first response against each parameter; of a single design none."""
    if len(sweep.numbers) < 2:
        return []
    varied = [j for j, column in enumerate(sweep.values) if len(np.unique(column)) > 1]
    trade_off = [] if sweep.pair is None else [_trade_off(sweep, *sweep.pair)]
    return [*trade_off, *(_parameter_chart(sweep, j, sweep.ranked[0]) for j in varied)]


def _trade_off(sweep: SweepStatistics, first: int, second: int) -> Chart:
    """Designs by two responses, and the front."""
    x, y = (to_display(sweep.results[:, k], sweep.responses[k].display_key) for k in (second, first))
    shown, name = _shown(sweep.having(first, second))
    front = sweep.front
    return chart(
        f"Trade-off: {sweep.responses[first].label}",
        [Curve("best trade-offs (Pareto front)", x[front], y[front], "c1")],
        x=Axis(sweep.responses[second].heading, from_zero=False),
        y=Axis(sweep.responses[first].heading, from_zero=False),
        points=[
            Dots(name, x[shown], y[shown], "c5"),
            *(Dots("", x[[i]], y[[i]], "c1", f"design {sweep.numbers[i]}") for i in front),
        ],
        height=CHART_HEIGHT,
    )


def _shown(rows: NDArray[np.int_]) -> tuple[NDArray[np.int_], str]:
    """The rows of designs that a chart draws, and their name in the legend."""
    count = len(rows)
    if count <= MAX_POINTS:
        return rows, "designs"
    spaced = np.linspace(0, count - 1, MAX_POINTS).round().astype(int)
    return rows[spaced], f"{MAX_POINTS} of {count} designs, evenly spaced"


def _parameter_chart(sweep: SweepStatistics, j: int, k: int) -> Chart:
    """A response against a parameter, with its median at each value or range of values."""
    rows = sweep.rows[k]
    response, column, label = sweep.responses[k], sweep.values[j][rows], column_label(sweep.names[j])
    results = to_display(sweep.results[rows, k], response.display_key)
    if column.dtype.kind not in "fi":
        return _names_chart(response, label, column, results)
    values = to_display(column, sweep.units[j])
    medians = _medians(column, np.stack([values, results], axis=1))
    shown, name = _shown(np.arange(len(column)))
    is_single = len(medians) == len(column)
    return chart(
        f"{response.label} by {label}",
        [Curve("the response" if is_single else "median", medians[:, 0], medians[:, 1], "c1")],
        x=Axis(with_heading(label, sweep.units[j]), from_zero=False),
        y=Axis(response.heading, from_zero=False),
        points=[Dots(name, values[shown], results[shown], "c5")],
        height=CHART_HEIGHT,
    )


def _medians(column: np.ndarray, results: Array) -> Array:
    """Medians of results (designs, n) by groups of a column, (groups, n)."""
    group, _ = groups_of(column)
    return np.array([np.median(results[group == i], axis=0) for i in range(group.max() + 1)])


def _names_chart(response: Response, label: str, column: np.ndarray, results: Array) -> Chart:
    """A response for each name in a column, the first on top, with their medians."""
    names = [*dict.fromkeys(column.tolist())][::-1]
    rows = np.array([names.index(name) for name in column.tolist()])
    medians = _medians(rows, results[:, None])[:, 0]
    shown, name = _shown(np.arange(len(rows)))
    points = [Dots(name, results[shown], rows[shown], "c5")]
    if len(names) < len(rows):
        points.append(Dots("median", medians, np.arange(len(names)), "c1"))
    return chart(
        f"{response.label} by {label}",
        [],
        x=Axis(response.heading, from_zero=False),
        y=Axis(label, names=tuple(names)),
        points=points,
        height=ROW_HEIGHT * len(names) + ROWS_END,
    )
