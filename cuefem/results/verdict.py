"""Which strokes have no verdict: a miscue, and a cue of an impossible mass."""

from __future__ import annotations

from cuefem.cue import Cue
from cuefem.cue.materials import MATERIALS, table_name
from cuefem.parameters.parts import main_material
from cuefem.quantity.display_units import with_unit
from cuefem.quantity.unit_checks import MIN_CUE_MASS
from cuefem.scene import Outcome, Scene

# The one definition of a miscue (`cuefem.contact.outcome.contact_state`).
MISCUE_DEFINITION = "the tip slips for more than half of the normal impulse, or through its last third"
MAX_DENSITY_MARGIN = 0.25  # relative, beyond the range of a wood: no piece of it has such a density


class NoVerdict(ValueError):
    """A stroke whose squirt is neither reported nor compared."""


def mass_problem(scene: Scene) -> str:
    """Why the masses of a cue are impossible; an empty text for others.

    A cue without its butt has too little squirt. The measured mass of a shaft sets the density of its wood.
    """
    whole = float(scene.cue.mass)
    if whole < MIN_CUE_MASS:
        return (
            f"the whole cue weighs {with_unit(whole, 'kg')}, less than {with_unit(MIN_CUE_MASS, 'kg')}: squirt is too "
            'low to compare; add the butt, such as --body-mass "15 oz" (body_mass in a file)'
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
    reason = (
        "the mass is too large: is its decimal point right, does it include a joint or the butt, or is the drawing too "
        "thin?"
    )
    if wood.rho < low:
        reason = "the mass is too small: is a digit missing, or is the drawing too large?"
    return (
        f"by the weight of the shaft the density of its {name} is {wood.rho:.4g} kg/m3, expected {low:g} to {high:g} "
        f"kg/m3; {reason}"
    )


def miscue_problem(scene: Scene, outcome: Outcome) -> str:
    """Why the squirt of a miscue is not reported; an empty text for other strokes."""
    if outcome.regime != "miscue":
        return ""
    advice = "Use a smaller offset" if scene.tip.friction else "Raise friction from 0, at which every offset miscues"
    return (  # its squirt hardly depends on the cue
        f"miscue at b/R {scene.stroke.offset:.4g}: no squirt is reported. {advice} (miscue: {MISCUE_DEFINITION})"
    )


def reject_miscue(scene: Scene, outcome: Outcome) -> None:
    """NoVerdict for a miscue, whatever the mass of the cue."""
    problem = miscue_problem(scene, outcome)
    if problem:
        raise NoVerdict(problem)


def verdict_problem(scene: Scene, outcome: Outcome) -> str:
    """Why the squirt of a stroke is neither reported nor compared, or "": a miscue, or an impossible mass."""
    miscue = miscue_problem(scene, outcome)
    if miscue:
        return miscue
    mass = mass_problem(scene)
    return mass and f"no verdict: {mass}"


def reject_no_verdict(scene: Scene, outcome: Outcome) -> None:
    """NoVerdict for a stroke whose squirt is neither reported nor compared."""
    problem = verdict_problem(scene, outcome)
    if problem:
        raise NoVerdict(problem)
