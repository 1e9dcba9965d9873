"""Tips as the compiled kernel knows them: a force-indentation law, and the tangential compliance of the patch."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import numpy as np

from cuefem.contact.kernel.declarations import CONSTANTS
from cuefem.effects.contact_terms import PowerLaw
from cuefem.effects.force_law import LeatherLaw, TipLaw, contact_time_ratio
from cuefem.quantity.fields import OutOfBounds, Quantity
from cuefem.scene import Scene
from cuefem.scene.solved_scene import MIN_RESTITUTION

MIN_LEATHER_RESTITUTION = 0.1  # leather vibrates on the ball below it
ANNULI_MARGIN = 1.05  # annuli up to 1.05 times the largest indentation
# Steps in a head-on contact time, and those of a leather tip that does not slip as a whole: the error of squirt is
# below 0.1 % (tests/contact/test_stored_answers.py). The impulse that begins infinite friction needs twice as many.
STEPS, LEATHER_STEPS, STICKING_STEPS = 400, 200, 800


def tip_of(scene: Scene) -> TipLaw | LeatherLaw:
    """The forces of a scene's tip. ValueError for a restitution below its bound."""
    terms, restitution = scene.contact_terms, scene.tip.restitution
    if terms.tip is not None:
        check_restitution("Tip.restitution", restitution, MIN_LEATHER_RESTITUTION)
        return scene.tip_law(restitution, scene.stroke.offset)
    check_restitution("Tip.restitution", restitution)
    exponent, speed = terms.law or PowerLaw(exponent=1.0, speed=scene.stroke.speed)
    law = TipLaw.for_contact_time(exponent, restitution, mass=scene.reduced_mass, speed=speed, time=scene.contact_time)
    return replace(law, compliance=terms.compliance / scene.stiffness)


def default_steps(scene: Scene) -> int:
    """Default number of steps in a head-on contact time."""
    if scene.contact_terms.tip is None:
        return STICKING_STEPS if math.isinf(scene.tip.friction) else STEPS
    slips_at_touch = math.tan(abs(scene.stroke.angle)) > scene.tip.friction
    return STEPS if slips_at_touch else LEATHER_STEPS


def tip_fields(law: TipLaw | LeatherLaw, max_indentation: float) -> dict[str, Any]:
    """Law and patch in the kernel's input; max_indentation: of a head-on impact, m."""
    if isinstance(law, TipLaw):
        return dict(
            law=CONSTANTS["POWER_LAW"],
            stiffness=law.stiffness,
            exponent=law.exponent,
            indentation_limit=math.inf,
            patch=CONSTANTS["RIGID_PATCH"] if law.is_rigid else CONSTANTS["SPRING_PATCH"],
            compliance=law.compliance,
        )
    return dict(
        law=CONSTANTS["LEATHER_LAW"],
        terms=len(law.force_terms),
        force_terms=np.array(law.force_terms),
        compliance_terms=np.array(law.compliance_terms),
        indentation_limit=law.indentation_limit,
        patch=CONSTANTS["PARTIAL_SLIP"],
        surface_restitution=law.surface_restitution,
        annuli_end=min(law.indentation_limit, ANNULI_MARGIN * max_indentation),
    )


def contact_time_of(scene: Scene) -> float:
    """Head-on contact time at the speed of the stroke, s; that of a power law depends on the speed."""
    law = scene.contact_terms.law
    if law is None:
        return scene.contact_time
    return scene.contact_time * contact_time_ratio(law.exponent, scene.stroke.speed / law.speed)


def check_restitution(name: str, restitution: float, bound: float = MIN_RESTITUTION) -> None:
    """OutOfBounds for a restitution below ``bound``."""
    if restitution < bound:
        bounds = Quantity("", f"[{bound:g}, 1]")
        raise OutOfBounds(name, bounds, float(restitution), " for a contact computed in time")
