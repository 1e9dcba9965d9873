"""What pages say of the model and of others' numbers is what was measured, computed and published (validation)."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path

import pytest

import cuefem as cf
from cuefem.report import strike_record, strike_sheet
from cuefem.report.record import scene_record
from cuefem.report.report_page import A31_NAME, MEASURED_A31, SOURCES
from cuefem.report.strike_table import LUMPED
from cuefem.squirt import alciatore_a31_mass_ratio

ROOT = Path(__file__).parents[2]
SCENE = cf.usual_scene(cf.load(ROOT / "meshes" / "pool_maple.toml"))


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
