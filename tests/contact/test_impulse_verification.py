"""The impulse solver against exact solutions, an oracle that shares no formula with it, and at regime boundaries."""

from collections import Counter
from math import inf, tan

import numpy as np

from cuefem import Ball, LumpedCue, Outcome, Scene, Stroke, Tip, impulse
from studies.paper import closed_forms as squirt
from tests.helpers.impulse_oracle import exact, regime_of

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
