"""Designs of a stack that have no end mass: each says why, and the others have theirs (properties)."""

from __future__ import annotations

import numpy as np
import pytest

from cuefem import Ball, Cue, Material, Resolution, Scene, Segment, StructuralDamping, Tip, end_mass
from cuefem.design import Levels, Response, Study, Vary, evaluate
from cuefem.design.batch import BLOCK, CueBatch, batch_stick
from cuefem.design.study_result import found
from tests.helpers.cues import MAPLE

AT = Resolution(1, 24, 12)
LONG = Tip(contact_time=2e-3)
HARD = [12, 25, BLOCK + 2]


def light_shaft(mass: float) -> Cue:
    """A short, steep shaft of ash, without a body, of a mass in kg."""
    ash = Material(9e9, 0.64e9, 660.0)
    tip = np.sqrt(12 * mass / np.pi / 0.33 / ash.rho / (1 + 5.5 + 5.5**2))
    return Cue((Segment(0.33, tip, 5.5 * tip, ash),))


def stack() -> list[Cue]:
    """Whole cues, and among them bare shafts of 16, 21 and 27 g."""
    cues = [Cue((Segment(0.7, 0.012, 0.02, MAPLE),), m) for m in np.linspace(0.3, 0.5, BLOCK + 6)]
    for i, mass in zip(HARD, (0.016, 0.021, 0.027), strict=True):
        cues[i] = light_shaft(mass)
    return cues


@pytest.mark.parametrize("ended", [False, True])
def test_one_design_without_an_end_mass_does_not_stop_the_stack(ended: bool) -> None:
    cues = stack()
    scene = Scene(cues[0], Ball(0.17, 0.0286), LONG)
    found = batch_stick(CueBatch.of(cues), scene, at=AT, ended=ended)
    mass, squirt = found
    assert np.flatnonzero(np.isnan(mass)).tolist() == HARD
    assert np.all(np.isfinite(squirt))
    assert np.all(squirt[HARD] < 0)
    assert [i for i, reason in enumerate(found.reasons) if reason] == HARD
    assert all(f"the squirt is {squirt[i]:.4g} times phi, below that of any" in str(found.reasons[i]) for i in HARD)
    whole = [i for i in range(len(cues)) if i not in HARD]
    np.testing.assert_allclose(
        mass[whole], batch_stick(CueBatch.of([cues[i] for i in whole]), scene, at=AT, ended=ended)[0], rtol=1e-12
    )


def test_a_single_cue_says_the_same() -> None:
    with pytest.raises(ValueError, match=r"'stick': the squirt is -0\.\d+ times phi, below that of any end mass"):
        end_mass(Scene(light_shaft(0.021), Ball(0.17, 0.0286), LONG), at=AT)


def light(effects: tuple[StructuralDamping, ...] = ()) -> Study:
    """A cue, a bare shaft that is too light, and one that cannot be."""
    vary = Vary(("cue.body_mass",), Levels((0.4, 0.0, -1.0)))
    base = Scene(light_shaft(0.021), Ball(0.17, 0.0286), LONG, effects=effects)
    return Study(base, (vary,), tuple(map(Response.of, ("end_mass", "squirt_slope", "mass"))), at=AT)


@pytest.mark.parametrize("effects", [(), (StructuralDamping(),)], ids=["together", "one by one"])
def test_a_sweep_says_which_design_has_none_and_keeps_its_squirt(
    effects: tuple[StructuralDamping, ...],
) -> None:
    study = light(effects)
    heavy, alone, none = found(study).rows
    assert heavy.failure is None
    assert none.responses == (None, None, None)
    assert alone.responses[0] is None
    assert alone.responses[1] < 0
    assert alone.responses[2] == pytest.approx(0.021)
    assert alone.failure.startswith("end_mass: the squirt is -")


def test_who_asks_for_squirt_alone_has_it() -> None:
    scenes = [Scene(cue, Ball(0.17, 0.0286), LONG) for cue in stack()]
    found = evaluate(scenes, ["squirt_slope"], at=AT)
    assert found.reasons == (None,) * len(scenes)
    assert np.all(found.values[HARD] < 0)
