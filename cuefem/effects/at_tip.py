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

    Adds: to each bending mode's displacement of the contact that of a rigid dome of radius r, m, tied to the end
    section: the contact is r sin(phi) off the axis and r (1 - cos(phi)) behind the apex. B gains u-w terms. Matters:
    always; a 9 mm dome raises small-offset squirt by 10 % (carbon) to 63 % (Kim's shaft; studies/dome.md), and a bare
    strike's plain sum over modes then converges very slowly. Wrong: where the leather shears or flattens so much that
    it does not follow the section. Source: geometry, physics.md section 8; [Kim] sec. 2 mentions the off-axis contact
    and drops it.
    """

    needs_beam: ClassVar[bool] = True  # a lumped cue has its coupling for it

    radius: Annotated[float, Quantity("m", "[0, inf)")]

    def add_to_contact(self, terms: ContactTerms) -> None:
        """The dome: the levers of two domes add, and so do their radii."""
        terms.add_dome(self.radius)


@dataclass(frozen=True)
class TipShear(TipEffect):
    """The leather's tangential give: a massless contact patch on a spring.

    Adds: one state, the spring's force, stiffness ratio times the tip's loading stiffness, lossless, capped by
    Coulomb's |F_t| <= mu F_n. Matters: at first touch F_t/F_n = ratio tan(phi), so there is no first slip while that
    is below mu; squirt falls strongly as the ratio falls. ratio: in (0, inf); Mindlin's for a circular contact is 2 (1
    - nu)/(2 - nu), 0.75 at nu = 0.4. Limit: ratio -> inf is the bare strike, like 1/ratio; with
    endless friction it is not, since nothing damps the patch there. Wrong: leather is no perfect spring, partial slip
    inside the patch is left out, and a leather segment in the cue gives way sideways as well. Source: [Mindlin] J.
    Appl. Mech. 1949; physics.md section 8.
    """

    ratio: Annotated[float, Quantity("", "(0, inf)")]

    def add_to_contact(self, terms: ContactTerms) -> None:
        """The patch's spring: springs in series, so that compliances add."""
        terms.add_compliance(1 / self.ratio)


@dataclass(frozen=True)
class PowerLawTip(TipEffect):
    """A tip that stiffens as it is compressed: force over compression is a power law, not a line.

    Adds: F = k' d^exponent while loaded, for the base model's k d; 3/2 is Hertz's contact of round bodies, 1 the base
    model. k' gives a head-on blow at ``speed``, m/s, the tip's contact time. The unloading curve is the loading curve
    with its compression scaled by e^2, F = F_peak ((d - d0)/(e^2 d_peak))^exponent from d0 = (1 - e^2) d_peak, so that
    the work given back is exactly e^2; below the old peak the tip is reloaded on it. Matters: contact time then falls
    with speed as U^((1 - n)/(1 + n)), and squirt with it. Wrong: where e itself falls with speed, and at speeds at
    which the leather bottoms out. exponent: in [1, inf). A `TipShear` beside it keeps its constant spring, ratio times
    the base model's k. Source: Hertz 1882; [Stronge] ch. 6; physics.md section 8. Cost: stepped in time to about 1e-10.
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
    """The contact moves over ball and tip while they touch, and its normal turns with it.

    Adds: the angle of the contact as a state; it grows as the tip passes the ball's centre: its rate is the tip's
    velocity along t less the ball's, over R + r, r the dome's radius (`TipDome`; none: a sharp point). Matters: little;
    squirt and spin change by a part of first order in U T/R (about 1 % at 1 m/s and 1 ms), so they grow with speed.
    Wrong: where the leather gives so far, or is so wide, that its contact is no point; the compression beside R + r
    (which changes the effect itself by a part of that order again) and the cue's turning are left out. Source: rigid
    kinematics of two spheres, written out in `cuefem.contact.nonlinear`. Cost: stepped in time to about 1e-10.
    """

    once: ClassVar[bool] = True

    def add_to_contact(self, terms: ContactTerms) -> None:
        """The normal turns."""
        terms.turn()
