"""What pages say of the model and of others' numbers is what was measured, computed and published (validation)."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest

import cuefem as cf
from cuefem.report import strike_record, strike_sheet
from cuefem.report.record import scene_record
from cuefem.report.strike_table import LUMPED

ROOT = Path(__file__).parents[2]
SCENE = cf.usual_scene(cf.load(ROOT / "meshes" / "pool_maple.toml"))


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
