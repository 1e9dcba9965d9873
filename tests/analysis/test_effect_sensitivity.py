"""Sensitivity to each effect: changes equal differences of strikes (properties)."""

from typing import Any

import pytest

import cuefem as cf
from cuefem.analysis.effect_sensitivity import MARGIN, EffectSensitivity, variants
from tests.helpers.strike_scenes import KIM

DOME, CLAY, HAND = cf.TipDome(9.5e-3), cf.PointMass(position=0.05, mass=0.011), cf.Support(0.2032, 5e3)
SCENE = cf.Scene(KIM, tip=cf.Tip(contact_time=1e-3), stroke=cf.Stroke(offset=0.3), effects=(DOME, CLAY, HAND))


@pytest.fixture(scope="module")
def found() -> EffectSensitivity:
    return cf.effect_sensitivity(SCENE)


def rows(found: EffectSensitivity) -> dict[str, Any]:
    return {row["name"]: row for row in found.effects}


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
