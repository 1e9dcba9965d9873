"""Results of a study: records and tables.

Varied parameters; of a sweep the best designs, sensitivities and a trade-off; of a tolerance analysis the spread and
its factors; of an optimum the best design and its active constraints.
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import fields, replace
from itertools import pairwise
from typing import Any

import numpy as np

from cuefem.cue import Array, Cue
from cuefem.cue.materials import material_name
from cuefem.designs import Levels, Normal, Span, Study, Vary
from cuefem.designs.evaluation import shortfalls
from cuefem.designs.optimum import Optimum, Problem
from cuefem.designs.scatter import Scatter, SobolIndices
from cuefem.designs.study_statistics import MAX_FRONT_ROWS, SweepStatistics
from cuefem.parameters.field_paths import Path
from cuefem.parameters.parts import Layout
from cuefem.quantity.display import counted
from cuefem.quantity.display_units import (
    display_unit,
    format_change,
    number_text,
    short_number,
    span_text,
    with_heading,
    with_unit,
)
from cuefem.results.differences import difference_text
from cuefem.results.quantities import DASH
from cuefem.results.records import Record, Table
from cuefem.scene import Scene
from cuefem.show.scene_summary import assumptions, scene_record

Designs = Mapping[str, np.ndarray]  # values of each parameter by its name, (designs,)
Spread = Mapping[str, Mapping[str, float]]  # of each response: mean, sd and quantiles

_FIELD = re.compile(rf"({'|'.join(field.name for field in fields(Scene))})(\[[\d*]+\])?(\.\w+(\[[\d*]+\])?)+")
_ITEM = re.compile(r"(\w+)s\[(\d+|\*)\]")
TREND_NOTE = (
    "falls: a larger value of the parameter gives a smaller result (a larger bore, less squirt); rises: a larger one; "
    "the shares exclude interactions of parameters"
)
NOT_DISTINCT_FROM_ROW_ABOVE = (
    "* ±: 1σ of the difference from the row above, which is smaller: the two designs are not distinct in this result."
)
NOT_DISTINCT = "* smaller than its uncertainty: the two designs are not distinct in this result."
MIN_SHARE = 0.01  # of the variance, of a factor that is named among the strongest


def varied_segments(vary: Sequence[Vary], base: Scene) -> dict[str, list[str]]:
    """The segments of the cue that each parameter varies, with their extents, by the parameter's name."""
    if base.lumped is not None:
        return {}
    pieces = dict[str, list[str]]()
    for each in vary:
        is_material = isinstance(each.range, Levels) and any(isinstance(value, str) for value in each.range.values)
        pieces[each.name] = _segments(base.shaft, each.fields(base), with_material=not is_material)
    return {name: texts for name, texts in pieces.items() if texts}


def _segments(cue: Cue, paths: Sequence[Path], *, with_material: bool) -> list[str]:
    """The segments at the paths, each with its extent from the tip, and its material unless that varies."""
    layout = Layout.of(cue)
    parts = {"ferrule": layout.ferrule, "bore": layout.bore or (), "shaft": layout.shaft}
    varied = set[int]()
    for path in paths:
        varied |= {int(path[2])} if path[:2] == ("cue", "segments") else {*parts.get(str(path[0]).split()[0], ())}
    pieces: dict[str, tuple[float, float]] = {}
    for i in sorted(varied):
        hollow = "bored " if layout.bore and i in layout.bore else ""
        part = "ferrule" if i in layout.ferrule else "shaft" if i in layout.shaft else f"segment {i}"
        material = f" of {material_name(cue.segments[i].material)}" if with_material else ""
        name = f"{hollow}{part}{material}"
        pieces[name] = (pieces.get(name, (cue.nodes[i],))[0], cue.nodes[i + 1])
    return [f"{name}, {span_text(first, last, 'm', 5)}" for name, (first, last) in pieces.items()]


def tabulate_parameters(study: Study) -> Table:
    """A row for each varied parameter: its name, range and segments; stroke and definitions of results as notes."""
    pieces = varied_segments(study.vary, study.base)
    rows = tuple(
        (column_label(vary.name), range_text(vary, unit), ", ".join(pieces.get(vary.name, ())))
        for vary, unit in zip(study.vary, study.units, strict=False)
    )
    about = {each.result.column_heading: each.result.about for each in study.responses if each.result.about}
    notes = (
        *(("positions from the front of the modelled cue",) if pieces else ()),
        f"unless varied: {assumptions(scene_record(study.base))}, offset b/R {study.base.stroke.offset:.4g}",
        *(f"{name}: {text}" for name, text in about.items()),
    )
    head = ("parameter", "range", "segments")
    return Table(
        "Varied parameters",
        head if pieces else head[:2],
        tuple(row[: 2 + bool(pieces)] for row in rows),
        notes,
        texts=(0, 1, 2),
    )


def range_text(vary: Vary, unit: str) -> str:
    """The values of a varied parameter, with their unit."""
    name = display_unit(unit).name
    match vary.range:
        case Levels(values):
            text = ", ".join(v if isinstance(v, str) else short_number(v, unit) for v in values)
        case Span(low, high):
            text = f"{short_number(low, unit)} to {short_number(high, unit)}"
        case Normal(middle, sd, logarithmic):
            spread = f"{100 * sd:.3g} %," if logarithmic else short_number(sd, unit, 3)
            text = f"{short_number(middle, unit)} ± {spread}"
    how = "times the drawn value" if vary.factor else "added to the drawn value" if vary.shift else ""
    return " ".join(part for part in (text, name, how) if part)


def column_label(name: str) -> str:
    """The label of a column: a path of the scene as text, such as "segment 3 tip bore"; another name as it is."""
    return ", ".join(_path_label(path) if _FIELD.fullmatch(path) else path for path in name.split(", "))


def _path_label(path: str) -> str:
    steps = path.removeprefix("cue.").split(".")
    items = (
        _ITEM.sub(lambda match: f"all {match[1]}s" if match[2] == "*" else f"{match[1]} {int(match[2]) + 1}", s)
        for s in steps
    )
    return " ".join(items).replace("_", " ")


def shown(value: Any, unit: str) -> str:
    """A value in the display unit of an SI unit, without the unit; a name as it is."""
    if isinstance(value, str):
        return str(value)
    return number_text(float(value), unit)


def failure_lines(study: Study, designs: Designs, results: Array, failures: Mapping[int, str]) -> list[str]:
    """How many designs failed or lack which responses, with the first of them and its reason.

    results: (designs, responses). failures: reasons by the number of the design.
    """
    lines = list[str]()
    for text, number in shortfalls(study.responses, results):
        if number is None:
            lines.append(text)
            continue
        values = [column[number].item() for column in designs.values()]
        levels = [replace(vary, range=Levels((x,))) for vary, x in zip(study.vary, values, strict=True)]
        texts = map(range_text, levels, study.units)
        design = ", ".join(f"{column_label(vary.name)} {x}" for vary, x in zip(levels, texts, strict=True))
        lines.append(f"{text}, the first of them design {number} ({design}): {failures[number]}")
    return lines


def sweep_record(sweep: SweepStatistics, steps: Sequence[Mapping[str, Record]]) -> Record:
    """Best designs, sensitivities and the Pareto front of a sweep.

    steps: differences of each shown design of the front from the one before.
    """
    names = [response.name for response in sweep.responses]

    def design(i: int) -> Record:
        values = {name: column[i].item() for name, column in zip(sweep.names, sweep.values, strict=True)}
        responses = dict(zip(names, sweep.results[i], strict=True))
        return {"design": sweep.numbers[i], "values": values, "responses": responses}

    record: Record = {
        "best": {names[k]: {"better": sweep.responses[k].result.better, **design(sweep.best(k))} for k in sweep.ranked},
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


def tabulate_sweep(sweep: SweepStatistics, steps: Sequence[Mapping[str, Record]]) -> list[Table | str]:
    """The best design for each response, the sensitivities, and evenly spaced designs of the Pareto front.

    Of a single design its responses alone. steps: as of `sweep_record`.
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
        best.append((f"{response.heading} ({which})", value, ends, str(sweep.numbers[i]), *rest))
    for k, response in enumerate(sweep.responses):
        parts = (
            f"{100 * share:.0f} % {trend[k]}".strip()
            for share, trend in zip(sweep.shares[:, k], sweep.trends, strict=True)
        )
        sensitivities.append((response.label, *parts))
    sheets: list[Table | str] = [
        Table("Best designs", ("best for", "value", "all designs", "design", *heads), tuple(best)),
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


def scatter_record(study: Study, spread: Spread, drivers: SobolIndices) -> Record:
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


def tabulate_scatter(scatter: Scatter, spread: Spread, drivers: SobolIndices) -> list[Table | str]:
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


def _change_text(start: Any, value: Any, change: Record | None) -> str:
    """A change in %, of a response with its uncertainty; a dash where there is none."""
    if change is not None:
        return difference_text(change["difference"], change["error"]) + ("" if change["distinct"] else " *")
    numbers = not isinstance(start, str) and not isinstance(value, str)
    if not numbers or not start * value > 0:
        return DASH
    return format_change(100 * (value / start - 1), 1, "%")


def _share(value: float, ends: Any) -> str:
    low, high = (100 * float(end) for end in ends)
    return f"{100 * value:.1f} ({low:.1f} to {high:.1f})"


def optimum_record(problem: Problem, best: Optimum, changes: Mapping[str, Record]) -> Record:
    """The best design, its responses and active constraints beside the unmodified design, and the evaluations."""
    assert best.start is not None
    aim = {"maximize" if problem.maximize else "minimize": problem.objective.name}
    return {
        "objective": aim,
        "value": best.responses[problem.objective.name],
        "values": best.values,
        "responses": best.responses,
        "start": {"values": best.start.values, "responses": best.start.responses, "failure": best.start.failure},
        "changes": changes,
        "active": [constraint._asdict() for constraint in best.active],
        "is_set_by_constraints": is_set_by_constraints(problem, best),
        "evaluations": best.evaluations,
        "stop_reason": best.stop_reason,
        "choices": [choice._asdict() for choice in best.choices],
    }


def is_set_by_constraints(problem: Problem, best: Optimum) -> bool:
    """Whether as many constraints are active as there are numbers to choose."""
    reached = {constraint.name for constraint in best.active}  # a limit with one bound on both sides counts once
    return len(reached) >= len(problem.spans) > 0


def tabulate_optimum(problem: Problem, best: Optimum, changes: Mapping[str, Record]) -> list[Table | str]:
    """The best design beside the unmodified one, its active constraints, and the best design for each choice.

    changes: differences of the responses, as of `design_differences`.
    """
    units = dict(zip(problem.study.columns, problem.study.units, strict=True))
    units |= {response.name: response.display_key for response in problem.study.responses}
    labels = {response.name: response.label for response in problem.study.responses}

    def text(name: str, value: Any) -> str:
        if isinstance(value, str):
            return value
        return DASH if math.isnan(value) else with_unit(value, units[name])

    assert best.start is not None
    start = {**best.start.responses, **best.start.values}
    both = {**best.responses, **best.values}
    names = {name: labels.get(name) or column_label(name) for name in both}
    aim = f"{'maximize' if problem.maximize else 'minimize'} {problem.objective.label}"
    compared = tuple(
        (names[name], text(name, start[name]), text(name, value), _change_text(start[name], value, changes.get(name)))
        for name, value in both.items()
    )
    marked = any(not change["distinct"] for change in changes.values())
    shared = ("±: 1σ of the difference; shared errors cancel.",) if changes else ()
    missing = (f"start: {best.start.failure}",) if best.start.failure else ()
    notes = (*shared, *((NOT_DISTINCT,) if marked else ()), *missing)
    active = [f"{names[name]} {sense} {text(name, bound)}" for name, sense, bound in best.active]
    tables: list[Table | str] = [
        f"{aim}: {counted(best.evaluations, 'design')} computed",
        Table("Best design", ("", "start", "best", "change"), compared, notes),
        f"active constraints: {', '.join(active) or 'none'}",
    ]
    if is_set_by_constraints(problem, best):
        tables.append(
            "The answer is your limits: as many constraints are active as there are numbers to choose. Only another "
            "limit or a wider range gives a better design."
        )
    if best.stop_reason:
        tables.append(f"not finished: {best.stop_reason}; more --iterations may find a better design")
    if best.choices:
        head = (*map(column_label, best.choices[0].values), problem.objective.heading, "")
        rows = tuple(
            (
                *(text(name, value) for name, value in choice.values.items()),
                DASH if choice.reason else shown(choice.objective, problem.objective.display_key),
                choice.reason,
            )
            for choice in best.choices
        )
        texts = (*range(len(head) - 2), len(head) - 1)
        tables.append(Table("Best design for each choice", head, rows, texts=texts))
    return tables
