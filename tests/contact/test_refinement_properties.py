"""Refinement to an accuracy: lumped cues, cost against accuracy, bounds of the work (properties)."""

from dataclasses import replace

import numpy as np
import pytest

import cuefem as cf
from cuefem.contact.refinement import MAX_STEPS, StrikeGrid, refinement_levels
from cuefem.scene.solved_scene import MAX_MODES
from tests.contact.test_step_convergence import random_lumped
from tests.helpers.accuracy_scenes import scene

KIM = scene("kim", 1e-3, 0.3)


@pytest.mark.filterwarnings("ignore::cuefem.PlausibilityWarning")
@pytest.mark.parametrize("seed", range(8))
def test_lumped_cue_to_rtol_agrees_with_impulse(seed: int) -> None:
    lumped = random_lumped(np.random.default_rng(seed))
    result, exact = cf.strike(lumped, rtol=1e-3), cf.impulse(lumped)
    assert result.error is not None
    assert result.error <= 1e-3
    assert abs(result.squirt - exact.squirt) <= 1e-3 * max(abs(exact.squirt), abs(lumped.stroke.angle))


def test_smaller_rtol_takes_more_modes_or_steps() -> None:
    levels = [list(refinement_levels(KIM, rtol))[-1] for rtol in (0.5, 1e-2, 1e-3, 3e-4)]
    work = [level.modes * level.steps for level in levels]
    assert work == sorted(work)
    assert work[-1] > work[0]
    assert all(level.error <= rtol for level, rtol in zip(levels, (0.5, 1e-2, 1e-3, 3e-4), strict=True))


def test_refinement_of_usual_stroke_solves_one_eigenproblem(monkeypatch: pytest.MonkeyPatch) -> None:
    solved = list[tuple[int, ...]]()
    original = StrikeGrid.__init__.__globals__["corrected_tip_modes"]

    def counted(here: cf.Scene, *counts: int) -> list:
        solved.append(counts)
        return original(here, *counts)

    monkeypatch.setattr("cuefem.contact.refinement.corrected_tip_modes", counted)
    assert cf.strike(cf.usual_scene(KIM.shaft), rtol=1e-3).error < 1e-3
    assert len(solved) == 1


@pytest.mark.heavy
def test_accuracy_beyond_the_finest_level_is_refused_in_one_line() -> None:
    """Infinite friction begins with an impulse, whose wave fronts no level has."""
    hard = replace(KIM, tip=replace(KIM.tip, friction=float("inf")))
    with pytest.raises(RuntimeError, match=r"^strike rtol must be above \S+ for this scene, .*; got 1e-12$") as caught:
        cf.strike(hard, rtol=1e-12)
    assert f"{MAX_MODES} modes" in str(caught.value) or f"{MAX_STEPS} steps" in str(caught.value)
    with pytest.raises(RuntimeError, match=r"^end_mass rtol must be above \S+ .* 400 modes; got 1e-12$"):
        cf.end_mass(KIM, "force", rtol=1e-12)
