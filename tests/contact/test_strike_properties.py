"""Coupled strikes with any effects: energy, mirror, order of effects, splitting, limits, friction (properties).

Effects are drawn from one strategy (`strikes`), which includes leather tips, elevation and second hits.
"""

from __future__ import annotations

from dataclasses import replace
from math import inf, isinf

import numpy as np
import pytest
from hypothesis import example, given
from hypothesis import strategies as st

import cuefem as cf
from cuefem.contact.strike import strike_modes
from cuefem.effects.effect import Effect
from cuefem.scene.solved_scene import tip_modes_of
from tests.helpers.examples import examples
from tests.helpers.leather_scenes import LEATHER, leather_scene
from tests.helpers.orders import assert_order
from tests.helpers.strike_scenes import (
    FRICTION,
    KIM,
    KIM_AT,
    OFFSET,
    RESTITUTION,
    SIGN,
    assert_mirrored,
    custom_tip_modes,
    energy_residual,
    kim_scene,
    logarithmic,
    outcome_vector,
    rotating_modes,
)

pytestmark = pytest.mark.kernel
AT = cf.Resolution(2, 10, 8)
# Bound on the energy residual of a cue with dampers at the default steps; its order: test_step_convergence.py
ENERGY_TOLERANCE = 1e-4
POSITIONS = st.floats(0.01, 0.69)


def size(low: float, high: float) -> st.SearchStrategy[float]:
    """None, or any power of ten between."""
    return st.just(0.0) | logarithmic(low, high)


ON_CUE = st.one_of(
    st.builds(cf.PointMass, position=POSITIONS, mass=size(1e-5, 0.1), rotary_inertia=size(1e-9, 1e-3)),
    st.builds(cf.Support, POSITIONS, size(1.0, 1e7), size(0.01, 1e3), size(0.1, 100.0)),
    st.just(cf.Support(KIM.length, inf, inf)),
    st.builds(cf.Joint, POSITIONS, size(1e-6, 1e2), size(1e-11, 1e-3)),
    st.builds(cf.StructuralDamping, size(1e-4, 0.9)),
    st.just(cf.AxialWaves()),
    st.just(cf.GeometricStiffness()),
)
DOME, POWER = st.builds(cf.TipDome, size(1e-4, 0.02)), st.builds(cf.PowerLawTip, st.floats(1.0, 3.0))
LEVEL = (
    DOME,
    POWER,
    st.builds(cf.TipShear, st.floats(0.05, 50.0)),
    st.just(cf.RollingContact()),
    st.just(cf.SecondHit()),
)
RAISED = st.builds(cf.Elevation, st.floats(0.0, 1.2), st.sampled_from([0.0, 0.2, 3.0]))
WHOLE_TIP = st.builds(
    lambda E, rolls, e_t: replace(LEATHER, E=E, rolling=rolls, surface_restitution=e_t),
    st.floats(1.5e8, 6e8),
    st.booleans(),
    st.just(1.0) | st.floats(0.3, 1.0),
)


@st.composite
def strikes(draw: st.DrawFn) -> cf.Scene:
    """A scene with effects on the cue, and compatible effects at its tip."""
    kinds = {type(effect): effect for effect in draw(st.lists(ON_CUE, max_size=3))}
    e, mu, tip_kind = draw(RESTITUTION), draw(FRICTION), draw(st.sampled_from(["level", "raised", "leather"]))
    stroke = cf.Stroke(draw(st.floats(0.3, 3.0)), draw(SIGN) * draw(OFFSET))
    if tip_kind == "leather":
        second_hit = draw(st.sampled_from([(), (cf.SecondHit(),)]))
        tip = draw(WHOLE_TIP)
        return leather_scene(
            stroke.offset, *second_hit, *kinds.values(), speed=stroke.speed, e=max(e, 0.15), friction=mu, leather=tip
        )
    if tip_kind == "raised":
        return replace(kim_scene(friction=mu, restitution=max(e, 0.1)), stroke=stroke,
                       effects=(draw(RAISED), *draw(st.tuples(DOME, POWER)), *kinds.values()))  # fmt: skip
    at_tip = draw(st.lists(st.sampled_from(LEVEL), unique=True).flatmap(lambda chosen: st.tuples(*chosen)))
    if any(isinstance(effect, cf.SecondHit) for effect in at_tip):
        e, mu = max(e, 0.1), min(mu, 5.0)
    return replace(kim_scene(friction=mu, restitution=e), stroke=stroke, effects=(*at_tip, *kinds.values()))


def strike(scene: cf.Scene, at: cf.Resolution = AT) -> cf.Outcome | None:
    """The strike, or None where axial force and bending exceed the range of GeometricStiffness."""
    try:
        return cf.strike(scene, at)
    except ValueError as error:
        if "bends the shaft by" not in str(error):
            raise
        return None


@pytest.mark.hypothesis
@pytest.mark.parametrize("count", [5, pytest.param(100, marks=pytest.mark.heavy)])
def test_strike_conserves_energy_mirrors_and_ignores_effect_order(count: int) -> None:
    @examples(count)
    @given(strikes(), st.integers(0, 5))
    @example(replace(kim_scene(0.3, restitution=0.05), effects=(cf.Support(0.25, dashpot=5.0),)), 0)
    @example(replace(kim_scene(0.3, restitution=0.05), effects=(cf.AxialWaves(),)), 0)
    @example(leather_scene(0.0, e=0.716796875, friction=inf, leather=replace(LEATHER, E=142981276.0, rolling=False)), 0)
    @example(leather_scene(0.2309, speed=3.8607, e=0.883, friction=0.17, leather=replace(LEATHER, E=3.9e8)), 0)
    @example(leather_scene(0.3, cf.AxialWaves(), cf.GeometricStiffness()), 0)
    def everywhere(scene: cf.Scene, turn: int) -> None:
        if (outcome := strike(scene)) is None:
            return
        assert np.all(np.isfinite(outcome_vector(outcome)))
        assert energy_residual(outcome) < ENERGY_TOLERANCE
        assert min(outcome.energy.values()) > -1e-9 * outcome.energy["initial"]
        assert ("damping loss" in outcome.energy) >= any(
            isinstance(effect, cf.StructuralDamping) and effect.loss for effect in scene.effects
        )
        if outcome.history.velocity is not None:
            assert outcome.history.velocity[2] > -1e-9  # the ball does not move into the table
        mirrored = strike(replace(scene, stroke=replace(scene.stroke, offset=-scene.stroke.offset)))
        assert mirrored is not None
        assert_mirrored(outcome, mirrored)
        head_on = strike(replace(scene, stroke=replace(scene.stroke, offset=0.0)))
        assert head_on is None or head_on.squirt == 0
        effects = scene.effects[turn:] + scene.effects[:turn]
        reordered = strike(replace(scene, effects=effects[::-1] if turn % 2 else effects))
        assert reordered is not None
        assert outcome_vector(reordered) == pytest.approx(outcome_vector(outcome), rel=1e-9, abs=1e-12)

    everywhere()


SPLIT: dict[str, tuple[Effect, ...]] = {  # the first is the sum of the others
    "mass": (
        cf.PointMass(position=0.1, mass=5e-3, rotary_inertia=1e-7),
        cf.PointMass(position=0.1, mass=2e-3, rotary_inertia=4e-8),
        cf.PointMass(position=0.1, mass=3e-3, rotary_inertia=6e-8),
    ),
    "support": (cf.Support(0.2, 5e3, 1.0, 20.0), cf.Support(0.2, 2e3, 0.4, 5.0), cf.Support(0.2, 3e3, 0.6, 15.0)),
    "dome": (cf.TipDome(9e-3), cf.TipDome(4e-3), cf.TipDome(5e-3), cf.TipDome(0.0)),
    "shear, in series": (cf.TipShear(0.75), cf.TipShear(3.0), cf.TipShear(2.0), cf.TipShear(2.0)),
}


@pytest.mark.parametrize("name", SPLIT)
def test_effect_split_in_parts_equals_whole(name: str) -> None:
    """For strike, end mass, motion and the impulse solver alike."""
    total, *parts = SPLIT[name]
    expected, result = (replace(kim_scene(), effects=tuple(effects)) for effects in ([total], parts))
    assert outcome_vector(cf.strike(result, AT)) == pytest.approx(
        outcome_vector(cf.strike(expected, AT)), rel=1e-9, abs=1e-14
    )
    for drive in ("offset", "velocity"):
        assert cf.end_mass(result, drive, AT) == pytest.approx(cf.end_mass(expected, drive, AT), rel=1e-9)
    assert cf.impulse(result).squirt == pytest.approx(cf.impulse(expected).squirt, rel=1e-9)
    centres = [cf.motion(scene, [0.0, 3e-4, 2e-3], AT).centre for scene in (expected, result)]
    np.testing.assert_allclose(*centres, rtol=1e-9, atol=1e-14)
    assert expected.dome_radius == pytest.approx(result.dome_radius, abs=1e-15)


def squirt(*effects: Effect, **stroke: float) -> float:
    scene = replace(kim_scene(), effects=effects)
    return float(cf.strike(replace(scene, stroke=replace(scene.stroke, **stroke)), KIM_AT).squirt)


def test_strike_other_limits_are_reached() -> None:
    """Infinite shear ratio (error 1/ratio within a factor 2), exponent 1, elevation 0, speed 0 with GeometricStiffness,
    contact time 0 with RollingContact."""
    bare = squirt()
    for ratio in (1e1, 1e2):
        assert 5e-3 / ratio < abs(squirt(cf.TipShear(ratio)) - bare) < 5e-2 / ratio
    assert squirt(cf.PowerLawTip(1.0)) == pytest.approx(bare, rel=1e-8)
    assert squirt(cf.Elevation(0.0, 0.2)) == pytest.approx(bare, rel=1e-8)
    slow = [squirt(cf.GeometricStiffness(), speed=speed) / bare - 1 for speed in (0.1, 0.2)]
    assert slow[1] / slow[0] == pytest.approx(2.0, rel=1e-2)
    changes = []
    for time in 1e-3 * 2.0 ** -np.arange(5, 9):
        scene = kim_scene(0.3, contact_time=float(time))
        rolling, fixed = (
            strike_modes(replace(scene, effects=e), rotating_modes()) for e in ((cf.RollingContact(),), ())
        )
        changes.append(rolling.squirt / fixed.squirt - 1)
    assert_order(1, 2.0 ** -np.arange(4.0), changes, within=[0.04, 0.02, 0.01])


LOUD = custom_tip_modes([870.0, 2600.0], [11.0, 12.0], rigid=0.5)
CASES = {
    "stick": (kim_scene(0.3), None),
    "reload": (kim_scene(0.9, restitution=0.05, friction=0.3, contact_time=3e-3), None),
    "infinite friction": (kim_scene(-0.5, friction=inf), None),
    "slips and sticks eight times": (kim_scene(0.5, restitution=0.3, friction=0.05, contact_time=3e-3), LOUD),
}


@pytest.mark.parametrize("name", CASES)
def test_history_forces_obey_friction_and_integrate_to_impulse(name: str) -> None:
    scene, tip = CASES[name]
    outcome = strike_modes(scene, tip or tip_modes_of(scene, KIM_AT))
    history, side, mu = outcome.history, np.sign(scene.stroke.offset), scene.tip.friction
    force_times, force, lengths = history.force_times[1:-1], history.forces[1:-1], np.diff(history.ends)
    assert np.all(force[:, 1] >= 0)
    for phase in outcome.phases:
        in_phase = (force_times > phase.start) & (force_times < phase.end)
        if not in_phase.any():
            assert (phase.state, phase.start) == ("impulse", phase.end)
            continue
        f_t, f_n = force[in_phase].T
        integrals = [lengths[in_phase] @ f_t, lengths[in_phase] @ f_n]
        np.testing.assert_allclose(integrals, phase.impulse, rtol=0, atol=1e-10 * outcome.impulse[1])
        if not isinf(mu):
            assert np.all(np.abs(f_t) <= mu * f_n * (1 + 1e-9))
        if phase.state != "stick":
            direction = side * (1 if phase.state == "slip" else -1)
            last = slice(None, -1)  # sliding may stop in the last step of a phase
            assert np.abs(f_t - direction * mu * f_n)[last].max() < 1e-9 * f_n.max()
            assert np.all(direction * history.velocities[1:][in_phase][last, 0] < 1e-3 * scene.stroke.speed)
    assert np.sum([phase.impulse for phase in outcome.phases], axis=0) == pytest.approx(outcome.impulse, rel=1e-12)
