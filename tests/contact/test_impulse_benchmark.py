"""How long a million strokes take, as a ratio to the closed form alone; run with --benchmark-enable, printed by -s.

Nothing is asserted about time: a busy machine is no failure.
"""

from statistics import median
from time import perf_counter

import numpy as np
import pytest

from cuefem import Ball, LumpedCue, Scene, Stroke, Tip, impulse, squirt

STROKES = 1_000_000


@pytest.fixture(scope="module")
def scene() -> Scene:
    """Strokes of every regime, every field an array."""
    rng = np.random.default_rng(1)
    M = rng.uniform(0.16, 0.22, STROKES)
    cue = LumpedCue(M * rng.uniform(0.3, 4, STROKES), M * 10 ** rng.uniform(-3, 1, STROKES))
    tip = Tip(rng.uniform(0, 1, STROKES), rng.uniform(0, 1.2, STROKES))
    return Scene(cue, Ball(M), tip, Stroke(rng.uniform(0.5, 5, STROKES), rng.uniform(-0.7, 0.7, STROKES)))


@pytest.fixture(scope="module")
def gentle() -> Scene:
    """Strokes that stick in compression, so that the closed form holds for all of them."""
    rng = np.random.default_rng(2)
    cue = LumpedCue(0.54, 0.21 * 10 ** rng.uniform(-4, -2, STROKES))
    return Scene(cue, Ball(), Tip(0.75, rng.uniform(0.7, 1.2, STROKES)), Stroke(2.0, rng.uniform(-0.5, 0.5, STROKES)))


def closed(scene: Scene):
    cue, ball, tip = scene.cue, scene.ball, scene.tip
    masses = {"mass": cue.mass, "end_mass": cue.end_mass, "ball_mass": ball.mass, "inertia": ball.inertia}
    return squirt.closed_form(scene.stroke.offset, **masses, restitution=tip.restitution, friction=tip.friction)


def bare(scene: Scene):
    """The closed form of the squirt without any check: the least that numpy can do."""
    offset, M = np.abs(scene.stroke.offset), scene.ball.mass
    ratios = {"cue_mass_ratio": scene.cue.mass / M, "end_mass_ratio": scene.cue.end_mass / M}
    beta = squirt.lumped(offset, **ratios)
    factor = squirt.restitution_factor(beta, offset, scene.tip.friction)
    return np.arctan(squirt.squirt_tangent(offset, **ratios, restitution=scene.tip.restitution, factor=factor))


def test_a_million_strokes_of_every_regime(benchmark, scene):
    out = benchmark.pedantic(impulse, args=(scene,), rounds=5, warmup_rounds=1)
    assert np.all(np.isfinite(out.squirt))
    assert set(np.unique(out.regime)) == {"stick", "late stick", "miscue", "slip reversal"}


def test_a_million_strokes_by_the_closed_form(benchmark, gentle):
    form = benchmark.pedantic(closed, args=(gentle,), rounds=5, warmup_rounds=1)
    np.testing.assert_allclose(impulse(gentle).squirt, form.squirt, rtol=1e-12, atol=0)


def test_the_ratio_to_the_closed_form_is_printed(scene, gentle, request):
    rounds = 5 if request.config.getoption("--benchmark-enable") else 1

    def seconds(work, strokes):
        times = []
        for _ in range(rounds):
            start = perf_counter()
            work(strokes)
            times.append(perf_counter() - start)
        return median(times)

    solver, every = seconds(impulse, gentle), seconds(impulse, scene)
    form, least = seconds(closed, gentle), seconds(bare, gentle)
    print(
        f"\na million strokes: {solver:.3f} s where the closed form holds, {every:.3f} s in every regime; closed form "
        f"{form:.3f} s, its squirt alone {least:.3f} s: ratios {solver / form:.2f} and {solver / least:.2f}"
    )
