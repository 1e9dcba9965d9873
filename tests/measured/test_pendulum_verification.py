"""The pendulum test: exact on free masses, its error by hand, its errors cover on made-up shafts, and what it plans."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

import cuefem as cf
from cuefem.measured.kinds import EndMass, Setup
from cuefem.measured.outliers import HOLDS_95, middle_of
from cuefem.measured.pendulum import (
    GRAVITY,
    Bounces,
    PendulumTest,
    choices,
    pressed_time,
    softness,
    squirt_told,
)
from cuefem.measured.unknowns import unknowns_of
from tests.helpers.documented import SCENE, SHAFT
from tests.helpers.leather_scenes import leather_scene

COARSE = cf.Resolution(elements=1, order=8, modes=6)


def readings(way: str, speed: float, thread: float = 1.0) -> float:
    """The reading of a speed, m/s, exactly."""
    swing = math.copysign(thread * math.sin(2 * math.asin(abs(speed) / (2 * math.sqrt(GRAVITY * thread)))), speed)
    return {
        "swing": swing,
        "height": math.copysign(speed**2 / (2 * GRAVITY), speed),
        "speed": speed,
        "frames": 10 / speed if speed else 0.0,
    }[way]


@pytest.mark.parametrize("way", ["swing", "height", "speed", "frames"])
@pytest.mark.parametrize("m", [3e-3, 7e-3, 20e-3])
def test_a_free_mass_is_weighed_exactly(way: str, m: float) -> None:
    """Momentum and restitution: a ball of mass m at a free mass M."""
    M, e, U = 7.3e-3, 0.8, 0.6
    back = U * (e * M - m) / (m + M)
    free, wall = (Bounces(way, (readings(way, U),), (readings(way, v),), error=1e-3, thread=1.0) for v in (back, e * U))
    found = PendulumTest(m, 0.0, free, 1e-3, wall=wall).weighed()
    assert found.end_mass == pytest.approx(M, rel=1e-12)
    assert found.restitution == pytest.approx(e, rel=1e-12)
    if way != "frames":
        assert free.impact_speed == pytest.approx(U, rel=1e-12)


def test_a_shaft_is_weighed_as_its_strike_says() -> None:
    """The end mass of the formula is that of the side strike with the ball's own e and contact time."""
    for scene in (SCENE, leather_scene()):
        one = EndMass(value=1.0, error=1.0, ball_mass=8e-3, restitution=0.8, contact_time=1e-3, position=0.02)
        height = scene.leather.height if scene.at_tip else 0.0
        effects = scene.leather.left_on(scene.shaft) if scene.at_tip else ()
        ball = cf.Striker(8e-3, 0.8, contact_time=1e-3)
        struck = cf.side_strike(cf.SideStrike(scene.shaft, ball, 0.02 - height, effects=effects))
        assert one.computed(Setup(scene)) == pytest.approx(struck.effective_mass, rel=1e-12)
        free = Bounces("speed", (1.0,), (struck.apparent_restitution,), error=0.01)
        found = PendulumTest(8e-3, 0.0, free, 1e-3, restitution=0.8).weighed()
        assert found.end_mass == pytest.approx(struck.effective_mass, rel=1e-12)


def test_the_budget_is_the_derivative() -> None:
    """Each reading moved by its error moves the end mass by its part of the budget."""
    free = Bounces("speed", (1.0,), (-0.15,), error=1e-5)
    wall = Bounces("speed", (1.0,), (0.8,), error=1e-5)
    test = PendulumTest(8e-3, 1e-8, free, 1e-3, wall=wall)
    found = test.weighed()
    moved = {
        "mass of the ball": replace(test, ball_mass=8e-3 + 1e-8),
        "free shaft, before": replace(test, free=replace(free, before=(1 + 1e-5,))),
        "free shaft, after": replace(test, free=replace(free, after=(-0.15 + 1e-5,))),
        "held shaft, before": replace(test, wall=replace(wall, before=(1 + 1e-5,))),
        "held shaft, after": replace(test, wall=replace(wall, after=(0.8 + 1e-5,))),
    }
    assert set(found.budget) == set(moved)
    for name, other in moved.items():
        change = abs(math.log(other.weighed().end_mass / found.end_mass))
        assert found.budget[name] == pytest.approx(change, rel=1e-3)


def test_repeated_bounces_average_out_but_for_one_release() -> None:
    """To a twentieth, which the chance of a wrong reading adds."""
    one = Bounces("speed", (1.0,), (0.5,), error=0.01)
    four = replace(one, after=(0.5,) * 4)
    apart = replace(one, before=(1.0,) * 4, after=(0.5,) * 4)
    (_, before, after), (_, same, quarter), (_, fewer, _) = (each.ratio for each in (one, four, apart))
    assert (same, quarter) == (pytest.approx(before), pytest.approx(after / 2, rel=0.05))
    assert fewer == pytest.approx(before / 2)
    wild = replace(one, after=(0.4, 0.5, 0.6))
    assert wild.ratio[2] > 0.1 / math.sqrt(3)


def test_a_wrong_bounce_hardly_counts_and_the_course_has_no_jump() -> None:
    """A fourth bounce moves from the others' place to a hundred errors away: the result goes along and comes back."""
    places = 0.5 + 0.01 * np.linspace(0, 100, 2001)
    bounces = [Bounces("speed", (1.0,), (0.49, 0.50, 0.51, float(v)), error=0.01) for v in places]
    found = np.array([each.ratio for each in bounces])[:, [0, 2]]
    assert np.abs(np.diff(found, axis=0)).max() < 2e-3
    assert found[-1, 0] == pytest.approx(0.5, abs=5e-4)
    assert found[-1, 1] == pytest.approx(0.01 / math.sqrt(3), rel=0.1)
    assert 0.503 < found[:, 0].max() < 0.51
    assert found[:, 1].max() > 1.3 * found[0, 1]


def test_the_order_and_the_scale_of_readings_do_not_matter() -> None:
    generator = np.random.default_rng(4)
    for count in (2, 3, 7, 40):
        values, errors = generator.normal(size=count), generator.uniform(0.1, 1.0, count)
        middle, error = middle_of(values, errors)
        turned = middle_of(-3 * values[::-1], 3 * errors[::-1])
        assert turned == pytest.approx((-3 * middle, 3 * error), rel=1e-9)


def made_up(generator: np.random.Generator) -> tuple[float, float, float, float]:
    """A made-up shaft and ball: e_A, e, ball mass, true end mass; wood, bore and taper as priors have them."""
    z = generator.normal(size=4)
    bore, growth = 6e-3 * math.exp(0.11 * z[0]), 8.8e-3 * math.exp(0.1 * z[1])
    wood = cf.Material(E=13.86e9 * math.exp(0.22 * z[2]), G=1.2e9, rho=705 * math.exp(0.107 * z[3]))
    cue = cf.Cue(
        (
            cf.Segment(0.13, 0.012, 0.0122, wood, bore, bore),
            cf.Segment(0.6, 0.0122, 0.0122 + growth, wood),
        )
    )
    m, e, time = (float(generator.uniform(*ends)) for ends in ((4e-3, 14e-3), (0.6, 0.9), (0.5e-3, 2e-3)))
    ball = cf.Striker(m, e, contact_time=time)
    struck = cf.side_strike(cf.SideStrike(cue, ball, position=0.01), COARSE)
    return struck.apparent_restitution, e, m, struck.effective_mass


Shaft = tuple[float, float, float, float]


@pytest.fixture(scope="module")
def shafts() -> list[Shaft]:
    """A hundred made-up shafts."""
    generator = np.random.default_rng(16)
    return [made_up(generator) for _ in range(100)]


def covered(shafts: list[Shaft], way: str, seed: int, *, times: int = 4, wrong: bool = False) -> np.ndarray:
    """Whether the 68 and the 95 % interval hold the end mass of each shaft, from readings with noise: (shafts, 2).

    wrong: one reading of each shaft is off by 4 to 30 errors.
    """
    generator = np.random.default_rng(seed)
    U, error = 0.63, {"swing": 1.5e-3, "height": 0.4e-3, "speed": 6e-3, "frames": 0.15}[way]
    found = []
    for a, e, m, true in shafts:
        right = np.repeat([readings(way, speed) for speed in (U, a * U, U, e * U)], times)
        off = generator.normal(size=len(right))
        if wrong:
            off[generator.integers(len(off))] += generator.choice([-1, 1]) * generator.uniform(4, 30)
        noisy = (right + error * off).reshape(4, times).tolist()
        free, wall = (Bounces(way, tuple(b), tuple(c), error=error, thread=1.0) for b, c in (noisy[:2], noisy[2:]))
        weighed = m + 5e-5 * generator.normal()
        result = PendulumTest(weighed, 5e-5, free, 1e-3, wall=wall).weighed()
        found.append([low < true < high for low, high in (result.interval(), result.interval(HOLDS_95))])
    return np.array(found)


@pytest.mark.parametrize("way", ["swing", "speed", "frames"])
def test_intervals_cover_in_a_thousand_tests(shafts: list[Shaft], way: str) -> None:
    """The same with ten draws of the noise for each shaft: 4.4 % and 2.1 % are three standard deviations."""
    some = [shaft for shaft in shafts if way != "frames" or abs(shaft[0]) > 0.1]  # a ball that stops has no count
    narrow, wide = np.mean([covered(some, way, seed).mean(axis=0) for seed in range(2, 12)], axis=0)
    assert narrow == pytest.approx(0.683, abs=0.044)
    assert wide == pytest.approx(0.95, abs=0.021)


@pytest.mark.heavy
@pytest.mark.parametrize(
    ("times", "wrong"),
    [(2, False), (2, True), (3, False), (3, True), (4, True)]
    + [pytest.param(8, wrong, marks=pytest.mark.heavy) for wrong in (False, True)],
)
def test_intervals_cover_with_one_wrong_reading(shafts: list[Shaft], times: int, wrong: bool) -> None:
    """Ten times on each shaft; of two bounces nobody can tell which is wrong: the interval holds both."""
    draws = [covered(shafts, "swing", seed, times=times, wrong=wrong) for seed in range(27, 37)]
    narrow, wide = np.mean(draws, axis=(0, 1))
    assert (0.58 if times == 2 else 0.639) < narrow < 0.683 + 0.06
    assert 0.95 - 0.021 < wide < 0.985


def test_the_plan_is_the_optimum() -> None:
    """A ball as heavy as the end mass has the smallest error of the free bounce, 4/(1 + e) that of the ratio."""
    found = choices(7e-3, 0.8, 0.01)
    assert [one.ball_mass for one in found] == pytest.approx([1.75e-3, 3.5e-3, 7e-3, 14e-3, 28e-3])
    assert min(found, key=lambda one: one.error).ball_mass == pytest.approx(7e-3)
    free = Bounces("speed", (1.0,), (found[2].bounce,), error=1e-9)
    per_ratio = PendulumTest(7e-3, 0.0, free, 1e-3, restitution=0.8).weighed().budget["free shaft, after"] / 1e-9
    assert per_ratio == pytest.approx(4 / 1.8)


def test_a_ball_pressed_as_planned_lasts_as_planned() -> None:
    for one in softness(8e-3, 0.6, 0.8):
        assert pressed_time(one.force, 0.5e-3, 8e-3, 0.6, 0.8) == pytest.approx(one.contact_time, rel=1e-12)
    assert [one.contact_time for one in softness(8e-3, 0.6)] == [0.5e-3, 1e-3, 2e-3]


def test_an_end_mass_moves_the_squirt_its_way() -> None:
    """More end mass than the drawing's is more squirt, within what is open; its own end mass moves nothing."""
    one = EndMass(value=1.0, error=1.0, ball_mass=8e-3, restitution=0.8, contact_time=1e-3, position=0.01)
    drawn = one.computed(Setup(SCENE))
    told = {}
    for factor in (1.0, 1.1):
        M, m, e = factor * drawn, 8e-3, 0.8
        free = Bounces("speed", (1.0,), ((e * M - m) / (m + M),), error=0.003)
        test = PendulumTest(m, 0.0, free, 1e-3, restitution=e, restitution_error=0.003)
        told[factor] = squirt_told(test, test.weighed(), SCENE, 0.01)
    assert told[1.0].after[0] == pytest.approx(told[1.0].before[0], rel=1e-3)
    assert told[1.0].after[0] < told[1.1].after[0]
    assert told[1.0].after[1] < told[1.0].before[1]
    assert told[1.0].before[0] == pytest.approx(cf.strike(SCENE).squirt, rel=1e-9)
    assert told[1.0].drawn == pytest.approx(drawn)


@pytest.mark.heavy
def test_squirt_intervals_cover_on_made_up_shafts() -> None:
    """Thirty shafts drawn from the priors, weighed with noise: their own squirt lies within the stated errors.

    Ten draws of the model's error for each shaft; three standard errors of the mean over the shafts are allowed.
    """
    generator, found = np.random.default_rng(3), []
    scene = replace(SCENE, cue=SHAFT)
    unknowns = unknowns_of(scene, ())
    for _ in range(30):
        setup = Setup(scene)
        for unknown in unknowns:
            setup = unknown.setup(setup, float(generator.normal()))
        one = EndMass(value=1.0, error=1.0, ball_mass=8e-3, restitution=0.8, contact_time=1e-3, position=0.01)
        M = one.computed(setup)
        a = (0.8 * M - 8e-3) / (8e-3 + M)
        free = Bounces("speed", (1.0,), (a + 0.01 * float(generator.normal()),), error=0.01)
        test = PendulumTest(8e-3, 0.0, free, 1e-3, restitution=0.8)
        told = squirt_told(test, test.weighed(), scene, 0.01)
        true = float(cf.strike(setup.scene).squirt) * np.exp(0.1 * generator.normal(size=10))
        pulls = np.abs(true - told.after[0]) / told.after[1]
        found.append([np.mean(pulls < 1), np.mean(pulls < HOLDS_95)])
    spread = np.std(found, axis=0, ddof=1) / math.sqrt(len(found))
    assert np.all(spread < (0.04, 0.02))
    assert np.all(np.abs(np.mean(found, axis=0) - (0.683, 0.95)) < 3 * spread)
