"""When a second hit begins: where the tip comes back, and only inside its window (property)."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from cuefem import Outcome, SecondHit, strike
from cuefem.contact.outcome import hits
from tests.contact.test_independent_effects import AT, Draw, hit_again


def starts(outcome: Outcome) -> list[float]:
    """When each contact after the first began, s."""
    return [phase.end for phase in outcome.phases if phase.press == "free" and phase.end < outcome.duration]


def parted(outcome: Outcome) -> float:
    """The first separation, s."""
    return next((float(phase.start) for phase in outcome.phases if phase.press == "free"), outcome.duration)


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
