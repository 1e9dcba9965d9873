"""The reference cues and scenes."""

from __future__ import annotations

from functools import cache
from pathlib import Path
from typing import Any, NamedTuple

from cuefem.cue import Cue
from cuefem.files import load
from cuefem.files.cue_names import CUES
from cuefem.files.parts_catalogue import data_folder
from cuefem.scene import Scene
from cuefem.scene.default_scene import usual_scene


class Preset(NamedTuple):
    """An example file: its path from the data folder, its name, its game."""

    file: str
    name: str
    game: str


PRESETS = (
    Preset("meshes/pool_maple.toml", "Pool: plain maple shaft", "pool"),
    Preset("meshes/pool_hollow.toml", "Pool: low-deflection shaft, hollow front", "pool"),
    Preset("meshes/carbon.toml", "Pool: carbon-fibre shaft", "pool"),
    Preset("meshes/whole_cue.toml", "Pool: a whole cue of two pieces", "pool"),
    Preset("meshes/kim.toml", "Carom: the shaft of Kim's paper", "carom"),
    Preset("studies/scenes/kim.toml", "Carom: Kim's shaft, bare, 2 ms", "carom"),
    Preset("studies/scenes/pool_low_deflection.toml", "Pool: low-deflection shaft on a bridge", "pool"),
    Preset("studies/scenes/carom.toml", "Carom: stiff conical shaft", "carom"),
    Preset("studies/scenes/break_cue.toml", "Pool: a break at 25 mph, phenolic tip", "pool"),
    Preset("studies/scenes/snooker.toml", "Snooker: thin ash shaft, brass ferrule", "snooker"),
    Preset("studies/scenes/clay_on_shaft.toml", "Pool: 11 g of clay on the shaft", "pool"),
)

# By their names in sentences; other cues are compared with the first.
REFERENCE_FILES = {name: CUES[name].file for name in ("plain maple", "low deflection", "carbon")}


def preset_scene(preset: Preset) -> Scene:
    """The scene of an example file."""
    scene: Any = load(data_folder() / preset.file)
    return usual_scene(scene, preset.game) if isinstance(scene, Cue) else scene


@cache
def reference_cues() -> dict[str, Cue]:
    """The reference cues of a verdict, in order of decreasing squirt."""
    cues: dict[str, Any] = {name: load(data_folder() / file) for name, file in REFERENCE_FILES.items()}
    return cues


def reference_cue_file(name: str) -> bytes | None:
    """The content of the reference cue file of this name; None for another name."""
    path = data_folder() / "meshes" / Path(name).name
    known = {Path(preset.file).name for preset in PRESETS if preset.file.startswith("meshes/")}
    return path.read_bytes() if Path(name).name in known and path.is_file() else None
