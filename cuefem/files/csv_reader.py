"""Reader of tables of numbers from spreadsheets and editors: common encodings, separators and decimal marks."""

from __future__ import annotations

import csv
import re
from collections.abc import Iterable, Sequence
from pathlib import Path

from cuefem.files.errors import LARGEST_TEXT, InputError, quote, read_bytes
from cuefem.quantity.units import FRACTION, parse_decimal, plain_fractions

MAX_LINE_CHARACTERS = 10_000

Row = tuple[int, list[str]]  # line number in the file, and its cells

_SPREADSHEET_BYTES = (b"PK\x03\x04", b"\xd0\xcf\x11\xe0")  # first bytes of .xlsx and .ods, and of .xls
_BYTE_ORDER_MARKS = {b"\xef\xbb\xbf": "utf-8-sig", b"\xff\xfe": "utf-16", b"\xfe\xff": "utf-16"}
_COMMENTS = ("#", "//")
_SEPARATORS = "\t;|,"  # in order of preference: the first one that is in at least half of the lines
_ANY_SEPARATOR = re.compile(r"[\t;|,]")
_DIAMETER_SIGNS = "Øø⌀∅"
# Full-width letters, digits and marks of East Asian keyboards, blanks of spreadsheets and the Swiss mark of thousands.
_PLAIN_CHARACTERS = {0xFF01 + i: chr(0x21 + i) for i in range(94)} | str.maketrans(
    dict.fromkeys("\xa0\u2007\u2009\u202f\u3000", " ") | {"’": "'", "−": "-", "㎜": "mm", "㎝": "cm"}
)
_THOUSANDS_GAPS = re.compile(r"(?<=\d)[ '](?=\d{3}(?!\d))")  # 1 470 and 1'470
_PLAIN = re.compile(r"[+-]?(?:\d+\.?\d*|\.\d+)(?:e[+-]?\d+)?|[+-]?(?:inf|nan)", re.IGNORECASE)
_NUMBER = re.compile(rf"(?:{FRACTION.pattern}|[+-]?[\d.,](?:[\d.,' ]*[\d.,])?(?:e[+-]?\d+)?|[+-]?(?:inf|nan))", re.I)


def read_rows(path: Path) -> list[Row]:
    """The lines of a table as cells, without empty lines and comments; InputError if the file is not text."""
    lines = read_lines(path)
    if named := _named_separator(lines):
        return _split(lines[1:], named)
    most = [mark for mark in _SEPARATORS if 2 * sum(mark in line for _, line in lines) >= len(lines)]
    return _split(lines, most[0] if most else None)


def read_table(path: Path) -> list[Row]:
    """The lines of a table that begins with its headings, as cells without blanks around them.

    The separator is the one that a line "sep=;" names, or the first of tab, semicolon, | and comma in the headings.
    Rows of empty cells, and empty cells behind the last heading, which spreadsheets write, are left out.
    """
    lines = read_lines(path)
    separator = _named_separator(lines)
    if separator:
        lines = lines[1:]
    elif lines:
        separator = next((mark for mark in _SEPARATORS if mark in lines[0][1]), None)
    rows = [(i, [cell.strip() for cell in _cells(line, separator or ",")]) for i, line in lines]
    rows = [(i, cells) for i, cells in rows if any(cells)]
    columns = len(_without_end(rows[0][1], 0)) if rows else 0
    return [(i, _without_end(cells, columns)) for i, cells in rows]


def _without_end(cells: Sequence[str], columns: int) -> list[str]:
    """The cells without the empty ones at their end, as far as they are behind a number of columns."""
    filled = max((k for k, cell in enumerate(cells, start=1) if cell), default=0)
    return [*cells[: max(filled, columns)]]


def _named_separator(lines: Sequence[tuple[int, str]]) -> str | None:
    """The separator that the first line names, as spreadsheets write it: "sep=;"."""
    named = re.fullmatch(r"sep=(.)", lines[0][1].strip(), re.IGNORECASE) if lines else None
    return named[1] if named else None


def read_lines(path: Path) -> list[tuple[int, str]]:
    """The numbered lines of a table, without empty lines and comments; InputError for a line that is too long."""
    lines = [(i, line) for i, line in enumerate(read_text(path).splitlines(), start=1) if line.strip()]
    lines = [(i, line) for i, line in lines if not line.lstrip().startswith(_COMMENTS)]
    for i, line in lines:
        if len(line) > MAX_LINE_CHARACTERS:
            raise InputError(path, f"line {i}", f"must have at most {MAX_LINE_CHARACTERS} characters; got {len(line)}")
    return lines


def _split(lines: Iterable[tuple[int, str]], separator: str | None) -> list[Row]:
    rows = []
    for i, line in lines:
        cells = re.split(r"\s{2,}|\t", line.strip()) if separator is None else _cells(line, separator)
        if separator is None and len(cells) == 1:
            cells = line.split()
        if len(cells) == 1 and _ANY_SEPARATOR.search(line):  # a header with another separator
            cells = _cells(line, _ANY_SEPARATOR.search(line)[0])  # type: ignore[index]
        cells = [plain_fractions(cell.translate(_PLAIN_CHARACTERS)).strip() for cell in cells]
        while cells and not cells[-1]:
            cells.pop()
        if cells:
            rows.append((i, cells))
    return rows


def _cells(line: str, separator: str) -> list[str]:
    return next(csv.reader([line], delimiter=separator, skipinitialspace=True))


def read_text(path: Path) -> str:
    """The text of a file in UTF-8, UTF-16 or Windows-1252; InputError if it is empty or not text."""
    content = read_bytes(path, LARGEST_TEXT)
    if content.startswith(_SPREADSHEET_BYTES):
        raise InputError(path, "", "is a spreadsheet: export it as CSV")
    try:
        text = content.decode(_encoding(content))
    except UnicodeDecodeError:
        text = "\0"
    if any(ord(letter) < 32 and letter not in "\t\r\n\f\v" for letter in text):
        raise InputError(path, "", "must be text; got a file of another kind")
    if not text.strip():
        raise InputError(path, "", "must hold text or a table; got an empty file")
    return text


def _encoding(content: bytes) -> str:
    for mark, name in _BYTE_ORDER_MARKS.items():
        if content.startswith(mark):
            return name
    if b"\0" in content[:100]:  # UTF-16 without a byte-order mark: every other byte of ASCII text is 0
        return "utf-16-be" if content[:1] == b"\0" else "utf-16-le"
    try:
        content.decode("utf-8")
    except UnicodeDecodeError:
        return "cp1252"
    return "utf-8"


def split_unit(cell: str) -> tuple[str, str]:
    """A cell's number and the unit behind it; the number is empty if the cell does not start with one.

    A diameter sign in front of the number is ignored.
    """
    cell = cell.lstrip("'").lstrip(_DIAMETER_SIGNS).lstrip()
    match = _NUMBER.match(cell)
    return (match[0], cell[match.end() :].strip()) if match else ("", cell)


def is_number(cell: str) -> bool:
    """Whether a cell holds a number and no unit."""
    number, rest = split_unit(cell)
    return bool(number) and not rest


def decimal_mark(numbers: Sequence[str]) -> str:
    """The decimal mark of a table: the last mark of a number with both, else the one in more numbers, else a point."""
    with_both = [number for number in numbers if "." in number and "," in number]
    if with_both:
        return max(".,", key=with_both[0].rfind)
    points, commas = (sum(mark in number for number in numbers) for mark in ".,")
    return "," if commas > points else "."


def python_number(number: str, mark: str) -> str:
    """A number with this decimal mark in Python's notation; ValueError for another mark or no number."""
    if FRACTION.fullmatch(number):
        return str(parse_decimal(number))
    other = "," if mark == "." else "."
    number = _THOUSANDS_GAPS.sub("", number)
    if other in number:
        if not re.fullmatch(rf"[+-]?\d{{1,3}}(?:{re.escape(other)}\d{{3}})+(?:{re.escape(mark)}\d*)?", number):
            word = "point" if mark == "." else "comma"
            raise ValueError(f"must be written with the decimal {word} of the other numbers; got {quote(number)}")
        number = number.replace(other, "")
    number = number.replace(mark, ".")
    if not _PLAIN.fullmatch(number):
        raise ValueError(f"must be a number; got {quote(number)}")
    return number
