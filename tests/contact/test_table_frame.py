"""Strokes in the table's frame: directions, signs and magnitudes (properties)."""

from math import cos, pi, sin

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

import cuefem as cf
from cuefem.contact.table_frame import offset_of
from tests.helpers.examples import examples

BALL = cf.Ball(0.17, 0.0286)
R = BALL.radius
INSIDE = st.tuples(st.floats(0, 0.95), st.floats(0, 2 * pi)).map(
    lambda polar: (R * polar[0] * cos(polar[1]), R + R * polar[0] * sin(polar[1]))
)


@examples(60)
@given(INSIDE, st.floats(0, 2 * pi), st.floats(0, 1.2), st.floats(0.1, 10))
def test_place_any_stroke_preserves_angles_and_magnitudes(point, heading, elevation, length):
    direction = length * np.array([cos(elevation) * sin(heading), cos(elevation) * cos(heading), -sin(elevation)])
    unit = direction / length
    contact = contact_of(point, unit)
    assume(contact @ unit < -0.05 * R)
    b = np.linalg.norm(np.cross(contact, unit))
    offset = offset_of(point, direction, ball=BALL)
    outcome = cf.impulse(cf.Scene(cf.LumpedCue(0.54, 0.004), BALL, cf.Tip(0.75, 0.7), cf.Stroke(2.0, offset)))
    placed = cf.place(outcome, point, direction, ball=BALL)
    assert offset == pytest.approx(b / R, rel=1e-12, abs=1e-14)
    V, spin = placed.velocity, placed.spin
    assert np.linalg.norm(V) == pytest.approx(outcome.ball_speed, rel=1e-14)
    assert np.linalg.norm(spin) == pytest.approx(abs(outcome.spin), rel=1e-12, abs=1e-12)
    assert np.arctan2(np.linalg.norm(np.cross(unit, V)), unit @ V) == pytest.approx(abs(outcome.squirt), abs=1e-14)
    # all in one plane, the spin across it along R_I x u, the squirt away from the struck side
    assert abs(spin @ V) < 1e-13 * np.linalg.norm(spin) * np.linalg.norm(V) + 1e-15
    assert abs(spin @ contact) < 1e-13 * np.linalg.norm(spin) * R + 1e-15
    beside = contact - (contact @ unit) * unit
    assert V @ beside <= 1e-16
    assert spin @ np.cross(contact, unit) >= -1e-16 * np.linalg.norm(spin)
    # Newton: the impulse that makes V, at the contact, makes the spin
    torque = np.cross(contact, BALL.mass * V)
    np.testing.assert_allclose(spin, torque / (0.4 * BALL.mass * R**2), rtol=0, atol=1e-12 * outcome.ball_speed / R)


def contact_of(point, unit):
    """R_I of a point (h, l), from right and forward vectors of the level cue."""
    right = np.cross(unit, [0, 0, 1])
    right = right / np.linalg.norm(right)
    forward = np.cross([0, 0, 1], right)
    h, up = point[0], point[1] - R
    return h * right + up * np.array([0, 0, 1]) - np.sqrt(max(R**2 - h**2 - up**2, 0)) * forward
