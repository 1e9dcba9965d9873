"""A strike with a tip of leather against numbers of others: a sketch of the same model, stepped in another way.

The sketch took the elasticity from a coarser mesh, stepped plainly at 0.8 us, lumped 0.7 g at the ferrule and kept 45
or 90 modes without a tail. Pool ball, leather of 6 mm, dome 9.5 mm, nu 0.4, e 0.73, mu 0.7.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from cuefem import Cue, Material, PointMass, Resolution, Segment, strike
from tests.helpers.accuracy_scenes import reference_cue
from tests.helpers.leather_scenes import LEATHER, leather_scene

MAPLE, HOLLOW = (reference_cue(name) for name in ("pool_maple", "pool_hollow"))
MAPLE, HOLLOW = (replace(cue, segments=cue.segments[1:]) for cue in (MAPLE, HOLLOW))


def degrees(*effects, offset: float = 0.375, cue: Cue = MAPLE, **more) -> float:
    """Squirt at the default resolution."""
    return float(np.degrees(strike(leather_scene(offset, *effects, cue=cue, **more)).squirt))


@pytest.mark.parametrize(("speed", "time"), [(1.0, 1.35), (2.0, 1.14), (5.0, 0.89)])
def test_contact_times_of_a_rigid_cue_of_567_g(speed: float, time: float) -> None:
    steel = Material(200e12, 80e12, 1000.0)
    rigid = Cue((Segment(0.3, 0.01275, 0.01275, steel),), body_mass=0.5)
    rigid = replace(rigid, body_mass=0.567 - rigid.shaft_mass - LEATHER.mass(0.01275))
    found = strike(leather_scene(0.0, speed=speed, cue=rigid), Resolution(1, 4, 2))
    assert 1e3 * found.duration == pytest.approx(time, rel=0.02)
    assert found.ball_speed == pytest.approx(speed * 1.73 * 0.567 / 0.737, rel=1e-6)


def test_squirt_and_contact_time_on_maple() -> None:
    found = strike(leather_scene(0.375, cue=MAPLE))
    assert np.degrees(found.squirt) == pytest.approx(2.411, rel=0.02)  # found 2.38: the patch's give is larger here
    assert 1e3 * found.duration == pytest.approx(1.199, rel=0.01)


def test_squirt_depends_little_on_speed_and_leather() -> None:
    speeds = [degrees(speed=speed) for speed in (0.8, 1.0, 2.0, 3.0, 5.0)]
    leathers = [degrees(leather=replace(LEATHER, E=E)) for E in (40e6, 70e6, 100e6, 200e6, 400e6)]
    for found in (speeds, leathers):
        assert max(found) / min(found) < 1.04
        assert np.mean(found) == pytest.approx(2.43, rel=0.02)


TOLD = {2: 1.56, 3: 1.44, 4: 1.30, 5: 1.16, 6: 0.97, 6.5: 0.90, 7: 0.87, 8: 0.96, 10: 1.07}


def test_eleven_grams_along_the_shaft() -> None:
    plain = degrees()
    for inches, told in TOLD.items():
        lump = PointMass(inches * 0.0254 - LEATHER.height, 0.011)
        assert degrees(lump) / plain == pytest.approx(told, abs=0.02), inches


def test_a_hollow_front_over_maple() -> None:
    maple = degrees(offset=0.453)
    for bore, told in ((6e-3, 0.79), (8.5e-3, 0.71)):
        pieces = (replace(s, tip_bore=bore, butt_bore=bore) if s.tip_bore else s for s in HOLLOW.segments)
        hollow = replace(HOLLOW, segments=tuple(pieces))
        assert degrees(offset=0.453, cue=hollow) / maple == pytest.approx(told, abs=0.015)


@pytest.mark.parametrize(("offset", "told"), [(0.2, 0.005), (0.45, 0.015)])
def test_what_the_spring_along_the_surface_loses(offset: float, told: float) -> None:
    energy = strike(leather_scene(offset, cue=MAPLE, e=1.0)).energy
    assert energy["tip shear"] / energy["initial"] == pytest.approx(told, abs=0.002)
