"""The state of a page as one short text, for the browser's memory and for links.

It is JSON, compressed, in letters that an address may hold. Scenes stand in it as in files, with units; a scene that
many steps share stands there once.
"""

from __future__ import annotations

import base64
import binascii
import json
import zlib
from collections.abc import Sequence
from functools import lru_cache
from hashlib import sha256
from typing import Any

from cuefem.cue import Material
from cuefem.designer.design import MOST_STEPS, Design, State, Step, check_segments
from cuefem.designer.sliders import choices
from cuefem.io.errors import shown
from cuefem.io.schema import NAMES, table
from cuefem.io.toml import scene_of_table
from cuefem.scene import Scene
from cuefem.vary import knobs_of, place

VERSION = 1
LONGEST = 1_000_000  # letters of a text
LARGEST = 4_000_000  # bytes that it unpacks to
LONGEST_NAME = 80  # letters of a design's name
LONGEST_NOTE = 500
MOST_PINNED = 12
MOST_NUMBER = 1e300  # that a knob may stand at; its own bounds are narrower
_WHAT = "this link"


class TooMuch(ValueError):
    """A text unpacks to more than is read."""


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


def state_of(text: str, most_steps: int = MOST_STEPS) -> State:
    """The state of a text; ValueError in a line if it is not one of `text_of`, or holds more steps."""
    try:
        return _read(_unpacked(text), most_steps)
    except (KeyError, IndexError, TypeError, AttributeError, RecursionError):
        raise ValueError(f"{_WHAT} is damaged: its parts do not fit together") from None


def step_of(link: str) -> Step:
    """The one step that a link holds; ValueError in a line if it holds none."""
    return state_of(link, 1).now


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
        raise ValueError(f"{_WHAT} must have at most {LONGEST} letters; got {len(text)}")
    try:
        packed = base64.urlsafe_b64decode(text + "=" * (-len(text) % 4))
        unpacking = zlib.decompressobj()
        content = unpacking.decompress(packed, LARGEST)
        if unpacking.unconsumed_tail:
            raise TooMuch(f"{_WHAT} must hold at most {LARGEST // 10**6} MB of designs")
        if not unpacking.eof:
            raise ValueError("cut off")
        state = json.loads(content)
    except TooMuch:
        raise
    except (ValueError, binascii.Error, zlib.error, RecursionError):
        raise ValueError(f"{_WHAT} is not whole: copy all of it; got {shown(text[:20])}") from None
    if not isinstance(state, dict) or state.get("version") != VERSION:
        raise ValueError(f"{_WHAT} must be of version {VERSION}: it is from another version of cuefem")
    return state


def _read(state: dict[str, Any], most_steps: int) -> State:
    rows, at = state["steps"], state["at"]
    if not 0 < len(rows) <= most_steps or type(at) is not int or not 0 <= at < len(rows):
        wanted = f"1 to {most_steps} steps" if most_steps > 1 else "1 step"
        raise ValueError(f"{_WHAT} must hold {wanted}; got {len(rows)}")
    most = most_steps * (1 + MOST_PINNED)
    for entries in (state["scenes"], state["designs"]):
        if len(entries) > most:
            raise ValueError(f"{_WHAT} must hold at most {most} designs; got {len(entries)}")
    for entry in state["scenes"]:  # all of them, before any is made
        check_segments(len(entry["cue"]["segments"]) if "segments" in entry["cue"] else 0)
    scenes = [scene_of_table(entry, _WHAT) for entry in state["scenes"]]
    designs = [_design(entry, scenes) for entry in state["designs"]]
    if any(len(row) > 1 + MOST_PINNED for row in rows):
        raise ValueError(f"{_WHAT} must hold at most {MOST_PINNED} pinned designs a step")
    steps = (Step(_at(designs, row[0]), tuple(_at(designs, number) for number in row[1:])) for row in rows)
    return State(tuple(steps), at)


def _at(entries: Sequence[Any], number: Any) -> Any:
    """The entry of this number, counted from 0 on."""
    if type(number) is not int or number < 0:
        raise IndexError(number)
    return entries[number]


def _design(entry: Any, scenes: Sequence[Scene]) -> Design:
    name, base, moved, notes = entry[0], _at(scenes, entry[1]), entry[2], entry[3]
    own, offered = knobs_of(base), {choice.knob: choice.materials for choice in choices(base)}
    knobs = dict(own)
    for written, value in moved.items():
        known = place(written)
        key = known.key if known else written
        knobs[key] = _material(key, value, offered[key]) if key in offered else _number(key, value, own.get(key))
    said = tuple(_words(note, LONGEST_NOTE) for note in notes)
    design = Design(_words(name, LONGEST_NAME), base, knobs, said)
    design.scene  # noqa: B018  # no such cue: ValueError
    return design


def _words(text: Any, longest: int) -> str:
    """A name or a note, in letters that a page can show."""
    if not isinstance(text, str):
        raise TypeError(text)
    return text[:longest].encode(errors="replace").decode()


def _material(knob: str, name: Any, offered: dict[str, Material]) -> Material:
    """A material by its name, of those that the knob offers."""
    if not isinstance(name, str) or name not in offered:
        raise ValueError(f"{_WHAT}: {knob} must be one of {', '.join(offered)}; got {shown(name)}")
    return offered[name]


def _number(knob: str, value: Any, own: Any) -> float:
    """Where a knob stands, if the scene has it."""
    if own is None:
        raise ValueError(f"{_WHAT}: {shown(knob)} must be a knob of its cue")
    if isinstance(value, bool) or not isinstance(value, int | float) or not abs(value) <= MOST_NUMBER:
        raise ValueError(f"{_WHAT}: {knob} must be a number; got {shown(value)}")
    return float(value)
