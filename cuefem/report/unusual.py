"""Numbers that no cue and no blow has, as a wrong unit or a diameter typed as a radius makes them."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from itertools import pairwise
from math import inf
from typing import Any, NamedTuple

from cuefem.cue import Segment
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


class UsualNumbers(NamedTuple):
    """Numbers of a scene (by name, SI), their usual range, the unit that shows them, and what else to ask."""

    of: Callable[[Scene], Iterable[tuple[str, Any]]]
    least: float
    most: float
    unit: str
    ask: str
    blow: bool = True  # whether it matters to a blow alone, and not to how the cue rings


def _usual(kind: type, name: str) -> tuple[float, float]:
    """Between which numbers a field usually lies."""
    return next(known.usual for field, known, *_ in quantities(kind) if field == name and known.usual)


def _of_drawing(name: str, attribute: str) -> Callable[[Scene], Iterable[tuple[str, Any]]]:
    """A number of the segments, if the cue has any."""
    return lambda scene: [(name, getattr(scene.shaft, attribute))] if scene.cue.segments else []


def _diameters(scene: Scene) -> Iterable[tuple[str, float]]:
    for i, segment in enumerate(scene.cue.segments):
        yield f"segments[{i}].tip_diameter", segment.tip_diameter
        yield f"segments[{i}].butt_diameter", segment.butt_diameter


def _solid_tubes(scene: Scene) -> Iterable[tuple[str, float]]:
    """The mass of a shaft with a long piece that is solid, of a material that shafts have as a tube (carbon fibre)."""
    solid = [
        segment
        for segment in scene.cue.segments
        if segment.length > LONG and segment.material.E > STIFF and segment.material.rho < LIGHT
        if not max(segment.tip_bore, segment.butt_bore)
    ]
    return [("a solid rod as stiff as carbon fibre, drawn mass", scene.shaft.shaft_mass)] if solid else []


def _weighed_wood(scene: Scene) -> Iterable[tuple[str, float]]:
    """The density that a weight gives to the main material, over the usual range of that material."""
    wood = main_material(scene.shaft) if scene.cue.segments else None
    name = table_name(wood) if wood is not None and scene.shaft.weighed else None
    if wood is None or name is None:
        return []
    low, high = MATERIALS[name].ranges["rho"]
    beyond = wood.rho < (1 - AT_EASE) * low or wood.rho > (1 + AT_EASE) * high
    return [(f"by the weight of the shaft the density of its {name} is", wood.rho)] if beyond else []


def _light_cue(scene: Scene) -> Iterable[tuple[str, float]]:
    """The mass of a whole cue, unless what is drawn is itself lighter than any shaft."""
    if scene.cue.segments and scene.shaft.shaft_mass < LEAST_DRAWN:
        return []
    return [("mass of the whole cue", float(scene.cue.mass))]


TUBES = "carbon shafts are tubes; add the bore (--bore, or `cuefem guide files`)"
BODY = 'expected 400 to 700 g; add the rest of the cue with --body-mass "15 oz" (body_mass in a file)'
SHOWN = {"mm": 1e3, "g": 1e3}  # how many of the unit an SI unit is, if not one
ASKED = (
    UsualNumbers(
        lambda s: [("head-on contact time", s.known_contact_time)],
        *(*_usual(Tip, "contact_time"), "s", "expected 0.001 to 0.002 s for leather"),
    ),
    UsualNumbers(
        lambda s: [("ball radius", s.ball.radius)],
        *(*_usual(Ball, "radius"), "mm", "expected 26 to 31 mm; is this the diameter?"),
    ),
    UsualNumbers(lambda s: [("ball mass", s.ball.mass)], *_usual(Ball, "mass"), "g", "expected 140 to 210 g"),
    UsualNumbers(
        lambda s: [("stroke speed", s.stroke.speed)], *_usual(Stroke, "speed"), "m/s", "expected 0.5 to 12 m/s"
    ),
    UsualNumbers(
        lambda s: [("dome radius", s.dome_radius or None)],
        *(*_usual(TipDome, "radius"), "mm", "expected 9 to 10.6 mm, dime to nickel"),
    ),
    UsualNumbers(_of_drawing("drawn length", "length"), *CUE_LENGTH, "mm", "check the unit of the lengths", False),
    UsualNumbers(
        _diameters,
        *(
            *CUE_DIAMETER,
            "mm",
            "expected 8.5 to 14 mm at the tip; check the unit: are these radii?",
            False,
        ),
    ),
    UsualNumbers(
        _of_drawing("drawn mass", "shaft_mass"), LEAST_DRAWN, inf, "g", "check the sizes and the densities", False
    ),
    UsualNumbers(
        _weighed_wood, 0.0, 0.0, "kg/m3", "does the measured mass include a joint or the rest of the cue?", False
    ),
    UsualNumbers(_solid_tubes, 0.0, 0.0, "g", TUBES, False),
    UsualNumbers(lambda s: [("mass of the whole cue", float(s.cue.mass))], 0.0, 1.0, "kg", "expected 0.4 to 0.7 kg"),
    UsualNumbers(_light_cue, LIGHTEST, inf, "g", BODY),
)


def unusual(scene: Scene, *, blow: bool = True) -> list[str]:
    """Numbers that no cue and no blow has, one line each; empty for ordinary scenes.

    blow: whether ball, tip, stroke and the mass of the whole cue count.
    """
    asked = [usual for usual in ASKED if blow or not usual.blow]
    said = [effect.unusual_on(scene.shaft) for effect in scene.effects] if blow and scene.cue.segments else []
    beyond = [_beyond(usual, scene) for usual in asked]
    return [*filter(None, [*beyond, *said]), *_shape(scene.cue.segments)]


def _beyond(usual: UsualNumbers, scene: Scene) -> str:
    """The first number that is out of bounds, in a line."""
    for name, value in usual.of(scene):
        if value is not None and not usual.least <= value <= usual.most:
            return f"{name} {SHOWN.get(usual.unit, 1) * value:.6g} {usual.unit}; {usual.ask}"
    return ""


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
        for end, here, there in (
            ("tip", segment.tip_bore, segment.butt_bore),
            ("butt", segment.butt_bore, segment.tip_bore),
        ):
            if here == 0 < there:
                lines.append(f"the bore of segments[{i}] tapers to zero; is {end}_bore missing?")
    return lines
