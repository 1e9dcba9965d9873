"""Pages that begin with the first screen: that of a report, and the parts that a page of compared cues has, too."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import Any, NamedTuple

from cuefem.analysis import report_sections
from cuefem.analysis.first_screen import HeadlineCue, comparison_lines, cue_names, screen_markup
from cuefem.analysis.page_notes import page_notes
from cuefem.analysis.squirt_curve import FINE_OFFSETS, OWN
from cuefem.analysis.strike_models import regime_warning
from cuefem.files.defaults_report import STROKE, TIP, Assumption
from cuefem.results.closed_forms import pivot_length
from cuefem.results.quantities import format_value
from cuefem.results.records import Record, Table
from cuefem.results.solved_design import coupled_curve
from cuefem.scene import Scene
from cuefem.scene.solved_scene import SolvedScene
from cuefem.show.analysis import Analysis, PageFrame
from cuefem.show.charts import Chart
from cuefem.show.glossary import with_glossary
from cuefem.show.offset_charts import offset_charts
from cuefem.show.scene_summary import cue_line, plain_effect_line, stroke_line
from cuefem.show.templates import framed

Answers = Mapping[str, Analysis]


class Beside(NamedTuple):
    """A cue beside that of a report: its numbers, the difference of squirt from it, if any, and the table of both."""

    cue: HeadlineCue
    difference: Record | None
    table: Table


def page_of(scene: Scene, answers: Answers, regime: str, frame: PageFrame, beside: Beside | None = None) -> str:
    """The computed answers of a report as HTML.

    answers: by the keys of `QUESTIONS`, a verdict among them. regime: of the contact. beside: a cue to compare with,
    with the same ball and stroke.
    """
    name = frame.name
    verdict: Any = answers["verdict"]
    calibrated = verdict.calibrated
    own = headline_cue(scene, answers, name)
    sections = [part for part in report_parts(scene, answers) if part["key"] != "verdict"]
    others = [] if beside is None else [beside.cue]
    if beside is not None:
        sections.insert(0, _beside(scene, answers, name, beside, verdict.factor))
    lines = comparison_lines(own) if beside is None else comparison_lines(own, beside.cue, beside.difference)
    advice: Any = answers.get("advice")
    if advice is not None and advice.together:
        lines = [*lines, [(advice.together_lines()[0], "")]]
    return page(
        cue_names(own, others),
        inline=frame.inline,
        kind="report",
        name=name,
        title=f"{name}: squirt {format_value('squirt', verdict.squirt)}",
        made=frame.made,
        notes=[*map(str, verdict.by_part(frame.assumptions))],
        warnings=[
            *frame.warnings,
            *filter(None, [regime_warning(regime)]),
            *(calibrated.warning_lines() if calibrated else ()),
        ],
        facts=facts(scene),
        uncertainty=[verdict.uncertainty_line()],
        screen=screen_markup(own, others, lines),
        sections=[part for part in sections if not part["engineer"]],
        engineers=[part for part in sections if part["engineer"]],
        engineers_open=_is_for_engineers(scene, name, frame.assumptions),
    )


def report_parts(scene: Scene, answers: Answers) -> list[Record]:
    """The sections of a page: each answer in the order of the report, then the notes on a stroke."""
    sections = [
        _section(
            key,
            part.title,
            answers[key].tables(),
            answers[key].charts(),
            folded=part.folded,
            engineer=part.engineer,
            about=answers[key].about,
            more=answers[key].more_charts(),
        )
        for key, part in report_sections().items()
        if key in answers
    ]
    stroke: Any = answers.get("strike")
    if stroke is None:
        return sections
    verdict: Any = answers.get("verdict")
    coupled, factor = stroke.models["coupled"], 1.0 if verdict is None else verdict.factor
    notes = page_notes(scene, factor * coupled["squirt"], coupled["error"])
    return [
        *sections,
        *(_section(key, title, tables, folded=True, engineer=True) for key, (title, tables) in notes.items()),
    ]


def _section(
    key: str,
    title: str,
    tables: Sequence[Any],
    charts: Sequence[Any] = (),
    *,
    folded: bool,
    engineer: bool,
    about: str = "",
    more: Sequence[Any] = (),
) -> Record:
    """A section of a page; folded: closed at first. engineer: a part for engineers. more: charts folded below it."""
    shown = {"key": key, "title": title, "tables": tables, "charts": charts, "about": about, "more": more}
    return {**shown, "folded": folded, "engineer": engineer}


def _is_for_engineers(scene: Scene, name: str, notes: Sequence[Assumption]) -> bool:
    """Whether the parts for engineers are open: of a lumped cue, Kim's, a scene with its own tip or stroke."""
    is_default = any(each.of in (TIP, STROKE) for each in notes)
    return scene.lumped is not None or name == "kim" or not is_default


def page(
    cues: Iterable[str],
    *,
    inline: bool = False,
    engineers: Sequence[Record] = (),
    engineers_open: bool = False,
    **parts: Any,
) -> str:
    """The page of these parts, which page.html.j2 names.

    cues: names of the cues on it. inline: for a notebook. engineers: the sections for engineers, folded unless
    ``engineers_open``.
    """
    made = framed("page.html.j2", inline=inline, engineers=engineers, engineers_open=engineers_open, **parts)
    return made if inline else with_glossary(made, cues) + "\n"


def facts(scene: Scene) -> list[str]:
    """Cue, ball, tip, stroke and effects of a scene, each as a line."""
    return [
        cue_line(scene.cue),
        f"{stroke_line(scene)}, offset b/R {scene.stroke.offset:.4g}",
        *map(plain_effect_line, scene.effects),
    ]


def _beside(scene: Scene, answers: Answers, name: str, beside: Beside, squirt_factor: float) -> Record:
    """The section that compares with another cue, which carries the same squirt factor."""
    other = beside.cue
    curve = coupled_curve(other.scene, FINE_OFFSETS, SolvedScene(other.scene).tip, squirt_factor)
    curves = [(name, "c1", answers["squirt"].values()["models"][OWN]), (other.name, "c2", curve)]
    return section_of(beside.table, offset_charts(curves, FINE_OFFSETS, scene.stroke.offset, height=300))


def section_of(table: Table, charts: Sequence[Chart]) -> Record:
    """The section of compared cues."""
    return _section("other", table.title, [table], charts, folded=False, engineer=False)


def headline_cue(scene: Scene, answers: Answers, name: str) -> HeadlineCue:
    """The cue of a report's answers with the numbers of the first screen, SI."""
    numbers = answers["numbers"]
    shown: dict[str, Any] = dict(numbers.values())
    shown["pivot_length"] = pivot_length(scene, shown["squirt"])
    modes: Any = answers.get("modes")
    shown["frequency_1"] = modes.frequencies[0] if modes else None
    verdict: Any = answers["verdict"]
    return HeadlineCue(name, scene, shown, verdict)
