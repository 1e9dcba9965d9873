"""Leather tips: contact time, partial slip against small steps, continuity, squirt of an exact chain (verification).

Small steps (`tests.oracle.partial_slip`) have no phases; scenes include gross slip, contact on the rim, and slow and
fast strokes. Tangential losses, energies and a constant stiffness: test_stored_answers.py.
"""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import quad

import cuefem as cf
from cuefem import strike
from tests.helpers.orders import assert_error_falls_with_the_step
from tests.helpers.strike_scenes import maple
from tests.oracle.partial_slip import LEATHER, maple_scene, small_step_squirt

WITHIN = 5e-3
FEW_MODES = cf.Scene(cf.Cue((cf.Segment(0.7, 0.012, 0.021, maple()),), body_mass=0.43))
# A jump: squirt changes from one offset to the next by more than this factor times the change at either neighbour plus
# 1e-4 of itself; a curve whose slope changes by a smaller factor within 1e-3 of b/R has none.
BEND = 1.5


@pytest.mark.parametrize(("speed", "chain"), [(0.8, 2.30), (2.0, 2.32), (4.0, 2.33), (7.0, 2.31)])
def test_leather_strike_on_maple_equals_exact_chain(speed: float, chain: float) -> None:
    """The full model against a geometrically exact chain."""
    outcome = strike(maple_scene(0.375, speed, effects=(cf.AxialWaves(), cf.GeometricStiffness())))
    assert np.degrees(outcome.squirt) == pytest.approx(chain, rel=0.02)


@pytest.mark.parametrize("speed", [1.0, 2.0, 5.0])
def test_leather_central_impact_contact_time_equals_quadrature(speed: float) -> None:
    scene, at = maple_scene(0.0, speed), cf.Resolution(2, 10, 10)
    assert_error_falls_with_the_step(
        lambda steps: abs(strike(scene, replace(at, steps=steps)).duration / scene.contact_time - 1)
    )
    law, mass = scene.tip_law(), scene.reduced_mass
    deepest, loading = law.central_impact(mass, speed)
    assert law.work(deepest) == pytest.approx(mass * speed**2 / 2, rel=1e-12)

    def slowness(s: float) -> float:  # depth = deepest (1 - s^2): a finite integrand
        return 2 * deepest * s / np.sqrt(2 * (law.work(deepest) - law.work(deepest * (1 - s**2))) / mass)

    assert loading == pytest.approx(quad(slowness, 1e-9, 1, epsabs=0, epsrel=1e-9, limit=200)[0], rel=1e-7)


def random_scene(seed: int) -> cf.Scene:
    """Friction 0.2 to 0.7, b/R 0.1 to 0.7, 0.8 to 7 m/s, restitution 0.5 to 0.9, soft to hard leather."""
    rng = np.random.default_rng([21, seed])
    tip = cf.Tip(float(rng.uniform(0.5, 0.9)), float(rng.uniform(0.2, 0.7)))
    speed, E = float(np.exp(rng.uniform(math.log(0.8), math.log(7.0)))), float(rng.uniform(100e6, 400e6))
    return maple_scene(float(rng.uniform(0.1, 0.7)), speed, replace(LEATHER, E=E), tip=tip)


def squirt_error(scene: cf.Scene, step: float = 1e-6) -> float:
    """Relative difference of squirt."""
    return small_step_squirt(scene, step) / math.degrees(strike(scene).squirt) - 1


@pytest.mark.parametrize(
    ("offset", "friction", "restitution"),
    [(0.38, 0.3, 1.0), (0.5, 0.4, 1.0), (0.6, 0.5, 1.0), (0.375, 0.7, 0.95), (0.5, 0.7, 0.5)],
)
def test_leather_slip_and_losses_agree_with_small_steps(offset: float, friction: float, restitution: float) -> None:
    leather = replace(LEATHER, surface_restitution=restitution)
    assert abs(squirt_error(maple_scene(offset, leather=leather, tip=cf.Tip(0.73, friction)), 2e-6)) < WITHIN


@pytest.mark.parametrize(
    ("restitution", "offset", "speed", "steps", "within"),
    [(0.947, 0.436, 0.587, 100, 2e-4), (0.971, 0.3545, 3.011, 30, 2e-2), (0.769, 0.2974, 0.93, 30, 1e-3)],
)
@pytest.mark.kernel
def test_sticking_leather_that_hardly_touches_has_forces(
    restitution: float, offset: float, speed: float, steps: int, within: float
) -> None:
    """Before separation the indentation vanishes in mid-step, and with it the stiffness of an annulus."""
    leather = replace(LEATHER, height=4e-3, dome_radius=math.inf, E=230e6)
    scene = replace(FEW_MODES, tip=cf.Tip(restitution, math.inf), stroke=cf.Stroke(speed, offset), effects=(leather,))
    coarse, fine = (strike(scene, cf.Resolution(1, 8, 12, steps=count)).squirt for count in (steps, 1600))
    assert coarse == pytest.approx(fine, rel=within)


@pytest.mark.nightly
def test_leather_strike_random_scenes_agree_with_small_steps() -> None:
    errors = np.array([squirt_error(random_scene(seed)) for seed in range(100)])
    wrong = np.flatnonzero(np.abs(errors) >= WITHIN).tolist()
    print("worst", np.abs(errors).max(), "median", np.median(np.abs(errors)), "wrong", len(wrong))
    assert not wrong, {seed: float(errors[seed]) for seed in wrong}


@pytest.mark.parametrize(("leather", "friction", "offset"), [(LEATHER, 0.3, 0.3746), (LEATHER, 0.7, 0.671)])
def test_squirt_at_gross_slip_and_rim_is_continuous(leather: cf.LeatherTip, friction: float, offset: float) -> None:
    """At the transition to gross slip, and where the contact reaches the rim of the dome."""
    offsets = offset + np.arange(-5, 6) * 1e-3
    scenes = (maple_scene(float(b), 2.0, leather, tip=cf.Tip(0.73, friction)) for b in offsets)
    squirts = np.array([strike(scene).squirt for scene in scenes])
    change = np.abs(np.diff(squirts))
    beside = np.maximum(np.r_[change[1:], 0.0], np.r_[0.0, change[:-1]])
    assert np.all(change < BEND * beside + 1e-4 * np.abs(squirts[:-1]))
