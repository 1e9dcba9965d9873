"""A dead tip on a beam whose slowest mode takes hundreds of contact times: it rides it until that lets go, however
short the touch was; the shorter the touch, the less it matters (property)."""

from __future__ import annotations

from collections.abc import Callable
from itertools import pairwise

import pytest

from cuefem import (
    Ball,
    Cue,
    Material,
    Resolution,
    RollingContact,
    Scene,
    Segment,
    SideStrike,
    Striker,
    Stroke,
    Tip,
    side_strike,
    strike,
)

ROD = Cue((Segment(3.0, 0.006, 0.006, Material(12.6e9, 0.84e9, 700.0)),), body_mass=0.3)
AT = Resolution(1, 14, 8)


def tip_rides(time: float) -> float:
    """How long a dead tip that strikes far out stays on the ball, s."""
    return float(strike(Scene(ROD, tip=Tip(0.0, 0.7, contact_time=time), stroke=Stroke(1.0, 0.8)), AT).duration)


def striker_rides(time: float) -> float:
    """How long a dead striker stays on the end of the rod, s."""
    return side_strike(SideStrike(ROD, Striker(0.02, 0.0, contact_time=time)), AT).duration


@pytest.mark.parametrize("rides", [tip_rides, striker_rides])
def test_it_rides_as_long_however_short_the_touch(rides: Callable[[float], float]) -> None:
    times = (2e-4, 1e-4, 0.5e-4, 0.25e-4)
    lasted = [rides(time) for time in times]
    assert all(duration > 200 * time for duration, time in zip(lasted, times, strict=True))
    steps = [abs(a - b) for a, b in pairwise(lasted)]
    assert steps[0] < 1e-2 * lasted[0]
    assert steps[1] == pytest.approx(steps[0] / 2, rel=0.5)
    assert steps[2] == pytest.approx(steps[1] / 2, rel=0.5)


@pytest.mark.parametrize("friction", [0.0, 0.1])
@pytest.mark.parametrize("offset", [0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.8])
def test_it_rolls_in_long_steps(offset: float, friction: float) -> None:
    """What the contact rolls through turns the answer of cue and ball to its force: steps of another time mislead."""
    cue = Cue((Segment(0.74, 0.012, 0.021, Material(12.6e9, 0.84e9, 700.0)),), body_mass=0.31)
    tip, ball = Tip(0.0, friction, contact_time=6e-4), Ball(0.142, 0.02625)
    outcome = strike(Scene(cue, ball, tip, Stroke(4.0, offset), (RollingContact(),)), Resolution(2, 11, 10))
    assert outcome.duration > 1.3e-3
    assert 5 < len(outcome.history.start) < 50
