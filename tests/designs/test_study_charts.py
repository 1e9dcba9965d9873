"""Charts of a study: each drawn position equals a number of its tables (verification)."""

import re

import numpy as np
import pytest

from cuefem.cue import Array
from cuefem.designs import Response
from cuefem.designs.sweep import MAX_POINTS, SweepStatistics, sweep_charts
from cuefem.quantity.display_units import displayed_in
from cuefem.show.charts import Chart

PAIR = (Response.of("squirt(0.3)"), Response.of("tip_stiffness"))


def positions(outline: str) -> Array:
    """The points of an SVG path, (points, 2)."""
    return np.array(re.findall(r"[ML](\S+) ([-\d.]+)", outline), float)


def numbers(drawn: Chart, outline: str) -> Array:
    """The points of a path in the units of a chart's axes, (points, 2)."""
    left, top, right, bottom = drawn.box
    ends = ((left, right), (bottom, top))
    columns = zip(positions(outline).T, ends, (drawn.x_scale, drawn.y_scale), strict=True)
    scaled = [scale.low + (at - a) / (b - a) * (scale.high - scale.low) for at, (a, b), scale in columns]
    return np.stack(scaled, axis=1)


def sweep(columns: dict[str, np.ndarray], results: Array) -> SweepStatistics:
    units = ("m",) * len(columns)
    return SweepStatistics(tuple(columns), units, PAIR, np.arange(len(results)), tuple(columns.values()), results)


def two_parameters(count: int) -> SweepStatistics:
    bore, wall = np.random.default_rng(1).random((2, count))
    return sweep({"bore": bore, "wall": wall, "same": np.ones(count)}, np.stack([1 - bore + wall, 900 - bore], axis=1))


def test_chart_of_each_varied_parameter_has_medians() -> None:
    bore = np.repeat([2e-3, 5e-3, 9e-3], 5)
    squirt = np.radians(1 + np.tile([0.0, 0.1, 0.2, 0.3, 0.9], 3) - 100 * bore)
    found = sweep({"bore": bore, "same": np.ones(15)}, np.stack([squirt, 900 - bore], axis=1))
    _, *charts = sweep_charts(found)
    assert [(drawn.title, drawn.x_label) for drawn in charts] == [("squirt at b/R 0.3 by bore", "bore, mm")]
    name, _, outline = charts[0].curves[0]
    assert name == "median"
    assert numbers(charts[0], outline) == pytest.approx(np.array([[2, 1.0], [5, 0.7], [9, 0.3]]), abs=0.01)
    with displayed_in("us"):
        assert sweep_charts(found)[1].x_label == "bore, in"


def test_names_stand_on_the_axis_of_a_chart() -> None:
    wood = np.repeat(["hard maple", "ash", "a wood of a very long name"], 2)
    squirt = np.radians([1.0, 1.2, 2.0, 2.2, 3.0, 3.2])
    drawn = sweep_charts(sweep({"wood": wood}, np.stack([squirt, np.arange(6.0)], axis=1)))[1]
    assert [tick.label for tick in drawn.y_ticks] == ["a wood of a very lo…", "ash", "hard maple"]
    assert numbers(drawn, drawn.points[1][2])[:, 0] == pytest.approx([3.1, 2.1, 1.1], abs=0.01)
    assert (drawn.y_ticks[2].at < drawn.y_ticks[0].at, drawn.is_read) == (True, False)


def test_chart_of_many_designs_shows_an_even_part() -> None:
    few, many = (sweep_charts(two_parameters(count))[0].points[0] for count in (MAX_POINTS, 10_000))
    assert (few[0], len(positions(few[2]))) == ("designs", MAX_POINTS)
    assert (many[0], len(positions(many[2]))) == ("2000 of 10000 designs, evenly spaced", MAX_POINTS)


def test_equal_results_and_one_design_are_drawn() -> None:
    equal = np.full((9, 2), 0.02)
    drawn = sweep_charts(sweep({"bore": np.arange(9.0)}, equal))[1]
    assert drawn.y_scale.low < np.degrees(0.02) < drawn.y_scale.high
    assert len(drawn.y_ticks) > 2
    assert sweep_charts(sweep({"bore": np.arange(1.0)}, equal[:1])) == []
