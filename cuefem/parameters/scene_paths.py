"""Names and paths of parameters in a scene: "ferrule length", "cue.segments[0].tip_bore"."""

from __future__ import annotations

import re
from dataclasses import fields, is_dataclass
from typing import Any

from cuefem.cue import Material
from cuefem.parameters.field_paths import Path, Step, is_path, items, kinds, path_text, steps, value_inside
from cuefem.parameters.parameter import Parameter
from cuefem.parameters.parts import PARTS, Part, diameter_at
from cuefem.parameters.table import PARAMETERS
from cuefem.quantity.fields import Quantity, field_quantity, suggestion
from cuefem.quantity.units import parse_number
from cuefem.scene import Scene

SCENE_FIELDS = tuple(field.name for field in fields(Scene) if field.compare)

_TAPER = re.compile(r"taper at (.+)")


def parameter(text: str) -> Parameter | None:
    """The parameter of a name; None if the text is a path. ValueError for "taper at" without a position."""
    taper = _TAPER.fullmatch(text.strip())
    if taper:
        try:
            position = parse_number(taper[1], "m")
        except ValueError:
            raise ValueError(f'must name a position such as "taper at 330 mm"; got {text!r}') from None
        return Parameter(text.strip(), f"diameter {taper[1]} from the front", part=diameter_at(lambda cue: position))
    return PARAMETERS.get(re.sub(r"[\s._]+", "_", text.strip()))


def part_at(step: Step) -> Part | None:
    """The part at which a path begins; None if it begins at a field of scenes."""
    if step in PARTS or step in SCENE_FIELDS:
        return PARTS.get(str(step))
    entry = parameter(str(step))
    return entry.part if entry else None


def paths(scene: Scene, text: str) -> tuple[Path, ...]:
    """The paths of a name or a path in a scene, "[*]" expanded; ValueError, with similar names, if it is unknown.

    Each leads to a number or a material.
    """
    entry = parameter(text)
    if entry is not None and value_at(scene, entry.steps()) is None and quantity_at(scene, entry.steps()) is None:
        raise ValueError(f"must name a parameter of the scene; got {text!r}, which this scene does not have")
    if entry is None and not is_path(text):
        hint = suggestion(text, [entry.name for entry in PARAMETERS.values()])
        hint = hint or '; write a name such as "bore width" or a path such as cue.segments[0].tip_bore'
        raise ValueError(f"unknown parameter {text!r}{hint}")
    ends: list[tuple[Path, Any]] = [((), scene)]
    for step in entry.steps() if entry else steps(text):
        ends = [end for path, value in ends for end in _below(path, value, step, text)]
    expanded = tuple(path for path, _ in ends)
    if not expanded or any(quantity_at(scene, path) is None and not is_material(scene, path) for path in expanded):
        contents = ", which holds " + ", ".join(map(str, items(ends[0][1]))) if ends and items(ends[0][1]) else ""
        raise ValueError(f"must name one number or a material; got {text!r}{contents}")
    return expanded


def _below(path: Path, value: Any, step: Step, text: str) -> list[tuple[Path, Any]]:
    """The paths and values one step below a value; the step is a field's name, an index or "*"."""
    inner = items(value)
    if step == "*" and isinstance(value, tuple):
        return [((*path, i), item) for i, item in inner.items()]
    if step in inner:
        return [((*path, step), inner[step])]
    if not path and (part := part_at(step)):
        return [((step,), part.read(value))]
    owner, names = path_text(path) or "the scene", [name for name in inner if isinstance(name, str)]
    valid = names if path else [*names, *(entry.name for entry in PARAMETERS.values()), *PARTS]
    contents = ", ".join(names) if names else f"{len(inner)} items"
    hint = suggestion(str(step), valid) or f", where {owner} has {contents}"
    raise ValueError(f"must name a field of the scene; got {text!r}{hint}")


def value_at(scene: Any, path: Path) -> Any:
    """The value at a path, which may begin at the name of a parameter; None if the scene has no such part."""
    if not path:
        return scene
    part = part_at(path[0])
    return value_inside(part.read(scene), path[1:]) if part else value_inside(scene, path)


def quantity_at(scene: Scene, path: Path) -> Quantity | None:
    """Unit and bounds of the number at a path; None if it is no number."""
    part = part_at(path[0]) if len(path) == 1 else None
    return part.number(scene) if part else field_quantity(value_at(scene, path[:-1]), path[-1])


def is_material(scene: Scene, path: Path) -> bool:
    """Whether the value at a path is, or may be, a material."""
    owner: Any = value_at(scene, path[:-1])
    if len(path) == 1 or not is_dataclass(owner):
        return isinstance(value_at(scene, path), Material)
    return Material in kinds(type(owner)).get(str(path[-1]), ())  # type: ignore[arg-type]
