"""Uncertainty of a squirt and of the ratio of two: of the model, of unmeasured inputs, of the computation (1 sigma)."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping
from dataclasses import replace
from functools import lru_cache
from itertools import chain
from types import MappingProxyType
from typing import NamedTuple

from cuefem.beam.tip_modes import TipModes
from cuefem.contact.strike import strike_modes
from cuefem.effects.force_law import IndentationOutOfRange
from cuefem.parameters.scene_changes import with_values_at
from cuefem.parameters.table import PARAMETERS
from cuefem.results.records import Record
from cuefem.results.verdict import NoVerdict, reject_miscue
from cuefem.scene import Scene
from cuefem.scene.solved_scene import SolvedScene

# Model error, relative: the scatter of published squirt less the uncertainty of those cues' inputs, which were not
# measured either. Few series determine it only to an interval; these are its upper ends, for a leather tip and for a
# spring without a dome. studies/measured/uncertainty.py derives them, and tests/results/test_uncertainty.py again.
MODEL_ERROR = 0.18
SPRING_ERROR = 0.29
# The error of the logarithm of a ratio of squirt as a part of that logarithm: of two shafts (upper end, from pairs of
# shafts in one series, their inputs included), and of a shaft with and without a mass on it (two masses, 31 positions).
SHAFT_ERROR = 0.31
MASS_ERROR = 0.54
RATIO_FLOOR = 0.01  # relative, of any ratio of squirt: calipers and numerical error
NUMERICAL_ERROR = 0.002  # of squirt at the default resolution: 0.19 % at most (studies/accuracy/accuracy.md)


class InputChanges(NamedTuple):
    """Relative changes of the results of a scene with its uncertain inputs.

    relative: by input and result. miscues: inputs that make the stroke a miscue one standard deviation up or down.
    """

    relative: dict[str, dict[str, float]]
    miscues: tuple[str, ...]

    def of(self, result: str) -> dict[str, float]:
        """Relative changes of one result, by input."""
        return {key: change[result] for key, change in self.relative.items()}


class Uncertainty(NamedTuple):
    """Relative standard uncertainty of a squirt, by its cause.

    model: model error. inputs: unmeasured wood and tip of this scene. computation: modes and
    steps.
    """

    model: float
    inputs: float
    computation: float

    @property
    def total(self) -> float:
        """Total relative uncertainty: the parts in quadrature."""
        return math.hypot(*self)


def model_error(scene: Scene) -> float:
    """Model error of a scene's squirt, relative: that of a leather tip or of a spring tip."""
    return MODEL_ERROR if scene.contact_terms.tip is not None else SPRING_ERROR


def shaft_uncertainty(inputs: Mapping[str, float]) -> float:
    """The contribution of the shaft's inputs alone, which remains between two shafts with one tip."""
    return math.hypot(*(share for key, share in inputs.items() if not PARAMETERS[key].is_shareable))


@lru_cache(maxsize=32)  # the verdict, the design changes and the calibration of one page ask for the same
def squirt_inputs(scene: Scene) -> InputChanges:
    """`squirt_changes` of a stroke at the default resolution; `NoVerdict` for a miscue."""
    solved = SolvedScene(scene)
    return squirt_changes(solved, _valid_squirt(scene, solved.tip))


def squirt_changes(solved: SolvedScene, base: float, of: Iterable[str] = PARAMETERS) -> InputChanges:
    """`changes_by_input` of squirt alone; base: that of the scene, rad; none without squirt."""
    if not base:
        return InputChanges({}, ())
    return changes_by_input(solved.scene, {"squirt": base}, lambda new: {"squirt": variant_squirt(solved, new)}, of)


def changes_by_input(
    scene: Scene,
    base: Mapping[str, float],
    of: Callable[[Scene], Mapping[str, float]],
    inputs: Iterable[str] = PARAMETERS,
    spreads: Mapping[str, float] = MappingProxyType({}),
) -> InputChanges:
    """Relative changes of results of a scene with each uncertain input, by its standard deviation.

    Half the difference between one standard deviation up and one down; of one side where the other is no valid cue or
    a miscue. base: results of the scene. of: computes those of a changed scene, nan for a result that it does not have;
    `NoVerdict` for a miscue. inputs: the requested inputs. spreads: standard deviations of logarithms that replace the
    usual ones, by input. Signs are those of a larger value of the input.
    """
    changes: dict[str, dict[str, float]] = {}
    miscues: list[str] = []
    for key in inputs if scene.cue.segments else ():
        sides, is_miscue = _sides(scene, key, of, spreads)
        own = [name for name, value in base.items() if not math.isnan(value)]
        lacks_result = any(math.isnan(side[name]) for side in sides.values() for name in own)
        if is_miscue or lacks_result:
            miscues.append(key)
        if sides:
            changes[key] = {name: _mean_change(sides, name, base[name]) for name in base}
    return InputChanges(changes, tuple(miscues))


def _sides(
    scene: Scene, key: str, of: Callable[[Scene], Mapping[str, float]], spreads: Mapping[str, float]
) -> tuple[dict[float, Mapping[str, float]], bool]:
    """Results one standard deviation of an input up and down, by the step of its logarithm, as far as there is a valid
    cue; and whether one of them is a miscue or beyond the range of the tip."""
    parameter = PARAMETERS[key]
    spread = spreads.get(key, parameter.spread_in(scene))
    steps = (spread, -spread) if spread is not None else (math.log1p(-parameter.below),) if parameter.below else ()
    sides: dict[float, Mapping[str, float]] = {}
    is_miscue = False
    for step in steps if parameter.value(scene) else ():
        try:
            sides[step] = of(with_values_at(scene, parameter.scaled(scene, math.exp(step))))
        except (NoVerdict, IndentationOutOfRange):
            is_miscue = True
        except (ValueError, RuntimeError):  # no valid cue there
            continue
    return sides, is_miscue


def _mean_change(sides: Mapping[float, Mapping[str, float]], name: str, base: float) -> float:
    """The mean relative change of a result over the sides that have it; nan if none has."""
    changes = [math.copysign(1.0, step) * (values[name] / base - 1) for step, values in sides.items()]
    valid = [change for change in changes if not math.isnan(change)]
    return sum(valid) / len(valid) if valid else math.nan


def miscue_note(inputs: Iterable[str]) -> str:
    """A sentence on the inputs whose uncertainty includes a stroke without squirt; "" without any."""
    labels = [PARAMETERS[key].label for key in inputs]
    if not labels:
        return ""
    reason = "since the other is a miscue or beyond the valid range of the tip"
    return f"Uncertain to one side only, {reason}: {', '.join(labels)}."


def variant_squirt(solved: SolvedScene, variant: Scene) -> float:
    """Squirt of a changed scene, rad; it reuses the solved modes as far as the vibrating cue is unchanged.

    `NoVerdict` for a miscue.
    """
    if _cue_and_effects(variant) == _cue_and_effects(solved.scene):
        return _valid_squirt(variant, solved.tip)
    if _bending_cue(variant) == _bending_cue(solved.scene):
        return _valid_squirt(variant, replace(solved, scene=variant).tip)
    return squirt_of(variant)


def _valid_squirt(scene: Scene, tip: TipModes) -> float:
    """Squirt of a strike by solved modes, rad; `NoVerdict` for a miscue."""
    outcome = strike_modes(scene, tip)
    reject_miscue(scene, outcome)
    return float(outcome.squirt)


def _cue_and_effects(scene: Scene) -> tuple[object, ...]:
    """The cue and the effects on it: of a tip only its mass."""
    return scene.cue, *chain.from_iterable(effect.without_tip(scene.shaft) for effect in scene.cue_effects)


def _bending_cue(scene: Scene) -> tuple[object, ...]:
    """The cue and the effects on it that change its bending modes."""
    return scene.cue, *(effect for effect in scene.cue_effects if effect.changes_bending)


@lru_cache(maxsize=256)
def squirt_of(scene: Scene) -> float:
    """Squirt of a scene's coupled strike, rad, cached for repeated scenes, such as reference cues.

    `NoVerdict` for a miscue.
    """
    return _valid_squirt(scene, SolvedScene(scene).tip)


def model_share(first: Scene, other: Scene) -> float:
    """The model's part of the logarithm of a ratio: `MASS_ERROR` if the shafts' masses differ, else `SHAFT_ERROR`."""
    masses = [[effect for effect in scene.effects if effect.axial_mass] for scene in (first, other)]
    return SHAFT_ERROR if masses[0] == masses[1] else MASS_ERROR


def ratio_error(ratio: float, share: float, *inputs: float, floor: float = RATIO_FLOOR) -> float:
    """The error of a ratio, 1 sigma: the model's share of its logarithm or the contributions of inputs, and a floor.

    The larger of share and inputs counts, because the share includes the inputs of the measured pairs.
    """
    ln = math.log(ratio)
    # from the logarithm to the ratio so that a difference and its error have one quotient in either order of the two
    return math.hypot(max(share * abs(ln), math.hypot(*inputs)), floor) * (math.expm1(ln) / ln if ln else 1.0)


def difference_record(ratio: float, share: float, *inputs: float, floor: float = RATIO_FLOOR) -> Record:
    """The relative difference of a ratio, its error as `ratio_error`, and whether the two are distinct, that is differ
    by more than the error."""
    error = ratio_error(ratio, share, *inputs, floor=floor)
    return {"difference": ratio - 1, "error": error, "distinct": abs(ratio - 1) > error}
