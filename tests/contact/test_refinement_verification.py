"""Truncation correction against all modes, and error estimates of a refinement against references (verification)."""

import numpy as np
import pytest

import cuefem as cf
from cuefem.beam.assembly import assemble
from cuefem.beam.modes import Modes, solve
from cuefem.contact.refinement import refinement_levels
from cuefem.contact.strike import strike_modes
from cuefem.endmass.definitions import definition_of
from cuefem.scene.solved_scene import has_moment_arm, tip_modes_from
from studies.strokes import NAMES
from tests.helpers.accuracy_scenes import family, scene


def all_modes(scene: cf.Scene, count: int) -> Modes:
    """All modes of a mesh for ``count`` modes."""
    system = assemble(scene.shaft, count, scene.cue_effects)
    return solve(system, system.size - system.rigid_basis.shape[1])


def checked_numbers(outcome: cf.Outcome) -> np.ndarray:
    return np.array([outcome.squirt, outcome.ball_speed, outcome.spin])


def reference(scene: cf.Scene, modes: int) -> np.ndarray:
    """Squirt, ball speed and spin from far more modes, on the mesh for twice as many."""
    system = assemble(scene.shaft, 2 * modes, scene.cue_effects)
    result = solve(system, modes, n_corrected=2 if has_moment_arm(scene) else 1)
    return checked_numbers(strike_modes(scene, tip_modes_from(result, scene), steps=3200))


def true_error(outcome: cf.Outcome, best: np.ndarray, scene: cf.Scene) -> float:
    size = np.maximum(np.abs(best), [0.01 * abs(scene.stroke.offset), 0, 0])
    return float((np.abs(checked_numbers(outcome) - best) / size).max())


def moment(result: Modes, power: int, *, past: int) -> np.ndarray:
    """Sum of [w, theta][w, theta]' / (omega^2 + shift)^power over the modes from number ``past`` on."""
    rows = result.participation[:, past:] / (result.omega[past:] ** 2 + result.system.shift) ** (power / 2)
    return np.asarray(rows @ rows.T)


@pytest.mark.parametrize("name", NAMES)
@pytest.mark.parametrize("effects", [(), (cf.Support(0.2, stiffness=np.inf),), (cf.Joint(0.3, 1e-3),)], ids=str)
def test_truncation_correction_conserves_moments_of_truncated_modes(name: str, effects: tuple) -> None:
    """Two Lanczos steps conserve four moments; with a force alone, those of the deflection."""
    whole = all_modes(scene(name, 1e-3, 0.3, effects=effects), 40)
    for loads in (2, 1):
        corrected, part = solve(whole.system, 20, n_corrected=loads), slice(loads)
        assert len(corrected.omega) == 20 + 2 * loads
        for power in (1, 2, 3, 4):
            computed, expected = (moment(each, power, past=20)[part, part] for each in (corrected, whole))
            scale = np.sqrt(np.outer(expected.diagonal(), expected.diagonal()))
            np.testing.assert_allclose(computed / scale, expected / scale, rtol=0, atol=1e-7)


def test_end_mass_to_rtol_equals_many_modes() -> None:
    here = scene("kim", 1e-3, 0.3)
    tip = tip_modes_from(solve(assemble(here.shaft, 140), 130, n_corrected=1), here)
    for drive in ("stick", "velocity", "force"):
        assert cf.end_mass(here, drive, rtol=1e-3) == pytest.approx(definition_of(drive).of(tip, here), rel=1e-3)


@pytest.mark.heavy
@pytest.mark.parametrize("number", [*range(0, 40, 9), 25])
def test_refinement_levels_error_estimate_bounds_true_error(number: int) -> None:
    """The tolerance includes the difference of two references."""
    here = family()[number]
    best, rougher = reference(here, 300), reference(here, 230)
    known = float((np.abs(rougher - best) / np.abs(best)).max())
    for level in refinement_levels(here, 1e-4):
        assert true_error(level.outcome, best, here) <= 2 * level.error + known
        if level.modes > 200:
            break
