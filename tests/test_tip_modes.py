"""Every cue becomes tip modes through one door, and each eigenproblem of a scene is solved once (properties)."""

import numpy as np
import pytest

import cuefem as cf
from cuefem.contact.strike import strike_modes
from cuefem.tip_modes import Solved, default_modes, tip_modes_of
from tests.helpers.strike_scenes import kim_scene

LUMPED = cf.Scene(cf.LumpedCue(0.54, 0.006, 3.0), stroke=cf.Stroke(offset=0.3))


def test_a_lumped_cue_goes_the_same_way() -> None:
    tip = tip_modes_of(LUMPED)
    assert not tip.omega.any()
    assert strike_modes(LUMPED, tip).squirt == cf.strike(LUMPED).squirt
    inverse = tip.amplitude.T @ tip.amplitude
    assert inverse == pytest.approx(np.array([[1 / 0.54, 3.0], [3.0, 1 / 0.006]]), rel=1e-12)


def test_what_needs_segments_says_so() -> None:
    for ask in (lambda: LUMPED.shaft, lambda: Solved(LUMPED).modes, lambda: default_modes(LUMPED)):
        with pytest.raises(ValueError, match=r"must be a Cue of segments: .* got a LumpedCue"):
            ask()
    assert LUMPED.lumped is LUMPED.cue
    assert kim_scene(0.3).lumped is None
