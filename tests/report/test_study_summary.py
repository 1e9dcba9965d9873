"""The summary of a study: best designs, drivers and fronts against what they are by definition (verification)."""

import itertools
import json
import re
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

import cuefem as cf
from cuefem.design import Response
from cuefem.report.study_table import StudyTable, column_label, front_sheet
from cuefem.results.asking import asked
from tests.helpers.command_line import said
from tests.helpers.refusals import command_refuses
from tests.helpers.sweeps import STUDY, written

PAIR = (Response.of("end_mass"), Response.of("tip_stiffness"))


def table(columns: dict[str, np.ndarray], results: np.ndarray, responses: tuple[Response, ...] = PAIR) -> StudyTable:
    units = ("",) * len(columns)
    return StudyTable(tuple(columns), units, responses, np.arange(len(results)), tuple(columns.values()), results)


def test_shares_of_a_grid_are_those_of_its_formula() -> None:
    """y = 3 a + b + 2 a c on a, b, c = -1, 0, 1: variances 6, 2/3 and 16/9 of a sum."""
    a, b, c = np.array(list(itertools.product((-1.0, 0.0, 1.0), repeat=3))).T
    y = 3 * a + b + 2 * a * c
    found = table({"a": a, "b": b, "c": c}, np.stack([y, -b], axis=1))
    whole = 9 * 2 / 3 + 2 / 3 + 4 * 4 / 9
    assert found.shares[:, 0] == pytest.approx([6 / whole, 2 / 3 / whole, 0.0], rel=1e-12, abs=1e-12)
    assert found.shares[:, 1] == pytest.approx([0, 1, 0], abs=1e-12)
    assert [row[0] for row in found.trends] == ["rises", "rises", ""]
    assert found.trends[1][1] == "falls"


@pytest.mark.parametrize("count", [500, 2000])
def test_shares_of_a_sample(count: int) -> None:
    """y = x + z/2 has 80 and 20 per cent of them; a column that changes nothing has nothing."""
    x, z, w = np.random.default_rng(3).random((3, count))
    found = table({"x": x, "z": z, "w": w}, np.stack([x + z / 2, w], axis=1))
    assert found.shares[:, 0] == pytest.approx([0.8, 0.2, 0.0], abs=2 / np.sqrt(count))


def test_names_are_groups_of_their_own() -> None:
    wood = np.array(["maple", "ash"] * 6)
    found = table({"wood": wood}, np.stack([np.where(wood == "ash", 1.0, 2.0), np.arange(12.0)], axis=1))
    assert found.shares[0, 0] == pytest.approx(1.0, rel=1e-12)
    assert found.trends == [["", ""]]


@given(arrays(int, (60, 2), elements=st.integers(0, 11)))  # with ties
def test_the_front_is_what_none_beats(numbers: np.ndarray) -> None:
    results = numbers.astype(float)
    found = table({"x": np.arange(60.0)}, results)
    wanted = results * [1, -1]  # stiffness is better if it is higher
    beaten = [any((other <= own).all() and (other < own).any() for other in wanted) for own in wanted]
    assert {tuple(wanted[i]) for i in found.front} == {tuple(w) for w, b in zip(wanted, beaten, strict=True) if not b}
    assert all(not beaten[i] for i in found.front)
    assert found.best(0) in np.flatnonzero(results[:, 0] == results[:, 0].min())
    assert found.best(1) in np.flatnonzero(results[:, 1] == results[:, 1].max())


@pytest.mark.parametrize("most", [7, 30])
def test_a_front_says_how_many_of_its_designs_are_listed(most: int) -> None:
    x = np.linspace(0, 1, 20)
    sheet = front_sheet(table({"x": x}, np.stack([x, x], axis=1)), most)
    assert len(sheet.rows) == min(most, 20)
    assert (f"{most} of them are listed" in sheet.title) == (most < 20)


def test_the_pair_is_the_strongest_trade_off() -> None:
    x = np.linspace(0, 1, 20)
    three = (Response.of("end_mass"), Response.of("squirt(0.3)"), Response.of("tip_stiffness"))
    found = table({"x": x}, np.stack([x, x, x], axis=1), three)
    assert found.pair == (0, 2)
    assert len(found.front) == 20
    neutral = table({"x": x}, np.stack([x, x], axis=1), (Response.of("frequency(1)"), Response.of("end_mass")))
    assert (neutral.judged, neutral.pair) == ([1], None)


def test_every_kind_says_which_way_is_better() -> None:
    assert {kind.better for kind in asked().values()} == {"lower", "higher", ""}
    assert Response.of("end_mass_force").better == "lower"


def test_command_ends_with_a_summary_and_writes_it_as_a_page(tmp_path: Path) -> None:
    study = written(tmp_path)
    out = said("study", study, "-o", tmp_path / "page.html", "-o", tmp_path / "best.toml")
    assert "stiffness at the tip, N/m (higher is better)" in " ".join(out.split())
    assert "16 failed, the first of them design 48: Segment.tip_bore must be in [0, 0.012)" in " ".join(out.split())
    assert "bore 0 to 15 mm" in " ".join(out.split())
    told = json.loads(said("study", study, "--json"))
    assert (told["designs"], told["evaluated"], told["failed"]) == (64, 0, 16)
    best = told["summary"]["best"]["end_mass"]
    assert best["at"]["bore"] == pytest.approx(0.011, rel=1e-12)  # the widest of those that exist
    assert cf.load(tmp_path / "best.toml").cue.segments[0].tip_bore == pytest.approx(0.011, rel=1e-12)
    assert told["summary"]["drives"]["end_mass"]["bore"]["trend"] == "falls"
    assert told["summary"]["front"]["of"] == ["end_mass", "tip_stiffness"]
    assert told["summary"]["front"]["designs"][0]["design"] == best["design"]
    page = (tmp_path / "page.html").read_text(encoding="utf-8")
    assert page.count("<table") == 4
    assert re.findall('(?:href|src)="([^"]*)"', page) == ["data:,"]


def test_no_design_has_no_summary(tmp_path: Path) -> None:
    study = STUDY.replace('low = "0 mm"', 'low = "13 mm"').replace('high = "15 mm"', 'high = "14 mm"')
    study = written(tmp_path, study.replace("count = 16", "count = 2"))
    assert "Best designs" not in said("study", study)
    command_refuses("needs a design with an answer; got none", "study", study, "-o", tmp_path / "best.toml")


def test_result_has_designs_responses_units_best_and_spread(tmp_path: Path) -> None:
    found = cf.study(written(tmp_path), store=tmp_path / "some.sqlite")
    assert (found.kind, len(found.rows), len(found.failures)) == ("sweep", 64, 16)
    assert found.units == {"bore": "m", "tip.contact_time": "s", "cue.segments[0].material": ""} | {
        "end_mass": "kg",
        "tip_stiffness": "N/m",
        "frequency(1)": "Hz",
    }
    assert (found.designs["bore"].shape, found.responses["end_mass"].shape) == ((64,), (64,))
    best = found.best["end_mass"]
    assert best.responses["end_mass"] == np.nanmin(found.responses["end_mass"])
    assert best.scene.cue.segments[0].tip_bore == best.values["bore"]
    assert set(found.best) == {"end_mass", "tip_stiffness"}
    assert found.spread["end_mass"]["5 %"] < found.spread["end_mass"]["mean"] < found.spread["end_mass"]["95 %"]
    assert repr(found).splitlines()[0] == "StudyResult(sweep of 64 designs, 16 without an answer)"
    again = cf.study(tmp_path / "study.toml", store=tmp_path / "some.sqlite", workers=1)  # nothing is left to do
    assert again.rows == found.rows


@pytest.mark.parametrize(
    ("name", "words"),
    [
        ("tip.contact_time", "tip contact time"),
        ("cue.segments[2].tip_bore", "segment 3 tip bore"),
        ("cue.segments[*].material.E", "all segments material E"),
        ("cue.segments[0].length, effects[0].dome_radius", "segment 1 length, effect 1 dome radius"),
        ("bore of 2.5, v1.5", "bore of 2.5, v1.5"),
        ("bore.depth", "bore.depth"),
    ],
)
def test_columns_are_named_in_words(name: str, words: str) -> None:
    assert column_label(name) == words


def test_responses_are_named_in_words() -> None:
    names = ("end_mass", "end_mass(0.3)", "squirt(-0.25)", "frequency(2)", "end_mass_force", "wall")
    said = [Response.of(name).label for name in names]
    assert said[:4] == ["end mass", "end mass at b/R 0.3", "squirt at b/R -0.25", "tone 2"]
    assert said[4:] == ["end mass, force", "thinnest wall"]
    every = [
        Response(name, x).label
        for name, of in asked().items()
        for x in ((None, 0.3, 0.3000001, 2) if of.argument else (None,))
    ]
    assert len({*every}) == len(every)
    assert not any("_" in label for label in every)
