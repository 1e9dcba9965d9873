"""Lathe profiles: a CSV of diameters measured along a shaft, from the tip to the butt, as conical segments."""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from dataclasses import dataclass, replace
from decimal import Decimal
from pathlib import Path

import numpy as np

from cuefem.cue import SOFT, Cue, Material, Segment
from cuefem.cue.materials import material_name
from cuefem.io.cells import Row, decimal_mark, parted, plain, read_rows
from cuefem.io.columns import (
    BORE,
    CORE,
    DIAMETER,
    EXAMPLE,
    FERRULE,
    MATERIAL,
    PLACE,
    RADIUS,
    Header,
    ProfileColumn,
    from_butt,
    read_header,
    unit_of,
)
from cuefem.io.errors import InputError, faults_of, shown
from cuefem.io.fittings import fitted, has_length, on_tenon
from cuefem.io.slices import corners
from cuefem.io.toml import named_material
from cuefem.quantity.display import MOST
from cuefem.quantity.fields import DIAMETER as WIDTH
from cuefem.quantity.fields import Quantity
from cuefem.quantity.units import number

DEFAULT_MATERIAL = "hard maple"
DEFAULT_UNIT = "mm"  # of a surface's coordinates
SURFACES = (".stl", ".ply", ".obj")
SHAPES = (".csv", *SURFACES)  # the files that say a shaft's shape and no material
TABLES = (".xlsx", ".xls", ".ods", ".numbers", ".txt", ".tsv", ".dat")  # files that can be saved as .csv
# Points closer than this to a straight taper lie on it, m: the rounding of a file, far below what a lathe measures.
_STRAIGHT = 1e-9
_NOTHING = ("none", "no", "-", "–", "—")  # cells without a bore or a material

_POSITION, _HOLE = Quantity("m"), Quantity("m", "[0, 10]")

Point = tuple[float, float]  # position, diameter, m


@dataclass(frozen=True)
class Inside:
    """The bore, m, and the materials of the shaft from a row on; None where there is none."""

    bore: float = 0.0
    material: Material | None = None
    core: Material | None = None
    ferrule: Material | None = None


def read_profile(path: Path, material: Material, length_unit: str | None = None) -> tuple[Cue, list[str]]:
    """The shaft of a CSV that names a column x and a column diameter (or radius) with their units of length, and what
    its reader should know of how it was read.

    Separator, decimal mark, encoding, order and names of the columns may be any usual ones. The first x may have any
    value: the shaft begins there. One segment an interval; straight tapers become one. Bore, core and ferrule hold for
    their row, a material until another is named. material: where the file names none. length_unit: of columns that
    name none.
    """
    rows = read_rows(path)
    if not rows:
        raise InputError(path, "", f"must begin with the header {EXAMPLE}; got comments alone")
    header = read_header(path, rows)
    for line, cells in header.rows:
        if len(cells) > header.width:
            problem = f"must have no more numbers than there are columns, {header.width}; got {shown(','.join(cells))}"
            hint = "where commas part the columns, write decimal points, or part the columns by semicolons"
            raise InputError(path, f"line {line}", f"{problem}; {hint}")
    numbers = [parted(cell)[0] for column in header.used for cell in _cells(header.rows, column)]
    mark = decimal_mark(numbers)
    columns = _with_units(path, header, length_unit)
    place, width = (_chosen(path, header, columns, kinds) for kinds in ((PLACE,), (DIAMETER, RADIUS)))
    x = [_number(path, row, place, mark) for row in header.rows]
    d = [_number(path, row, width, mark) for row in header.rows]
    points = _ordered(path, header, place, list(zip(x, d, strict=True)))
    if len(points) < 2:
        raise InputError(path, "", f"must hold at least 2 points; got {len(points)}")
    inside = _inside(path, header, columns, mark, d)
    if any(each != Inside() for each in inside) and (from_butt(place) or points[0][0] != x[0]):
        problem = "must run from tip to butt where a bore or a material stands beside it: each holds from its row on"
        raise InputError(path, f"line {header.line}, x", problem)
    behind = dict(zip(x, inside, strict=True))
    with faults_of(path, ""):
        cue, bored = _drawn(points, [behind.get(at, Inside()) for at, _ in points], material, place.unit)
        ferrule = _ferrule_with_length(path, header, inside)
        notes = [*_notes(header, place, width, points), *bored]
        return fitted(cue, ferrule=ferrule) if ferrule else cue, notes


def _drawn(points: Sequence[Point], inside: Sequence[Inside], material: Material, unit: str) -> tuple[Cue, list[str]]:
    """The cue of points with what lies inside from each on, and where it is bored, in words."""
    per, segments, bored = number(f"1 {unit}", "m"), list[Segment](), list[str]()

    def bores(i: int) -> tuple[float, float]:
        """The bore tapers to the next row's in the same materials; the last row draws nothing behind it."""
        here, behind = inside[i], inside[i + 1]
        same = i + 2 == len(inside) or replace(here, bore=0.0) == replace(behind, bore=0.0)
        return (here.bore, behind.bore) if here.bore and behind.bore and same else (here.bore, here.bore)

    def alike(i: int) -> tuple[object, ...]:
        """What two intervals share that may be one segment; an interval with a tapered bore is one by itself."""
        return bores(i), replace(inside[i], bore=0.0), i if bores(i)[0] != bores(i)[1] else None

    for _, run in itertools.groupby(range(len(points) - 1), key=alike):
        first, *others = run
        here, widths = inside[first], bores(first)
        run_of = points[first : first + len(others) + 2]
        x, d = np.array(run_of).T
        ends = (run_of[k] for k in corners(x, d[:, None], _STRAIGHT))
        wood = here.material or material
        rest = (wood, *widths, here.core if widths[0] else None)
        drawn = [Segment(_apart(x0, x1), d0, d1, *rest) for (x0, d0), (x1, d1) in itertools.pairwise(ends)]
        segments += drawn if here.ferrule is None else [on_tenon(s, here.ferrule, wood) for s in drawn]
        if widths[0]:
            sizes = " to ".join(f"{size / per:.6g}" for size in dict.fromkeys(widths))
            filled = f" and filled with {material_name(here.core)}" if here.core else ""
            bored.append(f"bored {sizes} {unit} from {x[0] / per:.6g} to {x[-1] / per:.6g} {unit}{filled}")
    return Cue(tuple(segments)), bored


def _inside(
    path: Path, header: Header, columns: Sequence[ProfileColumn], mark: str, diameters: Sequence[float]
) -> list[Inside]:
    """The bore and the materials of every row. An empty cell repeats the material above; bore, core and ferrule hold
    for their own row."""
    bore = next((column for column in columns if column.kind == BORE), None)
    named = {column.kind: column for column in header.names}
    rows, material = list[Inside](), None
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
            problem = f"must stand beside a bore, which it fills; got {shown(_entry(cells, named[CORE]))}"
            raise InputError(path, f"line {line}, core", problem)
        rows.append(Inside(width, material, found.get(CORE), found.get(FERRULE)))
    return rows


def _ferrule_with_length(path: Path, header: Header, inside: Sequence[Inside]) -> str:
    """The ferrule of a cell such as "25 mm melamine", which begins at its row; "" if no cell has a length."""
    column = next((column for column in header.names if column.kind == FERRULE), None)
    entries = [_entry(cells, column) if column else "" for _, cells in header.rows]
    told = [(i, text) for i, text in enumerate(entries) if has_length(text)]
    front = next((i for i, each in enumerate(inside) if each.material is None or each.material.E >= SOFT), 0)
    for i, text in told:
        if i != front or len([*filter(None, entries)]) > 1:
            problem = f"with a length must be the only one, in the first line of the shaft; got {shown(text)}"
            raise InputError(path, f"line {header.rows[i][0]}, ferrule", problem)
    return told[0][1] if told else ""


def _entry(cells: Sequence[str], column: ProfileColumn) -> str:
    """A cell's text, "" where it says that there is nothing."""
    text = cells[column.index].strip() if column.index < len(cells) else ""
    return "" if text.casefold() in _NOTHING else text


def _notes(header: Header, place: ProfileColumn, width: ProfileColumn, points: Sequence[Point]) -> list[str]:
    """How the columns and lines were read."""
    names = header.unused
    butt, first = from_butt(place), points[0][0] if points else 0.0
    told = f"{first / number(f'1 {place.unit}', 'm'):.6g} {place.unit}"
    lines = ", ".join(map(str, header.passed[:MOST])) + ", ..." * (len(header.passed) > MOST)
    notes = {
        f"line{'s' * (len(header.passed) > 1)} {lines} passed over: no numbers of the table": bool(header.passed),
        f"column{'s' if len(names) > 1 else ''} {', '.join(map(shown, names))} {'are' if len(names) > 1 else 'is'} not "
        "used": bool(names),
        f"diameters are twice the column {shown(width.name)}": width.kind == RADIUS,
        f"x is measured from the butt, as {shown(place.name)} says": butt,
        f"the shaft begins at its first point, x = {told}: nothing is drawn before it": first > 0 and not butt,
    }
    return [note for note, holds in notes.items() if holds]


def _cells(rows: Sequence[Row], column: ProfileColumn) -> list[str]:
    return [cells[column.index] if column.index < len(cells) else "" for _, cells in rows]


def _with_units(path: Path, header: Header, length_unit: str | None) -> list[ProfileColumn]:
    """The columns with the units that header, cells or ``length_unit`` say; InputError if there are none."""
    columns = []
    for column in header.used:
        beside = {unit_of(rest) for _, rest in map(parted, _cells(header.rows, column)) if rest}
        unit = column.unit or ("".join(beside) if len(beside) == 1 else "")
        columns.append(ProfileColumn(column.kind, column.index, column.name, unit))
    bare = [column for column in columns if not column.unit]
    if length_unit is not None:
        if not bare:
            problem = f"names its units itself: length_unit is for a table without units; got {shown(length_unit)}"
            raise InputError(path, "", problem)
        if not unit_of(length_unit):
            raise InputError(path, "length unit", f"must be a unit of length, such as mm; got {shown(length_unit)}")
    if bare and length_unit is None:
        names, written = (",".join(f"{column.name}{unit}" for column in bare) for unit in ("", " [mm]"))
        problem = f'{shown(names)} must name the unit: write "{written}" if these are mm, or give --length-unit'
        raise InputError(path, f"line {header.line}", problem)
    unit = unit_of(length_unit) if length_unit is not None else ""
    return [ProfileColumn(c.kind, c.index, c.name, c.unit or unit) for c in columns]


def _chosen(path: Path, header: Header, columns: Sequence[ProfileColumn], kinds: Sequence[str]) -> ProfileColumn:
    """The one column of these kinds."""
    first, *more = [column for column in columns if column.kind in kinds]
    if more:
        both = f"{shown(first.name)} and {shown(more[0].name)}"
        raise InputError(path, f"line {header.line}", f"two columns may be the {kinds[0]}, {both}: keep one")
    return first


def _number(path: Path, row: Row, column: ProfileColumn, mark: str) -> float:
    """A cell as an SI number, a radius doubled."""
    line, cells = row
    cell = cells[column.index] if column.index < len(cells) else ""
    kind, where = column.kind, f"line {line}, {column.kind}"
    text, rest = parted(cell)
    unit = (unit_of(rest) if rest else column.unit) or ""
    if not text or not unit:
        raise InputError(path, where, f"must be a number; got {shown(cell) if cell else 'nothing'}")
    with faults_of(path, where):
        value = (_POSITION if kind == PLACE else _HOLE if kind == BORE else WIDTH).read(f"{plain(text, mark)} {unit}")
    return 2 * value if kind == RADIUS else value


def _ordered(path: Path, header: Header, place: ProfileColumn, points: list[Point]) -> tuple[Point, ...]:
    """The points from tip to butt; InputError if their order goes both ways."""
    if from_butt(place):
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
            scale = number(f"1 {place.unit}", "m")
            before, here = (f"{value / scale:g}" for value in (ordered[-1][0], x))
            problem = f"must be beyond {before} {place.unit}, the x of the line before (points run from tip to butt)"
            step = "; a step in the diameter is two points a little apart, such as "
            hint = f"{step}{before} and {x / scale + 0.1:g} {place.unit}" if x == ordered[-1][0] else ""
            raise InputError(path, f"line {line}, x", f"{problem}; got '{here} {place.unit}'{hint}")
        ordered.append((x, d))
    return tuple(ordered)


def _apart(first: float, last: float) -> float:
    """The distance as decimals have it: 10 and 210 mm are 0.2 m apart, which floats miss by their last digit."""
    return float(Decimal(repr(last)) - Decimal(repr(first)))
