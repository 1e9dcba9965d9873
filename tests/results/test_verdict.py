"""The verdict: a squirt, its band, and its place among the ready cues, each as the strike gives it (properties)."""

from __future__ import annotations

import json
import math
import re
from dataclasses import replace
from pathlib import Path

import pytest

import cuefem as cf
from cuefem.designer.answers import answers, completed
from cuefem.designer.numbers_panel import key_markup, verdict_markup
from cuefem.games import without_leather
from cuefem.io.ready import PRESETS, SCALE, STROKES, Preset, opened, ready_cues
from cuefem.report.report_page import page
from cuefem.report.verdict_table import headline, scale, squirt_words, standing
from cuefem.results.band import LEVEL, LEVEL_OF_SPRING, OF_DIFFERENCE
from cuefem.results.verdict import same_stroke, verdict_record
from cuefem.squirt import alciatore_a31
from tests.helpers.command_line import call

ROOT = Path(__file__).parents[2]
SCENE = cf.usual_scene(cf.load(ROOT / "meshes" / "pool_hollow.toml"))
RECORD = verdict_record(SCENE, cf.strike(SCENE), ready_cues())


@pytest.mark.parametrize("name", SCALE)
def test_each_ready_cue_is_struck_the_same_way(name: str) -> None:
    struck = cf.strike(replace(SCENE, cue=without_leather(cf.load(ROOT / SCALE[name]))))
    among = RECORD["among"][name]
    assert among["squirt"] == pytest.approx(struck.squirt, rel=1e-12)
    assert among["difference"] == pytest.approx(cf.strike(SCENE).squirt / struck.squirt - 1, abs=1e-12)


def test_a_ready_cue_has_its_own_place() -> None:
    assert RECORD["among"]["low deflection"]["difference"] == 0
    maple = cf.usual_scene(cf.load(ROOT / "meshes" / "pool_maple.toml"))
    record = verdict_record(maple, cf.strike(maple), ready_cues())
    assert "As much squirt" in standing(record)[0]
    nearly = {name: beside | {"difference": 0.02} for name, beside in record["among"].items()}
    assert "As much squirt" not in standing(record | {"among": nearly})[0]


def test_the_band_is_its_parts_in_quadrature() -> None:
    band = RECORD["band"]
    parts = [band[name] for name in ("model", "inputs", "computation")]
    assert all(part > 0 for part in parts)
    assert band["whole"] == pytest.approx(math.sqrt(sum(part**2 for part in parts)), rel=1e-12)
    assert RECORD["squirt_error"] == pytest.approx(band["whole"] * RECORD["squirt"], rel=1e-12)
    assert band["inputs"] == pytest.approx(math.hypot(*RECORD["inputs"].values()), rel=1e-12)
    assert {"E", "rho", "tip_height"} <= set(RECORD["inputs"])


def test_an_input_is_worth_what_the_strike_says() -> None:
    tip = SCENE.leather
    higher = replace(SCENE, effects=(replace(tip, height=tip.height * math.exp(0.1)), *SCENE.effects[1:]))
    change = abs(cf.strike(higher).squirt / cf.strike(SCENE).squirt - 1)
    assert RECORD["inputs"]["tip_height"] == pytest.approx(change, rel=1e-9)


def test_a_difference_is_surer_than_a_level() -> None:
    """For shafts as far apart as those of meshes/, and the more so the less they differ."""
    among = sorted(RECORD["among"].values(), key=lambda beside: abs(math.log1p(beside["difference"])))
    errors = [beside["difference_error"] / (1 + beside["difference"]) for beside in among]
    assert max(beside["difference_error"] for beside in among) < RECORD["band"]["whole"]
    assert errors[0] < errors[1] < errors[2]
    assert 0 < OF_DIFFERENCE < 1
    assert LEVEL < LEVEL_OF_SPRING


def test_head_on_it_is_told_at_the_usual_offset() -> None:
    straight = replace(SCENE, stroke=replace(SCENE.stroke, offset=0.0))
    record = verdict_record(straight, cf.strike(straight), ready_cues())
    assert record["squirt"] == pytest.approx(RECORD["squirt"], rel=1e-12)
    assert "head on" in headline(record)


def test_what_is_fixed_to_the_cue_stays_with_it() -> None:
    more = (cf.PointMass(0.1, 0.011), cf.Support(0.2, 1e3), cf.Support(0.72, 1e3))
    scene = replace(SCENE, effects=(*SCENE.effects, *more))
    short = replace(SCENE.cue, segments=SCENE.cue.segments[:-1])
    kept = {type(effect).__name__ for effect in same_stroke(scene, short).effects}
    assert kept == {"LeatherTip", "Support", "AxialWaves", "GeometricStiffness"}
    assert sum(isinstance(effect, cf.Support) for effect in same_stroke(scene, short).effects) == 1


def test_the_scale_is_in_order_and_compares_every_cue_with_plain_maple() -> None:
    rows, among = scale(RECORD), RECORD["among"]
    assert [row.at for row in rows] == sorted(row.at for row in rows)
    assert all(0 <= row.low <= row.at <= row.high <= 100 for row in rows)
    assert [row.name for row in rows if row.own] == ["yours"]
    beside = {row.name: row.beside for row in rows}
    for name in ("low deflection", "carbon"):
        less = 1 - among[name]["squirt"] / among["plain maple"]["squirt"]
        assert beside[name] == f"{100 * less:.0f} % less than plain maple"
    assert beside["plain maple"] == ""
    assert "ready pool cues" in standing(RECORD)[1]


@pytest.mark.parametrize(
    ("squirt", "error", "words"), [(1.847, 0.31, "1.8°"), (0.4, 0.042, "0.40°"), (12.3, 2.2, "12°")]
)
def test_it_has_no_more_digits_than_are_sure(squirt: float, error: float, words: str) -> None:
    record = {"squirt": math.radians(squirt), "squirt_error": math.radians(error)}
    assert squirt_words(record)[0] == words


def test_terminal_json_page_and_designer_say_the_same() -> None:
    path = ROOT / "meshes" / "pool_hollow.toml"
    status, out, _ = call("report", path)
    said = " ".join(out.split())
    assert status == 0
    assert headline(RECORD) in said
    assert all(line in said for line in standing(RECORD))
    assert out.index("give or take") < out.index("Bending modes")
    assert said.endswith(f"What would change it: cuefem improve {path}, with the same options")
    found = json.loads(call("report", path, "--json")[1])["verdict"]
    assert found["squirt"] == pytest.approx(RECORD["squirt"], rel=1e-12)
    assert found["band"] == pytest.approx(RECORD["band"], rel=1e-9)
    squirt, error = squirt_words(RECORD)
    done = completed(answers(SCENE))
    for markup in (page("x", SCENE), verdict_markup(done)):
        plain = re.sub(r"</?button[^>]*>", "", markup)  # a word of the glossary
        assert f"<b>{squirt}</b> <i>give or take {error}</i>" in plain
        assert len(re.findall('class="spot"', markup)) == len(SCALE) + 1
    assert f"give or take {error}" in key_markup(done, None)


def test_measured_end_masses_stand_beside_their_own_definition_alone() -> None:
    """The green band is as high as one row, that of A.31, whose number gives the squirt of this stroke by A.31."""
    text = page("x", SCENE)
    (band,) = re.findall(r'<rect class="measured" x="[\d.]+" y="([\d.]+)" width="[\d.]+" height="([\d.]+)"', text)
    y, high = map(float, band)
    row = re.search(r'y="([\d.]+)" text-anchor="end">by A.31, like measured cues', text)
    assert row is not None
    assert y < float(row[1]) < y + high
    assert high == 26
    mass = re.search(r"by A.31, like measured cues</text>.*?([\d.]+) g</text>", text, re.S)
    assert mass is not None
    given = alciatore_a31(0.3, mass_ratio=SCENE.ball.mass / (1e-3 * float(mass[1])), inertia=SCENE.ball.inertia)
    assert float(given) == pytest.approx(cf.strike(SCENE).squirt, rel=2e-3)


@pytest.mark.parametrize("preset", [preset for preset in PRESETS if preset.measured in STROKES], ids=lambda p: p.file)
def test_measured_squirt_stands_beside_the_same_offset(preset: Preset) -> None:
    scene, _ = opened(preset)
    said = preset.beside(scene)
    for offset, measured in STROKES[preset.measured].items():
        assert f"at b/R {offset:g}" in preset.measured
        ours = math.degrees(cf.strike(replace(scene, stroke=replace(scene.stroke, offset=offset))).squirt)
        more = "more" if ours > measured else "less"
        assert f"{ours:.2f}° at b/R {offset:g}, {abs(ours - measured):.2f}° {more}" in said
