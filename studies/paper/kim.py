"""Every claim of [Kim], H.-C. Kim, "Motions of a billiard ball after a cue stroke", against its own equations.

What: each numbered result of the paper is evaluated as printed, beside what follows from the equations of motion
(`integrate_impulse`: dv = B dp from event to event), at one stroke: b/R = 0.5, the paper's two-part cue (epsilon =
m_c/M = 2/35, Q0 = M_c/M = 18/7, nu_c = 1/3), e = 3/4, mu = 0.7 (a rigid cue: Q0 = 3, nu_c = 0.136, mu = 0.6). Limits
epsilon -> 0 are Richardson-extrapolated from the exact law. Numbers that the text quotes are compared with the same
quantities as derived. Sections are the paper's, I (introduction) to VI (summary). Equations: handbook: Frame and signs,
Inverse mass, The impulse solver, Errata of Kim 2022; closed_forms. The last claims are about the shaft itself, its cue
end, and finite elements: E 12.6 GPa, E/G 15, kappa 0.9, 540 g along its axis, T = 2 ms head on, 22 flexible bending
modes; numbers to four digits, about as exact as these modes allow.
"""

from __future__ import annotations

import dataclasses
import math
from collections import Counter
from collections.abc import Callable
from itertools import pairwise
from typing import Any, NamedTuple

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes
from scipy.optimize import brentq

from cuefem import Ball, Effect, Outcome, Resolution, Scene, Stroke, Tip, TipDome, end_mass, strike
from studies import pages
from studies.paper import closed_forms as forms
from studies.paper.claims import Claim, markdown
from studies.paper.tone import CUE_MASS, DENSITY, MAPLE, MASS, SHAFT, front, nearest, pieces

# The stroke: b/R = sin phi, e and mu; the paper's Q0 = M_c/M and epsilon = m_c/M; inertia factors of ball and cue end.
OFFSET, RESTITUTION, MU = 0.5, 0.75, 0.7
Q0, EPS, NU, NU_C = 18 / 7, 2 / 35, 0.4, 1 / 3
SIN, COS = OFFSET, math.sqrt(1 - OFFSET**2)  # of phi
TAN = SIN / COS
LINE = {"cue_mass_ratio": Q0}


class ImpulseSolution(NamedTuple):
    """A stroke by its events: s, the end of slip; c, that of compression; f, separation.

    p, tangential: normal and tangential impulse over M U; v: velocity (t, n) over U; work: of the normal force, over
    M U^2.
    """

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


def integrate_impulse(b: float, matrix: np.ndarray, mu: float = MU, e: float = RESTITUTION) -> ImpulseSolution:
    """Slip until v_t = 0, then stick; compression until v_n = 0; separation when e^2 of the normal work is regained.

    Assumes that slip ends in compression, p_s <= p_c.
    """
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
    return ImpulseSolution(p_s, p_c, p_f, mu * p_s, tangential, v_s, v_f, work_s, work_c, work_c * (1 - e**2))


def two_part_solution(eps: float, b: float = OFFSET, mu: float = MU, e: float = RESTITUTION) -> ImpulseSolution:
    return integrate_impulse(b, inverse_mass(b, Q0, eps * NU_C / (1 + NU_C)), mu, e)


def two_part_squirt(b: float, eps: float, cue: float = Q0, mu: float = MU, e: float = RESTITUTION) -> float:
    """Squirt of the two-part cue by the closed form, degrees."""
    form = forms.closed_form(b, mass=cue, end_mass=eps / 4, ball_mass=1.0, friction=mu, restitution=e)
    return float(np.degrees(form.squirt))


def two_part_form(eps: float = EPS, b: float = OFFSET, **more: Any) -> forms.ClosedForm:
    return forms.closed_form(b, mass=Q0, end_mass=eps * NU_C / (1 + NU_C), ball_mass=1.0, **more)


def rigid_squirt(b: float, cue: float, mu: float = 0.6, e: float = RESTITUTION) -> float:
    """Squirt of a rigid cue by the closed form, degrees."""
    form = forms.closed_form(b, mass=cue, end_mass=cue * 0.136 / 1.136, ball_mass=1.0, friction=mu, restitution=e)
    return float(np.degrees(form.squirt))


def at_zero(f: Callable[[float], Any], h: float = 2e-3) -> float:
    """The limit of f(epsilon) as epsilon -> 0, by Richardson extrapolation of halved steps."""
    row = [float(f(h / 2**k)) for k in range(6)]
    for order in range(1, 6):
        row = [(2**order * b - a) / (2**order - 1) for a, b in pairwise(row)]
    return row[0]


def formula(source: str, what: str, printed: float, derived: float, cause: str = "", unit: str = "") -> Claim:
    """A formula of the paper: it agrees if both evaluations agree to 1e-8; otherwise it is an error."""
    close = math.isclose(printed, derived, rel_tol=1e-8, abs_tol=1e-12)
    return Claim(source, what, float(printed), float(derived), unit, "agrees" if close else "error", cause)


def quoted(
    source: str, what: str, printed: float, derived: float, tolerance: float, unit: str = "", cause: str = "",
    otherwise: str = "error",
) -> Claim:  # fmt: skip
    """A number of the paper: it agrees if the derived one is within ``tolerance`` of it.

    tolerance: half a unit of the last printed digit, or, where the paper says 'almost', that distance.
    """
    verdict = "agrees" if abs(printed - derived) <= tolerance * (1 + 1e-9) else otherwise
    return Claim(source, what, float(printed), float(derived), unit, verdict, cause)


def statement(
    source: str, what: str, holds: bool, derived: float, cause: str = "", unit: str = "", printed: float | None = None
) -> Claim:  # fmt: skip
    """A statement of the paper, true or not, with the number that decides it."""
    return Claim(source, what, printed, float(derived), unit, "agrees" if holds else "error", cause)


def introduction_claims() -> list[Claim]:
    two = forms.two_part(OFFSET, cue_end_ratio=EPS, **LINE)
    light = forms.two_part(OFFSET, cue_end_ratio=1e-10, **LINE)
    needed = "friction needed at b/R = 0.5 to avoid a miscue, mu = tan phi"
    return [
        formula("I, miscue condition", needed + ", light cue end", TAN,
                forms.miscue_friction(light, OFFSET, restitution=RESTITUTION)),
        Claim("I, miscue condition", needed + ", epsilon = 2/35", TAN,
              float(forms.miscue_friction(two, OFFSET, restitution=RESTITUTION)), "", "rounding",
              "holds as epsilon -> 0; an end mass rotates the force towards the normal (see miscue.md)"),
        Claim("II, definition of theta", "tan theta = F_N/N", 1.0,
              two_part_solution(EPS).tangential_f / two_part_solution(EPS).p_f, "", "misprint",
              "both are the normal force; f/F_N is meant"),
        quoted("II, after eq. rc", "largest phi at mu = 0.7", 35, math.degrees(math.atan(0.7)), 0.5, "deg"),
        quoted("II, after eq. rc", "sin 45 deg", 0.707, math.sin(math.pi / 4), 5e-4),
        quoted("II, after eq. rc", "phi of Coriolis' b = 0.7 R, 'almost the same' as", 45,
               math.degrees(math.asin(0.7)), 0.6, "deg"),
    ]  # fmt: skip


def motion_claims() -> list[Claim]:
    """Section II: equations of motion, from vectors."""
    r_c, R_I, F = np.array([SIN, COS, 0]), np.array([0.0, -1, 0]), np.array([0.3, 1.1, 0])
    rng = np.random.default_rng(1)
    V, U = (np.append(rng.standard_normal(2), 0) for _ in range(2))
    spin, cue_spin = np.array([0, 0, 0.7]), np.array([0, 0, -0.4])
    contact = (V + np.cross(spin, R_I)) - (U + np.cross(cue_spin, r_c))
    relative = V - U - np.cross(R_I, spin) + np.cross(r_c, cue_spin)
    cue, nu_c = 3.0, 0.136
    m = cue / (1 + cue)
    accelerate = m * inverse_mass(OFFSET, cue, cue * nu_c / (1 + nu_c)) @ F[:2]
    vector = (1 + m / (nu_c * cue) + m / NU) * F - m * (r_c @ F) * r_c / (nu_c * cue) - m * (R_I @ F) * R_I / NU
    k = 1 / (nu_c * (cue + 1))
    beta_t, beta_n, beta_x = 1 + cue / (NU * (cue + 1)) + COS**2 * k, 1 + SIN**2 * k, SIN * COS * k
    exact = m * inverse_mass(OFFSET, cue, cue * nu_c / (1 + nu_c))
    rigid_form = forms.closed_form(OFFSET, mass=cue, end_mass=cue * nu_c / (1 + nu_c), ball_mass=1.0, friction=0.6)
    along = float(rigid_form.velocity @ [SIN, COS])
    wide = forms.rigid(np.sin(np.radians(np.arange(90))), cue_mass_ratio=np.logspace(-2, 2, 41)[:, None])
    widest = float(np.max(forms.gamma(wide)))
    taper = brentq(lambda q: 1 - forms.centre_of_mass(tip_radius=q, base_radius=1.0) - 0.7, 0.01, 0.99)
    stick = float(forms.inertia_factor(tip_radius=taper, base_radius=1.0))
    return [
        formula("II, eq. Rot", "torque on the cue, r_c (cos F_t - sin F_n)", COS * F[0] - SIN * F[1],
                np.cross(r_c, -F)[2]),
        formula("II, eq. Rot:ball", "torque on the ball, R F_t", F[0], np.cross(R_I, F)[2]),
        formula("II, eq. vrel", "relative velocity, t part", relative[0], contact[0]),
        formula("II, eq. vrel", "relative velocity, n part", relative[1], contact[1]),
        formula("II, eq. dv:FF", "m dv_t/dt", vector[0], accelerate[0]),
        formula("II, eq. dv:FF", "m dv_n/dt", vector[1], accelerate[1]),
        formula("II, eq. P:conserv", "momentum along the cue, M_c V_cue + M V", cue * rigid_form.cue_speed + along,
                cue),
        formula("II, eq. dvdv", "m dv_t/dp", beta_t * F[0] - beta_x * F[1], accelerate[0]),
        formula("II, eq. dvdv", "m dv_n/dp", beta_n * F[1] - beta_x * F[0], accelerate[1]),
        formula("II, eq. beta:r", "beta_x, rigid", beta_x, -exact[0, 1]),
        formula("II, eq. beta:r", "beta_par, rigid", beta_t, exact[0, 0]),
        formula("II, eq. beta:r", "beta_perp, rigid", beta_n, exact[1, 1]),
        formula("II, eq. domega dOmega", "R Omega/U, from I dOmega = R dp_t", two_part_solution(EPS).tangential_f / NU,
                two_part_form().spin),
        statement("II, eq. gamma:beta", "gamma <= 1; the largest over phi to 89 deg and Q0 from 0.01 to 100",
                  widest < 1, widest),
        quoted("II, after eq. P:conserv", "nu of a uniform ball", 0.4, 3 / 5 * 2 / 3, 5e-3),
        Claim("II, after eq. P:conserv", "nu_c of a cue whose r_c is 0.7 of its length", 0.136, stick, "", "error",
              "a cone with its centre of mass there (tip/butt diameter "
              f"{taper:.3f}) has this; a uniform rod 1/3; 0.136 is I = M_c L^2/15"),
    ]  # fmt: skip


def process_claims() -> list[Claim]:
    """Section III: the course of the collision, the two-part cue's numbers put into its equations."""
    x = two_part_solution(EPS)
    beta = forms.two_part(OFFSET, cue_end_ratio=EPS, **LINE)
    m, par, perp, cross = beta.reduced_mass, beta.parallel, beta.perpendicular, beta.cross
    g, mu_c = forms.gamma(beta), forms.critical_friction(beta)
    v_n0, ratio = -COS, MU / mu_c
    matrix = inverse_mass(OFFSET, Q0, EPS / 4)
    slip = matrix @ [MU, 1.0]
    p_s = m * SIN / (cross * (ratio - 1))
    work_s = v_n0 * p_s + (1 - g * ratio) * perp * p_s**2 / (2 * m)
    p_c = m * COS / ((1 - g) * perp) * (1 + mu_c * TAN)
    lost = (ratio - 1) * g / (1 - g) * (p_s / p_c) ** 2
    late = 1 + RESTITUTION * math.sqrt(1 - lost)
    G = (1 + mu_c * TAN) * math.sqrt(1 - lost)
    s_over_c = (1 - g) * mu_c * TAN / (g * (ratio - 1) * (1 + mu_c * TAN))
    jam = [brentq(lambda b: jam_excess(b), *span) for span in ((1e-3, 0.2), (0.4, 0.59))]
    near = two_part_solution(EPS, 0.1, mu=0.6)
    slow = two_part_solution(EPS, mu=0.6)
    edge = float(forms.compression_stick_friction(OFFSET, end_mass_ratio=EPS / 4))
    at_edge = 1 / ((edge / mu_c - 1) / (mu_c * TAN) + edge / mu_c)
    return [
        formula("III, eq. sliding", "m dv_t/dp", (MU * par - cross) / m, slip[0]),
        formula("III, eq. sliding", "m dv_n/dp", (perp - MU * cross) / m, slip[1]),
        formula("III, eq. ps:v", "p_s/(M U)", p_s, x.p_s),
        formula("III, eq. v:v0", "v_n(p_s)/U", v_n0 + (1 - MU * g / mu_c) * perp * p_s / m, x.v_s[1]),
        formula("III, eq. ps:v5", "v_n(p_s)/U", v_n0 * (1 - (1 - g * ratio) / (ratio - 1) * mu_c / g * TAN), x.v_s[1]),
        formula("III, eq. p parallel ps", "p_t(p_s)/(M U)", MU * m * SIN / (cross * (ratio - 1)), x.tangential_s),
        formula("III, eq. mu:cond", "friction at which a jam begins, mu_c/gamma", mu_c / g, perp / cross),
        statement("III, after eq. mu:cond", "a jam comes 'under specific circumstances'; least b/R of one, mu = 0.7",
                  False, jam[0], "with a light cue end the ordinary case"),
        statement("III, after eq. mu:cond", "greatest b/R of a jam, mu = 0.7", False, jam[1], "as above"),
        Claim("III, eq. cond:stick", "largest tan phi for slip to end in compression, mu = 0.7",
              (ratio - 1) / (mu_c * (1 / g - ratio)), None, "", "error",
              "negative in a jam, where slip always ends in compression; b/R = 0.5 jams and sticks"),
        formula("III, eq. lower", "bound of gamma where p_s = p_c", at_edge, g),
        formula("III, eq. W perp ps", "W(p_s)/(M U^2)", work_s, x.work_s),
        formula("III, eq. cond:pp", "dv_n/dp of slip at mu = mu_c/gamma, times M",
                perp / m * (1 - g * (mu_c / g) / mu_c), matrix[1, 1] + matrix[1, 0] * perp / cross),
        formula("III, eq. W:p", "W(p_f)/(M U^2), against the energy that ball, cue and friction leave", x.work_f,
                work_left(x, matrix)),
        formula("III, eq. stick:eom", "dp_t/dp of stick", mu_c, (x.tangential_f - x.tangential_s) / (x.p_f - x.p_s)),
        formula("III, eq. p II:stick", "p_t(p_c)/(M U)", MU * x.p_s + mu_c * (x.p_c - x.p_s),
                x.tangential_s - matrix[0, 1] / matrix[0, 0] * (x.p_c - x.p_s)),
        formula("III, eq. mu:cond1", "mu_c", mu_c, -matrix[0, 1] / matrix[0, 0]),
        formula("III, eq. dv+", "dv_n/dp of stick, times M", (1 - g) * perp / m, np.linalg.det(matrix) / matrix[0, 0]),
        formula("III, eq. pc", "(p_c - p_s)/(M U)", -m * x.v_s[1] / ((1 - g) * perp), x.p_c - x.p_s),
        formula("III, eq. pc2", "p_c/(M U)", p_c, x.p_c),
        formula("III, eq. v perp 0", "v_n(0)/U",
                (1 - g) * perp * p_c / m * (g * (ratio - 1) / (1 - g) * p_s / p_c - 1), v_n0),
        formula("III, eq. Wpc", "(W(p_c) - W(p_s))/(M U^2)", -perp * (1 - g) / (2 * m) * (p_c - p_s) ** 2,
                x.work_c - x.work_s),
        formula("III, eq. W pc", "W(p_c)/(M U^2)", -(1 - g) * perp * p_c**2 / (2 * m) * (1 - lost), x.work_c),
        formula("III, eq. ps/pc", "p_s/p_c", s_over_c, x.p_s / x.p_c),
        Claim("III, before item 1", "p_s/p_c at mu = 0.6, slip 'disappears almost instantaneously'", 0.0,
              slow.p_s / slow.p_c, "", "error", f"a third of the compression; {near.p_s / near.p_c:.2g} at b/R = 0.1"),
        statement("III, before item 1", "no slip after stick: mu_c/mu, must stay below 1", mu_c < MU, mu_c / MU,
                  "a lumped cue; a vibrating shaft: see below"),
        formula("III, eq. vf:pf", "v_n(p_f)/U", (1 - g) * perp / m * (x.p_f - x.p_c), x.v_f[1]),
        formula("III, eq. W:rest", "(W(p_f) - W(p_c))/(M U^2)", (1 - g) * perp * p_c**2 / (2 * m) * (late - 1) ** 2,
                x.work_f - x.work_c),
        formula("III, eq. p II f", "p_t(p_f)/(M U)", mu_c * p_c * ((ratio - 1) * p_s / p_c + late), x.tangential_f),
        formula("III, eq. e* 1", "e^2", (x.p_f / x.p_c - 1) ** 2 / (1 - lost), RESTITUTION**2),
        formula("III, eq. pf/pc", "p_f/p_c", late, x.p_f / x.p_c),
        formula("III, eq. v perp e", "v_n(p_f)/v_n(0)", -RESTITUTION * G, x.v_f[1] / v_n0),
        statement("III, after eq. G", "head on G = 1, Newton's law", restitution_factor_of(0.0, MU) == 1,
                  restitution_factor_of(0.0, MU)),
    ]  # fmt: skip


def work_left(x: ImpulseSolution, matrix: np.ndarray) -> float:
    """Work of the normal force on the contact, from the balance of kinetic energy and friction, per M U^2."""
    p = np.array([x.tangential_f, x.p_f])
    initial = Q0 / 2
    # v changes by B p: of kinetic energy, v0 . p + p B p/2 is gained, by the normal force and by friction
    gained = -np.array([SIN, COS]) @ p + p @ matrix @ p / 2
    ball = (p @ p + x.tangential_f**2 / NU) / 2
    cue = Q0 / 2 * (1 - np.array([SIN, COS]) @ p / Q0) ** 2 + (np.array([COS, -SIN]) @ p) ** 2 / (2 * EPS / 4)
    assert math.isclose(ball + cue - initial, gained, rel_tol=1e-9)
    friction = -SIN / 2 * x.tangential_s  # v_t is linear in p and ends at 0
    return float(ball + cue - initial - friction)


def jam_excess(b: float) -> float:
    return float(forms.jam_friction(forms.two_part(b, cue_end_ratio=EPS, **LINE))) - MU


def restitution_factor_of(b: float, mu: float) -> float:
    return float(forms.restitution_factor(forms.two_part(b, cue_end_ratio=EPS, **LINE), b, mu))


def state_claims() -> list[Claim]:
    """Section IV, the state after the impact: a rigid cue, Q0 = 3, mu = 0.6."""
    cue, mu = 3.0, 0.6
    beta = forms.rigid(OFFSET, cue_mass_ratio=cue)
    m, perp = beta.reduced_mass, beta.perpendicular
    g, mu_c = forms.gamma(beta), forms.critical_friction(beta)
    x = integrate_impulse(OFFSET, inverse_mass(OFFSET, cue, cue * 0.136 / 1.136), mu)
    G = math.sqrt((1 + mu_c * TAN) ** 2 - (1 / g - 1) / (mu / mu_c - 1) * (mu_c * TAN) ** 2)
    p_0 = m * COS / ((1 - g) * perp)
    bracket, bracket_t = 1 + RESTITUTION * G + mu_c * TAN, 1 + RESTITUTION * G + mu_c * TAN / g
    low, high = forms.restitution_bounds(beta, OFFSET)
    printed_high = 1 / (1 - SIN**2 / ((NU + 1) * (cue + 1)))
    b = np.linspace(0.01, 0.7, 70)
    lows, highs = forms.restitution_bounds(forms.rigid(b, cue_mass_ratio=cue), b)
    _, _, psi = rigid_map()
    rise, across = np.diff(psi, axis=1), np.diff(psi, axis=0)
    factors = forms.restitution_factor(forms.rigid(b, cue_mass_ratio=cue), b, mu)
    grid = np.linspace(0.9, 1, 11)
    of_gamma = np.sqrt((1 + mu_c * TAN) ** 2 - (1 / grid - 1) / (mu / mu_c - 1) * (mu_c * TAN) ** 2)
    theta = math.atan2(x.tangential_f, x.p_f)
    cause = "these are the bounds of a rigid cue with nu_c set to nu"
    return [
        formula("IV, eq. pc:ui", "p_c/(M U)", p_0 * (1 + mu_c * TAN), x.p_c),
        formula("IV, eq. pfpc2", "p_f/p_c", 1 + RESTITUTION * G / (1 + mu_c * TAN), x.p_f / x.p_c),
        formula("IV, eq. G:res", "G", G, x.v_f[1] / (RESTITUTION * COS)),
        formula("IV, after eq. bound1", "lower bound of G", math.sqrt(printed_high), low, cause),
        formula("IV, after eq. bound1", "upper bound of G", printed_high, high, cause),
        statement("IV, after eq. bound1", "G rises with gamma, all else fixed; least rise from 0.9 to 1 in 0.01",
                  np.diff(of_gamma).min() > 0, np.diff(of_gamma).min()),
        statement("IV, after eq. bound1", "G > 1 for b/R to 0.7; least G - 1", factors.min() > 1, factors.min() - 1),
        statement("IV, after eq. bound1", "bounds of G rise with phi; least rise in 0.01 of b/R, derived bounds",
                  min(np.diff(lows).min(), np.diff(highs).min()) > 0, min(np.diff(lows).min(), np.diff(highs).min())),
        formula("IV, eq. vf:egv", "v_n(p_f)/U", RESTITUTION * G * COS, x.v_f[1]),
        formula("IV, eq. pf parl", "p_t(p_f)/(M U)", mu_c * p_0 * bracket_t, x.tangential_f),
        formula("IV, V0", "V_n/U", m * COS / ((1 - g) * perp) * bracket, x.p_f),
        formula("IV, V0", "V_t/U", m * COS / ((1 - g) * perp) * mu_c * bracket_t, x.tangential_f),
        formula("IV, kinetic energy", "energy of translation/(M U^2)",
                p_0**2 / 2 * (bracket**2 + (mu_c * bracket_t) ** 2), (x.p_f**2 + x.tangential_f**2) / 2),
        formula("IV, eq. theta f", "tan theta", mu_c * (1 + (1 / g - 1) * mu_c * TAN / bracket),
                x.tangential_f / x.p_f),
        Claim("IV, after fig. squirt2", "squirt of a rigid cue, Q0 = 3, b/R = 0.5", 16,
              math.degrees(math.asin(OFFSET) - theta), "deg", "error",
              f"e = 3/4, mu = 0.6; e = 1 would give {rigid_squirt(OFFSET, 3.0, e=1.0):.3g}, Q0 = 5 "
              f"{rigid_squirt(OFFSET, 5.0):.3g}: no stated value gives 16"),
        Claim("IV, after fig. squirt2", "'psi = 30 deg' at half the radius", 30, math.degrees(math.asin(OFFSET)),
              "deg", "misprint", "the value is right but it is phi's, not psi's"),
        quoted("IV, after fig. squirt2", "the same in radians", 0.523, math.asin(OFFSET), 5e-4, "rad",
               "cut, not rounded", otherwise="rounding"),
        Claim("IV, after fig. squirt2", "squirt of a rigid cue as Q0 -> 0, b/R = 0.5", 0.0, rigid_squirt(OFFSET, 1e-9),
              "deg", "error", "m_e and M_c vanish together, and their ratio stays"),
        statement("IV, after fig. squirt2",
                  "squirt rises with phi; least rise in 0.5 deg on the map where slip ends in " "compression",
                  np.nanmin(rise) > 0, np.nanmin(rise), unit="deg"),
        statement("IV, after fig. squirt2", "squirt rises with Q0; least rise in 0.05 on the map, phi > 0",
                  np.nanmin(across[:, 1:]) > 0, np.nanmin(across[:, 1:]), unit="deg"),
        statement("IV, fig. squirt2",
                  "the figure runs to 45 deg at mu = 0.6; largest phi of the closed form at Q0 = 0", False,
                  last_angle(1e-9), "further out slip outlasts compression", "deg", 45.0),
        Claim("IV, fig. squirt2", "largest phi of the closed form at Q0 = 3", 45.0, last_angle(3.0), "deg", "rounding",
              "a tenth of a degree, which the figure does not show"),
    ]  # fmt: skip


def last_angle(cue: float, mu: float = 0.6) -> float:
    """Largest phi, deg, where slip ends in compression for a rigid cue."""
    k = 1.136 / (0.136 * cue)
    return math.degrees(math.atan(mu * (1 + 1 / NU + k) / (1 + k)))


def rigid_map() -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Phi, deg, Q0 and squirt, deg (nan where slip outlasts compression), of fig. squirt2."""
    phi, ratios = np.linspace(0, 45, 91), np.linspace(0.05, 5, 100)
    b, cue = np.sin(np.radians(phi)), ratios[:, None]
    end = cue * 0.136 / 1.136
    beta = forms.rigid(b, cue_mass_ratio=cue)
    factor = forms.restitution_factor(beta, b, 0.6)
    tangent = forms.squirt_tangent(b, cue_mass_ratio=cue, end_mass_ratio=end, restitution=RESTITUTION, factor=factor)
    holds = forms.closed_form_holds(b, mass=cue, end_mass=end, ball_mass=1.0, friction=0.6)
    return phi, ratios, np.where(holds, np.degrees(np.arctan(tangent)), np.nan)


def stroke_claims() -> list[Claim]:
    """The claims of sections I to IV."""
    return [*introduction_claims(), *motion_claims(), *process_claims(), *state_claims()]


CAROM_TABLE, CAROM_BALL = 2.84, 30.75e-3  # m: long side, radius
INERTIA_SUM = 1 / NU + 1 + 1 / Q0


def two_part_claims() -> list[Claim]:
    """Section V: equations of the two-part cue."""
    held = Q0 - EPS
    matrix = np.array([[EPS + held * COS**2, held * SIN * COS], [held * SIN * COS, EPS + held * SIN**2]])  # (U_n, U_t)
    inverse = np.linalg.inv(matrix)
    kick = -inverse @ [1.1, 0.3]
    m = EPS / (1 + EPS)
    k = m / EPS * COS**2
    less = 1 - EPS / Q0
    exact = m * inverse_mass(OFFSET, Q0, EPS / 4)
    x = two_part_solution(EPS)
    beta = forms.two_part(OFFSET, cue_end_ratio=EPS, **LINE)
    g, mu_c = forms.gamma(beta), forms.critical_friction(beta)
    G = math.sqrt((1 + mu_c * TAN) ** 2 - (1 / g - 1) / (MU / mu_c - 1) * (mu_c * TAN) ** 2)
    p_0 = m * COS / ((1 - g) * beta.perpendicular)
    bracket, bracket_t = 1 + RESTITUTION * G + mu_c * TAN, 1 + RESTITUTION * G + mu_c * TAN / g
    return [
        formula("V, dU_perp", "coefficient of dp_perp", -(EPS + held * SIN**2) / (Q0 * EPS), -inverse[0, 0]),
        formula("V, dU_par", "coefficient of dp_par", -(EPS + held * COS**2) / (Q0 * EPS), -inverse[1, 1]),
        formula("V, dU_perp", "coefficient of dp_par", held * COS * SIN / (Q0 * EPS), -inverse[0, 1]),
        formula("V, eq. dW", "dV_cue, along the cue", -(COS * 1.1 + SIN * 0.3) / Q0, COS * kick[0] + SIN * kick[1]),
        formula("V, beta'", "beta'_par", 1 + m / NU + k * (1 / NU_C - less * TAN**2), exact[0, 0]),
        formula("V, beta'", "beta'_perp", 1 - k * (less - TAN**2 / NU_C), exact[1, 1]),
        formula("V, beta'", "beta'_x", m / EPS * (1 / NU_C + less) * COS * SIN, -exact[0, 1]),
        formula("V, m/m_c", "slope of m/m_c in epsilon", -1.0, at_zero(lambda x: (1 / (1 + x) - 1) / x)),
        formula("V, eq. muc:'", "mu_c",
                m / EPS * (1 / NU_C + less) * COS * SIN / (1 + m / NU + k * (1 / NU_C - less * TAN**2)),
                -exact[0, 1] / exact[0, 0]),
        statement("V, eq. gamma:'", "gamma <= 1; 1 - gamma", g < 1, forms.one_minus_gamma(beta)),
        formula("V, eq. G:res2", "G", G, x.v_f[1] / (RESTITUTION * COS)),
        formula("V, eq. pfpc3", "p_f/(M U)", p_0 * bracket, x.p_f),
        formula("V, eq. pf parl2", "p_t(p_f)/(M U)", mu_c * p_0 * bracket_t, x.tangential_f),
        Claim("V, eq. V0 after", "V_t/U: factor 'mu_0'", None, mu_c, "", "misprint",
              "mu_0 is nowhere defined; mu_c is meant"),
        formula("V, eq. Omega0 after", "R Omega/U", mu_c * p_0 / NU * bracket_t, x.tangential_f / NU),
        formula("V, eq. V:angle", "tan theta", mu_c * (1 + (1 / g - 1) * mu_c * TAN / bracket),
                x.tangential_f / x.p_f),
        formula("V, eq. squirt:psi", "psi = phi - theta", math.degrees(math.asin(OFFSET) - math.atan2(x.tangential_f,
                x.p_f)), two_part_squirt(OFFSET, EPS), "", "deg"),
    ]  # fmt: skip


def light_end_claims() -> list[Claim]:
    """Section V: epsilon -> 0 and first order."""

    def beta(x: float) -> forms.Coefficients:
        return forms.two_part(OFFSET, cue_end_ratio=x, **LINE)

    def factor(x: float) -> Any:
        return forms.restitution_factor(beta(x), OFFSET, MU)

    def theta(x: float) -> float:
        form = two_part_form(x)
        return float(form.velocity[0] / form.velocity[1])

    zero = {
        "parallel": COS**2 / NU_C * (1 + NU_C),
        "perpendicular": SIN**2 / NU_C * (1 + NU_C),
        "cross": SIN * COS / NU_C * (1 + NU_C),
    }
    part = NU_C / (1 + NU_C)
    A = {
        "parallel": 1 - NU_C * (1 + NU) / (NU * (1 + NU_C) * COS**2) - part * TAN**2 / Q0,
        "perpendicular": 1 - part / SIN**2 - part / TAN**2 / Q0,
        "cross": 1 + part / Q0,
    }
    signs = {"parallel": "par", "perpendicular": "perp", "cross": "x"}
    slope = part * SIN * COS / (1 + RESTITUTION) * (1 / NU + INERTIA_SUM * RESTITUTION / COS**2)
    first = [formula("V, eq. epsilon0 1", f"beta0_{signs[n]}", z, at_zero(lambda x, n=n: getattr(beta(x), n)))
             for n, z in zero.items()]  # fmt: skip
    second = [
        formula(
            "V, A-coefficients", f"A_{signs[n]}", a, at_zero(lambda x, n=n: (1 - getattr(beta(x), n) / zero[n]) / x)
        )
        for n, a in A.items()
    ]
    return [
        *first,
        formula("V, eq. muc gamma", "mu_c -> tan phi", TAN, at_zero(lambda x: forms.critical_friction(beta(x)))),
        formula("V, eq. muc gamma", "gamma -> 1", 1.0, at_zero(lambda x: forms.gamma(beta(x)))),
        formula("V, eq. G 0th", "G -> 1/cos^2 phi", 1 / COS**2, at_zero(factor)),
        Claim("V, after eq. G 0th", "the bound gives phi < 45 deg; at mu = 0.7", 45, math.degrees(math.atan(0.7)),
              "deg", "error", "it gives tan phi <= mu, 45 deg only at mu = 1"),
        statement("V, eq. psi=0", "squirt vanishes with the end mass; limit at b/R = 0.5",
                  abs(at_zero(lambda x: two_part_squirt(OFFSET, x))) < 1e-9, 0.0, "", "deg", 0.0),
        *second,
        formula("V, mu_c, first order", "(1 - mu_c/tan phi)/epsilon", part / COS**2 * INERTIA_SUM,
                at_zero(lambda x: (1 - forms.critical_friction(beta(x)) / TAN) / x)),
        formula("V, gamma, first order", "(1 - gamma)/epsilon", part / (SIN * COS) ** 2 * (1 + 1 / Q0 + SIN**2 / NU),
                at_zero(lambda x: forms.one_minus_gamma(beta(x)) / x)),
        formula("V, eq. theta f: 1", "(1 - tan theta/tan phi)/epsilon",
                part / (1 + RESTITUTION) * (1 / NU + INERTIA_SUM * RESTITUTION / COS**2),
                at_zero(lambda x: (1 - theta(x) / TAN) / x)),
        formula("V, eq. psi squirt", "psi/epsilon", slope, at_zero(lambda x: math.radians(two_part_squirt(OFFSET,
                x)) / x), "", "rad"),
        quoted("V, after eq. psi squirt", "(1 + nu)/nu", 3.5, (1 + NU) / NU, 1e-12),
    ]  # fmt: skip


def squirt_claims() -> list[Claim]:
    """Section V: what the text reads off its formulas and figures."""

    def slope(b: float, cue: float) -> float:
        return float(forms.squirt_slope(b, cue_mass_ratio=cue))

    one = [brentq(lambda b, x=x: two_part_squirt(b, x) - 1, 0.05, 0.56) for x in (0.1, EPS)]
    first = brentq(lambda b: math.degrees(0.1 * slope(b, Q0)) - 1, 0.05, 0.5)
    light = brentq(lambda x: two_part_squirt(0.55, x) - 1, 1e-3, 0.1)
    error = CAROM_TABLE * math.tan(math.radians(1))
    where = brentq(lambda b: shepard_squirt(b, 0.1) - 4.38, 0.1, 0.6)
    curves = [0.0, *(two_part_squirt(OFFSET, x) for x in (2 / 35, 0.1, 0.2, 0.3, 0.4, 0.7, 1.0))]
    lines = [slope(OFFSET, x) for x in (0.3, 1, 18 / 7, 5)]
    heavy = two_part_squirt(OFFSET, 1.0) / two_part_squirt(OFFSET, EPS)
    text, after = "V, after eq. psi squirt", "V, after fig. squirt"
    none = integrate_impulse(OFFSET, inverse_mass(OFFSET, Q0, 0.1 / 4), 1.0, 0.0)
    psi_none = math.asin(OFFSET) - math.atan2(none.tangential_f, none.p_f)
    line = math.sin(math.asin(OFFSET) - psi_none)
    return [
        statement(text, "squirt falls as the cue grows heavier; slope at Q0 = 5 over 18/7",
                  slope(OFFSET, 5) < slope(OFFSET, Q0), slope(OFFSET, 5) / slope(OFFSET, Q0)),
        statement(text, "little effect above Q0 = 3; slope at 3 over that at infinity, less 1",
                  slope(OFFSET, 3) < 1.1 * slope(OFFSET, 1e12), slope(OFFSET, 3) / slope(OFFSET, 1e12) - 1),
        statement(text, "noticeably more squirt below Q0 = 1; slope at 0.3 over that at 18/7",
                  slope(OFFSET, 0.3) > 1.2 * slope(OFFSET, Q0), slope(OFFSET, 0.3) / slope(OFFSET, Q0)),
        Claim("V, fig. squirt", "'squirt is proportional to epsilon': psi(epsilon = 1)/psi(2/35)", 17.5, heavy, "",
              "rounding", "to first order only"),
        statement("V, fig. squirt", "almost linear for small b: psi(0.2)/(2 psi(0.1)), less 1",
                  abs(two_part_squirt(0.2, EPS) / 2 / two_part_squirt(0.1, EPS) - 1) < 0.02,
                  two_part_squirt(0.2, EPS) / 2 / two_part_squirt(0.1, EPS) - 1),
        statement("V, fig. squirt", "not linear near b/R = 0.5: psi(0.5)/(5 psi(0.1)), less 1",
                  two_part_squirt(0.5, EPS) / 5 / two_part_squirt(0.1, EPS) - 1 > 0.01,
                  two_part_squirt(0.5, EPS) / 5 / two_part_squirt(0.1, EPS) - 1),
        statement("V, fig. squirt", "squirt rises with epsilon at b/R = 0.5; least rise between the figure's curves",
                  np.diff(curves).min() > 0, np.diff(curves).min(), unit="deg"),
        statement("V, fig. squirt", "psi/epsilon falls with Q0 at b/R = 0.5; least fall between the figure's curves",
                  np.diff(lines).max() < 0, -np.diff(lines).max(), unit="rad"),
        Claim(after, "squirt 'less than 1 degree' for m_c/M < 0.1, b < 0.55 R; at the corner", 1.0,
              two_part_squirt(0.55, 0.1), "deg", "error",
              f"true for m_c/M below {light:.3f}; the formula itself is larger"),
        Claim(after, "b/R at which squirt is 1 deg, m_c/M = 0.1", 0.55, one[0], "", "error", "mu = 0.7; as above"),
        Claim(after, "b/R at which squirt is 1 deg, m_c/M = 2/35", 0.55, one[1], "", "error", "mu = 0.7; as above"),
        quoted(after, "error of 1 deg along a carom table", 49.6, 1e3 * error, 0.05, "mm"),
        Claim(after, "radius of a carom ball", 36.9, 1e3 * CAROM_BALL, "mm", "error", "61.5 mm diameter"),
        Claim(after, "that error in balls, '5/8 thickness'", 5 / 8, error / (2 * CAROM_BALL), "", "error",
              f"with the printed radius it would be {error / 0.0738:.2f}"),
        Claim("V, Shepard", "squirt by the printed formula at epsilon = 0.1 (given there at b/R = 0.5)", 4.38,
              shepard_squirt(OFFSET, 0.1), "deg", "open",
              f"offset not stated; 4.38 belongs to b/R = {where:.3f}"),
        Claim("V, Shepard", "eq. psi squirt at epsilon = 0.1 'smaller than 1 degree', at that offset", 1.0,
              math.degrees(0.1 * slope(where, Q0)), "deg", "error", f"the formula passes 1 deg at b/R = {first:.3f}"),
        Claim("V, Shepard", "Shepard's squirt of a cue end of epsilon = 0.1, b/R = 0.5, e = 0",
              shepard_squirt(OFFSET, 0.1), math.degrees(psi_none), "deg", "error",
              "1/epsilon stands for M/m_e, but m_e = m_c/4; and b is measured to the force's line"),
        formula("V, Shepard", "the same with M/m_e and b to the force's line",
                math.degrees(forms.shepard(line, mass_ratio=40.0)), math.degrees(psi_none), "the two models are one",
                "deg"),
        formula("V, Shepard", "[A.31] with M/m_e and b of the contact",
                math.degrees(forms.alciatore_a31(OFFSET, mass_ratio=40.0)), math.degrees(psi_none), "", "deg"),
    ]  # fmt: skip


def shepard_squirt(b: float, eps: float) -> float:
    """Squirt by Shepard's formula, degrees."""
    return float(np.degrees(forms.shepard(b, mass_ratio=1 / eps)))


def summary_claims() -> list[Claim]:
    """Section VI: speeds, spin and energy of a light cue end."""
    D = 1 + 1 / Q0 + SIN**2 / NU

    def spin(b: Any, cue: float = Q0) -> Any:
        return (1 + RESTITUTION) * b / NU / (1 + 1 / cue + b**2 / NU)

    def energy(x: float, b: float = OFFSET) -> float:
        form = two_part_form(x, b)
        return float(form.velocity @ form.velocity + NU * form.spin**2)

    def peak(cue: float) -> float:
        return brentq(lambda b: spin(b + 1e-30j, cue).imag, 0.3, 0.999, xtol=1e-15)

    b = np.linspace(0, 0.55, 56)
    speeds = np.hypot(*np.moveaxis(two_part_form(EPS, b).velocity, -1, 0))
    rough, smooth = two_part_form(friction=0.6), two_part_form(friction=2.0)
    text = "VI, after eq. Omega max"
    light = {c: forms.kinetic_energy([0.0, OFFSET], cue_mass_ratio=c) for c in (Q0, 0.3)}
    product = np.cross([OFFSET, -COS, 0], [0, 1.0, 0]) / OFFSET
    most = forms.largest_spin(cue_mass_ratio=[Q0, 5.0])
    minute = float(forms.ball_speed(OFFSET, cue_mass_ratio=0.01))
    tighter = two_part_form().squirt, forms.closed_form(OFFSET, mass=5.0, end_mass=EPS / 4, ball_mass=1.0)
    return [
        formula("VI, p_0", "p_0/(M U)", COS**3 / D, at_zero(lambda x: forms.initial_impulse(forms.two_part(OFFSET,
                cue_end_ratio=x, **LINE), OFFSET))),
        formula("VI, eq. Vf: 0", "V/U", (1 + RESTITUTION) / D,
                at_zero(lambda x: np.hypot(*two_part_form(x).velocity))),
        statement("VI, after eq. Vf: 0", "speed is largest head on; least fall in 0.01 of b/R, exact law",
                  np.diff(speeds).max() < 0, -np.diff(speeds).max()),
        formula("VI, eq. ROmega: 0", "R Omega/U", SIN / NU * (1 + RESTITUTION) / D,
                at_zero(lambda x: two_part_form(x).spin)),
        formula("VI, after eq. ROmega: 0", "R Omega = V_t/nu", two_part_form().velocity[0] / NU, two_part_form().spin),
        formula("VI, eq. Omega max", "R Omega_max/U", (1 + RESTITUTION) / (2 * math.sqrt(NU * (1 + 1 / Q0))),
                spin(peak(Q0))),
        formula("VI, after eq. Omega max", "sin phi_M", math.sqrt(NU * (1 + 1 / Q0)), peak(Q0)),
        Claim(text, "mass ratio 'Q0 = 18/6' beside Q0 = 3", 18 / 6, 18 / 7, "", "misprint",
              "0.745 below belongs to 18/7"),
        quoted(text, "sin phi_M at Q0 = 18/7", 0.745, peak(18 / 7), 5e-4),
        quoted(text, "sin phi_M at Q0 = 3", 0.730, peak(3.0), 5e-4),
        quoted(text, "sin phi_M of a heavy cue", 0.632, peak(1e15), 5e-4),
        statement(text, "spin rises with phi up to 0.7 R; least rise in 0.01",
                  np.diff(spin(np.arange(0, 0.701, 0.01))).min() > 0, np.diff(spin(np.arange(0, 0.701, 0.01))).min()),
        Claim(text, "'spin never depends on friction': spin at mu = 2 over 0.6, less 1", 0.0,
              float(smooth.spin / rough.spin - 1), "", "rounding", "only as epsilon -> 0"),
        formula("VI, strike point", "y/R of the contact", COS, -COS, "the near side of the ball has y < 0"),
        formula("VI, strike point", "z part of R_I x V_cue/b", 1.0, product[2]),
        formula("VI, kinetic energy", "K/(M U^2/2)", ((1 + RESTITUTION) / D) ** 2 * (1 + SIN**2 / NU),
                at_zero(energy)),
        statement("VI, kinetic energy", "it falls with phi; K(0.5)/K(0) at Q0 = 18/7", light[Q0][1] < light[Q0][0],
                  light[Q0][1] / light[Q0][0]),
        statement("VI, kinetic energy", "it falls with phi; K(0.5)/K(0) at Q0 = 0.3", light[0.3][1] < light[0.3][0],
                  light[0.3][1] / light[0.3][0], "at small phi it falls only for Q0 >= 1"),
        statement("VI, last paragraph", "a firm grip (Q0 = 5) raises spin: spin over that at 18/7",
                  tighter[1].spin > two_part_form().spin, tighter[1].spin / two_part_form().spin),
        statement("VI, last paragraph", "and the largest spin: over that at 18/7", most[1] > most[0],
                  most[1] / most[0]),
        statement("VI, last paragraph", "which comes at a smaller offset: sin phi_M over that at 18/7",
                  peak(5.0) < peak(Q0), peak(5.0) / peak(Q0)),
        statement("VI, after eq. Omega max", "a light cue gives little speed: V/U at Q0 = 0.01", minute < 0.02,
                  minute),
        statement("VI, last paragraph", "and lowers squirt: squirt over that at 18/7", tighter[1].squirt < tighter[0],
                  tighter[1].squirt / tighter[0]),
    ]  # fmt: skip


def cue_after_claims() -> list[Claim]:
    """Section VI: what becomes of the cue."""
    x = two_part_solution(EPS)
    m_e = EPS / 4
    along, across = COS * x.p_f + SIN * x.tangential_f, COS * x.tangential_f - SIN * x.p_f
    D = 1 + 1 / Q0 + SIN**2 / NU
    beta = forms.two_part(OFFSET, cue_end_ratio=EPS, **LINE)
    g, mu_c = forms.gamma(beta), forms.critical_friction(beta)
    G = x.v_f[1] / (RESTITUTION * COS)
    p_0 = float(forms.initial_impulse(beta, OFFSET))
    after_n = COS - (COS * along / Q0 + -SIN * across / EPS)  # the cue end's velocity, from eq. dW and m_c across
    after_t = SIN - (SIN * along / Q0 + COS * across / EPS)
    omega = across / m_e - across / EPS  # of the tip less that of the centre of mass
    second = COS**2 / ((1 + EPS) * NU_C * (1 - g) * beta.perpendicular)
    second *= (1 + RESTITUTION * G) * (mu_c - TAN) + mu_c * TAN * (mu_c / g - TAN)
    printed = -SIN * COS / (1 + NU_C) * ((1 + RESTITUTION / COS**2) * INERTIA_SUM - TAN * (1 + 1 / Q0)) / D
    b = np.sin(np.radians(np.arange(0, 46)))
    rotation = -forms.light_cue_end_rotation(b, **LINE)
    half = 0.5 * NU_C * EPS * omega**2

    def speed(eps: float) -> float:
        return float(two_part_form(eps).cue_speed)

    def rotating(eps: float) -> float:
        return float(forms.cue_end_rotation(OFFSET, two_part_form(eps).velocity, cue_end_ratio=eps))

    vanishing = 0.1 * (rotating(EPS / 10) / rotating(EPS)) ** 2
    lost = "the weights cos phi and sin phi of the first line are lost"
    return [
        formula("VI, eq. Vf: cue, line 1", "V_cue/U", 1 - (COS * x.p_f + SIN * x.tangential_f) / Q0,
                COS * after_n + SIN * after_t),
        formula("VI, eq. Vf: cue, line 2", "V_cue/U",
                1 - p_0 / Q0 * (1 + RESTITUTION * G + mu_c * TAN + mu_c * (1 + RESTITUTION * G + mu_c * TAN / g)),
                speed(EPS), lost),
        formula("VI, eq. Vf: cue, line 3", "V_cue/U, b/R = 0.5", 1 - (COS + SIN) * (1 + RESTITUTION) / D,
                at_zero(speed), "should be 1 - (1 + e)/(Q0 D), D = 1 + 1/Q0 + sin^2 phi/nu"),
        formula("VI, eq. Vf: cue, line 3", "V_cue/U, head on", 1 - (1 + RESTITUTION) / (1 + 1 / Q0),
                1 - (1 + RESTITUTION) / (Q0 * (1 + 1 / Q0)), "breaks momentum: 1/Q0 is lost"),
        formula("VI, omega_z, line 1", "r_c omega_z/U", across / (NU_C * EPS), omega),
        formula("VI, omega_z, line 2", "r_c omega_z/U", second, omega),
        formula("VI, omega_z, line 3", "r_c omega_z/U", printed, at_zero(rotating),
                "the last term tan phi (1 + 1/Q0) should be (1 + 1/Q0)"),
        statement("VI, after omega_z", "its size rises with phi; least rise in 1 deg to 45 deg",
                  np.diff(rotation).min() > 0, np.diff(rotation).min()),
        formula("VI, E_cue-end", "rotational energy/(M U^2)", 2 * half, half, "the factor 1/2 is missing"),
        statement("VI, E_cue-end", "it vanishes with epsilon: energy at epsilon/10 over that at epsilon",
                  vanishing < 0.12, vanishing),
        Claim("VI, error of a shot", "error of 0.5 deg along a carom table, in balls", 0.5,
              CAROM_TABLE * math.tan(math.radians(0.5)) / (2 * CAROM_BALL), "", "rounding", "'about half a ball'"),
    ]  # fmt: skip


def cue_claims() -> list[Claim]:
    """The claims of sections V and VI."""
    return [*two_part_claims(), *light_end_claims(), *squirt_claims(), *summary_claims(), *cue_after_claims()]


AT = Resolution(elements=8, order=4, modes=22)


def shaft_scene(*effects: Effect) -> Scene:
    """Kim's cue at b/R = 0.5."""
    cue = dataclasses.replace(front(MAPLE[1]), body_mass=CUE_MASS - MASS)
    return Scene(cue, Ball(), Tip(contact_time=2e-3), Stroke(offset=OFFSET), effects)


def slip_again(outcome: Outcome) -> float:
    """The time at which slip begins again, over the duration of the contact."""
    last = outcome.phases[-1]
    return float(last.start / outcome.duration) if last.state != "stick" else 1.0


def four(value: float) -> float:
    """Four significant digits."""
    return float(f"{value:.4g}")


def cue_end_claims() -> list[Claim]:
    """Section V: how long, how heavy, how stiff the cue end is."""
    base = float(forms.base_radius(0.12, **SHAFT))
    end = {"tip_radius": SHAFT["tip_radius"], "base_radius": base}
    nu_c = float(forms.inertia_factor(end_length=0.12, **end))
    area, r = math.pi * 0.0065**2, 0.0065
    reach = math.sqrt(2e-3 * math.sqrt(12.6e9 * math.pi * r**4 / 4 / (DENSITY * area)))
    source = "V, after eq. cue end"
    return [
        quoted("V, contact time", "period of 250 Hz", 0.004, 1 / 250, 1e-6, "s"),
        Claim("V, contact time", "contact of 0.002 s takes 'less than half a period'; half a period", 0.002, 1 / 500,
              "s", "rounding", "it is just half a period, not less"),
        quoted("V, before eq. cue end", "ten tip diameters", 12, 10 * 2 * 0.6, 0.5, "cm"),
        Claim("V, before eq. cue end", "length of the cue end that answers in 2 ms", 12, 100 * reach, "cm",
              "hypothesis",
              "read off a video; bending waves reach sqrt(T sqrt(EI/rhoA)) = 16 cm in 2 ms (12.6 GPa), "
              f"12 cm in {2 * (0.12 / reach) ** 2:.2g} ms"),
        quoted("V, before eq. cue end", "cue end over shaft by volume", 0.1, forms.volume_ratio(0.12, **SHAFT), 0.005),
        quoted("V, eq. cue end", "m_c", 12, 1e3 * forms.cone_end_mass(0.12, shaft_mass=MASS, **SHAFT), 0.5, "g"),
        quoted(source, "length of the pointed cone", 105.3, 100 * forms.full_cone_length(0.12, **end), 0.05, "cm"),
        quoted(source, "base radius a", 6.77, 1e3 * base, 0.005, "mm"),
        quoted(source, "centre of mass from the base, over l", 0.48, forms.centre_of_mass(**end), 0.005),
        Claim(source, "r_c/l", 0.5, 1 - float(forms.centre_of_mass(**end)), "", "rounding",
              "the paper takes the middle of the cue end"),
        Claim(source, "nu_c of the cue end about its centre of mass", 1 / 3, nu_c, "", "rounding",
              f"a uniform rod's; without rotary inertia {float(forms.inertia_factor(**end)):.4f}"),
        Claim(source, "m_c/m_e that follows, (1 + nu_c)/nu_c", 4.0, (1 + nu_c) / nu_c, "", "rounding",
              "from nu_c above"),
        quoted("V, after eq. psi=0", "epsilon = 12/210", 2 / 35, 12 / 210, 1e-15),
    ]  # fmt: skip


def impact_claims() -> list[Claim]:
    """The shaft's end mass and squirt, and what the tip's dome and the shaft's ringing change."""
    bare, domed = strike(shaft_scene(), at=AT), strike(shaft_scene(TipDome(6e-3)), at=AT)
    cue_end_mass = forms.cue_end_mass(end_mass(shaft_scene(), drive="stick", at=AT), NU_C)
    return [
        Claim("II, first paragraph", "squirt of a domed tip, radius 6 mm, over that of a contact on the axis", 1.0,
              four(domed.squirt / bare.squirt), "", "simplification",
              "the contact off the cue's axis is noticed and dropped in eq. rc; the axial force bends the shaft"),
        Claim("III, before item 1",
              "time at which slip begins again, over the contact's; 'an additional slip will not " "happen'", 1.0,
              four(slip_again(bare)), "", "simplification",
              "true of the paper's lumped cue; a vibrating shaft slips back just before it leaves"),
        Claim("V, eq. cue end", "m_c by stick end mass, (1 + nu_c)/nu_c m_e", 12, four(1e3 * cue_end_mass), "g",
              "hypothesis", "12 cm of cue end was a guess; the shaft's own bending gives this at 2 ms"),
        Claim("V, eq. squirt:psi", "squirt at b/R = 0.5 with m_c = 12 g, against the coupled strike of the shaft",
              four(two_part_squirt(OFFSET, EPS)), four(math.degrees(bare.squirt)), "deg", "hypothesis",
              "the same guess"),
    ]  # fmt: skip


def tone_claims() -> list[Claim]:
    """The 250 Hz that the author heard, beside the nearest mode of each piece that he may have tapped."""
    claims = []
    for piece in pieces():
        number, (low, kim, high), needed = nearest(piece, 1)[0]
        cause = f"E = 12.6 GPa; 10 to 16 GPa give {low:.0f} to {high:.0f} Hz, 250 Hz needs {needed / 1e9:.3g} GPa"
        claims.append(
            Claim("V, tone", f"250 Hz as mode {number} of the {piece.name}", 250.0, kim, "Hz", "hypothesis", cause)
        )
    return claims


def shaft_claims() -> list[Claim]:
    """The claims about the shaft."""
    return [*cue_end_claims(), *impact_claims(), *tone_claims()]


ENDS = (0, 2 / 35, 0.1, 0.2, 0.3, 0.4, 0.7, 1.0)


def claims() -> list[Claim]:
    """Every claim of the paper: sections I to IV, V and VI, and then what it says of the shaft itself."""
    return [*stroke_claims(), *cue_claims(), *shaft_claims()]


def text() -> str:
    """The table of claims, with a count of the verdicts."""
    listed = claims()
    count = Counter(claim.verdict for claim in listed)
    return pages.page(
        "Claims of Kim's paper and their derivation",
        "Does what Kim's paper prints follow from its own equations?",
        f"Of {len(listed)} claims {count['agrees']} agree, {count['rounding']} are roundings, {count['misprint']} "
        f"misprints, {count['simplification']} simplifications, {count['hypothesis']} hypotheses, {count['open']} is "
        f"open, and {count['error']} are errors: the paper's own definitions give another value. The betas, the closed "
        "form and its expansions are right. The cue's speed after the stroke, the limit of the cue end's rotation, the "
        "bounds of G and 'less than 1 degree' are wrong.",
        markdown(listed),
    )


def draw_rigid(axes: Axes) -> None:
    """Squirt of a rigid cue over phi and Q0 (the paper's fig. squirt2)."""
    phi, ratios, psi = rigid_map()
    levels = np.arange(0, 27, 2)
    phi, ratios, psi = phi[::2], ratios[1::2], psi[1::2, ::2]
    filled = axes.contourf(phi, ratios, psi, levels, cmap="viridis")
    lines = axes.contour(phi, ratios, psi, levels[1:], colors="white", linewidths=0.5)
    axes.clabel(lines, fmt="%d°", fontsize=8)
    axes.figure.colorbar(filled, ax=axes, label="squirt ψ, degrees")
    axes.set(
        xlabel="φ = asin(b/R), degrees",
        ylabel="cue over ball mass, Q₀",
        title="Rigid cue: e = 3/4, μ = 0.6, ν_c = 0.136",
    )
    axes.text(44.5, 0.25, "slip outlasts\ncompression", ha="right", fontsize=8)


def draw_ends(axes: Axes) -> None:
    """Squirt of the two-part cue for eight cue ends (left panel of fig. squirt)."""
    b = np.linspace(0, 0.7, 701)
    shades = iter(plt.colormaps["viridis"](np.linspace(0.05, 0.85, len(ENDS) - 2)))
    for eps in ENDS:
        if eps == 0:
            axes.plot(b, 0 * b, color="black", label="0")
            continue
        hold = b[forms.closed_form_holds(b, mass=18 / 7, end_mass=eps / 4, ball_mass=1.0, friction=0.7)]
        psi = forms.closed_form(hold, mass=18 / 7, end_mass=eps / 4, ball_mass=1.0).squirt
        kim = eps == 2 / 35
        axes.plot(
            hold,
            np.degrees(psi),
            color="red" if kim else next(shades),
            lw=2.2 if kim else 1.3,
            label="2/35" if kim else f"{eps:g}",
        )
    handles, labels = axes.get_legend_handles_labels()
    axes.legend(handles[::-1], labels[::-1], title="m_c/M", fontsize=8)
    axes.set(
        xlabel="offset b/R",
        ylabel="squirt ψ, degrees",
        title="Two-part cue: e = 3/4, Q₀ = 18/7, μ = 0.7;\ncurves end where slip outlasts compression",
        xlim=(0, 0.7),
    )


def draw(panels: Any) -> None:
    """Both figures of the paper."""
    draw_rigid(panels[0])
    draw_ends(panels[1])


EXAMPLE = """\
from math import degrees
import cuefem as cf

cue = cf.LumpedCue.two_part(0.54, 0.012)  # 540 g, of which a cue end of 12 g moves sideways
scene = cf.Scene(cue, cf.Ball(mass=0.21), cf.Tip(restitution=0.75, friction=0.7), cf.Stroke(1.0, 0.5))
print(f"squirt {degrees(cf.impulse(scene).squirt):.3f} degrees; the paper: less than 1 degree")
"""
STUDY = pages.Study(__file__, text, {"kim.svg": pages.Figure(draw, (1, 2), (11, 4.2))}, example=EXAMPLE)


if __name__ == "__main__":
    STUDY.write()
