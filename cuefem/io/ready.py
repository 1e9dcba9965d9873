"""The reference cues and scenes: what each is, and what was measured on such cues."""

from __future__ import annotations

import math
from functools import cache
from pathlib import Path
from typing import Any, NamedTuple

from cuefem.cue import Cue
from cuefem.io import load
from cuefem.io.shelf import folder
from cuefem.results.solved_design import strikes_at
from cuefem.scene import Scene
from cuefem.scene.default_scene import usual_scene
from cuefem.tip_modes import Solved

_NOT = "no measurement known"
_PLAIN = "2.30 and 2.43° at b/R 0.375, 2.5° at b/R 0.453 (Players, 12.75 mm; Billiards Digest 2007, 2008)"
_LOW = "1.8° at b/R 0.453 (Predator Z, 11.85 mm; Billiards Digest 2007)"
_BREAK = "2.4° at b/R 0.267 (Stinger, 13.5 mm; Alciatore, TP B.1)"
_KIM = "a tone near 250 Hz and 120 g (Kim 2022); no squirt"
_CLAY = "squirt with masses on a Players shaft (Billiards Digest 2008)"


# The squirt of these, in degrees by offset; a mean where it was measured twice.
STROKES = {_PLAIN: {0.375: 2.365, 0.453: 2.5}, _LOW: {0.453: 1.8}, _BREAK: {0.267: 2.4}}


def _more(difference: float) -> str:
    return f"{abs(difference):.2f}° {'more' if difference > 0 else 'less'}"


class Preset(NamedTuple):
    """A ready file: its path from the folder of `meshes`, its name, its game, and what was measured on such cues."""

    file: str
    name: str
    game: str
    measured: str

    def beside(self, scene: Scene) -> str:
        """What was measured, and what this scene gives at the same offsets, with the difference."""
        strokes = STROKES.get(self.measured, {})
        if not strokes:
            return self.told
        struck = strikes_at(scene, strokes, Solved(scene).tip)
        texts = (
            f"{math.degrees(stroke.squirt):.2f}° at b/R {offset:g}, {_more(math.degrees(stroke.squirt) - measured)}"
            for (offset, measured), stroke in zip(strokes.items(), struck, strict=True)
        )
        return f"{self.told}; computed for this cue: {'; '.join(texts)}"

    @property
    def told(self) -> str:
        """What was measured, as a sentence that says of what."""
        return self.measured if self.measured == _NOT else f"measured on such cues: {self.measured}"


PRESETS = (
    Preset("meshes/pool_maple.toml", "Pool: plain maple shaft", "pool", _PLAIN),
    Preset("meshes/pool_hollow.toml", "Pool: low-deflection shaft, hollow front", "pool", _LOW),
    Preset("meshes/carbon.toml", "Pool: carbon-fibre shaft", "pool", _NOT),
    Preset("meshes/whole_cue.toml", "Pool: a whole cue of two pieces", "pool", _PLAIN),
    Preset("meshes/kim.toml", "Carom: the shaft of Kim's paper", "carom", _KIM),
    Preset("studies/scenes/kim.toml", "Carom: Kim's shaft, bare, 2 ms", "carom", _KIM),
    Preset("studies/scenes/pool_low_deflection.toml", "Pool: low-deflection shaft on a bridge", "pool", _LOW),
    Preset("studies/scenes/carom.toml", "Carom: stiff conical shaft", "carom", _NOT),
    Preset("studies/scenes/break_cue.toml", "Pool: a break at 25 mph, phenolic tip", "pool", _BREAK),
    Preset("studies/scenes/snooker.toml", "Snooker: thin ash shaft, brass ferrule", "snooker", _NOT),
    Preset(
        "studies/scenes/clay_on_shaft.toml",
        "Pool: 11 g of clay on the shaft",
        "pool",
        _CLAY,
    ),
)

# By what they are called in a sentence: the first is what the others, and a person's own cue, are compared with.
SCALE = {
    "plain maple": "meshes/pool_maple.toml",
    "low deflection": "meshes/pool_hollow.toml",
    "carbon": "meshes/carbon.toml",
}


def opened(preset: Preset) -> Scene:
    """The scene of a ready file."""
    scene: Any = load(folder() / preset.file)
    return usual_scene(scene, preset.game) if isinstance(scene, Cue) else scene


@cache
def ready_cues() -> dict[str, Cue]:
    """The reference cues among which a verdict places a cue, from the most squirt to less."""
    cues: dict[str, Any] = {name: load(folder() / file) for name, file in SCALE.items()}
    return cues


def ready_cue(name: str) -> bytes | None:
    """The content of a reference cue file of this name."""
    path = folder() / "meshes" / Path(name).name
    known = {Path(preset.file).name for preset in PRESETS if preset.file.startswith("meshes/")}
    return path.read_bytes() if Path(name).name in known and path.is_file() else None
