"""Diameters of a lathe table that do not belong to their shaft: a slipped decimal point, or another unit.

The limits were chosen on real drawings and on random ones; `tests/files/test_misplaced_diameters.py` measures how many
slips are found and that no plausible drawing is rejected.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from itertools import pairwise
from typing import NamedTuple

from cuefem.quantity.unit_checks import CUE_DIAMETER

MAX_BUMP = 1.6  # ratio of a row to both neighbours, if these agree within it: ferrule to collar is 1.5, and one step
MAX_RATIO = 2.0  # of a row outside CUE_DIAMETER to the nearest rows inside
BETWEEN_RATIO = 1.5  # within which a corrected row fits the rows on both sides; a row at an end fits within MAX_RATIO
ROUNDING = 0.6  # diameters: a rounded or chamfered end, or a bumper, becomes its full width within this length
SAME_WIDTH = 0.02  # relative difference within which an end row, corrected, has the width of the next one
_POWERS = {10.0**power: "decimal point?" for power in (-1, 1, -2, 2, -3, 3)}
_IN_INCHES = _POWERS | {1 / 25.4: "in mm?"}  # factors of a column in inches
_IN_METRES = _POWERS | {25.4: "in inches?"}  # of one in mm, cm or m
_ALL_FACTORS = (*_POWERS, 25.4, 1 / 25.4)


class MisplacedRow(NamedTuple):
    """A row that does not belong to its shaft.

    neighbours: the nearest rows that do. factor: by which it would fit; nan if none does. question: what that means.
    """

    row: int
    neighbours: tuple[int, ...]
    factor: float
    question: str


def misplaced_rows(x: Sequence[float], d: Sequence[float], *, in_inches: bool) -> list[MisplacedRow]:
    """Rows, m, whose diameter does not belong to the shaft of the others; x increases.

    Empty if most rows are outside `CUE_DIAMETER`: then the unit of the column is wrong, or these are radii.
    """
    count = len(d)
    is_usual = [CUE_DIAMETER[0] <= each <= CUE_DIAMETER[1] for each in d]
    if 2 * sum(is_usual) < count:
        return []
    rounded = {*_rounded_end(x, d, range(count)), *_rounded_end(x, d, range(count - 1, -1, -1))}
    bumps = {i for i in range(1, count - 1) if _is_bump(x, d, i) and not rounded & {i - 1, i + 1}}
    sound = [i for i in range(count) if is_usual[i] and i not in bumps]
    factors = _IN_INCHES if in_inches else _IN_METRES
    found = []
    for i in range(count):
        if i in rounded or i in sound:
            continue
        neighbours = _neighbours(i, sound)
        nearby = [d[k] for k in neighbours]
        if _is_off(d[i], nearby, MAX_BUMP) if i in bumps else _is_off(d[i], nearby, MAX_RATIO):
            factor = _fitting_factor(d[i], nearby, factors)
            found.append(MisplacedRow(i, neighbours, factor, factors.get(factor, "")))
    return found


def _rounded_end(x: Sequence[float], d: Sequence[float], order: Sequence[int]) -> list[int]:
    """The rows, from an end on, that widen within `ROUNDING` diameters: a dome, a chamfer or a bumper.

    An end that has the width of the shaft but for a factor is none of these.
    """
    rows, width = list[int](), d[order[0]]
    for i, inner in pairwise(order):
        is_near_end = abs(x[inner] - x[order[0]]) <= ROUNDING * d[inner]
        if d[i] >= d[inner] or not is_near_end:
            break
        rows.append(i)
        width = d[inner]
    return [] if rows and _is_slip(d[order[0]], d[order[1]], width) else rows


def _is_slip(end: float, second: float, width: float) -> bool:
    """Whether the row at an end has the width of the shaft but for a factor, and the second one has that width."""
    is_wide = second * (1 + SAME_WIDTH) >= width
    return is_wide and any(abs(factor * end / second - 1) <= SAME_WIDTH for factor in _ALL_FACTORS)


def _is_bump(x: Sequence[float], d: Sequence[float], i: int) -> bool:
    """Whether row i departs from two rows beside it that agree; rows at one position are a step."""
    before, after = d[i - 1], d[i + 1]
    agree = max(before, after) < MAX_BUMP * min(before, after)
    return agree and x[i - 1] != x[i] != x[i + 1] and _is_off(d[i], [before, after], MAX_BUMP)


def _is_off(own: float, nearby: Sequence[float], ratio: float) -> bool:
    """Whether a diameter is more than ``ratio`` times those nearby, or as much smaller."""
    return not min(nearby) / ratio < own < max(nearby) * ratio


def _neighbours(row: int, sound: Sequence[int]) -> tuple[int, ...]:
    """The nearest sound rows in front of a row and behind it; one of them at an end."""
    before = [k for k in sound if k < row][-1:]
    behind = [k for k in sound if k > row][:1]
    return (*before, *behind)


def _fitting_factor(own: float, nearby: Sequence[float], factors: Iterable[float]) -> float:
    """The factor by which a diameter fits those nearby best; nan if none does."""
    slack = BETWEEN_RATIO if len(nearby) == 2 else MAX_RATIO
    middle = math.sqrt(min(nearby) * max(nearby))
    fitting = [factor for factor in factors if not _is_off(factor * own, nearby, slack)]
    return min(fitting, key=lambda factor: abs(math.log(factor * own / middle)), default=math.nan)
