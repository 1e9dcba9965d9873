"""Symmetry, monotony, broadcasting and refusals of the closed forms."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from cuefem import squirt

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
@given(st.floats(-0.9, 0.9), st.floats(1e-6, 10.0), st.floats(0.1, 100.0), st.floats(0, 1))
def test_the_squirt_tangent_is_the_papers_phi_less_theta(offset, end, cue, e):
    ratios = {"cue_mass_ratio": cue, "end_mass_ratio": end}
    beta = squirt.lumped(offset, **ratios)
    theta = np.arctan(squirt.leaving_tangent(beta, offset, restitution=e, factor=1.2))
    psi = np.arctan(squirt.squirt_tangent(offset, restitution=e, factor=1.2, **ratios))
    assert np.arcsin(offset) - theta == pytest.approx(psi, abs=1e-13)


@MANY
@given(st.floats(0.01, 3.0), st.floats(0.05, 50), st.floats(1e-4, 50), st.floats(0, 1))
def test_more_friction_moves_the_miscue_outwards(friction, cue, end, e):
    ratios = {"cue_mass_ratio": cue, "end_mass_ratio": end, "restitution": e}
    near, far = squirt.miscue_offset([friction, friction * 1.01], **ratios)
    assert 0 < near < far < 1


def test_everything_broadcasts():
    offset, end = np.linspace(-0.5, 0.5, 5)[:, None], np.array([1e-3, 3e-3, 0.01])
    form = squirt.closed_form(offset, mass=0.54, end_mass=end)
    assert form.squirt.shape == form.spin.shape == form.cue_speed.shape == (5, 3)
    assert form.velocity.shape == (5, 3, 2)
    one = squirt.closed_form(0.25, mass=0.54, end_mass=0.01)
    assert one.squirt == form.squirt[3, 2]
    assert squirt.miscue_offset(np.full((2, 1), 0.5), cue_mass_ratio=2.0, end_mass_ratio=end).shape == (2, 3)
    assert squirt.natural_pivot_length(0.3, np.array([0.01, 0.02]), radius=0.03).shape == (2,)
