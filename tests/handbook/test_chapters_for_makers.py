"""Chapters for makers: numbers, pictures and example files are computed again (regression)."""

import math
import re
from dataclasses import replace
from pathlib import Path

import pytest

import cuefem as cf
from cuefem.handbook import MAKERS, chapters
from cuefem.parameters.scene_changes import with_parameters
from cuefem.results.quantities import drawn_mass
from cuefem.results.uncertainty import MODEL_ERROR, SHAFT_ERROR
from tests.helpers.maker_pictures import FOLDER, PICTURES, command_json, reference_squirts

TEXTS = {chapter.name: chapter.text for chapter in chapters() if chapter.name in MAKERS}
NUMBER = re.compile(r"[−+-]?\d+(?:\.\d+)?")


@pytest.mark.heavy
@pytest.mark.parametrize("name", PICTURES)
def test_picture_equals_redrawn_picture(name: str) -> None:
    """Tolerance of three units: rounded numbers may differ between machines."""
    stored, now = (FOLDER / f"{name}.svg").read_text(encoding="utf-8"), PICTURES[name]()
    assert NUMBER.sub("#", stored) == NUMBER.sub("#", now)
    both = zip(NUMBER.findall(stored), NUMBER.findall(now), strict=True)
    assert [(a, b) for a, b in both if abs(float(a.replace("−", "-")) - float(b.replace("−", "-"))) > 3] == []


@pytest.mark.heavy
def test_numbers_in_makers_chapters_equal_computation() -> None:
    verdict = command_json("report")["verdict"]
    degrees, off_line = math.degrees(verdict["squirt"]), 1e3 * math.tan(verdict["squirt"])
    off = degrees * verdict["uncertainty"]["total"]
    line = f"squirt {degrees:.2f} ± {off:.2f}° (at b/R 0.3, 3/10 of the way to the edge): the ball is"
    assert line in TEXTS["read_the_report"]
    assert f"about {off_line:.0f} mm off line after 1 m" in TEXTS["what_squirt_is"]
    known = reference_squirts()
    for name in ("low deflection", "carbon"):  # "about a fifth less"
        assert 0.18 < 1 - known[name] / known["plain maple"] < 0.24
    assert verdict["uncertainty"]["total"] == pytest.approx(0.2, abs=0.025)  # "off by about 20 %"
    assert f"The model's own is {100 * MODEL_ERROR:.0f} %" in TEXTS["read_the_report"]
    assert f"its uncertainty is {100 * SHAFT_ERROR:.0f} % of the difference for the model" in TEXTS["read_the_report"]
    assert f"{100 * SHAFT_ERROR:.0f} % of the change for the model" in TEXTS["design_changes"]
    assert_density_and_butt_as_stated()
    rows = {row["change"]: row for row in command_json("improve")["changes"]}
    for change, start in (("thinner from", "0.5 mm takes "), ("of a dime", "dime gives "), ("of a nickel", "nickel ")):
        (row,) = (row for label, row in rows.items() if change in label)
        text = f"{start}{100 * abs(row['squirt_change']):.1f} ± {100 * row['squirt_change_error']:.1f} %"
        assert text in TEXTS["design_changes"]


def assert_density_and_butt_as_stated() -> None:
    """Squirt of denser wood and of other butts; the error of a difference from plain maple, weighed or not."""
    maple, kim = (cf.usual_scene(cf.load(Path("meshes") / f"{name}.toml")) for name in ("pool_maple", "kim"))
    own = cf.strike(maple).squirt
    for scene in (maple, kim):
        heavier = with_parameters(scene, {"shaft mass": 1.1 * drawn_mass(scene)})
        assert f"{100 * (cf.strike(heavier).squirt / cf.strike(scene).squirt - 1):.1f} % (" in TEXTS["weigh_and_tap"]
    for butt, less in ((0.35, 4), (0.0, 23)):
        other = replace(maple, cue=replace(maple.cue, body_mass=butt))
        assert f"{100 * (1 - cf.strike(other).squirt / own):.0f}" == str(less)
        assert f"{less} % less" in TEXTS["what_squirt_is"]
    for scene in (maple, kim):
        weighed = replace(scene, cue=replace(scene.shaft, shaft_mass_measured=True))
        before, after = (cf.verdict(each).references["plain maple"]["error"] for each in (scene, weighed))
        assert f"from {100 * before:.1f} to {100 * after:.1f} %" in TEXTS["read_the_report"]
