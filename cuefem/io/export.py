"""The schema of cue and scene files as JSON schema, for editors and programs; its one source is the dataclasses."""

from __future__ import annotations

import inspect
import math
import typing
from dataclasses import fields, is_dataclass
from typing import Any, cast

from cuefem.cue import Cue, LumpedCue
from cuefem.effects import effect_kinds
from cuefem.games import STROKES
from cuefem.io.schema import choices, mark_of, needed, types_of
from cuefem.io.toml import Accuracy
from cuefem.measured.side.side_scene import SideStrike
from cuefem.quantity.fields import Quantity
from cuefem.scene import Scene

_PLAIN = {bool: "boolean", int: "integer", str: "string"}


def json_schema() -> dict[str, Any]:
    """JSON schema of a file: a scene, a strike from the side, or a cue alone."""
    effects = effect_kinds()
    definitions: dict[str, Any] = {}
    for kind in (Scene, SideStrike, Accuracy, *effects.values()):
        _define(kind, definitions)
    for name, kind in effects.items():
        words = {word: {"enum": [*names]} for word, names in kind.named.items()}
        meant = {key for names in kind.named.values() for values in names.values() for key in values}
        definitions[name]["properties"] = {"type": {"const": name}, **definitions[name]["properties"], **words}
        definitions[name]["required"] = ["type", *(key for key in needed(kind) if key not in meant)]
    named = {"type": "string", "description": "a name from `cuefem materials`"}
    definitions["Material"] = {"anyOf": [named, definitions["Material"]]}
    path = {"type": "string", "description": "path of a cue file, relative to this one"}
    for kind, cues in ((Scene, (Cue, LumpedCue)), (SideStrike, (Cue,))):
        scene = definitions[kind.__name__]["properties"]
        scene["cue"] = {"anyOf": [path, *(_ref(cue) for cue in cues)]}
        scene["effects"]["items"] = {"anyOf": [_ref(effect) for effect in effects.values()]} if effects else False
        scene["accuracy"] = _ref(Accuracy)
    definitions["Scene"]["properties"]["game"] = {"enum": [*STROKES], "description": "whose what is left out is"}
    return {
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        "title": "A cuefem file: a scene, a strike from the side, or a cue alone",
        "anyOf": [_ref(kind) for kind in (Scene, SideStrike, Cue)],
        "$defs": dict(sorted(definitions.items())),
    }


def _ref(kind: type) -> dict[str, str]:
    return {"$ref": f"#/$defs/{kind.__name__}"}


def _define(kind: type, definitions: dict[str, Any]) -> None:
    """Put the JSON schema of a dataclass, and of all that it holds, into ``definitions``."""
    made = {"description": inspect.cleandoc(kind.__doc__ or ""), "title": kind.__name__, "type": "object"}
    definitions[kind.__name__] = made | {
        "properties": {
            field.name: _field(field, types_of(kind)[field.name], definitions) for field in fields(cast(Any, kind))
        },
        "additionalProperties": False,
    }
    if needed(kind):
        definitions[kind.__name__]["required"] = needed(kind)


def _field(field: Any, hint: Any, definitions: dict[str, Any]) -> dict[str, Any]:
    """A field with its default as it stands in a file."""
    mark = mark_of(hint)
    if mark is None:
        return _contents(hint, definitions)
    default = mark.written(field.default) if isinstance(field.default, float) else math.inf
    return _number(mark) | ({} if default == math.inf else {"default": default})  # TOML can say inf, JSON cannot


def _number(mark: Quantity) -> dict[str, Any]:
    """Text with a unit, or a bare number within its bounds."""
    if mark.unit:
        kinds = ["string", "number"] if mark.endless else "string"  # inf alone is a number without a unit
        return {"type": kinds, "description": f"{mark.example}; in {mark.bounds}"}
    low, high = mark.ends
    bounds = {"minimum" if mark.interval[0] == "[" else "exclusiveMinimum": low}
    bounds["maximum" if mark.interval[-1] == "]" else "exclusiveMaximum"] = high
    finite = {key: end for key, end in bounds.items() if math.isfinite(end)}
    return {"type": "number", **finite, "description": f"a number in {mark.interval}"}


def _contents(hint: Any, definitions: dict[str, Any]) -> dict[str, Any]:
    """What a field holds that is no number with bounds: tables, lists of them, words."""
    kinds = choices(hint)
    if typing.get_origin(kinds[0]) is tuple:
        return {"type": "array", "items": _contents(typing.get_args(kinds[0])[0], definitions)}
    tables = [cast(type, kind) for kind in kinds if is_dataclass(kind)]
    for kind in tables:
        if kind.__name__ not in definitions:
            _define(kind, definitions)
    made = [_ref(kind) if kind in tables else {"type": _PLAIN[kind]} for kind in kinds]
    return made[0] if len(made) == 1 else {"anyOf": made}
