"""Drawings of the cue, of the strike and of the mode shapes, as geometry for the page's template."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import accumulate
from typing import Any, NamedTuple

import numpy as np

from cuefem.beam.modes import Modes
from cuefem.cue import Material, Segment
from cuefem.cue.materials import MATERIALS, material_name, table_name
from cuefem.quantity.fields import scalar
from cuefem.report.charts import WIDE, Axis, Tick, path
from cuefem.results.quantities import TRADE
from cuefem.scene import Scene

ACROSS = 8.0  # times that diameters are enlarged
TITLE = f"Diameters {ACROSS:g} times enlarged"
FRONT = 0.16  # m, of the drawing that shows the front true to scale


class Piece(NamedTuple):
    """The outlines of a segment and of its bore, as paths, with the page's classes for their materials."""

    outline: str
    material: str
    bore: str
    core: str


class Sign(NamedTuple):
    """An effect at its place on the cue: where, and its name."""

    at: float
    label: str


@dataclass(frozen=True)
class CueDrawing:
    """A cue from the side, tip to the left, its diameters `ACROSS` times enlarged."""

    title: str
    height: float
    axis: float
    pieces: tuple[Piece, ...]
    signs: tuple[Sign, ...]
    ticks: tuple[Tick, ...]
    unit: str = "mm"


@dataclass(frozen=True)
class SeenCue:
    """The segments of a cue as one sees it, which may be one more than a cue itself may have."""

    segments: tuple[Segment, ...]

    @property
    def nodes(self) -> tuple[float, ...]:
        """Positions of the ends of the segments, m from the tip."""
        return tuple(accumulate((segment.length for segment in self.segments), initial=0.0))

    @property
    def length(self) -> float:
        """Its length, m."""
        return self.nodes[-1]


def materials_of(cue: SeenCue) -> tuple[str, ...]:
    """Names of a cue's materials, from tip to butt, each once."""
    materials = [m for segment in cue.segments for m in (segment.material, segment.core) if m is not None]
    return tuple(dict.fromkeys(map(legend_name, materials)))


def seen(scene: Scene) -> SeenCue:
    """The cue as one sees it: with the leather and the layers of a whole tip in front of its segments."""
    segments = scene.shaft.segments
    if scene.contact_terms.tip is None:
        return SeenCue(segments)
    tip = scene.leather
    across = tip.diameter_on(segments[0].tip_diameter)
    below = [(layer.height, Material(layer.E, layer.E / 2 / (1 + layer.nu), layer.rho)) for layer in tip.layers[::-1]]
    leather = tip.height - math.fsum(height for height, _ in below)
    in_front = [(leather, MATERIALS["leather"].material), *below]
    return SeenCue((*(Segment(height, across, across, of) for height, of in in_front), *segments))


def legend_name(material: Material) -> str:
    """A material's name in a drawing's legend, whatever its density."""
    return table_name(material) or material_name(material)


def style_of(name: str) -> str:
    """A material's class on the page."""
    return "m-" + name.replace(" ", "-") if name in MATERIALS else "m-other"


def cue_drawing(scene: Scene) -> CueDrawing:
    """The whole cue from the side, its diameters `ACROSS` times enlarged."""
    cue = seen(scene)
    ahead = cue.length - scene.shaft.length  # positions on the cue count from behind the leather
    scale = (WIDE - 20) / cue.length
    widest = max(max(s.tip_diameter, s.butt_diameter) for s in cue.segments) * scale * ACROSS
    signs = tuple(
        Sign(10 + scale * (x + ahead), type(effect).__name__)
        for effect in scene.effects
        for x in effect.positions
        if not effect.whole_tip
    )
    axis = (14.0 if signs else 3.0) + widest / 2
    pieces = tuple(
        _piece(segment, x, scale=scale, axis=axis, dome=0.0 if x else scene.dome_radius)
        for x, segment in zip(cue.nodes[:-1], cue.segments, strict=True)
    )
    per_metre, unit = TRADE["m"]
    ticks = Axis(unit, 0.0, per_metre * cue.length).over([np.zeros(1)]).ticks(10.0, WIDE - 10.0)
    return CueDrawing(TITLE, axis + widest / 2 + 16, axis, pieces, signs, ticks, unit)


def true_drawing(scene: Scene, reach: float, title: str) -> CueDrawing:
    """The cue from the side, true to scale, as far as ``reach``, m from where its segments begin."""
    cue = seen(scene)
    ahead = cue.length - scene.shaft.length
    scale = WIDE / (reach + ahead)
    shown = [(x, segment) for x, segment in zip(cue.nodes, cue.segments, strict=False) if x < reach + ahead]
    widest = max(max(segment.tip_diameter, segment.butt_diameter) for _, segment in shown[:-1] or shown)
    x, last = shown[-1]
    there = last.tip_diameter + (last.butt_diameter - last.tip_diameter) * min(1.0, (reach + ahead - x) / last.length)
    axis = 1.0 + scale * max(widest, last.tip_diameter, there) / 2
    pieces = tuple(
        _piece(segment, x, scale=scale, axis=axis, dome=0.0 if x else scene.dome_radius, across=1.0, left=0.0)
        for x, segment in shown
    )
    ticks = Axis("mm", 0.0, 1e3 * reach).over([np.zeros(1)]).ticks(scale * ahead, WIDE)
    return CueDrawing(title, 2 * axis, axis, pieces, (), ticks)


def _piece(
    segment: Segment, x: float, *, scale: float, axis: float, dome: float, across: float = ACROSS, left: float = 10.0
) -> Piece:
    def outline(tip: float, butt: float, dome: float) -> str:
        first, last = left + scale * x, left + scale * (x + segment.length)
        high, low = (scale * across * width / 2 for width in (tip, butt))
        xs, ys = [first, last, last, first], [axis - high, axis - low, axis + low, axis + high]
        if dome > 0 and dome >= tip / 2:
            angle = np.linspace(1, -1, 25) * math.asin(tip / 2 / dome)
            front = left + scale * dome * (1 - np.cos(angle))
            xs, ys = [*xs[1:3], *front], [*ys[1:3], *(axis + scale * across * dome * np.sin(angle))]
        return path(xs, ys) + "Z"

    return Piece(
        outline(segment.tip_diameter, segment.butt_diameter, dome),
        style_of(legend_name(segment.material)),
        outline(segment.tip_bore, segment.butt_bore, 0.0) if max(segment.tip_bore, segment.butt_bore) > 0 else "",
        "hollow" if segment.core is None else style_of(legend_name(segment.core)),
    )


@dataclass(frozen=True)
class StrikeDrawing:
    """The blow from above: the ball, the cue's tip, the line of the cue and the line that the ball takes."""

    height: float
    ball: tuple[float, float, float]  # centre and radius
    contact: tuple[float, float]
    pieces: tuple[tuple[str, str], ...]  # the cue's end: outline and material's class, from the tip on
    cue_line: float
    path_end: tuple[float, float]
    straight_end: tuple[float, float]
    labels: tuple[float, float]  # heights of the two lines' labels: of the cue's, of the ball's path


def strike_drawing(scene: Scene, squirt: float) -> StrikeDrawing:
    """The blow at the scene's offset; lengths and the angle of squirt are true."""
    R = scalar("Ball.radius", scene.ball.radius)
    phi = math.asin(scalar("Stroke.offset", scene.stroke.offset))
    r = scene.dome_radius
    across = scene.tip_diameter if scene.cue.segments else 0.4 * R
    apex, scale = 300.0, 1.9e3 * 0.03 / R
    middle = 75.0
    centre = (apex + scale * (r - (R + r) * math.cos(phi)), middle)
    line = middle - scale * (R + r) * math.sin(phi)
    radius = max(r, across / 2)
    angle = np.linspace(1, -1, 25) * math.asin(across / 2 / radius)
    front_x = apex + scale * radius * (1 - np.cos(angle)) if r else np.full(25, apex)
    front_y = line + scale * across / 2 * np.linspace(1, -1, 25) if not r else line + scale * radius * np.sin(angle)
    segments = scene.cue.segments and seen(scene).segments
    pieces = _struck_end(segments, across, (front_x, front_y), apex=apex, line=line, scale=scale)
    reach = float(centre[0]) - 6
    fall = reach * math.tan(squirt)
    return StrikeDrawing(
        150.0,
        (float(centre[0]), middle, float(scale * R)),
        (apex + scale * r * (1 - math.cos(phi)), line + scale * r * math.sin(phi)),
        pieces,
        line,
        (float(centre[0]) - reach, middle + fall),
        (float(centre[0]) - reach, middle),
        (line - 6, middle + fall + 16) if phi >= 0 else (line + 15, middle + fall - 9),
    )


def _struck_end(
    segments: Sequence[Segment], across: float, front: tuple[Any, Any], *, apex: float, line: float, scale: float
) -> tuple[tuple[str, str], ...]:
    """The segments as far as the drawing reaches, the first with the tip's front; a lumped cue has no material."""
    reach = (WIDE - apex) / scale
    parts = [(0.0, reach, across, across, "m-other")]
    if segments:
        ends = [0.0, *accumulate(s.length for s in segments)]
        parts = [
            (x, x + s.length, s.tip_diameter, s.butt_diameter, style_of(legend_name(s.material)))
            for x, s in zip(ends, segments, strict=False)
            if x < reach
        ]
    shapes = []
    for x, end, first, last, style in parts:
        near, far = apex + scale * x, min(apex + scale * end, WIDE)
        wide = scale * first / 2, scale * (first + (last - first) * min(1, (reach - x) / (end - x))) / 2
        xs, ys = ([*front[0]], [*front[1]]) if x == 0 else ([near, near], [line + wide[0], line - wide[0]])
        shapes.append((path([*xs, far, far], [*ys, line - wide[1], line + wide[1]]) + "Z", style))
    return tuple(shapes)


class ModeRow(NamedTuple):
    """A mode's shape about its own line, its nodes on that line, and its frequency."""

    axis: float
    shape: str
    nodes: tuple[float, ...]
    frequency: str


@dataclass(frozen=True)
class ModesDrawing:
    """Mode shapes over the length of the cue."""

    height: float
    rows: tuple[ModeRow, ...]
    ticks: tuple[Tick, ...]
    unit: str = "mm"


def modes_drawing(modes: Modes, length: float, *, row: float = 38.0) -> ModesDrawing:
    """The modes' deflections, all drawn equally high."""
    left, right = 10.0, WIDE - 78.0
    x = np.linspace(0, length, 241)
    shapes, _ = modes.shape(x)
    places = left + (right - left) * x / length
    rows = []
    for i, (shape, frequency) in enumerate(zip(shapes, modes.frequencies, strict=True)):
        axis, high = row * (i + 0.5) + 4, shape / np.abs(shape).max()
        change = np.flatnonzero(high[:-1] * high[1:] < 0)
        nodes = places[change] + (places[1] - places[0]) * high[change] / (high[change] - high[change + 1])
        written = f"{frequency:.1f} Hz" if frequency < 1e3 else f"{frequency / 1e3:.2f} kHz"
        rows.append(ModeRow(axis, path(places, axis - 0.42 * row * high), tuple(nodes.tolist()), written))
    per_metre, unit = TRADE["m"]
    ticks = Axis(unit, 0.0, per_metre * length).over([np.zeros(1)]).ticks(left, right)
    return ModesDrawing(row * len(rows) + 32, tuple(rows), ticks, unit)
