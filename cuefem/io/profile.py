"""Lathe profiles: a CSV of diameters measured along a shaft, from the tip to the butt, as conical segments."""

from __future__ import annotations

import csv
import itertools
import math
import re
from decimal import Decimal
from pathlib import Path

from cuefem.cue import Cue, Material, Segment
from cuefem.io.errors import InputError, shown
from cuefem.io.toml import read_text
from cuefem.io.units import number, quantity
from cuefem.quantity import DIAMETER, Quantity

DEFAULT_MATERIAL = "hard maple"
DEFAULT_UNIT = "mm"  # of a surface's coordinates
SURFACES = (".stl", ".ply", ".obj")
SHAPES = (".csv", *SURFACES)  # the files that say a shaft's shape and no material
# Points closer than this to a straight taper lie on it, m: the rounding of a file, far below what a lathe measures.
_STRAIGHT = 1e-9

_HEADER = re.compile(r"\s*(x|diameter)\s*[\[(]([^])]+)[\])]\s*")
_COMMAS = "; commas part the columns, numbers have a decimal point"
_POSITION, _DIAMETER = Quantity("m"), DIAMETER

Point = tuple[float, float]  # position, diameter, m


def load_profile(path: Path, material: Material) -> Cue:
    """The shaft of a CSV with the header ``x [mm],diameter [mm]`` (any units of length), x rising from tip to butt.

    The first x may have any value: the shaft begins there. One segment an interval; straight tapers become one.
    """
    lines = list(enumerate(read_text(path).splitlines(), start=1))
    rows = [(i, next(csv.reader([line]))) for i, line in lines if line.strip() and not line.lstrip().startswith("#")]
    if not rows:
        raise InputError(path, "", 'must begin with the header "x [mm],diameter [mm]"; got comments alone')
    units = _units(path, *rows[0])
    points: list[Point] = []
    for line, cells in rows[1:]:
        points.append(_point(path, line, cells, units, points))
    if len(points) < 2:
        raise InputError(path, "", f"must hold at least 2 points; got {len(points)}")
    pairs = itertools.pairwise(_corners(points))
    try:
        return Cue(tuple(Segment(_apart(x0, x1), d0, d1, material) for (x0, d0), (x1, d1) in pairs))
    except ValueError as error:
        raise InputError(path, "", str(error)) from None


def _apart(first: float, last: float) -> float:
    """The distance as decimals have it: 10 and 210 mm are 0.2 m apart, which floats miss by their last digit."""
    return float(Decimal(repr(last)) - Decimal(repr(first)))


def _units(path: Path, line: int, cells: list[str]) -> tuple[str, str]:
    found = [_HEADER.fullmatch(cell) for cell in cells]
    names = [match[1] if match else None for match in found]
    if names != ["x", "diameter"]:
        hint = _COMMAS if any(";" in cell for cell in cells) else ""
        problem = f'must be the header "x [mm],diameter [mm]"; got {shown(",".join(cells))}{hint}'
        raise InputError(path, f"line {line}", problem)
    units = (found[0][2], found[1][2])  # type: ignore[index]
    for name, unit in zip(names, units, strict=True):
        try:
            number(f"1 {unit}", "m")
        except ValueError:
            problem = f"must be in a unit of length, such as mm; got {shown(unit)}"
            raise InputError(path, f"line {line}, {name}", problem) from None
    return units


def _point(path: Path, line: int, cells: list[str], units: tuple[str, str], before: list[Point]) -> Point:
    if len(cells) != 2:
        hint = _COMMAS if len(cells) > 2 or ";" in cells[0] else ""
        problem = f"must be two numbers, x and diameter; got {shown(','.join(cells))}{hint}"
        raise InputError(path, f"line {line}", problem)
    read = []
    for name, cell, unit, wanted in zip(("x", "diameter"), cells, units, (_POSITION, _DIAMETER), strict=True):
        try:
            read.append(quantity(wanted, f"{cell} {unit}"))
        except ValueError as error:
            raise InputError(path, f"line {line}, {name}", str(error)) from None
    x, diameter = read
    if before and x <= before[-1][0]:
        bound = f"must be in ({before[-1][0] / number(f'1 {units[0]}', 'm'):g}, inf) {units[0]}, beyond the line before"
        raise InputError(path, f"line {line}, x", f"{bound} (points run from tip to butt); got '{cells[0]} {units[0]}'")
    return x, diameter


def _corners(points: list[Point]) -> list[Point]:
    """The points where the taper changes: each straight run is taken as far as all its points lie on it."""
    ends, first = [points[0]], 0
    least, most = _slopes(points[0], points[1])
    for last in range(2, len(points)):
        (x0, d0), (x1, d1) = points[first], points[last]
        if not least <= (d1 - d0) / (x1 - x0) <= most:
            first = last - 1
            ends.append(points[first])
            least, most = -math.inf, math.inf
        low, high = _slopes(points[first], points[last])
        least, most = max(least, low), min(most, high)
    return [*ends, points[-1]]


def _slopes(start: Point, point: Point) -> tuple[float, float]:
    """The least and the largest slope of a straight taper from ``start`` that ``point`` lies on."""
    (x0, d0), (x, d) = start, point
    return (d - _STRAIGHT - d0) / (x - x0), (d + _STRAIGHT - d0) / (x - x0)
