"""Header of a lathe profile: which columns are position, diameter, bore and materials, and their units."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from cuefem.io.csv_reader import Row, is_number, split_unit
from cuefem.io.errors import InputError, quote
from cuefem.quantity.units import first_name, scale

EXAMPLE = '"x [mm],diameter [mm]"'
MAX_TITLES = 20  # lines allowed above the header

POSITION, DIAMETER, RADIUS, BORE, MATERIAL, CORE = "x", "diameter", "radius", "bore", "material", "core"
FERRULE = "ferrule"
NAMES = (MATERIAL, CORE, FERRULE)  # columns of material names, without units
# Words that identify a column, in order of precedence: "bore diameter" is a bore, "diameter at x" a diameter.
_WORDS = {
    CORE: {"core", "kern"},
    MATERIAL: {"material", "materials", "wood"},
    BORE: {"bore", "bored", "inner", "inside", "id", "hole", "hollow", "bohrung"},
    RADIUS: {"radius", "radii", "rad", "r", "halbmesser"},
    DIAMETER: {
        *("diameter", "diameters", "dia", "diam", "d", "ø", "od", "width", "thickness"),
        *("thick", "dicke", "durchmesser", "diamètre", "diametre", "diámetro", "diametro"),
    },
    POSITION: {
        *("x", "z", "position", "pos", "place", "location", "station", "distance", "dist", "length", "along", "from"),
        *("von", "abstand", "länge", "distancia", "posición", "posizione", "distanza"),
    },
}
_OTHERS = ("kg", "g", "oz", "lb", "s", "ms", "n", "deg", "°", "%")  # units that are not lengths
_BRACKETS = re.compile(r"[\[({<]([^])}>]*)[\])}>]")
_TOKENS = re.compile(r"[^\W\d_]+")
_WALL = re.compile(r"wall|wand")  # first letters of a wall thickness
_BUTT = {"butt", "joint"}  # origin of x, after the word "from"


@dataclass(frozen=True)
class ProfileColumn:
    """A used column: its kind, index, name in the file and unit ("" without one)."""

    kind: str
    index: int
    name: str
    unit: str


@dataclass(frozen=True)
class Header:
    """Columns of lengths, of materials and unused ones; the rows; the numbers of lines with titles and notes."""

    line: int
    number_columns: tuple[ProfileColumn, ...]
    name_columns: tuple[ProfileColumn, ...]
    unused_names: tuple[str, ...]
    width: int
    rows: tuple[Row, ...]
    skipped_lines: tuple[int, ...]


def unit_of(text: str) -> str:
    """The unit of length named by a text, by its first name in the table of units; "" without one."""
    word = text.strip().strip(".[](){}<>").strip()
    try:
        scale(word, "m")
    except ValueError:
        return ""
    return first_name(word)


def read_header(path: Path, rows: Sequence[Row]) -> Header:
    """The header of a profile's rows; InputError if no row names a position and a diameter."""
    nearest = rows[0]  # the row that resembles a header most
    for i, (line, cells) in enumerate(rows[:MAX_TITLES]):
        columns = [_column(path, line, j, cell) for j, cell in enumerate(cells)]
        used = tuple(column for column in columns if column.kind and column.kind not in NAMES)
        names = tuple(column for column in columns if column.kind in NAMES)
        kinds = {column.kind for column in used}
        if POSITION in kinds and kinds & {DIAMETER, RADIUS}:
            below = rows[i + 1 :]
            units = [unit_of(cell) for cell in below[0][1]] if below else []
            if units and all(unit or not cell for unit, cell in zip(units, below[0][1], strict=True)):
                used = tuple(_with_unit(column, units) for column in used)
                below = below[1:]
            unused = tuple(column.name for column in columns if column.name and not column.kind)
            if wall := next((name for name in unused if any(map(_WALL.match, _TOKENS.findall(name.casefold())))), None):
                problem = f"column {quote(wall)} is a wall thickness: write a column bore, the diameter less two walls"
                raise InputError(path, f"line {line}", problem)
            noted = tuple(row for row in below if not _has_data(row[1], used, names))
            passed = tuple(number for number, _ in (*rows[:i], *noted))
            return Header(line, used, names, unused, len(cells), tuple(r for r in below if r not in noted), passed)
        if len(cells) > 1 and kinds and nearest == rows[0]:
            nearest = line, cells
        if len(cells) > 1 and all(map(is_number, cells)):
            break
    line, cells = nearest
    wanted = f"must name a column for the position along the shaft and one for the diameter, such as {EXAMPLE}"
    raise InputError(path, f"line {line}", f"{wanted}; got {quote(','.join(cells))}")


def _has_data(cells: Sequence[str], used: Sequence[ProfileColumn], names: Sequence[ProfileColumn]) -> bool:
    """Whether a line has a number or a material in a used column."""
    inside = [[cells[c.index] for c in columns if c.index < len(cells)] for columns in (used, names)]
    return any(split_unit(cell)[0] for cell in inside[0]) or any(inside[1])


def _with_unit(column: ProfileColumn, units: Sequence[str]) -> ProfileColumn:
    unit = units[column.index] if column.index < len(units) else ""
    return ProfileColumn(column.kind, column.index, column.name, column.unit or unit)


def _column(path: Path, line: int, index: int, cell: str) -> ProfileColumn:
    """The column of a header cell; its kind is "" if the column is not used."""
    text = cell.replace("⌀", "ø").replace("Ø", "ø").casefold()
    inside = _BRACKETS.findall(text)
    unit = next(filter(None, map(unit_of, inside)), "")
    words = _TOKENS.findall(_BRACKETS.sub(" ", text) if unit else text)
    for end in (-1, 0):  # "diameter mm", "inches from tip"
        if not unit and len(words) > 1 and (unit := unit_of(words[end])):
            words.pop(end)
    if not unit and text.rstrip().endswith(('"', "″", "”")):
        unit = "in"
    kind = _kind(words)
    if words == ["id"] and not unit:  # a row number, not an inner diameter
        kind = ""
    if kind == BORE and _WORDS[RADIUS] & {*words}:
        raise InputError(path, f"line {line}, {kind}", f"must be a column of diameters; got {quote(cell)}")
    if kind and inside and not unit and inside[0].strip() in _OTHERS:
        problem = f"must be in a unit of length, such as mm; got {quote(inside[0])}"
        raise InputError(path, f"line {line}, {kind}", problem)
    return ProfileColumn(kind, index, cell, unit)


def _kind(words: Sequence[str]) -> str:
    """The kind of a column by the words of its name."""
    if FERRULE in words and {*words} <= {FERRULE, MATERIAL}:  # "distance from ferrule" is a position
        return FERRULE
    if any(map(_WALL.match, words)):
        return ""
    return next((kind for kind, known in _WORDS.items() if known & {*words}), "")


def measured_from_butt(column: ProfileColumn) -> bool:
    """Whether positions count from the butt, by the column's name."""
    words = _TOKENS.findall(column.name.casefold())
    return "from" in words and bool(_BUTT & set(words[words.index("from") :])) and "tip" not in words
