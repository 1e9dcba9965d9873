"""The parameters of a scene as options of commands, and the parsers of their texts."""

from __future__ import annotations

import math
import os
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path
from typing import Any

import click

from cuefem.cli.output import shared_option
from cuefem.files import InputError
from cuefem.files.cue_names import cue_name, named_path
from cuefem.parameters.table import PARAMETERS
from cuefem.quantity.display_units import with_unit
from cuefem.quantity.fields import Quantity, comma_hint
from cuefem.quantity.units import parse_number
from cuefem.scene.default_scene import GAMES

Command = Callable[..., Any]

IMPACT_KEYS = ("restitution", "friction", "speed")  # and, for commands with one stroke, the offset
CUE_KEYS = ("body_mass", "shaft_mass")
NO_SHAFT = "does not apply to a lumped cue, which has no shaft geometry"


class CueFile(click.Path):
    """A cue's or scene's file, or the name of a cue."""

    def __init__(self) -> None:
        super().__init__(path_type=Path)

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> Path:
        """The path; of a cue's name that of its drawing."""
        return named_path(Path(os.fsdecode(super().convert(value, param, ctx))))


def file_label(file: Path) -> str:
    """What a table's heading and a column call a file: the name of a cue, or of the file."""
    return cue_name(file) or file.name


def typed_name(file: Path) -> str:
    """What a user types for a file: the name of a cue, or the path."""
    return cue_name(file) or str(file)


def option(name: str) -> str:
    """The name of an option on the command line."""
    return f"--{name.replace('_', '-')}"


def parameter_options(heading: str, *keys: str) -> Callable[[Command], Command]:
    """The options of some parameters under a heading."""

    def decorated(command: Command) -> Command:
        for known in (PARAMETERS[key] for key in reversed(keys)):
            command = shared_option(heading, option(known.key), metavar=known.option, help=known.help)(command)
        return command

    return decorated


def game_option(name: str, help_words: str) -> Callable[[Command], Command]:
    """An option that takes the name of a game."""
    return shared_option("Stroke", name, type=click.Choice([*GAMES]), help=help_words)


def tip_options(command: Command) -> Command:
    """The game, and the options of the leather tip and of the cue."""
    own = (key for key, known in PARAMETERS.items() if known.option and key not in (*IMPACT_KEYS, *CUE_KEYS, "offset"))
    said = "Game whose default ball, tip and stroke a cue without a scene gets (default: pool)."
    return game_option("--game", said)(parameter_options("Tip", *own)(command))


def impact_options(command: Command) -> Command:
    """The options that replace tip and speed."""
    return tip_options(parameter_options("Stroke", *IMPACT_KEYS)(command))


def offset_option(command: Command) -> Command:
    """The option that replaces the stroke's offset."""
    return parameter_options("Stroke", "offset")(command)


def option_value(file: Path, name: str, text: str, wanted: Quantity) -> float:
    """An option's text as a checked SI number."""
    value: Any = text
    with suppress(ValueError):
        value = float(text) if wanted.unit == "" else value
    try:
        return wanted.read(value)
    except ValueError as error:
        raise InputError(file, name, str(error)) from None


def offset_value(file: Path, text: str, radius: float) -> float:
    """The b/R of --offset: a bare number, or a length over the radius of the ball, m."""
    offset = math.nan
    with suppress(ValueError):
        offset = parse_number(text, "m") / radius
    with suppress(ValueError):
        offset = float(text)
    if not abs(offset) < 1:
        below = with_unit(radius, "m", 6)
        within = f'b/R between -1 and 1, or a length below {below} with its unit, such as "8 mm"'
        raise InputError(file, "--offset", f"must be {within}; got {text!r}{comma_hint(text)}")
    return offset
