"""What holds for every coupled strike: energy, scale, symmetry, units, a course of forces that obeys its laws."""

from dataclasses import replace
from math import isinf

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from cuefem import (
    Ball,
    Cue,
    Elevation,
    LumpedCue,
    Material,
    Outcome,
    PowerLawTip,
    Resolution,
    RollingContact,
    Scene,
    SecondHit,
    Segment,
    Stroke,
    StructuralDamping,
    Tip,
    TipDome,
    TipShear,
    strike,
)
from cuefem.contact.strike import strike_modes
from tests.helpers.leather_scenes import LEATHER, leather_scene
from tests.helpers.strike_scenes import (
    FRICTION,
    KIM_AT,
    OFFSET,
    RESTITUTION,
    SIGN,
    a_few_modes,
    hand_made,
    imbalance,
    kim_scene,
    mirrors,
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


@pytest.mark.parametrize("examples", [40, pytest.param(400, marks=pytest.mark.heavy)])
def test_energy_closes_and_the_other_side_mirrors_on_any_shaft(examples):
    @settings(max_examples=examples, deadline=None)
    @given(shaft_scenes())
    def everywhere(drawn):
        scene, at = drawn
        outcome = strike(scene, at)
        sound(outcome)
        mirrors(outcome, strike(replace(scene, stroke=Stroke(1.0, -scene.stroke.offset)), at))

    everywhere()


LEVEL = st.sets(
    st.sampled_from([PowerLawTip(1.5), RollingContact(), SecondHit(2e-3), TipDome(0.009), TipShear(0.75)]), min_size=1
).map(lambda chosen: tuple(sorted(chosen, key=repr)))
ANGLE = st.one_of(st.sampled_from([0.0, 1e-6, 0.03]), st.floats(0.001, 1.4))
TABLE = st.one_of(st.sampled_from([0.0, 0.2]), st.floats(0.01, 3.0))
RAISED = st.builds(lambda angle, table: (Elevation(angle, table),), ANGLE, TABLE)


@settings(max_examples=32)
@given(st.one_of(LEVEL, RAISED), RESTITUTION, FRICTION, OFFSET, SIGN, st.sampled_from([0.0, 0.02]))
def test_energy_closes_and_the_other_side_mirrors_with_any_effects_at_the_tip(effects, e, mu, offset, side, damping):
    raised = isinstance(effects[0], Elevation)
    assume(e >= 0.1 or not (raised or SecondHit(2e-3) in effects))
    scene = replace(kim_scene(side * offset, restitution=e, friction=mu), effects=effects)
    outcome = strike_modes(scene, a_few_modes(damping))
    sound(outcome)
    assert imbalance(outcome) < 1e-10
    assert ("damping loss" in outcome.energy) == (damping > 0)
    if raised:
        assert outcome.history.velocity[2] > -1e-9  # the table keeps the ball up
    other = replace(scene, stroke=Stroke(offset=-scene.stroke.offset))
    mirrors(outcome, strike_modes(other, a_few_modes(damping)))


@settings(max_examples=12)
@given(st.floats(1.0, 3.0), st.floats(0.2, 8.0), st.floats(0.2, 8.0), OFFSET)
def test_a_power_law_knows_no_speed_of_its_own(exponent, speed, reference, offset):
    """The law that lasts T at one speed is the law that lasts T (U/U0)^((1-n)/(1+n)) at another."""
    scene = replace(kim_scene(offset), stroke=Stroke(speed, offset))
    time = 1e-3 * (speed / reference) ** ((1 - exponent) / (1 + exponent))
    other = replace(scene.tip, contact_time=time)
    first = strike_modes(replace(scene, effects=(PowerLawTip(exponent, reference),)), a_few_modes())
    second = strike_modes(replace(scene, tip=other, effects=(PowerLawTip(exponent, speed),)), a_few_modes())
    assert np.allclose(numbers(first), numbers(second), rtol=1e-9, atol=1e-9 * speed**2)


def test_effects_at_the_tip_go_with_those_on_the_cue():
    at_tip = (PowerLawTip(1.5), RollingContact(), TipDome(0.009), SecondHit())
    outcome = strike(replace(kim_scene(0.4), effects=(StructuralDamping(0.02), *at_tip)))
    sound(outcome)
    assert outcome.energy["damping loss"] > 0


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


LOUD = Scene(LumpedCue(0.54, 0.01), Ball(), Tip(0.3, 0.05, contact_time=3e-3), Stroke(1.5, 0.5))
COURSES = {
    "stick": kim_scene(0.3),
    "miscue": kim_scene(0.8),
    "late stick": kim_scene(0.3, restitution=1.0, friction=0.3),
    "dead tip": kim_scene(0.3, restitution=0.0),
    "reload": kim_scene(0.9, restitution=0.05, friction=0.3, contact_time=3e-3),
    "endless friction": kim_scene(-0.5, friction=float("inf")),
    "lumped": Scene(LumpedCue(0.54, 0.004), stroke=Stroke(offset=0.4)),
    "a cue made by hand, which slips and sticks eight times": LOUD,
}


def struck(scene: Scene) -> Outcome:
    if scene is LOUD:
        return strike_modes(scene, hand_made([870.0, 2600.0], [11.0, 12.0], rigid=0.5))
    return strike(scene, None if isinstance(scene.cue, LumpedCue) else KIM_AT)


@pytest.mark.parametrize(
    "scene", [*COURSES.values(), leather_scene(leather=replace(LEATHER, rolls=False))], ids=[*COURSES, "leather"]
)
def test_forces_integrate_to_the_impulse(scene):
    """By a Gauss rule that is exact for the polynomials of the steps."""
    outcome = struck(scene)
    points, weights = np.polynomial.legendre.leggauss(16)
    for phase in outcome.phases:
        if phase.grip == "blow":
            continue
        edges = np.unique([phase.start, *outcome.history.start, phase.end])
        edges = edges[(edges >= phase.start) & (edges <= phase.end)]
        half = np.diff(edges)[:, None] / 2
        now = outcome.history(np.clip(edges[:-1, None] + half * (1 + points), phase.start, phase.end))
        for row, key in enumerate(("force_t", "force_n")):
            total = np.sum(half * weights * now[key])
            assert abs(total - phase.impulse[row]) < 1e-10 * outcome.impulse[1], (phase, key)
    total = np.sum([phase.impulse for phase in outcome.phases], axis=0)
    assert np.abs(total - outcome.impulse).max() < 1e-12 * outcome.impulse[1]


@pytest.mark.parametrize("name", COURSES)
def test_forces_and_velocities_obey_the_laws_of_their_phase(name):
    scene, outcome = COURSES[name], struck(COURSES[name])
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


def test_history_keeps_the_shape():
    history = strike(kim_scene(), KIM_AT).history
    assert history(np.zeros((3, 2)))["force_n"].shape == (3, 2)
    assert np.shape(history(0.0)["velocity_t"]) == ()


@pytest.mark.parametrize("extra", [(), (PowerLawTip(1.5),), (Elevation(0.1),), (SecondHit(),)])
def test_single_numbers_are_plain_floats_that_print_well(extra):
    found = strike(Scene(LumpedCue(0.54, 0.006), stroke=Stroke(offset=0.3), effects=extra))
    numbers = [found.squirt, found.ball_speed, found.spin, found.cue_speed, found.duration, *found.energy.values()]
    times = [time for phase in found.phases for time in (phase.start, phase.end)]
    assert {type(value) for value in (*numbers, *times)} == {float}
    assert "np." not in repr(found.energy)
