"""A study as a page: its best designs, what drives the results, all designs as lines and as small charts."""

from __future__ import annotations

from itertools import pairwise
from textwrap import wrap
from typing import NamedTuple

import numpy as np

from cuefem.cue import Array
from cuefem.report.charts import path
from cuefem.report.glossary import with_words
from cuefem.report.study_table import (
    DRIVES,
    TREND,
    StudyTable,
    best_sheet,
    drive_sheet,
    front_sheet,
    front_words,
    shown,
)
from cuefem.report.templates import environment
from cuefem.results.quantities import with_heading
from cuefem.results.records import Sheet

MOST_LINES, MOST_POINTS = 300, 500  # drawn of many designs, evenly picked by their number
MOST_COLUMNS = 6  # small charts of a response: for its strongest drivers
SHADES = 5  # of lines, from the best fifth to the worst
SOBOL = (
    "The part of the variance that goes away if a cause is known, and "
    "in brackets the part that stays if all others are known. Neither is exact: the command prints their intervals."
)
LETTER, LINE, NAME = 7.6, 16, 14  # width and height of a letter over an axis; letters in a line of its name
FRONT = 30  # designs of the front in its table


class Panel(NamedTuple):
    """A small chart: points in a box of 200 by 150 with its axes' ends; ``curve``: a line through some of them."""

    title: str
    x_label: str
    points: tuple[tuple[float, float], ...]
    x_ends: tuple[str, str]
    y_ends: tuple[str, str]
    curve: str = ""


class Coordinate(NamedTuple):
    """An axis of the parallel coordinates: where it stands, its name in lines, and what stands at its ends."""

    x: float
    name: list[str]
    low: str
    high: str


BOX = (42.0, 196.0, 10.0, 112.0)  # left, right, top, bottom of a panel's plot


class Scattered(NamedTuple):
    """What a scatter's page has in the place of best designs: its distribution, and the shares of its causes."""

    spread: Sheet
    drives: Sheet


def study_page(name: str, table: StudyTable, facts: list[str], *, scattered: Scattered | None = None) -> str:
    """The page. facts: lines below its title. scattered: of a study that scatters, not one to choose a design from."""
    template = environment().get_template("study.html.j2")
    fronts = None
    if table.pair is not None:
        fronts = (front_words(table, FRONT), front_sheet(table, FRONT), _front_panel(table))
    lines, coordinates, wide = _parallel(table)
    first = table.responses[table.judged[0]]
    text = template.render(
        name=name,
        facts=facts,
        best=None if scattered else best_sheet(table),
        spread=scattered and scattered.spread,
        drives=scattered.drives if scattered else drive_sheet(table),
        drives_words=SOBOL if scattered else f"{DRIVES.partition(': ')[2].capitalize()}. {TREND.capitalize()}.",
        front=None if scattered else fronts,
        lines=lines,
        coordinates=coordinates,
        wide=wide,
        line=LINE,
        above=8 + LINE * max(len(axis.name) - 1 for axis in coordinates),
        shade=f"{first.label}, the {'highest' if first.better == 'higher' else 'lowest'} fifth",
        panels=[
            (response.heading, _panels(table, k, shares=scattered is None))
            for k, response in enumerate(table.responses)
        ],
        shown_of=_picked(len(table.results), MOST_LINES).size,
        total=len(table.results),
    )
    return with_words(text)


def _picked(count: int, most: int) -> Array:
    return np.unique(np.linspace(0, count - 1, min(count, most)).round().astype(int))


def _places(column: np.ndarray) -> Array:
    """A column as numbers: names by their order."""
    numbers = column if column.dtype.kind in "fi" else np.unique(column, return_inverse=True)[1]
    return np.asarray(numbers, float)


def _ends(column: np.ndarray, unit: str) -> tuple[str, str]:
    levels = np.unique(column)  # of names in the order of the alphabet
    return shown(levels[0], unit), shown(levels[-1], unit)


def _scaled(values: Array, low: float, high: float) -> Array:
    span = values.max() - values.min()
    return low + (values - values.min()) / span * (high - low) if span > 0 else np.full(len(values), (low + high) / 2)


def _parallel(table: StudyTable) -> tuple[list[tuple[str, int]], list[Coordinate], float]:
    """Lines of designs over what varied and the responses, best drawn last, with their shade; the axes; the width."""
    columns = [*table.values, *table.results.T]
    headings = [*map(with_heading, table.labels, table.units), *(r.heading for r in table.responses)]
    names = [wrap(near, NAME) for near in headings]
    units = [*table.units, *(r.unit for r in table.responses)]
    widths = [max(map(len, lines)) for lines in names]
    beside = [near + other for near, other in pairwise(widths)]
    step = max(110.0, LETTER * (max(beside) / 2 + 2))  # names of neighbours do not meet
    x = step / 2 + step * np.arange(len(columns))
    y = np.array([_scaled(_places(column), 200.0, 30.0) for column in columns])
    order = table.wanted[:, table.judged[0]].argsort().argsort()
    shade = np.minimum(SHADES * order // len(order), SHADES - 1)
    rows = _picked(len(order), MOST_LINES)
    rows = rows[np.argsort(-order[rows])]
    lines = [(path(x, y[:, i]), int(shade[i])) for i in rows]
    axes = [Coordinate(float(at), name, *_ends(c, u)) for at, name, c, u in zip(x, names, columns, units, strict=True)]
    return lines, axes, float(x[-1] + step / 2)


def _panel(title: str, x_label: str, x: np.ndarray, y: np.ndarray, units: tuple[str, str], rows: Array) -> Panel:
    left, right, top, bottom = BOX
    across, up = _scaled(_places(x), left, right)[rows], _scaled(_places(y), bottom, top)[rows]
    points = tuple((round(float(a), 1), round(float(b), 1)) for a, b in zip(across, up, strict=True))
    return Panel(title, x_label, points, _ends(x, units[0]), _ends(y, units[1]))


def _panels(table: StudyTable, k: int, *, shares: bool) -> list[Panel]:
    """A response over each of its strongest drivers."""
    response, rows = table.responses[k], _picked(len(table.results), MOST_POINTS)
    strongest = sorted(range(len(table.names)), key=lambda j: -table.shares[j, k])[:MOST_COLUMNS]
    return [
        _panel(
            f"{100 * table.shares[j, k]:.0f} % of the spread" if shares else response.heading,
            with_heading(table.labels[j], table.units[j]),
            table.values[j],
            table.results[:, k],
            (table.units[j], response.unit),
            rows,
        )
        for j in strongest
    ]


def _front_panel(table: StudyTable) -> Panel:
    """The pair of responses, all designs as points and the front as a line."""
    assert table.pair is not None
    sideways, other = (table.responses[k] for k in table.pair)
    first, second = (table.results[:, k] for k in table.pair)
    units = (sideways.unit, other.unit)
    panel = _panel(other.heading, sideways.heading, first, second, units, _picked(len(first), MOST_POINTS))
    left, right, top, bottom = BOX
    across, up = _scaled(first, left, right), _scaled(second, bottom, top)
    return panel._replace(curve=path(across[table.front], up[table.front]))
