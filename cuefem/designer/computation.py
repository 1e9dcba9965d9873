"""The results on the page, computed by the functions of the commands, each once.

The strike and the end mass are computed first, then the verdict and the comparison; results of a tab when it is
open. Moving a control again ends the sequence after the current part.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from contextvars import ContextVar
from dataclasses import dataclass, replace
from functools import lru_cache
from typing import TYPE_CHECKING, Any, NamedTuple

import cuefem as cf
from cuefem.analysis.comparison import compare_cues
from cuefem.analysis.cue_report import CueReport, report
from cuefem.analysis.design_changes import DesignChanges, design_changes
from cuefem.analysis.verdict import Verdict
from cuefem.analysis.verdict import verdict as verdict_of
from cuefem.contact.strike import strike_modes
from cuefem.cue import Array
from cuefem.endmass.definitions import DEFINITIONS, Drive
from cuefem.endmass.end_mass_density import end_mass_density
from cuefem.measurements.calibration import Calibration
from cuefem.measurements.estimate import estimate
from cuefem.measurements.measured_cue import MeasuredCue
from cuefem.measurements.shot import Shot
from cuefem.parameters.parts import main_material
from cuefem.quantity.display_units import cached_by_units
from cuefem.results.closed_forms import pivot_length
from cuefem.results.computable_results import listed_results
from cuefem.results.records import Record
from cuefem.results.solved_design import MIN_SOLVED_MODES, SolvedDesign, coupled_curve
from cuefem.results.verdict import verdict_problem
from cuefem.scene import Outcome, Scene
from cuefem.scene.solved_scene import SolvedScene, default_mode_count

if TYPE_CHECKING:
    from cuefem.analysis.model_error import ModelError

CACHED_DESIGNS = 12  # designs whose results are cached, for undo and comparison
OFFSET_STEP = 0.04  # b/R, of the curves
CURVE_OFFSETS = tuple(round(OFFSET_STEP * i, 2) for i in range(1, 18))
MAX_MASS_MODES = 45  # the end-mass distribution needs all modes of the mesh: cubic cost
MASS_RANGE = 0.3  # m from the tip

Count = Callable[[int, int], None]
_count: ContextVar[Count] = ContextVar("count", default=lambda done, of: None)  # of the thread that computes


@dataclass(frozen=True)
class SolvedStrike:
    """A scene's modes, and its strike without the time history."""

    solved: SolvedScene
    outcome: Outcome


def calibration_by(name: str, scene: Scene, shots: Sequence[Shot]) -> Calibration:
    """The calibration by shots with a cue, as of a folder with nothing else measured."""
    measured = MeasuredCue(name, scene, tuple(shot.squirt(scene) for shot in shots))
    return Calibration.of(estimate(measured))


@lru_cache(CACHED_DESIGNS)
def solved_strike(scene: Scene) -> SolvedStrike:
    """The coupled strike, sufficient for the first numbers."""
    solved = SolvedScene(scene)
    outcome = strike_modes(scene, solved.tip)
    return SolvedStrike(solved, replace(outcome, history=None))


class SquirtFactor(NamedTuple):
    """The squirt factor that a calibration gives a design; the design beside it carries the same one."""

    calibration: Calibration
    scene: Scene

    def value(self) -> float:
        """1 for a stroke without a verdict."""
        if verdict_problem(self.scene, solved_strike(self.scene).outcome):
            return 1.0
        return self.calibration.factor(self.scene)


def _value(factor: SquirtFactor | None) -> float:
    return 1.0 if factor is None else factor.value()


def first_numbers(scene: Scene, factor: SquirtFactor | None = None) -> dict[str, float | None]:
    """Results of the strike alone, SI; None for a miscue."""
    outcome = solved_strike(scene).outcome
    if outcome.regime == "miscue":
        return {"squirt": None, "pivot_length": None}
    squirt = _value(factor) * float(outcome.squirt)
    pivot = pivot_length(scene, squirt)
    return {"squirt": squirt, "pivot_length": None if pivot is None else float(pivot)}


@lru_cache(CACHED_DESIGNS)
def numbers(scene: Scene, factor: SquirtFactor | None = None) -> dict[str, Any]:
    """Every number that a table lists: the results by name, all end masses, and natural frequencies."""
    strike = solved_strike(scene)
    design = SolvedDesign(strike.solved, strike.outcome, _value(factor))
    masses = {f"end_mass_{each.name}": _end_mass(each.name, design) for each in DEFINITIONS.values()}
    frequencies = [design.frequency(mode) for mode in range(1, MIN_SOLVED_MODES + 1)]
    return listed_results(design) | first_numbers(scene, factor) | masses | {"frequencies": frequencies}


def _end_mass(name: Drive, design: SolvedDesign) -> float | None:
    try:
        return design.end_mass(name, None)
    except ValueError:
        return None


@lru_cache(CACHED_DESIGNS)
def verdict(scene: Scene, calibration: Calibration | None = None) -> Verdict:
    """Squirt with its uncertainty, compared with the reference cues."""
    strike = solved_strike(scene)
    return verdict_of(SolvedDesign(strike.solved, strike.outcome), calibration=calibration)


def with_stroke_of(scene: Scene, other: Scene) -> Scene:
    """Another design's scene with the ball and the stroke of the first."""
    return replace(other, ball=scene.ball, stroke=scene.stroke)


def comparison(scene: Scene, other: Scene, same_shaft: bool, names: Sequence[str] = ("squirt",)) -> Record:
    """The differences of a scene from another one by the same stroke; same_shaft applies only to one wood."""
    same = same_shaft and main_material(scene.shaft).E == main_material(other.shaft).E
    return compare_cues({"other": other, "own": scene}, same_shaft=same, names=names).differences["own"]


@lru_cache(CACHED_DESIGNS)
def curve(scene: Scene, factor: SquirtFactor | None = None) -> dict[str, Any]:
    """Squirt, pivot length and the contact state against the offset."""
    return coupled_curve(scene, CURVE_OFFSETS, solved_strike(scene).solved.tip, _value(factor))


@lru_cache(CACHED_DESIGNS)
def end_mass_distribution(scene: Scene) -> tuple[Array, Array]:
    """Positions along the cue, m, and the increase of the stick end mass by a mass of 1 g there, g.

    Without effects; the contact time is that of the scene's tip.
    """
    bare = replace(scene.without_tip_effects, effects=())
    effect = end_mass_density(bare, min(default_mode_count(bare), MAX_MASS_MODES))
    near = effect.x <= MASS_RANGE
    return effect.x[near], (effect.rhoA + effect.axial_mass)[near]


@cached_by_units(CACHED_DESIGNS)
def changes(scene: Scene, calibration: Calibration | None = None) -> DesignChanges:
    """The design changes a maker can make, with their results."""
    strike = solved_strike(scene)
    return design_changes(SolvedDesign(strike.solved, strike.outcome), calibration=calibration, progress=_counted)


@cached_by_units(CACHED_DESIGNS)
def answers(scene: Scene, calibration: Calibration | None = None) -> CueReport:
    """Every section of the report."""
    return report(scene, calibration=calibration, details=True)


def with_count(count: Count, call: Callable[[], Any]) -> Any:
    """The result of a call that counts its items to ``count``: how many are done, of how many."""
    before = _count.set(count)
    try:
        return call()
    finally:
        _count.reset(before)


def _counted(items: Sequence[Any]) -> Iterator[Any]:
    """The items, counted to the page that waits for them; a count is no part of a cached result."""
    count = _count.get()
    for done, item in enumerate(items):
        count(done, len(items))
        yield item
    count(len(items), len(items))


def solid(scene: Scene) -> ModelError:
    """The scene by the beam and by the solid model."""
    return cf.model_error(scene)  # loads scikit-fem, which the page's start need not
