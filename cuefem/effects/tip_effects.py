"""Effects at the contact between tip and ball."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, ClassVar

from cuefem.effects.contact_terms import ContactTerms, PowerLaw
from cuefem.effects.effect import TipEffect, TrialValues
from cuefem.quantity.fields import Quantity


@dataclass(frozen=True)
class TipDome(TipEffect):
    """The round end of the tip: the contact lies off the cue's axis, so that an axial force bends the shaft.

    Parameters
    ----------
    radius : float
        Radius of the dome, m.

    Notes
    -----
    Adds: The contact point moves with the end section of the cue, as the surface of a rigid dome does. At a contact
    angle phi it lies r sin(phi) off the axis and r (1 - cos(phi)) behind the apex, so the inverse mass B gains terms
    that couple the motion along the cue with the motion across it.

    Matters when: Always: no other effect changes squirt as much (studies/contact/effects.md). A truncated modal sum
    then converges very slowly.

    Wrong when: The leather shears or flattens so much that its surface does not follow the end section.

    Limit: The effect vanishes in proportion to the radius as the radius goes to zero.

    Source: handbook: Effects; the geometry. [Kim] section 2 mentions the off-axis contact and drops it.

    Examples
    --------
    >>> import cuefem as cf
    >>> wood = cf.Material(E=12.6e9, G=0.84e9, rho=700.0)
    >>> shaft = cf.Cue((cf.Segment(0.7, 0.0125, 0.021, wood),), body_mass=0.42)
    >>> bare = cf.Scene(shaft, stroke=cf.Stroke(offset=0.3))
    >>> domed = cf.Scene(shaft, stroke=cf.Stroke(offset=0.3), effects=(cf.TipDome(9.5e-3),))
    >>> cf.strike(domed).squirt > cf.strike(bare).squirt
    True
    """

    needs_beam: ClassVar[bool] = True  # a lumped cue has its coupling for it
    trial_values: ClassVar[TrialValues | None] = TrialValues(
        {"radius": 9.5e-3}, "between a dime's radius (8.95 mm) and a nickel's (10.6 mm)"
    )

    radius: Annotated[float, Quantity("m", "[0, inf)").with_typical_range(0.005, 0.02)]

    def add_to_contact(self, terms: ContactTerms) -> None:
        """The dome: moment arms and radii of two domes add."""
        terms.add_dome(self.radius)


@dataclass(frozen=True)
class TipShear(TipEffect):
    """Tangential compliance of the leather: a massless contact patch on a spring.

    Parameters
    ----------
    ratio : float
        Stiffness of the spring over the loading stiffness of the tip, in (0, inf). Mindlin's value for a circular
        contact is 2 (1 - nu)/(2 - nu), which is 0.75 at a Poisson ratio nu of 0.4.

    Notes
    -----
    Adds: One state, the force of a lossless tangential spring, which Coulomb friction limits to mu F_n.

    Matters when: The strike is off centre. At first touch F_t/F_n is ratio tan(phi), so the tip does not slip at first
    as long as that is below mu. Squirt falls strongly as the ratio falls.

    Wrong when: The leather dissipates tangential work, part of the contact patch slips while the rest sticks, or a
    leather segment drawn into the cue adds lateral compliance.

    Limit: The effect vanishes as 1/ratio as the ratio goes to infinity. With infinite friction it does not, because
    nothing damps the vibration of the patch there.

    Source: handbook: Effects; R. D. Mindlin, J. Appl. Mech. 16 (1949).

    Examples
    --------
    >>> import cuefem as cf
    >>> cue, stroke = cf.LumpedCue(mass=0.54, end_mass=0.006), cf.Stroke(offset=0.3)
    >>> sheared = cf.strike(cf.Scene(cue, stroke=stroke, effects=(cf.TipShear(0.75),)))
    >>> sheared.squirt < cf.strike(cf.Scene(cue, stroke=stroke)).squirt
    True
    """

    trial_values: ClassVar[TrialValues | None] = TrialValues(
        {"ratio": 0.75}, "Mindlin's 2 (1 - nu)/(2 - nu) at nu 0.4, round"
    )

    ratio: Annotated[float, Quantity("", "(0, inf)")]

    def add_to_contact(self, terms: ContactTerms) -> None:
        """The tangential spring; compliances of springs in series add."""
        terms.add_compliance(1 / self.ratio)


@dataclass(frozen=True)
class PowerLawTip(TipEffect):
    """A tip that stiffens with indentation: its force is a power of the indentation.

    Parameters
    ----------
    exponent : float, default 1.5
        Exponent of the loading curve, in [1, 10]. 3/2 is Hertz's law for round bodies; 1 is the base model.
    speed : float, default 1.0
        Speed of the head-on stroke, m/s, that has the tip's contact time.

    Notes
    -----
    Adds: During loading the force is F = k' d^exponent instead of k d. The constant k' makes the contact time of a
    central impact at `speed` that of the tip. The tip unloads on the same curve with the indentation scaled by e^2,
    F = F_peak ((d - d0)/(e^2 d_peak))^exponent with d0 = (1 - e^2) d_peak, which returns exactly the part e^2 of the
    work; below the former peak it reloads on that curve. A `TipShear` keeps its constant spring, ratio
    times the base model's k.

    Matters when: The speed of the stroke varies. The contact time falls with the speed as U^((1 - exponent)/(1 +
    exponent)), and squirt falls with it.

    Wrong when: The restitution falls with speed, or the indentation approaches the height of the leather.

    Limit: The effect vanishes as the exponent goes to 1.

    Source: handbook: Effects; Hertz 1882; [Stronge] chapter 6.

    Examples
    --------
    >>> import cuefem as cf
    >>> cue, law = cf.LumpedCue(mass=0.54, end_mass=0.006), (cf.PowerLawTip(1.5),)
    >>> slow = cf.strike(cf.Scene(cue, stroke=cf.Stroke(1.0, 0.3), effects=law))
    >>> cf.strike(cf.Scene(cue, stroke=cf.Stroke(4.0, 0.3), effects=law)).duration < slow.duration
    True
    """

    once: ClassVar[bool] = True
    trial_values: ClassVar[TrialValues | None] = TrialValues(
        {"exponent": 1.5}, "Hertz; the tip's contact time is meant at 1 m/s"
    )

    exponent: Annotated[float, Quantity("", "[1, 10]")] = 1.5
    speed: Annotated[float, Quantity("m/s", "(0, inf)")] = 1.0

    def add_to_contact(self, terms: ContactTerms) -> None:
        """The power law."""
        terms.law = PowerLaw(self.exponent, self.speed)


@dataclass(frozen=True)
class RollingContact(TipEffect):
    """The contact point rolls over ball and tip, which turns the direction of the contact.

    Notes
    -----
    Adds: The angle of the contact becomes a state. It grows while the tip moves past the ball's centre, at a rate equal
    to the velocity of the dome's centre less that of the ball's centre, along the tangent, over R + r. Here r is the
    radius of the `TipDome`; without one the tip is a sharp point.

    Matters when: The stroke is fast: squirt and spin change in proportion to U T/R.

    Wrong when: The contact patch is not small. The indentation is neglected beside R + r, a relative error of the
    effect of the order U T/R, and so is the rotation of the cue.

    Limit: The effect vanishes in proportion to U T/R, as the stroke becomes slow or the contact short.

    Source: handbook: Effects; rigid kinematics of two spheres.

    Examples
    --------
    >>> import cuefem as cf
    >>> cue, stroke = cf.LumpedCue(mass=0.54, end_mass=0.006), cf.Stroke(1.0, 0.3)
    >>> turned = cf.strike(cf.Scene(cue, stroke=stroke, effects=(cf.RollingContact(),))).squirt
    >>> abs(turned / cf.strike(cf.Scene(cue, stroke=stroke)).squirt - 1) < 0.05
    True
    """

    once: ClassVar[bool] = True
    trial_values: ClassVar[TrialValues | None] = TrialValues({}, "ball's and dome's own radii")

    def add_to_contact(self, terms: ContactTerms) -> None:
        """The normal turns."""
        terms.turns = True
