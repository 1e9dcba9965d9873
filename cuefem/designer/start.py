"""The scene that the designer opens if no file is named."""

from __future__ import annotations

from cuefem.cue import Cue, Segment
from cuefem.cue.materials import MATERIALS
from cuefem.scene import Scene
from cuefem.scene.default_scene import usual_scene

NAME = "pool_maple.toml"


def first_cue() -> Cue:
    """A generic maple pool shaft: meshes/pool_maple.toml; its README has the sources."""
    leather, melamine, maple = (MATERIALS[name].material for name in ("leather", "melamine", "hard maple"))
    return Cue(
        (
            Segment(0.006, 0.01275, 0.01275, leather),
            Segment(0.025, 0.01275, 0.0128, melamine, 0.00794, 0.00794, maple),
            Segment(0.2992, 0.0128, 0.0133, maple),
            Segment(0.1, 0.0133, 0.0147, maple),
            Segment(0.3064, 0.0147, 0.0215, maple),
        ),
        body_mass=0.467,
    )


def first_scene() -> Scene:
    """A usual stroke of pool with that shaft, as the commands give it to the drawing of a cue alone.

    How such a shaft plays is told in handbook: Measured squirt.
    """
    return usual_scene(first_cue())
