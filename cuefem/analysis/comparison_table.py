"""Comparison of cues: a sentence on each difference of squirt, a table, and figures for a page."""

from __future__ import annotations

import math
from collections.abc import Mapping

from cuefem.analysis.end_mass import SQUIRT_END_MASS
from cuefem.analysis.strike_models import regime_warning
from cuefem.results.comparison import with_same_stroke
from cuefem.results.quantities import DASH, RESULTS, format_value, with_unit
from cuefem.results.records import Record, Table
from cuefem.results.solved_design import coupled_curve
from cuefem.scene import Scene
from cuefem.scene.solved_scene import SolvedScene
from cuefem.show.charts import Chart
from cuefem.show.drawings import DIAMETER_SCALE, CueDrawing, cue_drawing
from cuefem.show.offset_charts import offset_charts
from cuefem.show.verdict_table import difference_text, squirt_difference

CURVE_OFFSETS = tuple(round(0.05 * i, 2) for i in range(1, 13))  # b/R
STYLES = ("c1", "c2", "c3", "c4", "c5")
_LABELS = {"end_mass_squirt": SQUIRT_END_MASS}


def comparison_sentences(record: Record) -> list[str]:
    """A sentence on the squirt of each cue relative to the first."""
    first = record["reference"]
    sentences = []
    for name, differences in record["differences"].items():
        squirt = differences.get("squirt")
        if squirt is None:
            problems = [f"{cue}: {record['problems'][cue]}" for cue in (first, name) if cue in record["problems"]]
            reason = "; ".join(problems) or "a stroke is nearly a miscue"
            sentences.append(f"{name} and {first} cannot be compared in squirt: {reason}.")
        else:
            sentences.append(f"{name}: {squirt_difference(**squirt)} {first} (1σ).")
    return sentences


def tabulate_comparison(record: Record) -> Table:
    """A row for each quantity: its value for each cue, and the differences of the others from the first."""
    first, *others = record["cues"]
    rows = []
    for name, own in record["cues"][first].items():
        cells = [_label(name), _value(name, own)]
        for other in others:
            text = DASH
            if difference := record["differences"][other].get(name):
                text = difference_text(difference["difference"], difference["error"])
                text += "" if difference["distinct"] else " *"
            cells += [_value(name, record["cues"][other][name]), text]
        rows.append(tuple(cells))
        if name == "squirt":
            lateral = [_lateral(record["cues"][cue][name]) for cue in (first, *others)]
            rows.append(("off line after 1 m", lateral[0], *(cell for each in lateral[1:] for cell in (each, ""))))
    head = ("", first, *(cell for other in others for cell in (other, "difference")))
    shaft = "one shaft, before and after a change" if record["same_shaft"] else "shafts of different pieces of wood"
    notes = (
        f"Same stroke, with the ball of {first}, b/R {record['offset']:.3g} at {record['speed']:g} m/s. ±: 1σ of the "
        f"difference, for {shaft}; shared errors cancel.",
        *(f"{name}: {warning}" for name, regime in record["regimes"].items() if (warning := regime_warning(regime))),
        "* smaller than its uncertainty: the cues are not distinct in this quantity.",
    )
    return Table("Side by side", head, tuple(rows), notes)


def _label(name: str) -> str:
    if name.startswith("frequency_"):
        return f"natural frequency {name.removeprefix('frequency_')}"
    return _LABELS.get(name) or RESULTS[name].label


def _value(name: str, value: float) -> str:
    """A value with its unit."""
    quantity = "frequency" if name.startswith("frequency_") else "end_mass" if name in _LABELS else name
    return format_value(quantity, value)


def _lateral(squirt: float) -> str:
    return DASH if math.isnan(squirt) else with_unit(math.tan(squirt), "m", decimals=0)


def comparison_figures(scenes: Mapping[str, Scene], record: Record) -> list[Chart | CueDrawing]:
    """Charts of squirt and natural pivot length against the offset, and a drawing of each cue."""
    lines = []
    for style, (name, scene) in zip(STYLES, with_same_stroke(scenes).items(), strict=False):
        lines.append((name, style, coupled_curve(scene, CURVE_OFFSETS, SolvedScene(scene).tip)))
    charts = offset_charts(lines, CURVE_OFFSETS, record["offset"], height=300)
    drawings = [
        cue_drawing(scene, f"{name}, diameters {DIAMETER_SCALE:g} times enlarged") for name, scene in scenes.items()
    ]
    return [*charts, *drawings]
