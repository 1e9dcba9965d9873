"""Drawings of the cue, of the strike and of the mode shapes, as geometry for the page's template."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from itertools import accumulate
from typing import NamedTuple

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
LEAST_DRAWN = 1e-4  # m of a segment
NO_MATERIAL = Material(1e10, 1e9, 700.0)  # of a lumped cue


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


def cue_drawing(scene: Scene) -> CueDrawing:
    """The whole cue from the side, its diameters `ACROSS` times enlarged, with its effects."""
    places = [(x, type(effect).__name__) for effect in scene.effects if not effect.whole_tip for x in effect.positions]
    return _from_side(
        scene,
        scene.shaft.length,
        TITLE,
        across=ACROSS,
        left=10.0,
        above=14.0 if places else 3.0,
        places=places,
    )


def true_drawing(scene: Scene, reach: float, title: str) -> CueDrawing:
    """The cue from the side, true to scale, as far as ``reach``, m from where its segments begin."""
    return _from_side(scene, reach, title, across=1.0, left=0.0, above=1.0)


def _from_side(
    scene: Scene,
    reach: float,
    title: str,
    *,
    across: float,
    left: float,
    above: float,
    places: Sequence[tuple[float, str]] = (),
) -> CueDrawing:
    """across: times that diameters are enlarged; left, above: space; places: of effects, m, with their names."""
    segments = seen(scene)
    ahead = sum(segment.length for segment in segments[: len(segments) - len(scene.shaft.segments)])
    scale = (WIDE - 2 * left) / (reach + ahead)
    drawn = _cut(segments, reach + ahead)
    half = scale * across * max(max(segment.tip_diameter, segment.butt_diameter) for segment in drawn) / 2
    pieces = _pieces(drawn, scale=scale, axis=above + half, dome=scene.dome_radius, across=across, left=left)
    signs = tuple(Sign(left + scale * (x + ahead), name) for x, name in places)
    ticks = Axis("mm", 0.0, 1e3 * reach).over([np.zeros(1)]).ticks(left + scale * ahead, WIDE - left)
    return CueDrawing(title, 2 * half + above + 1, above + half, pieces, signs, ticks)


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


def _pieces(
    segments: Sequence[Segment], *, scale: float, axis: float, dome: float, across: float, left: float
) -> tuple[Piece, ...]:
    """The segments' outlines from ``left`` on, the first with the tip's dome."""
    ends = accumulate((segment.length for segment in segments), initial=0.0)
    return tuple(
        _piece(segment, x, scale=scale, axis=axis, dome=0.0 if x else dome, across=across, left=left)
        for x, segment in zip(ends, segments, strict=False)
    )


def _piece(segment: Segment, x: float, *, scale: float, axis: float, dome: float, across: float, left: float) -> Piece:
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
    pieces: tuple[Piece, ...]  # the cue's end, from the tip on
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
    lumped = Segment((WIDE - apex) / scale, across, across, NO_MATERIAL)  # of which all that is drawn has one diameter
    pieces = _pieces(
        _cut(seen(scene) if scene.cue.segments else [lumped], (WIDE - apex) / scale),
        **{"scale": scale, "axis": line, "dome": max(r, across / 2) if r else 0.0, "across": 1.0, "left": apex},
    )
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
