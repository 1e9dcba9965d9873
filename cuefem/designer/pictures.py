"""The designer's pictures as markup, drawn as the report draws them."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import cycle
from typing import NamedTuple

import numpy as np
from scipy.interpolate import PchipInterpolator

from cuefem.cue import Array
from cuefem.designer.answers import CURVE_OFFSETS, Answers, Density, Point, SquirtCurve
from cuefem.designer.unit_system import METRIC, UnitSystem
from cuefem.report import charts as figures
from cuefem.report.charts import Axis, Shade, chart
from cuefem.report.drawings import cue_drawing, materials_of, modes_drawing, seen, style_of
from cuefem.report.squirt import offset_charts as report_charts
from cuefem.report.templates import chart_markup, cue_markup, shapes_markup
from cuefem.scene import Scene

HIGH = 280.0
STYLES = ("c2", "c4", "c3", "c5")  # of pinned designs, in turn
LIMITS = {"slips": ("slip", "slips through much of the blow"), "miscue": ("miss", "slips off the ball (a miscue)")}


def cue_pictures(scene: Scene, system: UnitSystem = METRIC) -> str:
    """The cue, enlarged across; and which colour is which material."""
    cue = scene.shaft
    hollow = any((s.tip_bore or s.butt_bore) and s.core is None for s in cue.segments)
    named = [(name, style_of(name)) for name in materials_of(seen(scene))] + ([("bore", "hollow")] if hollow else [])
    legend = "".join(f'<span><i class="swatch {style}"></i>{name}</span> ' for name, style in named)
    return f'{cue_markup(cue_drawing(scene, units=system.units))}<p class="legend">{legend}</p>'


class Drawn(NamedTuple):
    """A pinned design's curves by its name; None while they are computed."""

    name: str
    coupled: SquirtCurve | None
    density: Density | None


def offset_charts(
    answers: Answers,
    coupled: SquirtCurve | None,
    pinned: Sequence[Drawn],
    *,
    current: bool,
    limits: Sequence[Shade] = (),
    system: UnitSystem = METRIC,
) -> str:
    """Squirt and pivot length against the offset, the coupled curves of all designs: like with like.

    current: whether the coupled curve is of this design already. limits: where this design's strokes are not safe.
    """
    lines: list[tuple[str, str, SquirtCurve]] = []
    if coupled is not None:
        lines.append(("coupled, in time", "c1", coupled) if current else ("coupled, before", "c1 stale", coupled))
    lines += [
        (curve.name, style, curve.coupled) for curve, style in zip(pinned, cycle(STYLES), strict=False) if curve.coupled
    ]
    if answers.lumped is not None and (not pinned or coupled is None):
        lines.append(("lumped, stick end mass", "c3", answers.lumped))
    if not lines:  # nothing is computed yet
        return ""
    charts = report_charts(
        [(name, style, _smooth(curve.squirt), _smooth(curve.pivot_length)) for name, style, curve in lines],
        FINE.tolist(),
        float(answers.scene.stroke.offset),
        height=HIGH,
        spans=limits,
        units=system.units,
    )
    return f'<div class="grid2">{"".join(chart_markup(c, f"offset{i}") for i, c in enumerate(charts))}</div>'


FINE = np.linspace(CURVE_OFFSETS[0], CURVE_OFFSETS[-1], 10 * (len(CURVE_OFFSETS) - 1) + 1)


def _smooth(values: Array) -> Array:
    """A curve at `FINE` offsets through its values at `CURVE_OFFSETS`, without overshoot; nan where those are."""
    known = np.flatnonzero(np.isfinite(values))
    if len(known) < 2:
        return np.full(len(FINE), np.nan)
    return np.asarray(PchipInterpolator(np.array(CURVE_OFFSETS)[known], values[known], extrapolate=False)(FINE))


def limits_of(points: Sequence[Point]) -> tuple[list[Shade], str]:
    """Where strokes are not safe, as parts to shade; and from which offsets on, in a sentence."""
    spans: list[Shade] = []
    starts: dict[str, float] = {}
    half = 0.5 * (CURVE_OFFSETS[1] - CURVE_OFFSETS[0])
    for i, point in enumerate(points):
        if point.safety != "safe":
            last = i == len(points) - 1 and point.safety == "miscue"
            end = CURVE_OFFSETS[-1] if last else point.offset + half
            spans.append(Shade(point.offset - half, min(end, CURVE_OFFSETS[-1]), LIMITS[point.safety][0]))
            starts.setdefault(point.safety, point.offset - half)
    said = [f"{LIMITS[name][1]} from b/R {start:.2f} on" for name, start in starts.items()]
    return spans, f"Shaded: the tip {', and '.join(said)}." if said else ""


def density_chart(density: Density, pinned: Sequence[Drawn], system: UnitSystem = METRIC) -> str:
    """Where end mass lives along the cue, and how near to the tip half of it does."""
    (per_metre, length), (per_kilogram, mass) = system.units["m"], system.units["kg"]
    per, scale = ("cm", 0.01 * per_kilogram) if length == "mm" else (length, per_kilogram / per_metre)
    x = per_metre * density.x
    curves = [
        figures.Curve("whole", x, scale * (density.from_mass + density.from_stiffness), "c1"),
        *(
            figures.Curve(f"{drawn.name}, whole", per_metre * d.x, scale * (d.from_mass + d.from_stiffness), style)
            for drawn, style in zip(pinned, cycle(STYLES), strict=False)
            if (d := drawn.density)
        ),
    ]
    if not pinned:
        curves.append(figures.Curve("from the mass there", x, scale * density.from_mass, "c3"))
        curves.append(figures.Curve("from the stiffness there", x, scale * density.from_stiffness, "c4"))
    made = chart(
        *("End mass per length of cue", curves),
        x=Axis(f"distance from the tip, {length}", 0.0),
        y=Axis(f"end mass, {mass}/{per}"),
        height=HIGH,
    )
    half = f"Half of it lies within {system.length(half_within(density), 3)} of the tip."
    return chart_markup(made, "density") + f"<p>{half} Stick end mass of the bare cue, without effects.</p>"


def half_within(density: Density) -> float:
    """The distance from the tip within which half of the end mass lies, m."""
    sums = np.cumsum((density.from_mass + density.from_stiffness) * density.weights)
    return float(density.x[int(np.argmax(sums >= sums[-1] / 2))])


def shapes_picture(answers: Answers, system: UnitSystem = METRIC) -> str:
    """The bending modes; nothing if they are not computed yet."""
    if answers.bending is None:
        return ""
    return shapes_markup(modes_drawing(answers.bending, answers.scene.shaft.length, units=system.units))
