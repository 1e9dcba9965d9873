"""`cuefem cost`: its table, its figure, what it recommends and what it refuses (properties)."""

from __future__ import annotations

import json
from itertools import pairwise
from pathlib import Path

import pytest

from cuefem import LumpedCue, Scene, resolve, save
from cuefem.accuracy import JUDGED
from cuefem.report.cost import WANTED, cost_figure, cost_record
from tests.helpers.accuracy_scenes import MESHES, scene
from tests.helpers.command_line import call

KIM = MESHES / "kim.toml"


@pytest.fixture(scope="module")
def record() -> dict:
    return cost_record(scene("kim", 1e-3, 0.3), most=60)


def test_rungs_grow_and_the_climb_takes_time(record: dict) -> None:
    rungs = record["rungs"]
    for name in ("modes", "unknowns", "seconds"):
        values = [rung[name] for rung in rungs]
        assert all(first < second for first, second in pairwise(values))
    assert [rung["estimate"] is None for rung in rungs] == [True] * JUDGED + [False] * (len(rungs) - JUDGED)
    assert rungs[-1]["difference"] is None
    assert all(rung["plain"]["difference"] > 0 for rung in rungs)


def test_what_is_recommended_is_what_resolve_takes(record: dict) -> None:
    assert [row["rtol"] for row in record["wanted"]] == list(WANTED)
    for row in record["wanted"]:
        if row["reached"]:
            found = resolve(scene("kim", 1e-3, 0.3), row["rtol"])
            assert (found.unknowns, found.error) == (row["unknowns"], row["estimate"])
    assert [row["reached"] for row in record["wanted"]] == [True, True, False, False]
    best = min(rung["estimate"] for rung in record["rungs"] if rung["estimate"] is not None)
    assert record["wanted"][-1]["estimate"] == best


@pytest.mark.heavy
@pytest.mark.parametrize(("kind", "start"), [("png", b"\x89PNG"), ("svg", b"<?xml")])
def test_figures_are_the_same_twice(record: dict, kind: str, start: bytes) -> None:
    content = cost_figure(record, "a title", kind)
    assert content.startswith(start)
    assert content == cost_figure(record, "a title", kind)


def test_the_command_prints_and_draws(tmp_path: Path) -> None:
    figure = tmp_path / "cost.svg"
    status, out, err = call("cost", KIM, "--most", 24, "--output", figure)
    assert (status, err) == (0, "")
    assert "assumed: a usual stroke of pool (--game); ball 170 g, 57.15 mm (--ball)" in " ".join(out.split())
    assert "What to take" in out
    assert "1e-06, not reached" in out
    assert figure.read_text(encoding="utf-8").startswith("<?xml")


def test_the_command_speaks_json() -> None:
    status, out, err = call("cost", KIM, "--most", 24, "--json")
    assert (status, err) == (0, "")
    assert [row["rtol"] for row in json.loads(out)["wanted"]] == list(WANTED)


def test_a_figure_of_another_kind_is_refused_before_the_work(tmp_path: Path) -> None:
    status, out, err = call("cost", KIM, "--output", tmp_path / "cost.pdf")
    assert (status, out) == (2, "")
    assert "must end in .html or .png or .svg; got '.pdf'" in err


def test_a_lumped_cue_has_no_cost(tmp_path: Path) -> None:
    path = tmp_path / "lumped.toml"
    save(Scene(LumpedCue(0.5, 0.006)), path)
    status, out, err = call("cost", path)
    assert (status, out) == (2, "")
    assert "must be a Cue of segments" in err
