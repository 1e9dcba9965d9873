"""The coupled strike against the impulse solver where the cue is lumped, and [Kim]'s shaft against its known values."""

from collections import Counter
from dataclasses import replace
from math import inf
from pathlib import Path

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from cuefem import Ball, LumpedCue, Outcome, PowerLawTip, Scene, Stroke, Tip, impulse, load, strike
from cuefem.beam.modes import modes
from cuefem.beam.tail import tail
from cuefem.contact.impulse_space import inverse_mass
from cuefem.contact.strike import strike_modes
from cuefem.tip_modes import default_resolution, tip_modes_from
from tests.helpers.strike_scenes import (
    hollow_cue,
    kim_scene,
    lumped_scenes,
    near_miscue_scenes,
    pool_cue,
    sound,
    uniform_rod,
)

MESHES = sorted((Path(__file__).parents[2] / "meshes").glob("*.toml"))


def event_impulses(outcome: Outcome) -> dict[str, float]:
    """The normal impulse given until the events of the impulse solver, from the phases of the coupled strike."""
    given_by = np.cumsum([0.0, *(phase.impulse[1] for phase in outcome.phases)])
    slipping = next((i for i, phase in enumerate(outcome.phases) if phase.grip != "slip"), None)
    loaded = next((i for i, phase in enumerate(outcome.phases) if phase.press != "load"), len(outcome.phases))
    return {
        "slip ends": inf if slipping is None else given_by[slipping],
        "greatest compression": given_by[loaded],
        "separation": given_by[-1],
    }


def agree(scene: Scene) -> Outcome:
    """Coupled strike and impulse solver, which knows of no law along the normal, say the same."""
    coupled, lumped = strike(scene), impulse(replace(scene, effects=()))
    sound(coupled)
    U, speed = scene.stroke.speed, lumped.ball_speed
    assert abs(coupled.squirt - lumped.squirt) < 1e-9
    assert abs(coupled.ball_speed - speed) < 1e-9 * speed
    assert np.abs(coupled.ball_velocity - lumped.ball_velocity).max() < 1e-9 * speed
    assert abs(coupled.spin - lumped.spin) < 1e-9 * max(abs(lumped.spin), speed / scene.ball.radius)
    assert abs(coupled.cue_speed - lumped.cue_speed) < 1e-9 * U
    for name, joules in lumped.energy.items():
        assert abs(coupled.energy[name] - joules) < 1e-9 * lumped.energy["initial"], name
    assert coupled.energy["cue vibration"] == 0
    events = event_impulses(coupled)
    for event in lumped.phases:
        if event.impulse <= lumped.impulse[1] * (1 - 1e-9):
            assert abs(events[event.name] - event.impulse) < 1e-9 * lumped.impulse[1], event.name
    return coupled


def test_a_lumped_cue_gives_the_impulse_solver_s_answer_in_every_regime():
    seen: Counter[str] = Counter()

    @settings(max_examples=60, deadline=None)
    @given(st.one_of(lumped_scenes(), near_miscue_scenes()))
    @example(Scene(LumpedCue(0.54, 0.003), Ball(), Tip(0.75, 0.7), Stroke(offset=0.3)))  # jam
    @example(Scene(LumpedCue(0.54, 0.003), Ball(), Tip(0.75, 0.3), Stroke(offset=0.5)))  # miscue
    @example(Scene(LumpedCue(0.05, 1.0), Ball(), Tip(0.9, 0.2), Stroke(offset=0.3)))  # slip reversal
    @example(Scene(LumpedCue(0.54, 0.3), Ball(), Tip(1.0, 0.35), Stroke(offset=0.5)))  # late stick
    def everywhere(scene: Scene) -> None:
        coupled = agree(scene)
        seen.update([coupled.regime, "jam"] if coupled.jam else [coupled.regime])
        B = inverse_mass(scene.cue, scene.ball, abs(scene.stroke.offset))
        just_sticks = abs(scene.tip.friction - abs(B.tn / B.tt)) < 1e-12  # a tie, which rounding names
        assert just_sticks or coupled.regime == impulse(scene).regime

    everywhere()
    rng = np.random.default_rng(5)  # heavy cue ends and little friction: the rarer regimes, whatever hypothesis draws
    for mass, end_mass, e, mu, offset in zip(
        10 ** rng.uniform(-1.5, 0, 80),
        10 ** rng.uniform(-1.5, 0.3, 80),
        rng.uniform(0.3, 1, 80),
        rng.uniform(0.05, 0.6, 80),
        rng.uniform(0.1, 0.8, 80),
        strict=True,
    ):
        outcome = agree(Scene(LumpedCue(mass, end_mass), tip=Tip(e, mu), stroke=Stroke(offset=offset)))
        seen.update([outcome.regime])
    for end_mass in (0.002, 0.003, 0.004, 0.005, 0.006):
        outcome = agree(Scene(LumpedCue(0.54, end_mass), Ball(), Tip(0.75, 0.7), Stroke(offset=0.3)))
        seen.update(["jam"] if outcome.jam else [])
    for regime in ("stick", "late stick", "miscue", "slip reversal", "jam"):
        assert seen[regime] >= 3, (regime, seen)


@pytest.mark.parametrize("exponent", [1.5, 2.5])
@pytest.mark.parametrize(
    ("offset", "e", "friction", "end_mass"),
    [
        (0.3, 0.75, 0.7, 0.006),
        (0.5, 0.75, 0.2, 0.006),
        (0.6, 0.4, 0.6, 0.03),
        (0.4, 0.0, 0.7, 0.01),
        (0.3, 0.9, inf, 0.02),
        (-0.45, 1.0, 0.35, 1.5),
    ],
)
def test_a_lumped_cue_feels_the_restitution_not_the_power_law(exponent, offset, e, friction, end_mass):
    tip, law = Tip(e, friction, contact_time=1e-3), PowerLawTip(exponent)
    scene = Scene(LumpedCue(0.54, end_mass), tip=tip, stroke=Stroke(1.7, offset), effects=(law,))
    assert agree(scene).regime == impulse(replace(scene, effects=())).regime


def shipped() -> list:
    built = [("leather", pool_cue()), ("bored", hollow_cue()), ("rod", uniform_rod(120))]
    return [*built, *((path.stem, load(path)) for path in MESHES)]


@pytest.mark.nightly
@pytest.mark.parametrize("time", [0.7e-3, 1e-3, 2e-3, 3.2e-3, 4e-3])
@pytest.mark.parametrize(("name", "cue"), shipped(), ids=[name for name, _ in shipped()])
def test_the_default_keeps_squirt_within_half_a_percent_of_many_modes(name, cue, time):
    """Many: three times the modes on a mesh of their own, ended by a tail as well."""
    base = replace(kim_scene(0.1, contact_time=time), cue=cue)
    count = 3 * default_resolution(base).modes
    many = tip_modes_from(tail(modes(cue, count)), base)
    for offset in (0.1, 0.3, 0.5):
        scene = replace(base, stroke=replace(base.stroke, offset=offset))
        assert abs(strike(scene).squirt / strike_modes(scene, many).squirt - 1) < 5e-3, offset
