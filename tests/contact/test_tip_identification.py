"""Leather identified from contact time and rebound reproduces both; stored leathers are derived again (validation)."""

from __future__ import annotations

from dataclasses import replace

import pytest

import cuefem as cf
from cuefem.contact.tip_identification import IdentifiedTip, with_tip
from cuefem.cue.materials import LEATHERS
from studies.strokes import cue
from tests.helpers.leather_scenes import LEATHER, leather_scene


def head_on(scene: cf.Scene) -> tuple[float, float]:
    """Contact time, s, and rebound."""
    return cf.strike(replace(scene, stroke=replace(scene.stroke, offset=0.0))).duration, cf.rebound(scene)


def test_identify_tip_rigid_cue_recovers_tip() -> None:
    """In a centre-ball impact a cue without axial waves is rigid: its rebound is the tip's restitution."""
    scene = leather_scene()
    assert cf.rebound(scene) == pytest.approx(0.73, rel=1e-4)
    soft = leather_scene(leather=replace(LEATHER, E=1e6))  # too soft for the stroke; its E has no effect
    assert cf.identify_tip(soft, float(scene.contact_time), 0.73) == pytest.approx((LEATHER.E, 0.73), rel=2e-4)


@pytest.mark.parametrize("name", [pytest.param(n, marks=[] if n == "medium" else pytest.mark.heavy) for n in LEATHERS])
def test_identify_tip_reproduces_measured_contact_time_and_rebound(name: str) -> None:
    leather, whole_cue = LEATHERS[name], cf.usual_scene(cue("whole_cue"))
    result = cf.identify_tip(whole_cue, leather.contact_time, 0.73)
    assert (leather.E, leather.restitution) == pytest.approx(result, rel=3e-3)  # three digits are stored
    assert head_on(with_tip(whole_cue, IdentifiedTip(leather.E, leather.restitution))) == pytest.approx(
        (leather.contact_time, 0.73), rel=1e-3
    )


def test_rebound_of_reference_cues_is_in_published_range() -> None:
    """At 2 m/s, within 0.015 of the published range 0.71 to 0.75 (TP A.30); no parameter is fitted to these cues."""
    for game, name in (("pool", "pool_maple"), ("pool", "pool_hollow"), ("pool", "carbon"), ("carom", "kim")):
        scene = cf.usual_scene(cue(name), game)
        assert 0.71 - 0.015 < cf.rebound(replace(scene, stroke=cf.Stroke(2.0))) < 0.75 + 0.015
