"""Invalid input of `end_mass`, and squirts without an end mass (bad input)."""

from __future__ import annotations

import math
from dataclasses import replace

import pytest

import cuefem as cf
from cuefem import end_mass
from cuefem.endmass.definitions import equivalent_end_mass
from cuefem.endmass.end_mass_density import end_mass_density
from tests.helpers.cues import kim, scene
from tests.helpers.invalid_input import assert_raises

SCENE = scene(kim(), 1e-3)


def test_end_mass_unknown_drive_raises() -> None:
    message = "end_mass drive must be one of stick, offset, velocity, force, squirt; got 'push'"
    assert_raises(lambda: end_mass(SCENE, "push"), message)


def test_end_mass_density_of_a_lumped_cue_or_with_an_effect_raises() -> None:
    assert_raises(
        lambda: end_mass_density(replace(SCENE, cue=cf.LumpedCue(0.54, 0.01))),
        "Scene.cue must be a Cue of segments: its modes or its shape are needed; got a LumpedCue",
    )
    loaded = replace(SCENE, effects=(cf.PointMass(position=0.1, mass=1e-3),))
    assert_raises(lambda: end_mass_density(loaded), "end_mass_density scene must have no effects; got 1")


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


def test_end_mass_of_a_tip_that_moves_back_raises() -> None:
    clamp = cf.Support(0.01, math.inf, math.inf)
    impact = replace(scene(kim(), 2e-3), effects=(clamp,))
    with pytest.raises(ValueError, match="must move with the impulse when the contact ends"):
        end_mass(impact, "force")
