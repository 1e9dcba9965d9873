"""What the knobs of the designer reach: of each parameter the slider's range and what may be typed."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any, NamedTuple

from cuefem.cue import Cue
from cuefem.parameters.parameter import PARAMETERS, varied
from cuefem.parameters.parts import deepest_bore
from cuefem.scene import Scene


class Range(NamedTuple):
    """What a slider reaches from ``low`` to ``high`` in steps, and what may be typed, from ``least`` to ``most``.

    All in a unit that people read; ``scale`` is one SI unit in it.
    """

    unit: str
    scale: float
    low: float
    high: float
    step: float
    least: float
    most: float


def _mm(low: float, high: float, step: float, least: float, most: float) -> Range:
    return Range("mm", 1e3, low, high, step, least, most)


RANGES: dict[str, Range | Callable[[Cue], Range]] = {
    "tip_diameter": _mm(8, 15, 0.05, 4, 30),
    "taper_diameter": _mm(8, 20, 0.05, 4, 60),
    "butt_diameter": _mm(12, 34, 0.1, 4, 60),
    "bore_depth": lambda cue: _mm(0, round(min(300.0, 1e3 * deepest_bore(cue)), 1), 1, 0, 1e3 * deepest_bore(cue)),
    "bore_width": _mm(1, 11, 0.1, 0.1, 30),
    "ferrule_length": _mm(2, 40, 0.5, 0.5, 60),
    "leather": Range("MPa", 1e-6, 20, 500, 5, 1, 20_000),
    "tip_height": _mm(2, 12, 0.1, 0.5, 40),
    "dome": _mm(6, 20, 0.1, 3, 500),
    "contact_time": Range("ms", 1e3, 0.6, 3, 0.01, 0.2, 20),
    "restitution": Range("", 1.0, 0.5, 0.95, 0.01, 0, 1),
    "friction": Range("", 1.0, 0.2, 1.2, 0.01, 0.01, 10),
    "speed": Range("m/s", 1.0, 0.3, 12, 0.1, 0.01, 40),
    "offset": Range("", 1.0, 0, 0.9, 0.01, -0.95, 0.95),
    "body_mass": Range("g", 1e3, 0, 700, 5, 0, 5000),
}


def reach(key: str, cue: Cue) -> Range:
    """The range of a parameter's slider on a cue."""
    known = RANGES[key]
    return known(cue) if callable(known) else known


def knobs_of(scene: Scene) -> dict[str, Any]:
    """The values of all parameters that have a knob, by their keys; ValueError for a lumped cue, which has no shape."""
    _ = scene.shaft
    values = {key: known.value(scene) for key, known in PARAMETERS.items() if key in RANGES or known.materials}
    return {key: value for key, value in values.items() if value is not None}


def turned(scene: Scene, knobs: Mapping[str, Any]) -> Scene:
    """The scene with its knobs turned, or the scene itself if none was. ValueError if no such cue can be made."""
    own = knobs_of(scene)
    changes = {key: value for key, value in knobs.items() if value != own[key]}
    return varied(scene, changes) if changes else scene
