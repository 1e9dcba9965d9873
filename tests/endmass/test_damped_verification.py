"""Prescribed drives on modes that radiate, against scipy's exponential of the whole motion (verification)."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
import scipy.linalg as la

import cuefem as cf
from cuefem.endmass import damped
from cuefem.endmass.undamped import StickLimit
from cuefem.tip_modes import Solved
from tests.helpers.cues import kim, scene

DRAW = np.random.default_rng(3)
SKEW = DRAW.normal(size=(40, 40))


@pytest.mark.parametrize("size", [0.0, 1e-9, 0.3, 4.0, 900.0])
def test_exponential_of_a_rotation_is_scipys(size: float) -> None:
    turning = size * (SKEW - SKEW.T) / np.linalg.norm(SKEW - SKEW.T, 2)
    found = damped.expm(turning)
    np.testing.assert_allclose(found, la.expm(turning), rtol=0, atol=1e-15 * (10 + size))
    np.testing.assert_allclose(found @ found.T, np.eye(40), rtol=0, atol=1e-15 * (10 + size))


def test_exponential_of_a_nilpotent_matrix_is_its_polynomial() -> None:
    shift = np.diag(np.full(5, 7.0), 1)
    exact = sum(np.linalg.matrix_power(shift, k) / float(np.prod(range(1, k + 1))) for k in range(6))
    np.testing.assert_allclose(damped.expm(shift), exact, rtol=1e-13)


@pytest.mark.parametrize("T", [0.5e-3, 2e-3])
@pytest.mark.parametrize("effects", [(), (cf.StructuralDamping(0.02),), (cf.Support(0.5, 1e4, 0.0, 5.0),)])
def test_modes_that_nothing_damps_are_taken_in_closed_form(T: float, effects: tuple[cf.Effect, ...]) -> None:
    tip = Solved(replace(scene(kim(), T), effects=effects)).tip
    A, row = damped._motion(tip)
    size, a = len(A), np.pi / T
    whole = np.zeros((size + 2, size + 2))
    whole[:size, :size], whole[:size, size] = A, row
    whole[size, size + 1], whole[size + 1, size] = a, -a
    exact = float(row @ la.expm(whole * T)[:size, size + 1])
    assert damped.half_sine_velocity(tip, T) == pytest.approx(exact, rel=2e-13)


def test_nothing_touched_is_the_closed_form() -> None:
    """The limit of a dashpot that vanishes."""
    found = scene(kim(), 1e-3)
    tip = Solved(found).tip
    still = replace(tip, radiation=1e-14 * tip.radiation)
    bare, limit = replace(tip, radiation=None), StickLimit.of(found)
    omega, phi = bare.transverse
    flexible = omega > 0
    args = omega[flexible], phi[flexible], float(np.sum(phi[~flexible] ** 2))
    exact = damped.undamped.half_sine_velocity(*args, T=1e-3)
    assert damped.half_sine_velocity(still, 1e-3) == pytest.approx(exact, rel=1e-12)
    assert damped.stick_impulse(still, limit) == pytest.approx(limit.transverse_impulse(*args), rel=1e-10)
