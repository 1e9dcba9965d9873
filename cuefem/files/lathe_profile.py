"""Lathe profiles: a CSV of diameters measured along a shaft, from the tip to the butt, as conical segments."""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from dataclasses import dataclass, replace
from decimal import Decimal
from pathlib import Path

import numpy as np

from cuefem.cue import MAX_LEATHER_MODULUS, Cue, Material, Segment
from cuefem.cue.materials import material_name
from cuefem.files.csv_header import (
    EXAMPLE,
    CsvHeader,
    ProfileColumn,
    length_unit_of,
    measured_from_butt,
    read_header,
)
from cuefem.files.csv_reader import Row, decimal_mark, python_number, read_rows, split_unit
from cuefem.files.errors import InputError, as_input_error, quote
from cuefem.files.heading_words import Column
from cuefem.files.misplaced_diameters import misplaced_rows
from cuefem.files.schema import named_material
from cuefem.files.shaft_additions import ferrule_on_tenon, has_length, with_additions
from cuefem.files.surface_sections import polyline_corners
from cuefem.quantity.display import MAX_LISTED
from cuefem.quantity.display_units import with_unit
from cuefem.quantity.fields import DIAMETER, Quantity
from cuefem.quantity.units import parse_number

DEFAULT_MATERIAL = "hard maple"
DEFAULT_UNIT = "mm"  # of a surface's coordinates
SURFACE_EXTENSIONS = (".stl", ".ply", ".obj")
SHAPE_EXTENSIONS = (".csv", *SURFACE_EXTENSIONS)  # files with the shape of a shaft and without its material
DRAWING_EXTENSIONS = (".toml", *SHAPE_EXTENSIONS)
# Extensions of programs that can export .csv.
SPREADSHEET_EXTENSIONS = (".xlsx", ".xls", ".ods", ".numbers", ".txt", ".tsv", ".dat")
# Points closer than this to a straight taper lie on it, m: the rounding of a file, far below the error of a lathe.
_STRAIGHTNESS = 1e-9
_EMPTY = ("none", "no", "-", "–", "—")  # cells for "no bore" or "no material"

_POSITION, _BORE = Quantity("m"), Quantity("m", "[0, 10]")

Point = tuple[float, float]  # position, diameter, m


@dataclass(frozen=True)
class Interior:
    """Bore diameter, m (0 without one), and materials of the shaft from a row on; None if absent."""

    bore: float = 0.0
    material: Material | None = None
    core: Material | None = None
    ferrule: Material | None = None


def read_profile(path: Path, material: Material, length_unit: str | None = None) -> tuple[Cue, list[str]]:
    """Read the shaft of a CSV with a column x and a column diameter (or radius), and notes on how it was read.

    Separator, decimal mark, encoding, order and names of the columns may be any common ones. The shaft begins at the
    first x. Each interval is a segment; straight tapers are merged. Bore, core and ferrule apply from their row to the
    next, a material until another is named. material: the default. length_unit: of columns without a unit. InputError
    for an invalid table.
    """
    rows = read_rows(path)
    if not rows:
        raise InputError(path, "", f"must begin with the header {EXAMPLE}; got only comments")
    header = read_header(path, rows)
    for line, cells in header.rows:
        if len(cells) > header.n_columns:
            problem = f"must have at most as many cells as the header, {header.n_columns}; got {quote(','.join(cells))}"
            hint = "if commas separate the columns, write decimal points, or separate them by semicolons"
            raise InputError(path, f"line {line}", f"{problem}; {hint}")
    numbers = [split_unit(cell)[0] for column in header.length_columns for cell in _cells(header.rows, column)]
    mark = decimal_mark(numbers)
    columns = _with_units(path, header, length_unit)
    _check_single(path, header)
    by_kind = {column.kind: column for column in columns}
    position, diameter = by_kind[Column.POSITION], by_kind.get(Column.DIAMETER) or by_kind[Column.RADIUS]
    x = [_number(path, row, position, mark) for row in header.rows]
    d = [_number(path, row, diameter, mark) for row in header.rows]
    is_lathe = max(x, default=0.0) <= 0 > min(x, default=0.0)  # Z of a lathe, 0 at the front and negative behind it
    x = [abs(at) for at in x] if is_lathe else x
    _check_decimal_points(path, header, diameter, x, d)
    points = _ordered(path, header, position, list(zip(x, d, strict=True)))
    if len(points) < 2:
        raise InputError(path, "", f"must hold at least 2 points; got {len(points)}")
    inside = _inside(path, header, columns, mark, d)
    if any(each != Interior() for each in inside) and (measured_from_butt(position) or points[0][0] != x[0]):
        problem = "must increase from tip to butt: bores and materials apply from their row towards the butt"
        raise InputError(path, f"line {header.line}, x", problem)
    sides = _sides(path, header, x, inside)
    before, behind = zip(*(sides.get(at, (Interior(), Interior())) for at, _ in points), strict=True)
    with as_input_error(path, ""):
        cue, bored = _drawn(points, before, behind, material, position.unit)
        ferrule = _ferrule_with_length(path, header, inside)
        negative = ["positions are negative, as on a lathe: read as distances from the front"] if is_lathe else []
        notes = [*_notes(header, position, diameter, points), *negative, *bored]
        return with_additions(cue, ferrule=ferrule) if ferrule else cue, notes


def _check_decimal_points(
    path: Path, header: CsvHeader, column: ProfileColumn, x: Sequence[float], diameters: Sequence[float]
) -> None:
    """InputError for the first row whose diameter does not belong to the shaft of the others."""
    order = sorted(range(len(x)), key=lambda i: x[i])
    in_order = [[values[i] for i in order] for values in (x, diameters)]
    misplaced = misplaced_rows(*in_order, in_inches=column.unit == "in")
    if not misplaced:
        return
    found = misplaced[0]
    unit_size = parse_number(f"1 {column.unit}", "m") * (2 if column.kind == Column.RADIUS else 1)
    row, *neighbours = (order[i] for i in (found.row, *found.neighbours))
    own, *nearby = (diameters[i] / unit_size for i in (row, *neighbours))
    beside = f"{'between' if len(nearby) == 2 else 'beside'} {' and '.join(f'{each:.6g}' for each in nearby)}"
    guess = f"{found.question} {found.factor * own:.4g} would fit" if found.question else "check it"
    line, _ = header.rows[row]
    raise InputError(path, f"line {line}, {column.kind}", f"{own:.6g} {column.unit} {beside}: {guess}")


def _sides(
    path: Path, header: CsvHeader, x: Sequence[float], inside: Sequence[Interior]
) -> dict[float, tuple[Interior, Interior]]:
    """The interior in front of each position and the one behind it: two rows of one position make a step."""
    sides = dict[float, tuple[Interior, Interior]]()
    for (line, _), at, interior in zip(header.rows, x, inside, strict=True):
        before, behind = sides.get(at, (interior, interior))
        if before != behind != interior:
            problem = "must have at most two rows, in front of and behind a step of the bore or of a material"
            raise InputError(path, f"line {line}, x", f"{problem}; got a third row at {with_unit(at, 'm', 6)}")
        sides[at] = before, interior
    return sides


def _drawn(
    points: Sequence[Point], before: Sequence[Interior], inside: Sequence[Interior], material: Material, unit: str
) -> tuple[Cue, list[str]]:
    """The cue of points with the interior in front of each of them and behind it, and notes on its bores."""
    unit_size, segments, bored = parse_number(f"1 {unit}", "m"), list[Segment](), list[str]()

    def bores(i: int) -> tuple[float, float]:
        """Bore at both ends of interval i: it tapers to the bore of the next row if the materials are the same."""
        here, following = inside[i], before[i + 1]
        same = i + 2 == len(inside) or replace(here, bore=0.0) == replace(following, bore=0.0)
        return (here.bore, following.bore) if here.bore and following.bore and same else (here.bore, here.bore)

    def merge_key(i: int) -> tuple[object, ...]:
        """Key of intervals that may be merged; an interval with a tapered bore is never merged."""
        return bores(i), replace(inside[i], bore=0.0), i if bores(i)[0] != bores(i)[1] else None

    for _, run in itertools.groupby(range(len(points) - 1), key=merge_key):
        first, *others = run
        here, ends_of_bore = inside[first], bores(first)
        run_of = points[first : first + len(others) + 2]
        x, d = np.array(run_of).T
        ends = (run_of[k] for k in polyline_corners(x, d[:, None], _STRAIGHTNESS))
        wood = here.material or material
        rest = (wood, *ends_of_bore, here.core if ends_of_bore[0] else None)
        drawn = [Segment(_exact_difference(x0, x1), d0, d1, *rest) for (x0, d0), (x1, d1) in itertools.pairwise(ends)]
        segments += drawn if here.ferrule is None else [ferrule_on_tenon(s, here.ferrule, wood) for s in drawn]
        if ends_of_bore[0]:
            sizes = " to ".join(f"{size / unit_size:.6g}" for size in dict.fromkeys(ends_of_bore))
            filled = f" and filled with {material_name(here.core)}" if here.core else ""
            bored.append(f"bored {sizes} {unit} from {x[0] / unit_size:.6g} to {x[-1] / unit_size:.6g} {unit}{filled}")
    return Cue(tuple(segments)), bored


def _inside(
    path: Path, header: CsvHeader, columns: Sequence[ProfileColumn], mark: str, diameters: Sequence[float]
) -> list[Interior]:
    """The bore and the materials of every row: an empty cell repeats the material above only."""
    bore = next((column for column in columns if column.kind == Column.BORE), None)
    named = {column.kind: column for column in header.material_columns}
    rows, material = list[Interior](), None
    for row, outer in zip(header.rows, diameters, strict=True):
        line, cells = row
        found = {
            kind: named_material(
                text.casefold(), path, f"line {line}, {kind}", "ferrule" if kind == Column.FERRULE else ""
            )
            for kind, column in named.items()
            if (text := _entry(cells, column)) and not (kind == Column.FERRULE and has_length(text))
        }
        material = found.get(Column.MATERIAL, material)
        width = 0.0 if bore is None or not _entry(cells, bore) else _number(path, row, bore, mark)
        if width >= outer:
            problem = (
                f"must be less than {with_unit(outer, 'm', 6)}, the diameter there; got {with_unit(width, 'm', 6)}"
            )
            raise InputError(path, f"line {line}, bore", problem)
        if Column.CORE in found and not width and row is not header.rows[-1]:
            problem = f"needs a bore in its row, which it fills; got {quote(_entry(cells, named[Column.CORE]))}"
            raise InputError(path, f"line {line}, core", problem)
        rows.append(Interior(width, material, found.get(Column.CORE), found.get(Column.FERRULE)))
    return rows


def _ferrule_with_length(path: Path, header: CsvHeader, inside: Sequence[Interior]) -> str:
    """The ferrule of a cell such as "25 mm melamine", which begins at its row; "" if no cell has a length."""
    column = next((column for column in header.material_columns if column.kind == Column.FERRULE), None)
    entries = [_entry(cells, column) if column else "" for _, cells in header.rows]
    ferrules = [(i, text) for i, text in enumerate(entries) if has_length(text)]
    front = next(
        (i for i, each in enumerate(inside) if each.material is None or each.material.E >= MAX_LEATHER_MODULUS), 0
    )
    for i, text in ferrules:
        if i != front or len([*filter(None, entries)]) > 1:
            problem = f"with a length must be the only one, in the first line of the shaft; got {quote(text)}"
            raise InputError(path, f"line {header.rows[i][0]}, ferrule", problem)
    return ferrules[0][1] if ferrules else ""


def _entry(cells: Sequence[str], column: ProfileColumn) -> str:
    """A cell's text, "" for the words in `_EMPTY`."""
    text = cells[column.index].strip() if column.index < len(cells) else ""
    return "" if text.casefold() in _EMPTY else text


def _notes(header: CsvHeader, position: ProfileColumn, diameter: ProfileColumn, points: Sequence[Point]) -> list[str]:
    """Notes on how the columns and lines were read."""
    names = header.unused_names
    butt, first = measured_from_butt(position), points[0][0] if points else 0.0
    start = f"{first / parse_number(f'1 {position.unit}', 'm'):.6g} {position.unit}"
    skipped = header.skipped_lines
    lines = ", ".join(map(str, skipped[:MAX_LISTED])) + ", ..." * (len(skipped) > MAX_LISTED)
    notes = {
        f"line{'s' * (len(skipped) > 1)} {lines} skipped: without data": bool(skipped),
        f"column{'s' if len(names) > 1 else ''} {', '.join(map(quote, names))} {'are' if len(names) > 1 else 'is'} not "
        "used": bool(names),
        f"diameters are twice the column {quote(diameter.name)}": diameter.kind == Column.RADIUS,
        f"x is measured from the butt ({quote(position.name)})": butt,
        f"the shaft begins at its first point, x = {start}": first > 0 and not butt,
    }
    return [note for note, holds in notes.items() if holds]


def _cells(rows: Sequence[Row], column: ProfileColumn) -> list[str]:
    return [cells[column.index] if column.index < len(cells) else "" for _, cells in rows]


def names_units(path: Path) -> bool:
    """Whether a profile names the units of its columns, in its header or its cells."""
    return all(column.unit for column in _length_columns(read_header(path, read_rows(path))))


def _length_columns(header: CsvHeader) -> list[ProfileColumn]:
    """The columns of lengths with their units from header or cells; "" without one."""
    columns = []
    for column in header.length_columns:
        in_cells = {length_unit_of(rest) for _, rest in map(split_unit, _cells(header.rows, column)) if rest}
        unit = column.unit or ("".join(in_cells) if len(in_cells) == 1 else "")
        columns.append(replace(column, unit=unit))
    return columns


def _with_units(path: Path, header: CsvHeader, length_unit: str | None) -> list[ProfileColumn]:
    """The columns with their units from header, cells or ``length_unit``; InputError without a unit."""
    columns = _length_columns(header)
    without_unit = [column for column in columns if not column.unit]
    if length_unit is not None:
        if not without_unit:
            problem = f"already names its units: length_unit is for a table without units; got {quote(length_unit)}"
            raise InputError(path, "", problem)
        if not length_unit_of(length_unit):
            raise InputError(path, "length_unit", f"must be a unit of length, such as mm; got {quote(length_unit)}")
    if without_unit and length_unit is None:
        names, written = (",".join(f"{column.name}{unit}" for column in without_unit) for unit in ("", " [mm]"))
        problem = (
            f'{quote(names)} must name the unit: write "{written}" if these are mm, or give length_unit (--length-unit)'
        )
        raise InputError(path, f"line {header.line}", problem)
    unit = length_unit_of(length_unit) if length_unit is not None else ""
    return [replace(column, unit=column.unit or unit) for column in columns]


def _check_single(path: Path, header: CsvHeader) -> None:
    """InputError for two columns of one kind; a radius is a diameter."""
    names: dict[str, list[str]] = {kind: [] for kind in Column}
    for column in (*header.length_columns, *header.material_columns):
        kind = Column.DIAMETER if column.kind == Column.RADIUS else column.kind
        names[kind].append(quote(column.name))
    for kind, own in names.items():
        if len(own) > 1:
            problem = f"two columns may be the {kind}, {own[0]} and {own[1]}: delete one"
            raise InputError(path, f"line {header.line}", problem)


def _number(path: Path, row: Row, column: ProfileColumn, mark: str) -> float:
    """A cell as an SI number, a radius doubled."""
    line, cells = row
    cell = cells[column.index] if column.index < len(cells) else ""
    kind, key = column.kind, f"line {line}, {column.kind}"
    text, rest = split_unit(cell)
    unit = (length_unit_of(rest) if rest else column.unit) or ""
    if not text or not unit:
        raise InputError(path, key, f"must be a number; got {quote(cell) if cell else 'nothing'}")
    with as_input_error(path, key):
        bounds = _POSITION if kind == Column.POSITION else _BORE if kind == Column.BORE else DIAMETER
        value = bounds.read(f"{python_number(text, mark)} {unit}")
    return 2 * value if kind == Column.RADIUS else value


def _ordered(path: Path, header: CsvHeader, position: ProfileColumn, points: list[Point]) -> tuple[Point, ...]:
    """The points from tip to butt; InputError if x is not monotonic."""
    if measured_from_butt(position):
        butt_end = max((x for x, _ in points), default=0.0)
        points = [(_exact_difference(x, butt_end), d) for x, d in points]
    lines = list(zip((line for line, _ in header.rows), points, strict=True))
    if all(here[1][0] > there[1][0] for here, there in itertools.pairwise(lines)):  # butt first
        lines.reverse()
    ordered: list[Point] = []
    for line, (x, d) in lines:
        if ordered and (x, d) == ordered[-1]:
            continue  # a step of the bore or of a material, or a duplicate row
        if ordered and x <= ordered[-1][0]:
            unit_size = parse_number(f"1 {position.unit}", "m")
            before, here = (f"{value / unit_size:g}" for value in (ordered[-1][0], x))
            problem = f"must be beyond {before} {position.unit}, the x of the line before (points run from tip to butt)"
            step = "; a step in the diameter is two points a little apart, such as "
            hint = f"{step}{before} and {x / unit_size + 0.1:g} {position.unit}" if x == ordered[-1][0] else ""
            raise InputError(path, f"line {line}, x", f"{problem}; got '{here} {position.unit}'{hint}")
        ordered.append((x, d))
    return tuple(ordered)


def _exact_difference(first: float, last: float) -> float:
    """last - first in decimal arithmetic: 0.21 - 0.01 m is 0.2, without the round-off of floats."""
    return float(Decimal(repr(last)) - Decimal(repr(first)))
