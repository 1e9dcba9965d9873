"""The report as one self-contained HTML page, with inline drawings, style and script."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from typing import Any

from cuefem.contact.strike import strike_modes
from cuefem.cue.materials import material_name
from cuefem.design.design_changes import design_changes
from cuefem.endmass.definitions import DEFINITIONS
from cuefem.results.closed_forms import alciatore_a31_mass_ratio
from cuefem.results.comparison import comparison_record
from cuefem.results.convergence import resolve
from cuefem.results.quantities import DASH, RESULTS, format_value
from cuefem.results.records import Record, Table, tabulate_values, value_rows
from cuefem.results.solved_design import coupled_curve
from cuefem.scene import Outcome, Scene
from cuefem.scene.solved_scene import SolvedScene
from cuefem.show.charts import Chart
from cuefem.show.comparison_table import tabulate_comparison
from cuefem.show.contact_charts import contact_section
from cuefem.show.design_changes_table import tabulate_design_changes
from cuefem.show.drawings import modes_chart
from cuefem.show.end_mass_table import tabulate_end_masses
from cuefem.show.first_screen import (
    HeadlineCue,
    drawings_markup,
    headline_markup,
    parts_line,
    scale_markup,
    tiles_markup,
)
from cuefem.show.glossary import with_glossary
from cuefem.show.impact_table import tabulate_impacts
from cuefem.show.modes_table import tabulate_modes
from cuefem.show.report_sections import report_record
from cuefem.show.scene_summary import assumptions, plain_cue_line, plain_effect_line, scene_record
from cuefem.show.squirt_table import offset_charts
from cuefem.show.strike_table import regime_warning, strike_record, tabulate_strike
from cuefem.show.templates import environment
from cuefem.show.verdict_table import headline, uncertainty_line

PAGE_OFFSETS = tuple(round(0.03 * i, 2) for i in range(1, 21))  # b/R of the curves
# Notes on the accuracy of the model; its size is in `cuefem.results.uncertainty`.
LAW = (
    "The tip is modelled as elastic leather of given height, dome and E. Its compliance is that of the elastic solid "
    "to 0.3 % (95 % of the contacts of 36 tips) and 2.0 % (maximum of 20 others); it has not been tested on real tips. "
    "Computed squirt of soft leather is 9 % below medium, of hard 3 % below (b/R 0.3); players find no difference, to "
    "±5 % at best. Do not choose a tip's hardness by this number."
)
SPRING = (
    "The tip is modelled as a linear spring with the given contact time. No real tip was measured for it, and squirt "
    "depends on it: for a spring tip without dome and shear by 50 % from 0.7 to 2 ms."
)
COMPARING = (
    "A ratio of two designs is more accurate than the squirt of one: a low-deflection shaft was measured with 0.72 "
    "of the squirt of a maple shaft; the model computes 0.70 to 0.78 (handbook: Measured squirt)."
)
# CSS classes of the models' curves.
STYLES = {"coupled, this cue": "c1", "lumped, this cue": "c2", "two-part, this cue": "c3", "two-part, 12 g": "c5"}
STYLES |= {"A.31, this cue": "c4"}


def page(name: str, scene: Scene, **about: Any) -> str:
    """The report of a scene as HTML. about: arguments of `page_and_headline`."""
    return page_and_headline(name, scene, **about)[0]


def page_and_headline(
    name: str,
    scene: Scene,
    *,
    rtol: float | None = None,
    notes: Sequence[str] = (),
    warnings: Sequence[str] = (),
    other: tuple[str, Scene] | None = None,
    progress: Any = iter,
) -> tuple[str, str]:
    """The report of a scene as HTML, and its headline.

    Parameters
    ----------
    name : str
        The title of the page.
    scene : Scene
        The stroke to report.
    rtol : float, optional
        Relative numerical error target of the strike; by default that of a default strike.
    notes, warnings : sequence of str
        Assumptions, and warnings of implausible values.
    other : tuple of str and Scene, optional
        Name and scene of a cue to compare with, with the same ball and stroke.
    progress : callable
        Iterates over the stages with a progress bar.

    Returns
    -------
    tuple of str
        The page, and squirt with its uncertainty in one line.
    """
    solved = SolvedScene(scene)
    stages: dict[str, Callable[[], Any]] = {
        "outcome": lambda: strike_modes(scene, solved.tip) if rtol is None else resolve(scene, rtol),
        "report": lambda: report_record(scene, offsets=PAGE_OFFSETS, solved=solved, outcome=records["outcome"]),
        "strike": lambda: strike_record(scene, records["outcome"], solved=solved),
    }
    if scene.lumped is None:
        stages["advice"] = lambda: design_changes(scene, solved=solved)
    if other is not None:
        stages["comparison"] = lambda: comparison_record({other[0]: other[1], name: scene})
        stages["other"] = lambda: coupled_curve(other[1], PAGE_OFFSETS, SolvedScene(other[1]).tip)
    records: Record = {}
    for key, work in progress([*stages.items()]):
        records[key] = work()
    records |= records.pop("report")
    if "no_squirt" in records:
        raise ValueError(records["no_squirt"])
    lines = {"notes": list(notes), "warnings": list(warnings)}
    context = _context(scene, records) | {"screen": _screen(name, scene, records, other), "comparison": None}
    if other is not None:
        curves = {name: records["squirt"]["models"]["coupled, this cue"], other[0]: records["other"]}
        context |= {"comparison": tabulate_comparison(records["comparison"]), "by_offset": _by_offset(curves, scene)}
    text = environment().get_template("page.html.j2").render(name=name, **lines, **context)
    return with_glossary(text) + "\n", headline(records["verdict"])


def _screen(name: str, scene: Scene, records: Record, other: tuple[str, Scene] | None) -> dict[str, str]:
    """The parts of the first screen as markup."""
    outcome, drives = records["outcome"], records["end_masses"]["definitions"]
    squirt = {"squirt": float(outcome.squirt), "pivot_length": records["strike"]["models"]["coupled"]["pivot_length"]}
    own = HeadlineCue(
        name, scene, records["numbers"] | squirt | {"end_mass_squirt": drives["squirt"]["end_mass"]}, records["verdict"]
    )
    beside, difference = None, None
    if other is not None:
        compared = records["comparison"]
        beside = HeadlineCue(*other, compared["cues"][other[0]])
        difference = compared["differences"][name].get("squirt")
    scenes = {name: scene} | ({} if other is None else {other[0]: other[1]})
    return {
        "headline": headline_markup(own, beside, difference),
        "scale": scale_markup(own, beside),
        "tiles": tiles_markup(own, beside),
        "drawings": drawings_markup(scenes) if scene.cue.segments else "",
        "parts": parts_line(records["verdict"]),
    }


def _context(scene: Scene, records: Record) -> Record:
    outcome: Outcome = records["outcome"]
    about, regimes = scene_record(scene), records["squirt"]["models"]["coupled, this cue"]["regime"]
    stroke = f"{assumptions(about)}, offset b/R {scene.stroke.offset:.4g}"
    shaft = "modes" in records
    return {
        "facts": [plain_cue_line(scene.cue), stroke, *map(plain_effect_line, scene.effects)],
        "squirt": format_value("squirt", outcome.squirt),
        "error": "" if outcome.error is None else f"{100.0 * outcome.error:.2g} %",
        "uncertainty": uncertainty_line(records["verdict"]),
        "advice": tabulate_design_changes(records["advice"]) if "advice" in records else None,
        "accuracy": (LAW if scene.contact_terms.tip is not None else SPRING, COMPARING),
        "regime_warning": regime_warning(outcome.regime),
        "modes": modes_chart(scene) if shaft else None,
        "frequencies": tabulate_modes(records["modes"]) if shaft else None,
        "contact": None if outcome.history is None else contact_section(outcome),
        "by_offset": _by_offset(records["squirt"]["models"], scene, regimes),
        "numbers": tabulate_values("Cue and stroke", value_rows(records["numbers"])),
        "end_masses": tabulate_end_masses(records["end_masses"], about),
        "meanings": _meanings(scene, outcome),
        "tables": [
            *([_segments(scene)] if shaft else []),
            tabulate_strike(records["strike"], about),
            *([] if "tip" not in records else [tabulate_impacts(records["tip"])]),
            _energy(outcome),
        ],
    }


SEGMENT_COLUMNS = ("at, mm", "length, mm", "diameter, mm", "bore, mm", "mass", "material")


def _segments(scene: Scene) -> Table:
    cue = scene.shaft
    position, diameter = RESULTS["position"].number, RESULTS["radius"].number
    rows = (
        (
            position(x),
            position(s.length),
            f"{diameter(s.tip_diameter)} – {diameter(s.butt_diameter)}",
            f"{diameter(s.tip_bore)} – {diameter(s.butt_bore)}" if s.tip_bore or s.butt_bore else DASH,
            format_value("mass", s.mass),
            material_name(s.material) + (f", core {material_name(s.core)}" if s.core else ""),
        )
        for x, s in zip(cue.nodes[:-1], cue.segments, strict=True)
    )
    return Table("Segments, from tip to butt", SEGMENT_COLUMNS, tuple(rows), texts=(5,))


def _by_offset(curves: Mapping[str, Record], scene: Scene, regimes: Sequence[str] = ()) -> tuple[Chart, Chart]:
    lines = [(name, STYLES.get(name, f"c{i}"), curve) for i, (name, curve) in enumerate(curves.items(), 1)]
    return offset_charts(lines, PAGE_OFFSETS, scene.stroke.offset, height=300, regimes=regimes)


def _meanings(scene: Scene, outcome: Outcome) -> list[str]:
    """The definitions of the end mass, and the end mass by Alciatore's formula, which published values use."""
    meanings = [f"{known.name}: {known.meaning}." for known in DEFINITIONS.values()]
    try:
        offset, inertia = float(scene.stroke.offset), scene.ball.inertia
        mass = float(scene.ball.mass / alciatore_a31_mass_ratio(offset, outcome.squirt, inertia=inertia))
    except ValueError:
        return meanings
    if not 0 < mass < math.inf:
        return meanings
    return [
        *meanings,
        f"[A.31]: with {format_value('mass', mass)} Alciatore's formula (technical proof A.31, billiards.colostate.edu)"
        " gives this squirt. By this definition alone measured cues have 5.8 to 14 g (handbook: Effective end mass).",
    ]


def _energy(outcome: Outcome) -> Table:
    whole = outcome.energy["initial"]
    rows = (
        (name, f"{100 * value / whole:.2f} %", format_value("energy", value) if abs(value) > 1e-9 * whole else "0")
        for name, value in outcome.energy.items()
        if name != "initial"
    )
    return Table("Energy balance", ("", "share", "energy"), tuple(rows))
