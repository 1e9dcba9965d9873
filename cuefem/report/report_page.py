"""The report as one self-contained page: inline drawings and styles, nothing from the network."""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from typing import Any

from cuefem.beam.modes import modes
from cuefem.contact.outcome import grip_of
from cuefem.contact.strike import strike_modes
from cuefem.cue.materials import material_name
from cuefem.design.design_changes import design_changes
from cuefem.endmass.definitions import DEFINITIONS
from cuefem.quantity.fields import scalar
from cuefem.report.advice_table import advice_sheet
from cuefem.report.charts import Axis, Chart
from cuefem.report.comparison_table import comparison_sheet
from cuefem.report.contact import contact_part
from cuefem.report.drawings import cue_drawing, legend, modes_drawing, strike_drawing
from cuefem.report.effects import seconds_words
from cuefem.report.end_mass import SQUIRT_END_MASS
from cuefem.report.everything import report_record
from cuefem.report.first_screen import (
    Shown,
    drawings_markup,
    headline_markup,
    parts_line,
    scale_markup,
    tiles_markup,
)
from cuefem.report.glossary import with_words
from cuefem.report.models import ALCIATORE, PAPER
from cuefem.report.record import scene_record
from cuefem.report.scene_words import assumptions, effect_words, plain_cue_line
from cuefem.report.squirt import LATE, PAPER_CUE_END_MASS, offset_charts
from cuefem.report.strike_table import BRIEF, grip_warning, models_sheet, strike_record
from cuefem.report.templates import environment
from cuefem.report.tip_table import tip_sheet
from cuefem.report.trust import trust_lines
from cuefem.report.verdict_table import headline, uncertainty_line
from cuefem.results.closed_forms import alciatore_a31_mass_ratio
from cuefem.results.comparison import comparison_record
from cuefem.results.convergence import Level, levels
from cuefem.results.quantities import GRIPS, NONE, RESULTS, degrees, grams, scaled, written
from cuefem.results.records import Record, Sheet, value_rows, values_sheet
from cuefem.results.solved_design import coupled_curve
from cuefem.scene import Outcome, Scene
from cuefem.tip_modes import Solved

DEFAULT_RTOL = 1e-2
PAGE_OFFSETS = tuple(round(0.03 * i, 2) for i in range(1, 21))  # b/R of the curves
MEASURED_A31 = (5.8e-3, 14e-3)  # kg, of real cues by A.31, and by no other definition; handbook: Effective end mass
# Where the numbers come from that the page shows beside the cue's own.
A31_NAME = "by A.31, like measured cues"
SOURCES = (
    ("the paper's 12 g", f"the cue end of the two-part cue in {PAPER}"),
    (
        A31_NAME,
        "the end mass with which A.31 gives the squirt of this stroke; measured cues have 5.8 to 14 g by this "
        "definition alone, those with which A.31 gives the least and the most squirt that D. Alciatore's robot and "
        "players measured (a Predator Z, 1.8° at b/R 0.453, and a Stinger, 2.4° at b/R 0.267, ball 170 g)",
    ),
    ("A.31", ALCIATORE),
)

# The models' classes on the page.
STYLES = {"coupled, this cue": "c1", "lumped, this cue": "c2", "two-part, this cue": "c3", "two-part, 12 g": "c5"}
STYLES |= {"A.31, this cue": "c4"}


def page(name: str, scene: Scene, **about: Any) -> str:
    """The report of a scene as HTML; about: as for `page_and_headline`."""
    return page_and_headline(name, scene, **about)[0]


def page_and_headline(
    name: str,
    scene: Scene,
    *,
    rtol: float | None = None,
    notes: Sequence[str] = (),
    remarks: Sequence[str] = (),
    trust: Sequence[str] = (),
    other: tuple[str, Scene] | None = None,
    track: Any = iter,
) -> tuple[str, str]:
    """The report of a scene as HTML, and its squirt in a line.

    rtol: what is asked of the accuracy; notes: what was assumed; remarks: what is unusual; trust: what was
    computed on how far to trust it; other: the name and scene of a cue to compare with, struck alike; track: follows
    the stages.
    """
    rtol = DEFAULT_RTOL if rtol is None else rtol
    solved, made = Solved(scene), list[tuple[Level, float]]()

    def climbed() -> Sheet:
        begun = time.perf_counter()
        made.extend((level, time.perf_counter() - begun) for level in levels(scene, rtol))
        return _steps(made, rtol)

    def outcome() -> Outcome:
        return made[-1][0].outcome if made else strike_modes(scene, solved.tip)

    stages: dict[str, Callable[[], Any]] = {"steps": climbed} if scene.lumped is None else {}
    stages |= {
        "outcome": outcome,
        "report": lambda: report_record(scene, offsets=PAGE_OFFSETS, solved=solved, outcome=records["outcome"]),
        "strike": lambda: strike_record(scene, records["outcome"], solved=solved),
    }
    if scene.lumped is None:
        stages["advice"] = lambda: design_changes(scene, solved=solved)
    if other is not None:
        stages["comparison"] = lambda: comparison_record({other[0]: other[1], name: scene})
        stages["other"] = lambda: coupled_curve(other[1], PAGE_OFFSETS, Solved(other[1]).tip)
    records: Record = {}
    for key, work in track([*stages.items()]):
        records[key] = work()
    records |= records.pop("report")
    said = {"notes": list(notes), "remarks": list(remarks), "checked": list(trust), "asked": f"{100 * rtol:.3g} %"}
    context = _context(scene, records) | {"screen": _screen(name, scene, records, other), "comparison": None}
    if other is not None:
        curves = {name: records["squirt"]["models"]["coupled, this cue"], other[0]: records["other"]}
        context |= {"comparison": comparison_sheet(records["comparison"]), "by_offset": _by_offset(curves, scene)}
    text = environment().get_template("page.html.j2").render(name=name, **said, **context)
    return with_words(text) + "\n", headline(records["verdict"])


def _screen(name: str, scene: Scene, records: Record, other: tuple[str, Scene] | None) -> dict[str, str]:
    """The parts of the first screen, as markup."""
    outcome, drives = records["outcome"], records["end_masses"]["drives"]
    squirt = {"squirt": float(outcome.squirt), "pivot_length": records["strike"]["models"]["coupled"]["pivot_length"]}
    own = Shown(
        name, scene, records["numbers"] | squirt | {"end_mass_squirt": drives["squirt"]["end_mass"]}, records["verdict"]
    )
    beside, difference = None, None
    if other is not None:
        compared = records["comparison"]
        beside = Shown(*other, compared["cues"][other[0]])
        difference = compared["differences"][name].get("squirt")
    scenes = {name: scene} | ({} if other is None else {other[0]: other[1]})
    return {
        "headline": headline_markup(own, beside, difference),
        "scale": scale_markup(own, beside),
        "tiles": tiles_markup(own, beside),
        "drawings": drawings_markup(scenes) if scene.cue.segments else "",
        "parts": parts_line(records["verdict"]),
    }


def _steps(climbed_to: Sequence[tuple[Level, float]], rtol: float) -> Sheet:
    """The levels of resolution: modes and steps, squirt, its estimated error, and seconds so far."""
    outcomes = [(level.at, level.outcome, seconds) for level, seconds in climbed_to]
    rows = [
        (str(at.modes), str(at.steps), degrees(it.squirt), written("error", it.error), seconds_words(seconds))
        for at, it, seconds in outcomes
    ]
    reached = [i for i, (_, it, _) in enumerate(outcomes) if it.error is not None and it.error <= rtol]
    head = ("modes", "steps", "squirt", "error", "time so far")
    title = "Numerical convergence"
    return Sheet(title, head, tuple(rows), texts=(), styles=dict.fromkeys(reached, "reached"))


def _context(scene: Scene, records: Record) -> Record:
    outcome: Outcome = records["outcome"]
    record, grips = records["strike"], records["squirt"]["models"]["coupled, this cue"]["grip"]
    return {
        "scene": scene,
        "facts": _facts(scene),
        "figures": _key_figures(record, records["end_masses"], outcome),
        "strike": strike_drawing(scene, outcome.squirt),
        "squirt": written("squirt", outcome.squirt, brief=True),
        "error": "" if outcome.error is None else f"{100.0 * outcome.error:.2g} %",
        "uncertainty": uncertainty_line(records["verdict"]),
        "advice": advice_sheet(records["advice"]) if "advice" in records else None,
        "trust": trust_lines(scene),
        "warning": grip_warning(grip_of(outcome)),
        "cue": _cue_part(scene) if scene.cue.segments else None,
        "modes": modes_drawing(modes(scene.shaft, effects=scene.cue_effects), scene.shaft.length)
        if scene.cue.segments
        else None,
        "contact": None if outcome.history is None else contact_part(outcome),
        "tip": None if scene.contact_terms.tip is None else tip_sheet(records["tip"]),
        "by_offset": _by_offset(records["squirt"]["models"], scene, grips),
        "slipped": any(grip in LATE for grip in grips),
        "end_masses": _end_masses(records["end_masses"], scene, outcome),
        "energy": _energy(outcome),
        "models": replace(models_sheet(record, BRIEF), title="The same stroke by every model"),
        "coupling": record["coupling"],
        "numbers": values_sheet("The cue and this stroke in numbers", value_rows(records["numbers"])),
        "steps": records.get("steps"),
    }


def _facts(scene: Scene) -> list[str]:
    told = f"{assumptions(scene_record(scene))}, offset b/R {scene.stroke.offset:.4g}"
    return [plain_cue_line(scene.cue), told, *(f"with {effect_words(effect)}" for effect in scene.effects)]


def _key_figures(record: Record, end_masses: Record, outcome: Outcome) -> list[tuple[str, str, str]]:
    coupled, felt = record["models"]["coupled"], end_masses["drives"]["squirt"]["end_mass"]
    remarks = {
        "squirt": f"{math.tan(abs(outcome.squirt)) * 1e3:.0f} mm off line after 1 m",
        "pivot_length": "pivot the cue about this point and squirt cancels",
        "end_mass": "the mass at the tip that would make this much squirt",
        "ball_speed": f"the cue goes on at {written('cue_speed', outcome.cue_speed, brief=True)}",
        "spin": f"{abs(outcome.spin) / (2 * math.pi):.1f} turns a second",
        "duration": GRIPS[grip_of(outcome)][1],
    }
    values = coupled | {"end_mass": felt}
    words = {"end_mass": SQUIRT_END_MASS}
    return [
        (words.get(name, RESULTS[name].words), written(name, values[name], brief=True), remark)
        for name, remark in remarks.items()
        if name != "duration" or outcome.duration is not None
    ]


SEGMENT_COLUMNS = ("at, mm", "length, mm", "diameter, mm", "bore, mm", "mass", "material")


def _cue_part(scene: Scene) -> Record:
    cue = scene.shaft
    place, across = RESULTS["position"].number, RESULTS["radius"].number
    rows = (
        (
            place(x),
            place(s.length),
            f"{across(s.tip_diameter)} – {across(s.butt_diameter)}",
            f"{across(s.tip_bore)} – {across(s.butt_bore)}" if s.tip_bore or s.butt_bore else NONE,
            grams(s.mass),
            material_name(s.material) + (f", core {material_name(s.core)}" if s.core else ""),
        )
        for x, s in zip(cue.nodes[:-1], cue.segments, strict=True)
    )
    return {
        "drawing": cue_drawing(scene),
        "materials": legend([scene]),
        "segments": Sheet("Segments, from tip to butt", SEGMENT_COLUMNS, tuple(rows), texts=(5,)),
    }


def _by_offset(curves: Mapping[str, Record], scene: Scene, grips: Sequence[str] = ()) -> tuple[Chart, Chart]:
    lines = [(name, STYLES.get(name, f"c{i}"), curve) for i, (name, curve) in enumerate(curves.items(), 1)]
    return offset_charts(lines, PAGE_OFFSETS, scalar("Stroke.offset", scene.stroke.offset), height=300, grips=grips)


def _end_masses(record: Record, scene: Scene, outcome: Outcome) -> Record:
    drives = [(name, values) for name, values in record["drives"].items() if values["end_mass"] is not None]
    paper = PAPER_CUE_END_MASS / 4
    by_a31 = _a31_mass(scene, outcome)
    largest = max([MEASURED_A31[1], by_a31 or 0.0, *(values["highest"] for _, values in drives)])
    across = Axis("m_e, g", 0.0).over([scaled(largest, "kg")])
    left, right = 212.0, 372.0

    def place(mass: float) -> float:
        return float(across.place(scaled(mass, "kg"), left, right))

    felt = [
        (DEFINITIONS[name].label_at(record["offset"]), *(values[key] for key in ("end_mass", "lowest", "highest")))
        for name, values in drives
    ]
    felt += [
        (name, *3 * (mass,)) for name, mass in (("the paper's 12 g", paper), (A31_NAME, by_a31)) if mass is not None
    ]
    rows = [(name, grams(masses[0]), *map(place, masses)) for name, *masses in felt]
    return {
        "rows": rows,
        "ticks": across.ticks(left, right),
        "band": None if by_a31 is None else (place(MEASURED_A31[0]), place(MEASURED_A31[1])),
        "ends": (left, right),
        "height": 26.0 * len(rows) + 44,
        "reasons": [values["reason"] for values in record["drives"].values() if values["end_mass"] is None],
        "meanings": [
            *((definition.label_at(record["offset"]), definition.meaning) for definition in DEFINITIONS.values()),
            *SOURCES,
        ],
        "counted": "; ".join(definition.label for definition in DEFINITIONS.values() if definition.counts_tip),
    }


def _a31_mass(scene: Scene, outcome: Outcome) -> float | None:
    """The end mass with which A.31 gives this squirt, the definition of published end masses; None if there is none."""
    offset = float(scene.stroke.offset)
    try:
        mass = float(scene.ball.mass / alciatore_a31_mass_ratio(offset, outcome.squirt, inertia=scene.ball.inertia))
    except ValueError:
        return None
    return mass if 0 < mass < math.inf else None


def _energy(outcome: Outcome) -> list[tuple[str, str, float, str]]:
    whole = outcome.energy["initial"]
    parts = [(name, value) for name, value in outcome.energy.items() if name != "initial"]
    return [
        (name, f"e{i % 8 + 1}", 100 * value / whole, _joules(value) if abs(value) > 1e-9 * whole else "0")
        for i, (name, value) in enumerate(parts)
    ]


def _joules(energy: float) -> str:
    return f"{energy:.4g} J" if abs(energy) >= 1 else f"{1e3 * energy:.4g} mJ"
