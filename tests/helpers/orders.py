"""Assertions on orders of convergence; no tests."""

from collections.abc import Callable

import numpy as np
from numpy.typing import ArrayLike


def assert_order(expected: float, steps: ArrayLike, errors: ArrayLike, *, within: ArrayLike) -> None:
    """AssertionError unless the order at every level is ``expected``, neither less nor more, to ``within``.

    steps: step sizes (or 1/elements, 1/T ...), strictly falling. errors: errors, a hundred times the round-off error.
    within: one bound, or one a level (pair of neighbouring steps), where the bound is known to tighten with the step.
    """
    steps, errors = np.asarray(steps, float), np.asarray(errors, float)
    assert np.all(np.diff(steps) < 0)
    assert np.all(errors > 1e-12)
    orders = np.log(errors[:-1] / errors[1:]) / np.log(steps[:-1] / steps[1:])
    assert np.all(np.abs(orders - expected) <= within), orders


def assert_error_falls_with_the_step(error: Callable[[int], float], *, most: float = 1e-4) -> None:
    """AssertionError unless the error at 400 steps a contact is below ``most``, and a tenth of it or 1e-6 at 3200.

    A second order makes it a 64th; where in its step an event falls is chance.
    """
    coarse, fine = error(400), error(3200)
    assert coarse < most
    assert fine < max(coarse / 10, 1e-6), (coarse, fine)
