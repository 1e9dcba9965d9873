"""Sensitivity to each effect: changes equal differences of strikes (properties)."""

from typing import Any

import pytest

import cuefem as cf
from cuefem.analysis.effect_sensitivity import MARGIN, variants
from tests.helpers.strike_scenes import KIM

DOME, CLAY, HAND = cf.TipDome(9.5e-3), cf.PointMass(position=0.05, mass=0.011), cf.Support(0.2032, 5e3)
SCENE = cf.Scene(KIM, tip=cf.Tip(contact_time=1e-3), stroke=cf.Stroke(offset=0.3), effects=(DOME, CLAY, HAND))


@pytest.mark.heavy
def test_effect_changes_equal_differences_of_strikes() -> None:
    """Effects of the scene, which are left out, and others, which are added."""
    found, base = cf.effect_sensitivity(SCENE), cf.strike(SCENE, rtol=1e-3)
    tolerance = 2 * found.rtol / MARGIN  # the error of either strike
    changes = {row["name"]: row.get("change") for row in found.effects}
    scenes = {each.name: each.scene for each in variants(SCENE)}
    for name in ("TipDome", "PointMass", "Support", "TipShear", "AxialWaves"):
        exact = cf.strike(scenes[name], rtol=1e-3)
        for quantity in ("squirt", "ball_speed", "spin"):
            change: Any = changes[name][quantity]
            expected = getattr(exact, quantity) / getattr(base, quantity) - 1
            assert change["relative"] == pytest.approx(expected, abs=tolerance)
            gap = change["relative"] * abs(found.base[quantity])
            assert change["absolute"] == pytest.approx(gap, rel=1e-9)
