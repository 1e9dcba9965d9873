"""A field of a scene by its path, as in "cue.segments[0].tip_bore": its unit, its value, and how to replace it.

"[*]" stands for every item of a list: "cue.segments[*].material.E" is the modulus of every segment's material.
"""

from __future__ import annotations

import difflib
import re
from collections.abc import Mapping
from dataclasses import fields, is_dataclass, replace
from functools import cache
from typing import Any, get_args, get_type_hints

from cuefem.cue import Material
from cuefem.quantity import Quantity, quantities
from cuefem.scene import Scene

Step = str | int
Path = tuple[Step, ...]

_STEP = re.compile(r"\.?([A-Za-z_]\w*)|\[(\d+|\*)\]")
# Fields of which a dataclass takes one at most: setting one removes the other.
_INSTEAD = {("Tip", "contact_time"): "stiffness", ("Tip", "stiffness"): "contact_time"}


def paths(scene: Scene, text: str) -> tuple[Path, ...]:
    """The fields of a scene that a path names, "[*]" spelt out; ValueError, suggesting similar names, if none matches.

    A field is a number or a whole material.
    """
    steps, start = [], 0
    while start < len(text) or not text:
        found = _STEP.match(text, start)
        if not found:
            raise ValueError(f"must be a path such as cue.segments[0].tip_bore; got {text!r}")
        steps.append(found[1] or found[2])
        start = found.end()
    ends: list[tuple[Path, Any]] = [((), scene)]
    for step in steps:
        ends = [end for path, value in ends for end in _below(path, value, step, text)]
    if not ends:
        raise ValueError(f"must name a field of the scene; got {text!r}, of an empty list")
    return tuple(_field(scene, path, text) for path, _ in ends)


def _below(path: Path, value: Any, step: str, text: str) -> list[tuple[Path, Any]]:
    """What lies one step below a value; the step is a field's name, an index or "*"."""
    here = spelt(path) or "the scene"
    if step == "*" or step.isdigit():
        if not isinstance(value, tuple):
            raise ValueError(f"must name a field of the scene; got {text!r}, where {here} is no list")
        if step == "*":
            return [((*path, i), item) for i, item in enumerate(value)]
        if int(step) >= len(value):
            raise ValueError(f"must name a field of the scene; got {text!r}, where {here} has {len(value)} items")
        return [((*path, int(step)), value[int(step)])]
    names = [field.name for field in fields(value)] if is_dataclass(value) else []
    if step in names:
        return [((*path, step), getattr(value, step))]
    if value is None:
        raise ValueError(f"must name a field of the scene; got {text!r}, where {here} is empty")
    raise ValueError(f"must name a field of the scene; got {text!r}{_meant(here, step, names)}")


def _meant(here: str, name: str, names: list[str]) -> str:
    """Words that suggest similar names, or all names."""
    if not names:
        return f", where {here} has no fields"
    close = difflib.get_close_matches(name, names, n=3, cutoff=0.5)
    return f"; did you mean {' or '.join(close)}?" if close else f", where {here} has {', '.join(names)}"


def _field(scene: Scene, path: Path, text: str) -> Path:
    """The path, checked to end at a field that can vary."""
    if quantity_at(scene, path) is None and not is_material(scene, path):
        below = value_at(scene, path)
        names = [field.name for field in fields(below)] if is_dataclass(below) else []
        hint = f", which holds {', '.join(names)}" if names else ""
        raise ValueError(f"must name one number or a material; got {text!r}{hint}")
    return path


def spelt(path: Path) -> str:
    """A path as text."""
    return "".join(f"[{step}]" if isinstance(step, int) else f".{step}" for step in path).removeprefix(".")


def value_at(scene: Scene, path: Path) -> Any:
    """What stands at a path."""
    value: Any = scene
    for step in path:
        value = value[step] if isinstance(step, int) else getattr(value, step)
    return value


def quantity_at(scene: Scene, path: Path) -> Quantity | None:
    """Unit and bounds of the number at a path; None if the field holds no number."""
    *above, last = path
    owner = value_at(scene, tuple(above))
    if not is_dataclass(owner):
        return None
    known = {name: quantity for name, quantity, *_ in quantities(_type(owner))}
    return known.get(str(last))


def is_material(scene: Scene, path: Path) -> bool:
    """Whether a whole material stands, or may stand, at a path."""
    *above, last = path
    owner = value_at(scene, tuple(above))
    return is_dataclass(owner) and Material in _kinds(_type(owner)).get(str(last), ())


def _type(owner: object) -> type:
    return type(owner)


@cache
def _kinds(kind: type) -> dict[str, tuple[Any, ...]]:
    """What each field of a dataclass may hold."""
    return {name: (hint, *get_args(hint)) for name, hint in get_type_hints(kind).items()}


def replaced(thing: Any, changes: Mapping[Path, Any]) -> Any:
    """A dataclass (or tuple) with the values at some paths replaced: all at once, then checked as when it is made.

    A whole material goes in before what changes inside it.
    """
    if () in changes:
        inside = {path: value for path, value in changes.items() if path}
        return replaced(changes[()], inside) if inside else changes[()]
    below: dict[Step, dict[Path, Any]] = {}
    for (step, *rest), value in changes.items():
        below.setdefault(step, {})[tuple(rest)] = value
    if isinstance(thing, tuple):
        return tuple(replaced(item, below[i]) if i in below else item for i, item in enumerate(thing))
    new = {str(step): replaced(getattr(thing, str(step)), inner) for step, inner in below.items()}
    others = [_INSTEAD.get((type(thing).__name__, name)) for name in new]
    return replace(thing, **{other: None for other in others if other and other not in new}, **new)
