"""Comparison of cues: their results, and each difference with the uncertainty that does not cancel."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import replace
from functools import lru_cache
from typing import Any, NamedTuple

from cuefem.parameters.parameter import PARAMETERS
from cuefem.parameters.parts import main_material
from cuefem.results.records import Record
from cuefem.results.solved_design import SolvedDesign, computable_results, off_centre
from cuefem.results.uncertainty import RATIO_FLOOR, changes_by_input, difference_record, model_share
from cuefem.results.verdict import verdict_problem
from cuefem.scene import Scene
from cuefem.scene.solved_scene import SolvedScene

# The compared results, by their names in the registry.
SQUIRT_RESULTS = ("squirt", "end_mass_squirt", "pivot_length")  # derived from squirt: they include the model error
SHAPE_RESULTS = ("tip_stiffness", "shaft_mass", "mass")
N_FREQUENCIES = 3
RESULT_NAMES = (*SQUIRT_RESULTS, *SHAPE_RESULTS, *(f"frequency_{k}" for k in range(1, N_FREQUENCIES + 1)))
SHAPE_FLOOR = 2e-3  # relative, of shape, weights, frequencies: 0.2 g of 100 g, 0.01 mm of 13 mm to the fourth power
Progress = Callable[[Sequence[Any]], Iterable[Any]]


class _CueResults(NamedTuple):
    """A scene, its results, the contact state of its strike ("" if it fails), why it has no verdict ("" if it has), and
    the relative changes of the results with each uncertain input."""

    scene: Scene
    numbers: dict[str, float]
    regime: str
    problem: str
    inputs: dict[str, dict[str, float]]


def comparison_record(
    scenes: Mapping[str, Scene],
    *,
    same_shaft: bool = False,
    names: Sequence[str] = RESULT_NAMES,
    progress: Progress = list,
) -> Record:
    """Numbers of some cues, SI, and the relative differences of the others from the first with their uncertainty.

    An error that two cues share cancels in their difference: that of a tip of the same value on both, and of the wood
    if they are one shaft before and after a change (same_shaft). To squirt and what follows from it, the model adds
    its part of the logarithm (`model_share`), and `RATIO_FLOOR`; other numbers have `SHAPE_FLOOR`. "distinct": whether
    a difference exceeds its uncertainty (1 sigma), whichever of two cues is the first. ValueError for one shaft of two
    woods.

    All cues have the ball, the speed and the offset of the first. names: the numbers that are compared.
    progress: wraps the list of cues, to show progress.
    """
    struck = with_same_stroke(scenes)
    woods = {main_material(scene.shaft).E for scene in struck.values()}
    if same_shaft and len(woods) > 1:
        moduli = " and ".join(f"{E / 1e9:.4g} GPa" for E in sorted(woods))
        raise ValueError(f"one shaft before and after a change must be of one wood; got E of {moduli}")
    results = {name: _cue_results(struck[name], tuple(names)) for name in progress([*struck])}
    reference, *others = results
    first = struck[reference]
    return {
        "offset": float(first.stroke.offset),
        "speed": float(first.stroke.speed),
        "same_shaft": same_shaft,
        "reference": reference,
        "regimes": {name: each.regime for name, each in results.items()},
        "problems": {name: each.problem for name, each in results.items() if each.problem},
        "cues": {name: each.numbers for name, each in results.items()},
        "differences": {
            name: _differences(results[reference], results[name], same_shaft=same_shaft) for name in others
        },
    }


def with_same_stroke(scenes: Mapping[str, Scene]) -> dict[str, Scene]:
    """The scenes with the ball and the stroke of the first, off centre."""
    first = off_centre(next(iter(scenes.values())))
    return {name: replace(scene, ball=first.ball, stroke=first.stroke) for name, scene in scenes.items()}


@lru_cache(maxsize=16)  # the reference usually remains while the other cue changes
def _cue_results(scene: Scene, names: tuple[str, ...]) -> _CueResults:
    numbers = _numbers(scene, names)
    try:
        outcome = SolvedDesign(SolvedScene(scene)).strike()
        regime, problem = outcome.regime, verdict_problem(scene, outcome)
    except (ValueError, RuntimeError) as error:
        regime, problem = "", str(error)
    return _CueResults(
        scene, numbers, regime, problem, changes_by_input(scene, numbers, lambda other: _numbers(other, names))
    )


def _numbers(scene: Scene, names: Sequence[str]) -> dict[str, float]:
    """The compared results of a scene; nan where it has none, such as squirt of a miscue."""
    _ = scene.shaft  # ValueError for a lumped cue, which has no shape
    design, registry = SolvedDesign(SolvedScene(scene)), computable_results()

    def value(name: str) -> float:
        base, _, mode = name.partition("frequency_")
        of = registry[base or "frequency"].of
        argument: Any = int(mode) if mode else float(scene.stroke.offset) if name == "pivot_length" else None
        assert of is not None
        try:
            if name in SQUIRT_RESULTS and verdict_problem(scene, design.strike()):
                return math.nan
            return of(design, argument)
        except (ValueError, RuntimeError):
            return math.nan

    return {name: value(name) for name in names}


def _differences(first: _CueResults, other: _CueResults, *, same_shaft: bool) -> dict[str, Record]:
    """Relative differences, their uncertainty, and whether they are distinct, by number, if both have a value."""
    records: dict[str, Record] = {}
    for name, value in first.numbers.items():
        ratio = other.numbers[name] / value
        if not ratio > 0:
            continue
        inputs = {**first.inputs, **other.inputs}
        errors = [_input_error(first, other, key, name, same_shaft=same_shaft) for key in inputs]
        share, floor = 0.0, SHAPE_FLOOR
        if name in SQUIRT_RESULTS:
            share, floor = model_share(first.scene, other.scene), RATIO_FLOOR
        difference = difference_record(ratio, share, *errors, floor=floor)
        if not math.isnan(difference["error"]):  # a strike at a limit of an input's range is a miscue
            records[name] = difference
    return records


def _input_error(first: _CueResults, other: _CueResults, key: str, name: str, *, same_shaft: bool) -> float:
    """Uncertainty of the logarithm of a ratio of two cues' results by one input."""
    changes = [each.inputs.get(key, {}).get(name, 0.0) for each in (first, other)]
    parameter = PARAMETERS[key]
    shared = parameter.value(first.scene) == parameter.value(other.scene) if parameter.is_shareable else same_shaft
    return abs(changes[1] - changes[0]) if shared else math.hypot(*changes)
