"""The report as one self-contained page: inline drawings and styles, nothing from the network."""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Iterator, Sequence
from dataclasses import asdict
from functools import cache, partial
from itertools import islice, pairwise
from typing import Any, NamedTuple

import numpy as np

from cuefem.accuracy import Rung, ladder
from cuefem.beam.modes import modes
from cuefem.contact.strike import strike
from cuefem.endmass.drives import DEFINITIONS
from cuefem.quantity import scalar
from cuefem.report.charts import Axis, Chart, Curve, Mark, Span, chart
from cuefem.report.drawings import (
    cue_drawing,
    front_drawing,
    material_name,
    materials_of,
    modes_drawing,
    strike_drawing,
    style_of,
)
from cuefem.report.effects import seconds_words
from cuefem.report.end_mass import end_mass_record
from cuefem.report.record import Record
from cuefem.report.solve import ended_tip_modes
from cuefem.report.squirt import PAPER_CUE_END_MASS, squirt_record
from cuefem.report.strike import MISCUE, strike_record
from cuefem.report.templates import environment
from cuefem.report.words import assumptions, degrees, effect_words, grams, millimetres, plain_cue_line
from cuefem.scene import Outcome, Scene

DEFAULT_RTOL = 1e-2
OFFSETS = tuple(round(0.03 * i, 2) for i in range(1, 21))  # b/R of the curves
LONGEST_PIVOT = 1.5  # m; beyond it a pivot is behind the cue
MEASURED_END_MASS = (5.8e-3, 14e-3)  # kg, of real cues; physics.md section 6
MOST_EVENTS = 12
LATE = ("late stick", "miscue")

# A model's class on the page, by the beginning of its name.
STYLES = {"coupled": "c1", "lumped": "c2", "two-part, this": "c3", "A.31": "c4", "two-part, 12": "c5"}


class Stage(NamedTuple):
    """One step of the computation of a page, for who follows it."""

    name: str
    work: Callable[[], Any]


def page(
    name: str,
    scene: Scene,
    *,
    rtol: float | None = None,
    notes: Sequence[str] = (),
    remarks: Sequence[str] = (),
    track: Any = iter,
) -> str:
    """The report of a scene as HTML.

    rtol: what is asked of the accuracy; notes: what was assumed; remarks: what is unusual; track: follows the stages.
    """
    found: Record = {}
    rtol = DEFAULT_RTOL if rtol is None else rtol
    for stage in track(_stages(scene, rtol)):
        found[stage.name] = stage.work()
    template = environment().get_template("page.html.j2")
    asked = f"{100 * rtol:.3g} %"
    said = {"notes": list(notes), "remarks": list(remarks)}
    return template.render(name=name, asked=asked, **said, **_context(scene, found)) + "\n"


def _stages(scene: Scene, rtol: float) -> list[Stage]:
    solved: list[Rung] = []  # what the later stages need of the first

    def climb() -> list[Step]:
        steps, rung = accuracy_steps(scene, rtol)
        solved.append(rung)
        return steps

    if scene.cue.segments:
        first = Stage("steps", climb)
        outcome = Stage("outcome", lambda: solved[0].outcome)
        ended = cache(lambda: ended_tip_modes(scene, solved[0].at))
        masses = Stage("end_masses", lambda: end_mass_record(scene, tip=ended()))
        return [first, outcome, masses, Stage("squirt", lambda: squirt_record(scene, OFFSETS, tip=ended()))]
    return [
        Stage("outcome", lambda: strike(scene)),
        Stage("end_masses", lambda: end_mass_record(scene)),
        Stage("squirt", lambda: squirt_record(scene, OFFSETS)),
    ]


class Step(NamedTuple):
    """A rung of the ladder of resolutions: what it takes, what it gives, its estimated error, seconds so far."""

    modes: int
    unknowns: int
    squirt: str
    error: str
    seconds: str
    reached: bool


def accuracy_steps(scene: Scene, rtol: float) -> tuple[list[Step], Rung]:
    """The rungs that a strike to relative accuracy ``rtol`` takes, and the last of them."""
    begun, steps = time.perf_counter(), []
    for rung in ladder(scene):
        error = rung.outcome.error
        reached = error is not None and error <= rtol
        written = "–" if error is None else f"{error:.1e}"
        spent = seconds_words(time.perf_counter() - begun)
        steps.append(Step(rung.at.modes, rung.outcome.unknowns, degrees(rung.outcome.squirt), written, spent, reached))
        if reached:
            break
    return steps, rung


def _context(scene: Scene, found: Record) -> Record:
    outcome: Outcome = found["outcome"]
    record = strike_record(scene, outcome)
    return {
        "scene": scene,
        "facts": _facts(scene),
        "figures": _key_figures(record, found["end_masses"], outcome),
        "strike": strike_drawing(scene, outcome.squirt),
        "squirt": degrees(outcome.squirt),
        "error": "" if outcome.error is None else f"{outcome.error:.1e}",
        "warning": MISCUE if outcome.regime == "miscue" else "",
        "cue": _cue_part(scene) if scene.cue.segments else None,
        "modes": _modes_part(scene) if scene.cue.segments else None,
        "contact": None if outcome.history is None else _contact(outcome),
        "by_offset": _by_offset(found["squirt"], scene),
        "slipped": bool(_slipped(found["squirt"])),
        "end_masses": _end_masses(found["end_masses"], found["squirt"]),
        "energy": _energy(outcome),
        "models": _models(record),
        "coupling": record["coupling"],
        "steps": found.get("steps"),
    }


def _facts(scene: Scene) -> list[str]:
    about = {
        "ball": asdict(scene.ball),
        "tip": {**asdict(scene.tip), "contact_time": scene.contact_time},
        "stroke": asdict(scene.stroke),
    }
    effects = [f"with {effect_words(effect)}" for effect in scene.effects]
    return [plain_cue_line(scene.cue), f"{assumptions(about)}, offset b/R {scene.stroke.offset:g}", *effects]


def _key_figures(record: Record, end_masses: Record, outcome: Outcome) -> list[tuple[str, str, str]]:
    coupled, felt = record["models"]["coupled"], end_masses["drives"]["squirt"]["end_mass"]
    figures = [
        ("squirt", degrees(outcome.squirt), f"{math.tan(abs(outcome.squirt)) * 1e3:.0f} mm in a metre"),
        ("natural pivot length", millimetres(coupled["pivot_length"]), "where turning the cue undoes squirt"),
        ("end mass", "–" if felt is None else grams(felt), "the lumped one that squirts as much"),
        ("ball speed", f"{outcome.ball_speed:.3f} m/s", f"cue after: {outcome.cue_speed:.3f} m/s"),
        ("spin", f"{outcome.spin:.1f} rad/s", f"{abs(outcome.spin) / (2 * math.pi):.1f} turns a second"),
    ]
    if outcome.duration is not None:
        figures.append(("contact", f"{1e3 * outcome.duration:.3f} ms", f"how it went: {outcome.regime}"))
    return figures


def _modes_part(scene: Scene) -> Any:
    return modes_drawing(modes(scene.shaft, effects=scene.cue_effects), scene.shaft.length)


def _cue_part(scene: Scene) -> Record:
    cue = scene.shaft
    rows = [
        {
            "at": f"{1e3 * x:.1f}",
            "length": f"{1e3 * s.length:.1f}",
            "outer": f"{1e3 * s.tip_diameter:.2f} – {1e3 * s.butt_diameter:.2f}",
            "bore": f"{1e3 * s.tip_bore:.2f} – {1e3 * s.butt_bore:.2f}" if s.tip_bore or s.butt_bore else "–",
            "material": material_name(s.material) + (f", core {material_name(s.core)}" if s.core else ""),
            "mass": grams(s.mass),
        }
        for x, s in zip(cue.nodes[:-1], cue.segments, strict=True)
    ]
    names = materials_of(cue)
    hollow = any((s.tip_bore or s.butt_bore) and s.core is None for s in cue.segments)
    return {
        "drawings": [cue_drawing(scene, across=1.0), cue_drawing(scene, across=8.0), front_drawing(scene)],
        "materials": [(name, style_of(name)) for name in names] + ([("bore", "hollow")] if hollow else []),
        "rows": rows,
    }


def _contact(outcome: Outcome) -> Record:
    events = list(_events(outcome))
    t = np.linspace(0, outcome.duration, 401)
    history = outcome.history(t)
    ms = 1e3 * t
    slipping = [phase for phase in outcome.phases if phase.grip.startswith("slip")]
    spans = [Span(1e3 * phase.start, 1e3 * phase.end, "slip") for phase in slipping]
    marks = [Mark(1e3 * at, str(i + 1)) for i, (at, _) in enumerate(events)]

    def drawn(title: str, label: str, curves: list[Curve]) -> Chart:
        return chart(title, curves, x=Axis("time, ms", 0.0, float(ms[-1])), y=Axis(label), spans=spans, marks=marks)

    return {
        "charts": [
            drawn(
                "Force of the tip on the ball",
                "force, N",
                [
                    Curve("along the normal", ms, history["force_n"], "c1"),
                    Curve("along the tangent", ms, history["force_t"], "c2"),
                ],
            ),
            drawn(
                "Velocity of the ball against the tip",
                "velocity, m/s",
                [
                    Curve("along the normal", ms, history["velocity_n"], "c1"),
                    Curve("along the tangent", ms, history["velocity_t"], "c2"),
                ],
            ),
        ],
        "events": [(str(i + 1), f"{1e3 * at:.4f} ms", words) for i, (at, words) in enumerate(events)],
        "slips": bool(spans),
    }


def _events(outcome: Outcome) -> Iterator[tuple[float, str]]:
    """Moments at which one phase becomes another, s, in words; at most so many, and the last."""
    phases = outcome.phases
    yield phases[0].start, "first touch, the tip slips" if phases[0].grip != "stick" else "first touch, the tip sticks"
    for before, after in islice(pairwise(phases), MOST_EVENTS):
        yield after.start, _turn(before, after)
    yield phases[-1].end, "separation"


def _turn(before: Any, after: Any) -> str:
    grips = {"stick": "the tip sticks", "slip": "the tip slips", "slip back": "the tip slips back"}
    presses = {
        "load": "pressed beyond its old peak",
        "unload": "greatest compression",
        "rigid": "greatest compression",
        "ringing": "the tip rings",
        "capped": "the tip rings less and less",
        "rubbed": "friction damps the ringing",
        "rubbed back": "friction damps the ringing",
        "swinging": "the tip rings and slips by turns",
    }
    words = []
    if after.press != before.press:
        words.append(presses.get(after.press, after.press))
    if after.grip != before.grip:
        words.append(grips.get(after.grip, after.grip))
    return ", ".join(words) or "goes on"


def _style(model: str) -> str:
    return next(style for start, style in STYLES.items() if model.startswith(start))


def _by_offset(record: Record, scene: Scene) -> list[Chart]:
    offsets = np.array(record["offsets"])
    own = abs(scalar("Stroke.offset", scene.stroke.offset))
    models = [(name, found, _style(name)) for name, found in record["models"].items()]
    at = Axis("offset b/R", 0.0, float(offsets[-1]))
    squirt = [
        Curve(name, np.r_[0.0, offsets], np.degrees(np.r_[0.0, found["squirt"]]), style)
        for name, found, style in models
    ]
    pivot = [
        Curve(name, offsets, 1e3 * np.where(found["squirt"] > 0, found["pivot_length"], np.nan), style)
        for name, found, style in models
    ]
    longest = min(LONGEST_PIVOT, max(float(np.nanmax(curve.y, initial=0.1)) for curve in pivot) / 1e3)
    highest = Axis("", 0.0).over([np.array([1e3 * longest])]).high
    here = [Mark(own, "here")] if 0 < own <= offsets[-1] else []
    drawn = partial(chart, x=at, marks=here, spans=_slipped(record), height=300)
    return [
        drawn("Squirt", squirt, y=Axis("squirt, degrees")),
        drawn("Natural pivot length", pivot, y=Axis("pivot length, mm", 0.0, highest)),
    ]


def _slipped(record: Record) -> list[Span]:
    """Where the coupled stroke sticks late or miscues: halfway to the offsets before and after."""
    offsets, regimes = np.array(record["offsets"]), record["models"]["coupled, this cue"]["regime"]
    ends = np.r_[offsets[0], (offsets[1:] + offsets[:-1]) / 2, offsets[-1]]
    spans = [(float(ends[i]), float(ends[i + 1])) for i, regime in enumerate(regimes) if regime in LATE]
    return [Span(start, end, "slip") for start, end in spans]


class MassRow(NamedTuple):
    """An end mass on its axis: value, spread and text."""

    name: str
    at: float
    low: float
    high: float
    text: str


def _end_masses(record: Record, squirt: Record) -> Record:
    drives = [(name, values) for name, values in record["drives"].items() if values["end_mass"] is not None]
    paper = PAPER_CUE_END_MASS / 4
    largest = max([MEASURED_END_MASS[1], *(values["highest"] for _, values in drives)])
    across = Axis("m_e, g", 0.0).over([np.array([1e3 * largest])])
    left, right = 118.0, 372.0

    def place(mass: float) -> float:
        return float(across.place(1e3 * mass, left, right))

    def row(name: str, felt: float, spread: tuple[float, float]) -> MassRow:
        return MassRow(name, place(felt), place(spread[0]), place(spread[1]), grams(felt))

    rows = [
        row(DEFINITIONS[n].label_at(record["offset"]), values["end_mass"], (values["lowest"], values["highest"]))
        for n, values in drives
    ]
    rows.append(row("the paper's 12 g", paper, (paper, paper)))
    return {
        "rows": rows,
        "ticks": across.ticks(left, right),
        "band": (place(MEASURED_END_MASS[0]), place(MEASURED_END_MASS[1])),
        "ends": (left, right),
        "height": 26.0 * len(rows) + 44,
        "reasons": [values["reason"] for values in record["drives"].values() if values["end_mass"] is None],
        "meanings": [(one.label_at(record["offset"]), one.meaning) for one in DEFINITIONS.values()],
        "coupling": squirt["coupling"],
    }


def _energy(outcome: Outcome) -> list[tuple[str, str, float, str]]:
    whole = outcome.energy["initial"]
    parts = [(name, value) for name, value in outcome.energy.items() if name != "initial"]
    return [
        (name, f"e{i % 8 + 1}", 100 * value / whole, _joules(value) if abs(value) > 1e-9 * whole else "0")
        for i, (name, value) in enumerate(parts)
    ]


def _joules(energy: float) -> str:
    return f"{energy:.4g} J" if abs(energy) >= 1 else f"{1e3 * energy:.4g} mJ"


def _models(record: Record) -> Record:
    names = list(record["models"])
    rows = []
    for label, key, written in MODEL_ROWS:
        values = [record["models"][name].get(key) for name in names]
        if any(value is not None for value in values):
            rows.append((label, ["–" if value is None else written(value) for value in values]))
    return {"names": names, "rows": rows}


MODEL_ROWS: tuple[tuple[str, str, Callable[[Any], str]], ...] = (
    ("squirt", "squirt", degrees),
    ("pivot length", "pivot_length", millimetres),
    ("ball speed", "ball_speed", lambda v: f"{v:.3f} m/s"),
    ("spin", "spin", lambda v: f"{v:.1f} rad/s"),
    ("cue speed after", "cue_speed", lambda v: f"{v:.3f} m/s"),
    ("how it went", "regime", str),
)
