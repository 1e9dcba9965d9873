"""Scenes with a leather tip; no tests."""

from __future__ import annotations

from cuefem import Ball, Cue, Effect, LeatherTip, Resolution, Scene, Segment, Stroke, Tip
from tests.helpers.strike_scenes import maple

POOL = Ball(0.170, 0.028575)
# 12.75 mm at the tip, 567 g with the leather's 0.6 g.
SHAFT = Cue((Segment(0.02, 0.01275, 0.01275, maple(8e9)), Segment(0.7, 0.01275, 0.0215, maple())), body_mass=0.42)
LEATHER = LeatherTip(height=6e-3, dome_radius=9.5e-3, E=140e6)
AT = Resolution(2, 10, 10)


def leather_scene(
    offset: float = 0.375,
    *effects: Effect,
    speed: float = 2.0,
    e: float = 0.73,
    friction: float = 0.7,
    leather: LeatherTip = LEATHER,
    cue: Cue = SHAFT,
) -> Scene:
    """A shaft with a leather tip that strikes a pool ball."""
    return Scene(cue, POOL, Tip(e, friction), Stroke(speed, offset), (leather, *effects))
