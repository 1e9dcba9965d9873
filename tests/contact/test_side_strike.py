"""The side strike: rigid limit, closed forms of Hertz and infinite beams, energy (verification)."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.optimize import brentq
from scipy.special import wofz

import cuefem as cf
from cuefem import PointMass, Resolution, SideStrike, Striker, Support, side_strike
from tests.helpers.cues import cone, kim, rod, scaled

BALL = Striker(0.005, 0.8, contact_time=1e-3)
SOFT = Striker(0.005, 0.8, modulus=1e8, radius=0.02)
FEW = Resolution(2, 10, 8)
HAND, DAMPED, JOINT = Support(0.5, 1e4, dashpot=3.0), cf.StructuralDamping(0.02), cf.Joint(0.3, 1e-3)


@pytest.mark.parametrize("restitution", [1.0, 0.5])
@pytest.mark.parametrize(
    ("cue", "limit"),
    [(rod(3e3), 4.0), (cone(3e3, 0.4), 6.8318457694), (kim(), 5.494268)],
    ids=["rod", "cone 0.4", "kim"],
)
def test_side_strike_stiff_beam_has_rigid_effective_mass(cue: cf.Cue, limit: float, restitution: float) -> None:
    """Effective mass of a rigid rod at its end: 1/4 of its mass; of a cone of 0.4: 1/6.83; elsewhere `rigid_mass`."""
    striker, at = Striker(0.1 * cue.shaft_mass, restitution, contact_time=1e-3), Resolution(1, 12, 2, 6400)
    factor = (3000 / cf.modes(cue, 1).frequencies[0] / 1e-3) ** 2  # a contact lasts 3,000 periods of the lowest mode
    scene = SideStrike(scaled(cue, E=factor, G=factor), striker)
    assert cue.shaft_mass / side_strike(scene, at).effective_mass == pytest.approx(limit, rel=1e-6)
    elsewhere = replace(scene, position=cue.length / 3, effects=(PointMass(position=0.2, mass=5e-3),))
    assert side_strike(elsewhere, at).effective_mass == pytest.approx(elsewhere.rigid_mass, rel=1e-6)


@pytest.mark.parametrize("restitution", [1.0, 0.6, 0.2])
def test_side_strike_hertz_on_wall_equals_closed_form(restitution: float) -> None:
    """Duration: 2.94 times the maximum indentation (15 m v²/(16 E* √R))^(2/5) over v, times (1 + e)/2; e_A = e."""
    striker = Striker(0.02, restitution, modulus=1e8, radius=0.01)
    wall = (Support(0.2, math.inf, math.inf),)
    outcome = side_strike(SideStrike(kim(), striker, 0.2, 2.0, wall), Resolution(1, 6, 2, 12_800))
    smooth = lambda u: 2 * u / math.sqrt(-math.expm1(2.5 * math.log1p(-(u**2))))  # noqa: E731
    half = quad(smooth, 0, 1, epsabs=1e-14)[0] * (15 * 0.02 * 4.0 / (16 * 1e8 * math.sqrt(0.01))) ** 0.4 / 2.0
    linear = SideStrike(kim(), Striker(0.02, restitution, contact_time=1e-3), 0.2, 2.0, wall)
    assert side_strike(linear, Resolution(1, 6, 2, 12_800)).duration == pytest.approx(1e-3, rel=1e-4)
    load, unload = outcome.phases
    assert (load.end, unload.end - unload.start) == pytest.approx((half, restitution * half), abs=half / 2000)
    assert outcome.apparent_restitution == pytest.approx(restitution, abs=1e-7)
    assert striker.wall_time(2.0) == pytest.approx((1 + restitution) * half, rel=1e-9)
    assert striker.wall_time(64.0) == pytest.approx((1 + restitution) * half / 2, rel=1e-9)  # goes with v^(-1/5)


def spring_exact(inelasticity: float) -> tuple[float, float]:
    """(e_A, duration in 1/w0) of an elastic spring on an infinite Euler beam, in closed form.

    A force F(t) deflects its position by w(t) = C/Gamma(3/2) times the integral of sqrt(t - s) F(s) over s from 0 to t,
    with C = 1/(2 sqrt(2) EI^(1/4) rhoA^(3/4)), the free end of a semi-infinite beam four times as far. A striker
    of mass m and speed v on a spring k has, in units of 1/w0 = sqrt(m/k) of time, v/w0 of length, m v w0 of force, the
    compression d = t - I^2 F - L I^(3/2) F, L = C m sqrt(w0), the inelasticity parameter of Zener's plate.

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


@pytest.mark.filterwarnings("ignore::cuefem.PlausibilityWarning")
@pytest.mark.parametrize("inelasticity", [0.05, 0.5, 2.0])
@pytest.mark.parametrize(("where", "lengths"), [("middle", 16.0), ("end", 8.0)])
def test_side_strike_long_thin_beam_equals_infinite_beam(where: str, lengths: float, inelasticity: float) -> None:
    """An elastic spring on an infinite Euler beam: e_A by Laplace's transform, one parameter C m √ω0."""
    time, diameter, rho = 1e-3, 1e-2, 700.0
    spread = 250 * diameter  # (EI/rhoA)^(1/4) sqrt(T): thin, and without shear, it is nearly Euler's beam
    E = 16 * rho * (spread**2 / time) ** 2 / diameter**2
    thin = cf.Cue((cf.Segment(lengths * spread, diameter, diameter, cf.Material(E, 1e4 * E, rho, nu=0.0), kappa=1.0),))
    section, unit = thin.section(0.0), time / math.pi
    C = (1 if where == "middle" else 4) / (2 * math.sqrt(2) * float(section.EI) ** 0.25 * float(section.rhoA) ** 0.75)
    mass = inelasticity / C * math.sqrt(unit)
    position = thin.length / 2 if where == "middle" else 0.0
    outcome = side_strike(SideStrike(thin, Striker(mass, 1.0, stiffness=mass / unit**2), position))
    exact, duration = spring_exact(inelasticity)
    assert outcome.apparent_restitution == pytest.approx(exact, abs=1e-5)
    assert outcome.duration / unit == pytest.approx(duration, rel=1e-4)


@pytest.mark.parametrize("striker", [BALL, SOFT, replace(BALL, restitution=0.05), replace(BALL, mass=0.5)])
@pytest.mark.parametrize(
    "effects",
    [(), (PointMass(position=0.1, mass=2e-3, rotary_inertia=1e-7), HAND, JOINT, DAMPED)],
    ids=["bare", "effects"],
)
def test_side_strike_conserves_energy_and_momentum(striker: Striker, effects: tuple[cf.Effect, ...]) -> None:
    scene = SideStrike(kim(), striker, 0.04, 1.7, effects)
    outcome = side_strike(scene, FEW)
    parts = sum(joules for name, joules in outcome.energy.items() if name != "initial")
    assert parts == pytest.approx(outcome.energy["initial"], rel=2e-6)
    assert min(outcome.energy.values()) > -1e-12
    assert outcome.impulse == pytest.approx(striker.mass * (1.7 + outcome.rebound_speed), rel=1e-12)
    ratio = striker.mass / outcome.effective_mass
    assert outcome.apparent_restitution == pytest.approx((striker.restitution - ratio) / (1 + ratio), abs=1e-9)
