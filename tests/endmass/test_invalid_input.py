"""Invalid input of end masses: calls, whose messages are stored; squirts without an end mass (bad input)."""

from dataclasses import replace
from math import inf

import pytest

import cuefem as cf
from cuefem.endmass.definitions import equivalent_end_mass
from cuefem.endmass.end_mass_density import end_mass_density
from tests.helpers.cues import kim, scene
from tests.helpers.invalid_input import assert_calls_refused

SCENE = scene(kim(), 1e-3)
LOADED = replace(SCENE, effects=(cf.PointMass(position=0.1, mass=1e-3),))
CLAMPED = replace(scene(kim(), 2e-3), effects=(cf.Support(0.01, inf, inf),))


def test_end_mass_invalid_input_raises(request: pytest.FixtureRequest) -> None:
    assert_calls_refused("endmass", globals() | {"end_mass_density": end_mass_density}, request)


@pytest.mark.parametrize("mass", [1e-4, 1e-3, 0.01, 0.05])
def test_equivalent_end_mass_sliding_tip_raises(mass: float) -> None:
    """While the tip slides, squirt does not depend on the end mass, and round-off error must not determine one."""
    tip, stroke = cf.Tip(0.73, 0.2, contact_time=1e-3), cf.Stroke(2.0, 0.37)
    scene = cf.Scene(cf.LumpedCue(0.54, mass), cf.Ball(0.17, 0.028575), tip, stroke)
    slid = replace(cf.impulse(scene), regime="late stick")  # as if a vibrating cue had this squirt and stuck at the end
    with pytest.raises(ValueError, match="no single lumped end mass"):
        equivalent_end_mass(slid, scene)
    sticking = replace(scene, cue=cf.LumpedCue(0.54, 0.15))
    assert equivalent_end_mass(cf.impulse(sticking), sticking) == pytest.approx(0.15, rel=1e-9)
