"""The steps of a desk as one short text, for the browser's memory and for links.

It is JSON, compressed, in letters that an address may hold. Scenes stand in it as in files, with units; a scene that
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
from cuefem.designer.design import MOST_STEPS, Design, Step
from cuefem.io.errors import shown
from cuefem.io.schema import NAMES, build, table
from cuefem.io.toml import scene_of_table
from cuefem.materials import material
from cuefem.scene import Scene
from cuefem.vary import knobs_of, place

VERSION = 1
LONGEST = 1_000_000  # letters of a text
LARGEST = 4_000_000  # bytes that it unpacks to
LONGEST_NAME = 80  # letters of a design's name
MOST_PINNED = 12
_WHAT = "this link"


def text_of(steps: Sequence[Step], at: int = 0) -> str:
    """The steps, and which of them is the present one, as text."""
    scenes: dict[Scene, int] = {}
    designs: dict[Design, int] = {}

    def number(design: Design) -> int:
        scenes.setdefault(design.base, len(scenes))
        return designs.setdefault(design, len(designs))

    rows = [[number(step.design), *map(number, step.pinned)] for step in steps]
    record = {
        "version": VERSION,
        "scenes": [_table(scene) for scene in scenes],
        "designs": [[d.name, scenes[d.base], _moved(d), list(d.notes)] for d in designs],
        "steps": rows,
        "at": at,
    }
    packed = zlib.compress(json.dumps(record, ensure_ascii=False, separators=(",", ":")).encode(), 6)
    return base64.urlsafe_b64encode(packed).decode().rstrip("=")


def steps_of(text: str) -> tuple[list[Step], int]:
    """The steps of a text and which is the present one; ValueError if it is not one of `text_of`."""
    try:
        return _read(_unpacked(text))
    except (KeyError, IndexError, TypeError, RecursionError):
        raise ValueError(f"{_WHAT} is damaged: its parts do not fit together") from None


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
    return {key: _entry(value) for key, value in design.knobs.items() if value != own[key]}


def _entry(value: Any) -> Any:
    if isinstance(value, Material):
        return NAMES.get(value) or table(value)
    return value


def _unpacked(text: str) -> dict[str, Any]:
    if len(text) > LONGEST:
        raise ValueError(f"{_WHAT} must have at most {LONGEST} letters; got {len(text)}")
    try:
        packed = base64.urlsafe_b64decode(text + "=" * (-len(text) % 4))
        unpacking = zlib.decompressobj()
        content = unpacking.decompress(packed, LARGEST)
        if unpacking.unconsumed_tail or not unpacking.eof:
            raise ValueError("cut off")
        found = json.loads(content)
    except (ValueError, binascii.Error, zlib.error, RecursionError):
        raise ValueError(f"{_WHAT} is not whole: copy all of it; got {shown(text[:20])}") from None
    if not isinstance(found, dict) or found.get("version") != VERSION:
        raise ValueError(f"{_WHAT} must be of version {VERSION}: it is from another version of cuefem")
    return found


def _read(found: dict[str, Any]) -> tuple[list[Step], int]:
    rows, at = found["steps"], found["at"]
    if not 0 < len(rows) <= MOST_STEPS or not isinstance(at, int) or not 0 <= at < len(rows):
        raise ValueError(f"{_WHAT} must hold 1 to {MOST_STEPS} steps; got {shown(len(rows))}")
    scenes = [scene_of_table(entry, _WHAT) for entry in found["scenes"][: MOST_STEPS * (1 + MOST_PINNED)]]
    designs = [_design(entry, scenes) for entry in found["designs"][: MOST_STEPS * (1 + MOST_PINNED)]]
    steps = [Step(designs[row[0]], tuple(designs[i] for i in row[1 : 1 + MOST_PINNED])) for row in rows]
    return steps, at


def _design(entry: Any, scenes: Sequence[Scene]) -> Design:
    name, number, moved, notes = entry
    base = scenes[number]
    own = knobs_of(base)
    knobs = dict(own)
    for written, value in moved.items():
        known = place(written)
        key = known.key if known else written
        knobs[key] = _knob(written, value, own.get(key))
    found = Design(str(name)[:LONGEST_NAME], base, knobs, tuple(str(note)[:500] for note in notes))
    found.scene  # noqa: B018  # no such cue: ValueError
    return found


def _knob(name: str, value: Any, own: Any) -> Any:
    """A knob's value as it was read, of the kind that the scene has there."""
    if own is None:
        raise ValueError(f"{_WHAT}: {shown(name)} must be a knob of its cue")
    if isinstance(own, Material):
        return material(value) if isinstance(value, str) else build(Material, value, file=_WHAT, key=name)
    if isinstance(value, bool) or not isinstance(value, int | float) or not math.isfinite(value):
        raise ValueError(f"{_WHAT}: {name} must be a number; got {shown(value)}")
    return float(value)
