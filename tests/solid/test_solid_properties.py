"""Solid cues: strike, mass on the tip, modes, invalid input (properties)."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import cuefem as cf
from cuefem.solid.shaft import SolidBody
from tests.helpers.invalid_input import assert_calls_refused

WOOD = cf.Material(E=12.6e9, G=1.1e9, rho=700.0, nu=0.45, transverse_ratio=0.0985, nu_transverse=0.52)
CONE = cf.Segment(0.7, 0.012, 0.021, WOOD)
SCENE = cf.Scene(cf.Cue((CONE,), body_mass=0.42), tip=cf.Tip(contact_time=1e-3), stroke=cf.Stroke(offset=0.3))
COARSE = cf.Solid(order=3, modes=20)


def test_strike_point_mass_on_solid_agrees_with_beam() -> None:
    weighted = replace(SCENE, effects=(cf.PointMass(position=0.0, mass=2e-3),))
    beam, solid = (
        cf.strike(weighted, at=at).squirt / cf.strike(SCENE, at=at).squirt for at in (cf.Resolution(3, 16, 20), COARSE)
    )
    assert solid == pytest.approx(beam, rel=2e-3)


def test_solid_modes_agree_with_beam() -> None:
    beam, solid = cf.modes(SCENE.cue, 4), cf.solid_modes(SCENE.cue, 4)
    assert solid.rigid == beam.rigid == 2
    np.testing.assert_allclose(solid.frequencies, beam.frequencies, rtol=2e-4)
    for motion, expected in zip(solid.at_tip, beam.at_tip, strict=True):
        np.testing.assert_allclose(motion[2:], expected[2:], rtol=2e-3)
    assert np.sum(solid.at_tip[0][:2] ** 2) == pytest.approx(np.sum(beam.at_tip[0][:2] ** 2), rel=1e-9)


BORES = (0.004, 0.0119999999)  # one within the other
CROSSING = cf.Cue(tuple(cf.Segment(0.1, 0.012, 0.012, WOOD, bore, bore) for bore in BORES))
FINE = tuple(cf.Segment(0.002, 0.012, 0.013, WOOD) for _ in range(300))


def test_solid_invalid_input_raises_before_assembly(
    monkeypatch: pytest.MonkeyPatch, request: pytest.FixtureRequest
) -> None:
    """Input is checked before assembly, which takes seconds."""
    monkeypatch.setattr(SolidBody, "matrices", property(lambda body: pytest.fail("a solid was assembled")))
    assert_calls_refused("solid", globals(), request)
