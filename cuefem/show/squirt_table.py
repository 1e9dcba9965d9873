"""Squirt and natural pivot length against the tip offset: record, table and charts."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import groupby

import numpy as np

from cuefem.cue import LumpedCue
from cuefem.results.closed_forms import pivot_length
from cuefem.results.quantities import DISPLAY_UNITS, format_value
from cuefem.results.records import Record, Table
from cuefem.results.solved_design import OFFSETS, at_offset, coupled_curve
from cuefem.scene import Scene
from cuefem.scene.solved_scene import SolvedScene
from cuefem.show.charts import Axis, Chart, Curve, Shade, Tick, chart
from cuefem.show.scene_summary import assumptions
from cuefem.show.strike_table import PIVOT_NOTE, a31_squirt, lumped_cues, lumped_strike

PAPER_CUE_END_MASS = 0.012  # kg, [Kim]'s m_c of a real cue: four times the effective end mass


def squirt_record(scene: Scene, offsets: Sequence[float] = OFFSETS, *, solved: SolvedScene | None = None) -> Record:
    """Squirt, rad, and natural pivot length, m, at each offset b/R by every model; nan where no lumped cue fits.

    Models: coupled strike; lumped, if effects at the tip or a lumped cue's own constant couple transverse and axial
    motion; two-part, with this cue's end mass and with [Kim]'s 12 g; [A.31]. "end_mass", kg, and "coupling", 1/kg, at
    each offset are those of `lumped_cues`. solved: the scene's modes, if already computed.
    """
    solved = solved or SolvedScene(scene)
    own = lumped_cues(scene, offsets, solved.stick_tip)
    cues = {f"{name}, this cue": each for name, each in own.items()}
    cues["two-part, 12 g"] = [LumpedCue.two_part(scene.axial_mass, PAPER_CUE_END_MASS)] * len(offsets)
    cues["A.31, this cue"] = own["two-part"]
    struck = [at_offset(scene, offset) for offset in offsets]
    models: Record = {"coupled, this cue": coupled_curve(scene, offsets, solved.tip)}
    for name, each in cues.items():
        squirt = a31_squirt if name.startswith("A.31") else lambda at, cue: lumped_strike(at, cue).squirt
        pairs = [*zip(struck, each, strict=True)]
        angles = [np.nan if cue is None else float(squirt(at, cue)) for at, cue in pairs]
        pivots = [
            np.nan if np.isnan(angle) else pivot_length(at, angle) for at, angle in zip(struck, angles, strict=True)
        ]
        models[name] = {"squirt": np.array(angles), "pivot_length": np.array(pivots, float)}
    return {
        "offsets": list(offsets),
        "end_mass": [cue and cue.end_mass for cue in own["two-part"]],
        "coupling": [cue and cue.coupling for cue in own.get("lumped", own["two-part"])],
        "models": models,
    }


def tabulate_squirt(record: Record, scene: Record) -> Table:
    """Squirt, natural pivot length and contact state, a row for each offset."""
    own = record["models"]["coupled, this cue"]
    names = ("squirt", "pivot_length")
    rows = [
        (f"{offset:g}", *(format_value(name, None if missed else own[name][i]) for name in names), regime)
        for i, (offset, regime) in enumerate(zip(record["offsets"], own["regime"], strict=True))
        for missed in [regime == "miscue"]
    ]
    head = ("b/R", "squirt", "natural pivot length", "contact")
    return Table(
        "Squirt and tip offset",
        head,
        tuple(rows),
        (assumptions(scene), PIVOT_NOTE),
        texts=(3,),
    )


SHADES = {"late stick": "slip", "partial slip": "slip", "gross slip": "slip", "miscue": "miss"}  # CSS classes
MAX_PIVOT = 1.5  # m, of the chart; a longer pivot length is beyond the butt


def offset_charts(
    lines: Sequence[tuple[str, str, Record]],
    offsets: Sequence[float],
    own: float,
    *,
    height: float,
    regimes: Sequence[str] = (),
) -> tuple[Chart, Chart]:
    """Charts of squirt and natural pivot length against the offset, to the last one before a miscue.

    lines: name, CSS class and `coupled_curve` (or a record with the same keys) of every cue or model. own: offset b/R
    of the scene's stroke, which is marked. regimes: contact state at each offset; long slip and miscue are shaded.
    """
    x = np.array(offsets)
    per_metre, unit = DISPLAY_UNITS["m"]
    squirt, pivot = [], []
    for name, style, curve in lines:
        beyond = np.cumsum([regime == "miscue" for regime in curve.get("regime", [""] * len(x))]) > 0
        angle = np.where(beyond, np.nan, curve["squirt"])
        squirt.append(Curve(name, np.r_[0.0, x], np.degrees(np.r_[0.0, angle]), style))
        pivot.append(Curve(name, x, per_metre * np.where(angle > 0, curve["pivot_length"], np.nan), style))
    ends = np.r_[x[0], (x[1:] + x[:-1]) / 2, x[-1]]
    spans = []
    for shade, run in groupby(range(len(regimes)), lambda i: SHADES.get(regimes[i], "")):
        inside = [*run]
        if shade:
            spans.append(Shade(float(ends[inside[0]]), float(ends[inside[-1] + 1]), shade))
    longest = max([0.1, *(float(np.nanmax(curve.y, initial=0.0)) / per_metre for curve in pivot)])
    highest = Axis("", 0.0).scale_for([np.array([per_metre * min(MAX_PIVOT, longest)])]).high
    at = Axis("tip offset b/R", 0.0, float(x[-1]))
    here = [Tick(abs(own), f"b/R {abs(own):.2f}")] if 0 < abs(own) <= x[-1] else []

    def draw(title: str, curves: list[Curve], y: Axis) -> Chart:
        return chart(title, curves, x=at, y=y, marks=here, spans=spans, height=height)

    return (
        draw("Squirt", squirt, Axis("squirt, degrees")),
        draw("Natural pivot length", pivot, Axis(f"pivot length, {unit}", 0.0, highest)),
    )
