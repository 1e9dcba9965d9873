"""The page of a report: the first screen, then every section with its charts and tables."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from cuefem.analysis import report_sections
from cuefem.analysis.comparison import Comparison, compare_cues
from cuefem.analysis.first_screen import (
    HeadlineCue,
    drawings_markup,
    headline_markup,
    parts_line,
    scale_markup,
    tiles_markup,
)
from cuefem.analysis.squirt_curve import FINE_OFFSETS
from cuefem.analysis.strike_models import regime_warning
from cuefem.files.defaults_report import Assumption
from cuefem.results.closed_forms import pivot_length
from cuefem.results.quantities import format_value
from cuefem.results.records import Record
from cuefem.results.solved_design import coupled_curve
from cuefem.scene import Scene
from cuefem.scene.solved_scene import SolvedScene
from cuefem.show.analysis import Analysis
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
    about = scene_record(scene)
    verdict: Any = answers["verdict"]
    calibrated = verdict.calibrated
    compared = None if other is None else compare_cues({other[0]: other[1], name: scene})
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
    if other is not None and compared is not None:
        sections.insert(0, _comparison(scene, answers, name, other, compared))
    text = (
        environment()
        .get_template("page.html.j2")
        .render(
            name=name,
            made=made,
            notes=[*map(str, notes)],
            warnings=[
                *warnings,
                *filter(None, [regime_warning(regime)]),
                *(f"warning: {line}" for line in (calibrated.warnings if calibrated else ())),
            ],
            facts=[
                plain_cue_line(scene.cue),
                f"{assumptions(about)}, offset b/R {scene.stroke.offset:.4g}",
                *map(plain_effect_line, scene.effects),
            ],
            squirt=format_value("squirt", verdict.squirt),
            uncertainty=[verdict.uncertainty_line(), *([calibrated.basis()] if calibrated else [])],
            screen=_screen(scene, answers, name, other, compared),
            sections=sections,
        )
    )
    return with_glossary(text) + "\n"


def _comparison(scene: Scene, answers: Answers, name: str, other: Named, compared: Comparison) -> Record:
    """The section that compares with another cue."""
    beside = coupled_curve(other[1], FINE_OFFSETS, SolvedScene(other[1]).tip)
    curves = [(name, "c1", answers["squirt"].values()["models"]["coupled, this cue"]), (other[0], "c2", beside)]
    table = compared.table()
    charts = offset_charts(curves, FINE_OFFSETS, scene.stroke.offset, height=300)
    made: Record = {"key": "other", "title": table.title, "folded": False, "about": "", "more": []}
    return made | {"charts": charts, "tables": [table]}


def _screen(
    scene: Scene, answers: Answers, name: str, other: Named | None, compared: Comparison | None
) -> dict[str, str]:
    """The parts of the first screen as markup."""
    numbers = answers["numbers"]
    shown: dict[str, Any] = dict(numbers.values())
    shown["pivot_length"] = pivot_length(scene, shown["squirt"])
    shown["end_mass_squirt"] = numbers.squirt_end_mass  # type: ignore[attr-defined]
    verdict: Any = answers["verdict"]
    mine, beside, difference = HeadlineCue(name, scene, shown, verdict), None, None
    if other is not None and compared is not None:
        beside = HeadlineCue(*other, compared.cues[other[0]])
        difference = compared.differences[name].get("squirt")
    scenes = {name: scene} | ({} if other is None else {other[0]: other[1]})
    return {
        "headline": headline_markup(mine, beside, difference),
        "scale": scale_markup(mine, beside),
        "tiles": tiles_markup(mine, beside),
        "drawings": drawings_markup(scenes) if scene.cue.segments else "",
        "parts": parts_line(verdict),
    }
