"""Sections V and VI of [Kim]: the flexible cue, its light cue end, and the summary. Part of kim.py."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from scipy.optimize import brentq

from cuefem import squirt
from cuefem.validation import Claim
from studies.kim_walk import (
    EPS,
    LINE,
    MU,
    NU,
    NU_C,
    Q0,
    B,
    C,
    E,
    S,
    T,
    at_zero,
    degrees,
    inverse_mass,
    quoted,
    said,
    same,
    two_part_form,
    two_part_walk,
    walk,
)  # fmt: skip

CAROM_TABLE, CAROM_BALL = 2.84, 30.75e-3  # m: long side, radius
X = 1 / NU + 1 + 1 / Q0


def two_part() -> list[Claim]:
    """Section V: equations of the two-part cue."""
    held = Q0 - EPS
    matrix = np.array([[EPS + held * C**2, held * S * C], [held * S * C, EPS + held * S**2]])  # of (U_n, U_t)
    inverse = np.linalg.inv(matrix)
    kick = -inverse @ [1.1, 0.3]
    m = EPS / (1 + EPS)
    k = m / EPS * C**2
    less = 1 - EPS / Q0
    exact = m * inverse_mass(B, Q0, EPS / 4)
    x = two_part_walk(EPS)
    beta = squirt.two_part(B, cue_end_ratio=EPS, **LINE)
    g, mu_c = squirt.gamma(beta), squirt.critical_friction(beta)
    G = math.sqrt((1 + mu_c * T) ** 2 - (1 / g - 1) / (MU / mu_c - 1) * (mu_c * T) ** 2)
    p_0 = m * C / ((1 - g) * beta.perpendicular)
    bracket, bracket_t = 1 + E * G + mu_c * T, 1 + E * G + mu_c * T / g
    return [
        same("V, dU_perp", "coefficient of dp_perp", -(EPS + held * S**2) / (Q0 * EPS), -inverse[0, 0]),
        same("V, dU_par", "coefficient of dp_par", -(EPS + held * C**2) / (Q0 * EPS), -inverse[1, 1]),
        same("V, dU_perp", "coefficient of dp_par", held * C * S / (Q0 * EPS), -inverse[0, 1]),
        same("V, eq. dW", "dV_cue, along the cue", -(C * 1.1 + S * 0.3) / Q0, C * kick[0] + S * kick[1]),
        same("V, beta'", "beta'_par", 1 + m / NU + k * (1 / NU_C - less * T**2), exact[0, 0]),
        same("V, beta'", "beta'_perp", 1 - k * (less - T**2 / NU_C), exact[1, 1]),
        same("V, beta'", "beta'_x", m / EPS * (1 / NU_C + less) * C * S, -exact[0, 1]),
        same("V, m/m_c", "slope of m/m_c in epsilon", -1.0, at_zero(lambda x: (1 / (1 + x) - 1) / x)),
        same("V, eq. muc:'", "mu_c", m / EPS * (1 / NU_C + less) * C * S / (1 + m / NU + k * (1 / NU_C - less * T**2)),
             -exact[0, 1] / exact[0, 0]),
        said("V, eq. gamma:'", "gamma <= 1; 1 - gamma", g < 1, squirt.one_minus_gamma(beta)),
        same("V, eq. G:res2", "G", G, x.v_f[1] / (E * C)),
        same("V, eq. pfpc3", "p_f/(M U)", p_0 * bracket, x.p_f),
        same("V, eq. pf parl2", "p_t(p_f)/(M U)", mu_c * p_0 * bracket_t, x.tangential_f),
        Claim("V, eq. V0 after", "V_t/U: factor 'mu_0'", None, mu_c, "", "slip",
              "mu_0 is nowhere defined; mu_c is meant"),
        same("V, eq. Omega0 after", "R Omega/U", mu_c * p_0 / NU * bracket_t, x.tangential_f / NU),
        same("V, eq. V:angle", "tan theta", mu_c * (1 + (1 / g - 1) * mu_c * T / bracket), x.tangential_f / x.p_f),
        same("V, eq. squirt:psi", "psi = phi - theta", math.degrees(math.asin(B) - math.atan2(x.tangential_f, x.p_f)),
             degrees(B, EPS), "", "deg"),
    ]  # fmt: skip


def light_end() -> list[Claim]:
    """Section V: epsilon -> 0 and first order."""

    def beta(x: float) -> squirt.Coefficients:
        return squirt.two_part(B, cue_end_ratio=x, **LINE)

    def factor(x: float) -> Any:
        return squirt.restitution_factor(beta(x), B, MU)

    def theta(x: float) -> float:
        form = two_part_form(x)
        return float(form.velocity[0] / form.velocity[1])

    zero = {
        "parallel": C**2 / NU_C * (1 + NU_C),
        "perpendicular": S**2 / NU_C * (1 + NU_C),
        "cross": S * C / NU_C * (1 + NU_C),
    }
    part = NU_C / (1 + NU_C)
    A = {
        "parallel": 1 - NU_C * (1 + NU) / (NU * (1 + NU_C) * C**2) - part * T**2 / Q0,
        "perpendicular": 1 - part / S**2 - part / T**2 / Q0,
        "cross": 1 + part / Q0,
    }
    signs = {"parallel": "par", "perpendicular": "perp", "cross": "x"}
    slope = part * S * C / (1 + E) * (1 / NU + X * E / C**2)
    first = [same("V, eq. epsilon0 1", f"beta0_{signs[n]}", z, at_zero(lambda x, n=n: getattr(beta(x), n)))
             for n, z in zero.items()]  # fmt: skip
    second = [
        same("V, A-coefficients", f"A_{signs[n]}", a, at_zero(lambda x, n=n: (1 - getattr(beta(x), n) / zero[n]) / x))
        for n, a in A.items()
    ]
    return [
        *first,
        same("V, eq. muc gamma", "mu_c -> tan phi", T, at_zero(lambda x: squirt.critical_friction(beta(x)))),
        same("V, eq. muc gamma", "gamma -> 1", 1.0, at_zero(lambda x: squirt.gamma(beta(x)))),
        same("V, eq. G 0th", "G -> 1/cos^2 phi", 1 / C**2, at_zero(factor)),
        Claim("V, after eq. G 0th", "the bound gives phi < 45 deg; at mu = 0.7", 45, math.degrees(math.atan(0.7)),
              "deg",
              "slip", "it gives tan phi <= mu, 45 deg only at mu = 1"),
        said("V, eq. psi=0", "squirt vanishes with the end mass; limit at b/R = 0.5",
             abs(at_zero(lambda x: degrees(B, x))) < 1e-9, 0.0, "", "deg", 0.0),
        *second,
        same("V, mu_c, first order", "(1 - mu_c/tan phi)/epsilon", part / C**2 * X,
             at_zero(lambda x: (1 - squirt.critical_friction(beta(x)) / T) / x)),
        same("V, gamma, first order", "(1 - gamma)/epsilon", part / (S * C) ** 2 * (1 + 1 / Q0 + S**2 / NU),
             at_zero(lambda x: squirt.one_minus_gamma(beta(x)) / x)),
        same("V, eq. theta f: 1", "(1 - tan theta/tan phi)/epsilon", part / (1 + E) * (1 / NU + X * E / C**2),
             at_zero(lambda x: (1 - theta(x) / T) / x)),
        same("V, eq. psi squirt", "psi/epsilon", slope, at_zero(lambda x: math.radians(degrees(B, x)) / x), "", "rad"),
        quoted("V, after eq. psi squirt", "(1 + nu)/nu", 3.5, (1 + NU) / NU, 1e-12),
    ]  # fmt: skip


def squirt_of_cues() -> list[Claim]:
    """Section V: what the text reads off its formulas and figures."""

    def slope(b: float, cue: float) -> float:
        return float(squirt.squirt_slope(b, cue_mass_ratio=cue))

    one = [brentq(lambda b, x=x: degrees(b, x) - 1, 0.05, 0.56) for x in (0.1, EPS)]
    first = brentq(lambda b: math.degrees(0.1 * slope(b, Q0)) - 1, 0.05, 0.5)
    light = brentq(lambda x: degrees(0.55, x) - 1, 1e-3, 0.1)
    error = CAROM_TABLE * math.tan(math.radians(1))
    where = brentq(lambda b: shepard_degrees(b, 0.1) - 4.38, 0.1, 0.6)
    curves = [0.0, *(degrees(B, x) for x in (2 / 35, 0.1, 0.2, 0.3, 0.4, 0.7, 1.0))]
    lines = [slope(B, x) for x in (0.3, 1, 18 / 7, 5)]
    heavy = degrees(B, 1.0) / degrees(B, EPS)
    text, after = "V, after eq. psi squirt", "V, after fig. squirt"
    none = walk(B, inverse_mass(B, Q0, 0.1 / 4), 1.0, 0.0)
    psi_none = math.asin(B) - math.atan2(none.tangential_f, none.p_f)
    line = math.sin(math.asin(B) - psi_none)
    return [
        said(text, "squirt falls as the cue grows heavier; slope at Q0 = 5 over 18/7", slope(B, 5) < slope(B, Q0),
             slope(B, 5) / slope(B, Q0)),
        said(text, "little effect above Q0 = 3; slope at 3 over that at infinity, less 1", slope(B, 3) < 1.1 * slope(B,
             1e12),
             slope(B, 3) / slope(B, 1e12) - 1),
        said(text, "noticeably more squirt below Q0 = 1; slope at 0.3 over that at 18/7", slope(B,
             0.3) > 1.2 * slope(B, Q0),
             slope(B, 0.3) / slope(B, Q0)),
        Claim("V, fig. squirt", "'squirt is proportional to epsilon': psi(epsilon = 1)/psi(2/35)", 17.5, heavy, "",
              "rounding",
              "to first order only"),
        said("V, fig. squirt", "almost linear for small b: psi(0.2)/(2 psi(0.1)), less 1",
             abs(degrees(0.2, EPS) / 2 / degrees(0.1, EPS) - 1) < 0.02, degrees(0.2, EPS) / 2 / degrees(0.1, EPS) - 1),
        said("V, fig. squirt", "not linear near b/R = 0.5: psi(0.5)/(5 psi(0.1)), less 1",
             degrees(0.5, EPS) / 5 / degrees(0.1, EPS) - 1 > 0.01, degrees(0.5, EPS) / 5 / degrees(0.1, EPS) - 1),
        said("V, fig. squirt", "squirt rises with epsilon at b/R = 0.5; least rise between the figure's curves",
             np.diff(curves).min() > 0, np.diff(curves).min(), unit="deg"),
        said("V, fig. squirt", "psi/epsilon falls with Q0 at b/R = 0.5; least fall between the figure's curves",
             np.diff(lines).max() < 0, -np.diff(lines).max(), unit="rad"),
        Claim(after, "squirt 'less than 1 degree' for m_c/M < 0.1, b < 0.55 R; at the corner", 1.0, degrees(0.55, 0.1),
              "deg",
              "slip", f"true for m_c/M below {light:.3f}; the formula itself is larger"),
        Claim(after, "b/R at which squirt is 1 deg, m_c/M = 0.1", 0.55, one[0], "", "slip", "mu = 0.7; as above"),
        Claim(after, "b/R at which squirt is 1 deg, m_c/M = 2/35", 0.55, one[1], "", "slip", "mu = 0.7; as above"),
        quoted(after, "error of 1 deg along a carom table", 49.6, 1e3 * error, 0.05, "mm"),
        Claim(after, "radius of a carom ball", 36.9, 1e3 * CAROM_BALL, "mm", "slip", "61.5 mm diameter"),
        Claim(after, "that error in balls, '5/8 thickness'", 5 / 8, error / (2 * CAROM_BALL), "", "slip",
              f"with the printed radius it would be {error / 0.0738:.2f}"),
        Claim("V, Shepard", "squirt by the printed formula at epsilon = 0.1 (given there at b/R = 0.5)", 4.38,
              shepard_degrees(B, 0.1), "deg", "not derivable", f"offset not stated; 4.38 belongs to b/R = {where:.3f}"),
        Claim("V, Shepard", "eq. psi squirt at epsilon = 0.1 'smaller than 1 degree', at that offset", 1.0,
              math.degrees(0.1 * slope(where, Q0)), "deg", "slip", f"the formula passes 1 deg at b/R = {first:.3f}"),
        Claim("V, Shepard", "Shepard's squirt of a cue end of epsilon = 0.1, b/R = 0.5, e = 0", shepard_degrees(B, 0.1),
              math.degrees(psi_none), "deg", "slip",
              "1/epsilon stands for M/m_e, but m_e = m_c/4; and b is measured to the force's line"),
        same("V, Shepard", "the same with M/m_e and b to the force's line",
             math.degrees(squirt.shepard(line, mass_ratio=40.0)), math.degrees(psi_none), "the two models are one",
             "deg"),
        same("V, Shepard", "[A.31] with M/m_e and b of the contact",
             math.degrees(squirt.alciatore_a31(B, mass_ratio=40.0)), math.degrees(psi_none), "", "deg"),
    ]  # fmt: skip


def shepard_degrees(b: float, eps: float) -> float:
    return float(np.degrees(squirt.shepard(b, mass_ratio=1 / eps)))


def summary() -> list[Claim]:
    """Section VI: speeds, spin and energy of a light cue end."""
    D = 1 + 1 / Q0 + S**2 / NU

    def spin(b: Any, cue: float = Q0) -> Any:
        return (1 + E) * b / NU / (1 + 1 / cue + b**2 / NU)

    def energy(x: float, b: float = B) -> float:
        form = two_part_form(x, b)
        return float(form.velocity @ form.velocity + NU * form.spin**2)

    def peak(cue: float) -> float:
        return brentq(lambda b: spin(b + 1e-30j, cue).imag, 0.3, 0.999, xtol=1e-15)

    b = np.linspace(0, 0.55, 56)
    speeds = np.hypot(*np.moveaxis(two_part_form(EPS, b).velocity, -1, 0))
    rough, smooth = two_part_form(friction=0.6), two_part_form(friction=2.0)
    text = "VI, after eq. Omega max"
    light = {c: squirt.kinetic_energy([0.0, B], cue_mass_ratio=c) for c in (Q0, 0.3)}
    turn = np.cross([B, -C, 0], [0, 1.0, 0]) / B
    most = squirt.largest_spin(cue_mass_ratio=[Q0, 5.0])
    minute = float(squirt.ball_speed(B, cue_mass_ratio=0.01))
    tighter = two_part_form().squirt, squirt.closed_form(B, mass=5.0, end_mass=EPS / 4, ball_mass=1.0)
    return [
        same("VI, p_0", "p_0/(M U)", C**3 / D,
             at_zero(lambda x: squirt.initial_impulse(squirt.two_part(B, cue_end_ratio=x, **LINE), B))),
        same("VI, eq. Vf: 0", "V/U", (1 + E) / D, at_zero(lambda x: np.hypot(*two_part_form(x).velocity))),
        said("VI, after eq. Vf: 0", "speed is largest head on; least fall in 0.01 of b/R, exact law",
             np.diff(speeds).max() < 0, -np.diff(speeds).max()),
        same("VI, eq. ROmega: 0", "R Omega/U", S / NU * (1 + E) / D, at_zero(lambda x: two_part_form(x).spin)),
        same("VI, after eq. ROmega: 0", "R Omega = V_t/nu", two_part_form().velocity[0] / NU, two_part_form().spin),
        same("VI, eq. Omega max", "R Omega_max/U", (1 + E) / (2 * math.sqrt(NU * (1 + 1 / Q0))), spin(peak(Q0))),
        same("VI, after eq. Omega max", "sin phi_M", math.sqrt(NU * (1 + 1 / Q0)), peak(Q0)),
        Claim(text, "mass ratio 'Q0 = 18/6' beside Q0 = 3", 18 / 6, 18 / 7, "", "slip", "0.745 below belongs to 18/7"),
        quoted(text, "sin phi_M at Q0 = 18/7", 0.745, peak(18 / 7), 5e-4),
        quoted(text, "sin phi_M at Q0 = 3", 0.730, peak(3.0), 5e-4),
        quoted(text, "sin phi_M of a heavy cue", 0.632, peak(1e15), 5e-4),
        said(text, "spin rises with phi up to 0.7 R; least rise in 0.01", np.diff(spin(np.arange(0, 0.701,
             0.01))).min() > 0,
             np.diff(spin(np.arange(0, 0.701, 0.01))).min()),
        Claim(text, "'spin never depends on friction': spin at mu = 2 over 0.6, less 1", 0.0,
              float(smooth.spin / rough.spin - 1), "", "rounding", "only as epsilon -> 0"),
        same("VI, strike point", "y/R of the contact", C, -C, "the near side of the ball has y < 0"),
        same("VI, strike point", "z part of R_I x V_cue/b", 1.0, turn[2]),
        same("VI, kinetic energy", "K/(M U^2/2)", ((1 + E) / D) ** 2 * (1 + S**2 / NU), at_zero(energy)),
        said("VI, kinetic energy", "it falls with phi; K(0.5)/K(0) at Q0 = 18/7", light[Q0][1] < light[Q0][0],
             light[Q0][1] / light[Q0][0]),
        said("VI, kinetic energy", "it falls with phi; K(0.5)/K(0) at Q0 = 0.3", light[0.3][1] < light[0.3][0],
             light[0.3][1] / light[0.3][0],
             "at small phi it falls only for Q0 >= 1"),
        said("VI, last paragraph", "a firm grip (Q0 = 5) raises spin: spin over that at 18/7",
             tighter[1].spin > two_part_form().spin, tighter[1].spin / two_part_form().spin),
        said("VI, last paragraph", "and the largest spin: over that at 18/7", most[1] > most[0], most[1] / most[0]),
        said("VI, last paragraph", "which comes at a smaller offset: sin phi_M over that at 18/7", peak(5.0) < peak(Q0),
             peak(5.0) / peak(Q0)),
        said("VI, after eq. Omega max", "a light cue gives little speed: V/U at Q0 = 0.01", minute < 0.02, minute),
        said("VI, last paragraph", "and lowers squirt: squirt over that at 18/7", tighter[1].squirt < tighter[0],
             tighter[1].squirt / tighter[0]),
    ]  # fmt: skip


def cue_after() -> list[Claim]:
    """Section VI: what becomes of the cue."""
    x = two_part_walk(EPS)
    m_e = EPS / 4
    along, across = C * x.p_f + S * x.tangential_f, C * x.tangential_f - S * x.p_f
    D = 1 + 1 / Q0 + S**2 / NU
    beta = squirt.two_part(B, cue_end_ratio=EPS, **LINE)
    g, mu_c = squirt.gamma(beta), squirt.critical_friction(beta)
    G = x.v_f[1] / (E * C)
    p_0 = float(squirt.initial_impulse(beta, B))
    after_n = C - (C * along / Q0 + -S * across / EPS)  # the cue end's velocity, from eq. dW and m_c across
    after_t = S - (S * along / Q0 + C * across / EPS)
    turn = across / m_e - across / EPS  # of the tip less that of the centre of mass
    second = C**2 / ((1 + EPS) * NU_C * (1 - g) * beta.perpendicular)
    second *= (1 + E * G) * (mu_c - T) + mu_c * T * (mu_c / g - T)
    printed = -S * C / (1 + NU_C) * ((1 + E / C**2) * X - T * (1 + 1 / Q0)) / D
    b = np.sin(np.radians(np.arange(0, 46)))
    rotation = -squirt.light_cue_end_rotation(b, **LINE)
    half = 0.5 * NU_C * EPS * turn**2

    def speed(eps: float) -> float:
        return float(two_part_form(eps).cue_speed)

    def rotating(eps: float) -> float:
        return float(squirt.cue_end_rotation(B, two_part_form(eps).velocity, cue_end_ratio=eps))

    vanishing = 0.1 * (rotating(EPS / 10) / rotating(EPS)) ** 2
    lost = "the weights cos phi and sin phi of the first line are lost"
    return [
        same("VI, eq. Vf: cue, line 1", "V_cue/U", 1 - (C * x.p_f + S * x.tangential_f) / Q0,
             C * after_n + S * after_t),
        same("VI, eq. Vf: cue, line 2", "V_cue/U",
             1 - p_0 / Q0 * (1 + E * G + mu_c * T + mu_c * (1 + E * G + mu_c * T / g)), speed(EPS), lost),
        same("VI, eq. Vf: cue, line 3", "V_cue/U, b/R = 0.5", 1 - (C + S) * (1 + E) / D, at_zero(speed),
             "should be 1 - (1 + e)/(Q0 D), D = 1 + 1/Q0 + sin^2 phi/nu"),
        same("VI, eq. Vf: cue, line 3", "V_cue/U, head on", 1 - (1 + E) / (1 + 1 / Q0),
             1 - (1 + E) / (Q0 * (1 + 1 / Q0)),
             "breaks momentum: 1/Q0 is lost"),
        same("VI, omega_z, line 1", "r_c omega_z/U", across / (NU_C * EPS), turn),
        same("VI, omega_z, line 2", "r_c omega_z/U", second, turn),
        same("VI, omega_z, line 3", "r_c omega_z/U", printed, at_zero(rotating),
             "the last term tan phi (1 + 1/Q0) should be (1 + 1/Q0)"),
        said("VI, after omega_z", "its size rises with phi; least rise in 1 deg to 45 deg", np.diff(rotation).min() > 0,
             np.diff(rotation).min()),
        same("VI, E_cue-end", "rotational energy/(M U^2)", 2 * half, half, "the factor 1/2 is missing"),
        said("VI, E_cue-end", "it vanishes with epsilon: energy at epsilon/10 over that at epsilon",
             vanishing < 0.12, vanishing),
        Claim("VI, error of a shot", "error of 0.5 deg along a carom table, in balls", 0.5,
              CAROM_TABLE * math.tan(math.radians(0.5)) / (2 * CAROM_BALL), "", "rounding", "'about half a ball'"),
    ]  # fmt: skip


def rows() -> list[Claim]:
    """The claims of sections V and VI."""
    return [*two_part(), *light_end(), *squirt_of_cues(), *summary(), *cue_after()]
