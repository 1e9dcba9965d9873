"""The contact of a whole tip of leather: against another solver, in its limits, and how its errors fall."""

from __future__ import annotations

from dataclasses import replace
from math import asin, atan2, inf

import numpy as np
import pytest
from scipy.integrate import quad, solve_ivp

from cuefem import Scene, resolve, strike
from cuefem.beam.tip import TipModes
from cuefem.contact.strike import strike_modes
from tests.helpers.leather_scenes import AT, LEATHER, POOL, leather_scene
from tests.helpers.orders import falls_with_the_step
from tests.helpers.strike_scenes import a_few_modes
from tests.oracle.ring_stepper import LEATHER as RELEASED
from tests.oracle.ring_stepper import struck_scene

D = 0.01275


# Against other solvers


def by_other_solver(scene: Scene, tip: TipModes) -> tuple[float, float, float]:
    """(squirt, ball's spin in m/s of its surface, duration) of a tip that never slips; equations written out anew.

    Vectors are (u, w). States: q and q' of the modes, the ball's velocity, its surface's by spin, compression, angle of
    the contact, F_t.
    """
    law, leather_tip = scene.tip_law(scene.tip.restitution, scene.stroke.offset), scene.effects[0]
    n, M, nu, R, r = len(tip.omega), POOL.mass, POOL.inertia, POOL.radius, leather_tip.dome_radius
    phi_0 = asin(scene.stroke.offset)

    def rate(z: np.ndarray, deepest: float | None) -> np.ndarray:
        q, v, ball, spin, d, a, F_t = z[:n], z[n : 2 * n], z[2 * n : 2 * n + 2], *z[2 * n + 2 :]
        phi = phi_0 + a
        t, normal = np.array([np.sin(phi), np.cos(phi)]), np.array([np.cos(phi), -np.sin(phi)])
        moves = tip.amplitude + np.outer(tip.rotation, leather_tip.lever(phi, D))
        centre = tip.amplitude + np.outer(tip.rotation, (0.0, r - leather_tip.height))
        gap = ball - v @ moves
        F_n = float(law.at(np.array([law.virtual(d, deepest)]))[0][0])
        force = F_n * normal + F_t * t
        v_t = gap @ t + spin
        wound = -v_t * leather_tip.shear
        turning = (v @ centre - ball) @ t / (R + r) if leather_tip.rolls else 0.0
        return np.concatenate(
            [v, -(tip.omega**2) * q - moves @ force, force / M, [F_t / (nu * M), -gap @ normal, turning, wound]]
        )

    def follow(z, start, deepest, end):
        end.terminal, end.direction = True, -1
        told = solve_ivp(
            lambda _, z: rate(z, deepest), (start, 0.02), z, "DOP853", events=end, rtol=1e-11, atol=1e-13, max_step=2e-5
        )
        return told.y[:, -1], float(told.t[-1])

    z = np.zeros(2 * n + 6)
    z[n : 2 * n] = scene.stroke.speed * tip.approach
    z, time = follow(z, 0.0, None, lambda _, z: rate(z, None)[2 * n + 3] + (1.0 if z[2 * n + 3] == 0 else 0.0))
    deepest = float(z[2 * n + 3])
    z, time = follow(z, time, deepest, lambda _, z: (z[2 * n + 3] - law.rest(deepest)) / deepest)
    ball = z[2 * n : 2 * n + 2]
    return atan2(-ball[1], ball[0]), float(z[2 * n + 2]), time


@pytest.mark.parametrize(("e", "offset", "rolls"), [(0.73, 0.3, True), (1.0, 0.45, True), (0.4, 0.2, False)])
def test_another_solver_gives_the_same(e: float, offset: float, rolls: bool) -> None:
    scene = leather_scene(offset, e=e, friction=inf, leather=replace(LEATHER, rolls=rolls, shear=8e5))
    squirt, surface, duration = by_other_solver(scene, a_few_modes())

    def error(steps: int) -> float:
        found = strike_modes(scene, a_few_modes(), steps=steps)
        pairs = ((found.squirt, squirt), (found.spin * POOL.radius, surface), (found.duration, duration))
        return max(abs(value / exact - 1) for value, exact in pairs)

    falls_with_the_step(error, most=2e-4)


@pytest.mark.parametrize("speed", [1.0, 2.0, 5.0])
def test_head_on_the_contact_time_is_that_of_the_law_by_quadrature(speed: float) -> None:
    scene = leather_scene(0.0, speed=speed)
    falls_with_the_step(lambda steps: abs(strike(scene, replace(AT, steps=steps)).duration / scene.contact_time - 1))
    law, mass = scene.tip_law(), scene.head_on_mass
    deepest, loading = law.blow(mass, speed)
    assert law.work(deepest) == pytest.approx(mass * speed**2 / 2, rel=1e-12)
    told = quad(  # depth = deepest (1 - s^2), so that the integrand stays finite
        lambda s: 2 * deepest * s / np.sqrt(2 * (law.work(deepest) - law.work(deepest * (1 - s**2))) / mass),
        1e-9,
        1,
        epsabs=0,
        epsrel=1e-9,
        limit=200,
    )[0]
    assert loading == pytest.approx(told, rel=1e-7)
    each = leather_scene(0.0).tip_law().blow(mass, np.array([speed, 2 * speed]))[1]
    assert each[0] == pytest.approx(loading, rel=1e-12)


# How errors fall


def test_resolve_bounds_its_error() -> None:
    scene = leather_scene()
    best, rough = resolve(scene, 1e-5), resolve(scene, 3e-2)
    assert rough.unknowns < best.unknowns
    for name in ("squirt", "ball_speed", "spin"):
        assert abs(getattr(rough, name) / getattr(best, name) - 1) < rough.error <= 3e-2


# Limits


# What is lost along the surface, and its rings


@pytest.mark.parametrize("offset", [0.2, 0.375, 0.45])
def test_what_a_patch_loses_is_friction_unless_that_is_endless(offset: float) -> None:
    rubs, grips = (strike(leather_scene(offset, friction=mu), AT).energy for mu in (0.7, inf))
    assert rubs["friction loss"] > 1e-4 * rubs["initial"]
    assert abs(rubs["tip shear"]) < 1e-12 * rubs["initial"]
    assert abs(grips["friction loss"]) < 1e-12 * grips["initial"]
    assert 1e-4 < grips["tip shear"] / grips["initial"] < 0.03
    constant = strike(leather_scene(offset, e=1.0, leather=replace(LEATHER, shear=4e5)), AT).energy
    assert abs(constant["tip shear"]) < 1e-7 * constant["initial"]


def test_leather_that_keeps_a_little_of_its_work_along_the_surface() -> None:
    """On the maple shaft 0.95 and 0.9 are 5 and 10 % more squirt; next to no loss is next to nothing."""
    maple = {e: replace(RELEASED, surface_restitution=e) for e in (1, 1 - 1e-7, 0.95, 0.9)}
    told = {e: strike(struck_scene(leather=leather)) for e, leather in maple.items()}
    more = {e: each.squirt / told[1].squirt - 1 for e, each in told.items()}
    assert abs(more[1 - 1e-7]) < 1e-6
    assert more[0.95] == pytest.approx(0.049, abs=0.004)
    assert more[0.9] == pytest.approx(0.098, abs=0.008)
    assert [each.energy["tip shear"] for each in told.values()] == sorted(e.energy["tip shear"] for e in told.values())
