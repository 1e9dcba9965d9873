"""Verification of the strike from the side: rigid limits, Hertz, energy, reciprocity, and the end mass's limits."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import quad

from cuefem import (
    Cue,
    Joint,
    PointMass,
    Resolution,
    Scene,
    SecondHit,
    SideStrike,
    Striker,
    StructuralDamping,
    Support,
    Tip,
    end_mass,
    modes,
    resolve_side_strike,
    side_motion,
    side_strike,
)
from cuefem.measured.side.side_scene import HERTZ
from tests.helpers.cues import FAMILY, cone, kim, pool, rod, scaled
from tests.helpers.orders import assert_order

BALL = Striker(mass=0.005, restitution=0.8, contact_time=1e-3)
HERTZIAN = Striker(mass=0.005, restitution=0.8, modulus=1e8, radius=0.02)
FEW = Resolution(2, 10, 8)
EFFECTS = (
    PointMass(0.1, 2e-3, 1e-7),
    Support(0.5, 1e4, dashpot=3.0),
    Joint(0.3, rotational_compliance=1e-3),
    StructuralDamping(0.02),
)

# --- rigid limits ---


def stiffened(cue: Cue, periods: float) -> Cue:
    """The cue so stiff that a contact of a millisecond holds so many periods of its lowest mode."""
    factor = (periods / modes(cue, 1).frequencies[0] / 1e-3) ** 2
    return scaled(cue, E=factor, G=factor)


def side_ratio(cue: Cue, striker: Striker, position: float = 0.0) -> float:
    outcome = side_strike(SideStrike(cue, striker, position), Resolution(1, 12, 2))
    return cue.shaft_mass / outcome.effective_mass


@pytest.mark.parametrize("restitution", [1.0, 0.5])
@pytest.mark.parametrize(
    ("cue", "limit"),
    [(rod(3e3), 4.0), (cone(3e3, 0.4), 6.8318457694), (kim(), 5.494268)],
    ids=["rod", "cone 0.4", "kim"],
)
def test_rigid_limits_at_the_end(cue: Cue, limit: float, restitution: float) -> None:
    """A free rigid rod is felt as 1/4 of its mass, a cone of 0.4 as 1/6.83."""
    striker = Striker(0.1 * cue.shaft_mass, restitution, contact_time=1e-3)
    assert abs(side_ratio(stiffened(cue, 3000), striker) / limit - 1) < 1e-6


def test_rigid_limit_anywhere() -> None:
    """m/m_e = 1 + m (x - xbar)^2/I at every place, and SideStrike.rigid_mass is the same number."""
    cue = stiffened(kim(), 3000)
    for x in np.linspace(0, cue.length, 5):
        scene = SideStrike(cue, Striker(0.02, 0.7, contact_time=1e-3), float(x), effects=(PointMass(0.2, 5e-3),))
        found = side_strike(scene, Resolution(1, 12, 2)).effective_mass
        assert abs(found / scene.rigid_mass - 1) < 1e-6


def test_the_rigid_limit_comes_with_the_square_of_the_periods() -> None:
    """A half sine leaves a mode of n periods a velocity of the order 1/n^2: an energy between 0 and 1/n^2."""
    striker = Striker(1e-3, 1.0, contact_time=1e-3)
    for periods in (100, 300, 1000):
        assert abs(side_ratio(stiffened(rod(3e3), periods), striker) / 4 - 1) < 3 / periods**2


# --- Hertz on a rigid body: closed forms ---

# 2.94: twice the integral of 1/sqrt(1 - s^(5/2)) over 0..1, with s = 1 - u^2 so that it is smooth.
HERTZ_TIME = 2 * quad(lambda u: 2 * u / math.sqrt(-math.expm1(2.5 * math.log1p(-(u**2)))), 0, 1, epsabs=1e-14)[0]


@pytest.mark.parametrize("restitution", [1.0, 0.6, 0.2])
def test_hertz_on_a_wall(restitution: float) -> None:
    striker = Striker(0.02, restitution, modulus=1e8, radius=0.01)
    scene = SideStrike(kim(), striker, 0.2, 2.0, (Support(0.2, math.inf, math.inf),))
    outcome = side_strike(scene, Resolution(1, 6, 2))
    depth = (15 * 0.02 * 2.0**2 / (16 * 1e8 * math.sqrt(0.01))) ** 0.4
    half = HERTZ_TIME * depth / 2.0 / 2
    load, unload = outcome.phases
    assert abs(load.end / half - 1) < 1e-9
    assert abs((unload.end - unload.start) / (restitution * half) - 1) < 1e-9
    assert abs(outcome.apparent_restitution - restitution) < 1e-9


@pytest.mark.parametrize("restitution", [1.0, 0.6])
def test_hertz_on_a_rigid_body(restitution: float) -> None:
    """Greatest compression (15 m v^2/(16 E* sqrt(R)))^(2/5), duration 2.94 of it over v times (1 + e)/2, e_A."""
    cue = stiffened(rod(3e3), 30)
    striker = Striker(0.4 * cue.shaft_mass, restitution, modulus=2e7, radius=0.03)
    scene = SideStrike(cue, striker, 0.0, speed=2.0)
    outcome = side_strike(scene, Resolution(1, 12, 1))
    felt = 1 / (1 / striker.mass + 4 / cue.shaft_mass)
    depth = (15 * felt * scene.speed**2 / (16 * 2e7 * math.sqrt(0.03))) ** 0.4
    duration = HERTZ_TIME * depth / scene.speed * (1 + restitution) / 2
    assert abs(outcome.duration / duration - 1) < 2e-5  # what its 30 periods leave of the rod's bending
    ratio = striker.mass / (cue.shaft_mass / 4)
    assert abs(outcome.apparent_restitution - (restitution - ratio) / (1 + ratio)) < 1e-5
    peak = 4 / 3 * 2e7 * math.sqrt(0.03) * depth**HERTZ
    force = outcome.history(np.linspace(0, outcome.duration, 2001))["force_n"]
    assert abs(force.max() / peak - 1) < 1e-4
    assert abs(outcome.phases[0].end / (duration / (1 + restitution)) - 1) < 2e-5


def test_times_against_a_wall() -> None:
    """2.94 d/v for Hertz, pi sqrt(m/k) for a spring, the time given for a time; e splits it 1 : e."""
    ball = Striker(0.028, 1.0, modulus=12e9, radius=9.5e-3)
    depth = (15 * 0.028 * 4.0 / (16 * 12e9 * math.sqrt(9.5e-3))) ** 0.4
    assert abs(ball.wall_time(2.0) / (HERTZ_TIME * depth / 2.0) - 1) < 1e-10
    assert abs(Striker(0.03, 1.0, stiffness=1e5).wall_time(7.0) / (math.pi * math.sqrt(0.03 / 1e5)) - 1) < 1e-14
    assert abs(Striker(0.03, 0.4, contact_time=2e-3).wall_time(3.0) / 2e-3 - 1) < 1e-14
    slow, fast = (Striker(0.03, 0.4, modulus=1e8, radius=0.02).wall_time(v) for v in (1.0, 32.0))
    assert abs(slow / fast - 2) < 1e-12  # goes with v^(-1/5)


# --- energy, momentum ---


@pytest.mark.parametrize("striker", [BALL, HERTZIAN, replace(BALL, restitution=0.0), replace(BALL, mass=0.5)])
@pytest.mark.parametrize("effects", [(), EFFECTS], ids=["bare", "effects"])
@pytest.mark.parametrize("at", [None, FEW], ids=["tail", "plain"])
def test_the_energies_add_up(striker: Striker, effects: tuple, at: Resolution | None) -> None:  # type: ignore[type-arg]
    at = FEW if striker is HERTZIAN else at  # a tail is slow there, and adds nothing to what is tested
    energy = side_strike(SideStrike(kim(), striker, 0.04, 1.7, effects), at).energy
    parts = sum(joules for name, joules in energy.items() if name != "initial")
    assert abs(parts / energy["initial"] - 1) < 1e-10
    assert min(energy.values()) > -1e-12


def test_momentum_and_its_moment_are_kept() -> None:
    """A free beam takes up the striker's momentum, and its moment about the tip."""
    scene = SideStrike(pool(), BALL, 0.1, 2.0)
    outcome = side_strike(scene)
    first, later = side_motion(scene, [2 * outcome.duration, 3 * outcome.duration]).fields.T
    moved = (later - first) / outcome.duration
    system = side_motion(scene, [0.0]).modes.system
    momentum = system.rigid.T @ (system.M @ moved)  # of translation, and of turning about the tip over the length
    wanted = outcome.impulse * np.array([1.0, scene.position / scene.cue.length])
    np.testing.assert_allclose(np.linalg.norm(momentum), np.linalg.norm(wanted), rtol=1e-8)
    np.testing.assert_allclose(momentum, wanted, rtol=1e-7)
    assert abs(outcome.impulse / (BALL.mass * (2.0 + outcome.rebound_speed)) - 1) < 1e-12


# --- reciprocity ---


@pytest.mark.parametrize("effects", [(), EFFECTS], ids=["bare", "effects"])
def test_x_struck_y_moves_is_y_struck_x_moves(effects: tuple) -> None:  # type: ignore[type-arg]
    """Betti: the force of one strike, in convolution with what it meets of the other's motion, whatever the forces."""
    cue, x, y = pool(), 0.02, 0.6
    one, other = SideStrike(cue, BALL, x, 1.0, effects), SideStrike(cue, replace(BALL, mass=0.02), y, 3.0, effects)
    # both places are nodes of one mesh, so that both strikes meet the same modes
    one, other = (replace(s, effects=(*effects, PointMass(x, 0.0), PointMass(y, 0.0))) for s in (one, other))
    at = Resolution((1, 1, 4, 4), 14, 20)
    end = 2 * max(side_strike(one, at).duration, side_strike(other, at).duration)
    works = [_convolved(one, other, end, at), _convolved(other, one, end, at)]
    assert abs(works[0] / works[1] - 1) < 1e-10


def _convolved(struck: SideStrike, moving: SideStrike, end: float, at: Resolution) -> float:
    """Integral of the force at ``struck`` at time t with the motion there of the other strike at ``end`` - t."""
    outcome = side_strike(struck, at)
    pieces = [np.linspace(phase.start, phase.end, 61) for phase in outcome.phases]
    kinks = {end - phase.end for phase in side_strike(moving, at).phases}
    knots = np.unique(np.concatenate([*pieces, [t for t in kinks if 0 < t < outcome.duration]]))
    gauss, weights = np.polynomial.legendre.leggauss(10)
    half = np.diff(knots) / 2
    times = (knots[:-1, None] + half[:, None] * (1 + gauss)).ravel()
    force = outcome.history(times)["force_n"]
    moved = side_motion(moving, np.sort(end - times), at).deflection(struck.position)[0][::-1]
    return float((half[:, None] * weights).ravel() @ (force * moved))


# --- independent solution in time ---


# --- a strike at the tip, and the end mass ---


@pytest.mark.parametrize("name", sorted(FAMILY))
def test_a_light_striker_drives_the_tip_as_the_end_mass_by_force_does(name: str) -> None:
    """The force of a striker of no mass is a half sine; impulse over the tip's speed at its end is that definition."""
    cue, at = FAMILY[name], Resolution(2, 14, 24)
    felt = end_mass(Scene(cue, tip=Tip(contact_time=1e-3)), "force", at)
    errors = []
    for mass in (1e-7, 1e-8):
        outcome = side_strike(SideStrike(cue, Striker(mass, 1.0, contact_time=1e-3)), at)
        errors.append(outcome.impulse / outcome.place_speed / felt - 1)
    assert_order(1, [1e-7, 1e-8], np.abs(errors), within=0.02)
    assert abs(errors[-1]) < 2e-5


@pytest.mark.parametrize("drive", ["velocity", "force"])
def test_on_a_rigid_cue_the_end_mass_is_that_of_the_strike(drive: str) -> None:
    """The other definitions begin with a step of velocity, so that no cue is rigid to them."""
    cue = stiffened(rod(3e3), 1000)
    struck = side_strike(SideStrike(cue, Striker(0.02, 0.75, contact_time=1e-3)), Resolution(1, 12, 2))
    felt = end_mass(Scene(cue, tip=Tip(contact_time=1e-3)), drive, Resolution(1, 12, 2))
    assert abs(struck.effective_mass / felt - 1) < 1e-6


# --- accuracy on request, second hits, laws that agree ---


@pytest.mark.parametrize("position", [0.0, 0.05, 0.35])
def test_the_accuracy_asked_for_is_reached(position: float) -> None:
    scene = SideStrike(kim(), BALL, position)
    best = side_strike(scene, None if position < 0 else Resolution(8, 24, 250)).apparent_restitution
    for rtol in (1e-2, 1e-3, 1e-4):
        found = resolve_side_strike(scene, rtol)
        assert found.error is not None
        assert found.error <= rtol
        assert abs(found.apparent_restitution - best) <= 1.5 * rtol


def test_a_second_hit_is_followed() -> None:
    """A heavy striker is hit again by the end that it drove away."""
    scene = SideStrike(kim(), Striker(0.05, 0.8, contact_time=0.3e-3), 0.0)
    once, twice = side_strike(scene), side_strike(replace(scene, effects=(SecondHit(5e-3),)))
    assert twice.duration > once.duration
    assert twice.rebound_speed > once.rebound_speed
    assert any(phase.grip == "apart" for phase in twice.phases)
    energy = twice.energy
    assert abs(sum(j for name, j in energy.items() if name != "initial") / energy["initial"] - 1) < 1e-10


def test_a_contact_that_outlasts_the_window_is_the_last() -> None:
    """Stepped contacts: no flight goes back in time to the window's end."""
    striker = Striker(0.05, 0.8, modulus=1e9, radius=0.02)
    scene, at = SideStrike(kim(), striker, 0.0), Resolution(1, 8, 4)
    once, followed = side_strike(scene, at), side_strike(replace(scene, effects=(SecondHit(20e-3),)), at)
    flight = next(phase for phase in followed.phases if phase.grip == "apart")
    window = flight.end - once.duration + 1e-6  # ends in the middle of the second touch
    cut = side_strike(replace(scene, effects=(SecondHit(window),)), at)
    assert sum(phase.grip == "apart" for phase in cut.phases) == 1
    assert cut.duration > once.duration + window
    assert cut.rebound_speed > once.rebound_speed
