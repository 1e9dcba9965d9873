"""The contact of a whole tip of leather: its time head on, and what its surface loses."""

from __future__ import annotations

from dataclasses import replace
from math import inf

import numpy as np
import pytest
from scipy.integrate import quad

from cuefem import strike
from tests.helpers.leather_scenes import AT, LEATHER, leather_scene
from tests.helpers.orders import falls_with_the_step
from tests.oracle.ring_stepper import LEATHER as RELEASED
from tests.oracle.ring_stepper import struck_scene


@pytest.mark.parametrize("speed", [1.0, 2.0, 5.0])
def test_head_on_the_contact_time_is_that_of_the_law_by_quadrature(speed: float) -> None:
    scene = leather_scene(0.0, speed=speed)
    falls_with_the_step(lambda steps: abs(strike(scene, replace(AT, steps=steps)).duration / scene.contact_time - 1))
    law, mass = scene.tip_law(), scene.head_on_mass
    deepest, loading = law.blow(mass, speed)
    assert law.work(deepest) == pytest.approx(mass * speed**2 / 2, rel=1e-12)
    told = quad(  # depth = deepest (1 - s^2), so that the integrand stays finite
        lambda s: 2 * deepest * s / np.sqrt(2 * (law.work(deepest) - law.work(deepest * (1 - s**2))) / mass),
        1e-9,
        1,
        epsabs=0,
        epsrel=1e-9,
        limit=200,
    )[0]
    assert loading == pytest.approx(told, rel=1e-7)
    each = leather_scene(0.0).tip_law().blow(mass, np.array([speed, 2 * speed]))[1]
    assert each[0] == pytest.approx(loading, rel=1e-12)


@pytest.mark.parametrize("offset", [0.2, 0.375, 0.45])
def test_what_a_patch_loses_is_friction_unless_that_is_endless(offset: float) -> None:
    rubs, grips = (strike(leather_scene(offset, friction=mu), AT).energy for mu in (0.7, inf))
    assert rubs["friction loss"] > 1e-4 * rubs["initial"]
    assert abs(rubs["tip shear"]) < 1e-12 * rubs["initial"]
    assert abs(grips["friction loss"]) < 1e-12 * grips["initial"]
    assert 1e-4 < grips["tip shear"] / grips["initial"] < 0.03
    constant = strike(leather_scene(offset, e=1.0, leather=replace(LEATHER, shear=4e5)), AT).energy
    assert abs(constant["tip shear"]) < 1e-7 * constant["initial"]


def test_leather_that_keeps_a_little_of_its_work_along_the_surface() -> None:
    """On the maple shaft 0.95 and 0.9 are 5 and 10 % more squirt; next to no loss is next to nothing."""
    maple = {e: replace(RELEASED, surface_restitution=e) for e in (1, 1 - 1e-7, 0.95, 0.9)}
    told = {e: strike(struck_scene(leather=leather)) for e, leather in maple.items()}
    more = {e: each.squirt / told[1].squirt - 1 for e, each in told.items()}
    assert abs(more[1 - 1e-7]) < 1e-6
    assert more[0.95] == pytest.approx(0.049, abs=0.004)
    assert more[0.9] == pytest.approx(0.098, abs=0.008)
    assert [each.energy["tip shear"] for each in told.values()] == sorted(e.energy["tip shear"] for e in told.values())
