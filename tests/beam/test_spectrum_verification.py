"""Verification of the tip's spectrum: it is the modes and their tail, without the shapes."""

from __future__ import annotations

from typing import Any

import matplotlib as mpl
import numpy as np
import pytest

from cuefem import Support
from cuefem.beam.modes import solve
from cuefem.beam.spectrum import TipSpectrum, ended, reduced
from cuefem.beam.system import System, assemble
from cuefem.beam.tail import tail
from cuefem.effects import acting_on_cue
from tests.helpers.cues import kim, pool, soft_tip, stiff_ferrule

mpl.use("Agg")
from studies.strokes import random_cue

COUNT = 30


def drawn(number: int) -> Any:
    return random_cue(np.random.default_rng([7, number]))


CUES = {"kim": kim, "pool": pool, "soft tip": soft_tip, **{f"random {n}": (lambda n=n: drawn(n)) for n in range(8)}}


def beam(cue: Any, effects: Any = ()) -> System:
    return assemble(cue, elements=2, order=20, effects=acting_on_cue(effects), count=400)


@pytest.mark.parametrize("turning", [False, True])
@pytest.mark.parametrize("name", CUES)
def test_it_is_the_modes_and_their_tail(name: str, turning: bool) -> None:
    system = beam(CUES[name]())
    found, theirs = ended(system, COUNT, turning=turning)(COUNT), tail(solve(system, COUNT), turning=turning)
    np.testing.assert_allclose(found.omega, theirs.omega, rtol=2e-9)
    np.testing.assert_allclose(found.omega[:COUNT], theirs.omega[:COUNT], rtol=5e-11)
    assert found.highest == pytest.approx(theirs.highest, rel=1e-11)
    assert found.radiation is not None
    assert theirs.radiation is not None
    np.testing.assert_allclose(abs(found.radiation), abs(theirs.radiation), rtol=1e-7)
    for own, their in zip(found.at_tip, theirs.at_tip, strict=True):
        np.testing.assert_allclose(abs(own), abs(their), rtol=0, atol=1e-8 * abs(their).max())


@pytest.mark.parametrize(("cue", "effects"), [(stiff_ferrule(), ()), (kim(), (Support(0.3, np.inf),))])
def test_uneven_stiffness_and_clamps_take_the_shapes(cue: Any, effects: Any) -> None:
    """The rounding of K shows beside a steel ferrule of 1 mm: there the Rayleigh-Ritz step is taken."""
    system = beam(cue, effects)
    assert not isinstance(ended(system, COUNT, turning=False)(COUNT), TipSpectrum)
    if not effects:
        lowest = np.sqrt(reduced(system).squares[2])
        assert 5e-12 < abs(lowest / solve(system, 1).omega[0] - 1) < 1e-9
