"""Records: results as dictionaries of SI numbers, texts and lists that JSON can hold (no NaN, no infinity)."""

from __future__ import annotations

import math
from dataclasses import asdict
from typing import Any

import numpy as np

from cuefem.cue import Cue, LumpedCue
from cuefem.scene import Scene

Record = dict[str, Any]


def plain(value: Any) -> Any:
    """A value as JSON can hold it: arrays become lists, infinite and undefined numbers become null."""
    if isinstance(value, dict):
        return {str(key): plain(inner) for key, inner in value.items()}
    if isinstance(value, np.ndarray | np.generic):
        return plain(value.tolist())
    if isinstance(value, list | tuple):
        return [plain(inner) for inner in value]
    if isinstance(value, float) and not math.isfinite(value):
        return None
    return value


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
