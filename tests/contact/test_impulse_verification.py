"""The impulse solver against exact solutions, an oracle that shares no formula with it, and at regime boundaries."""

from collections import Counter
from itertools import product
from math import inf, tan

import numpy as np
import pytest

from cuefem import Ball, LumpedCue, Outcome, Scene, Stroke, Tip, impulse, squirt
from tests.helpers.impulse_oracle import exact, regime_of

POOL = Ball(0.21, 0.03075, 0.4)
REGIMES = ("stick", "late stick", "miscue", "slip reversal", "jam")


def scene_of(b, *, eps, Q0, e=0.75, mu=0.7, nu_c=1 / 3, ball=POOL, speed=1.0):
    """A two-part cue as [Kim] counts it: eps = m_c/M, Q0 = M_c/M."""
    cue = LumpedCue.two_part(np.multiply(Q0, ball.mass), np.multiply(eps, ball.mass), nu_c)
    return Scene(cue, ball, Tip(e, mu), Stroke(speed, b))


def numbers(scene):
    cue, ball = scene.cue, scene.ball
    return {"mass": cue.mass, "end_mass": cue.end_mass, "ball_mass": ball.mass, "inertia": ball.inertia}


def equals_closed_form(scene):
    """Every number of the outcome, to 1e-12; squirt and impulses relative to themselves."""
    tip, stroke, ball = scene.tip, scene.stroke, scene.ball
    out = impulse(scene)
    form = squirt.closed_form(stroke.offset, restitution=tip.restitution, friction=tip.friction, **numbers(scene))
    assert np.all(np.isin(out.regime, ["stick"]))
    np.testing.assert_allclose(out.squirt, form.squirt, rtol=1e-12, atol=0)
    speed = np.asarray(stroke.speed)
    scale = np.hypot(*np.moveaxis(form.velocity, -1, 0))
    assert np.all(np.abs(out.ball_velocity / speed[..., None] - form.velocity).max(axis=-1) <= 1e-12 * scale)
    assert np.all(np.abs(out.spin * ball.radius / speed - form.spin) <= 1e-12 * np.maximum(np.abs(form.spin), scale))
    np.testing.assert_allclose(out.cue_speed / speed, form.cue_speed, rtol=0, atol=1e-12)
    assert np.all(np.abs(out.impulse[..., 0] / speed - form.impulses.tangential) <= 1e-12 * ball.mass * scale)
    events = [np.asarray(event.impulse) / speed for event in out.phases]
    for event, expected in zip(events[1:], form.impulses[1:3], strict=True):
        np.testing.assert_allclose(event, expected, rtol=1e-12, atol=0)
    # where slip ends is as ill-conditioned as mu - mu_c, in both
    struck = np.abs(stroke.offset) > 0
    condition = 1 / (1 - form.critical_friction / np.where(struck, tip.friction, inf))
    assert np.all(np.abs(events[0] - form.impulses.slip) <= np.maximum(1e-12, 1e-15 * condition) * form.impulses.slip)


def test_where_the_closed_form_holds_the_solver_is_it_on_a_hundred_thousand_strokes():
    rng = np.random.default_rng(3)
    size = 200_000
    b, eps, Q0 = np.sin(rng.uniform(0, 1.5, size)), 10 ** rng.uniform(-6, 1, size), 10 ** rng.uniform(-1, 2, size)
    e, mu = rng.uniform(0, 1, size), np.tan(rng.uniform(0, 1.5, size))
    whole = scene_of(b, eps=eps, Q0=Q0, e=e, mu=mu)
    holds = squirt.closed_form_holds(b, friction=mu, **numbers(whole))
    assert holds.sum() > 80_000
    part = {"eps": eps[holds], "Q0": Q0[holds], "e": e[holds], "mu": mu[holds]}
    equals_closed_form(scene_of(b[holds], **part, speed=rng.uniform(0.1, 9, int(holds.sum()))))
    assert not np.any(np.isin(impulse(whole).regime, "stick") & ~holds)


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


@pytest.mark.parametrize("ends", [2.5e-10, 1e-12, 1e-15, 1e9, 0.02, 50.0])
def test_digits_are_kept_at_extreme_end_masses_and_on_the_edge_of_the_ball(ends):
    offsets = (1e-9, 0.03, 0.5, 0.9, 0.999999, 1 - 1e-9)
    cues = ((18 / 7, 0.75), (1e-6, 0.0), (1e6, 1.0))
    for b, mu, (Q0, e) in product(offsets, (0.0, 0.2, 0.7, 5.0, 1e3, inf), cues):
        scene = Scene(LumpedCue(Q0, ends), Ball(1.0, 0.03), Tip(e, mu), Stroke(1.0, b))
        out, told = impulse(scene), exact(scene, digits=90)
        assert out.regime == regime_of(told)
        assert out.squirt == pytest.approx(np.arctan(float(told.tangent)), rel=1e-12, abs=0)
        assert out.impulse[0] == pytest.approx(float(told.p_t), rel=1e-12, abs=0)
        assert out.impulse[1] == pytest.approx(float(told.p_n), rel=1e-12, abs=0)
        assert abs(sum(out.energy.values()) - 2 * out.energy["initial"]) < 1e-12 * out.energy["initial"]


def both_sides(scene_at, edge, step):
    """Outcomes just below and above an edge, and their largest difference relative to the stroke."""
    below, above = (impulse(scene_at(edge * (1 + sign * step))) for sign in (-1, 1))
    scale = below.ball_speed
    difference = max(
        abs(below.squirt - above.squirt),
        np.abs(below.ball_velocity - above.ball_velocity).max() / scale,
        abs(below.cue_speed - above.cue_speed) / scale,
        *(abs(below.energy[k] - above.energy[k]) / below.energy["initial"] for k in below.energy),
    )
    return below, above, difference


def edges():
    """Regime boundaries in friction: (name, where, scene at a friction, regimes or jams on its two sides)."""
    for b, Q0, ends, e, nu in [
        (0.3, 18 / 7, 1 / 70, 0.75, 0.4),
        (0.6, 3.0, 0.36, 1.0, 0.4),
        (0.45, 0.5, 1.5, 0.3, 0.7),
    ]:
        beta = squirt.lumped(b, cue_mass_ratio=Q0, end_mass_ratio=ends, inertia=nu)

        def scene_at(mu, b=b, Q0=Q0, ends=ends, e=e, nu=nu):
            return Scene(LumpedCue(Q0, ends), Ball(1.0, 0.03, nu), Tip(e, mu), Stroke(1.0, b))

        late = squirt.compression_stick_friction(b, end_mass_ratio=ends, inertia=nu)
        yield "in compression", late, scene_at, ("late stick", "stick")
        yield "miscue", squirt.miscue_friction(beta, b, restitution=e), scene_at, ("miscue", "late stick")
        mu_c, jam = squirt.critical_friction(beta), squirt.jam_friction(beta)
        if mu_c > 0:
            yield "mu_c", mu_c, scene_at, ("miscue", "miscue")
        if np.isfinite(jam):
            yield "jam", jam, scene_at, (False, True)
    for b, Q0, ends in [(0.3, 0.2, 10.0), (0.6, 0.3, 3.0)]:
        beta = squirt.lumped(b, cue_mass_ratio=Q0, end_mass_ratio=ends)

        def heavy(mu, b=b, Q0=Q0, ends=ends):
            return Scene(LumpedCue(Q0, ends), Ball(1.0), Tip(0.9, mu), Stroke(1.0, b))

        yield "reversal", -squirt.critical_friction(beta), heavy, ("slip reversal", None)


@pytest.mark.parametrize(("name", "edge", "scene_at", "sides"), list(edges()))
def test_continuous_across_every_regime_boundary(name, edge, scene_at, sides):
    for step in (1e-4, 1e-6, 1e-8, 1e-10, 1e-12):
        below, above, difference = both_sides(scene_at, edge, step)
        assert difference < 20 * step + 1e-13, (name, step)
        if name == "jam":
            assert (below.jam, above.jam) == sides
        elif step >= 1e-8 and name != "reversal":
            assert (below.regime, above.regime) == sides
        elif step >= 1e-8:
            assert below.regime == "slip reversal"
            assert above.regime in ("stick", "late stick")
    on = impulse(scene_at(edge))
    assert np.isfinite([on.squirt, *on.ball_velocity, on.cue_speed, *on.energy.values()]).all()


def test_continuous_where_the_offset_the_restitution_or_the_friction_ends():
    def at(b=0.4, e=0.75, mu=0.7, ends=0.02):
        return impulse(Scene(LumpedCue(2.5, ends), Ball(1.0), Tip(e, mu), Stroke(1.0, b)))

    for limit, near in [
        (at(b=0.0), at(b=1e-12)),
        (at(b=0.0, mu=0.0), at(b=1e-12, mu=0.0)),
        (at(mu=inf), at(mu=1e12)),
        (at(mu=inf, ends=9.0), at(mu=1e12, ends=9.0)),
        (at(mu=0.0), at(mu=1e-12)),
        (at(e=0.0), at(e=1e-12)),
        (at(e=0.0, mu=0.3), at(e=1e-12, mu=0.3)),
        (at(e=1.0), at(e=1 - 1e-12)),
    ]:
        assert abs(limit.squirt - near.squirt) < 1e-11
        np.testing.assert_allclose(limit.ball_velocity, near.ball_velocity, rtol=0, atol=1e-11)
        assert abs(limit.energy["friction loss"] - near.energy["friction loss"]) < 1e-11


def test_mu_exactly_critical_is_a_miscue():
    # B_tt and B_tn in exact binary fractions: cos = 0.8 is not one, so search the friction's neighbours too
    b = 0.6
    beta = squirt.lumped(b, cue_mass_ratio=2.0, end_mass_ratio=0.25)
    mu_c = float(squirt.critical_friction(beta))
    around = [mu_c, np.nextafter(mu_c, 0), np.nextafter(mu_c, 1)]
    outs = [impulse(Scene(LumpedCue(2.0, 0.25), Ball(1.0), Tip(0.75, mu), Stroke(1.0, b))) for mu in around]
    assert [out.regime for out in outs] == ["miscue"] * 3
    assert np.ptp([out.squirt for out in outs]) < 1e-14
    assert [out.phases[0].impulse for out in outs] == [inf] * 3


def test_a_blow_that_separates_while_it_still_grips():
    """Endless friction and a coupled cue: the tangential blow alone drives the contact apart; the limit of large mu."""
    seen = Counter()
    for b in (0.9, 0.97, 0.995):
        for e in (0.0, 0.5, 1.0):
            outs = []
            for mu in (1e6, 1e8, inf):
                scene = Scene(LumpedCue(0.5, 0.2, -2.9), Ball(1.0, 0.03), Tip(e, mu), Stroke(1.0, b))
                outs.append(impulse(scene))
            seen[outs[2].regime] += 1
            gaps = [abs(out.impulse[0] - outs[2].impulse[0]) for out in outs[:2]]
            assert gaps[1] < 1e-7
            assert gaps[1] <= gaps[0] / 20 + 1e-13
            assert np.isfinite([outs[2].squirt, *outs[2].ball_velocity, *outs[2].energy.values()]).all()
    assert seen["miscue"] >= 2
