"""Properties of the cue: what holds of every shaft that can be drawn."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from cuefem import Cue, Material, Segment
from tests.helpers.cues import scaled

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


cues = st.builds(Cue, st.lists(segments(), min_size=1, max_size=5), st.floats(0.0, 1.0))
places = st.floats(0.0, 1.0)


@settings(max_examples=30)
@given(cues, places, st.floats(0.01, 100), st.floats(0.01, 100))
def test_constants_enter_linearly(cue: Cue, place: float, stiffer: float, heavier: float) -> None:
    x = place * cue.length
    s, t = cue.section(x), scaled(cue, E=stiffer, G=stiffer, rho=heavier).section(x)
    np.testing.assert_allclose([t.EA, t.EI, t.kGA], np.multiply(stiffer, [s.EA, s.EI, s.kGA]), rtol=1e-12)
    np.testing.assert_allclose([t.rhoA, t.rhoI], np.multiply(heavier, [s.rhoA, s.rhoI]), rtol=1e-12)


@settings(max_examples=30)
@given(cues, places, st.floats(0.1, 10))
def test_sizes_enter_as_area_and_inertia(cue: Cue, place: float, larger: float) -> None:
    grown = scaled(cue, length=larger)
    x = min(place * cue.length * larger, grown.length)
    if np.min(np.abs(grown.nodes - x)) < 1e-9 * grown.length:  # rounding may take the other side of a jump
        return
    s, t = cue.section(place * cue.length), grown.section(x)
    for name, power in (("EA", 2), ("EI", 4), ("kGA", 2), ("rhoA", 2), ("rhoI", 4)):
        np.testing.assert_allclose(getattr(t, name), getattr(s, name) * larger**power, rtol=1e-9)
    np.testing.assert_allclose(grown.shaft_mass, cue.shaft_mass * larger**3, rtol=1e-12)


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
