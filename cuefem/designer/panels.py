"""The content of the tabs as markup and tables: the results of a session so far, or what is pending."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from html import escape
from typing import Any

from cuefem.analysis.report_page import report_parts
from cuefem.analysis.strike_models import regime_warning
from cuefem.designer.computation import CURVE_OFFSETS, OFFSET_STEP
from cuefem.designer.controls import KNOBS, label, value, value_text
from cuefem.designer.session import Session
from cuefem.endmass.definitions import DEFINITIONS
from cuefem.parameters.parts import shaft_word
from cuefem.quantity.display_units import format_change, to_display, with_heading
from cuefem.results.differences import difference_text
from cuefem.results.plausibility import plausibility_warnings
from cuefem.results.quantities import DASH, RESULTS
from cuefem.results.records import Record, Table
from cuefem.results.uncertainty import SHAFT_ERROR
from cuefem.scene import Scene
from cuefem.show.analysis import DESIGN_STYLES
from cuefem.show.charts import Axis, Curve, chart
from cuefem.show.offset_charts import offset_charts
from cuefem.show.templates import chart_markup, section_markup, shading_markup, table_markup

COMPUTING = '<p class="soft">computing …</p>'


def curves_markup(session: Session) -> str:
    """Squirt and pivot length against the offset, and the end-mass distribution, of one or two designs."""
    results = session.results
    sides = [
        (name, style, side)
        for name, style, side in zip(session.designs(), DESIGN_STYLES, (results.own, results.other), strict=False)
    ]
    drawn = [(name, style, side["curve"]) for name, style, side in sides if "curve" in side]
    if not drawn or "curve" not in results.own:
        return COMPUTING
    regimes = results.own["curve"]["regime"]
    offset = float(session.scene.stroke.offset)
    charts = [*offset_charts(drawn, CURVE_OFFSETS, offset, height=280, regimes=regimes)]
    curves = [
        Curve(name, to_display(side["end_mass_distribution"][0], "m"), side["end_mass_distribution"][1], style)
        for name, style, side in sides
        if "end_mass_distribution" in side
    ]
    if curves:
        charts.append(
            chart(
                "End mass added by 1 g (stick, without tip effects)",
                curves,
                x=Axis(with_heading("distance from the front of the drawing", "m"), 0.0),
                y=Axis("end mass, g"),
                height=280,
            )
        )
    figures = "".join(map(chart_markup, charts))
    missed = [b for b, regime in zip(CURVE_OFFSETS, regimes, strict=True) if regime == "miscue"]
    note = f"{session.step.design.name}: miscue from b/R {missed[0] - OFFSET_STEP / 2:.2f} on." if missed else ""
    of = f"({session.step.design.name})" if len(drawn) > 1 else ""
    return f'<div class="charts">{figures}</div>{shading_markup(charts[0], of)}<p class="soft">{escape(note)}</p>'


def tabulate_numbers(session: Session) -> Table | None:
    """Every number of the design and of the other one, and their differences."""
    results = session.results
    if "numbers" not in results.own:
        return None
    sides = [side["numbers"] for side in (results.own, results.other) if "numbers" in side]
    shown = [*session.designs().items()][: len(sides)]
    rows = [
        _number_row(name, [side.get(name) for side in sides], words, results.difference)
        for name, words in _names(results.own["numbers"], float(session.scene.stroke.offset))
    ]
    for k, _ in enumerate(results.own["numbers"]["frequencies"]):
        rows.append(_number_row("frequency", [side["frequencies"][k] for side in sides], f"natural frequency {k + 1}"))
    scenes = [design.scene for _, design in shown]
    for key, knob in KNOBS.items():
        cells = [_knob_text(key, scene) for scene in scenes]
        if knob.group and any(cell != DASH for cell in cells):
            alike = ["same" if cells[0] == cells[-1] else ""] if len(cells) > 1 else []
            rows.append((label(key, scenes[0]), *cells, *alike))
    head = ("", *(name for name, _ in shown), *(["difference"] if len(sides) > 1 else []))
    return Table(f"Numbers of {session.step.design.name}", head, tuple(rows))


def _names(numbers: Mapping[str, Any], offset: float) -> list[tuple[str, str]]:
    masses = [(f"end_mass_{name}", f"end mass, {known.label_at(offset)}") for name, known in DEFINITIONS.items()]
    own = [(name, RESULTS[name].label) for name in numbers if name in RESULTS and name != "frequencies"]
    return [*own, *masses]


def _number_row(name: str, values: Sequence[Any], words: str, difference: Record | None = None) -> tuple[str, ...]:
    result = RESULTS[name if name in RESULTS else "end_mass"]
    cells = [result.format(each) for each in values]
    if len(values) < 2:
        return (words, *cells)
    mine, other = values[:2]
    if name == "squirt" and difference:
        return (words, *cells, difference_text(difference["difference"], difference["error"]))
    part = DASH if not mine or not other else format_change(100 * (mine / other - 1), 1, "%")
    return (words, *cells, part)


def _knob_text(key: str, scene: Scene) -> str:
    own = value(key, scene)
    return DASH if own is None else own if KNOBS[key].range is None else value_text(key, own)


def tabulate_check(session: Session) -> list[Table]:
    """Checks of the design, and beam against solid once that is computed."""
    results = session.results
    rows = []
    if "verdict" in results.own:
        uncertainty = results.own["verdict"].uncertainty
        rows += [
            ("calculation error of squirt", f"{100 * uncertainty['computation']:.1g} %"),
            ("model error, RMS of published strokes", f"{100 * uncertainty['model']:.0f} %"),
            (f"{shaft_word(session.scene)} and tip, not measured", f"{100 * uncertainty['inputs']:.0f} %"),
            ("a change of squirt, relative uncertainty", f"{100 * SHAFT_ERROR:.0f} %"),
        ]
    if "solved_strike" in results.own:
        rows.append(("tip contact", regime_warning(results.own["solved_strike"].outcome.regime) or "no miscue"))
    rows += [("warning", line) for line in plausibility_warnings(session.scene)] or [("warnings", "none")]
    first = Table(f"Check of {session.step.design.name}", ("check", "result"), tuple(rows), texts=(0, 1))
    solid = results.own.get("solid")
    return [first] if solid is None else [first, solid.table()]


def tables_markup(sheets: Sequence[Table | None]) -> str:
    """Tables in the report's format."""
    return "".join(COMPUTING if each is None else table_markup(each) for each in sheets)


def sections_markup(session: Session) -> str:
    """Every section of the report in its order, closed, as the report's page shows it."""
    answers = session.results.own.get("answers")
    if answers is None:
        return COMPUTING
    return "".join(
        f"<details><summary><h2>{escape(part['title'])}</h2></summary>{section_markup(part)}</details>"
        for part in report_parts(answers.scene, answers.sections)
    )
