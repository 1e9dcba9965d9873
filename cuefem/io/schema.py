"""The dataclasses as the schema of the files: tables are read into them and made of them."""

from __future__ import annotations

import functools
import re
import types
import typing
from dataclasses import MISSING, fields, is_dataclass
from typing import Any, TypeVar, cast

from cuefem.cue import Material
from cuefem.cue.materials import MATERIALS
from cuefem.effects import Effect
from cuefem.io.errors import InputError, faults_of, nearest, shown
from cuefem.quantity.fields import OutOfBounds, Quantity

Kind = TypeVar("Kind")

NAMES = {known.material: name for name, known in MATERIALS.items()}
ABSENT = ("tip_bore", "butt_bore", "weighed")  # not written if 0 or false, their default


def build(kind: type[Kind], table: Any, *, file: str, key: str) -> Kind:
    """A ``kind`` from a file's table of keys and values; InputError names file, key path, bound, unit and value."""
    return cast(Kind, _read(kind, table, file, key))


def _read(hint: Any, value: Any, file: str, key: str) -> Any:
    """What a file's value says for a field of this type."""
    if hint is Any:
        return value
    mark = mark_of(hint)
    if mark is not None:
        with faults_of(file, key):
            return mark.read(value)
    for choice in choices(hint):
        if typing.get_origin(choice) is tuple:
            if isinstance(value, list):
                inner, *_ = typing.get_args(choice)
                return tuple(_read(inner, item, file, joined(key, i)) for i, item in enumerate(value))
        elif typing.get_origin(choice) is dict:
            if isinstance(value, dict):
                _, inner = typing.get_args(choice)
                return {name: _read(inner, item, file, joined(key, name)) for name, item in value.items()}
        elif isinstance(value, choice) and isinstance(value, bool) == (choice is bool):
            return value
        elif isinstance(value, dict) and is_dataclass(choice):
            return _made(cast(type, choice), value, file, key)
    raise InputError(file, key, f"must be {_wanted(hint)}; got {shown(value)}")


def _made(kind: type, table: dict[str, Any], file: str, key: str) -> Any:
    """A dataclass of a table; a key that no field has is reported first, for a missing one is usually misspelt."""
    values, known = {}, types_of(kind)
    for name, value in table.items():
        if name not in known:
            raise unknown_key(name, value, keys_of(kind), file=file, key=key)
    for name, hint in known.items():
        if name in table:
            values[name] = _read(hint, table[name], file, joined(key, name))
        elif name in needed(kind):
            raise InputError(file, joined(key, name), f"must be given, {_wanted(hint)}; got nothing")
    try:
        return kind(**values)
    except (TypeError, ValueError) as error:
        raise InputError(file, *_own_words(error, key)) from None


@functools.cache
def types_of(kind: type) -> dict[str, Any]:
    """The types of a dataclass's fields, with their marks."""
    hints = typing.get_type_hints(kind, include_extras=True)
    return {field.name: hints[field.name] for field in fields(cast(Any, kind))}


def needed(kind: type) -> list[str]:
    """The fields of a dataclass without a default."""
    return [f.name for f in fields(cast(Any, kind)) if f.default is MISSING and f.default_factory is MISSING]


def mark_of(hint: Any) -> Quantity | None:
    """The unit and the bounds of a field's type, if it is a number with these."""
    return next((mark for mark in getattr(hint, "__metadata__", ()) if isinstance(mark, Quantity)), None)


def choices(hint: Any) -> tuple[Any, ...]:
    """The types that a field may have, without its marks and None: Cue and LumpedCue of ``Cue | LumpedCue``."""
    if typing.get_origin(hint) is typing.Annotated:
        hint = hint.__origin__
    if not isinstance(hint, types.UnionType):
        return (hint,)
    return tuple(member for member in typing.get_args(hint) if member is not type(None))


def joined(key: str, part: str | int) -> str:
    """The key path one step on: ``segments``, then 0, then ``length`` make ``segments[0].length``."""
    if isinstance(part, int):
        return f"{key}[{part}]"
    return f"{key}.{part}" if key else part


def keys_of(kind: type) -> list[str]:
    """The keys that a table of ``kind`` may have."""
    names = [field.name for field in fields(kind)] if is_dataclass(kind) else []
    return [*names, *(kind.named if issubclass(kind, Effect) else ())]


def unknown_key(name: str, value: Any, names: list[str], *, file: str, key: str) -> InputError:
    """The error for a key that is not among ``names``."""
    wanted = f"must be one of the keys {', '.join(names)}"
    half = name == "diameter" and "radius" in names
    hint = "; did you mean 'radius', half of it?" if half else nearest(name, names)
    return InputError(file, joined(key, name), f"{wanted}; got {name} = {shown(value)}{hint}")


def _own_words(error: TypeError | ValueError, path: str) -> tuple[str, str]:
    """The core's "Segment.tip_bore must be ..." as key path and problem."""
    if isinstance(error, OutOfBounds):
        return joined(path, error.name.partition(".")[2]), error.in_words
    message = str(error)
    parts = re.fullmatch(r"[A-Z]\w*\.(\S+) (.*)", message, re.DOTALL)
    return (joined(path, parts[1]), parts[2]) if parts else (path, message)


def _wanted(hint: Any) -> str:
    """What a key takes, in words."""
    mark, first = mark_of(hint), choices(hint)[0]
    if mark is not None:
        return mark.wanted
    if is_dataclass(first):
        named = " or a name from `cuefem parts`" if first is Material else ""
        return f"a table with the keys {', '.join(keys_of(cast(type, first)))}{named}"
    if typing.get_origin(first) is tuple:
        return "an array of tables" if is_dataclass(typing.get_args(first)[0]) else "an array"
    if typing.get_origin(first) is dict:
        return "a table"
    if len(choices(hint)) > 1 and first is str:
        return "text, or an array of texts"
    return {bool: "true or false", int: "a whole number", str: "text"}.get(first, f"a {first}")


def table(instance: Any) -> dict[str, Any]:
    """A dataclass as the table that `build` reads back exactly: texts with units, numbers, tables, lists."""
    entries = {name: (getattr(instance, name), hint) for name, hint in types_of(cast(Any, type(instance))).items()}
    return {
        name: _entry(f"{type(instance).__name__}.{name}", value, hint)
        for name, (value, hint) in entries.items()
        if value is not None and not (isinstance(value, tuple) and not value) and not (name in ABSENT and value == 0)
    }


def _entry(name: str, value: Any, hint: Any) -> Any:
    mark = mark_of(hint)
    if mark is not None:
        return mark.written(value)
    if isinstance(value, Effect):
        return {"type": type(value).__name__, **table(value)}
    if isinstance(value, Material) and value in NAMES:
        return NAMES[value]
    if is_dataclass(value):
        return table(value)
    if isinstance(value, tuple):
        return [_entry(f"{name}[{i}]", item, object) for i, item in enumerate(value)]
    return value
