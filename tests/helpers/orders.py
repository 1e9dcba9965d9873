"""Measures orders of convergence; no tests."""

from collections.abc import Callable

import numpy as np
from numpy.typing import ArrayLike, NDArray


def observed_orders(steps: ArrayLike, errors: ArrayLike) -> NDArray[np.float64]:
    """The order between each level and the next: log of the ratio of errors over log of the ratio of steps.

    steps: step sizes (or 1/elements, 1/T ...), strictly falling. errors: sizes of the errors, above zero.
    ValueError for fewer than two levels, steps that do not fall, errors that are zero or not finite.
    """
    steps, errors = np.asarray(steps, float), np.asarray(errors, float)
    if steps.shape != errors.shape or steps.ndim != 1 or len(steps) < 2:
        raise ValueError(f"an order needs two levels or more, one error a step; got {steps.shape} and {errors.shape}")
    if not (np.all(steps > 0) and np.all(np.diff(steps) < 0)):
        raise ValueError(f"steps must be above zero and fall; got {steps}")
    if not (np.all(np.isfinite(errors)) and np.all(errors > 0)):
        raise ValueError(f"errors must be finite and above zero; got {errors}")
    return np.log(errors[:-1] / errors[1:]) / np.log(steps[:-1] / steps[1:])


def assert_order(
    expected: float, steps: ArrayLike, errors: ArrayLike, *, within: ArrayLike, rounding: float = 1e-14
) -> None:
    """AssertionError unless the order at every level is ``expected``, neither less nor more, to ``within``.

    within: one bound, or one a level (pair of neighbouring steps), where the bound is known to tighten with the step.
    rounding: relative size of rounding in the errors; a level whose error comes within a hundred times of it is refused
    (ValueError), since it would show the order of noise.
    """
    errors = np.asarray(errors, float)
    found = observed_orders(steps, errors)
    if np.any(errors < 100 * rounding):
        raise ValueError(f"errors must stay 100 times above rounding, {rounding}; got {errors.min()}")
    bounds = np.broadcast_to(np.asarray(within, float), found.shape)
    wrong = np.abs(found - expected) > bounds
    assert not wrong.any(), f"order {expected} wanted within {bounds} at every level; got {found}"


def falls_with_the_step(error: Callable[[int], float], *, most: float = 1e-4) -> None:
    """AssertionError unless the error at 400 steps a contact is below ``most``, and a tenth of it or 1e-6 at 3200.

    A second order makes it a 64th; where in its step an event falls is chance.
    """
    coarse, fine = error(400), error(3200)
    assert coarse < most
    assert fine < max(coarse / 10, 1e-6), (coarse, fine)
