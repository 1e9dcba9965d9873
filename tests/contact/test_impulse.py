"""The impulse solver against an oracle that shares no formula with it, and what every stroke obeys in any regime."""

from collections import Counter
from dataclasses import replace
from math import inf, sqrt, tan

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from cuefem import Ball, LumpedCue, Outcome, Scene, Stroke, Tip, impulse
from studies.paper import closed_forms as squirt
from tests.helpers.impulse_oracle import exact, regime_of

MANY = settings(max_examples=40, deadline=None)
PLACES = ("initial", "ball translation", "ball rotation", "cue", "tip loss", "friction loss")


def powers(low, high):
    return st.floats(low, high).map(lambda x: 10**x)


@st.composite
def scenes(draw):
    M, nu = draw(powers(-1, 0)), draw(st.floats(0.05, 1))
    cue, ends = M * draw(powers(-3, 3)), M * draw(powers(-9, 3))
    coupling = draw(st.sampled_from([0.0, 0.3, -0.5, 0.95, -0.95])) / sqrt(cue * ends)
    offset = draw(st.sampled_from([0.0, 1e-12, 0.3, 0.5, 0.999999]) | st.floats(0, 0.99).map(lambda x: round(x, 9)))
    friction = draw(st.sampled_from([0.0, inf, 0.7]) | st.floats(0, 3))
    restitution = draw(st.sampled_from([0.0, 1.0]) | st.floats(0, 1))
    speed = draw(st.floats(0.1, 10))
    return Scene(LumpedCue(cue, ends, coupling), Ball(M, 0.03, nu), Tip(restitution, friction), Stroke(speed, offset))


def everything(out):
    """Every number of an outcome, by name."""
    named = {event.name: event.impulse for event in out.phases} | out.energy
    fields = ("squirt", "ball_velocity", "ball_speed", "spin", "cue_speed", "impulse")
    return named | {name: getattr(out, name) for name in fields}


@MANY
@given(scenes())
@example(Scene(LumpedCue(0.5, 0.2, -2.9), Ball(1.0, 0.03), Tip(0.5, inf), Stroke(1.0, 0.995)))
def test_what_every_stroke_keeps(scene):
    out = impulse(scene)
    finite(out)
    energy_closes(scene, out)
    mirrors(out, impulse(replace(scene, stroke=replace(scene.stroke, offset=-scene.stroke.offset))))


def finite(out):
    """Never nan; only the end of a miscue's slip is infinite."""
    for name, value in everything(out).items():
        if name == "slip ends" and out.regime == "miscue":
            assert value == inf
        else:
            assert np.all(np.isfinite(value)), name


def energy_closes(scene, out):
    initial, *parts = (out.energy[name] for name in PLACES)
    assert set(out.energy) == set(PLACES)
    assert abs(sum(parts) - initial) < 1e-12 * initial
    assert min(parts) >= -1e-13 * initial
    assert initial >= scene.cue.mass * scene.stroke.speed**2 / 2 * (1 - 1e-15)
    assert out.energy["ball rotation"] == pytest.approx(
        scene.ball.inertia * scene.ball.mass * (scene.ball.radius * out.spin) ** 2 / 2, rel=1e-13
    )
    assert out.energy["ball translation"] == pytest.approx(scene.ball.mass * out.ball_speed**2 / 2, rel=1e-13)
    if scene.tip.restitution == 1:
        assert abs(out.energy["tip loss"]) < 1e-15 * initial
    if scene.tip.friction == 0 or scene.stroke.offset == 0:
        assert abs(out.energy["friction loss"]) < 1e-15 * initial


def mirrors(right, left):
    assert (left.squirt, left.spin, left.cue_speed) == (-right.squirt, -right.spin, right.cue_speed)
    assert tuple(left.ball_velocity) == (-right.ball_velocity[0], right.ball_velocity[1])
    assert tuple(left.impulse) == (-right.impulse[0], right.impulse[1])
    assert (left.phases, left.energy) == (right.phases, right.energy)
    assert (left.regime, left.jam) == (right.regime, right.jam)


def many_scenes(rng, shape):
    M = rng.uniform(0.1, 0.3, shape)
    cue, ends = M * 10 ** rng.uniform(-1, 2, shape), M * 10 ** rng.uniform(-6, 1, shape)
    coupling = rng.uniform(-0.9, 0.9, shape) / np.sqrt(cue * ends) * (rng.random(shape) < 0.3)
    tip = Tip(rng.uniform(0, 1, shape), rng.choice([0.0, inf, 0.7, 0.2], shape))
    stroke = Stroke(rng.uniform(0.1, 9, shape), rng.choice([0.0, -0.3, 0.5, 0.9], shape))
    return Scene(LumpedCue(cue, ends, coupling), Ball(M, rng.uniform(0.02, 0.04, shape), 0.4), tip, stroke)


@pytest.mark.parametrize("block", [8192, 1, 7, 64])
def test_an_array_of_strokes_is_its_strokes_one_by_one(monkeypatch, block):
    """However many are worked at a time."""
    monkeypatch.setattr("cuefem.contact.rigid_impact.BLOCK", block)
    whole = many_scenes(np.random.default_rng(5), (5, 8))
    out = impulse(whole)
    for at in np.ndindex(5, 8):
        single = Scene(
            LumpedCue(whole.cue.mass[at], whole.cue.end_mass[at], whole.cue.coupling[at]),
            Ball(whole.ball.mass[at], whole.ball.radius[at], 0.4),
            Tip(whole.tip.restitution[at], whole.tip.friction[at]),
            Stroke(whole.stroke.speed[at], whole.stroke.offset[at]),
        )
        one = impulse(single)
        assert (one.regime, one.jam) == (out.regime[at], out.jam[at])
        for name, value in everything(one).items():
            np.testing.assert_allclose(everything(out)[name][at], value, rtol=1e-13, atol=1e-300)


REGIMES = ("stick", "late stick", "miscue", "slip reversal", "jam")


def draw(rng: np.random.Generator, kind: str) -> Scene:
    """A scene that is likely to fall in the regime asked for."""
    M, nu = rng.uniform(0.1, 0.3), rng.uniform(0.2, 1)
    Q0, ends, b = 10 ** rng.uniform(-1, 2), 10 ** rng.uniform(-6, 1), rng.uniform(0.01, 0.99)
    mu, e = rng.uniform(0, 2), rng.choice([0.0, 1.0, rng.uniform(0, 1)])
    if kind == "late stick":
        ends, e = 10 ** rng.uniform(-1.5, 0.5), rng.uniform(0.1, 1)
        mu = squirt.compression_stick_friction(b, end_mass_ratio=ends, inertia=nu) * rng.uniform(0.8, 1)
    elif kind == "slip reversal":
        Q0, mu = 10 ** rng.uniform(-1, 0), rng.uniform(0, 0.08)
        ends = Q0 * 10 ** rng.uniform(0.5, 2)
    elif kind == "jam":
        ends, b, mu = 10 ** rng.uniform(-6, -2), rng.uniform(0.05, 0.55), rng.uniform(0.7, 2)
    elif kind == "stick" and rng.uniform() < 0.2:
        mu = inf
    coupling = rng.uniform(-0.9, 0.9) if rng.uniform() < 0.3 else 0.0
    cue = LumpedCue(Q0 * M, ends * M, coupling / np.sqrt(Q0 * ends) / M)
    return Scene(cue, Ball(M, 0.03, nu), Tip(e, mu), Stroke(rng.uniform(0.5, 4), b))


def close(out: Outcome, told, scene: Scene, tolerance: float) -> None:
    U, initial = scene.stroke.speed, out.energy["initial"]
    p = np.hypot(*out.impulse)
    assert abs(float(told.p_t) - out.impulse[0]) < tolerance * p
    assert abs(float(told.p_n) - out.impulse[1]) < tolerance * p
    np.testing.assert_allclose(out.impulse, scene.ball.mass * out.ball_velocity, rtol=1e-14)
    moment = scene.ball.inertia * scene.ball.mass * scene.ball.radius
    assert abs(out.spin * moment - out.impulse[0]) < 1e-14 * p
    assert abs(float(told.cue_speed) - out.cue_speed) < tolerance * U
    assert abs(float(told.tip_loss) - out.energy["tip loss"]) < tolerance * initial
    assert abs(float(told.friction_loss) - out.energy["friction loss"]) < tolerance * initial


def test_an_oracle_agrees_in_every_regime():
    rng = np.random.default_rng(8)
    seen: Counter[str] = Counter()
    for kind in REGIMES:
        for _ in range(100):
            scene = draw(rng, kind)
            out, told = impulse(scene), exact(scene)
            assert out.regime == regime_of(told)
            seen.update([out.regime, "jam"] if out.jam else [out.regime])
            # angles as tangents, which decimals have; a slip's end within its rounding of the miscue
            assert abs(tan(out.squirt) - float(told.tangent)) < 1e-12 * (1 + float(told.tangent) ** 2)
            close(out, told, scene, 1e-12)
    for regime in REGIMES:
        assert seen[regime] >= 30, (regime, seen)
