"""Wood whose grain is turned, and shafts of wedges: limits and symmetries of what studies/beam/grain.py says."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from studies.beam.grain import PLANES, shares, turned


@pytest.mark.parametrize("plane", PLANES)
def test_straight_grain_and_a_quarter_turn(plane: str) -> None:
    """Nothing changes at 0; at 90 degrees the axis has the wood's E across; G is the same for both."""
    across, shear, nu = PLANES[plane]
    assert turned(0.0, across, shear, nu) == pytest.approx((1.0, 1.0), rel=1e-12)
    assert turned(math.pi / 2, across, shear, nu) == pytest.approx((across, 1.0), rel=1e-12)


@given(
    angle=st.floats(-math.pi, math.pi),
    across=st.floats(0.02, 1.0),
    shear=st.floats(0.02, 0.4),
    part=st.floats(0.0, 0.99),
)
def test_against_the_turned_tensor(angle: float, across: float, shear: float, part: float) -> None:
    """The plane's compliance, turned as a tensor; both moduli stay positive, and either sense is the same."""
    nu = min(part / math.sqrt(across), 0.5)  # below which the plane stores energy under every strain
    S = np.zeros((2, 2, 2, 2))
    S[0, 0, 0, 0], S[1, 1, 1, 1], S[0, 0, 1, 1], S[1, 1, 0, 0] = 1.0, 1 / across, -nu, -nu
    for place in ((0, 1, 0, 1), (0, 1, 1, 0), (1, 0, 0, 1), (1, 0, 1, 0)):
        S[place] = 1 / shear / 4
    R = np.array([[math.cos(angle), math.sin(angle)], [-math.sin(angle), math.cos(angle)]])
    T = np.einsum("ai,bj,ck,dl,ijkl->abcd", R, R, R, R, S)
    wood = turned(angle, across, shear, nu)
    assert pytest.approx(1 / T[0, 0, 0, 0], rel=1e-9) == wood.E
    assert wood.G * shear == pytest.approx(1 / (4 * T[0, 1, 0, 1]), rel=1e-9)
    assert min(wood) > 0
    assert turned(-angle, across, shear, nu) == pytest.approx(wood, rel=1e-12)


def test_a_body_that_is_the_same_in_all_directions_does_not_change() -> None:
    for angle in np.linspace(0, 3, 7):
        assert turned(float(angle), 1.0, 1 / 2.6, 0.3) == pytest.approx((1.0, 1.0), rel=1e-12)


@pytest.mark.parametrize("count", [1, 6, 8, 10])
def test_wedges_drawn_at_random(count: int) -> None:
    """Their sections integrated, and 40000 shafts drawn with a seed: both shares to 2 %."""
    t = (np.arange(3600) + 0.5) * 2 * math.pi / 3600
    wedge = (t * count / (2 * math.pi)).astype(int)
    turns = (0.0, math.pi / 4)
    second = np.array([[np.mean(2 * np.sin(t + turn) ** 2 * (wedge == i)) for i in range(count)] for turn in turns])
    E = np.random.default_rng(0).normal(1.0, 0.22, (40000, count))
    middle = np.mean(E, axis=1)
    mean, lobe = shares(count)
    assert np.std(middle) / 0.22 == pytest.approx(mean, rel=0.02)
    assert np.sqrt(np.mean((second @ E.T - middle) ** 2)) / 0.22 == pytest.approx(lobe, rel=0.02, abs=1e-6)
