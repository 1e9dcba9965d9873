"""When a second hit begins: where the tip comes back, and only inside its window (property)."""

from __future__ import annotations

import math
from dataclasses import replace
from itertools import product

import numpy as np
import pytest

from cuefem import LumpedCue, Outcome, Scene, SecondHit, Stroke, Tip, strike
from cuefem.contact.outcome import hits
from cuefem.contact.strike import strike_modes
from tests.contact.test_independent_effects import AT, Draw, hit_again
from tests.helpers.strike_scenes import hand_made


def starts(outcome: Outcome) -> list[float]:
    """When each contact after the first began, s."""
    return [phase.end for phase in outcome.phases if phase.press == "free" and phase.end < outcome.duration]


def parted(outcome: Outcome) -> float:
    """The first separation, s."""
    return next((float(phase.start) for phase in outcome.phases if phase.press == "free"), outcome.duration)


def opens_and_closes(scene: Scene, outcome: Outcome) -> None:
    """The gap is the integral of the velocity at which ball and tip part, and no force acts until it has closed."""
    history = outcome.history
    step = float(scene.contact_time) / 400
    for phase in outcome.phases:
        if phase.press != "free" or phase.end == outcome.duration:
            continue
        here = (history.ends >= phase.start) & (history.ends <= phase.end)
        times, speed = history.ends[here], history.velocities[here, 1]
        gap = np.cumsum(np.diff(times) * (speed[1:] + speed[:-1]) / 2)
        middles = history.middles
        assert not history.forces[(middles > phase.start) & (middles < phase.end), 1].any()
        assert gap[:-1].min() > 0
        assert abs(gap[-1]) <= 1.01 * step * abs(speed).max()  # the tip touches within the flight's last step


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
        strike(replace(scene, effects=(*others, SecondHit(window))), AT) for window in (1.2 * wait, 0.8 * wait)
    )
    alone = strike(replace(scene, effects=others), AT)
    assert starts(just)[0] == again
    assert not starts(missed)
    assert missed.squirt == alone.squirt
    assert parted(missed) == alone.duration


def test_the_regime_is_that_of_the_first_touch() -> None:
    """Endless friction: the blow of a later touch may throw ball and tip apart, which is no miscue of the strike."""
    tip = hand_made([900.0, 4000.0, 12000.0], [12.0, -9.0, 15.0], mass=0.2, rigid=6.0)
    seen = 0
    for offset, e in product((0.1, 0.3, 0.5, 0.9), (0.05, 0.5, 1.0)):
        cue = LumpedCue(float(tip.approach @ tip.approach), 0.01)
        once = Scene(cue, tip=Tip(e, math.inf, 1e-3), stroke=Stroke(1.0, offset))
        again = strike_modes(replace(once, effects=(SecondHit(2e-2),)), tip)
        assert again.regime == strike_modes(once, tip).regime
        seen += again.phases[-1].grip == "blow" and len(again.phases) > 1
    assert seen
