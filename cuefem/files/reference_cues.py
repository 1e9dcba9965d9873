"""The reference cues and scenes."""

from __future__ import annotations

from functools import cache
from pathlib import Path
from typing import Any

from cuefem.cue import Cue, LumpedCue
from cuefem.files import load
from cuefem.files.cue_names import CUES, REFERENCES
from cuefem.files.parts_catalogue import data_folder
from cuefem.scene import Scene
from cuefem.scene.default_scene import stroke_name, usual_scene


def named_scene(name: str) -> Scene:
    """The scene of a name, or the usual one of its cue and game."""
    scene: Any = load(data_folder() / CUES[name].file)
    return usual_scene(scene, stroke_name(CUES[name].game)) if isinstance(scene, Cue) else scene


def inside_mark(name: str, scene: Scene) -> str:
    """A dagger for the cue of a name whose inside is assumed, also with another ferrule, bore or tip.

    "" for others, as for a maker's own file of that name, which has no segment of the cue.
    """
    mark = CUES[name].mark if name in CUES else ""
    return mark if mark and _outlines(scene.cue) & _outlines(named_scene(name).cue) else ""


def _outlines(cue: Cue | LumpedCue) -> set[tuple[float, ...]]:
    """Length, diameters and bores of each segment."""
    return {(s.length, s.tip_diameter, s.butt_diameter, s.tip_bore, s.butt_bore) for s in cue.segments}


@cache
def reference_cues() -> dict[str, Cue]:
    """The reference cues of a verdict, in order of decreasing squirt."""
    cues: dict[str, Any] = {name: load(data_folder() / CUES[name].file) for name in REFERENCES}
    return cues


def reference_cue_file(name: str) -> bytes | None:
    """The content of the reference cue file of this name; None for another name."""
    path = data_folder() / "meshes" / Path(name).name
    known = {Path(cue.file).name for cue in CUES.values() if cue.file.startswith("meshes/")}
    return path.read_bytes() if Path(name).name in known and path.is_file() else None
