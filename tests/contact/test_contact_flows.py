"""Verification: what a phase does in one cell is scipy's exponential of its motion, for every kind of phase."""

import math
from dataclasses import replace

import numpy as np
import pytest
import scipy.linalg as la
from cuefem.contact.kinds import contact_of
from cuefem.contact.linear import Exact
from cuefem.contact.state import Laws

from cuefem import AxialWaves, PointMass, StructuralDamping, Support, TipDome, TipShear
from cuefem.tip_modes import tip_modes_of
from tests.helpers.strike_scenes import kim_scene

RNG = np.random.default_rng(3)
GRIPS, PRESSES = ("slip", "slip back", "stick"), ("load", "unload", "rigid")


def contact(*effects, friction=0.7) -> Exact:
    scene = replace(kim_scene(0.4), effects=effects)
    laws = Laws(math.asin(0.4), 0.21, 0.4, scene.stiffness, 0.75, friction, scene.contact_time, 1.0)
    return contact_of(scene, tip_modes_of(scene), laws)


def possible(here: Exact, grip: str, press: str) -> np.ndarray:
    """States that the phase can be in: stick holds v_t, a rigid tip v_n, unless a spring takes the patch along."""
    held = [here.contact.c_n] * (press == "rigid")
    held += [here.contact.c_t] * (grip == "stick" and "shear" not in here.contact.slots)
    z = RNG.normal(size=(len(here.contact.z), 4))
    basis = np.linalg.qr(np.array(held).T)[0] if held else np.zeros((len(z), 0))
    return z - basis @ (basis.T @ z)


@pytest.mark.parametrize("press", PRESSES)
@pytest.mark.parametrize("grip", GRIPS)
@pytest.mark.parametrize(
    "effects",
    [(), (TipShear(0.75),), (TipDome(0.0095),), (Support(0.2, dashpot=5.0), AxialWaves()), (PointMass(0.1, 0.01),)],
    ids=str,
)
def test_a_driven_motion_is_its_exponential(effects, grip, press):
    here = contact(*effects)
    flow, z = here.flow(grip, press), possible(here, grip, press)
    assert flow.few is not None
    exact = la.expm(flow.A * flow.step) @ z
    assert np.abs(flow.advance @ z - exact).max() < 1e-13 * np.abs(exact).max()


def test_many_dampers_take_the_exponential_of_a_matrix():
    here = contact(StructuralDamping(0.01))
    flow = here.flow("stick", "load")
    assert flow.few is None
    exact = la.expm(flow.A * flow.step)
    assert np.abs(flow.advance - exact).max() < 1e-13 * np.abs(exact).max()
