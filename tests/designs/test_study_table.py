"""Tables of a study: sensitivities, Pareto fronts, best designs (verification)."""

import itertools
import math
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

import cuefem as cf
from cuefem.designs import Response
from cuefem.designs.sweep import MAX_POINTS, SweepResult, SweepStatistics, _shown, _trend, sweep_charts
from cuefem.files.defaults_report import Assumption
from cuefem.results.uncertainty import RATIO_FLOOR, SHAFT_ERROR
from tests.helpers.examples import examples
from tests.helpers.sweeps import STUDY, write_study

PAIR = (Response.of("end_mass"), Response.of("tip_stiffness"))


def table(
    columns: dict[str, np.ndarray], results: np.ndarray, responses: tuple[Response, ...] = PAIR
) -> SweepStatistics:
    units = ("",) * len(columns)
    return SweepStatistics(tuple(columns), units, responses, np.arange(len(results)), tuple(columns.values()), results)


def test_shares_of_grid_equal_exact_variances() -> None:
    """y = 3 a + b + 2 a c on a, b, c = -1, 0, 1: variances 6, 2/3 and 16/9 of a sum."""
    a, b, c = np.array(list(itertools.product((-1.0, 0.0, 1.0), repeat=3))).T
    y = 3 * a + b + 2 * a * c
    result = table({"a": a, "b": b, "c": c}, np.stack([y, -b], axis=1))
    whole = 9 * 2 / 3 + 2 / 3 + 4 * 4 / 9
    assert result.shares[:, 0] == pytest.approx([6 / whole, 2 / 3 / whole, 0.0], rel=1e-12, abs=1e-12)
    assert result.shares[:, 1] == pytest.approx([0, 1, 0], abs=1e-12)
    assert [row[0] for row in result.trends] == ["rises", "rises", ""]
    assert result.trends[1][1] == "falls"


def test_shares_of_sample_and_of_choices_equal_exact_variances() -> None:
    """y = x + z/2 has shares of 80 and 20 %, a column without effect 0; waves are resolved; choices are groups."""
    x, z, w = np.random.default_rng(3).random((3, 2000))
    result = table({"x": x, "z": z, "w": w}, np.stack([x + z / 2, w], axis=1))
    assert result.shares[:, 0] == pytest.approx([0.8, 0.2, 0.0], abs=0.045)
    waves = table({"x": x}, np.stack([np.cos(4 * np.pi * x), w], axis=1))
    assert waves.shares[0, 0] == pytest.approx(1.0, abs=0.1)
    wood = np.array(["maple", "ash"] * 6)
    named = table({"wood": wood}, np.stack([np.where(wood == "ash", 1.0, 2.0), np.arange(12.0)], axis=1))
    assert (named.shares[0, 0], named.trends) == (pytest.approx(1.0, rel=1e-12), [["", ""]])


@examples(12)
@given(arrays(int, (60, 2), elements=st.integers(0, 11)))  # with ties
def test_pareto_front_has_undominated_designs(numbers: np.ndarray) -> None:
    results = numbers.astype(float)
    result = table({"x": np.arange(60.0)}, results)
    costs = results * [1, -1]  # stiffness is better if it is higher
    dominated = [any((other <= own).all() and (other < own).any() for other in costs) for own in costs]
    assert {tuple(costs[i]) for i in result.front} == {tuple(w) for w, b in zip(costs, dominated, strict=True) if not b}
    assert all(not dominated[i] for i in result.front)
    assert result.best(0) in np.flatnonzero(results[:, 0] == results[:, 0].min())
    assert result.best(1) in np.flatnonzero(results[:, 1] == results[:, 1].max())


def test_neighbours_on_the_front_that_are_not_distinct_are_marked(tmp_path: Path) -> None:
    """By the rule of `compare`: a bore of 0 or 1 mm changes the end mass by less than its uncertainty."""
    result = cf.study(write_study(tmp_path, STUDY.replace('values = ["hard maple", "ash"]', 'values = ["ash"]')))
    assert isinstance(result, SweepResult)
    assert result.statistics is not None
    steps = result.to_dict()["summary"]["front"]["steps"]
    shown = result.statistics.numbers[result.statistics.shown_front].tolist()
    assert [(step["from"], step["to"]) for step in steps] == [*itertools.pairwise(shown)]
    for step in steps:
        ratio = result.responses["end_mass"][step["to"]] / result.responses["end_mass"][step["from"]]
        change = step["changes"]["end_mass"]
        assert change["difference"] == pytest.approx(ratio - 1, rel=1e-12)
        # of one wood and one tip only the model's part and the floor remain
        part = math.hypot(SHAFT_ERROR * math.log(ratio), RATIO_FLOOR) * (ratio - 1) / math.log(ratio)
        assert change["error"] == pytest.approx(part, rel=1e-9)
    marks = [step["changes"][name]["distinct"] for step in steps for name in ("end_mass", "tip_stiffness")]
    assert {*marks} == {True, False}
    text = str(result)
    assert (text.count("% *"), "the two designs are not distinct" in " ".join(text.split())) == (
        marks.count(False),
        True,
    )


@pytest.mark.heavy
def test_best_squirt_has_the_uncertainty_of_a_verdict() -> None:
    scene = cf.usual_scene(cf.Cue((cf.Segment(0.7, 0.01275, 0.021, cf.material("hard maple")),), body_mass=0.43))
    result = cf.study(
        cf.Study(scene, (cf.Vary("tip diameter", cf.Span(0.0115, 0.0125, count=2)),), (cf.Response("squirt"),))
    )
    own = cf.verdict(result.best["squirt"].scene)
    relative = result.errors["squirt"] / own.squirt
    assert relative == pytest.approx(math.hypot(own.uncertainty["model"], own.uncertainty["inputs"]), rel=1e-3)
    assert f"{math.degrees(own.squirt):.2f} ± {math.degrees(result.errors['squirt']):.2f}" in str(result)
    assert "<summary>1 assumption</summary>" in result.to_html(assumptions=[Assumption("", "ball 170 g")])


def test_trend_has_a_rank_correlation_of_more_than_a_fifth() -> None:
    """Of ten ranks: 1 - 6 * 130 / 990 is 0.212, and 1 - 6 * 132 / 990 is 0.2."""
    beyond, at = np.array([2, 1, 8, 3, 4, 7, 6, 5, 9, 0]), np.array([0, 1, 9, 6, 8, 2, 4, 7, 5, 3])
    assert [_trend(np.arange(10), each) for each in (beyond, -beyond, at)] == ["rises", "falls", ""]


def test_chart_of_many_designs_shows_an_even_part() -> None:
    for count, said in ((MAX_POINTS, "designs"), (5 * MAX_POINTS, "2000 of 10000 designs, evenly spaced")):
        bore = np.random.default_rng(1).random(count)
        drawn = sweep_charts(table({"bore": bore}, np.stack([bore, 900 - bore], axis=1)))[0].points[0]
        assert (drawn[0], drawn[2].count("M")) == (said, MAX_POINTS)
        assert _shown(np.arange(count))[0][[0, -1]].tolist() == [0, count - 1]
