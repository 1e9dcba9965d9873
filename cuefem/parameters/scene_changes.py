"""Scenes with other values of some parameters."""

from __future__ import annotations

from collections.abc import Container, Mapping
from dataclasses import dataclass
from typing import Any

from cuefem.cue import Cue, LumpedCue
from cuefem.cue.materials import material as named_material
from cuefem.parameters.field_paths import Path, Step, with_fields
from cuefem.parameters.parts import BORE_DEPTH, PARTS, Part
from cuefem.parameters.scene_paths import SCENE_FIELDS, is_material, parameter, part_at, paths
from cuefem.parameters.table import PARAMETERS
from cuefem.scene import Scene, check_scene


@dataclass(frozen=True)
class _Draft:
    """A scene under construction, without checks."""

    cue: Cue | LumpedCue
    ball: Any
    tip: Any
    stroke: Any
    effects: tuple[Any, ...]

    @property
    def shaft(self) -> Any:
        """The cue; only scenes with a cue of segments have parts."""
        return self.cue


def with_parameters(scene: Scene, changes: Mapping[str, Any]) -> Scene:
    """A scene with other values of some parameters, changed together and then checked.

    Parameters
    ----------
    scene : Scene
        The original scene.
    changes : mapping
        SI numbers, materials, or names of materials and leathers, by parameter name ("bore width"; `cuefem guide study`
        lists them) or path ("cue.segments[0].tip_bore").

    Returns
    -------
    Scene
        With these values; dependent values change with them.

    Raises
    ------
    ValueError
        If this scene has no such parameter, or the new scene is invalid.

    Examples
    --------
    >>> import cuefem as cf
    >>> scene = cf.usual_scene(cf.Cue((cf.Segment(0.7, 0.012, 0.021, cf.material("hard maple")),)))
    >>> changed = cf.with_parameters(scene, {"shaft material": "ash", "bore depth": 0.1, "speed": 3.0})
    >>> [segment.length for segment in changed.cue.segments], changed.cue.segments[0].tip_bore, changed.stroke.speed
    ([0.1, 0.6], 0.006, 3.0)
    """
    check_scene("with_parameters scene", scene)
    values = dict[Path, Any]()
    for text, value in changes.items():
        entry = parameter(text)
        by_name: dict[Path, Any] = entry.named_value(value) if entry and isinstance(value, str) else {}
        for path in paths(scene, text):
            is_name = is_material(scene, path) and isinstance(value, str)
            values |= by_name if by_name else {path: named_material(value) if is_name else value}
    return with_values_at(scene, values)


def with_values_at(scene: Scene, changes: Mapping[Path, Any]) -> Scene:
    """A scene with the values at some paths replaced, changed together and then checked.

    Fields of the scene are written first, then parts of the drawing in the order of `PARAMETERS`.
    """
    below: dict[str, dict[Path, Any]] = {}
    for (head, *rest), value in changes.items():
        below.setdefault(str(head), {})[tuple(rest)] = value
    draft = _Draft(**{name: getattr(scene, name) for name in SCENE_FIELDS})
    draft = with_fields(draft, {path: value for path, value in changes.items() if path[0] in SCENE_FIELDS})
    heads = (*(entry.name for entry in PARAMETERS.values()), *PARTS, *below)
    parts = {head: part for head in heads if (part := part_at(head))}  # in writing order
    for head, inner in below.items():
        if head in parts and () in inner:
            _check_part(head, parts[head], inner[()])
    values = {
        head: with_fields(None if () in inner else parts[head].read(draft), inner)
        for head, inner in below.items()
        if head in parts
    }
    check_bore(draft, values)
    unchanged = {name for head in values for name in parts[head].unchanged} - {*values}
    values |= {name: parts[name].read(draft) for name in unchanged}
    for head, part in parts.items():
        if values.get(head) is not None:
            draft = part.write(draft, values[head])
    return Scene(**{name: getattr(draft, name) for name in SCENE_FIELDS}, assumed=scene.assumed)


def _check_part(name: str, part: Part, value: Any) -> None:
    """TypeError or ValueError for a number of a part that is none, or out of its bounds."""
    if part.quantity is not None:
        part.quantity.check(name, value)


def check_bore(scene: Any, names: Container[Step]) -> None:
    """ValueError if the width of a bore changes in a cue without one: "bore width" is then that of a new bore."""
    if "bore width" in names and "bore depth" not in names and BORE_DEPTH.read(scene) == 0:
        raise ValueError("bore width has no effect: the cue has no bore; change bore depth too, or draw a bore")
