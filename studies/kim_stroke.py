"""Sections I to IV of [Kim]: miscue, equations of motion, the course of the collision, a rigid cue. Part of kim.py."""

from __future__ import annotations

import math

import numpy as np
from scipy.optimize import brentq

from cuefem import squirt
from cuefem.validation import Claim
from studies.kim_walk import (
    EPS,
    LINE,
    MU,
    NU,
    Q0,
    B,
    C,
    E,
    S,
    T,
    Walk,
    inverse_mass,
    quoted,
    rigid_degrees,
    said,
    same,
    two_part_form,
    two_part_walk,
    walk,
)  # fmt: skip


def introduction() -> list[Claim]:
    two = squirt.two_part(B, cue_end_ratio=EPS, **LINE)
    light = squirt.two_part(B, cue_end_ratio=1e-10, **LINE)
    needed = "friction needed at b/R = 0.5 to avoid a miscue, mu = tan phi"
    return [
        same("I, miscue condition", needed + ", light cue end", T, squirt.miscue_friction(light, B, restitution=E)),
        Claim(
            "I, miscue condition", needed + ", epsilon = 2/35", T, float(squirt.miscue_friction(two, B, restitution=E)),
            "", "rounding", "holds as epsilon -> 0; an end mass turns the force to the normal (see miscue.md)",
        ),
        Claim(
            "II, definition of theta", "tan theta = F_N/N", 1.0,
            two_part_walk(EPS).tangential_f / two_part_walk(EPS).p_f,
            "", "slip", "both are the normal force; f/F_N is meant",
        ),
        quoted("II, after eq. rc", "largest phi at mu = 0.7", 35, math.degrees(math.atan(0.7)), 0.5, "deg"),
        quoted("II, after eq. rc", "sin 45 deg", 0.707, math.sin(math.pi / 4), 5e-4),
        quoted("II, after eq. rc", "phi of Coriolis' b = 0.7 R, 'almost the same' as", 45, math.degrees(math.asin(0.7)),
               0.6, "deg"),
    ]  # fmt: skip


def motion() -> list[Claim]:
    """Section II: equations of motion, from vectors."""
    r_c, R_I, F = np.array([S, C, 0]), np.array([0.0, -1, 0]), np.array([0.3, 1.1, 0])
    rng = np.random.default_rng(1)
    V, U = (np.append(rng.standard_normal(2), 0) for _ in range(2))
    spin, turn = np.array([0, 0, 0.7]), np.array([0, 0, -0.4])
    contact = (V + np.cross(spin, R_I)) - (U + np.cross(turn, r_c))
    relative = V - U - np.cross(R_I, spin) + np.cross(r_c, turn)
    cue, nu_c = 3.0, 0.136
    m = cue / (1 + cue)
    accelerate = m * inverse_mass(B, cue, cue * nu_c / (1 + nu_c)) @ F[:2]
    vector = (1 + m / (nu_c * cue) + m / NU) * F - m * (r_c @ F) * r_c / (nu_c * cue) - m * (R_I @ F) * R_I / NU
    k = 1 / (nu_c * (cue + 1))
    beta_t, beta_n, beta_x = 1 + cue / (NU * (cue + 1)) + C**2 * k, 1 + S**2 * k, S * C * k
    exact = m * inverse_mass(B, cue, cue * nu_c / (1 + nu_c))
    rigid_form = squirt.closed_form(B, mass=cue, end_mass=cue * nu_c / (1 + nu_c), ball_mass=1.0, friction=0.6)
    along = float(rigid_form.velocity @ [S, C])
    wide = squirt.rigid(np.sin(np.radians(np.arange(90))), cue_mass_ratio=np.logspace(-2, 2, 41)[:, None])
    widest = float(np.max(squirt.gamma(wide)))
    taper = brentq(lambda q: 1 - squirt.centre_of_mass(tip_radius=q, base_radius=1.0) - 0.7, 0.01, 0.99)
    stick = float(squirt.inertia_factor(tip_radius=taper, base_radius=1.0))
    return [
        same("II, eq. Rot", "torque on the cue, r_c (cos F_t - sin F_n)", C * F[0] - S * F[1], np.cross(r_c, -F)[2]),
        same("II, eq. Rot:ball", "torque on the ball, R F_t", F[0], np.cross(R_I, F)[2]),
        same("II, eq. vrel", "relative velocity, t part", relative[0], contact[0]),
        same("II, eq. vrel", "relative velocity, n part", relative[1], contact[1]),
        same("II, eq. dv:FF", "m dv_t/dt", vector[0], accelerate[0]),
        same("II, eq. dv:FF", "m dv_n/dt", vector[1], accelerate[1]),
        same("II, eq. P:conserv", "momentum along the cue, M_c V_cue + M V", cue * rigid_form.cue_speed + along, cue),
        same("II, eq. dvdv", "m dv_t/dp", beta_t * F[0] - beta_x * F[1], accelerate[0]),
        same("II, eq. dvdv", "m dv_n/dp", beta_n * F[1] - beta_x * F[0], accelerate[1]),
        same("II, eq. beta:r", "beta_x, rigid", beta_x, -exact[0, 1]),
        same("II, eq. beta:r", "beta_par, rigid", beta_t, exact[0, 0]),
        same("II, eq. beta:r", "beta_perp, rigid", beta_n, exact[1, 1]),
        same("II, eq. domega dOmega", "R Omega/U, from I dOmega = R dp_t", two_part_walk(EPS).tangential_f / NU,
             two_part_form().spin),
        said("II, eq. gamma:beta", "gamma <= 1; the largest over phi to 89 deg and Q0 from 0.01 to 100", widest < 1,
             widest),
        quoted("II, after eq. P:conserv", "nu of a uniform ball", 0.4, 3 / 5 * 2 / 3, 5e-3),
        Claim("II, after eq. P:conserv", "nu_c of a cue whose r_c is 0.7 of its length", 0.136, stick, "", "slip",
              "a cone with its centre of mass there (tip/butt diameter "
              f"{taper:.3f}) has this; a uniform rod 1/3; 0.136 is I = M_c L^2/15"),
    ]  # fmt: skip


def process() -> list[Claim]:
    """Section III: the course of the collision, the two-part cue's numbers put into its equations."""
    x = two_part_walk(EPS)
    beta = squirt.two_part(B, cue_end_ratio=EPS, **LINE)
    m, par, perp, cross = beta.reduced_mass, beta.parallel, beta.perpendicular, beta.cross
    g, mu_c = squirt.gamma(beta), squirt.critical_friction(beta)
    v_n0, ratio = -C, MU / mu_c
    matrix = inverse_mass(B, Q0, EPS / 4)
    slip = matrix @ [MU, 1.0]
    p_s = m * S / (cross * (ratio - 1))
    work_s = v_n0 * p_s + (1 - g * ratio) * perp * p_s**2 / (2 * m)
    p_c = m * C / ((1 - g) * perp) * (1 + mu_c * T)
    lost = (ratio - 1) * g / (1 - g) * (p_s / p_c) ** 2
    late = 1 + E * math.sqrt(1 - lost)
    G = (1 + mu_c * T) * math.sqrt(1 - lost)
    s_over_c = (1 - g) * mu_c * T / (g * (ratio - 1) * (1 + mu_c * T))
    jam = [brentq(lambda b: jam_excess(b), *span) for span in ((1e-3, 0.2), (0.4, 0.59))]
    near = two_part_walk(EPS, 0.1, mu=0.6)
    slow = two_part_walk(EPS, mu=0.6)
    edge = float(squirt.compression_stick_friction(B, end_mass_ratio=EPS / 4))
    at_edge = 1 / ((edge / mu_c - 1) / (mu_c * T) + edge / mu_c)
    return [
        same("III, eq. sliding", "m dv_t/dp", (MU * par - cross) / m, slip[0]),
        same("III, eq. sliding", "m dv_n/dp", (perp - MU * cross) / m, slip[1]),
        same("III, eq. ps:v", "p_s/(M U)", p_s, x.p_s),
        same("III, eq. v:v0", "v_n(p_s)/U", v_n0 + (1 - MU * g / mu_c) * perp * p_s / m, x.v_s[1]),
        same("III, eq. ps:v5", "v_n(p_s)/U", v_n0 * (1 - (1 - g * ratio) / (ratio - 1) * mu_c / g * T), x.v_s[1]),
        same("III, eq. p parallel ps", "p_t(p_s)/(M U)", MU * m * S / (cross * (ratio - 1)), x.tangential_s),
        same("III, eq. mu:cond", "friction at which a jam begins, mu_c/gamma", mu_c / g, perp / cross),
        said("III, after eq. mu:cond", "a jam comes 'under specific circumstances'; least b/R of one, mu = 0.7", False,
             jam[0], "with a light cue end the ordinary case"),
        said("III, after eq. mu:cond", "greatest b/R of a jam, mu = 0.7", False, jam[1], "as above"),
        Claim("III, eq. cond:stick", "largest tan phi for slip to end in compression, mu = 0.7",
              (ratio - 1) / (mu_c * (1 / g - ratio)), None, "", "slip",
              "negative in a jam, where slip always ends in compression; b/R = 0.5 jams and sticks"),
        same("III, eq. lower", "bound of gamma where p_s = p_c", at_edge, g),
        same("III, eq. W perp ps", "W(p_s)/(M U^2)", work_s, x.work_s),
        same("III, eq. cond:pp", "dv_n/dp of slip at mu = mu_c/gamma, times M", perp / m * (1 - g * (mu_c / g) / mu_c),
             matrix[1, 1] + matrix[1, 0] * perp / cross),
        same("III, eq. W:p", "W(p_f)/(M U^2), against the energy that ball, cue and friction leave", x.work_f,
             work_left(x, matrix)),
        same("III, eq. stick:eom", "dp_t/dp of stick", mu_c, (x.tangential_f - x.tangential_s) / (x.p_f - x.p_s)),
        same("III, eq. p II:stick", "p_t(p_c)/(M U)", MU * x.p_s + mu_c * (x.p_c - x.p_s),
             x.tangential_s - matrix[0, 1] / matrix[0, 0] * (x.p_c - x.p_s)),
        same("III, eq. mu:cond1", "mu_c", mu_c, -matrix[0, 1] / matrix[0, 0]),
        same("III, eq. dv+", "dv_n/dp of stick, times M", (1 - g) * perp / m, np.linalg.det(matrix) / matrix[0, 0]),
        same("III, eq. pc", "(p_c - p_s)/(M U)", -m * x.v_s[1] / ((1 - g) * perp), x.p_c - x.p_s),
        same("III, eq. pc2", "p_c/(M U)", p_c, x.p_c),
        same("III, eq. v perp 0", "v_n(0)/U",
             (1 - g) * perp * p_c / m * (g * (ratio - 1) / (1 - g) * p_s / p_c - 1), v_n0),
        same("III, eq. Wpc", "(W(p_c) - W(p_s))/(M U^2)", -perp * (1 - g) / (2 * m) * (p_c - p_s) ** 2,
             x.work_c - x.work_s),
        same("III, eq. W pc", "W(p_c)/(M U^2)", -(1 - g) * perp * p_c**2 / (2 * m) * (1 - lost), x.work_c),
        same("III, eq. ps/pc", "p_s/p_c", s_over_c, x.p_s / x.p_c),
        Claim("III, before item 1", "p_s/p_c at mu = 0.6, slip 'disappears almost instantaneously'", 0.0,
              slow.p_s / slow.p_c, "", "slip", f"a third of the compression; {near.p_s / near.p_c:.2g} at b/R = 0.1"),
        said("III, before item 1", "no slip after stick: mu_c/mu, must stay below 1", mu_c < MU, mu_c / MU,
             "a lumped cue; a vibrating shaft: see below"),
        same("III, eq. vf:pf", "v_n(p_f)/U", (1 - g) * perp / m * (x.p_f - x.p_c), x.v_f[1]),
        same("III, eq. W:rest", "(W(p_f) - W(p_c))/(M U^2)", (1 - g) * perp * p_c**2 / (2 * m) * (late - 1) ** 2,
             x.work_f - x.work_c),
        same("III, eq. p II f", "p_t(p_f)/(M U)", mu_c * p_c * ((ratio - 1) * p_s / p_c + late), x.tangential_f),
        same("III, eq. e* 1", "e^2", (x.p_f / x.p_c - 1) ** 2 / (1 - lost), E**2),
        same("III, eq. pf/pc", "p_f/p_c", late, x.p_f / x.p_c),
        same("III, eq. v perp e", "v_n(p_f)/v_n(0)", -E * G, x.v_f[1] / v_n0),
        said("III, after eq. G", "head on G = 1, Newton's law", restitution(0.0, MU) == 1, restitution(0.0, MU)),
    ]  # fmt: skip


def work_left(x: Walk, matrix: np.ndarray) -> float:
    """Work of the normal force on the contact, from the balance of kinetic energy and friction, per M U^2."""
    p = np.array([x.tangential_f, x.p_f])
    initial = Q0 / 2
    # v changes by B p: of kinetic energy, v0 . p + p B p/2 is gained, by the normal force and by friction
    gained = -np.array([S, C]) @ p + p @ matrix @ p / 2
    ball = (p @ p + x.tangential_f**2 / NU) / 2
    cue = Q0 / 2 * (1 - np.array([S, C]) @ p / Q0) ** 2 + (np.array([C, -S]) @ p) ** 2 / (2 * EPS / 4)
    assert math.isclose(ball + cue - initial, gained, rel_tol=1e-9)
    friction = -S / 2 * x.tangential_s  # v_t is linear in p and ends at 0
    return float(ball + cue - initial - friction)


def jam_excess(b: float) -> float:
    return float(squirt.jam_friction(squirt.two_part(b, cue_end_ratio=EPS, **LINE))) - MU


def restitution(b: float, mu: float) -> float:
    return float(squirt.restitution_factor(squirt.two_part(b, cue_end_ratio=EPS, **LINE), b, mu))


def state() -> list[Claim]:
    """Section IV, the state after the impact: a rigid cue, Q0 = 3, mu = 0.6."""
    cue, mu = 3.0, 0.6
    beta = squirt.rigid(B, cue_mass_ratio=cue)
    m, perp = beta.reduced_mass, beta.perpendicular
    g, mu_c = squirt.gamma(beta), squirt.critical_friction(beta)
    x = walk(B, inverse_mass(B, cue, cue * 0.136 / 1.136), mu)
    G = math.sqrt((1 + mu_c * T) ** 2 - (1 / g - 1) / (mu / mu_c - 1) * (mu_c * T) ** 2)
    p_0 = m * C / ((1 - g) * perp)
    bracket, bracket_t = 1 + E * G + mu_c * T, 1 + E * G + mu_c * T / g
    low, high = squirt.restitution_bounds(beta, B)
    printed_high = 1 / (1 - S**2 / ((NU + 1) * (cue + 1)))
    b = np.linspace(0.01, 0.7, 70)
    lows, highs = squirt.restitution_bounds(squirt.rigid(b, cue_mass_ratio=cue), b)
    _, _, psi = rigid_map()
    rise, across = np.diff(psi, axis=1), np.diff(psi, axis=0)
    factors = squirt.restitution_factor(squirt.rigid(b, cue_mass_ratio=cue), b, mu)
    grid = np.linspace(0.9, 1, 11)
    of_gamma = np.sqrt((1 + mu_c * T) ** 2 - (1 / grid - 1) / (mu / mu_c - 1) * (mu_c * T) ** 2)
    theta = math.atan2(x.tangential_f, x.p_f)
    cause = "these are the bounds of a rigid cue with nu_c set to nu"
    return [
        same("IV, eq. pc:ui", "p_c/(M U)", p_0 * (1 + mu_c * T), x.p_c),
        same("IV, eq. pfpc2", "p_f/p_c", 1 + E * G / (1 + mu_c * T), x.p_f / x.p_c),
        same("IV, eq. G:res", "G", G, x.v_f[1] / (E * C)),
        same("IV, after eq. bound1", "lower bound of G", math.sqrt(printed_high), low, cause),
        same("IV, after eq. bound1", "upper bound of G", printed_high, high, cause),
        said("IV, after eq. bound1", "G rises with gamma, all else fixed; least rise from 0.9 to 1 in 0.01",
             np.diff(of_gamma).min() > 0, np.diff(of_gamma).min()),
        said("IV, after eq. bound1", "G > 1 for b/R to 0.7; least G - 1", factors.min() > 1, factors.min() - 1),
        said("IV, after eq. bound1", "bounds of G rise with phi; least rise in 0.01 of b/R, derived bounds",
             min(np.diff(lows).min(), np.diff(highs).min()) > 0, min(np.diff(lows).min(), np.diff(highs).min())),
        same("IV, eq. vf:egv", "v_n(p_f)/U", E * G * C, x.v_f[1]),
        same("IV, eq. pf parl", "p_t(p_f)/(M U)", mu_c * p_0 * bracket_t, x.tangential_f),
        same("IV, V0", "V_n/U", m * C / ((1 - g) * perp) * bracket, x.p_f),
        same("IV, V0", "V_t/U", m * C / ((1 - g) * perp) * mu_c * bracket_t, x.tangential_f),
        same("IV, kinetic energy", "energy of translation/(M U^2)", p_0**2 / 2 * (bracket**2 + (mu_c * bracket_t) ** 2),
             (x.p_f**2 + x.tangential_f**2) / 2),
        same("IV, eq. theta f", "tan theta", mu_c * (1 + (1 / g - 1) * mu_c * T / bracket), x.tangential_f / x.p_f),
        Claim("IV, after fig. squirt2", "squirt of a rigid cue, Q0 = 3, b/R = 0.5", 16,
              math.degrees(math.asin(B) - theta), "deg", "slip",
              f"e = 3/4, mu = 0.6; e = 1 would give {rigid_degrees(B, 3.0, e=1.0):.3g}, Q0 = 5 "
              f"{rigid_degrees(B, 5.0):.3g}: no stated value gives 16"),
        Claim("IV, after fig. squirt2", "'psi = 30 deg' at half the radius", 30, math.degrees(math.asin(B)), "deg",
              "slip",
              "the value is right but it is phi's, not psi's"),
        quoted("IV, after fig. squirt2", "the same in radians", 0.523, math.asin(B), 1e-3, "rad"),
        Claim("IV, after fig. squirt2", "squirt of a rigid cue as Q0 -> 0, b/R = 0.5", 0.0, rigid_degrees(B, 1e-9),
              "deg",
              "slip", "m_e and M_c vanish together, and their ratio stays"),
        said("IV, after fig. squirt2", "squirt rises with phi; least rise in 0.5 deg on the map where slip ends in "
             "compression", np.nanmin(rise) > 0, np.nanmin(rise), unit="deg"),
        said("IV, after fig. squirt2", "squirt rises with Q0; least rise in 0.05 on the map, phi > 0",
             np.nanmin(across[:, 1:]) > 0, np.nanmin(across[:, 1:]), unit="deg"),
        said("IV, fig. squirt2", "the figure runs to 45 deg at mu = 0.6; largest phi of the closed form at Q0 = 0",
             False, last_angle(1e-9), "further out slip outlasts compression", "deg", 45.0),
        said("IV, fig. squirt2", "largest phi of the closed form at Q0 = 3", False, last_angle(3.0), "", "deg", 45.0),
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
    beta = squirt.rigid(b, cue_mass_ratio=cue)
    factor = squirt.restitution_factor(beta, b, 0.6)
    tangent = squirt.squirt_tangent(b, cue_mass_ratio=cue, end_mass_ratio=end, restitution=E, factor=factor)
    holds = squirt.closed_form_holds(b, mass=cue, end_mass=end, ball_mass=1.0, friction=0.6)
    return phi, ratios, np.where(holds, np.degrees(np.arctan(tangent)), np.nan)


def rows() -> list[Claim]:
    """The claims of sections I to IV."""
    return [*introduction(), *motion(), *process(), *state()]
