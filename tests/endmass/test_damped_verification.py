"""Prescribed drives on modes that radiate, against scipy's exponential of the whole motion (verification)."""

from __future__ import annotations

from dataclasses import replace

import matplotlib as mpl
import numpy as np
import pytest

import cuefem as cf
from cuefem.endmass import damped, poles
from cuefem.endmass.undamped import StickLimit
from cuefem.tip_modes import Solved
from tests.helpers.cues import kim, scene

mpl.use("Agg")
from studies.strokes import random_cue


@pytest.mark.parametrize("effects", [(), (cf.StructuralDamping(0.02),), (cf.PointMass(0.3, 0.01),)])
@pytest.mark.parametrize("restitution", [0.0, 0.75, 1.0])
def test_the_rates_of_the_held_tip_are_the_motion_in_time(restitution: float, effects: tuple[cf.Effect, ...]) -> None:
    """The closed forms agree with matrix exponentials, and the rates with a dense eigenproblem."""
    for number in range(6):
        cue = random_cue(np.random.default_rng([9, number]))
        found = replace(scene(cue, 0.6e-3 + 0.4e-3 * number), effects=effects)
        found = replace(found, tip=replace(found.tip, restitution=restitution))
        tip, limit = Solved(found).tip, StickLimit.of(found)
        exact = damped.stick_impulse_in_time(tip, limit)
        assert damped.stick_impulse(tip, limit) == pytest.approx(exact, rel=1e-11)
        held = poles.held_tip(tip, limit.c)
        assert held is not None
        A, row = damped._motion(tip)
        rates = np.linalg.eigvals(A - np.outer(row, row @ A) / (row @ row + limit.c))
        rates = rates[rates.imag > 1.0]
        rates, own = rates[np.argsort(rates.imag)], held.rates[np.argsort(held.rates.imag)]
        np.testing.assert_allclose(own, rates, rtol=0, atol=1e-12 * np.abs(rates).max())


def test_all_offsets_at_once_are_each_alone() -> None:
    found = replace(scene(kim(), 1e-3), effects=(cf.StructuralDamping(0.02),))
    offsets = np.array([[0.0, 0.1], [0.3, -0.45]])
    together = cf.end_mass(replace(found, stroke=cf.Stroke(1.0, offsets)), "offset")
    for place, b in np.ndenumerate(offsets):
        alone = cf.end_mass(replace(found, stroke=cf.Stroke(1.0, float(b))), "offset")
        assert together[place] == pytest.approx(alone, rel=1e-13)
    lumps = replace(found, effects=(cf.Support(0.5, 1e4, 0.0, 5.0),), stroke=cf.Stroke(1.0, offsets))
    by_exponentials = cf.end_mass(lumps, "offset")
    one = cf.end_mass(replace(lumps, stroke=cf.Stroke(1.0, 0.1)), "offset")
    assert by_exponentials[0, 1] == pytest.approx(one, rel=1e-13)
