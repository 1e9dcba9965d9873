"""Cues and scenes by name, in every place that takes a file: one list for calls, commands and the designer."""

from __future__ import annotations

import os
from pathlib import Path
from typing import NamedTuple

from cuefem.files.errors import InputError, check_path
from cuefem.files.parts_catalogue import data_folder
from cuefem.quantity.fields import suggestion


class NamedCue(NamedTuple):
    """A drawing or scene that has a name: its path from the data folder, what is assumed in it, and its game."""

    file: str
    assumed: str
    game: str = "pool"

    @property
    def mark(self) -> str:
        """A dagger for a cue whose inside is assumed, which no one but its maker has seen."""
        return "†" if "inside" in self.assumed else ""


INSIDE_ASSUMED = "† inside assumed"
_USUAL = "usual dimensions (meshes/README.md)"
_SOLD = "a size that is sold, its inside assumed (meshes/README.md)"
_INSIDE = "inside and taper assumed (studies/measured)"
_WIDTH = "all but the width of the tip assumed (studies/measured)"
_EXAMPLE = "an example: cue, tip and stroke are usual"
CUES = {
    "plain maple": NamedCue("meshes/pool_maple.toml", _USUAL),
    "low deflection": NamedCue("meshes/pool_hollow.toml", _SOLD),
    "carbon": NamedCue("meshes/carbon.toml", _SOLD),
    "whole cue": NamedCue("meshes/whole_cue.toml", _USUAL),
    "kim": NamedCue("meshes/kim.toml", "the shaft of Kim's paper (meshes/README.md)", "carom"),
    "predator z2": NamedCue("studies/measured/predator_z2/cue.toml", _INSIDE),
    "players maple": NamedCue("studies/measured/players_maple/cue.toml", _WIDTH),
    "stinger": NamedCue("studies/measured/stinger/cue.toml", _WIDTH),
    "kim bare": NamedCue("studies/scenes/kim.toml", "the stroke of Kim's paper: bare shaft, 2 ms", "carom"),
    "hollow front on bridge": NamedCue("studies/scenes/pool_low_deflection.toml", _EXAMPLE),
    "carom cone": NamedCue("studies/scenes/carom.toml", _EXAMPLE, "carom"),
    "break cue": NamedCue("studies/scenes/break_cue.toml", "a break at 25 mph with a phenolic tip: example"),
    "snooker ash": NamedCue("studies/scenes/snooker.toml", "thin ash shaft with a brass ferrule: example", "snooker"),
    "clay on shaft": NamedCue("studies/scenes/clay_on_shaft.toml", "11 g of clay on the shaft: example"),
}
REFERENCES = ("plain maple", "low deflection", "carbon")  # of a verdict; other cues are compared with the first


def named_path(path: Path) -> Path:
    """The drawing of the cue that a path names: a text without extension where there is no file.

    Any words of a name are enough, if they are those of no other; InputError otherwise.
    """
    check_path(path)
    if path.suffix or os.path.exists(path):
        return path
    found = matching_names(path)
    if len(found) > 1:
        raise InputError(path, "", f"names {len(found)} cues: write {' or '.join(map(repr, found))}")
    if not found:
        problem = f"must be a file, or a cue's name: {', '.join(CUES)}; got neither{suggestion(path.name, CUES)}"
        raise InputError(path, "", problem)
    return _place(found[0])


def matching_names(path: Path) -> list[str]:
    """The names that contain all words of a path, or only the name that equals it."""
    words = _words(path.name)
    exact = [name for name in CUES if _words(name) == words]
    return exact or [name for name in CUES if words and {*words} <= {*_words(name)}]


def cue_name(path: Path) -> str:
    """The name of the cue whose drawing this is; "" for another file."""
    return next((name for name in CUES if path == _place(name)), "")


def _place(name: str) -> Path:
    """The file of a name; that of a scene is spelt with "..", so that a path that was typed keeps its own name."""
    folder, file = data_folder(), CUES[name].file
    return folder / "studies" / ".." / file if file.startswith("studies/scenes/") else folder / file


def _words(name: str) -> list[str]:
    return name.casefold().replace("_", " ").replace("-", " ").split()
