"""Verification: a support that is next to nothing is no support, down to the last digits."""

from __future__ import annotations

import pytest

from cuefem import Cue, LeatherTip, PointMass, Scene, Segment, Stroke, Support, end_mass, strike
from tests.helpers.strike_scenes import maple

CUE = Cue((Segment(0.02, 0.01275, 0.01275, maple(8e9)), Segment(0.7, 0.01275, 0.0215, maple())), body_mass=0.42)
UNEVEN = Cue((Segment(0.02, 0.012, 0.012, maple(40e9)), Segment(0.7, 0.01275, 0.0215, maple())), body_mass=0.42)


def scene(cue: Cue, *effects) -> Scene:
    return Scene(cue, stroke=Stroke(2.0, 0.3), effects=(LeatherTip(6e-3, 9.5e-3, 140e6), *effects))


@pytest.mark.parametrize("cue", [CUE, UNEVEN], ids=["even", "stiff ferrule"])
@pytest.mark.parametrize("k", [1e-9, 1e-3])
def test_end_mass_and_squirt_go_to_those_of_a_free_cue(cue: Cue, k: float) -> None:
    # the same mesh, with an element's end where the support is
    held, free = (scene(cue, effect) for effect in (Support(0.5, k), PointMass(0.5, 1e-15)))
    assert end_mass(held) == pytest.approx(end_mass(free), rel=1e-7)
    assert strike(held).squirt == pytest.approx(strike(free).squirt, rel=1e-6)
