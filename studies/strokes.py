"""Cues and strokes that studies share: the cues of meshes/, a bare scene, the whole stroke, a hollow shaft's bore."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from functools import cache
from math import degrees

import cuefem as cf
from studies.pages import STUDIES

MESHES = STUDIES.parent / "meshes"
NAMES = ("kim", "pool_maple", "pool_hollow", "carbon", "whole_cue")
INCH = 0.0254
POOL = cf.Ball(mass=0.170, radius=0.028575)
# Textbook tip of the models before LeatherTip: Alciatore's dime to nickel, and Mindlin's ratio of stiffnesses.
DOME, SHEAR = cf.TipDome(9.5e-3), cf.TipShear(0.75)
# Bores of the hollow shaft, m, that the measured static stiffness of such a shaft asks for (measured/squirt.py).
BORES = (7.4e-3, 8.5e-3, 10.2e-3)


@cache
def cue(name: str) -> cf.Cue:
    """A cue of meshes/."""
    drawn = cf.load(MESHES / f"{name}.toml")
    assert isinstance(drawn, cf.Cue)
    return drawn


@cache
def hollow(bore: float) -> cf.Cue:
    """The hollow shaft of meshes/ with another bore in front, m."""
    found = cue("pool_hollow")
    drilled = (replace(s, tip_bore=bore, butt_bore=bore) if s.tip_bore else s for s in found.segments)
    return replace(found, segments=tuple(drilled))


def scene(struck: cf.Cue | cf.LumpedCue, contact_time: float = 1e-3, offset: float = 0.0) -> cf.Scene:
    """The cue before the default ball (210 g), e = 3/4, mu = 0.7, no effects."""
    return cf.Scene(struck, tip=cf.Tip(contact_time=contact_time), stroke=cf.Stroke(offset=offset))


def pool_scene(struck: cf.Cue, contact_time: float, offset: float, effects: Sequence[cf.Effect] = ()) -> cf.Scene:
    """The cue before a pool ball (170 g), with a spring as its tip, e = 0.73, mu = 0.7."""
    return cf.Scene(struck, POOL, cf.Tip(0.73, 0.7, contact_time), cf.Stroke(2.0, offset), tuple(effects))


def whole(drawn: cf.Cue, offset: float = 0.375, speed: float = 2.0, **leather: float) -> cf.Scene:
    """Pool's usual stroke: LeatherTip, axial waves, axial force on the bent shaft. leather: fields of the tip."""
    usual = cf.usual_scene(drawn)
    effects = tuple(replace(e, **leather) if isinstance(e, cf.LeatherTip) else e for e in usual.effects)
    return replace(usual, stroke=cf.Stroke(speed, offset), effects=effects)


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
