"""The designer's numbers in words: values as the commands write them, side by side with those of pinned designs."""

from __future__ import annotations

import math
from collections.abc import Sequence
from html import escape
from typing import NamedTuple

from cuefem.designer.answers import TONES, Answers, note
from cuefem.designer.design import Design
from cuefem.designer.sliders import choices, sliders
from cuefem.designer.unit_system import METRIC, UnitSystem
from cuefem.endmass.definitions import DEFINITIONS
from cuefem.report import table
from cuefem.report.glossary import subscripts
from cuefem.report.strike_table import MISCUE
from cuefem.report.templates import verdict_markup as as_verdict
from cuefem.report.trust import trust_lines
from cuefem.report.verdict_table import squirt_words, verdict_part
from cuefem.results.quantities import NONE, RESULTS, Result, signed, significant
from cuefem.scene import Scene

WAITING = "…"
DIGITS = 4  # of a number that are shown: a difference has no finer ones


class NumberRow(NamedTuple):
    """A number: its name on the page, what it is in full, its value in SI (None if it has none), and its quantity."""

    name: str
    label: str
    value: float | None
    known: Result
    waiting: bool = False  # it is not computed yet

    def text(self, system: UnitSystem = METRIC) -> str:
        """The value with its unit."""
        return WAITING if self.waiting else self.known.written(self.value, units=system.units)

    def number(self, system: UnitSystem = METRIC) -> str:
        """The value without its unit; a dash if there is none."""
        if self.value is None or not math.isfinite(self.value):
            return WAITING if self.waiting else NONE
        return self.known.number(self.value, units=system.units)


def rows(answers: Answers) -> list[NumberRow]:
    """All numbers of a design, each with its definition."""
    strike, offset = answers.strike, answers.scene.stroke.offset
    labels = {definition.name: f"end mass m_e, {definition.label_at(offset)}" for definition in DEFINITIONS.values()}
    pivot = strike["pivot_length"]
    later = not answers.has_end_mass
    tones = [None] * TONES if later else answers.frequencies.tolist()

    def row(name: str, quantity: str, value: float | None, label: str = "") -> NumberRow:
        known = RESULTS[quantity]
        return NumberRow(name, label or known.words, value, known)

    return [
        row("squirt", "squirt", strike["squirt"], f"squirt, coupled, at b/R {offset:.4g}"),
        row("pivot", "pivot_length", None if pivot is None else float(pivot)),
        *(
            row(f"end_mass_{drive}", "end_mass", answers.end_masses.get(drive), labels[drive])._replace(
                waiting=drive not in answers.end_masses
            )
            for drive in DEFINITIONS
        ),
        *(
            row(SHORT.get(name, name), name, answers.numbers.get(name))._replace(waiting=name not in answers.numbers)
            for name, result in RESULTS.items()
            if result.of is not None and result.listed and name != "squirt"
        ),
        *(row(f"mode{i}", "frequencies", f, f"mode {i}")._replace(waiting=later) for i, f in enumerate(tones, 1)),
    ]


# What the page calls some results, in its links and for its script.
SHORT = {"balance_point": "balance", "tip_stiffness": "stiffness"}


def percent(value: float | None, other: float | None) -> str:
    """How much more a number is than another, in percent; a dash if one is missing, or the other is 0."""
    if value is None or other is None or not (math.isfinite(value) and math.isfinite(other)):
        return NONE
    if abs(value - other) <= 1e-12 * abs(other):
        return "the same"
    if not other:
        return NONE
    return signed(100 * (value - other) / abs(other), 1, "%")


def difference(row: NumberRow, other: NumberRow, system: UnitSystem = METRIC) -> str:
    """How much more a number is than another: in its unit and in percent."""
    part = percent(row.value, other.value)
    if row.value is None or other.value is None or part == "the same":
        return part
    more, (scale, unit) = row.value - other.value, row.known.shown_in(system.units)
    if not math.isfinite(more):
        return NONE
    space = "" if unit == "°" else " "
    powers = (math.floor(math.log10(size)) for size in (abs(more), max(abs(row.value), abs(other.value))))
    digits = min(3, DIGITS + next(powers) - next(powers))
    if digits < 1:
        return "the same to four digits"
    sign = "+" if more > 0 else "−"
    said = f"{sign}{significant(abs(more) * scale, digits)}{space}{unit}"
    return said if part == NONE else f"{said} ({part})"


class Column(NamedTuple):
    """A design beside others; answers: None while it is computed."""

    design: Design
    answers: Answers | None


class Line(NamedTuple):
    """A row of the comparison: every design's number in the unit, and its difference from one design's in percent."""

    name: str
    label: str
    unit: str
    numbers: list[str]
    parts: list[str]

    def text(self, i: int) -> str:
        """A design's number with its unit."""
        number = self.numbers[i]
        space = "" if self.unit in ("", "°") else " "
        return number if number in (WAITING, NONE) else f"{number}{space}{self.unit}"


def compared(columns: Sequence[Column], reference: int, system: UnitSystem) -> list[Line]:
    """All numbers of all designs, then the settings in which they differ. reference: the one compared with."""
    tables = [rows(column.answers) if column.answers else None for column in columns]
    lines = []
    for i, row in enumerate(next(listed for listed in tables if listed)):
        beside = [listed[i] if listed else None for listed in tables]
        same = len({listed.label for listed in beside if listed}) == 1
        lines.append(
            Line(
                row.name,
                row.label if same else row.label.partition(" at b/R")[0].rstrip(","),
                row.known.shown_in(system.units)[1],
                [listed.number(system) if listed else WAITING for listed in beside],
                _parts([listed.value if listed else None for listed in beside], reference),
            )
        )
    return [*lines, *_settings([column.design for column in columns], reference, system)]


def _parts(values: Sequence[float | None], reference: int) -> list[str]:
    """Differences in percent from one of the values, which has none itself; empty where there is nothing to say."""
    if len(values) == 1:
        return [""]
    return ["" if i == reference else percent(value, values[reference]) for i, value in enumerate(values)]


def _settings(designs: Sequence[Design], reference: int, system: UnitSystem) -> list[Line]:
    """The knobs that do not stand alike in all designs."""
    turned = [{slider.knob: slider for slider in sliders(design.scene, system)} for design in designs]
    chosen = [{choice.knob: choice for choice in choices(design.scene)} for design in designs]
    lines = []
    for knob, known in {knob: knobs[knob] for knobs in reversed(turned) for knob in knobs}.items():
        beside = list(zip(turned, designs, strict=True))
        numbers = [knobs[knob].text(knobs[knob].shown(d.knobs)) if knob in knobs else NONE for knobs, d in beside]
        if len(set(numbers)) > 1:
            values = [design.knobs.get(knob) for design in designs]
            lines.append(Line(knob, known.label.partition(", from")[0], known.unit, numbers, _parts(values, reference)))
    for knob, label in {knob: knobs[knob].label for knobs in chosen for knob in knobs}.items():
        names = [knobs[knob].name(d.knobs) if knob in knobs else NONE for knobs, d in zip(chosen, designs, strict=True)]
        if len(set(names)) > 1:
            lines.append(Line(knob, label, "", names, [""] * len(designs)))
    return lines


THIS = "this design"


def table_markup(columns: Sequence[Column], reference: int, system: UnitSystem = METRIC) -> str:
    """All numbers as a table, a column for every design; the first is the one in work."""
    names = [THIS, *(column.design.name for column in columns[1:])]
    head = "".join(f'<th scope="col">{escape(name)}</th>' for name in ["number", *names])
    body = "".join(map(_line, compared(columns, reference, system)))
    return f'<div class="scroll"><table><thead><tr>{head}</tr></thead><tbody>{body}</tbody></table></div>'


def _line(line: Line) -> str:
    first, *others = (
        f"<span>{escape(line.text(i))}</span>" + (f" <small>{escape(part)}</small>" if part else "")
        for i, part in enumerate(line.parts)
    )
    cells = "".join(f"<td>{cell}</td>" for cell in others)
    named = first.replace("<span>", f'<span data-number="{line.name}">', 1)
    return f'<tr><th class="text" scope="row">{subscripts(escape(line.label))}</th><td>{named}</td>{cells}</tr>'


def csv_text(columns: Sequence[Column], reference: int, system: UnitSystem = METRIC) -> str:
    """The table as CSV: for every design its numbers and, beside others, how much they differ, in percent."""
    names = [THIS, *(column.design.name for column in columns[1:])]
    differing = [len(columns) > 1 and i != reference for i in range(len(columns))]
    head = ["", "unit"]
    for name, differs in zip(names, differing, strict=True):
        head += [name, f"{name}, % from {names[reference]}"] if differs else [name]
    rows = []
    for line in compared(columns, reference, system):
        cells = [line.label, line.unit]
        for number, part, differs in zip(line.numbers, line.parts, differing, strict=True):
            said = part.removesuffix("\u00a0%").replace("−", "-").replace("the same", "0")
            cells += [number, said] if differs else [number]
        rows.append(cells)
    return table.csv_text(head, rows)


KEYS = {
    "squirt": ("squirt", "coupled strike at this offset"),
    "pivot": ("natural pivot length", "pivot about this point and squirt cancels"),
    "end_mass_stick": ("end mass m<sub>e</sub>", "felt by the ball, small offsets"),
    "stiffness": ("shaft stiffness at the tip", "static, butt end clamped"),
    "balance": ("balance point", "of the drawn part, from the tip"),
    "shaft_mass": ("mass", "of the drawn part"),
}


def key_markup(
    answers: Answers, other: Answers | None, system: UnitSystem = METRIC, before: Answers | None = None
) -> str:
    """The numbers that matter most, each with its definition or its difference from the design compared with.

    before: the last design with all of them; its own stand, pale, where a number is not computed yet.
    """
    mine, theirs, last = ({row.name: row for row in rows(each)} if each else {} for each in (answers, other, before))
    parts = []
    for name, (label, remark) in KEYS.items():
        row = last.get(name, mine[name]) if mine[name].waiting else mine[name]
        said = difference(row, theirs[name], system) if theirs and not theirs[name].waiting else remark
        if name == "squirt" and not theirs and answers.verdict and not answers.verdict["head_on"]:
            said = f"± {squirt_words(answers.verdict)[1]}, at this offset"
        pale = ' class="stale"' if mine[name].waiting else ""
        value = f'<b data-key="{name}"{pale}>{escape(row.text(system))}</b>'
        parts.append(f"<div><dt>{label}</dt><dd>{value}<small>{escape(said)}</small></dd></div>")
    return f'<dl class="key">{"".join(parts)}</dl>{_warned(answers.safety)}'


def verdict_markup(answers: Answers) -> str:
    """The squirt with its uncertainty, and where it stands among the ready cues; nothing until that is computed."""
    return as_verdict(verdict_part(answers.verdict)) if answers.verdict else ""


def trust_markup(scene: Scene) -> str:
    """How far the numbers can be trusted, folded away."""
    lines = "".join(f"<p>{escape(line)}</p>" for line in trust_lines(scene))
    return f"<details><summary>How far to trust it</summary>{lines}</details>"


LATE = "near a miscue: the tip slips through much of this blow, and squirt is larger for it"


def _warned(safety: str) -> str:
    said = {"miscue": MISCUE, "slips": LATE}.get(safety)
    return f'<p class="miscue">{escape(said)}</p>' if said else ""


def tones_markup(frequencies: Sequence[float]) -> str:
    """A button for every tone, with its note."""
    buttons = (
        f'<button type="button" class="tone" data-hz="{hertz:.3f}"><span class="spoken">play mode {i}: </span>'
        f"▶ {hertz:.1f} Hz <small>{escape(note(hertz))} ct</small></button>"
        for i, hertz in enumerate(frequencies, 1)
    )
    return f'<p class="tones">{"".join(buttons)}</p>'
