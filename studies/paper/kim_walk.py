"""What the parts of kim.py share: the reference stroke, the walk through the impulse equations, kinds of claims."""

from __future__ import annotations

import math
from collections.abc import Callable
from itertools import pairwise
from typing import Any, NamedTuple

import numpy as np

from cuefem import squirt
from cuefem.validation import Claim

B, Q0, EPS, E, MU, NU, NU_C = 0.5, 18 / 7, 2 / 35, 0.75, 0.7, 0.4, 1 / 3
S, C = B, math.sqrt(1 - B**2)
T = S / C
LINE = {"cue_mass_ratio": Q0}


class Walk(NamedTuple):
    """A stroke by its events, per M U: impulses, velocities (t, n) over U and normal work over M U^2 at each."""

    p_s: float
    p_c: float
    p_f: float
    tangential_s: float
    tangential_f: float
    v_s: np.ndarray
    v_f: np.ndarray
    work_s: float
    work_c: float
    work_f: float


def inverse_mass(b: float, cue: float, end: float, nu: float = NU) -> np.ndarray:
    """M B = M (B_ball + u u/m_a + w w/m_e) in (t, n), masses over the ball's."""
    u = np.array([b, math.sqrt(1 - b**2)])
    w = np.array([u[1], -u[0]])
    return np.diag([1 + 1 / nu, 1.0]) + np.outer(u, u) / cue + np.outer(w, w) / end


def walk(b: float, matrix: np.ndarray, mu: float = MU, e: float = E) -> Walk:
    """Slip until v_t = 0, stick; compressed when v_n = 0; separated when e^2 of the normal work is regained."""
    v = -np.array([b, math.sqrt(1 - b**2)])
    slip = matrix @ [mu, 1.0]
    p_s = -v[0] / slip[0]
    v_s = v + slip * p_s
    stick = np.array([-matrix[0, 1] / matrix[0, 0], 1.0])
    rate = (matrix @ stick)[1]
    p_c = p_s - v_s[1] / rate
    work_s = (v[1] + v_s[1]) / 2 * p_s
    work_c = work_s + v_s[1] / 2 * (p_c - p_s)
    p_f = p_c + math.sqrt(-2 * e**2 * work_c / rate)
    v_f = np.array([0.0, rate * (p_f - p_c)])
    tangential = mu * p_s + stick[0] * (p_f - p_s)
    return Walk(p_s, p_c, p_f, mu * p_s, tangential, v_s, v_f, work_s, work_c, work_c * (1 - e**2))


def two_part_walk(eps: float, b: float = B, mu: float = MU, e: float = E) -> Walk:
    return walk(b, inverse_mass(b, Q0, eps * NU_C / (1 + NU_C)), mu, e)


def degrees(b: float, eps: float, cue: float = Q0, mu: float = MU, e: float = E) -> float:
    """Squirt of the two-part cue by the exact law, degrees."""
    form = squirt.closed_form(b, mass=cue, end_mass=eps / 4, ball_mass=1.0, friction=mu, restitution=e)
    return float(np.degrees(form.squirt))


def two_part_form(eps: float = EPS, b: float = B, **more: Any) -> squirt.ClosedForm:
    return squirt.closed_form(b, mass=Q0, end_mass=eps * NU_C / (1 + NU_C), ball_mass=1.0, **more)


def rigid_degrees(b: float, cue: float, mu: float = 0.6, e: float = E) -> float:
    form = squirt.closed_form(b, mass=cue, end_mass=cue * 0.136 / 1.136, ball_mass=1.0, friction=mu, restitution=e)
    return float(np.degrees(form.squirt))


def at_zero(f: Callable[[float], Any], h: float = 2e-3) -> float:
    """The limit of f(epsilon) as epsilon -> 0, by Richardson extrapolation of halved steps."""
    row = [float(f(h / 2**k)) for k in range(6)]
    for order in range(1, 6):
        row = [(2**order * b - a) / (2**order - 1) for a, b in pairwise(row)]
    return row[0]


def same(source: str, what: str, printed: float, derived: float, cause: str = "", unit: str = "") -> Claim:
    """A formula of the paper: it agrees where both evaluations agree to 1e-8, else it is a slip."""
    close = math.isclose(printed, derived, rel_tol=1e-8, abs_tol=1e-12)
    return Claim(source, what, float(printed), float(derived), unit, "agrees" if close else "slip", cause)


def quoted(
    source: str, what: str, printed: float, derived: float, half_digit: float, unit: str = "", cause: str = "",
    otherwise: str = "slip",
) -> Claim:  # fmt: skip
    """A number of the paper: it agrees where the derived one rounds to it (``half_digit`` of its last place)."""
    verdict = "agrees" if abs(printed - derived) <= half_digit * (1 + 1e-9) else otherwise
    return Claim(source, what, float(printed), float(derived), unit, verdict, cause)


def said(
    source: str, what: str, holds: bool, derived: float, cause: str = "", unit: str = "", printed: float | None = None
) -> Claim:  # fmt: skip
    """A statement of the paper, true or not, with the number that decides it."""
    return Claim(source, what, printed, float(derived), unit, "agrees" if holds else "slip", cause)
