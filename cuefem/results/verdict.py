"""Verdict on a cue: its squirt with its uncertainty, compared with that of reference cues at the same stroke."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import replace

from cuefem.contact.strike import strike_modes
from cuefem.cue import Cue
from cuefem.cue.materials import MATERIALS, table_name
from cuefem.parameters.parts import main_material
from cuefem.quantity.unit_checks import MIN_CUE_MASS
from cuefem.results.quantities import MISCUE_DEFINITION
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

MAX_DENSITY_MARGIN = 0.25  # relative, beyond the range of a wood: no piece of it has such a density


class NoVerdict(ValueError):
    """A stroke whose squirt is neither reported nor compared."""


def mass_problem(scene: Scene) -> str:
    """Why the masses of a cue are impossible; an empty text for others.

    A cue without its butt has too little squirt (maple about 20 %). The measured mass of a shaft sets the density of
    its wood.
    """
    whole = float(scene.cue.mass)
    if whole < MIN_CUE_MASS:
        return (
            f"the whole cue weighs {1e3 * whole:.4g} g, expected 400 to 700 g: squirt is too low to compare; add the "
            'butt, such as --body-mass "15 oz" (body_mass in a file)'
        )
    if scene.lumped is not None or not scene.shaft.shaft_mass_measured:
        return ""
    return density_problem(scene.shaft, MAX_DENSITY_MARGIN)


def density_problem(cue: Cue, margin: float) -> str:
    """Why the density of a weighed shaft is impossible, or ""; margin: relative, beyond the range of its wood."""
    wood = main_material(cue)
    name = table_name(wood)
    if name is None:
        return ""
    low, high = MATERIALS[name].ranges["rho"]
    if (1 - margin) * low <= wood.rho <= (1 + margin) * high:
        return ""
    reason = "the mass is too large: does it include a joint or the butt, or is the drawing too thin?"
    if wood.rho < low:
        reason = "the mass is too small: is a digit missing, or is the drawing too large?"
    return (
        f"by the weight of the shaft the density of its {name} is {wood.rho:.4g} kg/m3, expected {low:g} to {high:g} "
        f"kg/m3; {reason}"
    )


def verdict_problem(scene: Scene, outcome: Outcome) -> str:
    """Why the squirt of a stroke is neither reported nor compared, or "": a miscue, or an impossible mass."""
    if outcome.regime == "miscue":  # whose squirt hardly depends on the cue
        return (
            f"miscue at b/R {scene.stroke.offset:.4g}: no squirt is reported. Use a smaller offset "
            f"(miscue: {MISCUE_DEFINITION})"
        )
    mass = mass_problem(scene)
    return mass and f"no verdict: {mass}"


def reject_no_verdict(scene: Scene, outcome: Outcome) -> None:
    """NoVerdict for a stroke whose squirt is neither reported nor compared."""
    problem = verdict_problem(scene, outcome)
    if problem:
        raise NoVerdict(problem)


def verdict_record(
    scene: Scene, outcome: Outcome, reference_cues: Mapping[str, Cue], *, solved: SolvedScene | None = None
) -> Record:
    """Squirt at the stroke's offset, its uncertainty, and the squirt of each reference cue at the same stroke.

    Parameters
    ----------
    scene : Scene
        A head-on stroke, which has no squirt, is computed at the default offset instead.
    outcome : Outcome
        Of the scene's strike, at any resolution.
    reference_cues : mapping of str to Cue
        The report compares with the first.
    solved : SolvedScene, optional
        The scene with its default modes, if already computed.

    Returns
    -------
    dict
        offset: b/R; head_on: whether it replaces a head-on stroke. squirt: rad, signed; squirt_error: rad, 1 sigma.
        uncertainty: relative, 1 sigma, by its causes model, inputs and computation, and in total. inputs: contribution
        of each uncertain input to "inputs". references: by name squirt, rad; difference, own squirt over it less 1,
        both at the default resolution; error of the difference, 1 sigma; distinct, whether the difference exceeds it.
        Reference cues whose strike fails, or whose squirt is zero or of the opposite sign, are left out.

    Raises
    ------
    NoVerdict
        If the stroke is a miscue, or the mass of the cue impossible (`verdict_problem`).
    """
    struck = off_centre(scene)
    head_on = struck is not scene
    solved = SolvedScene(struck) if solved is None or head_on else solved
    outcome = strike_modes(struck, solved.tip) if head_on else outcome
    reject_no_verdict(struck, outcome)
    squirt = float(outcome.squirt)
    # at the resolution of the reference cues, since the outcome may be finer
    base = squirt if outcome.error is None else variant_squirt(solved, struck)
    inputs = {key: abs(change) for key, change in squirt_changes(solved, base).items()}
    computation = NUMERICAL_ERROR if outcome.error is None else outcome.error
    uncertainty = Uncertainty(model_error(struck), math.hypot(*inputs.values()), computation)
    shaft = shaft_uncertainty(inputs)
    reference_rows = {name: _reference_row(struck, base, cue, shaft) for name, cue in reference_cues.items()}
    return {
        "offset": float(struck.stroke.offset),
        "head_on": head_on,
        "squirt": squirt,
        "uncertainty": uncertainty._asdict() | {"total": uncertainty.total},
        "inputs": inputs,
        "squirt_error": uncertainty.total * abs(squirt),
        "references": {name: row for name, row in reference_rows.items() if row},
    }


def _reference_row(scene: Scene, squirt: float, cue: Cue, inputs: float) -> Record | None:
    """Comparison with another cue at the same stroke; None if its strike fails or the signs of squirt differ.

    squirt: that of the scene, rad. inputs: relative uncertainty of squirt by the inputs of the scene's shaft; the
    same is assumed, independently, for the other shaft.
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

    Effects that are part of the scene's own cue (a mass, a joint) or lie beyond the other's end are dropped. The other
    cue retains leather in its drawing only if the scene's own cue has it. A tip that does not fit the other's face is
    adapted (`cuefem.effects.leather_tip.LeatherTip.on_other_cue`).
    """
    has_leather = scene.lumped is None and scene.shaft.leather_height
    other = cue if has_leather else without_leather(cue)
    remaining = (
        e for e in scene.effects if e.at_tip or not (e.part_of_cue or any(x >= other.length for x in e.positions))
    )
    effects = remaining if scene.lumped else (e.on_other_cue(scene.shaft, other) for e in remaining)
    return replace(scene, cue=other, effects=tuple(effects))
