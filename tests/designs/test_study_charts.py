"""Charts of a study: each drawn position equals a number of its tables (verification)."""

import re

import numpy as np

from cuefem.cue import Array
from cuefem.designs import Response
from cuefem.designs.sweep import MAX_POINTS, SweepStatistics, sweep_charts

PAIR = (Response.of("squirt(0.3)"), Response.of("tip_stiffness"))


def positions(outline: str) -> Array:
    """The points of an SVG path, (points, 2)."""
    return np.array(re.findall(r"[ML](\S+) ([-\d.]+)", outline), float)


def sweep(columns: dict[str, np.ndarray], results: Array) -> SweepStatistics:
    units = ("m",) * len(columns)
    return SweepStatistics(tuple(columns), units, PAIR, np.arange(len(results)), tuple(columns.values()), results)


def two_parameters(count: int) -> SweepStatistics:
    bore, wall = np.random.default_rng(1).random((2, count))
    return sweep({"bore": bore, "wall": wall, "same": np.ones(count)}, np.stack([1 - bore + wall, 900 - bore], axis=1))


def test_chart_of_many_designs_shows_an_even_part() -> None:
    few, many = (sweep_charts(two_parameters(count))[0].points[0] for count in (MAX_POINTS, 10_000))
    assert (few[0], len(positions(few[2]))) == ("designs", MAX_POINTS)
    assert (many[0], len(positions(many[2]))) == ("2000 of 10000 designs, evenly spaced", MAX_POINTS)
