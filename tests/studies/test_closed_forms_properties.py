"""Symmetry, monotony, broadcasting and refusals of the closed forms."""

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from studies.paper import closed_forms as squirt

OFFSET = st.floats(1e-4, 0.95)
STROKE = {
    "mass": st.floats(0.02, 20.0),
    "end_mass": st.floats(2e-7, 2.0),
    "restitution": st.floats(0, 1),
    "friction": st.floats(0.05, 3.0),
    "inertia": st.floats(0.1, 1.0),
}
MANY = settings(max_examples=200, deadline=None)


def holds(offset, stroke):
    return squirt.closed_form_holds(offset, **{k: v for k, v in stroke.items() if k != "restitution"})


@MANY
@given(OFFSET, st.fixed_dictionaries(STROKE))
def test_a_negative_offset_mirrors_exactly_and_it_refuses_exactly_where_it_does_not_hold(offset, stroke):
    assert holds(-offset, stroke) == holds(offset, stroke)
    if not holds(offset, stroke):
        with pytest.raises(ValueError, match=r"closed_form: (friction|slip) must"):
            squirt.closed_form(offset, **stroke)
        return
    right, left = squirt.closed_form(offset, **stroke), squirt.closed_form(-offset, **stroke)
    assert (left.squirt, left.spin, left.cue_speed) == (-right.squirt, -right.spin, right.cue_speed)
    assert tuple(left.velocity) == (-right.velocity[0], right.velocity[1])
    assert left.impulses == right.impulses._replace(tangential=-right.impulses.tangential)


@MANY
@given(st.floats(0.01, 3.0), st.floats(0.05, 50), st.floats(1e-4, 50), st.floats(0, 1))
def test_more_friction_moves_the_miscue_outwards(friction, cue, end, e):
    ratios = {"cue_mass_ratio": cue, "end_mass_ratio": end, "restitution": e}
    near, far = squirt.miscue_offset([friction, friction * 1.01], **ratios)
    assert 0 < near < far < 1
