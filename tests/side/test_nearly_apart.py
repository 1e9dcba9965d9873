"""A contact from the side that nearly parts in its middle and goes on: parting there is its error (property)."""

from __future__ import annotations

import numpy as np
import pytest

from cuefem import SideOutcome, SideStrike, Striker, resolve_side_strike
from tests.helpers.cues import pool


def resolved(contact_time: float) -> SideOutcome:
    """A ball on a shaft, 20 cm behind its tip; the shorter the contact time, the nearer they part."""
    return resolve_side_strike(SideStrike(pool(), Striker(0.05, 0.9, contact_time=contact_time), 0.2), 0.5)


def dip(outcome: SideOutcome) -> tuple[float, float]:
    """The least force between the two pushes, over the greatest, and the impulse of the second push, N s."""
    time = np.linspace(0, outcome.duration, 20_001)
    force = outcome.history(time)["force_n"]
    inside = (time > 0.1 * outcome.duration) & (time < 0.9 * outcome.duration)
    low = int(np.argmin(np.where(inside, force, np.inf)))
    return float(force[low] / force.max()), float(np.trapezoid(force[low:], time[low:]))


@pytest.mark.parametrize("contact_time", [2.2332e-3, 2.2375e-3, 2.2425e-3])
def test_its_error_is_what_it_would_lack(contact_time: float) -> None:
    outcome = resolved(contact_time)
    least, second = dip(outcome)
    assert 1e-4 < least < 5e-3
    assert second > 0.2 * outcome.impulse
    assert outcome.error is not None
    assert second <= outcome.error * outcome.impulse < 1.0001 * second


def test_it_has_none_where_it_holds_well() -> None:
    outcome = resolved(2.2528e-3)
    assert 5e-3 < dip(outcome)[0] < 2e-2
    assert outcome.error is not None
    assert outcome.error < 1e-3


def test_a_touch_that_begins_and_ends_slowly_is_no_dip() -> None:
    """Hertz's force grows like t^(3/2): small at both ends of a contact, and large throughout its middle."""
    striker = Striker(0.005, 1.0, modulus=1e8, radius=0.02)
    outcome = resolve_side_strike(SideStrike(pool(), striker, 0.2), 0.5)
    time = np.linspace(0, outcome.duration, 1001)[1:-1]
    force = outcome.history(time)["force_n"]
    assert force[0] < 5e-3 * force.max()
    assert outcome.error is not None
    assert outcome.error < 2e-2
