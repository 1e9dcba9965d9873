"""Sensitivity to each effect: changes equal differences of strikes (properties)."""

from dataclasses import replace
from typing import Any

import pytest

import cuefem as cf
from cuefem.analysis.effect_sensitivity import MARGIN, EffectSensitivity, variants
from cuefem.effects.effect import effect_kinds
from tests.helpers.strike_scenes import KIM

DOME, CLAY, HAND = cf.TipDome(9.5e-3), cf.PointMass(position=0.05, mass=0.011), cf.Support(0.2032, 5e3)
SCENE = cf.Scene(KIM, tip=cf.Tip(contact_time=1e-3), stroke=cf.Stroke(offset=0.3), effects=(DOME, CLAY, HAND))


@pytest.fixture(scope="module")
def found() -> EffectSensitivity:
    return cf.effect_sensitivity(SCENE)


def rows(found: EffectSensitivity) -> dict[str, Any]:
    return {row["name"]: row for row in found.effects}


def test_variants_remove_or_add_each_effect_once() -> None:
    result = variants(SCENE)
    assert sorted(variant.name for variant in result) == sorted(effect_kinds())
    assert [v.name for v in result if v.is_listed] == ["TipDome", "PointMass", "Support"]
    for v in result:
        changed = tuple(e for e in SCENE.effects if e != v.effect) if v.is_listed else (*SCENE.effects, v.effect)
        assert v.reason if v.scene is None else v.scene.effects == changed


def test_variants_of_repeated_effect_remove_one_and_invalid_has_reason() -> None:
    two = replace(SCENE, effects=(CLAY, cf.PointMass(position=0.1, mass=0.003)))
    remaining = [v.scene.effects for v in variants(two) if v.is_listed and v.scene is not None]
    assert remaining == [two.effects[1:], two.effects[:1]]
    short = cf.Cue((cf.Segment(0.15, 0.012, 0.013, KIM.segments[0].material),), 0.5)
    (support,) = (v for v in variants(replace(SCENE, cue=short, effects=(DOME,))) if v.name == "Support")
    assert support.scene is None
    assert support.reason == "Support.position must be in [0, 0.15] m, on the cue; got 0.2032"


@pytest.mark.heavy
@pytest.mark.parametrize("name", ["TipDome", "PointMass", "Support", "TipShear", "AxialWaves"])
def test_effect_change_equals_difference_of_strikes(found: EffectSensitivity, name: str) -> None:
    row = rows(found)[name]
    (variant,) = (v for v in variants(SCENE) if v.name == name)
    assert variant.scene is not None
    exact, base = cf.strike(variant.scene, rtol=1e-3), cf.strike(SCENE, rtol=1e-3)
    tolerance = 2 * found.rtol / MARGIN  # the error of either strike
    for quantity in ("squirt", "ball_speed", "spin"):
        expected = getattr(exact, quantity) / getattr(base, quantity) - 1
        assert row["change"][quantity]["relative"] == pytest.approx(expected, abs=tolerance)
        gap = row["change"][quantity]["relative"] * abs(found.base[quantity])
        assert row["change"][quantity]["absolute"] == pytest.approx(gap, rel=1e-9)


@pytest.mark.heavy
def test_recommendation_depends_on_tolerance(found: EffectSensitivity) -> None:
    worth = found.recommendation
    assert worth["effects_to_remove"] == ["Support (position 203.2 mm, stiffness 5000 N/m)"]
    assert "TipDome (radius 9.5 mm)" in worth["effects_to_keep"]
    assert "TipShear (ratio 0.75)" in worth["effects_to_add"]
    loose = cf.effect_sensitivity(cf.Scene(cf.LumpedCue(0.54, 0.006), stroke=cf.Stroke(offset=0.3)), rtol=0.9)
    assert loose.recommendation == {"effects_to_keep": [], "effects_to_remove": [], "effects_to_add": []}
