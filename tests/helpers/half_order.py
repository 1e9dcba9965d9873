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
from scipy.integrate import quad
from scipy.optimize import brentq
from scipy.special import wofz


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
