"""Words of a study's tables: parameters with their ranges and segments, values, and which designs lack responses."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from cuefem.cue import Array, Cue
from cuefem.cue.materials import material_name
from cuefem.designs.blocks import LOST
from cuefem.designs.evaluation import shortfalls
from cuefem.designs.sampling import Levels, Normal, Span
from cuefem.designs.study import Study, Vary
from cuefem.parameters.field_paths import Path
from cuefem.parameters.parts import Layout
from cuefem.parameters.scene_paths import SCENE_FIELDS
from cuefem.quantity.display_units import display_unit, displayed_system, number_text, short_number, span_text
from cuefem.results.records import Table
from cuefem.scene import Scene
from cuefem.show.scene_summary import stroke_line

_FIELD = re.compile(rf"({'|'.join(SCENE_FIELDS)})(\[[\d*]+\])?(\.\w+(\[[\d*]+\])?)+")
_ITEM = re.compile(r"(\w+)s\[(\d+|\*)\]")


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
        f"unless varied: {stroke_line(study.base)}, offset b/R {study.base.stroke.offset:.4g}",
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


def failure_lines(
    study: Study, designs: Mapping[str, np.ndarray], results: Array, failures: Mapping[int, str]
) -> list[str]:
    """How many designs failed or lack which responses, with the first of them and its reason.

    designs: values of each parameter by its name. results: (designs, responses). failures: reasons by the number of
    the design.
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
        reason = displayed_reason(study, study.scene_or_reason(tuple(values)), failures[number])
        lines.append(f"{text}, the first of them design {number} ({design}): {reason}")
    return lines


def displayed_reason(study: Study, design: Scene | str, reason: str) -> str:
    """The reason why a design (or an invalid one) lacks a response, in the units displayed; as data it is metric."""
    if displayed_system() == "metric" or reason == LOST:
        return reason
    return study.evaluate_scenes([design]).reasons[0] or reason
