"""Verdict on a cue: its squirt with its uncertainty, compared with reference cues by the same stroke."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import replace

from cuefem.cue import Cue
from cuefem.results.records import Record
from cuefem.results.solved_design import off_centre
from cuefem.results.uncertainty import (
    NUMERICAL_ERROR,
    Uncertainty,
    difference_record,
    model_error,
    model_share,
    shaft_uncertainty,
    squirt_changes,
    squirt_of,
    variant_squirt,
)
from cuefem.scene import Outcome, Scene
from cuefem.scene.default_scene import without_leather
from cuefem.scene.solved_scene import SolvedScene


def verdict_record(
    scene: Scene, outcome: Outcome, ready: Mapping[str, Cue], *, solved: SolvedScene | None = None
) -> Record:
    """Squirt at the stroke's offset, its uncertainty, and the squirt of each reference cue by the same stroke.

    A head-on stroke, which has no squirt, is computed at the default offset instead. "inputs": by how much each changes
    squirt. "references": squirt, own squirt over it less 1, its error, and whether the two are "distinct". ready:
    the first is the reference of the text. solved: the scene's default modes, if already computed.
    """
    struck = off_centre(scene)
    head_on = struck is not scene
    solved = SolvedScene(struck) if solved is None or head_on else solved
    # at the resolution of the reference cues, since the outcome may be finer
    own = variant_squirt(solved, struck) if head_on or outcome.error is not None else float(outcome.squirt)
    squirt = own if head_on else float(outcome.squirt)
    inputs = {key: abs(change) for key, change in squirt_changes(solved, own).items()}
    computation = NUMERICAL_ERROR if outcome.error is None else outcome.error
    uncertainty = Uncertainty(model_error(struck), math.hypot(*inputs.values()), computation)
    among = {name: _reference_row(struck, own, cue, shaft_uncertainty(inputs)) for name, cue in ready.items()}
    return {
        "offset": float(struck.stroke.offset),
        "head_on": head_on,
        "squirt": squirt,
        "uncertainty": uncertainty._asdict() | {"total": uncertainty.total},
        "inputs": inputs,
        "squirt_error": uncertainty.total * abs(squirt),
        "references": {name: beside for name, beside in among.items() if beside},
    }


def _reference_row(scene: Scene, squirt: float, cue: Cue, inputs: float) -> Record | None:
    """Another cue with the same stroke; None if this stroke fails with it, or one of the two has no squirt.

    inputs: relative uncertainty of squirt by the inputs of the scene's shaft; the other shaft, another piece of wood,
    is taken to have as much.
    """
    struck = with_cue(scene, cue)
    try:
        other = squirt_of(struck)
    except (ValueError, RuntimeError):
        return None
    if not squirt * other > 0:
        return None
    return {"squirt": other} | difference_record(squirt / other, model_share(scene, struck), inputs, inputs)


def with_cue(scene: Scene, cue: Cue) -> Scene:
    """The scene's ball, tip, stroke and effects with another cue.

    Effects on the scene's own cue (a mass, a joint, a clamp beyond the other's end) are dropped. The other cue
    has the leather in its drawing only if the scene's own cue has.
    """
    own = scene.lumped is None and scene.shaft.leather
    other = cue if own else without_leather(cue)
    stay = (e for e in scene.effects if e.at_tip or not (e.part_of_cue or any(x >= other.length for x in e.positions)))
    return replace(scene, cue=other, effects=tuple(stay))
