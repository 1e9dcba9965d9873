"""The designer's numbers in words: values as the commands write them, and how they differ from a pinned design's."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from html import escape
from typing import NamedTuple

from cuefem.designer.answers import Answers, note
from cuefem.designer.model import cue_of
from cuefem.endmass.drives import DEFINITIONS
from cuefem.report.strike import MISCUE
from cuefem.report.table import NONE
from cuefem.report.words import degrees, grams, millimetres, significant


class Row(NamedTuple):
    """A number: its name on the page, what it is, SI (None: there is none), how it is written, and a unit's size."""

    name: str
    label: str
    value: float | None
    written: Callable[[float], str]
    unit: str
    scale: float


def rows(found: Answers) -> list[Row]:
    """All numbers of a design, each with its definition."""
    cue, strike, offset = cue_of(found.scene), found.strike, found.scene.stroke.offset
    labels = {one.name: f"end mass m_e, {one.label_at(offset)}" for one in DEFINITIONS.values()}
    pivot = strike["pivot_length"]
    return [
        Row("squirt", f"squirt, coupled, at b/R {offset:g}", strike["squirt"], degrees, "°", 180 / math.pi),
        Row("pivot", "natural pivot length", None if pivot is None else float(pivot), millimetres, "mm", 1e3),
        *(Row(f"end_mass_{drive}", labels[drive], felt, grams, "g", 1e3) for drive, felt in found.end_masses.items()),
        Row("shaft_mass", "mass of what is drawn", cue.shaft_mass, grams, "g", 1e3),
        Row("mass", "mass of the cue", cue.mass, grams, "g", 1e3),
        Row("balance", "balance point of what is drawn, from the tip", cue.balance_point, _tenths, "mm", 1e3),
        Row("stiffness", "static stiffness at the tip, butt clamped", found.tip_stiffness, _stiffness, "N/m", 1.0),
        *(Row(f"mode{i}", f"mode {i}", f, _hertz, "Hz", 1.0) for i, f in enumerate(found.frequencies.tolist(), 1)),
    ]


def _tenths(length: float) -> str:
    return f"{1e3 * length:.1f} mm"


def _stiffness(value: float) -> str:
    return f"{significant(value)} N/m"


def _hertz(frequency: float) -> str:
    return f"{frequency:.2f} Hz"


def _text(row: Row) -> str:
    return NONE if row.value is None or not math.isfinite(row.value) else row.written(row.value)


def difference(row: Row, other: Row) -> str:
    """How much more a number is than another: in its unit and in percent."""
    if row.value is None or other.value is None or not (math.isfinite(row.value) and math.isfinite(other.value)):
        return NONE
    more = row.value - other.value
    if abs(more) <= 1e-12 * abs(other.value):
        return "the same"
    space = "" if row.unit == "°" else " "
    sign = "+" if more > 0 else "−"
    part = f" ({100 * more / abs(other.value):+.1f}\u00a0%)".replace("-", "−") if other.value else ""
    return f"{sign}{significant(abs(more) * row.scale, 3)}{space}{row.unit}{part}"


def table_markup(found: Answers, pinned: Answers | None) -> str:
    """All numbers as a table, beside those of a pinned design."""
    mine, theirs = rows(found), {row.name: row for row in rows(pinned)} if pinned else {}
    heads = ["", "this design", *(["pinned", "difference"] if pinned else [])]
    head = "".join(f'<th scope="col">{words}</th>' for words in heads)
    body = "".join(_line(row, theirs.get(row.name)) for row in mine)
    return f'<div class="scroll"><table><thead><tr>{head}</tr></thead><tbody>{body}</tbody></table></div>'


def _line(row: Row, other: Row | None) -> str:
    cells = [_text(row), *([_text(other), difference(row, other)] if other else [])]
    first, *rest = (escape(cell) for cell in cells)
    label = escape(row.label if other is None or other.label == row.label else f"{row.label} (pinned: {other.label})")
    others = "".join(f"<td>{cell}</td>" for cell in rest)
    return f'<tr><th class="text" scope="row">{label}</th><td data-number="{row.name}">{first}</td>{others}</tr>'


KEYS = {
    "squirt": ("squirt", "coupled, at this offset"),
    "pivot": ("pivot length", "natural: turned there, no squirt"),
    "end_mass_stick": ("end mass m<sub>e</sub>", "stick: at small offsets"),
    "stiffness": ("tip stiffness", "static, butt end clamped"),
    "balance": ("balance point", "from the tip, as drawn"),
    "shaft_mass": ("mass", "as drawn, no body"),
}


def key_markup(found: Answers, pinned: Answers | None) -> str:
    """The numbers that matter most, each with its definition or its difference from the pinned design's."""
    mine, theirs = ({row.name: row for row in rows(one)} if one else {} for one in (found, pinned))
    parts = []
    for name, (label, remark) in KEYS.items():
        said = difference(mine[name], theirs[name]) if theirs else remark
        value = escape(_text(mine[name]))
        parts.append(
            f'<div><dt>{label}</dt><dd><b data-key="{name}">{value}</b><small>{escape(said)}</small></dd></div>'
        )
    missed = f'<p class="miscue">{escape(MISCUE)}</p>' if found.strike["regime"] == "miscue" else ""
    return f'<dl class="key">{"".join(parts)}</dl>{missed}'


def tones_markup(frequencies: Sequence[float]) -> str:
    """A button for every tone, with its note."""
    buttons = (
        f'<button type="button" class="tone" data-hz="{hertz:.3f}" aria-label="play mode {i}, {hertz:.1f} hertz">'
        f"▶ {hertz:.1f} Hz <small>{escape(note(hertz))} ct</small></button>"
        for i, hertz in enumerate(frequencies, 1)
    )
    return f'<p class="tones">{"".join(buttons)}</p>'
