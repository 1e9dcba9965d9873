"""What a study says, as records for programs and sheets for people: what varies; of a sweep the best designs, what
drives the results and where two of them trade off; of a scatter the spread and its causes; of an optimum the design."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass, fields
from functools import cached_property
from typing import Any

import numpy as np

from cuefem.cue import Array, Cue
from cuefem.cue.materials import material_name
from cuefem.design import Levels, Normal, Response, Span, Study, Vary
from cuefem.design.optimum import Optimum, Problem
from cuefem.design.scatter import Drivers, Scatter
from cuefem.design.study_result import StudyResult
from cuefem.parameters.parameter import Path
from cuefem.parameters.parts import Layout
from cuefem.results.quantities import TRADE, significant, with_heading, with_unit
from cuefem.results.records import Sheet
from cuefem.scene import Scene

MOST_LEVELS = 24  # values of a column that are groups of their own; of more, each group is a range
RANGES = 12  # so many then
CLEAR = 0.2  # the least rank correlation of a trend that is printed
_FIELD = re.compile(rf"({'|'.join(field.name for field in fields(Scene))})(\[[\d*]+\])?(\.\w+(\[[\d*]+\])?)+")
_ITEM = re.compile(r"(\w+)s\[(\d+|\*)\]")
SHOWN = 7  # designs of a front in the terminal

LEAST_NAMED = 0.01  # share of a cause that is named among the strongest

DRIVES = "What drives the results: the part of the spread between designs that goes with one column alone"
CAUSES = "What drives the spread: share of the variance, in per cent"
TREND = (
    "falls: a larger number in the column gives a smaller result (a larger bore, less squirt); rises: a larger one; "
    "parts that only act together are in no column"
)


@dataclass(frozen=True)
class DesignTable:
    """Designs that have an answer, as columns.

    values: what varied, numbers or names. results: (designs, responses).
    """

    names: tuple[str, ...]
    units: tuple[str, ...]
    responses: tuple[Response, ...]
    numbers: Array
    values: tuple[np.ndarray, ...]
    results: Array

    @cached_property
    def shares(self) -> Array:
        """Part of the variance of each response that goes with each column alone, (columns, responses)."""
        return np.array([_shares(column, self.results) for column in self.values])

    @cached_property
    def trends(self) -> list[list[str]]:
        """ "rises", "falls" or nothing, by column and response."""
        return [[_trend(column, result) for result in self.results.T] for column in self.values]

    def best(self, k: int) -> int:
        """The row of the best design for a response."""
        result = self.results[:, k]
        return int(result.argmax() if self.responses[k].result.better == "higher" else result.argmin())

    @property
    def labels(self) -> list[str]:
        """The names of what varied, as people say them."""
        return [*map(column_label, self.names)]

    def at(self, i: int) -> list[str]:
        """What varied in a design, for people."""
        return [shown(column[i], unit) for column, unit in zip(self.values, self.units, strict=True)]

    @property
    def judged(self) -> list[int]:
        """The responses of which one way is better; all of them if there is none."""
        return [k for k, response in enumerate(self.responses) if response.result.better] or [
            *range(len(self.responses))
        ]

    @cached_property
    def wanted(self) -> Array:
        """The results, turned so that less is better."""
        signs = [-1.0 if response.result.better == "higher" else 1.0 for response in self.responses]
        return self.results * np.array(signs)

    @cached_property
    def pair(self) -> tuple[int, int] | None:
        """The first response that is judged, and the one that speaks most against it; None if there is one alone."""
        first, *others = self.judged
        if not others:
            return None
        ranks = [_ranks(column) for column in self.wanted.T]
        return first, min(others, key=lambda k: _correlation(ranks[first], ranks[k]))

    @cached_property
    def front(self) -> list[int]:
        """Rows of which no other is better in one response of the pair and as good in the other, in their order."""
        if self.pair is None:
            return []
        first, second = self.wanted[:, self.pair[0]], self.wanted[:, self.pair[1]]
        rows, least = [], np.inf
        for i in np.lexsort((second, first)).tolist():
            if second[i] < least:
                rows.append(i)
                least = second[i]
        return rows


def varied_pieces(vary: Sequence[Vary], base: Scene) -> dict[str, list[str]]:
    """The pieces of the cue that each column varies, with their extents, by the column's name; none off the cue."""
    pieces = {each.name: _pieces(base.shaft, each.fields(base)) for each in vary} if base.lumped is None else {}
    return {name: words for name, words in pieces.items() if words}


def _pieces(cue: Cue, paths: Sequence[Path]) -> list[str]:
    """The pieces of a cue that some paths vary, each with its material and extent from the tip."""
    layout = Layout.of(cue)
    parts = {"ferrule": layout.ferrule, "bore": layout.bore or (), "shaft": layout.shaft}
    found = set[int]()
    for path in paths:
        found |= {int(path[2])} if path[:2] == ("cue", "segments") else {*parts.get(str(path[0]).split()[0], ())}
    pieces: dict[str, tuple[float, float]] = {}
    for i in sorted(found):
        hollow = "bored " if layout.bore and i in layout.bore else ""
        part = "ferrule" if i in layout.ferrule else "shaft" if i in layout.shaft else f"segment {i}"
        name = f"{hollow}{part} of {material_name(cue.segments[i].material)}"
        pieces[name] = (pieces.get(name, (cue.nodes[i],))[0], cue.nodes[i + 1])
    return [f"{name}, {1e3 * first:.5g} to {1e3 * last:.5g} mm" for name, (first, last) in pieces.items()]


def varied_sheet(study: Study) -> Sheet:
    """What varies: its name, its range with the unit, and the pieces of the cue that it is of."""
    pieces = varied_pieces(study.vary, study.base)
    rows = tuple(
        (column_label(vary.name), range_words(vary, unit), ", ".join(pieces.get(vary.name, ())))
        for vary, unit in zip(study.vary, study.units, strict=False)
    )
    notes = ("positions from the front of the modelled cue",) if pieces else ()
    head = ("varies", "over", "of")
    return Sheet(
        "What varies",
        head if pieces else head[:2],
        tuple(row[: 2 + bool(pieces)] for row in rows),
        notes,
        texts=(0, 1, 2),
    )


def range_words(vary: Vary, unit: str) -> str:
    """The values that a column takes, with their unit."""
    scale, name = TRADE.get(unit, (1.0, unit))
    match vary.range:
        case Levels(values):
            words = ", ".join(v if isinstance(v, str) else f"{scale * v:.4g}" for v in values)
        case Span(low, high):
            words = f"{scale * low:.4g} to {scale * high:.4g}"
        case Normal(middle, sd, logarithmic):
            words = f"{scale * middle:.4g} ± {f'{100 * sd:.3g} %,' if logarithmic else f'{scale * sd:.3g}'}"
    how = "times what is drawn" if vary.factor else "added to what is drawn" if vary.shift else ""
    return " ".join(word for word in (words, name, how) if word)


def table_of(result: StudyResult) -> DesignTable | None:
    """The designs of a sweep that have all answers; None if there are fewer than two."""
    good = [row for row in result.rows if None not in row.responses]
    if len(good) < 2:
        return None
    columns = tuple(np.array(column) for column in zip(*(row.values for row in good), strict=True))
    results, numbers = np.array([row.responses for row in good], float), np.array([row.design for row in good])
    names, units = (part[: len(columns)] for part in (result.study.columns, result.study.units))
    return DesignTable(names, units, result.study.responses, numbers, columns, results)


def _groups(column: np.ndarray) -> np.ndarray:
    """The number of the group of each value: its own, or a range of values with as many designs as others."""
    levels, which = np.unique(column, return_inverse=True)
    if len(levels) <= MOST_LEVELS or column.dtype.kind not in "fi":
        return which
    count = max(2, min(RANGES, len(column) // 8))
    return np.asarray(np.searchsorted(np.quantile(column, np.arange(1, count) / count), column, side="right"))


def _shares(column: np.ndarray, results: Array) -> Array:
    """Variance of the groups' means over the whole, (responses,); ranges less what chance gives them."""
    which = _groups(column)
    sizes = np.bincount(which)
    spread = sizes > 0
    means = np.array([np.bincount(which, weights=r)[spread] / sizes[spread] for r in results.T]).T
    whole = results.var(axis=0)
    between = (sizes[spread, None] * (means - results.mean(axis=0)) ** 2).sum(axis=0) / len(results)
    share = np.divide(between, whole, out=np.zeros_like(whole), where=whole > 0)
    groups, count = int(spread.sum()), len(results)
    if groups < len(np.unique(column)) and count > groups:
        share = np.clip(1 - (1 - share) * (count - 1) / (count - groups), 0.0, 1.0)
    return np.asarray(share)


def _ranks(values: Array) -> Array:
    return np.unique(values, return_inverse=True)[1].astype(float)


def _correlation(first: Array, other: Array) -> float:
    spread = first.std() * other.std()
    return float(np.mean((first - first.mean()) * (other - other.mean())) / spread) if spread > 0 else 0.0


def _trend(column: np.ndarray, result: Array) -> str:
    if column.dtype.kind not in "fi":
        return ""
    correlation = _correlation(_ranks(column), _ranks(result))
    return "rises" if correlation > CLEAR else "falls" if correlation < -CLEAR else ""


def column_label(name: str) -> str:
    """A column's name as people say it; fields of the scene are said in words: "segment 3 tip bore"."""
    return ", ".join(_field_words(path) if _FIELD.fullmatch(path) else path for path in name.split(", "))


def _field_words(path: str) -> str:
    steps = path.removeprefix("cue.").split(".")
    items = (
        _ITEM.sub(lambda match: f"all {match[1]}s" if match[2] == "*" else f"{match[1]} {int(match[2]) + 1}", s)
        for s in steps
    )
    return " ".join(items).replace("_", " ")


def shown(value: Any, unit: str) -> str:
    """A value of a column in that unit, without it; names as they are."""
    if isinstance(value, str):
        return str(value)
    return significant(TRADE.get(unit, (1.0, unit))[0] * float(value))


def study_record(result: StudyResult) -> dict[str, Any]:
    """What a study found, for programs: SI."""
    if isinstance(result.asked, Problem) and result.optimum:
        return optimum_record(result.asked, result.optimum)
    if isinstance(result.asked, Scatter) and result.drivers:
        about = {"count": result.asked.count, "seed": result.asked.seed}
        return about | {"responses": scatter_record(result, result.drivers)}
    table, failed = table_of(result), [*result.failures.values()]
    counts = {"designs": len(result.rows), "failed": len(failed), "first_failure": failed[0] if failed else None}
    return counts | {"summary": table and sweep_record(table)}


def study_sheets(result: StudyResult) -> list[Sheet | str]:
    """What a study found, for people."""
    varies = varied_sheet(result.study)
    if isinstance(result.asked, Problem) and result.optimum:
        return [varies, *optimum_sheets(result.asked, result.optimum)]
    if isinstance(result.asked, Scatter) and result.drivers:
        return [varies, *scatter_sheets(result, result.asked, result.drivers)]
    table, failures = table_of(result), [*result.failures.items()]
    lines = [f"{len(failures)} failed, the first of them design {n}: {reason}" for n, reason in failures[:1]]
    return [*lines, varies, *([] if table is None else sweep_sheets(table))]


def sweep_record(table: DesignTable) -> dict[str, Any]:
    """The summary of a sweep."""

    def design(i: int) -> dict[str, Any]:
        at = {name: column[i].item() for name, column in zip(table.names, table.values, strict=True)}
        results = {response.name: table.results[i, k] for k, response in enumerate(table.responses)}
        return {"design": int(table.numbers[i]), "at": at, "responses": results}

    names = [response.name for response in table.responses]
    record: dict[str, Any] = {
        "best": {
            table.responses[k].name: {"better": table.responses[k].result.better, **design(table.best(k))}
            for k in table.judged
        },
        "drives": {
            name: {
                column: {"share": table.shares[j, k], "trend": table.trends[j][k] or None}
                for j, column in enumerate(table.names)
            }
            for k, name in enumerate(names)
        },
    }
    if table.pair is not None:
        record["front"] = {"of": [names[k] for k in table.pair], "designs": [design(i) for i in table.front]}
    return record


def best_sheet(table: DesignTable) -> Sheet:
    """The best design for each response."""
    head = ("best for", "value", "all designs", "design", *map(with_heading, table.labels, table.units))
    rows = []
    for k in table.judged:
        response, i, result = table.responses[k], table.best(k), table.results[:, k]
        ends = " to ".join(shown(end, response.unit) for end in (result.min(), result.max()))
        which = f"{response.result.better} is better" if response.result.better else "the lowest"
        name = f"{response.heading} ({which})"
        rows.append((name, shown(result[i], response.unit), ends, str(table.numbers[i]), *table.at(i)))
    return Sheet("Best designs", head, tuple(rows))


def drive_sheet(table: DesignTable) -> Sheet:
    """Which part of each response's spread goes with each column."""
    rows = [
        (
            response.label,
            *(f"{100 * table.shares[j, k]:.0f} % {table.trends[j][k]}".strip() for j in range(len(table.names))),
        )
        for k, response in enumerate(table.responses)
    ]
    return Sheet(DRIVES, ("result", *table.labels), tuple(rows), (TREND,))


def front_sheet(table: DesignTable, most: int) -> Sheet:
    """Designs along the front, evenly picked."""
    assert table.pair is not None
    picked = np.unique(np.linspace(0, len(table.front) - 1, min(most, len(table.front))).round().astype(int))
    two = [table.responses[k] for k in table.pair]
    names = (*(response.heading for response in two), *map(with_heading, table.labels, table.units))
    rows = []
    for i in (table.front[j] for j in picked):
        results = (shown(table.results[i, k], response.unit) for k, response in zip(table.pair, two, strict=True))
        rows.append((str(table.numbers[i]), *results, *table.at(i)))
    return Sheet(f"Trade-off, {front_words(table, most)}", ("design", *names), tuple(rows))


def front_words(table: DesignTable, most: int) -> str:
    """What the front is, and how many of its designs are listed where there is room for ``most``."""
    assert table.pair is not None
    first, other = (table.responses[k] for k in table.pair)
    count = len(table.front)
    few = f"; {most} of them are listed, evenly picked" if most < count else ""
    if count == 1:
        return f"{first.label} and {other.label}: one design is the best for both"
    return f"{first.label} against {other.label}: {count} designs, of which none is beaten in both{few}"


def sweep_sheets(table: DesignTable) -> list[Sheet | str]:
    """The summary of a sweep."""
    front = [] if table.pair is None else [front_sheet(table, SHOWN)]
    return [best_sheet(table), drive_sheet(table), *front]


def scatter_record(result: StudyResult, drivers: Drivers) -> dict[str, Any]:
    """The distribution of every response, and the shares of its causes."""
    return {
        response.name: {
            "unit": response.unit,
            **result.spread[response.name],
            "causes": {
                cause: {
                    "first": drivers.first[i, k],
                    "first_interval": drivers.first_interval[:, i, k],
                    "total": drivers.total[i, k],
                    "total_interval": drivers.total_interval[:, i, k],
                }
                for i, cause in enumerate(drivers.causes)
            },
        }
        for k, response in enumerate(result.study.responses)
    }


def scatter_sheets(result: StudyResult, scatter: Scatter, drivers: Drivers) -> list[Sheet | str]:
    """The spread of every response, what drives it, and both in a sentence for each."""
    spreads, rows, bold, lines = list[tuple[str, ...]](), list[tuple[str, ...]](), dict[int, str](), list[str]()
    for k, response in enumerate(scatter.study.responses):
        numbers = {name: shown(value, response.unit) for name, value in result.spread[response.name].items()}
        spreads.append((response.heading, *numbers.values()))
        bold[len(rows)] = "bold"
        rows.append((response.label, "", ""))
        strongest = drivers.total[:, k].argsort()[::-1]
        for i in strongest:
            both = ((drivers.first, drivers.first_interval), (drivers.total, drivers.total_interval))
            rows.append((f"  {drivers.causes[i]}", *(_share(value[i, k], ends[:, i, k]) for value, ends in both)))
        total = np.clip(drivers.total[:, k], 0.0, 1.0)  # an estimate may lie beyond
        most = [f"{drivers.causes[i]} ({100 * total[i]:.0f} %)" for i in strongest[:2] if total[i] >= LEAST_NAMED]
        unit = TRADE.get(response.unit, (1, response.unit))[1]
        ends = f"{response.label}: nine in ten lie from {numbers['5 %']} to {numbers['95 %']} {unit}".rstrip()
        named = f"the strongest cause{'s are' if len(most) > 1 else ' is'} {' and '.join(most)}"
        lines.append(f"{ends}; {named if most else 'no cause stands out'}")
    drawn = "a column headed 5 %: 5 % of the designs lie below its value; sd: standard deviation"
    notes = (
        "alone: the part of the variance that goes away if this cause is known; in all: the part that stays if all "
        "other causes are known",
        "in brackets 95 % intervals, bootstrapped",
        *(f"{cause}: {', '.join(names)}" for cause, names in scatter.groups.items()),
    )
    return [
        Sheet(f"Spread of {2 * scatter.count} designs", ("response", *numbers), tuple(spreads), (drawn,)),
        Sheet(CAUSES, ("response, cause", "alone", "in all"), tuple(rows), notes, styles=bold),
        *lines,
    ]


def _share(value: float, ends: Any) -> str:
    low, high = (100 * float(end) for end in ends)
    return f"{100 * value:.1f} ({low:.1f} to {high:.1f})"


def optimum_record(problem: Problem, best: Optimum) -> dict[str, Any]:
    """The best design, and how it was found."""
    aim = {"maximize" if problem.largest else "minimize": problem.objective.name}
    return {
        "objective": aim,
        "value": best.responses[problem.objective.name],
        "values": best.values,
        "responses": best.responses,
        "active": best.active,
        "evaluations": best.evaluations,
        "unfinished": best.unfinished,
        "choices": [choice._asdict() for choice in best.choices],
    }


def optimum_sheets(problem: Problem, best: Optimum) -> list[Sheet | str]:
    """The best design, what holds it, and the best with each of the listed values."""
    units = dict(zip(problem.study.columns, problem.study.units, strict=True))
    labels = {response.name: response.label for response in problem.study.responses}

    def words(name: str, value: Any) -> str:
        return value if isinstance(value, str) else with_unit(value, units[name], 6)

    both = {**best.responses, **best.values}
    names = {name: labels.get(name) or column_label(name) for name in both}
    aim = f"{'maximize' if problem.largest else 'minimize'} {problem.objective.label}"
    limits = (limit.rsplit(" ", 2) for limit in best.active)
    held_by = [f"{names[name]} {sign} {words(name, float(bound))}" for name, sign, bound in limits]
    things: list[Sheet | str] = [
        f"{aim}: {best.evaluations} designs computed",
        Sheet("Best design", ("", "value"), tuple((names[name], words(name, value)) for name, value in both.items())),
        f"held by: {', '.join(held_by) or 'nothing'}",
    ]
    if best.unfinished:
        things.append(f"not finished: {best.unfinished}; more --iterations may find a better design")
    if best.choices:
        head = (*map(column_label, best.choices[0].values), problem.objective.heading, "")
        rows = tuple(
            (
                *(words(name, value) for name, value in choice.values.items()),
                "—" if choice.reason else shown(choice.objective, problem.objective.unit),
                choice.reason,
            )
            for choice in best.choices
        )
        texts = (*range(len(head) - 2), len(head) - 1)
        things.append(Sheet("The best with each of the listed values", head, rows, texts=texts))
    return things
