"""What stands below a stroke's table: why a lumped cue leaves the ball slower, where it does."""

from __future__ import annotations

from dataclasses import replace

import pytest

import cuefem as cf
from cuefem.designer.start import first_cue
from cuefem.report import strike_record, strike_sheet
from cuefem.report.record import scene_record
from cuefem.report.strike import LUMPED


def test_the_slower_ball_of_a_lumped_cue_is_explained_where_waves_raise_the_coupled_one() -> None:
    scene = cf.usual_scene(first_cue())
    still = replace(scene, effects=tuple(effect for effect in scene.effects if not isinstance(effect, cf.AxialWaves)))
    speeds = []
    for struck, told in ((scene, True), (still, False)):
        record = strike_record(struck)
        speeds.append([record["models"][name]["ball_speed"] for name in ("coupled", "two-part")])
        assert (LUMPED in strike_sheet(record, scene_record(struck)).notes) is told
    (coupled, lumped), (without, same) = speeds
    assert lumped == pytest.approx(same, rel=1e-3)  # it feels the waves by its end mass alone
    assert coupled > 1.04 * without > 1.04 * lumped
