"""What holds for every coupled strike: energy, scale, symmetry, units, a course of forces that obeys its laws."""

from dataclasses import replace
from itertools import pairwise
from math import isinf

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.integrate import quad

from cuefem import Ball, Cue, LumpedCue, Material, Outcome, Resolution, Scene, Segment, Stroke, Tip, strike
from cuefem.contact.strike import strike_modes
from cuefem.effects import Elevation, PowerLawTip, SecondHit
from tests.helpers.strike_scenes import (
    KIM_AT,
    hand_made,
    kim_scene,
    lumped_scenes,
    numbers,
    pool_cue,
    shaft_scenes,
    sound,
)

EXACT = 1e-10


def same_course(first: Outcome, second: Outcome) -> None:
    """The same phases in the same order, but for those of no length."""
    names = [[(p.grip, p.press) for p in o.phases if p.end > p.start + 1e-9 * o.duration] for o in (first, second)]
    assert names[0] == names[1]


@settings(max_examples=40, deadline=None)
@given(shaft_scenes())
def test_energy_closes_and_nothing_is_made_of_nothing(drawn):
    scene, at = drawn
    sound(strike(scene, at))


@pytest.mark.heavy
@settings(max_examples=400, deadline=None)
@given(shaft_scenes())
def test_energy_closes_over_many_shafts(drawn):
    scene, at = drawn
    sound(strike(scene, at))


@settings(max_examples=25, deadline=None)
@given(shaft_scenes())
def test_a_negative_offset_is_the_exact_mirror(drawn):
    scene, at = drawn
    right, left = strike(scene, at), strike(replace(scene, stroke=Stroke(1.0, -scene.stroke.offset)), at)
    assert left.squirt == -right.squirt
    assert left.spin == -right.spin
    assert np.array_equal(left.ball_velocity, right.ball_velocity * [-1, 1])
    assert np.array_equal(left.impulse, right.impulse * [-1, 1])
    assert (left.cue_speed, left.ball_speed, left.duration) == (right.cue_speed, right.ball_speed, right.duration)
    assert left.energy == right.energy
    for phase, other in zip(left.phases, right.phases, strict=True):
        assert phase[:4] == other[:4]
        assert phase.impulse == (-other.impulse[0], other.impulse[1])
    times = np.linspace(0, right.duration, 7)
    for name, values in right.history(times).items():
        assert np.array_equal(left.history(times)[name], -values if name[-1] == "t" else values)


@settings(max_examples=20, deadline=None)
@given(shaft_scenes(), st.sampled_from([1e-3, 0.1, 7.0, 1e3]))
def test_speed_scales_every_velocity_and_no_time(drawn, factor):
    scene, at = drawn
    slow, fast = strike(scene, at), strike(replace(scene, stroke=replace(scene.stroke, speed=factor)), at)
    same_course(slow, fast)
    assert abs(fast.squirt - slow.squirt) < EXACT
    assert abs(fast.duration / slow.duration - 1) < EXACT
    assert abs(fast.cue_speed - factor * slow.cue_speed) < EXACT * factor
    assert np.abs(fast.ball_velocity - factor * slow.ball_velocity).max() < EXACT * factor * slow.ball_speed
    for name, joules in slow.energy.items():
        assert abs(fast.energy[name] - factor**2 * joules) < EXACT * fast.energy["initial"]


def in_units(scene: Scene, *, time: float, length: float, mass: float) -> Scene:
    """The same scene with its numbers in other units: a second is ``time`` of the new ones, and so on."""
    pressure = mass / length / time**2

    def material(m: Material) -> Material:
        return replace(m, E=m.E * pressure, G=m.G * pressure, rho=m.rho * mass / length**3)

    def segment(s: Segment) -> Segment:
        lengths = ("length", "tip_diameter", "butt_diameter", "tip_bore", "butt_bore")
        scaled = {name: getattr(s, name) * length for name in lengths}
        return replace(s, **scaled, material=material(s.material), core=s.core and material(s.core))

    cue = Cue(tuple(segment(s) for s in scene.cue.segments), scene.cue.body_mass * mass)
    ball = replace(scene.ball, mass=scene.ball.mass * mass, radius=scene.ball.radius * length)
    tip = replace(scene.tip, contact_time=scene.contact_time * time)
    return Scene(cue, ball, tip, replace(scene.stroke, speed=scene.stroke.speed * length / time))


@pytest.mark.parametrize("units", [(1e3, 1, 1), (1, 400, 1), (1, 1, 1e3), (1e-2, 39.37, 2.2)])
@pytest.mark.parametrize(("offset", "e", "mu"), [(0.3, 0.75, 0.7), (0.6, 0.75, 0.3), (0.2, 0.0, 0.7), (0.9, 0.05, 0.3)])
def test_the_answer_does_not_depend_on_the_units(units, offset, e, mu):
    time, length, mass = units
    scene, at = Scene(pool_cue(), Ball(), Tip(e, mu, contact_time=1e-3), Stroke(1.3, offset)), Resolution(4, 10, 20)
    ours, theirs = strike(scene, at), strike(in_units(scene, time=time, length=length, mass=mass), at)
    same_course(ours, theirs)
    assert abs(theirs.squirt - ours.squirt) < EXACT
    assert abs(theirs.duration / time / ours.duration - 1) < EXACT
    assert abs(theirs.spin * time / ours.spin - 1) < EXACT
    velocity = theirs.ball_velocity * time / length
    assert np.abs(velocity - ours.ball_velocity).max() < EXACT * ours.ball_speed
    for name, joules in ours.energy.items():
        scaled = theirs.energy[name] * time**2 / length**2 / mass
        assert abs(scaled - joules) < EXACT * ours.energy["initial"], name


HISTORIES = {
    "stick": (kim_scene(0.3), KIM_AT),
    "miscue": (kim_scene(0.8), KIM_AT),
    "late stick": (kim_scene(0.3, restitution=1.0, friction=0.3), KIM_AT),
    "dead tip": (kim_scene(0.3, restitution=0.0), KIM_AT),
    "reload": (kim_scene(0.9, restitution=0.05, friction=0.3, contact_time=3e-3), KIM_AT),
    "endless friction": (kim_scene(-0.5, friction=float("inf")), KIM_AT),
    "lumped": (Scene(LumpedCue(0.54, 0.004), stroke=Stroke(offset=0.4)), None),
}


def loud() -> tuple[Scene, Outcome]:
    """A hand-made cue that slips and sticks eight times."""
    scene = Scene(LumpedCue(0.54, 0.01), Ball(), Tip(0.3, 0.05, contact_time=3e-3), Stroke(1.5, 0.5))
    return scene, strike_modes(scene, hand_made([870.0, 2600.0], [11.0, 12.0], rigid=0.5))


def course(name: str) -> tuple[Scene, Outcome]:
    return loud() if name == "loud" else (HISTORIES[name][0], strike(*HISTORIES[name]))


@pytest.mark.parametrize("name", [*HISTORIES, "loud"])
def test_forces_integrate_to_the_impulse(name):
    _, outcome = course(name)
    total = np.zeros(2)
    for phase in outcome.phases:
        total += phase.impulse
        if phase.grip == "blow":
            continue
        edges = np.linspace(phase.start, phase.end, 40)
        for row, key in enumerate(("force_t", "force_n")):
            found = sum(
                quad(lambda t, key=key: float(outcome.history(t)[key]), a, b, epsabs=0, epsrel=1e-11)[0]
                for a, b in pairwise(edges[(edges > phase.start) | (edges == edges[0])])
                if b > a
            )
            assert abs(found - phase.impulse[row]) < 1e-10 * outcome.impulse[1], (phase, key)
    assert np.abs(total - outcome.impulse).max() < 1e-12 * outcome.impulse[1]


@pytest.mark.parametrize("name", [*HISTORIES, "loud"])
def test_forces_and_velocities_obey_the_laws_of_their_phase(name):
    scene, outcome = course(name)
    side, mu = np.sign(scene.stroke.offset), scene.tip.friction
    force = np.abs(outcome.history(np.linspace(0, outcome.duration, 400))["force_n"]).max()
    speed = scene.stroke.speed
    for phase in outcome.phases:
        if not phase.end > phase.start:
            continue
        now = outcome.history(np.linspace(phase.start, phase.end, 203)[1:-1])
        assert np.all(now["force_n"] > -1e-11 * force)
        if not isinf(mu):
            assert np.all(np.abs(now["force_t"]) < mu * now["force_n"] + 1e-10 * force)
        if phase.grip == "stick":
            assert np.abs(now["velocity_t"]).max() < 1e-12 * speed
        else:
            way = side * (1 if phase.grip == "slip" else -1)
            assert np.abs(now["force_t"] - way * mu * now["force_n"]).max() < 1e-11 * force
            assert np.all(way * now["velocity_t"] < 1e-11 * speed)
        if phase.press == "load":
            assert np.all(now["velocity_n"] < 1e-11 * speed)
        if phase.press == "rigid":
            assert np.abs(now["velocity_n"]).max() < 1e-11 * speed


def test_history_keeps_the_shape_and_refuses_other_times():
    outcome = strike(*HISTORIES["stick"])
    assert outcome.history(np.zeros((3, 2)))["force_n"].shape == (3, 2)
    assert np.shape(outcome.history(0.0)["velocity_t"]) == ()
    for time in (-1e-9, outcome.duration * 1.001, np.nan):
        with pytest.raises(ValueError, match="History takes times in"):
            outcome.history(time)


@settings(max_examples=40, deadline=None)
@given(lumped_scenes())
def test_a_lumped_cue_loses_nothing_to_vibration(scene):
    outcome = strike(scene)
    sound(outcome)
    assert outcome.energy["cue vibration"] == 0
    assert np.all(np.isfinite(numbers(outcome)))


@pytest.mark.parametrize("extra", [(), (PowerLawTip(1.5),), (Elevation(0.1),), (SecondHit(),)])
def test_single_numbers_are_plain_floats_that_print_well(extra):
    found = strike(Scene(LumpedCue(0.54, 0.006), stroke=Stroke(offset=0.3), effects=extra))
    numbers = [found.squirt, found.ball_speed, found.spin, found.cue_speed, found.duration, *found.energy.values()]
    times = [time for phase in found.phases for time in (phase.start, phase.end)]
    assert {type(value) for value in (*numbers, *times)} == {float}
    assert "np." not in repr(found.energy)
