"""Timoshenko beams solved without cuefem: a frequency equation and a shooting method; no tests."""

from __future__ import annotations

import math
from collections.abc import Callable
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

from cuefem import Cue, Segment

Array = NDArray[np.float64]


def _roots(function: Callable[[float], float], grid: Array) -> list[float]:
    values = [function(x) for x in grid]
    pairs = pairwise(zip(grid, values, strict=True))
    return [brentq(function, x, y, xtol=1e-300, rtol=1e-14) for (x, fx), (y, fy) in pairs if fx * fy < 0]


def uniform_frequencies(cue: Cue, count: int) -> Array:
    """The lowest free-free frequencies of a uniform rod, Hz, from its frequency equation.

    With a = rhoA W^2/kGA, b = rhoI W^2/EI, c = rhoA W^2/EI a deflection e^(kx) has k^4 + (a + b) k^2 + ab - c = 0, so
    k^2 = p (above zero below the shear cut-off) or -q, and theta' = w'' + a w. About the middle, h = L/2, the even and
    odd solutions without moment and shear force at the ends satisfy, r = sqrt(p), s = sqrt(q),

        even  (p + a) cosh(rh) sin(sh)/s + (q - a) cos(sh) sinh(rh)/r = 0
        odd   (p + a) p sinh(rh)/r cos(sh) - (q - a) q sin(sh)/s cosh(rh) = 0

    which stay smooth through p = 0.
    """
    section, h = cue.section(0.0), cue.length / 2
    EI, kGA, rhoA, rhoI = (float(x) for x in (section.EI, section.kGA, section.rhoA, section.rhoI))

    def sides(omega: float) -> tuple[float, float]:
        a, b, c = (x * omega**2 for x in (rhoA / kGA, rhoI / EI, rhoA / EI))
        half = math.hypot((a - b) / 2, math.sqrt(c))
        p, q = half - (a + b) / 2, half + (a + b) / 2
        r, s = math.sqrt(abs(p)), math.sqrt(q)
        if p > 0:  # both over e^(rh)
            cosh, sinh = (1 + math.exp(-2 * r * h)) / 2, -math.expm1(-2 * r * h) / 2 / r
        else:
            cosh, sinh = math.cos(r * h), math.sin(r * h) / r
        cos, sin = math.cos(s * h), math.sin(s * h) / s
        return (p + a) * cosh * sin + (q - a) * cos * sinh, (p + a) * p * sinh * cos - (q - a) * q * sin * cosh

    euler = ((np.arange(1, count + 2) + 0.5) * math.pi / cue.length) ** 2 * math.sqrt(EI / rhoA)
    grid = np.geomspace(0.2 * euler[0], euler[-1], 300 * count)
    found = _roots(lambda omega: sides(omega)[0], grid) + _roots(lambda omega: sides(omega)[1], grid)
    return np.sort(found)[:count] / (2 * math.pi)


def _properties(segment: Segment, s: float) -> tuple[float, float, float, float]:
    """(EI, kGA, rhoA, rhoI) at s m from the tip end of a segment whose kappa is given; written out anew."""
    t = s / segment.length
    outer = (segment.tip_diameter * (1 - t) + segment.butt_diameter * t) / 2
    inner = (segment.tip_bore * (1 - t) + segment.butt_bore * t) / 2
    area, inertia = math.pi * (outer**2 - inner**2), math.pi / 4 * (outer**4 - inner**4)
    m, core = segment.material, segment.core
    EI, GA, rhoA, rhoI = m.E * inertia, m.G * area, m.rho * area, m.rho * inertia
    if core:
        disc, turn = math.pi * inner**2, math.pi / 4 * inner**4
        EI, GA, rhoA, rhoI = EI + core.E * turn, GA + core.G * disc, rhoA + core.rho * disc, rhoI + core.rho * turn
    assert segment.kappa is not None
    return EI, segment.kappa * GA, rhoA, rhoI


def _misfit(cue: Cue, omega: float) -> float:
    """Determinant of (shear force, moment) at the butt, of the two motions without either at the tip."""
    length, stiffness = cue.length, float(cue.section(cue.length).EI)
    state = np.array([[1.0, 0.0], [0.0, 1.0], [0.0, 0.0], [0.0, 0.0]])  # w/L, theta, Q L^2/EI, M L/EI
    for segment in cue.segments:

        def slope(s: float, y: Array, segment: Segment = segment) -> Array:
            EI, kGA, rhoA, rhoI = _properties(segment, s)
            w, theta, Q, M = y.reshape(4, 2)
            return np.array(
                [
                    theta / length + Q * stiffness / (kGA * length**3),
                    M * stiffness / (EI * length),
                    -(omega**2) * rhoA * w * length**3 / stiffness,
                    -Q / length - omega**2 * rhoI * theta * length / stiffness,
                ]
            ).ravel()

        for ends in pairwise(np.linspace(0, segment.length, 5)):
            run = solve_ivp(slope, ends, state.ravel(), method="DOP853", rtol=1e-12, atol=1e-14)
            # both motions grow alike, and their determinant would be lost in rounding: keep them orthogonal
            state, mix = np.linalg.qr(run.y[:, -1].reshape(4, 2))
            state = state * np.sign(np.diag(mix))
    return float(np.linalg.det(state[2:]))


def shot_frequency(cue: Cue, guess: float) -> float:
    """The free-free frequency within 0.1 % of a guess, Hz, by shooting; every kappa given."""
    low, high = 2 * math.pi * guess * 0.999, 2 * math.pi * guess * 1.001
    return brentq(lambda omega: _misfit(cue, omega), low, high, xtol=1e-300, rtol=1e-13) / (2 * math.pi)
