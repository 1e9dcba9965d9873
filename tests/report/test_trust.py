"""What a page says of the model's error is what the handbook says (validation)."""

from __future__ import annotations

import html
import re
from dataclasses import replace
from pathlib import Path

import cuefem as cf
from cuefem.designer.numbers import trust_markup
from cuefem.report.page import page
from cuefem.report.trust import trust_lines

ROOT = Path(__file__).parents[2]
SCENE = cf.usual_scene(cf.load(ROOT / "meshes" / "pool_maple.toml"))
SPRING = replace(SCENE, effects=())
LUMPED = cf.Scene(cf.LumpedCue(0.54, 0.006), stroke=cf.Stroke(offset=0.3))


def handbook(name: str) -> str:
    return " ".join((ROOT / "cuefem" / "handbook" / f"{name}.md").read_text(encoding="utf-8").split())


def test_the_errors_are_those_of_the_handbook() -> None:
    told = handbook("measured")
    assert "the low-deflection shaft has 0.74 to 0.67 of the maple shaft's squirt" in told
    assert "0.72 of the maple shaft's" in told
    assert "good to 0.5 % in 95 of 100 points and to 2.5 % at worst" in handbook("accuracy") + handbook("effects")


def test_each_tip_has_its_own_error() -> None:
    assert trust_lines(SCENE)[0].startswith("The tip is taken as elastic leather")
    assert trust_lines(SPRING)[0].startswith("The tip is taken as a spring")
    assert trust_lines(LUMPED) == trust_lines(SPRING)


def test_report_and_designer_say_it() -> None:
    for line in trust_lines(SPRING):
        assert line.partition(".")[0] in html.unescape(re.sub("<[^>]+>", "", page("lumped.toml", LUMPED)))
        assert line in html.unescape(trust_markup(SPRING))
