"""The dataclasses as the schema of the files: tables are validated into them and made of them."""

from __future__ import annotations

import functools
import re
import typing
from dataclasses import fields, is_dataclass
from typing import Annotated, Any, TypeVar, cast

from pydantic import ConfigDict, TypeAdapter, ValidationError

from cuefem.cue import Material
from cuefem.effects import Effect
from cuefem.io.errors import InputError, nearest, shown
from cuefem.io.units import quantity, text
from cuefem.materials import MATERIALS
from cuefem.quantity import Quantity

Kind = TypeVar("Kind")

NAMES = {known.material: name for name, known in MATERIALS.items()}
ABSENT = ("tip_bore", "butt_bore")  # not written if 0, their default: a bore that is not there
_CONFIG = ConfigDict(extra="forbid", arbitrary_types_allowed=True)


@functools.cache
def adapter(kind: Any) -> TypeAdapter[Any]:
    """Pydantic's validator of lists of ``kind``: it takes a configuration for plain dataclasses only from a holder."""
    return TypeAdapter(list[kind], config=_CONFIG)


def build(kind: type[Kind], table: Any, *, file: str, key: str) -> Kind:
    """A ``kind`` from a file's table of keys and values; InputError names file, key path, bound, unit and value."""
    try:
        made = adapter(cast(Any, kind)).validate_python([table], context={"read": quantity})
    except ValidationError as error:
        raise _input_error(error, kind, file=file, key=key) from None
    return cast(Kind, made[0])


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


def _input_error(error: ValidationError, kind: type, *, file: str, key: str) -> InputError:
    """The first fault as one line: misspelt keys before missing ones, since one usually causes the other."""
    faults = sorted(error.errors(include_url=False), key=lambda fault: fault["type"] != "unexpected_keyword_argument")
    fault = faults[0]
    parts, value = fault["loc"][1:], fault["input"]
    path = functools.reduce(joined, parts, key)
    if fault["type"] == "unexpected_keyword_argument":
        *above, name = parts
        owner = functools.reduce(joined, above, key)
        return unknown_key(str(name), value, keys_of(_hint_at(kind, above)), file=file, key=owner)
    if fault["type"] == "missing":
        return InputError(file, path, f"must be given, {_wanted(_hint_at(kind, parts))}; got nothing")
    if fault["type"] == "value_error":
        return InputError(file, *_own_words(str(fault["ctx"]["error"]), path))
    return InputError(file, path, f"must be {_wanted(_hint_at(kind, parts))}; got {shown(value)}")


def _own_words(message: str, path: str) -> tuple[str, str]:
    """The core's "Segment.tip_bore must be ..." as key path and problem."""
    found = re.fullmatch(r"[A-Z]\w*\.(\S+) (.*)", message, re.DOTALL)
    return (joined(path, found[1]), found[2]) if found else (path, message)


def _hint_at(kind: Any, parts: typing.Sequence[str | int]) -> Any:
    """The type declared at a key path below ``kind``."""
    for part in parts:
        kind = _bare_type(kind)
        if isinstance(part, int):
            kind = typing.get_args(kind)[0] if typing.get_args(kind) else object
        else:
            kind = typing.get_type_hints(kind, include_extras=True).get(part, object) if is_dataclass(kind) else object
    return _bare_type(kind)


def _bare_type(hint: Any) -> Any:
    """``Material`` of ``Material | None``; quantities keep their mark."""
    if typing.get_origin(hint) is Annotated:
        return hint
    members = [member for member in typing.get_args(hint) if is_dataclass(member)]
    return members[0] if members and typing.get_origin(hint) is not tuple else hint


def _wanted(hint: Any) -> str:
    """What a key takes, in words."""
    for mark in getattr(hint, "__metadata__", ()):
        if isinstance(mark, Quantity):
            return f"in {mark.bounds}, {mark.example}" if mark.unit else f"a bare number in {mark.bounds}"
    if is_dataclass(hint):
        named = " or a name from `cuefem materials`" if hint is Material else ""
        return f"a table with the keys {', '.join(keys_of(cast(type, hint)))}{named}"
    if typing.get_origin(hint) is tuple:
        return "an array of tables" if is_dataclass(typing.get_args(hint)[0]) else "an array"
    if hint is bool or bool in typing.get_args(hint):
        return "true or false"
    return f"a {getattr(hint, '__name__', hint)}"


def file_value(value: float, mark: Quantity) -> str | float:
    """A number as it stands in a file: text with a unit, or a bare number if it has no dimension."""
    return text(value, mark.unit) if mark.unit else value


def table(instance: Any) -> dict[str, Any]:
    """A dataclass as the table that `build` reads back exactly: texts with units, numbers, tables, lists."""
    hints = typing.get_type_hints(type(instance), include_extras=True)
    found = {field.name: getattr(instance, field.name) for field in fields(instance)}
    return {
        name: _entry(f"{type(instance).__name__}.{name}", value, hints[name])
        for name, value in found.items()
        if value is not None and not (isinstance(value, tuple) and not value) and not (name in ABSENT and value == 0)
    }


def _entry(name: str, value: Any, hint: Any) -> Any:
    marks = [mark for mark in getattr(hint, "__metadata__", ()) if isinstance(mark, Quantity)]
    if marks:
        if not isinstance(value, float):
            raise ValueError(f"{name} must be one number to stand in a file; got an array of {len(value)}")
        return file_value(value, marks[0])
    if isinstance(value, Effect):
        return {"type": type(value).__name__, **table(value)}
    if isinstance(value, Material) and value in NAMES:
        return NAMES[value]
    if is_dataclass(value):
        return table(value)
    if isinstance(value, tuple):
        return [_entry(f"{name}[{i}]", item, object) for i, item in enumerate(value)]
    return value
