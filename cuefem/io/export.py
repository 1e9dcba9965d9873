"""The schema of cue and scene files as JSON schema, for editors and programs; its one source is the dataclasses."""

from __future__ import annotations

import math
import typing
from collections.abc import Iterator
from dataclasses import MISSING, fields, is_dataclass
from typing import Any, cast

from pydantic.json_schema import GenerateJsonSchema

from cuefem.cue import Cue, LumpedCue
from cuefem.effects import effect_kinds
from cuefem.io.schema import adapter, file_value
from cuefem.io.toml import Accuracy
from cuefem.quantity import quantities
from cuefem.scene import Scene


class _Generator(GenerateJsonSchema):
    def field_title_should_be_set(self, schema: Any) -> bool:
        return False

    def default_schema(self, schema: Any) -> dict[str, Any]:
        return dict(self.generate_inner(schema["schema"]))  # defaults are written below, with units

    def nullable_schema(self, schema: Any) -> dict[str, Any]:
        return dict(self.generate_inner(schema["schema"]))  # a file leaves out what is None

    def is_instance_schema(self, schema: Any) -> dict[str, Any]:
        return {}  # the effects, which stand apart below


def _definitions(kind: type) -> dict[str, Any]:
    """JSON schemas of ``kind`` and all that it holds, by name."""
    made = adapter(kind).json_schema(schema_generator=_Generator)
    closed = {"additionalProperties": False}  # which older pydantics leave out for plain dataclasses
    return {name: definition | closed for name, definition in made["$defs"].items()}


def _with_defaults(kind: type, definition: dict[str, Any]) -> None:
    marked = {name: mark for name, mark, *_ in quantities(kind)}
    for field in fields(kind):
        if field.name in marked and field.default is not MISSING and field.default is not None:
            default = file_value(field.default, marked[field.name])
            if default != math.inf:  # which TOML can say and JSON cannot
                definition["properties"][field.name]["default"] = default


def _held(hint: Any) -> Iterator[type]:
    """A dataclass and every dataclass that its fields hold."""
    if is_dataclass(hint):
        yield cast(type, hint)
        for inner in typing.get_type_hints(hint).values():
            yield from _held(inner)
    for inner in typing.get_args(hint):
        yield from _held(inner)


def json_schema() -> dict[str, Any]:
    """JSON schema of a file: a scene, or a cue alone."""
    effects = effect_kinds()
    kinds: tuple[type, ...] = (Scene, Accuracy, *effects.values())
    found: dict[str, Any] = {}
    for kind in kinds:
        found |= _definitions(kind)
    for held in {inner for kind in kinds for inner in _held(kind)}:
        _with_defaults(held, found[held.__name__])
    for name in effects:
        found[name]["properties"] = {"type": {"const": name}, **found[name]["properties"]}
        found[name]["required"] = ["type", *found[name].get("required", [])]
        for word, names in effects[name].named.items():
            found[name]["properties"][word] = {"enum": [*names]}
            meant = {key for values in names.values() for key in values}
            found[name]["required"] = [key for key in found[name]["required"] if key not in meant]
    named = {"type": "string", "description": "a name from `cuefem materials`"}
    found["Material"] = {"anyOf": [named, found["Material"]]}
    scene = found["Scene"]["properties"]
    path = {"type": "string", "description": "path of a cue file, relative to this one"}
    scene["cue"] = {"anyOf": [path, _ref(Cue.__name__), _ref(LumpedCue.__name__)]}
    scene["effects"]["items"] = {"anyOf": [_ref(name) for name in effects]} if effects else False
    scene["accuracy"] = _ref(Accuracy.__name__)
    return {
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        "title": "A cuefem file: a scene, or a cue alone",
        "anyOf": [_ref(Scene.__name__), _ref(Cue.__name__)],
        "$defs": dict(sorted(found.items())),
    }


def _ref(name: str) -> dict[str, str]:
    return {"$ref": f"#/$defs/{name}"}
