"""Refinement to a requested accuracy: `resolve` and `resolve_end_mass`.

Each level has twice the modes (with truncation correction) and half the step of the previous one; the last has 400
modes, 1.35 to 2.7 times as many. The error of a level is its largest difference from the two previous levels: two
levels may agree by chance.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np

from cuefem.beam.mesh import MAX_STEPS
from cuefem.beam.mode_count import modes_below
from cuefem.beam.tip_modes import TipModes, lumped_tip_modes
from cuefem.contact.strike import strike_modes
from cuefem.cue import Array
from cuefem.endmass.definitions import definition_of
from cuefem.quantity.fields import Quantity, check_kind
from cuefem.scene import Outcome, Scene
from cuefem.scene.solved_scene import MAX_MODES, corrected_tip_modes

FIRST_MODES, FIRST_STEPS = 12, 100  # modes and steps of the first level
COMPARED_LEVELS = 2  # previous levels
MIN_PERIODS = 3  # periods in a contact up to which the first level has all modes
# Squirt errors are relative to max(|squirt|, MIN_SQUIRT |sin phi| rad), since squirt may vanish.
MIN_SQUIRT = 0.01

RTOL = Quantity("", "(0, 1)")


class Level(NamedTuple):
    """One refinement level: modes, steps, outcome or end mass, kg, and from the third level on the relative error."""

    modes: int
    steps: int
    result: Any
    error: float | None


def resolve(scene: Scene, rtol: float) -> Outcome:
    """Outcome of the coupled strike at the first refinement level whose error estimate is within rtol.

    Parameters
    ----------
    scene : Scene
        As `cuefem.strike` takes it.
    rtol : float
        Requested accuracy, in (0, 1): the largest relative error of squirt, ball speed and spin.

    Returns
    -------
    Outcome
        ``.error`` is the estimated error. If neither 400 modes nor, for a lumped cue, 819,200 steps reach ``rtol``, the
        outcome at the finest level is returned, and its error is above ``rtol``.

    Raises
    ------
    ValueError
        If rtol is out of bounds.

    Notes
    -----
    Each level has twice the modes and half the step of the previous one; the last has 400 modes, 1.35 to 2.7 times as
    many. The error is the largest difference from the two previous levels. Errors of squirt are relative to its
    magnitude, or to 0.01 sin(phi) rad if that is larger, since squirt may vanish. Close to a separation or a double hit
    more modes may change the sequence of contacts: agreement of levels then proves little.

    Examples
    --------
    >>> import cuefem as cf
    >>> wood = cf.Material(E=12.6e9, G=0.84e9, rho=700.0)
    >>> cue = cf.Cue((cf.Segment(0.7, 0.012, 0.021, wood),), body_mass=0.43)
    >>> scene = cf.Scene(cue, tip=cf.Tip(contact_time=1e-3), stroke=cf.Stroke(offset=0.3))
    >>> cf.resolve(scene, rtol=1e-2).error < 1e-2
    True
    """
    check_kind("resolve scene", scene, Scene)
    rtol = RTOL.check("resolve rtol", rtol)
    *_, last = refinement_levels(scene, rtol)
    return replace(last.result, error=last.error)


def refinement_levels(scene: Scene, rtol: float) -> Iterator[Level]:
    """Strikes at the refinement levels, up to the first whose error is within ``rtol``, or the finest."""
    strike = lambda tip, steps: strike_modes(scene, tip, steps=steps)  # noqa: E731
    return _refined(scene, rtol, strike, lambda outcome, best: relative_error(outcome, best, scene))


def _refined(
    scene: Scene, rtol: float, solve: Callable[[TipModes, int], Any], difference: Callable[[Any, Any], float]
) -> Iterator[Level]:
    before: list[Any] = []
    for modes, steps, tip in _level_tip_modes(scene):
        result = solve(tip, steps)
        error = max(difference(each, result) for each in before) if len(before) == COMPARED_LEVELS else None
        yield Level(modes, steps, result, error)
        if error is not None and error <= rtol:
            return
        before = [*before, result][-COMPARED_LEVELS:]


def resolve_end_mass(scene: Scene, drive: str = "stick", rtol: float = 1e-4) -> tuple[float, float]:
    """Effective end mass at the first refinement level whose error estimate is within rtol.

    Parameters
    ----------
    scene : Scene
        As `cuefem.end_mass` takes it.
    drive : str
        Name of a definition, as `cuefem.end_mass` takes it.
    rtol : float
        Requested relative accuracy, in (0, 1).

    Returns
    -------
    (float, float)
        The end mass, kg, and its estimated relative error, which is above ``rtol`` if even 400 modes do not reach it.

    Raises
    ------
    ValueError
        If rtol is out of bounds, or the definition is unknown or undefined for this scene.

    Examples
    --------
    >>> import cuefem as cf
    >>> wood = cf.Material(E=12.6e9, G=0.84e9, rho=700.0)
    >>> cue = cf.Cue((cf.Segment(0.7, 0.012, 0.021, wood),), body_mass=0.43)
    >>> mass, error = cf.resolve_end_mass(cf.Scene(cue, tip=cf.Tip(contact_time=1e-3)), "stick", rtol=1e-3)
    >>> round(1e3 * mass), error < 1e-3  # g
    (5, True)
    """
    check_kind("resolve_end_mass scene", scene, Scene)
    rtol, formula = RTOL.check("resolve_end_mass rtol", rtol), definition_of(drive).of
    if scene.lumped is not None:
        return scene.lumped.end_mass, 0.0
    *_, last = _refined(scene, rtol, lambda tip, _: float(formula(tip, scene)), lambda mass, best: abs(mass / best - 1))
    assert last.error is not None
    return last.result, last.error


def relative_error(outcome: Outcome, best: Outcome, scene: Scene) -> float:
    """Largest relative difference of squirt, ball speed and spin from those of ``best``, as in `resolve`."""
    min_scale = np.array([MIN_SQUIRT * abs(float(scene.stroke.offset)), 0.0, 0.0])
    scale = np.maximum(np.abs(_compared_numbers(best)), min_scale)
    scale = np.where(scale > 0, scale, 1.0)  # head-on: squirt and spin are zero at every level
    return float((np.abs(_compared_numbers(outcome) - _compared_numbers(best)) / scale).max())


def _compared_numbers(outcome: Outcome) -> Array:
    return np.array([outcome.squirt, outcome.ball_speed, outcome.spin], float)


def _level_tip_modes(scene: Scene) -> Iterator[tuple[int, int, TipModes]]:
    """Modes, steps and tip modes of the levels; for a lumped cue, which has two modes, only the step is halved."""
    steps = FIRST_STEPS
    if scene.lumped is not None:
        tip = lumped_tip_modes(scene.lumped)
        while steps <= MAX_STEPS:
            yield 0, steps, tip
            steps *= 2
        return
    for count in mode_counts(modes_below(scene.shaft, 2 * np.pi * MIN_PERIODS / scene.contact_time)):
        yield count, steps, corrected_tip_modes(scene, count)
        steps *= 2


def mode_counts(least: int) -> list[int]:
    """Numbers of modes of the levels: from max(FIRST_MODES, least), at most 50, doubled each time; the last is 400.

    The last is 1.35 to 2.7 times its predecessor.
    """
    first = min(max(FIRST_MODES, least), MAX_MODES // 8)
    return [*(first * 2**k for k in range(10) if first * 2**k < 0.75 * MAX_MODES), MAX_MODES]
