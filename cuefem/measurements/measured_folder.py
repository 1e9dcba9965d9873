"""A measured cue as a folder: the drawing, measured.toml with the measurements, and a CSV for each long series."""

from __future__ import annotations

import io
import math
import os
import re
import struct
import warnings
from collections.abc import Iterator, Sequence
from contextlib import suppress
from importlib.resources import files
from pathlib import Path
from typing import Any

from scipy.io import wavfile

from cuefem.files import InputError, load, write_folder_atomically
from cuefem.files.csv_reader import decimal_mark, is_number, python_number, read_table, read_text, split_unit
from cuefem.files.cue_names import matching_names, named_path
from cuefem.files.defaults_report import Assumption, assumptions_of_tables, offered_assumptions
from cuefem.files.errors import as_input_error, check_path, quote, read_bytes, suggestion
from cuefem.files.schema import build, field_types, key_path, member_types, unknown_key
from cuefem.files.toml_reader import GAME_KEYS, game_of, missing_keys, read_tables, scene_from_tables
from cuefem.measurements.measured_cue import MeasuredCue
from cuefem.measurements.measurement_types import (
    ELEVATION,
    ELEVATION_SPREAD,
    MEASUREMENT_TYPES,
    BallDirection,
    Measurement,
    Setup,
    Tone,
)
from cuefem.measurements.recording import Recording, combine_tones, tones_in
from cuefem.measurements.shot import Shot
from cuefem.measurements.uncertain_parameters import Prior
from cuefem.parameters.scene_paths import parameter
from cuefem.quantity.display_units import with_unit
from cuefem.quantity.fields import Quantity, quantity_of
from cuefem.scene import Scene

MEASURED = "measured.toml"
DRAWINGS = ("cue.toml", "cue.csv")
SCENE_KEYS = ("cue", "game", "ball", "tip", "stroke", "effects")
OWN_KEYS = ("name", "source", "prior")
WAV_HEAD = 12  # bytes before the chunks of a .wav file
READINGS: dict[str, type] = {"recording": Recording, "shot": Shot}  # tables that yield measurements
LONGEST, LARGEST_SOUND = 120.0, 100_000_000  # s, bytes of a recording: 120 s of two channels at 96 kHz and 32 bits
TEMPLATE = ("README.md", "cue.toml", MEASURED)
BLANK = "?"  # begins a value of the template that is to be filled in
EXAMPLES = {"speed": '"3.5 m/s" or "8 mph"', "distance": '"0.9 m" or "3 ft"', "elevation": '"2 deg"'}

_COLUMN = re.compile(r"\s*([a-z_]+)\s*(?:\[([^\]]+)\])?\s*")


def load_measured(folder: Path) -> tuple[MeasuredCue, list[Assumption]]:
    """Load the measured cue of a folder, and the assumptions for its drawing; InputError for invalid files."""
    folder = named_folder(folder)
    if not folder.is_dir():
        raise InputError(
            folder, "", "must be a measured cue: its folder (`--template` creates one) or its name; got no folder"
        )
    path = folder / MEASURED
    tables = read_tables(path) if path.exists() else {}
    known = [*OWN_KEYS, *SCENE_KEYS, *MEASUREMENT_TYPES, *READINGS]
    for name in tables:
        if name not in known:
            raise unknown_key(name, known, file=str(path), key="")
    scene, notes = _scene(folder, path, tables)
    measurements = (*_measurements(folder, path, tables), *_readings(folder, path, tables, scene))
    priors = tuple(_priors(path, tables, scene))
    name, source = (_text(path, tables, key) for key in ("name", "source"))
    with as_input_error(path, ""):
        made = MeasuredCue(name or folder.resolve().name, scene, measurements, priors, source)
    return made, [*notes, *_assumed_elevation(measurements)]


def _assumed_elevation(measurements: Sequence[Measurement]) -> list[Assumption]:
    """The elevation of readings at a distance that state none."""
    read = [each for each in measurements if isinstance(each, BallDirection) and each.distance is not None]
    if all(each.elevation is not None for each in read):
        return []
    low, high = (with_unit(ELEVATION * math.exp(sign * ELEVATION_SPREAD), "rad", decimals=1) for sign in (-1, 1))
    return [Assumption("", f"elevation of the cue {low} to {high} (elevation in {MEASURED})")]


def named_folder(folder: Path) -> Path:
    """The folder, or that of the measured cue which it names; the drawing of a named cue that nobody measured."""
    check_path(folder)
    if os.path.exists(folder) or not matching_names(folder):
        return folder
    drawing = named_path(folder)
    return drawing.parent if (drawing.parent / MEASURED).is_file() else drawing


def write_template(folder: Path) -> None:
    """Create a folder with example files of a measured cue; InputError if it exists."""

    def write(temporary: Path) -> None:
        for name in TEMPLATE:
            (temporary / name).write_text(_example(name), encoding="utf-8")

    write_folder_atomically(folder, write)


def _example(name: str) -> str:
    """A file of the template."""
    return files(__package__).joinpath("measured_template", name).read_text(encoding="utf-8")


def _text(path: Path, tables: dict[str, Any], key: str) -> str:
    value = tables.get(key, "")
    if not isinstance(value, str):
        raise InputError(path, key, f"must be text; got {quote(value)}")
    return value


def _scene(folder: Path, path: Path, tables: dict[str, Any]) -> tuple[Scene, list[Assumption]]:
    """The scene, and the assumptions for it: ball, tip, stroke and effects default to those of the game, or of pool."""
    parts = {key: tables[key] for key in SCENE_KEYS if key in tables}
    if "cue" not in parts:
        there = [name for name in DRAWINGS if (folder / name).exists()]
        if len(there) != 1:
            got = "both: delete the one that is not your drawing" if there else "none"
            raise InputError(folder, "", f"must contain the shaft's drawing, {' or '.join(DRAWINGS)}; got {got}")
        parts["cue"] = there[0]
        if there[0] in TEMPLATE and read_text(folder / there[0]) == _example(there[0]):
            raise InputError(folder / there[0], "", "must be replaced by your drawing; got the example of the template")
    present = {*GAME_KEYS, "effects"} & {*parts}
    if not present or missing_keys(parts) == ["stroke.offset"]:  # every measurement has its own offset
        parts["game"] = game_of(parts, path)
    scene = scene_from_tables(parts, path, _drawing)
    if scene.lumped is not None:
        raise InputError(path, "cue", "must be a cue of segments; got a lumped cue")
    return scene, offered_assumptions(assumptions_of_tables(parts, folder, scene, {"offset": None}))


def _drawing(path: Path) -> Any:
    drawing = load(path)
    if isinstance(drawing, Scene):
        raise InputError(path, "cue", "must be absent: this file is the drawing; ball and tip belong in " + MEASURED)
    return drawing


def _measurements(folder: Path, path: Path, tables: dict[str, Any]) -> Iterator[Measurement]:
    for key, kind in MEASUREMENT_TYPES.items():
        yield from _rows(path, tables, key, kind)
        series = folder / f"{key}.csv"
        if series.exists():
            yield from _series(series, kind)
    names = [f"{key}.csv" for key in MEASUREMENT_TYPES]
    drawing = folder / str(tables.get("cue", ""))
    for other in sorted(folder.iterdir()):
        if other.suffix.lower() == ".csv" and other.name not in (*DRAWINGS, *names) and other != drawing:
            raise InputError(other, "", f"must be one of {', '.join(names)}{suggestion(other.name, names)}")


def _tables(path: Path, tables: dict[str, Any], key: str) -> list[dict[str, Any]]:
    """The tables [[key]]."""
    rows = tables.get(key, [])
    if not isinstance(rows, list) or not all(isinstance(row, dict) for row in rows):
        raise InputError(path, key, f"must be tables, [[{key}]]; got {quote(rows)}")
    return rows


def _rows(path: Path, tables: dict[str, Any], key: str, kind: type[Any]) -> Iterator[Any]:
    """The objects of the tables [[key]]."""
    for i, row in enumerate(_tables(path, tables, key)):
        _reject_blanks(path, key_path(key, i), row)
        yield build(kind, row, file=str(path), key=key_path(key, i))


def _reject_blanks(path: Path, key: str, row: dict[str, Any]) -> None:
    """InputError for a value of the template that is not filled in."""
    for name, value in row.items():
        if isinstance(value, str) and value.startswith(BLANK):
            example = EXAMPLES.get(name, '"40 mm" or "1.6 in"')
            raise InputError(path, key_path(key, name), f'must be filled in, such as {example}; got "{value}"')


def _readings(folder: Path, path: Path, tables: dict[str, Any], scene: Scene) -> Iterator[Measurement]:
    """Measurements from shots and recordings: squirts, and one tone for each mode in the recordings."""
    for i, shot in enumerate(_rows(path, tables, "shot", Shot)):
        with as_input_error(path, key_path("shot", i)):
            yield shot.squirt(scene)
    tones: list[Tone] = []
    for recording in _rows(path, tables, "recording", Recording):
        sound = folder / recording.file
        with as_input_error(sound, ""):
            samples, rate = _sound(sound)
            source = recording.source or recording.file
            tones += tones_in(samples, rate, Setup(scene).predictions.frequencies, source)
    yield from combine_tones(tones)


def _sound(path: Path) -> tuple[Any, float]:
    """Samples, (n, channels), and samples per second of a .wav file; InputError if it cannot be read."""
    if path.suffix.lower() != ".wav":
        raise InputError(path, "", f"must end in .wav; got {path.suffix!r} (ffmpeg -i tap.m4a tap.wav converts)")
    content = _with_data_size(read_bytes(path, LARGEST_SOUND))
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", wavfile.WavFileWarning)  # for chunks of metadata that phones add
            rate, samples = wavfile.read(io.BytesIO(content))
    except (ValueError, TypeError, ArithmeticError, MemoryError, struct.error, UnboundLocalError) as error:
        detail = "" if isinstance(error, UnboundLocalError) else f" ({error})"  # raised for a file without data
        raise InputError(path, "", f"must be a .wav file of sound{detail}") from None
    if samples.size == 0 or not 0 < len(samples) <= LONGEST * rate:
        raise InputError(path, "", f"must last at most {LONGEST:g} s and contain samples; got {len(samples)} samples")
    return samples.reshape(len(samples), -1).astype(float), float(rate)


def _with_data_size(content: bytes) -> bytes:
    """The .wav file with the size of its data where a program that did not know it wrote 0 or too much."""
    at = content.find(b"data", WAV_HEAD)
    if content[:4] != b"RIFF" or at < 0:
        return content
    start = at + 8
    size, present = int.from_bytes(content[at + 4 : start], "little"), len(content) - start
    if 0 < size <= present:
        return content
    sizes = [(whole - whole % 2).to_bytes(4, "little") for whole in (len(content) - 8, present)]
    return content[:4] + sizes[0] + content[8 : at + 4] + sizes[1] + content[start:]


def _series(path: Path, kind: type) -> Iterator[Measurement]:
    """The measurements of a CSV: one column per key, its unit in the heading; empty cells are skipped."""
    rows = read_table(path)
    if not rows:
        raise InputError(path, "", "must begin with a line of headings; got comments alone")
    (first, headings), *others = rows
    columns = [_column(path, first, heading, kind) for heading in headings]
    names = [name for name, _ in columns]
    for name in names:
        if names.count(name) > 1:
            raise InputError(path, f"line {first}, {name}", f"must be in one column; got {names.count(name)}")
    hints = field_types(kind)
    numeric = [i for i, name in enumerate(names) if quantity_of(hints[name])]
    mark = decimal_mark([cells[i] for _, cells in others for i in numeric if i < len(cells) and is_number(cells[i])])
    for line, cells in others:
        if len(cells) != len(columns):
            raise InputError(path, f"line {line}", f"must have {len(columns)} cells, one per heading; got {len(cells)}")
        table = {}
        for (name, unit), cell in zip(columns, cells, strict=True):
            with as_input_error(path, key_path(f"line {line}", name)):
                if cell:
                    table[name] = _cell(cell, unit, hints[name], mark)
        yield build(kind, table, file=str(path), key=f"line {line}")


def _column(path: Path, line: int, heading: str, kind: type) -> tuple[str, str]:
    """Key and unit of a heading such as "value [deg]"."""
    match, hints = _COLUMN.fullmatch(heading), field_types(kind)
    if not match or match[1] not in hints:
        hint = suggestion(heading.partition("[")[0].strip(), hints)
        raise InputError(path, f"line {line}", f"must have headings {', '.join(hints)}; got {quote(heading)}{hint}")
    name, unit, mark = match[1], match[2] or "", quantity_of(hints[match[1]])
    wanted = mark.unit if mark else ""
    if bool(wanted) != bool(unit):
        example = f'"{name} [{wanted}]"' if wanted else f'"{name}"'
        raise InputError(path, f"line {line}, {name}", f"must be the heading {example}; got {quote(heading)}")
    return name, unit


def _cell(cell: str, unit: str, hint: Any, mark: str) -> Any:
    """The value of a cell as in a TOML file: a text with its unit, a number, or text. mark: of the decimals."""
    if quantity_of(hint) and is_number(cell):
        cell = python_number(split_unit(cell)[0], mark)
    if unit:
        return f"{cell} {unit}"
    with suppress(ValueError):
        return int(cell) if int in member_types(hint) else float(cell) if quantity_of(hint) else cell
    return cell


def _priors(path: Path, tables: dict[str, Any], scene: Scene) -> Iterator[Prior]:
    """The [[prior]] tables; low and high have the unit of the parameter."""
    for i, row in enumerate(_tables(path, tables, "prior")):
        key, name, read = key_path("prior", i), row.get("name"), dict(row)
        with as_input_error(path, key):
            known = parameter(name) if isinstance(name, str) else None
            unit = known.quantity(scene).unit if known and {"low", "high"} & {*row} else ""
        for end in [end for end in ("low", "high") if known and end in row]:
            with as_input_error(path, key_path(key, end)):
                read[end] = Quantity(unit, "(0, inf)").read(row[end])
        yield build(Prior, read, file=str(path), key=key)
