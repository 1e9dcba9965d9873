"""Dataclasses as the schema of the files: conversion of tables to dataclasses and back."""

from __future__ import annotations

import functools
import re
import types
import typing
from dataclasses import MISSING, fields, is_dataclass
from os import PathLike
from typing import Any, TypeVar, cast

from cuefem.cue import Material
from cuefem.cue.materials import MATERIALS, material
from cuefem.effects.effect import Effect
from cuefem.files.errors import InputError, as_input_error, quote, suggestion
from cuefem.quantity.fields import OutOfBounds, quantity_of

Kind = TypeVar("Kind")

MATERIAL_NAMES = {known.material: name for name, known in MATERIALS.items()}
OMITTED_IF_ZERO = ("tip_bore", "butt_bore", "shaft_mass_measured", "assumed_body_mass")  # if 0 or false, their default


def build(kind: type[Kind], table: Any, *, file: str, key: str) -> Kind:
    """An instance of ``kind`` from a file's table; InputError names file, key path, limit, unit and value."""
    return cast(Kind, _convert(kind, table, file, key))


def _convert(hint: Any, value: Any, file: str, key: str) -> Any:
    """A file's value converted to the type of a field."""
    if hint is Any:
        return value
    quantity = quantity_of(hint)
    if quantity is not None:
        with as_input_error(file, key):
            return quantity.read(value)
    for choice in member_types(hint):
        if typing.get_origin(choice) is tuple:
            if isinstance(value, list):
                inner, *_ = typing.get_args(choice)
                return tuple(_convert(inner, item, file, key_path(key, i)) for i, item in enumerate(value))
        elif typing.get_origin(choice) is dict:
            if isinstance(value, dict):
                _, inner = typing.get_args(choice)
                return {name: _convert(inner, item, file, key_path(key, name)) for name, item in value.items()}
        elif isinstance(value, choice) and isinstance(value, bool) == (choice is bool):
            return value
        elif isinstance(value, str) and choice is Material:
            return named_material(value, file, key)
        elif isinstance(value, dict) and is_dataclass(choice):
            return _build_table(cast(type, choice), value, file, key)
    raise InputError(file, key, f"must be {_expected(hint)}; got {quote(value)}")


def named_material(name: str, file: str | PathLike[str], key: str, use: str = "") -> Material:
    """The material of this name; InputError with similar names of its use (`material`) if it is unknown."""
    try:
        return material(name, use)
    except ValueError as error:
        raise InputError(file, key, f"{error}; see `cuefem parts`") from None


def _build_table(kind: type, table: dict[str, Any], file: str, key: str) -> Any:
    """A dataclass from a table; unknown keys are reported first, since a missing key is often misspelt."""
    values, known = {}, field_types(kind)
    for name in table:
        if name not in known:
            raise unknown_key(name, keys_of(kind), file=file, key=key)
    for name, hint in known.items():
        if name in table:
            values[name] = _convert(hint, table[name], file, key_path(key, name))
        elif name in required_keys(kind):
            raise InputError(file, key_path(key, name), f"must be given, {_expected(hint)}; got nothing")
    try:
        return kind(**values)
    except (TypeError, ValueError) as error:
        raise InputError(file, *_key_and_problem(error, key)) from None


@functools.cache
def field_types(kind: type) -> dict[str, Any]:
    """The types of a dataclass's fields, with their annotations."""
    hints = typing.get_type_hints(kind, include_extras=True)
    return {field.name: hints[field.name] for field in fields(cast(Any, kind)) if field.compare}


def required_keys(kind: type) -> list[str]:
    """The names of fields without a default."""
    return [f.name for f in fields(cast(Any, kind)) if f.default is MISSING and f.default_factory is MISSING]


def member_types(hint: Any) -> tuple[Any, ...]:
    """The member types of a field's union, without annotations and None: Cue and LumpedCue of ``Cue | LumpedCue``."""
    if typing.get_origin(hint) is typing.Annotated:
        hint = hint.__origin__
    if not isinstance(hint, types.UnionType):
        return (hint,)
    return tuple(member for member in typing.get_args(hint) if member is not type(None))


def key_path(key: str, part: str | int) -> str:
    """The key path with one more part: ``segments``, 0 and ``length`` give ``segments[0].length``."""
    if isinstance(part, int):
        return f"{key}[{part}]"
    return f"{key}.{part}" if key else part


def keys_of(kind: type) -> list[str]:
    """The valid keys of a table of ``kind``."""
    names = [field.name for field in fields(kind) if field.compare] if is_dataclass(kind) else []
    return [*names, *(kind.presets if issubclass(kind, Effect) else ())]


def unknown_key(name: str, names: list[str], *, file: str, key: str) -> InputError:
    """The error for a key that is not among ``names``."""
    hint = suggestion(name, names) or f"; valid: {', '.join(names)}"
    return InputError(file, key_path(key, name), f"unknown key{hint}")


def _key_and_problem(error: TypeError | ValueError, path: str) -> tuple[str, str]:
    """Key path and problem of a dataclass's error "Segment.tip_bore must be ..."."""
    if isinstance(error, OutOfBounds):
        return key_path(path, error.name.partition(".")[2]), error.file_message
    message = str(error)
    parts = re.fullmatch(r"[A-Z]\w*\.(\S+) (.*)", message, re.DOTALL)
    return (key_path(path, parts[1]), parts[2]) if parts else (path, message)


def _expected(hint: Any) -> str:
    """Description of the valid values of a field."""
    quantity, first = quantity_of(hint), member_types(hint)[0]
    if quantity is not None:
        return quantity.expected
    if is_dataclass(first):
        named = " or a name from `cuefem parts`" if first is Material else ""
        return f"a table with the keys {', '.join(keys_of(cast(type, first)))}{named}"
    if typing.get_origin(first) is tuple:
        return "an array of tables, with [[ ]]" if is_dataclass(typing.get_args(first)[0]) else "an array"
    if typing.get_origin(first) is dict:
        return "a table"
    if len(member_types(hint)) > 1 and first is str:
        return "text, or an array of texts"
    return {bool: "true or false", int: "a whole number", float: "a number", str: "text"}.get(first, f"a {first}")


def table(instance: Any) -> dict[str, Any]:
    """A dataclass as a table that `build` converts back exactly: texts with units, numbers, tables, lists."""
    entries = {name: (getattr(instance, name), hint) for name, hint in field_types(cast(Any, type(instance))).items()}
    return {
        name: _entry(f"{type(instance).__name__}.{name}", value, hint)
        for name, (value, hint) in entries.items()
        if value is not None
        and not (isinstance(value, tuple) and not value)
        and not (name in OMITTED_IF_ZERO and value == 0)
    }


def _entry(name: str, value: Any, hint: Any) -> Any:
    quantity = quantity_of(hint)
    if quantity is not None:
        return quantity.as_text(value)
    if isinstance(value, Effect):
        return {"type": type(value).__name__, **table(value)}
    if isinstance(value, Material) and value in MATERIAL_NAMES:
        return MATERIAL_NAMES[value]
    if is_dataclass(value):
        return table(value)
    if isinstance(value, tuple):
        return [_entry(f"{name}[{i}]", item, object) for i, item in enumerate(value)]
    return value
