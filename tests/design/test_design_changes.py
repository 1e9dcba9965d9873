"""What a maker can change: each row is the strike of a cue that `varied` makes, and can be taken over (properties)."""

from __future__ import annotations

import html
import json
import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import cuefem as cf
from cuefem.cue.materials import material
from cuefem.design.design_changes import COSTS, LEAST_WALL, PAYS, changes_of, design_changes
from cuefem.parameters.parameter import varied
from cuefem.report.report_page import page
from cuefem.results.verdict import verdict_record
from cuefem.scene.default_scene import GAMES
from cuefem.tip_modes import Solved
from tests.helpers.command_line import call

ROOT = Path(__file__).parents[2]
READY = ("pool_maple", "pool_hollow", "carbon", "whole_cue", "kim")


def scene_of(name: str) -> cf.Scene:
    return cf.usual_scene(cf.load(ROOT / "meshes" / f"{name}.toml"))


@pytest.fixture(scope="module", params=READY)
def found(request: pytest.FixtureRequest) -> tuple[cf.Scene, dict]:
    scene = scene_of(request.param)
    return scene, design_changes(scene)


def test_every_row_is_the_strike_of_the_changed_cue(found: tuple[cf.Scene, dict]) -> None:
    scene, record = found
    own = cf.strike(scene)
    tone = cf.modes(scene.cue, effects=scene.cue_effects).frequencies[0]
    assert record["own"]["squirt"] == pytest.approx(own.squirt, rel=1e-9)
    assert record["changes"]
    for row in record["changes"]:
        made = varied(scene, row["set"])
        assert row["squirt_change"] == pytest.approx(cf.strike(made).squirt / own.squirt - 1, abs=1e-8)
        assert row["shaft_mass_change"] == pytest.approx(made.cue.shaft_mass - scene.cue.shaft_mass, abs=1e-12)
        heard = cf.modes(made.cue, effects=made.cue_effects).frequencies[0]
        assert row["frequency_change"] == pytest.approx(heard - tone, abs=1e-6 * tone)


def test_head_on_the_advice_and_the_verdict_are_those_of_the_usual_offset() -> None:
    scene = scene_of("pool_maple")
    head_on = replace(scene, stroke=replace(scene.stroke, offset=0.0))
    usual = replace(scene, stroke=replace(scene.stroke, offset=GAMES["pool"].offset))
    solved = Solved(head_on)
    advice, verdict = design_changes(head_on, solved=solved), verdict_record(head_on, cf.strike(head_on), {})
    assert advice == design_changes(usual)
    assert verdict["head_on"]
    assert advice["offset"] == verdict["offset"] == usual.stroke.offset
    assert advice["own"]["squirt"] == pytest.approx(verdict["squirt"], rel=1e-9)
    assert verdict["squirt"] == pytest.approx(cf.strike(usual).squirt, rel=1e-9)


def test_the_least_squirt_comes_first_and_what_pays_says_so(found: tuple[cf.Scene, dict]) -> None:
    rows = found[1]["changes"]
    changes = [row["squirt_change"] for row in rows]
    assert changes == sorted(changes)
    for row in rows:
        assert ("pays" in row["verdict"]) == (row["squirt_change"] <= -PAYS)
        assert ("costs stiffness" in row["verdict"]) == (
            row["squirt_change"] <= -PAYS and row["tip_stiffness_change"] < -COSTS
        )
        assert 0 <= row["squirt_change_error"] < max(abs(row["squirt_change"]), 1e-12)


def test_no_wall_is_thinner_than_one_can_make(found: tuple[cf.Scene, dict]) -> None:
    scene, record = found
    for row in record["changes"]:
        bored = [s for s in varied(scene, row["set"]).cue.segments if s.core is None and max(s.tip_bore, s.butt_bore)]
        walls = [min(s.tip_diameter - s.tip_bore, s.butt_diameter - s.butt_bore) / 2 for s in bored]
        assert min(walls, default=np.inf) >= LEAST_WALL


def test_a_maker_finds_what_the_issue_lists() -> None:
    said = " ".join(change.words for name in READY[:2] for change in changes_of(scene_of(name)))
    bores, fronts = ("bore wider", "bore deeper", "a bore,"), ("ferrule shorter", "ferrule of", "leather lower")
    shafts = ("thinner", "straight taper", "pro taper", "shaft of ash", "carbon tube")
    for words in (*bores, *fronts, "dime", "nickel", *shafts):
        assert words in said


def test_a_tube_is_neither_turned_nor_filled_with_wood() -> None:
    words = [change.words for change in changes_of(scene_of("carbon"))]
    assert not any("taper" in each or "shaft" in each or "thinner" in each for each in words)
    (tube,) = (change for change in changes_of(scene_of("pool_maple")) if "carbon" in change.words)
    made = varied(scene_of("pool_maple"), tube.places)
    assert {s.core for s in made.cue.segments[1:]} == {material("foam")}


def test_the_command_the_page_and_the_saved_file_agree(tmp_path: Path) -> None:
    path = ROOT / "meshes" / "pool_hollow.toml"
    rows = json.loads(call("improve", path, "--json")[1])["changes"]
    own = design_changes(scene_of("pool_hollow"))["changes"]
    assert [row["squirt"] for row in rows] == pytest.approx([row["squirt"] for row in own], rel=1e-12)
    status, out, _ = call("improve", path)
    text = html.unescape(re.sub("<[^>]+>", "", page("x", scene_of("pool_hollow"))))
    assert status == 0
    for row in rows:
        assert row["change"] in out
        assert row["change"] in text
    target = tmp_path / "better.toml"
    status, out, _ = call("improve", path, "--take", "2", "-o", target)
    assert (status, out) == (0, f"wrote {target}: {rows[1]['change']}\n")
    assert cf.strike(cf.load(target)).squirt == pytest.approx(rows[1]["squirt"], rel=1e-9)
    status, _, err = call("improve", path, "--take", "2", "-o", target)
    assert status == 2
    assert "--force" in err


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["--take", "1"], "goes with -o FILE.toml"),
        (["--take", "99", "-o", "x.toml"], "must be a row of the table, 1 to "),
        (["--take", "1", "-o", "x.csv"], "must end in .html or .toml; got '.csv'"),
    ],
)
def test_refusals(arguments: list[str], words: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    status, _, err = call("improve", ROOT / "meshes" / "pool_maple.toml", *arguments)
    assert status == 2
    assert words in err
    assert not list(tmp_path.iterdir())
