"""Benchmarks of the calls that everything else repeats: how long one warm call takes, on one thread.

The ordinary run only checks the answers. Numbers are printed by

    OMP_NUM_THREADS=1 OPENBLAS_NUM_THREADS=1 python -m pytest -n 0 --benchmark-enable tests/test_benchmark.py

(one thread: small dense solves on two may spike a hundredfold on a busy machine). No test asserts a time.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from cues import kim, pool, scene
from strike_scenes import KIM_AT, kim_scene

from cuefem import Cue, Resolution, end_mass, modes, resolve, strike
from cuefem.endmass import stick
from cuefem.resolution import tip_modes_of
from cuefem.strike import strike_modes


def test_modes_of_kim(benchmark: Any) -> None:
    """One warm `modes` call, f1 to f5 to 1e-6 (they hold to 1e-9)."""
    cue = kim()
    fine = modes(cue, 5, at=Resolution(4, 16, 5)).frequencies
    found = benchmark(modes, cue, 5)
    np.testing.assert_allclose(found.frequencies, fine, rtol=1e-6)


def test_modes_near(benchmark: Any) -> None:
    cue = kim()
    lowest = modes(cue, 3).frequencies
    found = benchmark(lambda: modes(cue, 2, near=250.0))
    np.testing.assert_allclose(found.frequencies, lowest[:2], rtol=1e-6)


@pytest.mark.parametrize("cue", [kim(), pool()], ids=["kim", "pool"])
def test_stick_end_mass(benchmark: Any, cue: Cue) -> None:
    """`end_mass` at the resolution left out, the beam included."""
    found = benchmark(end_mass, scene(cue, 2e-3))
    np.testing.assert_allclose(found, end_mass(scene(cue, 2e-3), at=Resolution(4, 16, 100)), rtol=0.02)


def test_stick_end_mass_from_tip_modes(benchmark: Any) -> None:
    """The closed form alone, its eigenproblem of the modes kept included."""
    found = scene(kim(), 2e-3)
    tip = tip_modes_of(found)
    np.testing.assert_allclose(benchmark(stick, tip, found), end_mass(found), rtol=1e-12)


def test_the_contact_alone(benchmark: Any) -> None:
    """A strike of 22 modes that are known."""
    struck = kim_scene()
    tip = tip_modes_of(struck, KIM_AT)
    assert benchmark(strike_modes, struck, tip).squirt == strike(struck, KIM_AT).squirt


def test_a_strike_from_the_drawing_on(benchmark: Any) -> None:
    struck = kim_scene()
    np.testing.assert_allclose(benchmark(strike, struck).squirt, resolve(struck, 1e-3).squirt, rtol=4e-3)


@pytest.mark.parametrize("rtol", [1e-2, 1e-3])
def test_an_accuracy_asked_for(benchmark: Any, rtol: float) -> None:
    assert benchmark(resolve, kim_scene(), rtol).error <= rtol
