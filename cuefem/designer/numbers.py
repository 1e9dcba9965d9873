"""The designer's numbers in words: values as the commands write them, and how they differ from a pinned design's."""

from __future__ import annotations

import math
from collections.abc import Sequence
from html import escape
from typing import NamedTuple

from cuefem.designer.answers import Answers, note
from cuefem.designer.model import cue_of
from cuefem.endmass.drives import DEFINITIONS
from cuefem.report.quantities import NONE, QUANTITIES, Known, significant
from cuefem.report.strike import MISCUE


class Row(NamedTuple):
    """A number: its name on the page, what it is in full, its value in SI (None if it has none), and its quantity."""

    name: str
    label: str
    value: float | None
    known: Known

    @property
    def text(self) -> str:
        """The value with its unit."""
        return self.known.written(self.value)


def rows(found: Answers) -> list[Row]:
    """All numbers of a design, each with its definition."""
    cue, strike, offset = cue_of(found.scene), found.strike, found.scene.stroke.offset
    labels = {one.name: f"end mass m_e, {one.label_at(offset)}" for one in DEFINITIONS.values()}
    pivot = strike["pivot_length"]

    def row(name: str, quantity: str, value: float | None, label: str = "") -> Row:
        known = QUANTITIES[quantity]
        return Row(name, label or known.label, value, known)

    return [
        row("squirt", "squirt", strike["squirt"], f"squirt, coupled, at b/R {offset:g}"),
        row("pivot", "pivot_length", None if pivot is None else float(pivot)),
        *(row(f"end_mass_{drive}", "end_mass", felt, labels[drive]) for drive, felt in found.end_masses.items()),
        row("shaft_mass", "shaft_mass", cue.shaft_mass),
        row("mass", "mass", cue.mass),
        row("balance", "balance_point", cue.balance_point),
        row("stiffness", "tip_stiffness", found.tip_stiffness, STIFFNESS),
        *(row(f"mode{i}", "frequencies", f, f"mode {i}") for i, f in enumerate(found.frequencies.tolist(), 1)),
    ]


STIFFNESS = f"{QUANTITIES['tip_stiffness'].label}, static, butt clamped"


def difference(row: Row, other: Row) -> str:
    """How much more a number is than another: in its unit and in percent."""
    if row.value is None or other.value is None or not (math.isfinite(row.value) and math.isfinite(other.value)):
        return NONE
    more, unit = row.value - other.value, row.known.shown_unit
    if abs(more) <= 1e-12 * abs(other.value):
        return "the same"
    space = "" if unit == "°" else " "
    sign = "+" if more > 0 else "−"
    part = f" ({100 * more / abs(other.value):+.1f}\u00a0%)".replace("-", "−") if other.value else ""
    return f"{sign}{significant(abs(more) * row.known.scale, 3)}{space}{unit}{part}"


def table_markup(found: Answers, pinned: Answers | None) -> str:
    """All numbers as a table, beside those of a pinned design."""
    mine, theirs = rows(found), {row.name: row for row in rows(pinned)} if pinned else {}
    heads = ["", "this design", *(["pinned", "difference"] if pinned else [])]
    head = "".join(f'<th scope="col">{words}</th>' for words in heads)
    body = "".join(_line(row, theirs.get(row.name)) for row in mine)
    return f'<div class="scroll"><table><thead><tr>{head}</tr></thead><tbody>{body}</tbody></table></div>'


def _line(row: Row, other: Row | None) -> str:
    cells = [row.text, *([other.text, difference(row, other)] if other else [])]
    first, *rest = (escape(cell) for cell in cells)
    label = escape(row.label if other is None or other.label == row.label else f"{row.label} (pinned: {other.label})")
    others = "".join(f"<td>{cell}</td>" for cell in rest)
    return f'<tr><th class="text" scope="row">{label}</th><td data-number="{row.name}">{first}</td>{others}</tr>'


KEYS = {
    "squirt": ("squirt", "coupled strike at this offset"),
    "pivot": ("natural pivot length", "pivot about this point and squirt cancels"),
    "end_mass_stick": ("end mass m<sub>e</sub>", "felt by the ball, small offsets"),
    "stiffness": ("shaft stiffness at the tip", "static, butt end clamped"),
    "balance": ("balance point", "of the drawn part, from the tip"),
    "shaft_mass": ("mass", "of the drawn part"),
}


def key_markup(found: Answers, pinned: Answers | None) -> str:
    """The numbers that matter most, each with its definition or its difference from the pinned design's."""
    mine, theirs = ({row.name: row for row in rows(one)} if one else {} for one in (found, pinned))
    parts = []
    for name, (label, remark) in KEYS.items():
        said = difference(mine[name], theirs[name]) if theirs else remark
        value = escape(mine[name].text)
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
