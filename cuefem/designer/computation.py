"""What the page shows of a design, computed by the functions of the commands, off the page's loop, each once.

The strike and the end mass come first; then the verdict and the comparison; what a tab shows is computed when it is
open. A knob that is moved again ends the sequence after the part that is being computed.
"""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import lru_cache
from typing import Any

import numpy as np
from nicegui import run

import cuefem.report
from cuefem.contact.strike import strike_modes
from cuefem.cue import Array
from cuefem.design.design_changes import design_changes
from cuefem.design.sensitivity import sensitivity
from cuefem.endmass.definitions import DEFINITIONS
from cuefem.io.ready import ready_cues
from cuefem.parameters.parts import main_material
from cuefem.results.closed_forms import pivot_length
from cuefem.results.comparison import comparison_record
from cuefem.results.records import Record
from cuefem.results.solved_design import TONES, SolvedDesign, coupled_curve, listed
from cuefem.results.verdict import verdict_record
from cuefem.scene import Outcome, Scene
from cuefem.scene.solved_scene import Solved, default_modes

LONGEST_WORK = 60.0  # s, time limit of a result; playing cues need less than a tenth
KEPT = 12  # designs whose results are kept, to undo and compare at once
CURVE_OFFSETS = tuple(round(0.04 * i, 2) for i in range(1, 18))  # b/R
MOST_GRAM_MODES = 45  # what a gram adds takes all modes of the mesh: cubic
GRAM_REACH = 0.3  # m from the tip


@dataclass(frozen=True)
class Struck:
    """A scene's modes, and its strike without the course of it."""

    solved: Solved
    outcome: Outcome


@lru_cache(KEPT)
def struck(scene: Scene) -> Struck:
    """The coupled strike: all that the first number takes."""
    solved = Solved(scene)
    outcome = strike_modes(scene, solved.tip)
    return Struck(solved, replace(outcome, history=None))


def first_numbers(scene: Scene) -> dict[str, float | None]:
    """What follows from the strike alone, SI."""
    outcome = struck(scene).outcome
    pivot = pivot_length(scene, outcome.squirt)
    return {"squirt": float(outcome.squirt), "pivot_length": None if pivot is None else float(pivot)}


@lru_cache(KEPT)
def numbers(scene: Scene) -> dict[str, Any]:
    """Every number that a table lists: the results by name, all end masses, and natural frequencies."""
    known = struck(scene)
    design = SolvedDesign(known.solved, known.outcome)
    masses = {f"end_mass_{name}": _end_mass(name, known.solved) for name in DEFINITIONS}
    frequencies = [design.frequency(mode) for mode in range(1, TONES + 1)]
    return first_numbers(scene) | listed(design) | masses | {"frequencies": frequencies}


def _end_mass(name: str, solved: Solved) -> float | None:
    try:
        return float(DEFINITIONS[name].of_solved(solved))
    except ValueError:
        return None


@lru_cache(KEPT)
def verdict(scene: Scene) -> Record:
    """Squirt with its uncertainty, among the reference cues."""
    known = struck(scene)
    return verdict_record(scene, known.outcome, ready_cues(), solved=known.solved)


def struck_like(scene: Scene, other: Scene) -> Scene:
    """Another design's scene with the ball and the stroke of the first."""
    return replace(other, ball=scene.ball, stroke=scene.stroke)


def comparison(scene: Scene, other: Scene, same_shaft: bool, names: Sequence[str] = ("squirt",)) -> Record:
    """The differences of a scene from another one that is struck alike; same_shaft counts only for one wood."""
    same = same_shaft and main_material(scene.shaft).E == main_material(other.shaft).E
    return comparison_record({"other": other, "own": scene}, same_shaft=same, names=names)["differences"]["own"]


@lru_cache(KEPT)
def curve(scene: Scene) -> dict[str, Any]:
    """Squirt, pivot length and the state of the contact against the offset."""
    return coupled_curve(scene, CURVE_OFFSETS, struck(scene).solved.tip)


@lru_cache(KEPT)
def gram(scene: Scene) -> tuple[Array, Array]:
    """Positions along the bare cue, m, and the end mass that one gram adds there, g."""
    bare = replace(scene, effects=())
    effect = sensitivity(bare, min(default_modes(bare), MOST_GRAM_MODES))
    near = effect.x <= GRAM_REACH
    return effect.x[near], effect.rhoA[near]


@lru_cache(KEPT)
def changes(scene: Scene) -> Record:
    """What a maker can change, and what each change does."""
    return design_changes(scene, solved=struck(scene).solved)


def solid(scene: Scene) -> Record:
    """The scene by beam and by solid."""
    return cuefem.report.model_error_record(scene)  # loads scikit-fem, which the page's start need not


async def computed(work: Callable[..., Any], *arguments: Any) -> Any:
    """Work done in a thread, with overflows as errors; RuntimeError if it takes too long."""

    def guarded() -> Any:
        with np.errstate(over="raise", divide="raise", invalid="raise"):
            return work(*arguments)

    try:
        return await asyncio.wait_for(run.io_bound(guarded), LONGEST_WORK)
    except TimeoutError:
        raise RuntimeError(f"this takes more than {LONGEST_WORK:g} s: draw fewer segments, or check sizes") from None
