"""Cues and strokes of several studies: the cues of meshes/, a scene without effects, the default stroke, bores."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from functools import cache
from itertools import pairwise
from math import degrees

import numpy as np

import cuefem as cf
from studies.pages import STUDIES

MESHES = STUDIES.parent / "meshes"
NAMES = ("kim", "pool_maple", "pool_hollow", "carbon", "whole_cue")
INCH, MPH = 0.0254, 0.44704
POOL = cf.Ball(mass=0.170, radius=0.028575)
# Textbook tip of the models before LeatherTip: Alciatore's dime to nickel, and Mindlin's ratio of stiffnesses.
DOME, SHEAR = cf.TipDome(9.5e-3), cf.TipShear(0.75)
# Bores of the hollow shaft, m, that the measured static stiffness of such a shaft requires (measured/squirt.py).
BORES = (7.4e-3, 8.5e-3, 10.2e-3)


@cache
def cue(name: str) -> cf.Cue:
    """A cue of meshes/."""
    result = cf.load(MESHES / f"{name}.toml")
    assert isinstance(result, cf.Cue)
    return result


def plain_maple() -> cf.Cue:
    """The maple shaft with the shear coefficient 0.9, which the independent oracle takes."""
    maple = cue("pool_maple")
    return replace(maple, segments=tuple(replace(segment, kappa=0.9) for segment in maple.segments))


@cache
def hollow(bore: float) -> cf.Cue:
    """The hollow shaft of meshes/ with another bore in front, m."""
    base = cue("pool_hollow")
    drilled = (replace(s, tip_bore=bore, butt_bore=bore) if s.tip_bore else s for s in base.segments)
    return replace(base, segments=tuple(drilled))


def wood(draw: np.random.Generator) -> cf.Material:
    """A wood drawn at random."""
    E = draw.uniform(9e9, 18e9)
    return cf.Material(E, E / draw.uniform(10, 20), draw.uniform(450, 1000))


def random_cue(draw: np.random.Generator, kind: str | None = None) -> cf.Cue:
    """A cue drawn at random: of one to four pieces, of wood or a tube of carbon, some bored, with a leather or not."""
    u = draw.uniform
    kind = kind or str(draw.choice(["none", "leather", "leather and ferrule", "ferrule"]))
    timber, tube = wood(draw), draw.random() < 0.25
    front, back, length, power, wall = u(0.010, 0.0135), u(0.019, 0.024), u(0.65, 0.8), u(1, 2.5), u(0.001, 0.002)
    carbon, foam = cf.Material(u(40e9, 130e9), 5e9, 1550.0), cf.Material(7e7, 2.5e7, 60.0)
    leather, plastic = cf.Material(u(5e7, 4e8), 4e7, 1000.0), cf.Material(u(2e9, 10e9), 2e9, 1200.0)
    front_pieces = [cf.Segment(u(0.003, 0.012), front, front, leather)] if "leather" in kind else []
    if "ferrule" in kind:
        front_pieces.append(cf.Segment(u(0.005, 0.03), front, front, plastic, 0.55 * front, 0.55 * front, core=timber))
    ends = np.r_[0, np.sort(u(0.1, 0.9, draw.integers(0, 4))), 1]
    depth = u(0.3, 0.65) * front if draw.random() < 0.3 else 0.0  # of a bore, as wide, in the first piece
    shaft = []
    for i, (first, last) in enumerate(pairwise(ends)):
        a, b = (front + (back - front) * x**power for x in (first, last))
        bores = (a - 2 * wall, b - 2 * wall, foam) if tube else (depth, depth, None) if i == 0 else (0.0, 0.0, None)
        shaft.append(cf.Segment(length * (last - first), a, b, carbon if tube else timber, *bores))
    return cf.Cue((*front_pieces, *shaft), u(0.3, 0.5))


def scene(struck: cf.Cue | cf.LumpedCue, contact_time: float = 1e-3, offset: float = 0.0) -> cf.Scene:
    """The cue before the default ball (210 g), e = 3/4, mu = 0.7, no effects."""
    return cf.Scene(struck, tip=cf.Tip(contact_time=contact_time), stroke=cf.Stroke(offset=offset))


def pool_scene(struck: cf.Cue, contact_time: float, offset: float, effects: Sequence[cf.Effect] = ()) -> cf.Scene:
    """The cue before a pool ball (170 g), with a spring as its tip, e = 0.73, mu = 0.7."""
    return cf.Scene(struck, POOL, cf.Tip(0.73, 0.7, contact_time), cf.Stroke(2.0, offset), tuple(effects))


def full_model(shaft: cf.Cue, offset: float = 0.375, speed: float = 2.0, **leather: float) -> cf.Scene:
    """Pool's default stroke: LeatherTip, axial waves, axial force on the bent shaft. leather: fields of the tip."""
    base = cf.usual_scene(shaft)
    effects = tuple(replace(e, **leather) if isinstance(e, cf.LeatherTip) else e for e in base.effects)
    return replace(base, stroke=cf.Stroke(speed, offset), effects=effects)


def drawn_stroke(draw: np.random.Generator, shaft: cf.Cue | None = None) -> cf.Scene:
    """Pool's default stroke of a shaft, or of one drawn at random, with speed, offset and leather drawn at random."""
    u = draw.uniform
    struck = shaft or random_cue(draw, str(draw.choice(["none", "ferrule"])))
    leather = {"E": 80e6 * (300 / 80) ** draw.random(), "height": u(4e-3, 8e-3), "dome_radius": u(8.95e-3, 10.6e-3)}
    return full_model(struck, u(0.2, 0.4), u(1.0, 4.0), **leather)


def pool_stroke(struck: cf.Scene) -> cf.Scene:
    """The scene, if its cue has a drawing and strikes a lighter ball of pool; ValueError otherwise."""
    if struck.lumped is not None:
        raise ValueError("cue is a LumpedCue, without waves; this study needs a drawing of its shaft")
    if not 0.027 <= struck.ball.radius <= 0.030:
        size = f"{2e3 * struck.ball.radius:g} mm"
        raise ValueError(f"ball.radius is of another game ({size} wide); this study needs a ball of pool, 54 to 60 mm")
    if struck.ball.mass >= struck.cue.mass:
        masses = f"{1e3 * struck.ball.mass:g} g, the cue {1e3 * struck.cue.mass:g} g"
        raise ValueError(f"ball.mass must be less than the mass of the cue; the ball has {masses}")
    return struck


def own_stroke(path: str) -> cf.Scene:
    """The stroke of a file, or pool's default stroke of its cue; ValueError unless it is a `pool_stroke`."""
    loaded = cf.load(path)
    return pool_stroke(loaded if isinstance(loaded, cf.Scene) else cf.usual_scene(loaded))


def with_tip(struck: cf.Scene, E: float, restitution: float) -> cf.Scene:
    """The scene with another modulus, Pa, and restitution of its leather tip."""
    effects = tuple(replace(e, E=E) if isinstance(e, cf.LeatherTip) else e for e in struck.effects)
    return replace(struck, tip=replace(struck.tip, restitution=restitution), effects=effects)


@cache
def robot_speeds() -> tuple[float, float]:
    """Cue speeds of the robot's strokes (Billiards Digest, February 2008), m/s.

    It timed the ball, 3.6 to 7.8 mph between two beams; at b/R 0.375 the ball is faster than the cue was.
    """
    ratio = float(cf.strike(full_model(cue("pool_maple"))).ball_speed) / 2.0
    return 3.6 * MPH / ratio, 7.8 * MPH / ratio


@cache
def squirt(struck: cf.Scene) -> float:
    """Squirt of the coupled strike, degrees."""
    return degrees(cf.strike(struck).squirt)


def lumped_squirt(struck: cf.Scene, end_mass: float) -> float:
    """Squirt of the impulse solver with this end mass at the scene's offset, rad."""
    return float(cf.impulse(replace(struck, cue=cf.LumpedCue(struck.axial_mass, end_mass), effects=())).squirt)


def at_offset(struck: cf.Scene, offset: float) -> cf.Scene:
    """The scene struck at another offset."""
    return replace(struck, stroke=replace(struck.stroke, offset=offset))
