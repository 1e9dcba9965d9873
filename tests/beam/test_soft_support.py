"""The limit of a support of vanishing stiffness is the free cue (verification)."""

from __future__ import annotations

import numpy as np
import pytest

from cuefem import Cue, LeatherTip, PointMass, Scene, Segment, Stroke, Support, end_mass, strike
from cuefem.effects.effect import Effect
from tests.helpers.orders import assert_order
from tests.helpers.strike_scenes import maple

CUE = Cue((Segment(0.02, 0.01275, 0.01275, maple(8e9)), Segment(0.7, 0.01275, 0.0215, maple())), body_mass=0.42)
UNEVEN = Cue((Segment(0.02, 0.012, 0.012, maple(40e9)), Segment(0.7, 0.01275, 0.0215, maple())), body_mass=0.42)


def scene(cue: Cue, *effects) -> Scene:
    return Scene(cue, stroke=Stroke(2.0, 0.3), effects=(LeatherTip(6e-3, 9.5e-3, 140e6), *effects))


@pytest.mark.parametrize("cue", [CUE, UNEVEN], ids=["even", "stiff ferrule"])
def test_end_mass_and_squirt_soft_support_converge_to_free_cue(cue: Cue) -> None:
    """The error is proportional to the stiffness, even where the soft mode's frequency is round-off error."""

    def results(*effects: Effect) -> np.ndarray:
        return np.array([end_mass(scene(cue, *effects)), strike(scene(cue, *effects)).squirt])

    free = results(PointMass(position=0.5, mass=1e-15))  # the same mesh, with an element's end where the support is
    errors = np.array([abs(results(Support(0.5, k)) / free - 1) for k in (1e3, 1e2, 1e-3, 1e-9)])
    for errors_of_one in errors.T:
        assert_order(1, [1e3, 1e2], errors_of_one[:2], within=0.05)
    assert errors.max() < 1e-6
