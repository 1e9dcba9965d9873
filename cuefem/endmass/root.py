"""The root of a function between two places."""

from __future__ import annotations

from collections.abc import Callable


def zero(function: Callable[[float], float], low: float, high: float) -> float:
    """The zero of a continuous function between two places of opposite sign, to 1e-15 and to rounding.

    Chandrupatla's method (Adv. Eng. Software 28 (1997) 145): inverse quadratic interpolation where it is safe, else
    bisection. scipy.optimize has it too, but loading that would take a fifth of a cold start.
    """
    a, b = low, high
    at_a, at_b, part = function(a), function(b), 0.5
    if at_a == 0 or at_b == 0:
        return a if at_a == 0 else b
    while True:
        x = a + part * (b - a)
        at_x = function(x)
        c, at_c = a, at_a  # the place before, at the far side of x or behind it
        if (at_x > 0) != (at_a > 0):
            c, at_c, b, at_b = b, at_b, a, at_a
        a, at_a = x, at_x
        best = a if abs(at_a) < abs(at_b) else b
        least = (1e-15 + 2e-15 * abs(best)) / abs(b - a)
        if at_a == 0 or least > 0.5:
            return best
        xi, phi = (a - b) / (c - b), (at_a - at_b) / (at_c - at_b)
        part = 0.5
        if phi**2 < xi and (1 - phi) ** 2 < 1 - xi:
            part = at_a / (at_b - at_a) * at_c / (at_b - at_c)
            part += (c - a) / (b - a) * at_a / (at_c - at_a) * at_b / (at_c - at_b)
        part = min(1 - least, max(least, part))
