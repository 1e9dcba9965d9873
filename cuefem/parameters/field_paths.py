"""Paths to the fields of a scene: "tip.friction", "cue.segments[0].tip_bore", or "wood.E" inside a part of the drawing.

A path leads through fields; "[*]" means every item of a list. It may begin at a part (`cuefem.parameters.parts.PARTS`).
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import fields, is_dataclass, replace
from functools import cache
from typing import Any, get_args, get_type_hints

from cuefem.parameters.parts import PARTS

Step = str | int
Path = tuple[Step, ...]

_STEP = r"\.?([A-Za-z_]\w*)|\[(\d+|\*)\]"


def is_path(text: str) -> bool:
    """Whether a text is written as a path."""
    return re.fullmatch(f"(?:{_STEP})+", text) is not None


def steps(path: str) -> Path:
    """The steps of a path: names of fields, and indices of lists or "*"; "segments" alone are those of the cue."""
    found = re.findall(_STEP, path)
    read = tuple(name or (index if index == "*" else int(index)) for name, index in found)
    return ("cue", *read) if read[0] == "segments" else read


def path_text(path: Path) -> str:
    """A path as text."""
    return "".join(f"[{step}]" if isinstance(step, int) else f".{step}" for step in path).removeprefix(".")


def items(value: Any) -> dict[Step, Any]:
    """The items or fields of a value, by index or name."""
    if isinstance(value, tuple):
        return dict(enumerate(value))
    if not is_dataclass(value):
        return {}
    return {field.name: getattr(value, field.name) for field in fields(value) if field.compare}


def field_value(scene: Any, path: Path) -> Any:
    """The value at a path of fields or of a part of `PARTS`; None if the scene has no such part."""
    part = PARTS.get(str(path[0])) if path else None
    return value_inside(part.read(scene), path[1:]) if part else value_inside(scene, path)


def value_inside(value: Any, path: Path) -> Any:
    """The value at a path of fields and indices inside a value; None inside None."""
    for step in path:
        value = None if value is None else value[step] if isinstance(step, int) else getattr(value, step)
    return value


@cache
def kinds(owner: type) -> dict[str, tuple[Any, ...]]:
    """The types of each field of a dataclass."""
    return {name: (hint, *get_args(hint)) for name, hint in get_type_hints(owner).items()}


def with_fields(instance: Any, changes: Mapping[Path, Any]) -> Any:
    """A dataclass (or tuple) with the values at some paths replaced, changed together and then checked.

    A material is replaced before its own fields.
    """
    if () in changes:
        own_fields = {path: value for path, value in changes.items() if path}
        return with_fields(changes[()], own_fields) if own_fields else changes[()]
    below: dict[Step, dict[Path, Any]] = {}
    for (step, *rest), value in changes.items():
        below.setdefault(step, {})[tuple(rest)] = value
    if isinstance(instance, tuple):
        return tuple(with_fields(item, below[i]) if i in below else item for i, item in enumerate(instance))
    new = {str(step): with_fields(getattr(instance, str(step)), inner) for step, inner in below.items()}
    return replace(instance, **new)
