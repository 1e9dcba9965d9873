"""Drawings of cues from the side and charts of their mode shapes, as geometry for the templates."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from itertools import accumulate
from typing import NamedTuple

import numpy as np

from cuefem.beam.modes import modes
from cuefem.cue import Cue, Material, Segment
from cuefem.cue.materials import MATERIALS, material_name, table_name
from cuefem.parameters.parts import outer_diameter
from cuefem.quantity.display_units import display_unit, number_text, short_number, significant, to_display, with_heading
from cuefem.scene import Scene
from cuefem.show.charts import WIDTH, Axis, Chart, Curve, Tick, chart, path, round_step, spread_labels

DIAMETER_SCALE = 4.0  # enlargement of the diameters in the drawing of a whole cue
FRONT_LENGTH = 0.16  # m, length of the drawing of the front, true to scale
MIN_DRAWN = 1e-4  # m, of a segment
SHAPES = 4  # mode shapes in the chart
MOST_STATIONS, LABEL_GAP, BELOW = 15, 21.0, 24.0  # of a lathe drawing: room for a label and for two rows of them
MOST_JOINTS = 6  # whose places are stations of their own; a table of a lathe has more


class Piece(NamedTuple):
    """The outlines of a segment and of its bore as paths, with the CSS classes of their materials."""

    outline: str
    material: str
    bore: str
    core: str


class Station(NamedTuple):
    """A place along a lathe drawing, its label's place, half the diameter in the drawing, and the texts below it."""

    at: float
    label_at: float
    half: float
    diameter: str
    distance: str


@dataclass(frozen=True)
class CueDrawing:
    """A cue from the side, tip on the left; ticks in the display unit of lengths from the front of its segments.

    stations: of a lathe drawing, which has diameters below it; the height includes their room.
    """

    title: str
    height: float
    axis: float
    pieces: tuple[Piece, ...]
    ticks: tuple[Tick, ...]
    unit: str
    stations: tuple[Station, ...] = ()


def drawn_segments(scene: Scene) -> tuple[Segment, ...]:
    """The segments of the cue, with the leather and the layers of a `LeatherTip` in front."""
    segments = scene.shaft.segments
    if scene.contact_terms.tip is None:
        return segments
    tip = scene.leather_tip
    diameter = tip.diameter_on(segments[0].tip_diameter)
    below = [(layer.height, Material(layer.E, layer.E / 2 / (1 + layer.nu), layer.rho)) for layer in tip.layers[::-1]]
    leather = tip.height - math.fsum(height for height, _ in below)
    in_front = [(leather, MATERIALS["leather"].material), *below]
    return (*(Segment(height, diameter, diameter, of) for height, of in in_front), *segments)


def legend(scenes: Iterable[Scene]) -> list[tuple[str, str]]:
    """Names and CSS classes of the materials of drawn cues, from tip to butt; and of a bore."""
    segments = [segment for scene in scenes for segment in drawn_segments(scene)]
    names = [legend_name(of) for segment in segments for of in (segment.material, segment.core) if of is not None]
    hollow = any((s.tip_bore or s.butt_bore) and s.core is None for s in segments)
    return [(name, css_class(name)) for name in dict.fromkeys(names)] + ([("bore", "hollow")] if hollow else [])


def legend_name(material: Material) -> str:
    """The name of a material in a legend, regardless of its density."""
    return table_name(material) or material_name(material)


def css_class(name: str) -> str:
    """The CSS class of a material."""
    return "m-" + name.replace(" ", "-") if name in MATERIALS else "m-other"


def leather_ahead(scene: Scene) -> float:
    """Length, m, that is drawn in front of the segments of a cue."""
    segments = drawn_segments(scene)
    return math.fsum(segment.length for segment in segments[: len(segments) - len(scene.shaft.segments)])


def cue_drawing(
    scene: Scene,
    title: str,
    length: float | None = None,
    *,
    diameter_scale: float = DIAMETER_SCALE,
    ahead: float | None = None,
) -> CueDrawing:
    """A cue from the side.

    length: m from the front of its segments; None for the whole cue. diameter_scale: enlargement of the diameters.
    ahead: m in front of the segments, at least `leather_ahead`; cues with the same length and ahead are drawn at one
    scale, their segments one below the other.
    """
    segments = drawn_segments(scene)
    length = scene.shaft.length if length is None else length
    own_ahead = leather_ahead(scene)
    ahead = own_ahead if ahead is None else ahead
    scale = WIDTH / (length + ahead)
    drawn = _cut(segments, length + own_ahead)
    widest = max(max(segment.tip_diameter, segment.butt_diameter) for segment in drawn)
    axis = 1 + scale * diameter_scale * widest / 2
    ends = accumulate((segment.length for segment in drawn), initial=ahead - own_ahead)
    pieces = tuple(
        _piece(segment, x, scale, axis, dome=0.0 if i else scene.dome_radius, diameter_scale=diameter_scale)
        for i, (x, segment) in enumerate(zip(ends, drawn, strict=False))
    )
    per_metre, unit, _ = display_unit("m")
    ticks = Axis(unit, 0.0, per_metre * length).scale_for([np.zeros(1)]).ticks(scale * ahead, WIDTH)
    return CueDrawing(title, 2 * axis, axis, pieces, ticks, unit)


def lathe_drawing(scene: Scene, title: str) -> CueDrawing:
    """A whole cue from the side with its diameters at stations, which count from the front of its segments."""
    cue, drawing = scene.shaft, cue_drawing(scene, title)
    ahead = leather_ahead(scene)
    scale = WIDTH / (cue.length + ahead)
    places = stations_of(cue)
    at = [scale * (ahead + x) for x in places]
    labels = spread_labels(at, LABEL_GAP / 2, WIDTH - LABEL_GAP / 2, gap=LABEL_GAP)
    stations = tuple(
        Station(x, label, scale * DIAMETER_SCALE * outer_diameter(cue, place) / 2, *_station_texts(cue, place))
        for x, label, place in zip(at, labels, places, strict=True)
    )
    return replace(drawing, height=drawing.height + BELOW, stations=stations)


def _station_texts(cue: Cue, place: float) -> tuple[str, str]:
    return number_text(outer_diameter(cue, place), "m", decimals=2), short_number(place, "m")


def stations_of(cue: Cue) -> list[float]:
    """Places, m, at which a lathe drawing has diameters: ends, joints of segments, and round steps between them."""
    per_metre = display_unit("m").factor
    step = round_step(per_metre * cue.length, MOST_STATIONS) / per_metre
    joints = cue.nodes[1:-1].tolist() if len(cue.segments) <= MOST_JOINTS else []
    between = [step * i for i in range(1, math.ceil(cue.length / step))]
    chosen = [0.0, cue.length]
    for places, apart in ((joints, 0.45), (between, 0.7)):
        chosen += [x for x in places if min(abs(x - other) for other in chosen) >= apart * step]
    return sorted(chosen)


def _cut(segments: Sequence[Segment], length: float) -> list[Segment]:
    """The segments up to ``length``, m."""
    front: list[Segment] = []
    for segment in segments:
        part = min(1.0, length / segment.length)
        if length <= MIN_DRAWN:
            break
        diameter, bore = (
            first + part * (last - first)
            for first, last in (
                (segment.tip_diameter, segment.butt_diameter),
                (segment.tip_bore, segment.butt_bore),
            )
        )
        front.append(replace(segment, length=part * segment.length, butt_diameter=diameter, butt_bore=bore))
        length -= segment.length
    return front


def _piece(segment: Segment, x: float, scale: float, axis: float, *, dome: float, diameter_scale: float) -> Piece:
    """A segment that begins ``x`` m from the front. dome: radius of the tip's dome, m; 0 for none."""

    def outline(tip: float, butt: float, dome: float) -> str:
        first, last = scale * x, scale * (x + segment.length)
        high, low = (scale * diameter_scale * diameter / 2 for diameter in (tip, butt))
        xs, ys = [first, last, last, first], [axis - high, axis - low, axis + low, axis + high]
        if dome > 0 and dome >= tip / 2:
            angle = np.linspace(1, -1, 25) * math.asin(tip / 2 / dome)
            front = first + scale * dome * (1 - np.cos(angle))
            xs, ys = [*xs[1:3], *front], [*ys[1:3], *(axis + scale * diameter_scale * dome * np.sin(angle))]
        return path(xs, ys) + "Z"

    return Piece(
        outline(segment.tip_diameter, segment.butt_diameter, dome),
        css_class(legend_name(segment.material)),
        outline(segment.tip_bore, segment.butt_bore, 0.0) if max(segment.tip_bore, segment.butt_bore) > 0 else "",
        "hollow" if segment.core is None else css_class(legend_name(segment.core)),
    )


def modes_chart(scene: Scene) -> Chart:
    """The lowest bending mode shapes, each scaled to its largest deflection."""
    solved, x = modes(scene.shaft, SHAPES, effects=scene.cue_effects), np.linspace(0, scene.shaft.length, 241)
    curves = [
        Curve(f"{significant(frequency)} Hz", to_display(x, "m"), shape / np.abs(shape).max(), f"c{k}")
        for k, (frequency, shape) in enumerate(zip(solved.frequencies, solved.shape(x)[0], strict=True), 1)
    ]
    along = Axis(with_heading("distance from the front of the drawing", "m"), 0.0, float(to_display(x[-1], "m")))
    return chart("Bending mode shapes", curves, x=along, y=Axis("deflection", -1.0, 1.0))
