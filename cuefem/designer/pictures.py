"""The designer's pictures as markup, drawn as the report draws them."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from cuefem.designer.answers import Answers, Curve, Density
from cuefem.designer.model import cue_of
from cuefem.report import charts as figures
from cuefem.report.charts import Axis, chart
from cuefem.report.drawings import cue_drawing, front_drawing, materials_of, modes_drawing, seen, style_of
from cuefem.report.squirt import offset_charts as report_charts
from cuefem.report.templates import chart_markup, cue_markup, shapes_markup
from cuefem.scene import Scene

HIGH = 280.0


def cue_pictures(scene: Scene) -> str:
    """The cue to scale, enlarged across, its tip end; and which colour is which material."""
    whole, wide, front = cue_drawing(scene, across=1.0), cue_drawing(scene, across=8.0), front_drawing(scene)
    cue = cue_of(scene)
    hollow = any((s.tip_bore or s.butt_bore) and s.core is None for s in cue.segments)
    named = [(name, style_of(name)) for name in materials_of(seen(scene))] + ([("bore", "hollow")] if hollow else [])
    legend = "".join(f'<span><i class="swatch {style}"></i>{name}</span> ' for name, style in named)
    near = f'<div class="grid2">{cue_markup(wide)}{cue_markup(front)}</div>'
    return f'{cue_markup(whole)}{near}<p class="legend">{legend}</p>'


def offset_charts(
    found: Answers, coupled: Curve | None, pinned: tuple[Answers, Curve | None] | None, *, current: bool
) -> str:
    """Squirt and pivot length against the offset. current: whether the coupled curve is of this design already."""
    lines: list[tuple[str, str, Curve]] = []
    if coupled is not None:
        lines.append(("coupled, in time", "c1", coupled) if current else ("coupled, before", "c1 stale", coupled))
    lines.append(("lumped, stick end mass", "c3", found.lumped))
    if pinned is not None:
        lines.append(("pinned, coupled", "c2", pinned[1]) if pinned[1] else ("pinned, lumped", "c2", pinned[0].lumped))
    charts = report_charts(
        [(name, style, one.squirt, one.pivot_length) for name, style, one in lines],
        *(found.lumped.offsets, float(found.scene.stroke.offset)),
        height=HIGH,
    )
    return f'<div class="grid2">{"".join(chart_markup(c, f"offset{i}") for i, c in enumerate(charts))}</div>'


def density_chart(found: Density, pinned: Density | None) -> str:
    """Where end mass lives along the cue, in grams a centimetre; and how near to the tip half of it does."""
    mm = 1e3 * found.x
    curves = [
        figures.Curve("whole", mm, 10 * (found.from_mass + found.from_stiffness), "c1"),
        figures.Curve("from the mass there", mm, 10 * found.from_mass, "c3"),
        figures.Curve("from the stiffness there", mm, 10 * found.from_stiffness, "c4"),
    ]
    if pinned is not None:
        curves.append(
            figures.Curve("pinned, whole", 1e3 * pinned.x, 10 * (pinned.from_mass + pinned.from_stiffness), "c2")
        )
    made = chart(
        *("End mass per length of cue", curves),
        x=Axis("distance from the tip, mm", 0.0),
        y=Axis("end mass, g/cm"),
        height=HIGH,
    )
    half = f"Half of it lies within {1e3 * half_within(found):.0f} mm of the tip."
    return chart_markup(made, "density") + f"<p>{half} Stick end mass of the bare cue, without effects.</p>"


def half_within(found: Density) -> float:
    """The distance from the tip within which half of the end mass lies, m."""
    sums = np.cumsum((found.from_mass + found.from_stiffness) * found.weights)
    return float(found.x[int(np.argmax(sums >= sums[-1] / 2))])


def shapes_picture(found: Answers) -> str:
    """The bending modes."""
    return shapes_markup(modes_drawing(found.found, cue_of(found.scene).length))


def curve_of(points: Sequence[tuple[float, float, float]]) -> Curve:
    """A curve of (offset, squirt, pivot length)."""
    offsets, squirt, pivot = zip(*points, strict=True)
    return Curve(offsets, np.array(squirt), np.array(pivot))
