"""The cues and strokes that studies share: the cues of meshes/ before one ball, and strikes by modes solved once."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

from cuefem import Cue, LumpedCue, Scene, Stroke, Tip, impulse, load
from cuefem.contact.strike import strike_modes
from studies.pages import STUDIES

__all__ = ["CAROM", "INCH", "MESHES", "NAMES", "at_offset", "cue", "lumped_squirt", "scene", "strike_modes"]

MESHES = STUDIES.parent / "meshes"
NAMES = ("kim", "pool_maple", "pool_hollow", "carbon", "whole_cue")
INCH = 0.0254
# What pages say that strike before the ball of `scene`.
CAROM = (
    "Struck before a carom ball of 210 g, as Kim's shaft is; the commands take a pool ball of 170 g where a file names "
    "none."
)


@cache
def cue(name: str) -> Cue:
    """A cue of meshes/."""
    drawn = load(MESHES / f"{name}.toml")
    assert isinstance(drawn, Cue)
    return drawn


def scene(struck: Cue | LumpedCue, contact_time: float = 1e-3, offset: float = 0.0) -> Scene:
    """The cue before the default ball (210 g), e = 3/4, mu = 0.7."""
    return Scene(struck, tip=Tip(contact_time=contact_time), stroke=Stroke(offset=offset))


def at_offset(struck: Scene, offset: float) -> Scene:
    """The scene struck at another offset."""
    return replace(struck, stroke=replace(struck.stroke, offset=offset))


def lumped_squirt(struck: Scene, end_mass: float) -> float:
    """Squirt of the impulse solver with this end mass at the scene's offset, rad."""
    return float(impulse(replace(struck, cue=LumpedCue(struck.axial_mass, end_mass), effects=())).squirt)
