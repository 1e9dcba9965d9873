"""Pages that begin with the first screen: that of a report, and that of compared cues."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from typing import Any

from cuefem.analysis import report_sections
from cuefem.analysis.comparison import Comparison, compare_cues
from cuefem.analysis.first_screen import HeadlineCue, comparison_lines, screen_markup
from cuefem.analysis.squirt_curve import FINE_OFFSETS
from cuefem.analysis.strike_models import regime_warning
from cuefem.analysis.verdict import Verdict, squirt_difference
from cuefem.files.defaults_report import Assumption
from cuefem.results.closed_forms import pivot_length
from cuefem.results.quantities import format_value
from cuefem.results.records import Record
from cuefem.results.solved_design import coupled_curve
from cuefem.scene import Scene
from cuefem.scene.solved_scene import SolvedScene
from cuefem.show.analysis import DESIGN_STYLES, Analysis
from cuefem.show.charts import Chart
from cuefem.show.glossary import with_glossary
from cuefem.show.offset_charts import offset_charts
from cuefem.show.scene_summary import assumptions, plain_cue_line, plain_effect_line, scene_record
from cuefem.show.templates import environment

Named = tuple[str, Scene]
Answers = Mapping[str, Analysis]


def page_of(
    scene: Scene,
    answers: Answers,
    regime: str,
    name: str,
    notes: Sequence[Assumption],
    warnings: Sequence[str],
    made: str = "",
    other: Named | None = None,
) -> str:
    """The computed answers of a report as HTML.

    answers: by the keys of `QUESTIONS`, a verdict among them. regime: of the contact. made: the date at the page's end.
    other: name and scene of a cue to compare with, with the same ball and stroke.
    """
    verdict: Any = answers["verdict"]
    calibrated = verdict.calibrated
    own = HeadlineCue(name, scene, _numbers(scene, answers), verdict)
    beside, difference = None, None
    parts = {key: part for key, part in report_sections().items() if key in answers and key != "verdict"}
    sections = [
        {
            "key": key,
            "title": part.title,
            "folded": part.folded,
            "about": answers[key].about,
            "charts": answers[key].charts(),
            "more": answers[key].more_charts(),
            "tables": answers[key].tables(),
        }
        for key, part in parts.items()
    ]
    if other is not None:
        compared = compare_cues({other[0]: other[1], name: scene})
        beside = HeadlineCue(*other, compared.cues[other[0]])
        difference = compared.differences[name].get("squirt")
        sections.insert(0, _beside(scene, answers, name, other, compared))
    return _page(
        [name, *filter(None, [other and other[0]]), *verdict.references],
        kind="report",
        name=name,
        title=f"{name}: squirt {format_value('squirt', verdict.squirt)}",
        made=made,
        notes=[*map(str, notes)],
        warnings=[
            *warnings,
            *filter(None, [regime_warning(regime)]),
            *(f"warning: {line}" for line in (calibrated.warnings if calibrated else ())),
        ],
        facts=_facts(scene),
        uncertainty=[verdict.uncertainty_line(), *([calibrated.basis()] if calibrated else [])],
        screen=screen_markup(own, [*filter(None, [beside])], comparison_lines(own, beside, difference)),
        sections=sections,
    )


def page_of_comparison(
    compared: Comparison, verdict: Verdict, notes: Sequence[Assumption], warnings: Sequence[str], made: str = ""
) -> str:
    """Compared cues as HTML: the first screen of the first one, which has this verdict, with the others beside it."""
    own, *others = [HeadlineCue(name, scene, compared.cues[name]) for name, scene in compared.scenes.items()]
    calibrated = compared.calibrated
    styles = dict(zip(compared.scenes, DESIGN_STYLES, strict=False))
    squirts = {name: each["squirt"] for name, each in compared.differences.items() if "squirt" in each}
    lines = [
        [(name, styles[name]), (f": {squirt_difference(**each).removesuffix(' than')}", "")]
        for name, each in squirts.items()
    ]
    lines += [[(text, "")] for text in filter(None, [compared.without_difference()])]
    lines += [[(name, styles[name]), (f", {each.headline()}", "")] for name, each in calibrated.items()]
    facts = {name: _facts(scene) for name, scene in compared.scenes.items()}
    shared = [fact for fact in facts[own.name] if all(fact in each for each in facts.values())]
    apart = [f"{name}: {fact}" for name, each in facts.items() for fact in each if fact not in shared]
    return _page(
        [*compared.scenes, *verdict.references],
        kind="compare",
        name=compared.heading(),
        title=f"{compared.heading()}: compared",
        made=made,
        notes=[*map(str, notes)],
        warnings=[*warnings, *(f"warning: {line}" for line in compared.calibration_warnings())],
        facts=[*apart, *shared],
        uncertainty=[
            f"{own.name}, {verdict.uncertainty_line()}",
            *(f"{name}: {each.basis()}" for name, each in calibrated.items()),
        ],
        screen=screen_markup(replace(own, verdict=verdict), others, lines, with_values=True),
        sections=[_section(compared, compared.curves())],
    )


def _page(cues: Iterable[str], **parts: Any) -> str:
    """The page of these parts, which page.html.j2 names. cues: names of the cues on it."""
    return with_glossary(environment().get_template("page.html.j2").render(**parts), cues) + "\n"


def _facts(scene: Scene) -> list[str]:
    """Cue, ball, tip, stroke and effects of a scene, each as a line."""
    return [
        plain_cue_line(scene.cue),
        f"{assumptions(scene_record(scene))}, offset b/R {scene.stroke.offset:.4g}",
        *map(plain_effect_line, scene.effects),
    ]


def _beside(scene: Scene, answers: Answers, name: str, other: Named, compared: Comparison) -> Record:
    """The section that compares with another cue."""
    beside = coupled_curve(other[1], FINE_OFFSETS, SolvedScene(other[1]).tip)
    curves = [(name, "c1", answers["squirt"].values()["models"]["coupled, this cue"]), (other[0], "c2", beside)]
    return _section(compared, offset_charts(curves, FINE_OFFSETS, scene.stroke.offset, height=300))


def _section(compared: Comparison, charts: Sequence[Chart]) -> Record:
    """The section of compared cues."""
    table = compared.table()
    made: Record = {"key": "other", "title": table.title, "folded": False, "about": "", "more": []}
    return made | {"charts": charts, "tables": [table]}


def _numbers(scene: Scene, answers: Answers) -> dict[str, float | None]:
    """The numbers of the first screen, SI."""
    numbers = answers["numbers"]
    shown: dict[str, Any] = dict(numbers.values())
    shown["pivot_length"] = pivot_length(scene, shown["squirt"])
    shown["end_mass_squirt"] = numbers.squirt_end_mass  # type: ignore[attr-defined]
    return shown
