"""The parameters of a scene as options, and the scene of a file with these options."""

from __future__ import annotations

import math
import os
from collections.abc import Callable, Iterator
from contextlib import suppress
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import click

from cuefem.cli.output import shared_option
from cuefem.contact.side_strike import SideStrike
from cuefem.cue import Cue, LumpedCue
from cuefem.files import InputError, with_body_mass
from cuefem.files.cue_names import cue_name, named_path
from cuefem.files.errors import as_input_error
from cuefem.parameters.parameter import PARAMETERS, Parameter, with_fields, with_parameters, with_values_at
from cuefem.parameters.parameter import Path as Steps
from cuefem.parameters.parts import main_material, with_material
from cuefem.quantity.display_units import with_unit
from cuefem.quantity.fields import OutOfBounds, Quantity, comma_hint
from cuefem.quantity.units import parse_number
from cuefem.scene import Scene
from cuefem.scene.default_scene import DEFAULT_GAME, GAMES, default_tip, usual_scene
from cuefem.show.plausibility import plausibility_warnings

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


def with_body_option(thing: Cue | Scene | SideStrike, file: Path, text: str) -> Any:
    """The cue or scene of a file with the mass behind its segments by --body-mass."""
    if not isinstance(thing, Cue) and isinstance(thing.cue, LumpedCue):
        raise InputError(file, "--body-mass", NO_SHAFT)
    return with_body_mass(thing, file, "--body-mass", text)


def with_shaft_mass_option(thing: Cue | Scene | SideStrike, file: Path, text: str) -> Any:
    """The cue or scene of a file with the density of its wood by --shaft-mass."""
    mass = option_value(file, "--shaft-mass", text, Quantity("kg", "(0, 100]"))
    if isinstance(thing, SideStrike) or (isinstance(thing, Scene) and thing.lumped):
        raise InputError(file, "--shaft-mass", "does not apply: FILE has no shaft")
    with as_input_error(file, "--shaft-mass"):
        if not isinstance(thing, Cue):
            return with_parameters(thing, {"shaft mass": mass})
        weighed = with_parameters(
            usual_scene(thing), {"shaft mass": mass}
        )  # whose weight counts the tip, as a scale does
        return replace(with_material(thing, *map(main_material, (thing, weighed.shaft))), shaft_mass_measured=True)


def scene_from_cue(cue: Cue, file: Path, options: dict[str, Any]) -> Scene:
    """The scene of a cue alone: the game's default stroke."""
    game = options.get("game") or DEFAULT_GAME
    leather = default_tip(cue, game)
    changes = _changes(SimpleNamespace(effects=(leather,)), file, options, _is_leather)
    try:
        own = {path[1:]: value for path, value in changes.items() if path[0] == "leather"}
        leather = with_fields(leather, own)
        scene = usual_scene(cue, game, tip=leather)
    except ValueError as error:
        implausible = plausibility_warnings(Scene(cue), with_impact=False)
        hint = f"; {implausible[0]}" if implausible else " (options: --tip-height, --dome)"
        text = str(error) if options.get("dome") is None else str(error).replace("dome radius", "--dome")
        raise InputError(file, "", f"{text}{hint}") from None
    return with_options(scene, file, options)


def scene_as_drawn(cue: Cue, file: Path, options: dict[str, Any]) -> Scene:
    """The scene of a cue without a tip; --shaft-mass weighs it with its usual tip, as in `cuefem convert`."""
    weight = options.get("shaft_mass")
    drawn = cue if weight is None else with_shaft_mass_option(cue, file, weight)
    return with_options(Scene(drawn), file, {**options, "shaft_mass": None})


def sets_tip(options: dict[str, Any]) -> bool:
    """Whether options set the game or the leather tip."""
    has_leather_option = next(_options(options, _is_leather), None) is not None
    return options.get("game") is not None or has_leather_option


def with_options(scene: Scene, file: Path, options: dict[str, Any]) -> Scene:
    """The scene with the values of the command's options."""
    changes = _changes(scene, file, options)
    try:
        return with_values_at(scene, changes) if changes else scene
    except OutOfBounds as error:
        if not error.name.endswith("cue.body_mass") or options.get("body_mass") is None:
            raise InputError(file, "", str(error)) from None
        bounds = error.bounds.bounds_in(error.bounds.unit)
        raise InputError(file, "--body-mass", f"must be {bounds}{error.reason}; got {options['body_mass']}") from None
    except ValueError as error:
        raise InputError(file, "", str(error)) from None


def _is_leather(known: Parameter) -> bool:
    return known.path.startswith("leather.")


def _options(options: dict[str, Any], which: Callable[[Parameter], bool] = lambda known: True) -> Iterator[Parameter]:
    """The parameters that options set."""
    return (
        known for known in PARAMETERS.values() if known.option and options.get(known.key) is not None and which(known)
    )


def _changes(
    scene: Any, file: Path, options: dict[str, Any], which: Callable[[Parameter], bool] = lambda known: True
) -> dict[Steps, Any]:
    """The values of options, by their paths."""
    changes = dict[Steps, Any]()
    for known in _options(options, which):
        text, path = options[known.key], known.steps()
        try:
            wanted = known.quantity(scene)
        except ValueError:
            raise InputError(file, option(known.key), _absent(scene, known)) from None
        changes |= known.named_value(text)
        changes[path] = (
            offset_value(file, text, float(scene.ball.radius))
            if known.key == "offset"
            else option_value(file, option(known.key), text, wanted)
        )
    return changes


def _absent(scene: Scene, known: Parameter) -> str:
    """Why a scene has no such parameter, for an error."""
    if _is_leather(known):
        return "does not apply: the scene has no LeatherTip among its effects"
    return NO_SHAFT if scene.lumped else f"does not apply: the scene has no {known.label}"


def reject_game(file: Path, options: dict[str, Any]) -> None:
    """Reject a game for a scene, which has its own ball, tip and stroke."""
    if options.get("game") is not None:
        raise InputError(file, "--game", "does not apply: FILE is a scene, which has its own ball, tip and stroke")
