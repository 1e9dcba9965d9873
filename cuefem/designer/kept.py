"""The state of a page as one short text, for the browser's memory.

It is JSON, compressed, as base64. Scenes stand in it as in files, with units; a scene that
many steps share stands there once.
"""

from __future__ import annotations

import base64
import binascii
import json
import math
import zlib
from collections.abc import Sequence
from functools import lru_cache
from hashlib import sha256
from typing import Any

from cuefem.cue import Material
from cuefem.designer.design import MOST_STEPS, Design, State, Step, check_segments
from cuefem.designer.ranges import knobs_of
from cuefem.designer.sliders import choices
from cuefem.io.schema import NAMES, table
from cuefem.io.toml import scene_of_table
from cuefem.parameters.parameter import parameter
from cuefem.scene import Scene

VERSION = 1
LONGEST = 1_000_000  # letters of a text
LARGEST = 4_000_000  # bytes that it unpacks to
LONGEST_NAME = 80  # letters of a design's name
MOST_PINNED = 12
DAMAGED = "what this browser kept is damaged, or of another version of cuefem"


def text_of(state: State) -> str:
    """All steps of a state, and which of them is shown, as text."""
    scenes: dict[Scene, int] = {}
    designs: dict[Design, int] = {}

    def number(design: Design) -> int:
        scenes.setdefault(design.base, len(scenes))
        return designs.setdefault(design, len(designs))

    rows = [[number(step.design), *map(number, step.pinned)] for step in state.steps]
    record = {
        "version": VERSION,
        "scenes": [_table(scene) for scene in scenes],
        "designs": [[d.name, scenes[d.base], _moved(d), list(d.notes)] for d in designs],
        "steps": rows,
        "at": state.at,
    }
    packed = zlib.compress(json.dumps(record, ensure_ascii=False, separators=(",", ":")).encode(), 6)
    return base64.urlsafe_b64encode(packed).decode().rstrip("=")


def state_of(text: str) -> State:
    """The state of a text; ValueError in a line if it is not one of `text_of`."""
    try:
        return _read(_unpacked(text))
    except (LookupError, TypeError, AttributeError, RecursionError, OverflowError, binascii.Error, zlib.error):
        raise ValueError(DAMAGED) from None


def key_of(design: Design) -> str:
    """A short name of what the page was opened with: another file, or one that was changed, has another."""
    text = json.dumps([design.name, _table(design.base)], ensure_ascii=False)
    return "cuefem-desk-" + sha256(text.encode()).hexdigest()[:16]


@lru_cache(maxsize=64)
def _table(scene: Scene) -> dict[str, Any]:
    return table(scene)


@lru_cache(maxsize=64)
def _own(scene: Scene) -> dict[str, Any]:
    return knobs_of(scene)


def _moved(design: Design) -> dict[str, Any]:
    """The knobs that do not stand where the scene has them."""
    own = _own(design.base)
    values = {key: value for key, value in design.knobs.items() if value != own[key]}
    return {key: NAMES[value] if isinstance(value, Material) else value for key, value in values.items()}


def _unpacked(text: str) -> dict[str, Any]:
    if len(text) > LONGEST:
        raise ValueError(DAMAGED)
    unpacking = zlib.decompressobj()
    content = unpacking.decompress(base64.urlsafe_b64decode(text + "=" * (-len(text) % 4)), LARGEST)
    state = json.loads(content) if unpacking.eof else None
    if not isinstance(state, dict) or state.get("version") != VERSION:
        raise ValueError(DAMAGED)
    return state


def _read(state: dict[str, Any]) -> State:
    rows, at = state["steps"], state["at"]
    if not 0 < len(rows) <= MOST_STEPS or type(at) is not int or not 0 <= at < len(rows):
        raise ValueError(DAMAGED)
    for entry in state["scenes"]:  # all of them, before any is made
        check_segments(len(entry["cue"].get("segments", ())))
    scenes = [scene_of_table(entry, "this browser") for entry in state["scenes"]]
    designs = [_design(entry, scenes) for entry in state["designs"]]
    if any(len(row) > 1 + MOST_PINNED for row in rows):
        raise ValueError(DAMAGED)
    return State(tuple(Step(designs[row[0]], tuple(designs[i] for i in row[1:])) for row in rows), at)


def _design(entry: Any, scenes: Sequence[Scene]) -> Design:
    name, base, moved, notes = entry[0], scenes[entry[1]], entry[2], entry[3]
    offered = {choice.knob: choice.materials for choice in choices(base)}
    knobs = dict(knobs_of(base))
    for written, value in moved.items():
        known = parameter(written)
        key = known.key if known else written
        if key not in knobs or not (key in offered or (isinstance(value, int | float) and math.isfinite(value))):
            raise ValueError(DAMAGED)
        knobs[key] = offered[key][value] if key in offered else float(value)
    if not all(isinstance(text, str) for text in (name, *notes)):
        raise ValueError(DAMAGED)
    design = Design(name, base, knobs, tuple(notes))
    design.scene  # noqa: B018  # no such cue: ValueError
    return design
