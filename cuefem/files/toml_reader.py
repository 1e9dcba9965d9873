"""Reader of cues and scenes as TOML: `[[segments]]` makes a cue, `[cue]` (a table or a path) a scene.

Ball, tip, stroke and effects default to those of the scene's `game`, by default pool.
"""

from __future__ import annotations

import datetime
import re
import tomllib
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any

from cuefem.cue import Cue, LumpedCue
from cuefem.effects.effect import Effect, effect_kinds
from cuefem.files.csv_reader import read_text
from cuefem.files.errors import InputError, as_input_error, errors_name_key, quote, suggestion
from cuefem.files.parts_catalogue import catalogue_shaft
from cuefem.files.schema import build, key_path, keys_of, table, unknown_key
from cuefem.files.shaft_additions import with_additions
from cuefem.parameters.parts import with_shaft_mass
from cuefem.quantity.fields import MAX_SEGMENTS, Quantity, check_fields, quantity_fields
from cuefem.scene import Scene, Stroke
from cuefem.scene.default_scene import (
    DEFAULT_GAME,
    GAMES,
    KIM,
    STROKES,
    StrokeName,
    stroke_name,
    usual_scene,
    with_usual_rest,
)

# Keys of a scene that default to those of its game.
GAME_KEYS = {"ball": ("mass", "radius"), "tip": ("restitution", "friction"), "stroke": ("speed", "offset")}


LONGEST_LINE = 80  # characters, on a customer's sheet
MAX_KEY_PARTS = 32  # of a dotted key, such as 3 of cue.segments.length
_LONG_KEY = re.compile(rf"(?<![\w-])(?:[\w-]+\s*\.\s*){{{MAX_KEY_PARTS},}}")
_QUOTED = re.compile(r"""\"(?:[^"\\]|\\.)*\"|'[^']*'""")


@dataclass(frozen=True)
class ShaftParts:
    """The parts of a cue from the catalogue, instead of [[segments]]."""

    shaft: str
    material: str | None = None
    ferrule: str | None = None
    bore: str | None = None


@dataclass(frozen=True)
class Accuracy:
    """The requested accuracy of a command: rtol, relative; not a part of the scene."""

    rtol: Annotated[float, Quantity("", "(0, 1)")]

    def __post_init__(self) -> None:
        check_fields(self)


@dataclass(frozen=True)
class Order:
    """Whom a cue is made for: what a customer's sheet says of the order.

    Parameters
    ----------
    customer, serial : str
        At most 80 characters each.
    date : str or datetime.date
        By default that of the page.
    """

    customer: str = ""
    serial: str = ""
    date: str | datetime.date = ""

    def __post_init__(self) -> None:
        check_lines(self)


def check_lines(thing: Any) -> None:
    """ValueError for a text of a dataclass that is longer than a line of a sheet."""
    for name, text in vars(thing).items():
        if isinstance(text, str) and len(text) > LONGEST_LINE:
            raise ValueError(
                f"{type(thing).__name__}.{name} must have at most {LONGEST_LINE} characters; got {len(text)}"
            )


def read_tables(path: Path) -> dict[str, Any]:
    """A TOML file as plain tables; InputError if it is not TOML."""
    text = read_text(path)
    _check_keys_are_short(text, path)
    try:
        return tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        raise InputError(path, "", f"must be TOML; got a syntax error: {error}{_unquoted(text, str(error))}") from None
    except RecursionError:
        raise InputError(path, "", "must be TOML nested less deeply") from None


def _check_keys_are_short(text: str, path: Path) -> None:
    """InputError for a key of more than `MAX_KEY_PARTS` parts: tomllib's memory grows like their square."""
    for number, line in enumerate(text.splitlines(), start=1):
        chain = _LONG_KEY.search(_QUOTED.sub("quoted", line).partition("#")[0])
        if chain:
            problem = f"must have keys of at most {MAX_KEY_PARTS} parts; got one of {chain[0].count('.') + 1}"
            raise InputError(path, f"line {number}", problem)


def _unquoted(text: str, error: str) -> str:
    """A hint for a table of an array in single brackets, and for an unquoted value with a unit."""
    if twice := re.search(r"declare \('(vary|limit|segments|effects)',\) twice", error):
        return f"; write [[{twice[1]}]] with double brackets"
    match = re.search(r"at line (\d+)", error)
    line = text.splitlines()[int(match[1]) - 1] if match else ""
    return "; put a value with a unit in quotes" if re.search(r"=\s*[-+.\d]+\s*[^\W\d_]", line) else ""


def other_tables(path: Path) -> dict[str, Any]:
    """The tables of a cue's or a scene's file that are of neither: whom it is made for, and how finely it is computed.

    Who changes the cue and writes it to another file writes them too.
    """
    tables = read_tables(path) if path.suffix.lower() == ".toml" else {}
    return {name: tables[name] for name in ("accuracy", "order") if name in tables}


def _without_order(path: Path) -> dict[str, Any]:
    """The tables of a cue or a scene; its [order], which is for a customer's sheet, is checked."""
    tables = read_tables(path)
    build(Order, tables.pop("order", {}), file=str(path), key="order")
    return tables


def load_toml(path: Path, cue_file: Callable[[Path], Cue]) -> Cue | Scene:
    """Load the cue or scene of a TOML file; ``cue_file`` loads the cue file of a scene."""
    tables = _without_order(path)
    if "scene" in tables and "cue" not in tables:
        raise InputError(path, "scene", "must be a cue or a scene; got a study: `cuefem study`, cuefem.study(file)")
    if {"segments", "shaft"} & {*tables} and "cue" not in tables:
        return _cue(tables, path, "")
    return scene_from_tables(tables, path, cue_file)


def cue_as_drawn(path: Path, cue_file: Callable[[Path], Cue]) -> Cue | LumpedCue:
    """The drawn cue of a scene's file, with the leather that a `LeatherTip` replaces in the scene."""
    return _scene_cue(read_tables(path)["cue"], path, cue_file)


def load_cue(path: Path) -> Cue:
    """Load the cue of a TOML file; InputError for a scene."""
    tables = _without_order(path)
    if "cue" in tables:
        raise InputError(path, "cue", "must be absent: the cue of a scene is a cue file with [[segments]]; got a scene")
    return _cue(tables, path, "")


def load_accuracy(path: str | Path) -> float | None:
    """The relative accuracy rtol of a scene file's [accuracy] table; None without one."""
    path = Path(path)
    tables = read_tables(path) if path.suffix.lower() == ".toml" else {}
    return _accuracy(tables.get("accuracy"), path)


def _accuracy(table: Any, path: Path) -> float | None:
    return None if table is None else build(Accuracy, table, file=str(path), key="accuracy").rtol


def _cue(table: dict[str, Any], path: Path, key: str) -> Cue:
    if "shaft" in table:
        table = _assembled(table, path, key)
    segments = table.get("segments")
    if isinstance(segments, list) and len(segments) > MAX_SEGMENTS:
        problem = f"must have at most {MAX_SEGMENTS} segments; got {len(segments)}"
        raise InputError(path, key_path(key, "segments"), problem)
    weight = table.get("shaft_mass")
    without = {name: value for name, value in table.items() if name != "shaft_mass"}
    cue = build(Cue, without, file=str(path), key=key)
    if weight is None:
        return cue
    with as_input_error(path, key_path(key, "shaft_mass")):
        return with_shaft_mass(cue, Quantity("kg", "(0, 100]").read(weight))


def _assembled(cue_table: dict[str, Any], path: Path, key: str) -> dict[str, Any]:
    """A cue's table with the segments of a shaft of the catalogue instead of its parts."""
    named = {name: cue_table[name] for name in keys_of(ShaftParts) if name in cue_table}
    parts = build(ShaftParts, named, file=str(path), key=key)
    if "segments" in cue_table:
        raise InputError(path, key_path(key, "segments"), "must be omitted with shaft, which defines them")
    with as_input_error(path, key_path(key, "shaft")):
        cue = catalogue_shaft(parts.shaft, load_cue)
        cue = with_additions(cue, material=parts.material, ferrule=parts.ferrule, bore=parts.bore)
    rest = {name: value for name, value in cue_table.items() if name not in named}
    return rest | {"segments": [*cue.segments]}


def scene_from_tables(tables: dict[str, Any], path: Path, cue_file: Callable[[Path], Cue]) -> Scene:
    """A scene from a file's tables; ``cue_file`` loads its cue file."""
    _check_keys(tables, [*keys_of(Scene), "game", "accuracy"], path)
    if "cue" not in tables:
        raise InputError(path, "cue", "must be given: [[segments]] make a cue, [cue] a scene; got neither")
    game = game_of(tables, path)
    parts = _parts({name: value for name, value in tables.items() if name != "game"}, path, cue_file)
    if game != KIM:
        is_body_mass_given = isinstance(tables["cue"], dict) and "body_mass" in tables["cue"]
        parts = _completed(parts, game, path, is_body_mass_given=is_body_mass_given)
    scene = build(Scene, parts, file=str(path), key="")
    _check_effects(scene, path)
    return scene


def game_of(tables: dict[str, Any], path: Path) -> StrokeName:
    """The game of a file's tables, by default pool."""
    game = tables.get("game", DEFAULT_GAME)
    if game not in STROKES:
        hint = suggestion(game, STROKES) if isinstance(game, str) else ""
        raise InputError(path, "game", f"must be one of {', '.join(STROKES)}; got {quote(game)}{hint}")
    return stroke_name(game)


def missing_keys(tables: dict[str, Any]) -> list[str]:
    """The missing keys of a scene's tables, which default to those of the game."""
    missing = [
        f"{part}.{name}"
        for part, names in GAME_KEYS.items()
        for name in names
        if not isinstance(tables.get(part, {}), dict) or name not in tables.get(part, {})
    ]
    return missing + ["effects"] * ("effects" not in tables)


def _completed(parts: dict[str, Any], game: StrokeName, path: Path, *, is_body_mass_given: bool) -> dict[str, Any]:
    """The fields of a scene, completed from a game; a spring tip and a lumped cue get no leather tip."""
    known, cue, tip = GAMES[game], parts["cue"], parts.get("tip", {})
    if isinstance(cue, Cue) and not is_body_mass_given:
        cue = with_usual_rest(cue, game)
        parts = parts | {"cue": cue}
    if "effects" not in parts and isinstance(cue, LumpedCue):
        parts = parts | {"effects": []}
    elif "effects" not in parts and isinstance(tip, dict) and {"contact_time", "stiffness"} & {*tip}:
        parts = parts | {"effects": [*known.effects]}
    elif "effects" not in parts:
        with as_input_error(path, ""):
            default = usual_scene(cue, game)
        parts = parts | {"cue": default.cue, "effects": [*default.effects]}
    of_game = known.ball, known.tip_with(parts["effects"]), Stroke(known.speed, known.offset)
    for name, default_part in zip(GAME_KEYS, of_game, strict=True):
        in_file = parts.get(name, {})
        if isinstance(in_file, dict):
            parts = parts | {name: table(default_part) | in_file}
    return parts


def _check_keys(table: dict[str, Any], names: list[str], path: Path) -> None:
    unknown = [name for name in table if name not in names]
    if unknown:  # misspelt keys first: for [[segment]] and body_mass, report segment
        name = next((name for name in unknown if suggestion(name, ["segments", *names])), unknown[0])
        raise unknown_key(name, ["segments", *names], file=str(path), key="")


def _parts(tables: dict[str, Any], path: Path, cue_file: Callable[[Path], Cue]) -> dict[str, Any]:
    """The fields of a scene: its tables, with cue and effects as objects."""
    _accuracy(tables.get("accuracy"), path)
    parts = {name: value for name, value in tables.items() if name != "accuracy"}
    parts["cue"] = _scene_cue(tables["cue"], path, cue_file)
    effects = tables.get("effects")
    if isinstance(effects, list):
        parts["effects"] = [_effect(e, path, key_path("effects", i)) for i, e in enumerate(effects)]
    return parts


def _check_effects(scene: Scene, path: Path) -> None:
    """InputError for an effect at a position off the cue."""
    for i, effect in enumerate(scene.effects):
        if scene.lumped is None:
            try:
                effect.check_on(scene.shaft, key_path("effects", i))
            except ValueError as error:
                key, _, problem = str(error).partition(" ")
                raise InputError(path, key, problem) from None


def _scene_cue(cue: Any, path: Path, cue_file: Callable[[Path], Cue]) -> Cue | LumpedCue:
    if isinstance(cue, str):
        with errors_name_key(path, "cue"):
            return cue_file(path.parent / cue)
    if not isinstance(cue, dict):
        raise InputError(path, "cue", f"must be a table or the path of a cue file; got {quote(cue)}")
    lumped = {"mass", "end_mass"} & set(cue) and not {"segments", "shaft"} & set(cue)
    return build(LumpedCue, cue, file=str(path), key="cue") if lumped else _cue(cue, path, "cue")


def _effect(table: Any, path: Path, key: str) -> Effect:
    kinds = effect_kinds()
    names = ", ".join(kinds)
    if not isinstance(table, dict) or "type" not in table:
        got = "nothing" if isinstance(table, dict) else quote(table)
        raise InputError(path, key_path(key, "type"), f"must be one of {names}; got {got}")
    name = table["type"]
    if not isinstance(name, str) or name not in kinds:
        problem = f"must be one of {names}; got {quote(name)}{suggestion(str(name), kinds)}"
        raise InputError(path, key_path(key, "type"), problem)
    rest = {field: value for field, value in table.items() if field != "type"}
    return build(kinds[name], _with_presets(kinds[name], rest, path, key), file=str(path), key=key)


def _with_presets(kind: type[Effect], table: dict[str, Any], path: Path, key: str) -> dict[str, Any]:
    """The table with the fields that a preset sets instead of its name, such as the hardness of a leather."""
    quantities = {name: quantity for name, quantity, *_ in quantity_fields(kind)}  # type: ignore[arg-type]
    for preset, names in kind.presets.items():
        expected = f"must be one of {', '.join(names)}"
        set_fields = [*dict.fromkeys(name for values in names.values() for name in values)]
        preset_key, first = key_path(key, preset), set_fields[0]
        if preset not in table:
            if first not in table and set(table) <= {*keys_of(kind)}:  # a misspelt key is reported first
                raise InputError(path, preset_key, f"{expected}, or give {first} instead; got nothing")
            continue
        chosen = table[preset].casefold() if isinstance(table[preset], str) else table[preset]
        if not isinstance(chosen, str) or chosen not in names:
            raise InputError(path, preset_key, f"{expected}; got {quote(chosen)}{suggestion(str(chosen), names)}")
        if twice := [name for name in set_fields if name in table]:
            raise InputError(path, key_path(key, twice[0]), f"must be omitted with {preset}, which sets it")
        rest = {name: value for name, value in table.items() if name != preset}
        table = rest | {name: quantities[name].as_text(value) for name, value in names[chosen].items()}
    return table
