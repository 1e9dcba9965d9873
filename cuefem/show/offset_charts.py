"""Charts of squirt and natural pivot length against the tip offset."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import groupby

import numpy as np

from cuefem.quantity.display_units import display_unit
from cuefem.results.records import Record
from cuefem.show.charts import Axis, Chart, Curve, Shade, Tick, chart

SHADES = {"late stick": "slip", "partial slip": "slip", "gross slip": "slip", "miscue": "miss"}  # CSS classes
MAX_PIVOT = 1.5  # m, of the chart; a longer pivot length is beyond the butt


def offset_charts(
    lines: Sequence[tuple[str, str, Record]],
    offsets: Sequence[float],
    own: float,
    *,
    height: float,
    regimes: Sequence[str] = (),
    title: str = "{}",
) -> tuple[Chart, Chart]:
    """Charts of squirt and natural pivot length against the offset, to the last one before a miscue.

    lines: name, CSS class and `coupled_curve` (or a record with the same keys) of every cue or model; one without
    regimes has those of the scene. own: offset b/R of the scene's stroke, which is marked. regimes: contact state of
    the scene at each offset; long slip and miscue are shaded. title: of a chart, with a place for its quantity.
    """
    x = np.array(offsets)
    per_metre, unit, _ = display_unit("m")
    squirt, pivot = [], []
    for name, style, curve in lines:
        states = curve.get("regime", regimes or [""] * len(x))
        beyond = np.cumsum([state == "miscue" for state in states]) > 0
        angle = np.where(beyond, np.nan, curve["squirt"])
        squirt.append(Curve(name, np.r_[0.0, x], np.degrees(np.r_[0.0, angle]), style))
        pivot.append(Curve(name, x, per_metre * np.where(angle > 0, curve["pivot_length"], np.nan), style))
    ends = np.r_[x[0], (x[1:] + x[:-1]) / 2, x[-1]]
    spans = []
    for shade, run in groupby(range(len(regimes)), lambda i: SHADES.get(regimes[i], "")):
        inside = [*run]
        if shade:
            spans.append(Shade(float(ends[inside[0]]), float(ends[inside[-1] + 1]), shade))
    longest = max((float(np.nanmax(curve.y, initial=0.0)) for curve in pivot), default=0.0)
    highest = Axis("", 0.0).scale_for([min(per_metre * MAX_PIVOT, longest)]).high
    at = Axis("tip offset b/R", 0.0, float(x[-1]))
    here = [Tick(abs(own), f"b/R {abs(own):.2f}")] if 0 < abs(own) <= x[-1] else []

    def draw(title: str, curves: list[Curve], y: Axis) -> Chart:
        return chart(title, curves, x=at, y=y, marks=here, spans=spans, height=height)

    return (
        draw(title.format("Squirt"), squirt, Axis("squirt, degrees")),
        draw(title.format("Natural pivot length"), pivot, Axis(f"pivot length, {unit}", 0.0, highest)),
    )
