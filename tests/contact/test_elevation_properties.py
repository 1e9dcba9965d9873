"""What holds for every raised cue: energy, mirror, a ball that the table keeps up, refusals, files."""

from dataclasses import replace

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from cuefem import (
    Elevation,
    Stroke,
)
from cuefem.contact.strike import strike_modes
from tests.helpers.strike_scenes import FRICTION, OFFSET, hand_made, imbalance, kim_scene, numbers

VIBRATING = hand_made([500.0, 3000.0], [5.0, 8.0], rigid=9.0)
ANGLE = st.one_of(st.sampled_from([0.0, 1e-6, 0.03]), st.floats(0.001, 1.4))
TABLE = st.one_of(st.sampled_from([0.0, 0.2]), st.floats(0.01, 3.0))


@settings(max_examples=20)
@given(ANGLE, TABLE, OFFSET, st.floats(0.1, 1.0), FRICTION)
def test_energy_closes_and_the_other_side_mirrors(angle, table, offset, e, friction):
    scene = replace(kim_scene(offset, restitution=e, friction=friction), effects=(Elevation(angle, table),))
    outcome = strike_modes(scene, VIBRATING)
    assert np.all(np.isfinite(numbers(outcome)))
    assert imbalance(outcome) < 1e-10
    assert all(part >= -1e-10 * outcome.energy["initial"] for part in outcome.energy.values())
    assert outcome.phases[-1].end == outcome.duration
    assert outcome.history.velocity[2] > -1e-9
    other = strike_modes(replace(scene, stroke=Stroke(offset=-offset)), VIBRATING)
    mirrored = numbers(other)
    mirrored[[0, 1, 4, 6]] *= -1  # squirt, V_t, spin, impulse along t
    assert np.array_equal(numbers(outcome), mirrored)
    assert np.array_equal(outcome.history.velocity, other.history.velocity * [-1, 1, 1])
    assert np.array_equal(outcome.history.spin, other.history.spin * [1, -1, -1])
