"""Numbers that no cue and no blow has, as a wrong unit or a diameter typed as a radius makes them."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise
from math import inf
from typing import Any

from cuefem.cue import Cue, Segment
from cuefem.cue.materials import MATERIALS, table_name
from cuefem.effects import TipDome
from cuefem.parameters.parts import main_material
from cuefem.quantity.fields import quantities
from cuefem.quantity.slips import CUE_DIAMETER, CUE_LENGTH, LIGHTEST
from cuefem.results.quantities import scaled
from cuefem.scene import Ball, Scene, Stroke, Tip

JUMP = 1.5  # of the diameter between two segments
LEAST_DRAWN = 0.02  # kg, of a shaft
# m, Pa, kg/m^3: a long piece of a material stiffer than wood, lighter than metal
AT_EASE = 0.1  # relative: so far beyond the range of a wood its density may be
LONG, STIFF, LIGHT = 0.3, 3e10, 2500.0


Asked = tuple[str, Any, tuple[float, float], str, str]  # name, value, usual range, unit, what else to ask


def _usual(kind: type, name: str) -> tuple[float, float]:
    """Between which numbers a field usually lies."""
    return next(known.usual for field, known, *_ in quantities(kind) if field == name and known.usual)


def _of_stroke(scene: Scene) -> Iterator[Asked]:
    leather, ball = "expected 0.001 to 0.002 s for leather", scene.ball
    yield "head-on contact time", scene.known_contact_time, _usual(Tip, "contact_time"), "s", leather
    diameter = "expected 26 to 31 mm; is this the diameter?"
    yield "ball radius", ball.radius, _usual(Ball, "radius"), "mm", diameter
    yield "ball mass", ball.mass, _usual(Ball, "mass"), "g", "expected 140 to 210 g"
    yield "stroke speed", scene.stroke.speed, _usual(Stroke, "speed"), "m/s", "expected 0.5 to 12 m/s"
    dome = "expected 9 to 10.6 mm, dime to nickel"
    yield "dome radius", scene.dome_radius or None, _usual(TipDome, "radius"), "mm", dome


def _of_drawing(cue: Cue) -> Iterator[Asked]:
    yield "drawn length", cue.length, CUE_LENGTH, "mm", "check the unit of the lengths"
    ends = (
        (f"segments[{i}].{end}", getattr(segment, end))
        for i, segment in enumerate(cue.segments)
        for end in ("tip_diameter", "butt_diameter")
    )
    radii = "expected 8.5 to 14 mm at the tip; check the unit: are these radii?"
    for name, across in [end for end in ends if not CUE_DIAMETER[0] <= end[1] <= CUE_DIAMETER[1]][:1]:
        yield name, across, CUE_DIAMETER, "mm", radii
    yield "drawn mass", cue.shaft_mass, (LEAST_DRAWN, inf), "g", "check the sizes and the densities"
    wood = main_material(cue)
    known = table_name(wood)
    if cue.weighed and known is not None:
        low, high = MATERIALS[known].ranges["rho"]
        own = f"by the weight of the shaft the density of its {known} is"
        joint = "does the measured mass include a joint or the rest of the cue?"
        yield own, wood.rho, ((1 - AT_EASE) * low, (1 + AT_EASE) * high), "kg/m3", joint
    if any(
        segment.length > LONG and segment.material.E > STIFF and segment.material.rho < LIGHT
        for segment in cue.segments
        if not max(segment.tip_bore, segment.butt_bore)
    ):
        tubes = "carbon shafts are tubes; add the bore (--bore, or `cuefem guide files`)"
        yield "a solid rod as stiff as carbon fibre, drawn mass", cue.shaft_mass, (0.0, 0.0), "g", tubes


def _of_mass(scene: Scene) -> Iterator[Asked]:
    name, mass = "mass of the whole cue", float(scene.cue.mass)
    yield name, mass, (0.0, 1.0), "kg", "expected 0.4 to 0.7 kg"
    if not scene.cue.segments or scene.shaft.shaft_mass >= LEAST_DRAWN:  # else the drawing itself is too light
        body = 'expected 400 to 700 g; add the rest of the cue with --body-mass "15 oz" (body_mass in a file)'
        yield name, mass, (LIGHTEST, inf), "g", body


SHOWN = {"mm": 1e3, "g": 1e3}  # how many of the unit an SI unit is, if not one


def unusual(scene: Scene, *, blow: bool = True) -> list[str]:
    """Numbers that no cue and no blow has, one line each; empty for ordinary scenes.

    blow: whether ball, tip, stroke and the mass of the whole cue count.
    """
    drawn = scene.cue.segments
    asked = [
        *(_of_stroke(scene) if blow else ()),
        *(_of_drawing(scene.shaft) if drawn else ()),
        *(_of_mass(scene) if blow else ()),
    ]
    beyond = [
        f"{name} {SHOWN.get(unit, 1) * value:.6g} {unit}; {ask}"
        for name, value, (least, most), unit, ask in asked
        if value is not None and not least <= value <= most
    ]
    said = [effect.unusual_on(scene.shaft) for effect in scene.effects] if blow and drawn else []
    return [*beyond, *filter(None, said), *_shape(drawn)]


def _shape(segments: tuple[Segment, ...]) -> list[str]:
    """What the outline of a cue has that none has."""
    lines = []
    for i, (near, other) in enumerate(pairwise(segments)):
        ends = near.butt_diameter, other.tip_diameter
        if max(ends) > JUMP * min(ends):
            sizes = " to ".join(f"{scaled(end, 'm'):.4g}" for end in ends)
            lines.append(f"the diameter jumps from {sizes} mm between segments[{i}] and segments[{i + 1}]")
    if segments and segments[0].tip_diameter > segments[-1].butt_diameter:
        ends = segments[0].tip_diameter, segments[-1].butt_diameter
        sizes = " and ".join(f"{scaled(end, 'm'):.4g}" for end in ends)
        lines.append(f"the tip is thicker than the butt, {sizes} mm; is the profile butt first?")
    for i, segment in enumerate(segments):
        bores = {"tip": segment.tip_bore, "butt": segment.butt_bore}
        missing = [end for end, bore in bores.items() if bore == 0 < max(bores.values())]
        lines += [f"the bore of segments[{i}] tapers to zero; is {end}_bore missing?" for end in missing]
    return lines
