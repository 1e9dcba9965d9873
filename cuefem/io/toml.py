"""Cues and scenes as TOML: `[[segments]]` at the top is a cue, `[cue]` (a table, or the path of a cue file) a scene.

What a scene leaves out of ball, tip, stroke and effects is that of its `game`, which is pool where none is named.
A scene with a `[striker]` is a strike from the side (`SideStrike`).
"""

from __future__ import annotations

import re
import tomllib
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any

from cuefem.contact.side_strike import SideStrike
from cuefem.cue import Cue, LumpedCue, Material
from cuefem.cue.materials import material
from cuefem.effects import Effect, effect_kinds
from cuefem.io.cells import read_text
from cuefem.io.errors import InputError, faults_of, nearest, shown
from cuefem.io.schema import build, joined, keys_of, table, unknown_key
from cuefem.io.shelf import assembled
from cuefem.parameters.parts import with_shaft_mass
from cuefem.quantity.fields import MOST_SEGMENTS, Quantity, check_fields, quantities
from cuefem.scene import Scene, Stroke
from cuefem.scene.default_scene import DEFAULT_GAME, GAMES, KIM, STROKES, usual_scene

# What a scene's tables leave to its game.
OF_GAME = {"ball": ("mass", "radius"), "tip": ("restitution", "friction"), "stroke": ("speed", "offset")}


@dataclass(frozen=True)
class ShaftParts:
    """The parts of which a cue is put together instead of [[segments]]."""

    shaft: str
    material: str | None = None
    ferrule: str | None = None
    bore: str | None = None


@dataclass(frozen=True)
class Accuracy:
    """How exact a command's answer shall be: rtol, relative; no part of the scene."""

    rtol: Annotated[float, Quantity("", "(0, 1)")]

    def __post_init__(self) -> None:
        check_fields(self)


def read_tables(path: Path) -> dict[str, Any]:
    """A TOML file as plain tables."""
    text = read_text(path)
    try:
        return tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        raise InputError(path, "", f"must be TOML; got a syntax error: {error}{_unquoted(text, str(error))}") from None
    except RecursionError:
        raise InputError(path, "", "must be TOML nested less deeply") from None


def _unquoted(text: str, error: str) -> str:
    """A hint if the line of a syntax error has a value with a unit and no quotes."""
    match = re.search(r"at line (\d+)", error)
    line = text.splitlines()[int(match[1]) - 1] if match else ""
    return "; put a value with a unit in quotes" if re.search(r"=\s*[-+.\d]+\s*[^\W\d_]", line) else ""


def load_toml(path: Path, cue_file: Callable[[Path], Cue]) -> Cue | Scene | SideStrike:
    """The cue or scene of a TOML file; ``cue_file`` loads the cue file that a scene names."""
    tables = read_tables(path)
    if {"segments", "shaft"} & {*tables} and "cue" not in tables:
        return _cue(tables, path, "")
    if "striker" in tables:
        return _side_strike(tables, path, cue_file)
    return scene_of_tables(tables, path, cue_file)


def drawn_cue(path: Path, cue_file: Callable[[Path], Cue]) -> Cue | LumpedCue:
    """The cue of a scene's file as it is drawn, with the leather that a `LeatherTip` replaces in the scene."""
    return _scene_cue(read_tables(path)["cue"], path, cue_file)


def load_cue(path: Path) -> Cue:
    """The cue of a TOML file that must not be a scene."""
    tables = read_tables(path)
    if "cue" in tables:
        raise InputError(
            path, "cue", "must be absent here: a scene's cue is a cue file, with [[segments]]; got a scene"
        )
    return _cue(tables, path, "")


def load_accuracy(path: str | Path) -> float | None:
    """The relative accuracy rtol that a scene file's [accuracy] table asks for; None if there is no such table."""
    path = Path(path)
    tables = read_tables(path) if path.suffix.lower() == ".toml" else {}
    return _accuracy(tables.get("accuracy"), path)


def _accuracy(table: Any, path: Path) -> float | None:
    return None if table is None else build(Accuracy, table, file=str(path), key="accuracy").rtol


def _cue(table: dict[str, Any], path: Path, key: str) -> Cue:
    if "shaft" in table:
        table = _of_parts(table, path, key)
    segments = table.get("segments")
    if isinstance(segments, list):
        if len(segments) > MOST_SEGMENTS:
            problem = f"must hold at most {MOST_SEGMENTS} segments; got {len(segments)}"
            raise InputError(path, joined(key, "segments"), problem)
        within = joined(key, "segments")
        table = {**table, "segments": [_segment(s, path, joined(within, i)) for i, s in enumerate(segments)]}
    weight = table.get("shaft_mass")
    without = {name: value for name, value in table.items() if name != "shaft_mass"}
    cue = build(Cue, without, file=str(path), key=key)
    if weight is None:
        return cue
    with faults_of(path, joined(key, "shaft_mass")):
        return with_shaft_mass(cue, Quantity("kg", "(0, 100]").read(weight))


def _of_parts(cue_table: dict[str, Any], path: Path, key: str) -> dict[str, Any]:
    """A cue's table whose shaft is one of the shelf, with its segments instead of the parts that it names."""
    told = {name: cue_table[name] for name in keys_of(ShaftParts) if name in cue_table}
    parts = build(ShaftParts, told, file=str(path), key=key)
    if "segments" in cue_table:
        raise InputError(path, joined(key, "segments"), "must be left out beside shaft, which draws them")
    with faults_of(path, joined(key, "shaft")):
        cue = assembled(parts.shaft, load_cue, material=parts.material, ferrule=parts.ferrule, bore=parts.bore)
    rest = {name: value for name, value in cue_table.items() if name not in told}
    return rest | {"segments": [*cue.segments]}


def _segment(table: Any, path: Path, key: str) -> Any:
    """A segment's table with the names of materials looked up."""
    if not isinstance(table, dict):
        return table
    named = {name: table[name] for name in ("material", "core") if isinstance(table.get(name), str)}
    return table | {name: named_material(value, path, joined(key, name)) for name, value in named.items()}


def named_material(name: str, path: Path, key: str) -> Material:
    """A material of the table; InputError that suggests similar names if no material has this one."""
    try:
        return material(name)
    except ValueError as error:
        raise InputError(path, key, f"{error}; see `cuefem parts`") from None


def scene_of_tables(tables: dict[str, Any], path: Path, cue_file: Callable[[Path], Cue]) -> Scene:
    """A scene from a file's tables; ``cue_file`` loads the cue file that it names."""
    _check_keys(tables, [*keys_of(Scene), "game", "accuracy"], path)
    if "cue" not in tables:
        raise InputError(path, "cue", "must be given: [[segments]] make a cue, [cue] a scene; got neither")
    game = game_of(tables, path)
    parts = _parts({name: value for name, value in tables.items() if name != "game"}, path, cue_file)
    scene = build(Scene, parts if game == KIM else _completed(parts, game, path), file=str(path), key="")
    _check_effects(scene, path)
    return scene


def game_of(tables: dict[str, Any], path: Path) -> str:
    """The game that a file's tables name, or pool."""
    game = tables.get("game", DEFAULT_GAME)
    if game not in STROKES:
        hint = nearest(game, STROKES) if isinstance(game, str) else ""
        raise InputError(path, "game", f"must be one of {', '.join(STROKES)}; got {shown(game)}{hint}")
    return str(game)


def left_out(tables: dict[str, Any]) -> list[str]:
    """The keys that a scene's tables leave to its game."""
    missing = [
        f"{part}.{name}"
        for part, names in OF_GAME.items()
        for name in names
        if not isinstance(tables.get(part, {}), dict) or name not in tables.get(part, {})
    ]
    return missing + ["effects"] * ("effects" not in tables)


def _completed(parts: dict[str, Any], game: str, path: Path) -> dict[str, Any]:
    """The fields of a scene with what they leave out filled in from a game.

    A spring tip and a lumped cue take no leather.
    """
    known, cue, tip = GAMES[game], parts["cue"], parts.get("tip", {})
    if "effects" not in parts and isinstance(cue, LumpedCue):
        parts = parts | {"effects": []}
    elif "effects" not in parts and isinstance(tip, dict) and {"contact_time", "stiffness"} & {*tip}:
        parts = parts | {"effects": [*known.effects]}
    elif "effects" not in parts:
        with faults_of(path, ""):
            usual = usual_scene(cue, game)
        parts = parts | {"cue": usual.cue, "effects": [*usual.effects]}
    of_game = known.ball, known.tip_beside(parts["effects"]), Stroke(known.speed, known.offset)
    for name, usual_part in zip(OF_GAME, of_game, strict=True):
        told = parts.get(name, {})
        if isinstance(told, dict):
            parts = parts | {name: table(usual_part) | told}
    return parts


def _check_keys(table: dict[str, Any], names: list[str], path: Path) -> None:
    unknown = [name for name in table if name not in names]
    if unknown:  # a misspelt key first: beside [[segment]], body_mass is not the fault
        name = next((name for name in unknown if nearest(name, ["segments", *names])), unknown[0])
        raise unknown_key(name, table[name], ["segments", *names], file=str(path), key="")


def _parts(tables: dict[str, Any], path: Path, cue_file: Callable[[Path], Cue]) -> dict[str, Any]:
    """The fields of a scene: its tables, with the cue and the effects made."""
    _accuracy(tables.get("accuracy"), path)
    parts = {name: value for name, value in tables.items() if name != "accuracy"}
    parts["cue"] = _scene_cue(tables["cue"], path, cue_file)
    effects = tables.get("effects")
    if isinstance(effects, list):
        parts["effects"] = [_effect(e, path, joined("effects", i)) for i, e in enumerate(effects)]
    return parts


def _side_strike(tables: dict[str, Any], path: Path, cue_file: Callable[[Path], Cue]) -> SideStrike:
    """A strike from the side, which [striker] makes."""
    _check_keys(tables, keys_of(SideStrike), path)
    if "cue" not in tables:
        raise InputError(path, "cue", "must be given: a table or the path of a cue file; got nothing")
    parts = _parts(tables, path, cue_file)
    if isinstance(parts["cue"], LumpedCue):
        raise InputError(path, "cue", "must be a cue of segments: a lumped cue has no side; got mass and end_mass")
    return build(SideStrike, parts, file=str(path), key="")


def _check_effects(scene: Scene, path: Path) -> None:
    """Refuse what only the cue can say: an effect at a position off it."""
    for i, effect in enumerate(scene.effects):
        if scene.lumped is None:
            try:
                effect.check_on(scene.shaft, joined("effects", i))
            except ValueError as error:
                key, _, problem = str(error).partition(" ")
                raise InputError(path, key, problem) from None


def _scene_cue(cue: Any, path: Path, cue_file: Callable[[Path], Cue]) -> Cue | LumpedCue:
    if isinstance(cue, str):
        try:
            return cue_file(path.parent / cue)
        except InputError as error:
            if error.key:  # a fault inside the cue file, which has its own key
                raise
            raise InputError(path, "cue", str(error)) from None
    if not isinstance(cue, dict):
        raise InputError(path, "cue", f"must be a table or the path of a cue file; got {shown(cue)}")
    lumped = {"mass", "end_mass"} & set(cue) and not {"segments", "shaft"} & set(cue)
    return build(LumpedCue, cue, file=str(path), key="cue") if lumped else _cue(cue, path, "cue")


def _effect(table: Any, path: Path, key: str) -> Effect:
    kinds = effect_kinds()
    names = ", ".join(kinds)
    if not isinstance(table, dict) or "type" not in table:
        got = "nothing" if isinstance(table, dict) else shown(table)
        raise InputError(path, joined(key, "type"), f"must be one of {names}; got {got}")
    name = table["type"]
    if not isinstance(name, str) or name not in kinds:
        problem = f"must be one of {names}; got {shown(name)}{nearest(str(name), kinds)}"
        raise InputError(path, joined(key, "type"), problem)
    rest = {field: value for field, value in table.items() if field != "type"}
    return build(kinds[name], _spelt_out(kinds[name], rest, path, key), file=str(path), key=key)


def _spelt_out(kind: type[Effect], table: dict[str, Any], path: Path, key: str) -> dict[str, Any]:
    """The table with the fields instead of each word that stands for several, such as the name of a leather."""
    marks = {name: mark for name, mark, *_ in quantities(kind)}  # type: ignore[arg-type]
    for word, names in kind.named.items():
        wanted = f"must be one of {', '.join(names)}"
        meant = [*dict.fromkeys(name for values in names.values() for name in values)]
        here, first = joined(key, word), meant[0]
        if word not in table:
            if first not in table and set(table) <= {*keys_of(kind)}:  # a misspelt key is reported first
                raise InputError(path, here, f"{wanted}, or {first} be given in its place; got nothing")
            continue
        spelt = table[word].casefold() if isinstance(table[word], str) else table[word]
        if not isinstance(spelt, str) or spelt not in names:
            raise InputError(path, here, f"{wanted}; got {shown(spelt)}{nearest(str(spelt), names)}")
        if twice := [name for name in meant if name in table]:
            raise InputError(path, joined(key, twice[0]), f"must be left out beside {word}, which gives it")
        rest = {name: value for name, value in table.items() if name != word}
        table = rest | {name: marks[name].written(value) for name, value in names[spelt].items()}
    return table
