"""Impact on endless Euler beams, solved without cuefem: their response goes with the square root of time; no tests.

A force F(t) on an Euler beam that is endless to both sides moves its place by

    w(t) = C/Gamma(3/2) integral of sqrt(t - s) F(s) over s from 0 to t,    C = 1/(2 sqrt(2) EI^(1/4) rhoA^(3/4)),

and the free end of one that is endless to one side four times as far: with 4 b^4 = rhoA p^2/EI, p Laplace's variable,
the deflection F/(8 EI b^3) exp(-b |x|) (cos(b x) + sin(b |x|)) satisfies the equation of the one, and
F/(2 EI b^3) exp(-b x) cos(b x) that of the other. A striker of mass m and speed v on a spring k then has, in units of
1/w0 = sqrt(m/k) of time, v/w0 of length and m v w0 of force, the compression

    d = t - I^2 F - L I^(3/2) F,    L = C m sqrt(w0),

where I^a is the integral of the order a, and L is the only parameter: the part that inelasticity has in Zener's plate.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import quad
from scipy.optimize import brentq
from scipy.special import gamma, wofz

Array = NDArray[np.float64]


def spring_exact(inelasticity: float) -> tuple[float, float]:
    """(e_A, duration in 1/w0) of an elastic spring, in closed form.

    Laplace: F = 1/(p^2 + 1 + L sqrt(p)). Over the four roots u of u^4 + L u + 1, F(t) is the sum of
    u exp(u^2 t) erfc(-u sqrt(t))/(4 u^3 + L).
    """
    u = np.roots([1.0, 0.0, 0.0, inelasticity, 1.0])
    weights = u / (4 * u**3 + inelasticity)

    def force(t: float) -> float:
        return float((weights * wofz(-1j * u * math.sqrt(t))).sum().real)

    end = next(t for t in np.linspace(0.05, 40, 800) if force(t) < 0)
    last = brentq(force, end - 0.05, end, xtol=1e-14)
    # force is smooth in the root of time
    impulse = quad(lambda x: 2 * x * force(x * x), 0, math.sqrt(last), epsabs=1e-13, limit=200)[0]
    return impulse - 1, last


def stepped(
    inelasticity: float, *, exponent: float = 1.0, restitution: float = 1.0, steps: int = 4000, span: float = 6.0
) -> tuple[float, float]:
    """(e_A, duration) of a power law F = d^exponent that gives back e^2 of its work, by product integration.

    Forces are taken straight between ``steps`` times up to ``span``; the error falls like 1/steps^2. Units: of length
    (m v^2/K)^(1/(n + 1)), of time that over v.
    """
    h = span / steps
    orders = ((2.0, 1.0), (1.5, inelasticity))
    weights = np.zeros(steps + 1)
    n = np.arange(steps + 1.0)
    for a, factor in orders:
        scale = factor * h**a / gamma(a + 2)
        weights[1:] += scale * ((n[1:] + 1) ** (a + 1) - 2 * n[1:] ** (a + 1) + (n[1:] - 1) ** (a + 1))
        weights[0] += scale
    forces, depth, deepest, impulse = np.zeros(steps + 1), np.zeros(steps + 1), None, 0.0
    for i in range(1, steps + 1):
        free = i * h - weights[i - 1 : 0 : -1] @ forces[1:i]  # forces[0] is zero
        rest = 0.0 if deepest is None else (1 - restitution**2) * deepest
        soft = 1.0 if deepest is None else restitution**2
        depth[i] = _balance(free, weights[0], exponent, rest, soft, start=depth[i - 1])
        if deepest is not None and depth[i] <= rest:
            part = (depth[i - 1] - rest) / (depth[i - 1] - depth[i])
            return impulse + forces[i - 1] * part * h / (exponent + 1) - 1, (i - 1 + part) * h
        forces[i] = max((depth[i] - rest) / soft, 0.0) ** exponent
        if deepest is None and depth[i] < depth[i - 1]:
            curve = depth[i - 2] - 2 * depth[i - 1] + depth[i]
            deepest = depth[i - 1] - (depth[i] - depth[i - 2]) ** 2 / (8 * curve)
            rest = (1 - restitution**2) * deepest
            forces[i] = max((depth[i] - rest) / restitution**2, 0.0) ** exponent
        impulse += (forces[i - 1] + forces[i]) * h / 2
    raise RuntimeError("the contact lasts longer than the span")


def _balance(free: float, weight: float, exponent: float, rest: float, soft: float, *, start: float) -> float:
    """The depth d with d + weight ((d - rest)/soft)^exponent = free, by Newton's steps."""
    d = start
    for _ in range(60):
        squeezed = max((d - rest) / soft, 0.0)
        slope = exponent * squeezed ** (exponent - 1) / soft if squeezed > 0 or exponent == 1 else 0.0
        step = (d + weight * squeezed**exponent - free) / (1 + weight * slope)
        d -= step
        if abs(step) < 1e-15 * (1 + abs(d)):
            break
    return d
