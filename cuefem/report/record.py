"""Records of what a result is for: the cue and the scene."""

from __future__ import annotations

from dataclasses import asdict

from cuefem.cue import Cue, LumpedCue
from cuefem.results.records import Record
from cuefem.scene import Scene


def cue_record(cue: Cue | LumpedCue) -> Record:
    """What a cue is, in a few numbers."""
    if not cue.segments:
        return {name: getattr(cue, name) for name in ("mass", "end_mass", "coupling")}
    names = ("length", "mass", "shaft_mass", "body_mass", "balance_point")
    return {name: getattr(cue, name) for name in names} | {"segments": len(cue.segments)}


def scene_record(scene: Scene) -> Record:
    """The scene that a result is for: cue, ball, tip, stroke and effects."""
    return {
        "cue": cue_record(scene.cue),
        "ball": asdict(scene.ball),
        "tip": {name: value for name, value in asdict(scene.tip).items() if value is not None}
        | {"contact_time": scene.known_contact_time},
        "stroke": asdict(scene.stroke),
        "effects": [{"type": type(effect).__name__, **asdict(effect)} for effect in scene.effects],
        "effects_at_tip": [type(effect).__name__ for effect in scene.at_tip],
    }
