"""Verification: the impulses of the phases add up to the whole, whatever holds the contact aside."""

from dataclasses import replace
from math import inf

import numpy as np
import pytest

from cuefem import TipDome, TipShear, strike
from tests.helpers.strike_scenes import kim_scene


@pytest.mark.parametrize("effects", [(), (TipShear(0.75),), (TipDome(0.0095),), (TipShear(0.75), TipDome(0.0095))])
@pytest.mark.parametrize("friction", [0.2, 0.7, inf])
@pytest.mark.parametrize("restitution", [0.0, 0.75])
def test_impulses_of_the_phases_add_up(effects, friction, restitution):
    scene = kim_scene(0.4)
    scene = replace(scene, tip=replace(scene.tip, friction=friction, restitution=restitution), effects=effects)
    outcome = strike(scene)
    given = np.sum([phase.impulse for phase in outcome.phases], axis=0)
    np.testing.assert_allclose(given, outcome.impulse, rtol=1e-12, atol=1e-12 * abs(outcome.impulse[1]))
