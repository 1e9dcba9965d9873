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
from cuefem.io.csv_header import (
    BORE,
    CORE,
    DIAMETER,
    EXAMPLE,
    FERRULE,
    MATERIAL,
    POSITION,
    RADIUS,
    Header,
    ProfileColumn,
    measured_from_butt,
    read_header,
    unit_of,
)
from cuefem.io.csv_reader import Row, decimal_mark, python_number, read_rows, split_unit
from cuefem.io.errors import InputError, as_input_error, quote
from cuefem.io.shaft_additions import ferrule_on_tenon, has_length, with_additions
from cuefem.io.surface_sections import polyline_corners
from cuefem.io.toml_reader import named_material
from cuefem.quantity.display import MOST
from cuefem.quantity.fields import DIAMETER as WIDTH
from cuefem.quantity.fields import Quantity
from cuefem.quantity.units import parse_number

DEFAULT_MATERIAL = "hard maple"
DEFAULT_UNIT = "mm"  # of a surface's coordinates
SURFACE_EXTENSIONS = (".stl", ".ply", ".obj")
SHAPE_EXTENSIONS = (".csv", *SURFACE_EXTENSIONS)  # files with the shape of a shaft and without its material
# Files of programs that save .csv as well.
SPREADSHEET_EXTENSIONS = (".xlsx", ".xls", ".ods", ".numbers", ".txt", ".tsv", ".dat")
# Points closer than this to a straight taper lie on it, m: the rounding of a file, far below the error of a lathe.
_STRAIGHT = 1e-9
_NOTHING = ("none", "no", "-", "–", "—")  # cells for "no bore" or "no material"

_POSITION, _BORE = Quantity("m"), Quantity("m", "[0, 10]")

Point = tuple[float, float]  # position, diameter, m


@dataclass(frozen=True)
class Interior:
    """Bore, m, and materials of the shaft behind a row; None if absent."""

    bore: float = 0.0
    material: Material | None = None
    core: Material | None = None
    ferrule: Material | None = None


def read_profile(path: Path, material: Material, length_unit: str | None = None) -> tuple[Cue, list[str]]:
    """Read the shaft of a CSV with a column x and a column diameter (or radius), and notes on how it was read.

    Separator, decimal mark, encoding, order and names of the columns may be any common ones. The shaft begins at the
    first x. Each interval is a segment; straight tapers are merged. Bore, core and ferrule apply to their row, a
    material until the next one. material: the default. length_unit: of columns without a unit.
    """
    rows = read_rows(path)
    if not rows:
        raise InputError(path, "", f"must begin with the header {EXAMPLE}; got comments alone")
    header = read_header(path, rows)
    for line, cells in header.rows:
        if len(cells) > header.width:
            problem = f"must have no more numbers than there are columns, {header.width}; got {quote(','.join(cells))}"
            hint = "if commas separate the columns, write decimal points, or separate them by semicolons"
            raise InputError(path, f"line {line}", f"{problem}; {hint}")
    numbers = [split_unit(cell)[0] for column in header.number_columns for cell in _cells(header.rows, column)]
    mark = decimal_mark(numbers)
    columns = _with_units(path, header, length_unit)
    position, width = (_chosen(path, header, columns, kinds) for kinds in ((POSITION,), (DIAMETER, RADIUS)))
    x = [_number(path, row, position, mark) for row in header.rows]
    d = [_number(path, row, width, mark) for row in header.rows]
    points = _ordered(path, header, position, list(zip(x, d, strict=True)))
    if len(points) < 2:
        raise InputError(path, "", f"must hold at least 2 points; got {len(points)}")
    inside = _inside(path, header, columns, mark, d)
    if any(each != Interior() for each in inside) and (measured_from_butt(position) or points[0][0] != x[0]):
        problem = "must run from tip to butt beside a bore or a material, which apply from their row towards the butt"
        raise InputError(path, f"line {header.line}, x", problem)
    behind = dict(zip(x, inside, strict=True))
    with as_input_error(path, ""):
        cue, bored = _drawn(points, [behind.get(at, Interior()) for at, _ in points], material, position.unit)
        ferrule = _ferrule_with_length(path, header, inside)
        notes = [*_notes(header, position, width, points), *bored]
        return with_additions(cue, ferrule=ferrule) if ferrule else cue, notes


def _drawn(points: Sequence[Point], inside: Sequence[Interior], material: Material, unit: str) -> tuple[Cue, list[str]]:
    """The cue of points with the interior behind each of them, and notes on its bores."""
    per, segments, bored = parse_number(f"1 {unit}", "m"), list[Segment](), list[str]()

    def bores(i: int) -> tuple[float, float]:
        """Bore at both ends of interval i: it tapers to the bore of the next row if the materials are the same."""
        here, behind = inside[i], inside[i + 1]
        same = i + 2 == len(inside) or replace(here, bore=0.0) == replace(behind, bore=0.0)
        return (here.bore, behind.bore) if here.bore and behind.bore and same else (here.bore, here.bore)

    def alike(i: int) -> tuple[object, ...]:
        """Key of intervals that may be merged; an interval with a tapered bore is never merged."""
        return bores(i), replace(inside[i], bore=0.0), i if bores(i)[0] != bores(i)[1] else None

    for _, run in itertools.groupby(range(len(points) - 1), key=alike):
        first, *others = run
        here, widths = inside[first], bores(first)
        run_of = points[first : first + len(others) + 2]
        x, d = np.array(run_of).T
        ends = (run_of[k] for k in polyline_corners(x, d[:, None], _STRAIGHT))
        wood = here.material or material
        rest = (wood, *widths, here.core if widths[0] else None)
        drawn = [Segment(_apart(x0, x1), d0, d1, *rest) for (x0, d0), (x1, d1) in itertools.pairwise(ends)]
        segments += drawn if here.ferrule is None else [ferrule_on_tenon(s, here.ferrule, wood) for s in drawn]
        if widths[0]:
            sizes = " to ".join(f"{size / per:.6g}" for size in dict.fromkeys(widths))
            filled = f" and filled with {material_name(here.core)}" if here.core else ""
            bored.append(f"bored {sizes} {unit} from {x[0] / per:.6g} to {x[-1] / per:.6g} {unit}{filled}")
    return Cue(tuple(segments)), bored


def _inside(
    path: Path, header: Header, columns: Sequence[ProfileColumn], mark: str, diameters: Sequence[float]
) -> list[Interior]:
    """The bore and the materials of every row: an empty cell repeats only the material above."""
    bore = next((column for column in columns if column.kind == BORE), None)
    named = {column.kind: column for column in header.name_columns}
    rows, material = list[Interior](), None
    for row, outer in zip(header.rows, diameters, strict=True):
        line, cells = row
        found = {
            kind: named_material(text.casefold(), path, f"line {line}, {kind}")
            for kind, column in named.items()
            if (text := _entry(cells, column)) and not (kind == FERRULE and has_length(text))
        }
        material = found.get(MATERIAL, material)
        width = 0.0 if bore is None or not _entry(cells, bore) else _number(path, row, bore, mark)
        if width >= outer:
            across = f"{1e3 * outer:.6g} mm, the diameter there; got {1e3 * width:.6g} mm"
            raise InputError(path, f"line {line}, bore", f"must be less than {across}")
        if CORE in found and not width and row is not header.rows[-1]:
            problem = f"needs a bore in its row, which it fills; got {quote(_entry(cells, named[CORE]))}"
            raise InputError(path, f"line {line}, core", problem)
        rows.append(Interior(width, material, found.get(CORE), found.get(FERRULE)))
    return rows


def _ferrule_with_length(path: Path, header: Header, inside: Sequence[Interior]) -> str:
    """The ferrule of a cell such as "25 mm melamine", which begins at its row; "" if no cell has a length."""
    column = next((column for column in header.name_columns if column.kind == FERRULE), None)
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
    """A cell's text, "" for the words in `_NOTHING`."""
    text = cells[column.index].strip() if column.index < len(cells) else ""
    return "" if text.casefold() in _NOTHING else text


def _notes(header: Header, position: ProfileColumn, width: ProfileColumn, points: Sequence[Point]) -> list[str]:
    """Notes on how the columns and lines were read."""
    names = header.unused_names
    butt, first = measured_from_butt(position), points[0][0] if points else 0.0
    start = f"{first / parse_number(f'1 {position.unit}', 'm'):.6g} {position.unit}"
    skipped = header.skipped_lines
    lines = ", ".join(map(str, skipped[:MOST])) + ", ..." * (len(skipped) > MOST)
    notes = {
        f"line{'s' * (len(skipped) > 1)} {lines} skipped: no numbers of the table": bool(skipped),
        f"column{'s' if len(names) > 1 else ''} {', '.join(map(quote, names))} {'are' if len(names) > 1 else 'is'} not "
        "used": bool(names),
        f"diameters are twice the column {quote(width.name)}": width.kind == RADIUS,
        f"x is measured from the butt ({quote(position.name)})": butt,
        f"the shaft begins at its first point, x = {start}": first > 0 and not butt,
    }
    return [note for note, holds in notes.items() if holds]


def _cells(rows: Sequence[Row], column: ProfileColumn) -> list[str]:
    return [cells[column.index] if column.index < len(cells) else "" for _, cells in rows]


def _with_units(path: Path, header: Header, length_unit: str | None) -> list[ProfileColumn]:
    """The columns with their units from header, cells or ``length_unit``; InputError without a unit."""
    columns = []
    for column in header.number_columns:
        beside = {unit_of(rest) for _, rest in map(split_unit, _cells(header.rows, column)) if rest}
        unit = column.unit or ("".join(beside) if len(beside) == 1 else "")
        columns.append(ProfileColumn(column.kind, column.index, column.name, unit))
    bare = [column for column in columns if not column.unit]
    if length_unit is not None:
        if not bare:
            problem = f"already names its units: length_unit is for a table without units; got {quote(length_unit)}"
            raise InputError(path, "", problem)
        if not unit_of(length_unit):
            raise InputError(path, "length unit", f"must be a unit of length, such as mm; got {quote(length_unit)}")
    if bare and length_unit is None:
        names, written = (",".join(f"{column.name}{unit}" for column in bare) for unit in ("", " [mm]"))
        problem = f'{quote(names)} must name the unit: write "{written}" if these are mm, or use --length-unit'
        raise InputError(path, f"line {header.line}", problem)
    unit = unit_of(length_unit) if length_unit is not None else ""
    return [ProfileColumn(c.kind, c.index, c.name, c.unit or unit) for c in columns]


def _chosen(path: Path, header: Header, columns: Sequence[ProfileColumn], kinds: Sequence[str]) -> ProfileColumn:
    """The only column of these kinds; InputError for two."""
    first, *more = [column for column in columns if column.kind in kinds]
    if more:
        both = f"{quote(first.name)} and {quote(more[0].name)}"
        raise InputError(path, f"line {header.line}", f"two columns may be the {kinds[0]}, {both}: delete one")
    return first


def _number(path: Path, row: Row, column: ProfileColumn, mark: str) -> float:
    """A cell as an SI number, a radius doubled."""
    line, cells = row
    cell = cells[column.index] if column.index < len(cells) else ""
    kind, where = column.kind, f"line {line}, {column.kind}"
    text, rest = split_unit(cell)
    unit = (unit_of(rest) if rest else column.unit) or ""
    if not text or not unit:
        raise InputError(path, where, f"must be a number; got {quote(cell) if cell else 'nothing'}")
    with as_input_error(path, where):
        bounds = _POSITION if kind == POSITION else _BORE if kind == BORE else WIDTH
        value = bounds.read(f"{python_number(text, mark)} {unit}")
    return 2 * value if kind == RADIUS else value


def _ordered(path: Path, header: Header, position: ProfileColumn, points: list[Point]) -> tuple[Point, ...]:
    """The points from tip to butt; InputError if x is not monotonic."""
    if measured_from_butt(position):
        most = max((x for x, _ in points), default=0.0)
        points = [(_apart(x, most), d) for x, d in points]
    lines = list(zip((line for line, _ in header.rows), points, strict=True))
    if all(here[1][0] > there[1][0] for here, there in itertools.pairwise(lines)):  # butt first
        lines.reverse()
    ordered: list[Point] = []
    for line, (x, d) in lines:
        if ordered and (x, d) == ordered[-1]:
            continue  # written twice
        if ordered and x <= ordered[-1][0]:
            scale = parse_number(f"1 {position.unit}", "m")
            before, here = (f"{value / scale:g}" for value in (ordered[-1][0], x))
            problem = f"must be beyond {before} {position.unit}, the x of the line before (points run from tip to butt)"
            step = "; a step in the diameter is two points a little apart, such as "
            hint = f"{step}{before} and {x / scale + 0.1:g} {position.unit}" if x == ordered[-1][0] else ""
            raise InputError(path, f"line {line}, x", f"{problem}; got '{here} {position.unit}'{hint}")
        ordered.append((x, d))
    return tuple(ordered)


def _apart(first: float, last: float) -> float:
    """Difference in decimal arithmetic: 0.21 - 0.01 m is 0.2, without the round-off of floats."""
    return float(Decimal(repr(last)) - Decimal(repr(first)))
