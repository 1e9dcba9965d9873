"""Warnings of implausible values of a scene, such as a wrong unit or a diameter entered as a radius causes."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from itertools import pairwise
from math import inf
from typing import Any

import numpy as np

from cuefem.cue import Cue, Segment
from cuefem.effects.tip_effects import TipDome
from cuefem.parameters.parts import MAX_FERRULE, Layout
from cuefem.quantity.display_units import short_number, span_text, unit_suffix, with_unit
from cuefem.quantity.fields import quantity_fields
from cuefem.quantity.unit_checks import CUE_DIAMETER, CUE_LENGTH, MIN_CUE_MASS
from cuefem.results.verdict import density_problem, mass_problem
from cuefem.scene import Ball, Scene, Stroke, Tip

MAX_STEP = 1.5  # ratio of the diameters at the joint of two segments
MIN_DRAWN_MASS = 0.02  # kg
BUTT_END = 0.01  # of the volume: what lies behind it is no part of the taper
DENSITY_MARGIN = 0.1  # relative, beyond the density range of a wood
MIN_FERRULE, MIN_WALL, MIN_BORE = 5e-4, 2e-4, 1e-3  # m; a fibre pad in front of a shaft is 0.8 mm thick
LONG, STIFF, LIGHT = 0.3, 3e10, 2500.0  # m, Pa, kg/m3: a long segment, stiffer than wood and lighter than metal


Check = tuple[str, Any, tuple[float, float], str, str]  # name, value, plausible range, unit, hint


def _usual(kind: type, name: str) -> tuple[float, float]:
    """The plausible range of a field."""
    return next(
        known.typical_range for field, known, *_ in quantity_fields(kind) if field == name and known.typical_range
    )


def _of_stroke(scene: Scene) -> Iterator[Check]:
    leather, ball = f"expected {span_text(1e-3, 2e-3, 's')} for leather", scene.ball
    yield "contact time, rigid cue head-on,", scene.valid_contact_time, _usual(Tip, "contact_time"), "s", leather
    diameter = f"expected {span_text(0.026, 0.031, 'm')}; is this the diameter?"
    yield "ball radius", ball.radius, _usual(Ball, "radius"), "m", diameter
    yield "ball mass", ball.mass, _usual(Ball, "mass"), "kg", f"expected {span_text(0.14, 0.21, 'kg')}"
    yield "stroke speed", scene.stroke.speed, _usual(Stroke, "speed"), "m/s", f"expected {span_text(0.5, 12.0, 'm/s')}"
    yield "friction", scene.tip.friction, (0.2, 1.2), "", "expected 0.5 to 0.8 for chalked leather"
    tips = "expected 0.5 to 0.9, of the tip alone"
    yield "restitution", scene.tip.restitution, (0.0, 0.95), "", tips
    dome = f"expected {span_text(0.009, 0.0106, 'm')}, dime to nickel"
    yield "dome radius", scene.dome_radius or None, _usual(TipDome, "radius"), "m", dome


def _of_drawing(cue: Cue) -> Iterator[Check]:
    yield "drawn length", cue.length, CUE_LENGTH, "m", "check the unit of the lengths"
    ends = (
        (f"segments[{i}].{end}", getattr(segment, end), i == 0 and end == "tip_diameter")
        for i, segment in enumerate(_without_rounded_butt(cue.segments))
        for end in ("tip_diameter", "butt_diameter")
    )
    for name, diameter, is_tip in [end for end in ends if not CUE_DIAMETER[0] <= end[1] <= CUE_DIAMETER[1]][:1]:
        check = "are these radii?" if diameter < CUE_DIAMETER[0] else "check the decimal point and the unit"
        usual = (
            f"{span_text(0.0085, 0.014, 'm')} at the tip" if is_tip else f"{span_text(0.0085, 0.035, 'm')} along a cue"
        )
        yield name, diameter, CUE_DIAMETER, "m", f"expected {usual}; {check}"
    yield from _of_parts(cue)
    yield "drawn mass", cue.shaft_mass, (MIN_DRAWN_MASS, inf), "kg", "check the sizes and the densities"
    if any(
        segment.length > LONG and segment.material.E > STIFF and segment.material.rho < LIGHT
        for segment in cue.segments
        if not max(segment.tip_bore, segment.butt_bore)
    ):
        tubes = "carbon shafts are tubes; add the bore (--bore, or `cuefem guide files`)"
        yield "a solid rod as stiff as carbon fibre, drawn mass", cue.shaft_mass, (0.0, 0.0), "kg", tubes


def _of_parts(cue: Cue) -> Iterator[Check]:
    """Sizes that a slip of unit or decimal point leaves of a ferrule, of a bore or of a wall."""
    ferrule = sum(cue.segments[i].length for i in Layout.of(cue).ferrule)
    usual = f"expected {span_text(0.005, 0.04, 'm')}; check its unit"
    if ferrule:
        yield "ferrule length", ferrule, (MIN_FERRULE, inf), "m", usual
    for i, segment in enumerate(cue.segments):
        core, bore = segment.core, max(segment.tip_bore, segment.butt_bore)
        if core is not None and segment.material.E < core.E:
            yield f"segments[{i}].length, a ferrule on its tenon,", segment.length, (0.0, MAX_FERRULE), "m", usual
        if bore:
            wall = min(segment.tip_diameter - segment.tip_bore, segment.butt_diameter - segment.butt_bore) / 2
            sizes = "check diameter and bore"
            yield (
                f"wall of segments[{i}]",
                wall,
                (MIN_WALL, inf),
                "m",
                f"expected {with_unit(8e-4, 'm')} or more; {sizes}",
            )
            yield (
                f"bore of segments[{i}]",
                bore,
                (MIN_BORE, inf),
                "m",
                f"expected {with_unit(3e-3, 'm')} or more; {sizes}",
            )


def _without_rounded_butt(segments: tuple[Segment, ...]) -> tuple[Segment, ...]:
    """The segments without the last `BUTT_END` of the volume: a chamfer, a rounding or a bumper at the butt."""
    d0, d1, length = np.array([(s.tip_diameter, s.butt_diameter, s.length) for s in segments]).reshape(-1, 3).T
    volumes = (d0**2 + d0 * d1 + d1**2) * length
    behind = np.cumsum(volumes[::-1])[::-1]
    return tuple(s for s, volume in zip(segments, behind, strict=True) if volume > BUTT_END * behind[0])


def _thickest(segments: tuple[Segment, ...], first: float, last: float) -> float:
    """The largest diameter at 11 positions between two shares of the length."""
    ends = np.cumsum([0.0, *(s.length for s in segments)])
    x = np.repeat(ends, 2)[1:-1]
    d = [diameter for s in segments for diameter in (s.tip_diameter, s.butt_diameter)]
    return float(np.interp(ends[-1] * np.linspace(first, last, 11), x, d).max())


def _of_mass(scene: Scene) -> Iterator[Check]:
    mass = float(scene.cue.mass)
    expected = f"expected {span_text(0.4, 0.7, 'kg')}"
    whole = f"{expected}: check the unit of --body-mass (body_mass), or omit it if FILE draws the whole cue"
    yield "mass of the whole cue", mass, (0.0, 1.0), "kg", whole


def plausibility_warnings(scene: Scene, *, with_impact: bool = True) -> list[str]:
    """Warnings of implausible values, one line each; empty for ordinary scenes.

    with_impact: also check ball, tip, stroke and the mass of the whole cue.
    """
    drawing = [] if scene.lumped else drawing_warnings_of(scene.shaft)
    if not with_impact:
        return drawing
    return [*_outside(_of_stroke(scene)), *drawing, *_outside(_of_mass(scene)), *_of_missing_butt(scene)]


def drawing_warnings_of(cue: Cue) -> list[str]:
    """Warnings of a drawing, without the rest of the cue behind it."""
    if not cue.segments:
        return []
    density = density_problem(cue, DENSITY_MARGIN) if cue.shaft_mass_measured else ""
    return [*_outside(_of_drawing(cue)), *filter(None, [density]), *_of_outline(cue.segments)]


def _outside(checks: Iterable[Check]) -> list[str]:
    """The warnings of the values that lie outside their ranges."""
    return [
        f"{name} {with_unit(value, unit, 6).replace('inf', '∞')}; {hint}"
        for name, value, (low, high), unit, hint in checks
        if value is not None and not low <= value <= high
    ]


def _of_missing_butt(scene: Scene) -> Iterator[str]:
    is_drawing_too_light = scene.lumped is None and scene.shaft.shaft_mass < MIN_DRAWN_MASS  # has its own warning
    if scene.cue.mass < MIN_CUE_MASS and not is_drawing_too_light:
        yield mass_problem(scene)


def _of_outline(segments: tuple[Segment, ...]) -> list[str]:
    """Warnings of a cue's outline: steps of the diameter, butt first, and bores that end inside a segment."""
    lines = []
    for i, (near, other) in enumerate(pairwise(_without_rounded_butt(segments))):
        ends = near.butt_diameter, other.tip_diameter
        if max(ends) > MAX_STEP * min(ends):
            sizes = " to ".join(short_number(end, "m") for end in ends)
            lines.append(
                f"the diameter jumps from {sizes}{unit_suffix('m')} between segments[{i}] and segments[{i + 1}]"
            )
    ends = (_thickest(segments, 0, 1 / 3), _thickest(segments, 2 / 3, 1)) if segments else (0.0, 0.0)
    if ends[0] > ends[1]:
        sizes = " and ".join(short_number(end, "m") for end in ends)
        order = "list the rows from tip to butt, or head their column `from butt [mm]`"
        lines.append(f"the tip end is thicker than the butt end, {sizes}{unit_suffix('m')}: {order}")
    for i, segment in enumerate(segments):
        bores = {"tip": segment.tip_bore, "butt": segment.butt_bore}
        missing = [end for end, bore in bores.items() if bore == 0 < max(bores.values())]
        lines += [f"the bore of segments[{i}] tapers to zero; is {end}_bore missing?" for end in missing]
    return lines
