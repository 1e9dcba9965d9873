"""Properties of the cue: what holds of every shaft that can be drawn."""

from dataclasses import replace

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from cuefem import Material, Segment
from cuefem.cue import shear_coefficient

# From foam to steel; G of each stays below E/(2 nu).
materials = st.builds(
    lambda E, slack, rho, nu: Material(E, E / (2 * max(nu, 0.05)) / slack, rho, nu=nu),
    st.floats(1e7, 3e11),
    st.floats(1.01, 30),
    st.floats(50, 9000),
    st.floats(0.0, 0.5),
)


@st.composite
def segments(draw: st.DrawFn) -> Segment:
    tip, butt = draw(st.floats(0.004, 0.04)), draw(st.floats(0.004, 0.04))
    bores = (draw(st.floats(0.0, 0.95)) * tip, draw(st.floats(0.0, 0.95)) * butt)
    core = draw(st.none() | materials)
    return Segment(draw(st.floats(0.001, 1.5)), tip, butt, draw(materials), *bores, core=core)


places = st.floats(0.0, 1.0)


@given(segments())
def test_a_bore_takes_mass_and_a_core_gives_it_back(segment: Segment) -> None:
    bored = replace(segment, core=None)
    solid = replace(bored, tip_bore=0.0, butt_bore=0.0)
    filled = replace(segment, core=segment.material)
    assert bored.mass <= solid.mass * (1 + 1e-14)
    np.testing.assert_allclose(filled.mass, solid.mass, rtol=1e-12)
    np.testing.assert_allclose(filled.centre, solid.centre, rtol=1e-11)
    s, t = filled.section(0.3 * segment.length), solid.section(0.3 * segment.length)
    np.testing.assert_allclose([s.EA, s.EI, s.rhoA, s.rhoI], [t.EA, t.EI, t.rhoA, t.rhoI], rtol=1e-12)


@given(st.floats(0.0, 0.5), st.floats(0.0, 0.999))
def test_shear_coefficient_falls_with_the_bore(nu: float, bore_ratio: float) -> None:
    """From the solid circle's to the thin tube's (1 + nu)/(2 + nu), never outside."""
    kappa = shear_coefficient(nu, bore_ratio)
    assert (1 + nu) / (2 + nu) * (1 - 1e-12) <= kappa <= shear_coefficient(nu) * (1 + 1e-12)
