"""Header of a lathe profile: its columns of position, diameter or radius, bore and materials, and their units."""

from __future__ import annotations

import difflib
import re
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

from cuefem.files.csv_reader import Row, is_number, split_unit
from cuefem.files.errors import InputError, quote
from cuefem.files.heading_words import BUTT, TIP, WORDS, Column, has_word
from cuefem.quantity.units import conversion_factor, preferred_name

EXAMPLE = '"x [mm],diameter [mm]"'
MAX_HEADER_ROWS = 20  # rows searched for the header: without blank lines and comments, at most 19 above it

MATERIAL_COLUMNS = (Column.MATERIAL, Column.CORE, Column.FERRULE)
_OTHER_UNITS = ("kg", "g", "oz", "lb", "s", "ms", "n", "deg", "°", "%")  # units that are not lengths
_BRACKETS = re.compile(r"[\[({<]([^])}>]*)[\])}>]")
_TOKENS = re.compile(r"[^\W\d_]+")
_WALL = re.compile(r"wall|wand")  # first letters of the words for a wall thickness
_BUTT = {"butt", "joint"}  # after the word "from": x is measured from the butt
_NEAR = 0.82  # least similarity (`difflib`) of a misspelt word: bor, materail and ferule reach 0.86 to 0.92
_SHORTEST = 6  # letters of another word than a kind's name that may be misspelt: foo is no foro, ratio no raio


@dataclass(frozen=True)
class ProfileColumn:
    """A column of the table.

    kind: "" if unused. index: from 0. name: in the file. unit: of length; "" if the header names none.
    """

    kind: str
    index: int
    name: str
    unit: str


@dataclass(frozen=True)
class CsvHeader:
    """The header of a table, and the rows below it that have data.

    line: of the header, from 1. n_columns: cells in that line. skipped_lines: of titles above the header and of rows
    without data.
    """

    line: int
    length_columns: tuple[ProfileColumn, ...]
    material_columns: tuple[ProfileColumn, ...]
    unused_names: tuple[str, ...]
    n_columns: int
    rows: tuple[Row, ...]
    skipped_lines: tuple[int, ...]


def length_unit_of(text: str) -> str:
    """The unit of length named by a text, by its preferred name; "" if it names none."""
    word = text.strip().strip(".[](){}<>").strip()
    try:
        conversion_factor(word, "m")
    except ValueError:
        return ""
    return preferred_name(word)


def read_header(path: Path, rows: Sequence[Row]) -> CsvHeader:
    """Find the header in the first `MAX_HEADER_ROWS` rows of a profile.

    Raises
    ------
    InputError
        If no row names a position and a diameter (or radius); for a column of wall thicknesses or of bore radii; for a
        column of another unit than length; and for a heading that is nearly a known word.
    """
    candidate = rows[0]  # or the first row with a recognised column: quoted in the error
    for i, (line, cells) in enumerate(rows[:MAX_HEADER_ROWS]):
        columns = [_column(path, line, j, cell) for j, cell in enumerate(cells)]
        lengths = tuple(column for column in columns if column.kind and column.kind not in MATERIAL_COLUMNS)
        materials = tuple(column for column in columns if column.kind in MATERIAL_COLUMNS)
        kinds = {column.kind for column in lengths}
        if Column.POSITION in kinds and kinds & {Column.DIAMETER, Column.RADIUS}:
            below = rows[i + 1 :]
            units = [length_unit_of(cell) for cell in below[0][1]] if below else []
            if units and all(unit or not cell for unit, cell in zip(units, below[0][1], strict=True)):
                # a row of units only
                lengths = tuple(_with_unit(column, units) for column in lengths)
                below = below[1:]
            unused = tuple(column.name for column in columns if column.name and not column.kind)
            if wall := next((name for name in unused if any(map(_WALL.match, _TOKENS.findall(name.casefold())))), None):
                problem = f"column {quote(wall)} is a wall thickness: write a column bore, the diameter less two walls"
                raise InputError(path, f"line {line}", problem)
            for name in unused:
                if word := _misspelt(name):
                    problem = f"column {quote(name)} is unknown; did you mean {word!r}? Correct or rename it"
                    raise InputError(path, f"line {line}", problem)
            data = tuple(row for row in below if _has_data(row[1], lengths, materials))
            data = _without_closing_text(data, lengths)
            skipped = tuple(number for number, _ in (*rows[:i], *(row for row in below if row not in data)))
            return CsvHeader(line, lengths, materials, unused, len(cells), data, skipped)
        if len(cells) > 1 and kinds and candidate == rows[0]:
            candidate = line, cells
        if len(cells) > 1 and all(map(is_number, cells)):
            break
    line, cells = candidate
    expected = f"must name a column for the position along the shaft and one for the diameter, such as {EXAMPLE}"
    words = [word for cell in cells if (word := _misspelt(cell))]
    hint = f"; did you mean {words[0]!r}?" if words else ""
    raise InputError(path, f"line {line}", f"{expected}; got {quote(','.join(cells))}{hint}")


def _has_data(cells: Sequence[str], lengths: Sequence[ProfileColumn], materials: Sequence[ProfileColumn]) -> bool:
    """Whether a row has a number in a column of lengths, or a text in one of materials."""
    numbers, names = ([cells[c.index] for c in columns if c.index < len(cells)] for columns in (lengths, materials))
    return any(split_unit(cell)[0] for cell in numbers) or any(names)


def _without_closing_text(rows: tuple[Row, ...], lengths: Sequence[ProfileColumn]) -> tuple[Row, ...]:
    """The rows up to the last one that has no text without digits for its position, such as a line of weights."""
    at = next(column.index for column in lengths if column.kind == Column.POSITION)
    count = len(rows)
    while count and _is_text(rows[count - 1][1][at : at + 1]):
        count -= 1
    return rows[:count]


def _is_text(cells: Sequence[str]) -> bool:
    """Whether cells hold letters and no digit: "l3.5" may be a misspelt number."""
    text = "".join(cells)
    return any(map(str.isalpha, text)) and not any(map(str.isdigit, text))


def _misspelt(name: str) -> str:
    """The known word that a heading misspells after its first letter; "" if it has a known word, or none is near."""
    words = _TOKENS.findall(name.casefold())
    if _kind(words):
        return ""
    others = {word for kind in WORDS.values() for word in kind if len(word) >= _SHORTEST}
    for word in words:
        same_start = [known for known in sorted({*map(str, WORDS)} | others) if known[0] == word[0]]  # core is no score
        if near := difflib.get_close_matches(word, same_start, n=1, cutoff=_NEAR):
            return near[0]
    return ""


def _with_unit(column: ProfileColumn, units: Sequence[str]) -> ProfileColumn:
    """The column with the unit of a row of units, if its header names none."""
    unit = units[column.index] if column.index < len(units) else ""
    return replace(column, unit=column.unit or unit)


def _column(path: Path, line: int, index: int, cell: str) -> ProfileColumn:
    """The column of a header cell; InputError for a bore radius or another unit than length."""
    text = cell.replace("⌀", "ø").replace("Ø", "ø").casefold()
    bracketed = _BRACKETS.findall(text)
    unit = next(filter(None, map(length_unit_of, bracketed)), "")
    words = _TOKENS.findall(_BRACKETS.sub(" ", text) if unit else text)
    for end in (-1, 0):  # "diameter mm", "inches from tip"
        if not unit and len(words) > 1 and (unit := length_unit_of(words[end])):
            words.pop(end)
    if not unit and text.rstrip().endswith(('"', "″", "”")):
        unit = "in"
    kind = _kind(words)
    if words == ["id"] and not unit:  # a row number, not an inner diameter
        kind = ""
    if kind == Column.BORE and any(has_word(word, WORDS[Column.RADIUS]) for word in words):
        raise InputError(path, f"line {line}, {kind}", f"must be a column of diameters; got {quote(cell)}")
    if kind and bracketed and not unit and bracketed[0].strip() in _OTHER_UNITS:
        problem = f"must be in a unit of length, such as mm; got {quote(bracketed[0])}"
        raise InputError(path, f"line {line}, {kind}", problem)
    return ProfileColumn(kind, index, cell, unit)


def _kind(words: Sequence[str]) -> str:
    """The kind of a column by the words of its name; "" if unused."""
    kinds = [{kind for kind, known in WORDS.items() if has_word(word, known)} for word in words]
    found = set[str]().union(*kinds)
    if Column.FERRULE in found and all(own and own <= {Column.FERRULE, Column.MATERIAL} for own in kinds):
        # but "distance from ferrule" is a position
        return Column.FERRULE
    if any(map(_WALL.match, words)):
        return ""
    return next((kind for kind in WORDS if kind in found - {Column.FERRULE}), "")


def measured_from_butt(column: ProfileColumn) -> bool:
    """Whether positions count from the butt, by the column's name."""
    words = _TOKENS.findall(column.name.casefold())
    if any(has_word(word, TIP) for word in words):
        return False
    in_english = "from" in words and bool(_BUTT & set(words[words.index("from") :]))
    return in_english or any(has_word(word, BUTT) for word in words)
