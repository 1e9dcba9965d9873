"""Properties of the public calls as other programs make them: fixed signatures, clear refusals."""

from dataclasses import replace

import numpy as np
import pytest

import cuefem as cf
from tests.helpers.strike_scenes import imbalance, kim_scene


def test_modes_takes_a_scene_s_effects_and_leaves_those_at_the_tip() -> None:
    cue = kim_scene().cue
    bare = cf.modes(cue, 3).frequencies
    np.testing.assert_array_equal(cf.modes(cue, 3, None, (cf.TipShear(0.5), cf.TipDome(0.009))).frequencies, bare)
    heavier = cf.modes(cue, 3, effects=(cf.TipShear(0.5), cf.PointMass(0.1, 0.01))).frequencies
    assert np.all(heavier < bare)
    with pytest.raises(TypeError, match=r"modes effects must be effects.*got 3"):
        cf.modes(cue, 3, effects=(3,))


def test_a_clamped_tip_is_struck_but_has_no_end_mass() -> None:
    clamped = replace(kim_scene(0.3), effects=(cf.Support(0.0, np.inf),))
    assert imbalance(cf.strike(clamped)) < 1e-9
    for drive in ("stick", "velocity", "force"):
        with pytest.raises(ValueError, match=r"a clamp holds the tip across the cue"):
            cf.end_mass(clamped, drive)


def test_other_things_than_scenes_are_refused() -> None:
    for call in (cf.strike, cf.impulse):
        with pytest.raises(TypeError, match=f"{call.__name__} scene must be a Scene; got 3"):
            call(3)  # type: ignore[arg-type]
    with pytest.raises(TypeError, match=r"Scene\.effects must be a sequence of effects"):
        replace(kim_scene(), effects=cf.TipShear(0.5))
