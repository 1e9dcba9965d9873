"""What pages say of the model and of others' numbers is what was measured, computed and published (validation)."""

from __future__ import annotations

import html
import math
import re
from dataclasses import replace
from pathlib import Path

import pytest

import cuefem as cf
from cuefem.designer.numbers_panel import trust_markup
from cuefem.report import strike_record, strike_sheet
from cuefem.report.record import scene_record
from cuefem.report.report_page import A31_NAME, MEASURED_A31, SOURCES, page
from cuefem.report.strike_table import LUMPED
from cuefem.report.trust import trust_lines
from cuefem.squirt import alciatore_a31_mass_ratio

ROOT = Path(__file__).parents[2]
SCENE = cf.usual_scene(cf.load(ROOT / "meshes" / "pool_maple.toml"))
SPRING = cf.Scene(cf.LumpedCue(0.54, 0.006), stroke=cf.Stroke(offset=0.3))


def test_the_errors_are_those_of_the_handbook() -> None:
    files = ("measured", "accuracy", "effects")
    told = {n: " ".join((ROOT / f"cuefem/handbook/{n}.md").read_text(encoding="utf-8").split()) for n in files}
    assert "the low-deflection shaft has 0.74 to 0.67 of the maple shaft's squirt" in told["measured"]
    assert "0.72 of the maple shaft's" in told["measured"]
    assert "good to 0.5 % in 95 of 100 points and to 2.5 % at worst" in told["accuracy"] + told["effects"]


def test_report_and_designer_say_the_error_of_the_tip_they_have() -> None:
    assert trust_lines(SCENE)[0].startswith("The tip is taken as elastic leather")
    assert trust_lines(SPRING)[0].startswith("The tip is taken as a spring")
    for line in trust_lines(SPRING):
        assert line.partition(".")[0] in html.unescape(re.sub("<[^>]+>", "", page("lumped.toml", SPRING)))
        assert line in html.unescape(trust_markup(SPRING))


@pytest.mark.parametrize(("end", "offset", "degrees"), [(0, 0.453, 1.8), (1, 0.267, 2.4)], ids=["Predator", "Stinger"])
def test_measured_end_masses_are_those_of_a31(end: int, offset: float, degrees: float) -> None:
    felt = 0.170 / alciatore_a31_mass_ratio(offset, math.radians(degrees))
    assert MEASURED_A31[end] == pytest.approx(float(felt), rel=0.01)
    assert f"{degrees:g}° at b/R {offset:g}" in dict(SOURCES)[A31_NAME]


def test_the_slower_ball_of_a_lumped_cue_is_explained_where_waves_raise_the_coupled_one() -> None:
    still = replace(SCENE, effects=tuple(effect for effect in SCENE.effects if not isinstance(effect, cf.AxialWaves)))
    speeds = []
    for struck, told in ((SCENE, True), (still, False)):
        record = strike_record(struck)
        speeds.append([record["models"][name]["ball_speed"] for name in ("coupled", "two-part")])
        assert (LUMPED in strike_sheet(record, scene_record(struck)).notes) is told
    (coupled, lumped), (without, same) = speeds
    assert lumped == pytest.approx(same, rel=1e-3)  # it feels the waves by its end mass alone
    assert coupled > 1.04 * without > 1.04 * lumped
