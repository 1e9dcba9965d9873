"""The scene that the designer opens if no file is named."""

from __future__ import annotations

from cuefem.cue import Cue, Segment
from cuefem.effects import TipDome, TipShear
from cuefem.materials import MATERIALS
from cuefem.scene import Ball, Scene, Stroke, Tip

NAME = "pool_maple.toml"


def first_scene() -> Scene:
    """A generic maple pool shaft on a pool ball: meshes/pool_maple.toml; its README has the sources.

    How such a shaft plays is told in handbook: Measured squirt.
    """
    leather, melamine, maple = (MATERIALS[name].material for name in ("leather", "melamine", "hard maple"))
    cue = Cue(
        (
            Segment(0.006, 0.01275, 0.01275, leather),
            Segment(0.025, 0.01275, 0.0128, melamine, 0.00794, 0.00794, maple),
            Segment(0.2992, 0.0128, 0.0133, maple),
            Segment(0.1, 0.0133, 0.0147, maple),
            Segment(0.3064, 0.0147, 0.0215, maple),
        ),
        body_mass=0.467,
    )
    tip = Tip(restitution=0.73, friction=0.7, contact_time=1.1e-3)
    return Scene(cue, Ball(0.170, 0.028575), tip, Stroke(2.0, 0.3), (TipDome(9.5e-3), TipShear(0.75)))
