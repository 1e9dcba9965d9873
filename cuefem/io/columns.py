"""The header of a lathe profile, as people write it: which column is the place, which the diameter, in which units."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from cuefem.io.cells import Row, is_number, parted
from cuefem.io.errors import InputError, shown
from cuefem.quantity.units import first_name, scale

EXAMPLE = '"x [mm],diameter [mm]"'
TITLES = 20  # lines that may stand above the header

PLACE, DIAMETER, RADIUS, BORE, MATERIAL, CORE = "x", "diameter", "radius", "bore", "material", "core"
FERRULE = "ferrule"
NAMES = (MATERIAL, CORE, FERRULE)  # columns of names, which have no unit
# The words by which a column is known, most telling first: "bore diameter" is a bore, "diameter at x" a diameter.
_WORDS = {
    CORE: {"core", "kern"},
    MATERIAL: {"material", "materials", "wood"},
    BORE: {"bore", "bored", "inner", "inside", "id", "hole", "hollow", "bohrung"},
    RADIUS: {"radius", "radii", "rad", "r", "halbmesser"},
    DIAMETER: {
        *("diameter", "diameters", "dia", "diam", "d", "ø", "od", "width", "thickness"),
        *("thick", "dicke", "durchmesser", "diamètre", "diametre", "diámetro", "diametro"),
    },
    PLACE: {
        *("x", "z", "position", "pos", "place", "location", "station", "distance", "dist", "length", "along", "from"),
        *("von", "abstand", "länge", "distancia", "posición", "posizione", "distanza"),
    },
}
_OTHERS = ("kg", "g", "oz", "lb", "s", "ms", "n", "deg", "°", "%")  # units of no length
_BRACKETS = re.compile(r"[\[({<]([^])}>]*)[\])}>]")
_TOKENS = re.compile(r"[^\W\d_]+")
_WALL = re.compile(r"wall|wand")  # how the name of a tube's wall thickness begins
_BUTT = {"butt", "joint"}  # where x is measured from, if "from" stands before it


@dataclass(frozen=True)
class ProfileColumn:
    """A column that is used: what it holds, where it stands, its name in the file, and its unit ("" if it has none)."""

    kind: str
    index: int
    name: str
    unit: str


@dataclass(frozen=True)
class Header:
    """The columns of a profile that say a length, a material, and nothing that is used; the lines below that hold
    numbers; and which lines are titles and notes."""

    line: int
    used: tuple[ProfileColumn, ...]
    names: tuple[ProfileColumn, ...]
    unused: tuple[str, ...]
    width: int
    rows: tuple[Row, ...]
    passed: tuple[int, ...]


def unit_of(text: str) -> str:
    """The unit of length that a text names, by its first name in the table of units; "" if it names none."""
    word = text.strip().strip(".[](){}<>").strip()
    try:
        scale(word, "m")
    except ValueError:
        return ""
    return first_name(word)


def read_header(path: Path, rows: Sequence[Row]) -> Header:
    """The header of a profile's rows; InputError if no row names a place and a diameter."""
    nearest = rows[0]  # to a header
    for i, (line, cells) in enumerate(rows[:TITLES]):
        columns = [_column(path, line, j, cell) for j, cell in enumerate(cells)]
        used = tuple(column for column in columns if column.kind and column.kind not in NAMES)
        names = tuple(column for column in columns if column.kind in NAMES)
        kinds = {column.kind for column in used}
        if PLACE in kinds and kinds & {DIAMETER, RADIUS}:
            below = rows[i + 1 :]
            units = [unit_of(cell) for cell in below[0][1]] if below else []
            if units and all(unit or not cell for unit, cell in zip(units, below[0][1], strict=True)):
                used = tuple(_with_unit(column, units) for column in used)
                below = below[1:]
            unused = tuple(column.name for column in columns if column.name and not column.kind)
            if wall := next((name for name in unused if any(map(_WALL.match, _TOKENS.findall(name.casefold())))), None):
                problem = f"column {shown(wall)} is a wall thickness: write a column bore, the diameter less two walls"
                raise InputError(path, f"line {line}", problem)
            noted = tuple(row for row in below if not _has_data(row[1], used, names))
            passed = tuple(number for number, _ in (*rows[:i], *noted))
            return Header(line, used, names, unused, len(cells), tuple(r for r in below if r not in noted), passed)
        if len(cells) > 1 and kinds and nearest == rows[0]:
            nearest = line, cells
        if len(cells) > 1 and all(map(is_number, cells)):
            break
    line, cells = nearest
    wanted = f"must name one column for the place along the shaft and one for the diameter, such as {EXAMPLE}"
    raise InputError(path, f"line {line}", f"{wanted}; got {shown(','.join(cells))}")


def _has_data(cells: Sequence[str], used: Sequence[ProfileColumn], names: Sequence[ProfileColumn]) -> bool:
    """Whether a line is a row of the table: it has a number or a material where one belongs."""
    inside = [[cells[c.index] for c in columns if c.index < len(cells)] for columns in (used, names)]
    return any(parted(cell)[0] for cell in inside[0]) or any(inside[1])


def _with_unit(column: ProfileColumn, units: Sequence[str]) -> ProfileColumn:
    unit = units[column.index] if column.index < len(units) else ""
    return ProfileColumn(column.kind, column.index, column.name, column.unit or unit)


def _column(path: Path, line: int, index: int, cell: str) -> ProfileColumn:
    """What a cell of a header says; its kind is "" if it is neither a place nor a width."""
    text = cell.replace("⌀", "ø").replace("Ø", "ø").casefold()
    inside = _BRACKETS.findall(text)
    unit = next(filter(None, map(unit_of, inside)), "")
    words = _TOKENS.findall(_BRACKETS.sub(" ", text) if unit else text)
    for place in (-1, 0):  # "diameter mm", "inches from tip"
        if not unit and len(words) > 1 and (unit := unit_of(words[place])):
            words.pop(place)
    if not unit and text.rstrip().endswith(('"', "″", "”")):
        unit = "in"
    kind = _kind(words)
    if words == ["id"] and not unit:  # the number of a row, no inner diameter
        kind = ""
    if kind == BORE and _WORDS[RADIUS] & {*words}:
        raise InputError(path, f"line {line}, {kind}", f"must be a column of diameters; got {shown(cell)}")
    if kind and inside and not unit and inside[0].strip() in _OTHERS:
        problem = f"must be in a unit of length, such as mm; got {shown(inside[0])}"
        raise InputError(path, f"line {line}, {kind}", problem)
    return ProfileColumn(kind, index, cell, unit)


def _kind(words: Sequence[str]) -> str:
    """The kind of column that words mean."""
    if FERRULE in words and {*words} <= {FERRULE, MATERIAL}:  # "distance from ferrule" is a place
        return FERRULE
    if any(map(_WALL.match, words)):
        return ""
    return next((kind for kind, known in _WORDS.items() if known & {*words}), "")


def from_butt(column: ProfileColumn) -> bool:
    """Whether a column of places says that it counts from the butt."""
    words = _TOKENS.findall(column.name.casefold())
    return "from" in words and bool(_BUTT & set(words[words.index("from") :])) and "tip" not in words
