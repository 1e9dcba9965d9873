"""Properties of the order-measuring helper: it accepts the right order and fails on every kind of wrong one."""

import numpy as np
import pytest

from tests.helpers.orders import assert_order

STEPS = 1 / np.array([2.0, 4, 8, 16])


@pytest.mark.parametrize("order", [1, 2, 4, 6])
def test_accepts_the_order(order: int) -> None:
    assert_order(order, STEPS, 3 * STEPS**order, within=1e-9)


@pytest.mark.parametrize("order", [1.8, 2.2])
def test_fails_on_too_low_and_on_too_high(order: float) -> None:
    with pytest.raises(AssertionError, match="order 2 wanted"):
        assert_order(2, STEPS, STEPS**order, within=0.1)


def test_fails_on_errors_that_grow_or_stand_still() -> None:
    with pytest.raises(AssertionError):
        assert_order(2, STEPS, 1 / STEPS, within=0.1)
    with pytest.raises(AssertionError):
        assert_order(2, STEPS, np.full(4, 1e-3), within=0.1)


def test_a_bound_for_each_level() -> None:
    errors = STEPS**2 * (1 + STEPS**2)
    bounds = 2 * STEPS[:-1] ** 2
    assert_order(2, STEPS, errors, within=bounds)
    with pytest.raises(AssertionError):
        assert_order(2, STEPS, errors, within=bounds / 4)


@pytest.mark.parametrize(
    ("steps", "errors"),
    [
        ([0.5], [0.1]),
        ([0.5, 0.25], [0.1]),
        ([0.25, 0.5], [0.1, 0.2]),
        ([0.5, 0.5], [0.1, 0.1]),
        ([0.5, 0.0], [0.1, 0.1]),
        ([0.5, 0.25], [0.1, 0.0]),
        ([0.5, 0.25], [0.1, -0.1]),
        ([0.5, 0.25], [np.nan, 0.1]),
        ([0.5, 0.25], [np.inf, 0.1]),
    ],
)
def test_refuses_what_has_no_order(steps: list[float], errors: list[float]) -> None:
    with pytest.raises(ValueError, match=r"must|needs"):
        assert_order(2, steps, errors, within=0.1)
