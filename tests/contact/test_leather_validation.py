"""A strike with a tip of leather against numbers of others: of a sketch and of a chain, stepped in other ways.

The sketch (contact times) took the elasticity from a coarser mesh, stepped plainly at 0.8 us, lumped 0.7 g at the
ferrule and kept 45 modes without a tail. The chain of rigid links is geometrically exact and of its own. Pool ball,
leather of 6 mm, dome 9.5 mm, nu 0.4, e 0.73, mu 0.7.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from cuefem import AxialWaves, Cue, GeometricStiffness, Material, Resolution, Segment, strike
from tests.helpers.accuracy_scenes import reference_cue
from tests.helpers.leather_scenes import LEATHER, leather_scene

MAPLE = reference_cue("pool_maple")
MAPLE = replace(MAPLE, segments=MAPLE.segments[1:])


@pytest.mark.parametrize(("speed", "time"), [(1.0, 1.35), (2.0, 1.14), (5.0, 0.89)])
def test_contact_times_of_a_rigid_cue_of_567_g(speed: float, time: float) -> None:
    steel = Material(200e12, 80e12, 1000.0)
    rigid = Cue((Segment(0.3, 0.01275, 0.01275, steel),), body_mass=0.5)
    rigid = replace(rigid, body_mass=0.567 - rigid.shaft_mass - LEATHER.mass(0.01275))
    found = strike(leather_scene(0.0, speed=speed, cue=rigid), Resolution(1, 4, 2, 6400))
    assert 1e3 * found.duration == pytest.approx(time, rel=0.02)
    assert found.ball_speed == pytest.approx(speed * 1.73 * 0.567 / 0.737, rel=1e-6)


@pytest.mark.parametrize(("speed", "chain"), [(0.8, 2.30), (2.0, 2.32), (4.0, 2.33), (7.0, 2.31)])
def test_squirt_on_maple_is_that_of_an_exact_chain(speed: float, chain: float) -> None:
    """The whole stroke: rings that slip, waves along the cue, thrust on the bent shaft."""
    found = strike(leather_scene(0.375, AxialWaves(), GeometricStiffness(), cue=MAPLE, speed=speed))
    assert np.degrees(found.squirt) == pytest.approx(chain, rel=0.02)
