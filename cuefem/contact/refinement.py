"""Refinement of modes and of steps to a requested accuracy, by the levels of each that are solved already.

The error of a level is its difference from the previous ones: a LeatherTip converges steeply in both, so that one
previous level bounds it; with a spring tip two levels may agree by chance, and the two previous ones count. The first
level with an error and smaller ones share an eigenproblem, and strikes of the same modes share the cue's propagator.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from cuefem.beam.blas_threads import one_blas_thread
from cuefem.beam.tip_modes import TipModes, lumped_tip_modes
from cuefem.contact.contact_model import ContactModel, model_of
from cuefem.contact.step_records import solve_contact
from cuefem.cue import Array
from cuefem.quantity.fields import Quantity
from cuefem.scene import Outcome, Scene
from cuefem.scene.solved_scene import MAX_MODES, corrected_tip_modes, strike_mode_count

# Modes from one level to the next; the first level with an error has the default number. The last level is MAX_MODES,
# at least MIN_LAST times as many as the one before.
MODES_RATIO, MIN_LAST = 2**0.5, 1.2
# The levels of steps begin with this part of the default number, and double up to MAX_STEPS in a contact time.
FIRST_STEPS, MAX_STEPS = 1 / 4, 51_200
# Strikes with different modes are compared at half the default number of steps.
COMPARED_STEPS = 1
# Squirt errors are relative to max(|squirt|, MIN_SQUIRT |sin phi| rad), since squirt may vanish.
MIN_SQUIRT = 0.01

RTOL = Quantity("", "(0, 1)")


class Level(NamedTuple):
    """One level of refinement: modes (0 of a lumped cue), steps, outcome, and its estimated relative error."""

    modes: int
    steps: int
    outcome: Outcome
    error: float


def check_one_resolution(name: str, at: object) -> None:
    """ValueError unless ``at`` is None, beside an rtol."""
    if at is not None:
        raise ValueError(f"{name} must be given at or rtol, not both; got {at!r}")


def refined_strike(scene: Scene, rtol: float) -> Outcome:
    """Outcome at the first level whose error is within ``rtol``; RuntimeError if no level has such an error."""
    rtol = RTOL.check("strike rtol", rtol)
    *_, last = refinement_levels(scene, rtol)
    if last.error > rtol:
        raise not_reached("strike", rtol, last.error, f"{last.modes} modes and {last.steps} steps")
    return replace(last.outcome, error=last.error)


def refined_end_mass(formula: Callable[[TipModes], float], scene: Scene, rtol: float) -> float:
    """End mass by a formula, kg, at the first number of modes that is within ``rtol``; RuntimeError if none is."""
    rtol = RTOL.check("end_mass rtol", rtol)
    ladder = ModeLadder(scene)
    masses = [formula(ladder.tip(i)) for i in range(ladder.start)]
    error = math.inf
    for i in range(ladder.start, len(ladder.counts)):
        masses.append(formula(ladder.tip(i)))
        error = max((abs(mass / masses[-1] - 1) for mass in masses[-1 - ladder.compared : -1]), default=0.0)
        if error <= rtol:
            return masses[-1]
    raise not_reached("end_mass", rtol, error, f"{ladder.counts[-1]} modes")


def not_reached(name: str, rtol: float, error: float, finest: str) -> RuntimeError:
    """The exception for an accuracy that the finest level does not have."""
    return RuntimeError(f"{name} rtol must be above {error:.2g} for this scene, the error with {finest}; got {rtol:g}")


def refinement_levels(scene: Scene, rtol: float, *, max_modes: int = MAX_MODES) -> Iterator[Level]:
    """Strikes at the levels up to the first whose error is within ``rtol``, or the finest one.

    Each level refines what contributes more to the error of the previous one: 1.4 times the modes, or twice the steps.
    """
    grid = StrikeGrid(scene, max_modes)
    i, j = grid.ladder.start, grid.ladder.compared
    while i < len(grid.ladder.counts) and j < len(grid.steps):
        from_modes, from_steps = grid.error_of_modes(i), grid.error_of_steps(i, j)
        level = Level(grid.ladder.counts[i], grid.steps[j], grid.outcome(i, j), from_modes + from_steps)
        yield level
        if level.error <= rtol:
            return
        if from_steps >= from_modes:
            j += 1
        else:
            i += 1


class ModeLadder:
    """Ascending numbers of modes of a scene's cue, and the tip modes of each; a lumped cue has one, 0.

    compared: how many previous levels bound the error of a level. start: the first level that has an error.
    """

    def __init__(self, scene: Scene, max_modes: int = MAX_MODES) -> None:
        self.scene = scene
        self.compared = 2 if scene.contact_terms.tip is None else 1
        self._tips: dict[int, TipModes] = {}
        if scene.lumped is not None:
            self.counts, self.start = [0], 0
            self._tips[0] = lumped_tip_modes(scene.lumped)
            return
        first, self.start = strike_mode_count(scene), self.compared
        counts = [round(first * MODES_RATIO**k) for k in range(-self.start, 20)]
        rising = [*(count for count in counts if MIN_LAST * count <= MAX_MODES), MAX_MODES]
        self.counts = [count for k, count in enumerate(rising) if k <= self.start or count <= max_modes]

    def tip(self, i: int) -> TipModes:
        """The tip modes of level i; the levels up to the start share one eigenproblem, and so do any two above it."""
        if i not in self._tips:
            levels = range(self.start + 1) if i <= self.start else range(i, min(i + 2, len(self.counts)))
            tips = corrected_tip_modes(self.scene, *(self.counts[k] for k in levels))
            self._tips |= dict(zip(levels, tips, strict=True))
        return self._tips[i]


class StrikeGrid:
    """Strikes of a scene by level of modes and level of steps, each solved once."""

    def __init__(self, scene: Scene, max_modes: int) -> None:
        self.scene, self.ladder = scene, ModeLadder(scene, max_modes)
        self._models: dict[int, ContactModel] = {}
        self._outcomes: dict[tuple[int, int], Outcome] = {}
        first = round(FIRST_STEPS * self._model(self.ladder.start).steps)
        self.steps = [first * 2**k for k in range(64) if first * 2**k <= MAX_STEPS]

    def _model(self, i: int) -> ContactModel:
        if i not in self._models:
            self._models[i] = model_of(self.scene, self.ladder.tip(i))
        return self._models[i]

    @one_blas_thread
    def outcome(self, i: int, j: int) -> Outcome:
        """The strike at a level of modes and one of steps."""
        if (i, j) not in self._outcomes:
            self._outcomes[i, j] = solve_contact(self._model(i), steps=self.steps[j]).outcome
        return self._outcomes[i, j]

    def error_of_modes(self, i: int) -> float:
        """Largest difference from the previous levels of modes; 0 of a lumped cue."""
        previous = range(max(i - self.ladder.compared, 0), i)
        best = self.outcome(i, COMPARED_STEPS)
        errors = [relative_error(self.outcome(k, COMPARED_STEPS), best, self.scene) for k in previous]
        return max(errors, default=0.0)

    def error_of_steps(self, i: int, j: int) -> float:
        """Largest difference from the previous levels of steps."""
        best, previous = self.outcome(i, j), range(j - self.ladder.compared, j)
        return max(relative_error(self.outcome(i, k), best, self.scene) for k in previous)


def relative_error(outcome: Outcome, best: Outcome, scene: Scene) -> float:
    """Largest relative difference of squirt, ball speed and spin from those of ``best``."""
    scale = np.abs(_compared_numbers(best))
    scale[0] = max(scale[0], MIN_SQUIRT * abs(float(scene.stroke.offset)))
    scale = np.where(scale > 0, scale, 1.0)  # head-on: squirt and spin are zero at every level
    return float((np.abs(_compared_numbers(outcome) - _compared_numbers(best)) / scale).max())


def _compared_numbers(outcome: Outcome) -> Array:
    return np.array([outcome.squirt, outcome.ball_speed, outcome.spin], float)
