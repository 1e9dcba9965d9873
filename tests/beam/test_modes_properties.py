"""Modes and end masses of random shafts: change of units, monotony in stiffness and mass (properties)."""

from __future__ import annotations

import re
from dataclasses import replace
from math import nan

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from cuefem import Ball, Cue, Material, Resolution, Scene, Segment, Tip, end_mass, modes
from tests.helpers.cues import kim, scaled
from tests.helpers.examples import examples

WOOD, SOFT, STIFF = Material(12e9, 0.8e9, 700.0), Material(0.1e9, 0.036e9, 1000.0), Material(200e9, 77e9, 7850.0)
AT = Resolution(2, 8, 10)


@st.composite
def cues(draw: st.DrawFn) -> Cue:
    """One to four segments of 4 mm to 40 cm, 8 to 30 mm in diameter, some bored, of wood, leather or steel.

    kappa is set, because its default depends on E/G.
    """
    pieces = []
    for _ in range(draw(st.integers(1, 4))):
        first, last = draw(st.floats(0.008, 0.03)), draw(st.floats(0.008, 0.03))
        bore = draw(st.sampled_from([0.0, 0.6])) * min(first, last)
        material = draw(st.sampled_from([WOOD, WOOD, SOFT, STIFF]))
        pieces.append(Segment(draw(st.floats(0.004, 0.4)), first, last, material, bore, bore, kappa=0.8))
    return Cue(tuple(pieces), draw(st.floats(0.0, 0.6)))


factors = st.floats(0.05, 20.0)
drives = st.sampled_from(["force", "velocity", "stick"])


def inverse_end_mass(scene: Scene, drive: str) -> float:
    """1/kg; nan where soft leather drives the tip back before the contact ends, or no end mass has the squirt."""
    try:
        return 1 / end_mass(scene, drive, AT)
    except ValueError as error:
        if not re.search("must move with the impulse|no end mass has it", str(error)):
            raise
        return nan


@given(cues(), drives, factors, factors, factors)
@examples(20)
def test_modes_and_end_mass_scaled_units_scale(cue: Cue, drive: str, length: float, time: float, mass: float) -> None:
    """Units of length, time, mass a, b, c times smaller: E and G c/(a b^2), rho c/a^3, frequency 1/b, w 1/sqrt(c)."""
    stiff, heavy = mass / (length * time**2), mass / length**3
    other = replace(scaled(cue, E=stiff, G=stiff, rho=heavy, length=length), body_mass=cue.body_mass * mass)
    original, result = modes(cue, 5, at=AT), modes(other, 5, at=AT)
    np.testing.assert_allclose(result.frequencies * time, original.frequencies, rtol=1e-8)
    shape = original.shape(0.0)
    np.testing.assert_allclose(result.shape(0.0)[0] * mass**0.5, shape[0], rtol=1e-5)
    np.testing.assert_allclose(
        result.shape(0.0)[1] * mass**0.5 * length, shape[1], rtol=1e-4, atol=1e-6 * abs(shape[1]).max()
    )
    one = inverse_end_mass(Scene(cue, tip=Tip(contact_time=1e-3)), drive)
    two = inverse_end_mass(Scene(other, Ball(mass=0.21 * mass), Tip(contact_time=1e-3 * time)), drive)
    # as frequencies; soft ends have 1.1e-9 in 1,000 cues; a tip almost at rest has almost no inverse
    np.testing.assert_allclose(two * mass, one, rtol=1e-8, atol=1e-8 / cue.mass)


@given(cues(), st.floats(1.01, 4.0))
@examples(20)
def test_frequencies_rise_with_stiffness_and_fall_with_mass(cue: Cue, factor: float) -> None:
    """Rayleigh: a larger E lowers no frequency; a larger density divides all by its root."""
    original = modes(cue, 6, at=AT).frequencies
    stiff, heavy = (
        modes(scaled(cue, E=factor), 6, at=AT).frequencies,
        modes(scaled(cue, rho=factor), 6, at=AT).frequencies,
    )
    assert np.all(stiff >= original * (1 - 1e-12))
    assert np.all(stiff <= original * factor**0.5 * (1 + 1e-12))
    rounding = 1e-11 * original[-1]  # of a low frequency: relative to the high ones of the same matrix
    np.testing.assert_allclose(heavy, original / factor**0.5, rtol=1e-11, atol=rounding)


def test_modes_show_a_table_in_a_notebook() -> None:
    found = modes(kim(), 3)
    text = found._repr_html_()
    assert text.count("<tr>") == 4
    rows = [f"<td>{mode}</td><td>{frequency:.2f}</td>" for mode, frequency in enumerate(found.frequencies, start=1)]
    assert [row in text for row in rows] == [True] * 3
