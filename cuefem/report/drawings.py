"""Drawings of cues from the side and of their mode shapes, as geometry for the page's templates."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from itertools import accumulate
from typing import NamedTuple

import numpy as np

from cuefem.beam.modes import modes
from cuefem.cue import Material, Segment
from cuefem.cue.materials import MATERIALS, material_name, table_name
from cuefem.report.charts import WIDE, Axis, Chart, Curve, Tick, chart, path
from cuefem.results.quantities import scaled, with_heading
from cuefem.scene import Scene

ACROSS = 4.0  # times that diameters of a whole cue are enlarged
FRONT = 0.16  # m, of the drawing that shows the front true to scale
LEAST_DRAWN = 1e-4  # m of a segment
SHAPES = 4  # mode shapes that are drawn


class Piece(NamedTuple):
    """The outlines of a segment and of its bore, as paths, with the page's classes for their materials."""

    outline: str
    material: str
    bore: str
    core: str


@dataclass(frozen=True)
class CueDrawing:
    """A cue from the side, tip to the left, with places in mm from where its segments begin."""

    title: str
    height: float
    axis: float
    pieces: tuple[Piece, ...]
    ticks: tuple[Tick, ...]


def seen(scene: Scene) -> tuple[Segment, ...]:
    """The segments as one sees them: behind the leather and the layers of a whole tip."""
    segments = scene.shaft.segments
    if scene.contact_terms.tip is None:
        return segments
    tip = scene.leather
    across = tip.diameter_on(segments[0].tip_diameter)
    below = [(layer.height, Material(layer.E, layer.E / 2 / (1 + layer.nu), layer.rho)) for layer in tip.layers[::-1]]
    leather = tip.height - math.fsum(height for height, _ in below)
    in_front = [(leather, MATERIALS["leather"].material), *below]
    return (*(Segment(height, across, across, of) for height, of in in_front), *segments)


def legend(scenes: Iterable[Scene]) -> list[tuple[str, str]]:
    """The materials of drawn cues, from tip to butt, each once, with their classes on the page; and a bore."""
    segments = [segment for scene in scenes for segment in seen(scene)]
    names = [legend_name(of) for segment in segments for of in (segment.material, segment.core) if of is not None]
    hollow = any((s.tip_bore or s.butt_bore) and s.core is None for s in segments)
    return [(name, style_of(name)) for name in dict.fromkeys(names)] + ([("bore", "hollow")] if hollow else [])


def legend_name(material: Material) -> str:
    """A material's name in a drawing's legend, whatever its density."""
    return table_name(material) or material_name(material)


def style_of(name: str) -> str:
    """A material's class on the page."""
    return "m-" + name.replace(" ", "-") if name in MATERIALS else "m-other"


def cue_drawing(scene: Scene, title: str, reach: float | None = None, *, across: float = ACROSS) -> CueDrawing:
    """A cue from the side.

    reach: how far it is drawn, m from where its segments begin; None for all of it. across: times that diameters are
    enlarged.
    """
    segments, own = seen(scene), scene.shaft
    reach = own.length if reach is None else reach
    ahead = sum(segment.length for segment in segments[: len(segments) - len(own.segments)])
    scale = WIDE / (reach + ahead)
    drawn = _cut(segments, reach + ahead)
    axis = 1 + scale * across * max(max(segment.tip_diameter, segment.butt_diameter) for segment in drawn) / 2
    ends = accumulate((segment.length for segment in drawn), initial=0.0)
    pieces = tuple(
        _piece(segment, x, scale, axis, dome=0.0 if x else scene.dome_radius, across=across)
        for x, segment in zip(ends, drawn, strict=False)
    )
    ticks = Axis("mm", 0.0, 1e3 * reach).over([np.zeros(1)]).ticks(scale * ahead, WIDE)
    return CueDrawing(title, 2 * axis, axis, pieces, ticks)


def _cut(segments: Sequence[Segment], reach: float) -> list[Segment]:
    """The segments as far as ``reach``, m."""
    kept: list[Segment] = []
    for segment in segments:
        part = min(1.0, reach / segment.length)
        if reach <= LEAST_DRAWN:
            break
        wide, bore = (
            first + part * (last - first)
            for first, last in (
                (segment.tip_diameter, segment.butt_diameter),
                (segment.tip_bore, segment.butt_bore),
            )
        )
        kept.append(replace(segment, length=part * segment.length, butt_diameter=wide, butt_bore=bore))
        reach -= segment.length
    return kept


def _piece(segment: Segment, x: float, scale: float, axis: float, *, dome: float, across: float) -> Piece:
    """A segment that begins ``x`` m from the front, with the tip's dome if it has one."""

    def outline(tip: float, butt: float, dome: float) -> str:
        first, last = scale * x, scale * (x + segment.length)
        high, low = (scale * across * width / 2 for width in (tip, butt))
        xs, ys = [first, last, last, first], [axis - high, axis - low, axis + low, axis + high]
        if dome > 0 and dome >= tip / 2:
            angle = np.linspace(1, -1, 25) * math.asin(tip / 2 / dome)
            front = scale * dome * (1 - np.cos(angle))
            xs, ys = [*xs[1:3], *front], [*ys[1:3], *(axis + scale * across * dome * np.sin(angle))]
        return path(xs, ys) + "Z"

    return Piece(
        outline(segment.tip_diameter, segment.butt_diameter, dome),
        style_of(legend_name(segment.material)),
        outline(segment.tip_bore, segment.butt_bore, 0.0) if max(segment.tip_bore, segment.butt_bore) > 0 else "",
        "hollow" if segment.core is None else style_of(legend_name(segment.core)),
    )


def modes_chart(scene: Scene) -> Chart:
    """The lowest bending mode shapes, each scaled to its largest deflection."""
    solved, x = modes(scene.shaft, SHAPES, effects=scene.cue_effects), np.linspace(0, scene.shaft.length, 241)
    curves = [
        Curve(f"{frequency:.4g} Hz", scaled(x, "m"), shape / np.abs(shape).max(), f"c{k}")
        for k, (frequency, shape) in enumerate(zip(solved.frequencies, solved.shape(x)[0], strict=True), 1)
    ]
    along = Axis(with_heading("distance from the tip", "m"), 0.0, float(scaled(x[-1], "m")))
    return chart("Bending mode shapes", curves, x=along, y=Axis("deflection", -1.0, 1.0))
