"""Tips as the compiled kernel knows them: a force-indentation law, and the tangential compliance of the patch."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from cuefem.contact.kernel.declarations import CONSTANTS, KernelInput
from cuefem.effects.contact_terms import ContactTerms, PowerLaw, TipModel
from cuefem.effects.force_law import LeatherLaw, TipLaw, contact_time_ratio
from cuefem.quantity.fields import OutOfBounds, Quantity
from cuefem.scene import Scene
from cuefem.scene.solved_scene import MIN_RESTITUTION

MIN_LEATHER_RESTITUTION = 0.1  # leather vibrates on the ball below it
ANNULI_MARGIN = 1.05  # annuli up to 1.05 times the largest indentation
# Steps in a head-on contact time, and those of a leather tip that does not slip as a whole: the error of squirt is
# below 0.1 % (tests/contact/test_stored_answers.py). The impulse that begins infinite friction needs twice as many.
STEPS, LEATHER_STEPS, STICKING_STEPS = 400, 200, 800


@dataclass(frozen=True)
class PowerTip:
    """A tip whose force is a power of its indentation. Its patch sticks or slips as a whole.

    law: F = stiffness d^exponent. compliance: of the tangential spring, m/N; 0 for a rigid patch. steps: default number
    in a head-on contact time.
    """

    law: TipLaw
    compliance: float = 0.0
    steps: int = STEPS
    slips_in_parts: ClassVar[bool] = False

    @property
    def is_rigid(self) -> bool:
        """Whether the tip has no tangential compliance."""
        return self.compliance == 0

    def write_to(self, fields: KernelInput) -> None:
        """Write law and patch to the kernel's input."""
        fields.law = CONSTANTS["POWER_LAW"]
        fields.stiffness = self.law.stiffness
        fields.exponent = self.law.exponent
        fields.indentation_limit = math.inf
        fields.patch = CONSTANTS["RIGID_PATCH"] if self.is_rigid else CONSTANTS["SPRING_PATCH"]
        fields.compliance = self.compliance


@dataclass(frozen=True)
class Leather:
    """A leather tip. Its patch slips annulus by annulus.

    law: series of force and tangential compliance. surface_restitution: square root of the part of the tangential
    strain energy that the leather returns. largest_indentation: of a head-on impact, m. steps: default number in a
    head-on contact time.
    """

    law: LeatherLaw
    surface_restitution: float
    largest_indentation: float
    steps: int
    slips_in_parts: ClassVar[bool] = True
    is_rigid: ClassVar[bool] = False

    def write_to(self, fields: KernelInput) -> None:
        """Write law and patch to the kernel's input."""
        law = self.law
        fields.law = CONSTANTS["LEATHER_LAW"]
        fields.terms = len(law.force_terms)
        fields.force_terms = np.array(law.force_terms)
        fields.compliance_terms = np.array(law.compliance_terms)
        fields.indentation_limit = law.indentation_limit
        fields.patch = CONSTANTS["PARTIAL_SLIP"]
        fields.surface_restitution = self.surface_restitution
        fields.annuli_end = min(law.indentation_limit, ANNULI_MARGIN * self.largest_indentation)


def tip_of(scene: Scene) -> PowerTip | Leather:
    """The tip of a scene. ValueError for a restitution below its bound."""
    terms = scene.contact_terms
    return _power_tip(scene, terms) if terms.tip is None else _leather(scene, terms.tip)


def _power_tip(scene: Scene, terms: ContactTerms) -> PowerTip:
    """A tip with the law of an effect, or a linear one."""
    restitution = scene.tip.restitution
    check_restitution("Tip.restitution", restitution)
    exponent, speed = terms.law or PowerLaw(exponent=1.0, speed=scene.stroke.speed)
    law = TipLaw.for_contact_time(exponent, restitution, mass=scene.reduced_mass, speed=speed, time=scene.contact_time)
    steps = STICKING_STEPS if math.isinf(scene.tip.friction) else STEPS
    return PowerTip(law, compliance=terms.compliance / scene.stiffness, steps=steps)


def _leather(scene: Scene, tip: TipModel) -> Leather:
    restitution, offset = scene.tip.restitution, abs(scene.stroke.offset)
    check_restitution("Tip.restitution", restitution, MIN_LEATHER_RESTITUTION)
    slips_at_touch = math.tan(math.asin(offset)) > scene.tip.friction
    return Leather(
        law=tip.law(scene.ball.radius, offset, restitution),
        surface_restitution=tip.surface_restitution,
        largest_indentation=scene.max_indentation,
        steps=STEPS if slips_at_touch else LEATHER_STEPS,
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
