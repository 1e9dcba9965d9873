"""End masses at the default resolution, against many modes (verification)."""

from dataclasses import replace

import matplotlib as mpl
import numpy as np
import pytest

from cuefem import Stroke, end_mass, usual_scene
from cuefem.endmass.definitions import definition_of
from cuefem.scene.solved_scene import MAX_MODES, corrected_tip_modes
from tests.helpers.cues import scene

mpl.use("Agg")
from studies.strokes import random_cue

MANY = 200  # modes of a reference


@pytest.mark.parametrize("number", [0, *(pytest.param(n, marks=pytest.mark.nightly) for n in range(1, 40))])
def test_end_mass_of_smooth_drive_with_default_modes_equals_many_modes(number: int) -> None:
    """Force: 0.5 % with drawn leather, whose modes are truncated (soft leather from 1 ms on); 0.1 % otherwise."""
    draw = np.random.default_rng([8, number])
    cue = random_cue(draw)
    E = cue.segments[0].material.E
    leather = E < 1e9
    pulse = scene(cue, 1e-3)
    (exact,) = corrected_tip_modes(pulse, MANY)
    shortest = 1e-3 if E < 150e6 else 0.5e-3
    for T in draw.uniform(shortest, 5e-3, 8):
        pulse = scene(cue, float(T))
        assert end_mass(pulse, "velocity") == pytest.approx(definition_of("velocity").of(exact, pulse), rel=5e-6)
        expected = definition_of("force").of(exact, pulse)
        assert end_mass(pulse, "force") == pytest.approx(expected, rel=5e-3 if leather else 1e-3)


@pytest.mark.nightly
def test_stick_end_mass_random_cues_has_stated_error() -> None:
    """95th percentile 0.1 %, maximum 0.2 %: leather, ferrules, tubes and bores, contacts of 0.5 to 3 ms."""
    draw, errors = np.random.default_rng(9), []
    for _ in range(60):
        pulse = scene(random_cue(draw), float(draw.uniform(0.5e-3, 3e-3)))
        exact = definition_of("stick").of(*corrected_tip_modes(pulse, MAX_MODES), pulse)
        errors.append(abs(end_mass(pulse) / exact - 1))
    assert np.quantile(errors, 0.95) < 1e-3
    assert max(errors) < 2e-3


@pytest.mark.heavy
def test_stick_end_mass_through_leather_with_modes_of_a_strike_equals_many_modes() -> None:
    """A compliant tip has no velocity step: the modes of a strike are enough for 0.05 %."""
    draw = np.random.default_rng(10)
    for _ in range(10):
        struck = usual_scene(random_cue(draw))
        struck = replace(struck, stroke=Stroke(speed=draw.uniform(1, 6), offset=draw.uniform(0.05, 0.5)))
        modes = corrected_tip_modes(struck, MAX_MODES)
        for drive in ("stick", "offset"):
            assert end_mass(struck, drive) == pytest.approx(definition_of(drive).of(*modes, struck), rel=5e-4)
