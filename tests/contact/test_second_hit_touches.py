"""When a second hit begins: where the tip comes back, and only inside its window (property)."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from cuefem import Outcome, Scene, SecondHit, strike
from cuefem.contact.outcome import hits
from tests.contact.test_independent_effects import AT, Draw, hit_again


def starts(outcome: Outcome) -> list[float]:
    """When each contact after the first began, s."""
    return [phase.end for phase in outcome.phases if phase.press == "free" and phase.end < outcome.duration]


def parted(outcome: Outcome) -> float:
    """The first separation, s."""
    return next((float(phase.start) for phase in outcome.phases if phase.press == "free"), outcome.duration)


def opens_and_closes(scene: Scene, outcome: Outcome) -> None:
    """The gap is the integral of the velocity at which ball and tip part, and no force acts until it has closed."""
    length = scene.stroke.speed * float(scene.contact_time)
    points, weights = np.polynomial.legendre.leggauss(8)
    for phase in outcome.phases:
        if phase.press != "free" or phase.end == outcome.duration:
            continue
        edges = np.linspace(phase.start, phase.end, 401)
        read = outcome.history(edges[:-1, None] + np.diff(edges)[:, None] * (1 + points) / 2)
        gap = np.cumsum(np.diff(edges) * (read["velocity_n"] @ weights) / 2)
        assert not read["force_n"].any()
        assert gap[:-1].min() > 0
        assert abs(gap[-1]) < 1e-7 * length


@pytest.mark.parametrize("seed", [1, 6, 20, 24])
def test_the_window_counts_from_the_first_separation(seed: int) -> None:
    scene = hit_again(Draw(seed))
    others = tuple(effect for effect in scene.effects if not isinstance(effect, SecondHit))
    outcome = strike(scene, AT)
    again, first = starts(outcome)[0], parted(outcome)
    touches = hits(outcome)
    assert [hit.start for hit in touches] == [0.0, *starts(outcome)]
    assert (touches[0].end, touches[-1].end) == (first, outcome.duration)
    pushed = np.sum([hit.impulse for hit in touches], axis=0)
    assert pushed == pytest.approx(outcome.impulse, rel=1e-12)
    opens_and_closes(scene, outcome)
    wait = again - first
    assert wait > 0
    just, missed = (
        strike(replace(scene, effects=(*others, SecondHit(window))), AT) for window in (1.0001 * wait, 0.9999 * wait)
    )
    alone = strike(replace(scene, effects=others), AT)
    assert starts(just)[0] == pytest.approx(again, rel=1e-9)
    assert not starts(missed)
    assert missed.squirt == pytest.approx(alone.squirt, rel=1e-9)
    assert parted(missed) == pytest.approx(float(alone.duration), rel=1e-9)
