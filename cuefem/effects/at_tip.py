"""Effects at the contact between tip and ball."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, ClassVar

from cuefem.effects.base import TipEffect
from cuefem.effects.law import TipLaw, slowed
from cuefem.effects.terms import ContactTerms, HeadOn
from cuefem.quantity import Quantity


@dataclass(frozen=True)
class TipDome(TipEffect):
    """The round end of the tip: the contact lies off the cue's axis, so the axial force bends the shaft.

    radius: of the dome, m. The radii of several domes add.

    Adds: to each bending mode, the displacement of the contact on a rigid dome of radius r tied to the end section. The
    contact is r sin(phi) off the axis and r (1 - cos(phi)) behind the apex; the inverse mass gains terms that couple
    motion along and across the cue.
    Matters when: always. A 9 mm dome raises squirt at small offsets by 10 % (carbon) to 63 % (Kim's shaft;
    studies/dome.md); a plain sum over modes then converges very slowly.
    Wrong when: the leather shears or flattens so much that it does not follow the end section.
    Limit: radius 0 is the bare strike.
    Source: geometry, physics.md section 8; [Kim] sec. 2 mentions the off-axis contact and drops it.
    """

    needs_beam: ClassVar[bool] = True  # a lumped cue has its coupling for it

    radius: Annotated[float, Quantity("m", "[0, inf)")]

    def add_to_contact(self, terms: ContactTerms) -> None:
        """The dome: the levers of two domes add, and so do their radii."""
        terms.add_dome(self.radius)


@dataclass(frozen=True)
class TipShear(TipEffect):
    """The leather gives way sideways: a massless contact patch on a spring.

    ratio: of the spring's stiffness to the tip's loading stiffness, in (0, inf). Mindlin's for a circular contact is
    2 (1 - nu)/(2 - nu), 0.75 at nu = 0.4. Several springs act in series.

    Adds: one state, the spring's force. The spring is lossless; Coulomb friction limits it, |F_t| <= mu F_n.
    Matters when: the ratio is low, since squirt falls strongly with it. At first touch F_t/F_n = ratio tan(phi), so the
    contact does not slip first while that is below mu.
    Wrong when: the leather is no perfect spring; slip in a part of the patch alone is left out; and leather that is
    drawn into the cue gives way sideways as well.
    Limit: ratio -> inf is the bare strike, like 1/ratio; with endless friction it is not, since nothing then damps the
    patch.
    Source: [Mindlin] J. Appl. Mech. 1949; physics.md section 8.
    """

    ratio: Annotated[float, Quantity("", "(0, inf)")]

    def add_to_contact(self, terms: ContactTerms) -> None:
        """The patch's spring: springs in series, so that compliances add."""
        terms.add_compliance(1 / self.ratio)


@dataclass(frozen=True)
class PowerLawTip(TipEffect):
    """A tip that stiffens as it is compressed: its force is a power of the compression. It acts once.

    exponent: n >= 1; 3/2 is Hertz's contact of round bodies, 1 the base model. speed: of the head-on blow that lasts
    the tip's contact time, m/s.

    Adds: F = k' d^n while the tip is loaded, in place of k d. Unloading follows the loading curve with its compression
    scaled by e^2, F = F_peak ((d - d0)/(e^2 d_peak))^n from d0 = (1 - e^2) d_peak, so that the work given back is
    exactly e^2 of that spent; below the old peak the tip is reloaded on that curve. A `TipShear` keeps its constant
    spring, ratio times the base model's k. The contact is stepped in time, to about 1e-10.
    Matters when: speeds differ. Contact time falls with speed as U^((1 - n)/(1 + n)), and squirt with it.
    Wrong when: e itself falls with speed, or the leather bottoms out.
    Limit: exponent 1 is the base model.
    Source: Hertz 1882; [Stronge] ch. 6; physics.md section 8.
    """

    once: ClassVar[bool] = True
    exponent: Annotated[float, Quantity("", "[1, inf)")] = 1.5
    speed: Annotated[float, Quantity("m/s", "(0, inf)")] = 1.0

    def add_to_contact(self, terms: ContactTerms) -> None:
        """The power law."""
        terms.set_law(self._law)

    def _law(self, blow: HeadOn) -> tuple[TipLaw, float]:
        law = TipLaw.timed(self.exponent, blow.restitution, mass=blow.mass, speed=self.speed, time=blow.time)
        return law, blow.time * slowed(self.exponent, blow.speed / self.speed)


@dataclass(frozen=True)
class RollingContact(TipEffect):
    """The contact moves over ball and tip while they touch, and its normal turns with it. It acts once.

    Adds: the angle of the contact as a state. Its rate is the tip's velocity along t less the ball's, over R + r; r is
    the radius of the tip's dome (`TipDome`; without one, the tip is a sharp point). The contact is stepped in time, to
    about 1e-10.
    Matters when: the stroke is fast: squirt and spin change by about U T/R, 1 % at 1 m/s and 1 ms.
    Wrong when: the leather gives so far, or is so wide, that the contact is no point. The compression beside R + r,
    which changes the effect by a part U T/R of itself, and the turning of the cue are left out.
    Limit: a short contact, T -> 0, is the bare strike.
    Source: rigid kinematics of two spheres, written out in `cuefem.contact.nonlinear`.
    """

    once: ClassVar[bool] = True

    def add_to_contact(self, terms: ContactTerms) -> None:
        """The normal turns."""
        terms.turn()
