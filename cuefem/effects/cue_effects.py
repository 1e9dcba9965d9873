"""Effects on the cue: point masses, supports, joints, damping, axial waves, geometric stiffness."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Annotated, ClassVar

import numpy as np

from cuefem.cue import POSITION_TOLERANCE, Array, Cue, Segment
from cuefem.effects.effect import CueEffect, TrialValues
from cuefem.quantity.fields import DIAMETER, LENGTH, Quantity

if TYPE_CHECKING:
    from cuefem.beam.axial_modes import RodModes
    from cuefem.beam.modes import Modes
    from cuefem.beam.point_terms import PointTerms
    from cuefem.beam.tip_modes import TipModes

MIN_BUTT_LENGTH = 0.05  # m: shortest butt behind a drawing that is a rod
# Rod modes beside fewer bending modes. Wood has fewer than bending modes; where axial waves have 100 m/s, these many of
# a butt of 0.75 m reach 10 kHz.
MAX_ROD_MODES = 160
BUTT_FIELDS = "cue_length, butt_diameter and wave_speed"


@dataclass(frozen=True, kw_only=True)
class PointMass(CueEffect):
    """A small heavy piece on the cue, such as a clip, a joint pin or a weight bolt.

    Parameters
    ----------
    position : float
        Distance from the tip, m.
    mass : float
        Mass, kg.
    rotary_inertia : float, default 0
        Moment of inertia against turning with the cue, kg m^2.
    axial_share : float, default 1
        Part of the mass that moves axially with the cue: 1 for a piece fixed to it, 0 for a bridge hand, through which
        the cue slides.

    Notes
    -----
    Adds: The mass to the bending motion, its axial share to the axial motion, and the rotary inertia to the rotation of
    the section.

    Matters when: The piece sits near the tip, within the distance that bending waves travel during the contact.

    Wrong when: The piece is longer than a bending wave that matters, or it stiffens the shaft.

    Limit: The effect vanishes in proportion to its mass and its rotary inertia as both go to zero.

    Source: handbook: Effects; D. Alciatore, Billiards Digest, February 2008: binder clips on a shaft.

    Examples
    --------
    >>> import cuefem as cf
    >>> wood = cf.Material(E=12.6e9, G=0.84e9, rho=700.0)
    >>> shaft = cf.Cue((cf.Segment(0.7, 0.0125, 0.021, wood),), body_mass=0.42)
    >>> cf.end_mass(cf.Scene(shaft, effects=(cf.PointMass(position=0.05, mass=5e-3),))) > cf.end_mass(cf.Scene(shaft))
    True
    """

    part_of_cue: ClassVar[bool] = True

    position: Annotated[float, Quantity("m", "[0, inf)").with_typical_range(0.01, 1.6)]
    mass: Annotated[float, Quantity("kg", "[0, inf)").with_typical_range(5e-4, 0.1)]
    rotary_inertia: Annotated[float, Quantity("kg m^2", "[0, inf)")] = 0.0
    axial_share: Annotated[float, Quantity("", "[0, 1]")] = 1.0

    @property
    def axial_mass(self) -> float:
        """The axial share of the mass, kg."""
        return self.axial_share * self.mass

    @property
    def positions(self) -> tuple[float, ...]:
        """The position of the piece."""
        return (self.position,)

    def add_to(self, terms: PointTerms) -> None:
        """Add the mass and the rotary inertia."""
        terms.add_mass(self.position, self.mass, self.rotary_inertia)

    def mass_on_face(self, cue: Cue) -> float | None:
        """The mass, if it is at the tip and has no rotary inertia."""
        return self.mass if self.position == 0 and self.rotary_inertia == 0 else None


@dataclass(frozen=True)
class Support(CueEffect):
    """A lateral support of the cue: a bridge hand, a grip, or a clamp in a test stand.

    Parameters
    ----------
    position : float
        Distance from the tip, m.
    stiffness : float, default 0
        Stiffness against deflection, N/m. Infinity clamps the deflection.
    rotational_stiffness : float, default 0
        Stiffness against rotation, N m/rad. Infinity clamps the rotation.
    dashpot : float, default 0
        Damping of the deflection, N s/m.

    Notes
    -----
    Adds: Two springs and a dashpot act on deflection and rotation; an infinite stiffness removes the degree of freedom
    that it clamps. Nothing acts along the axis.

    Matters when: The support is stiff and near the tip; a bridge hand is too soft to change squirt much.

    Wrong when: The hand's nonlinearity or its sliding along the cue matters. A clamped beam also vibrates 1e-3 lower in
    frequency than a beam with a clamped solid face.

    Limit: The effect vanishes in proportion to both stiffnesses and the dashpot as all three go to zero.

    Source: handbook: Effects.

    Examples
    --------
    >>> import cuefem as cf
    >>> wood = cf.Material(E=12.6e9, G=0.84e9, rho=700.0)
    >>> shaft = cf.Cue((cf.Segment(0.7, 0.0125, 0.021, wood),), body_mass=0.42)
    >>> hand = cf.Support(0.2, stiffness=5e3)
    >>> bool(cf.modes(shaft, 3, effects=(hand,)).frequencies[0] > 0)
    True
    """

    trial_values: ClassVar[TrialValues | None] = TrialValues(
        {"position": 0.2032, "stiffness": 5e3}, "a bridge hand 8 in behind the tip (assumed)"
    )

    position: Annotated[float, Quantity("m", "[0, inf)").with_typical_range(0.01, 1.6)]
    stiffness: Annotated[float, Quantity("N/m", "[0, inf]")] = 0.0
    rotational_stiffness: Annotated[float, Quantity("N m/rad", "[0, inf]")] = 0.0
    dashpot: Annotated[float, Quantity("N s/m", "[0, inf)")] = 0.0

    @property
    def positions(self) -> tuple[float, ...]:
        """The position of the support."""
        return (self.position,)

    def add_to(self, terms: PointTerms) -> None:
        """Add the springs and the dashpot."""
        terms.add_springs(self.position, self.stiffness, self.rotational_stiffness)
        terms.add_dashpot(self.position, self.dashpot)


@dataclass(frozen=True)
class Joint(CueEffect):
    """A compliant joint of the cue: a pin with its collars, or a loose ferrule.

    Parameters
    ----------
    position : float
        Distance from the tip, m, between the two ends of the cue.
    rotational_compliance : float, default 0
        Jump of the rotation for each unit of bending moment, rad/(N m).
    shear_compliance : float, default 0
        Jump of the deflection for each unit of shear force, m/N.

    Notes
    -----
    Adds: Rotation and deflection may jump at the joint, two more degrees of freedom; a compliance of zero removes its
    own again. Other effects at the same position are attached to the butt side.

    Matters when: The joint lies within the distance that bending waves travel during the contact; the joint in the
    middle of a cue has little effect.

    Wrong when: The joint rattles or dissipates energy.

    Limit: The effect vanishes in proportion to both compliances as they go to zero.

    Source: handbook: Effects; two springs in series with the beam.

    Examples
    --------
    >>> import cuefem as cf
    >>> wood = cf.Material(E=12.6e9, G=0.84e9, rho=700.0)
    >>> shaft = cf.Cue((cf.Segment(0.7, 0.0125, 0.021, wood),), body_mass=0.42)
    >>> loose = cf.modes(shaft, 3, effects=(cf.Joint(0.35, rotational_compliance=1e-3),))
    >>> bool(loose.frequencies[0] < cf.modes(shaft, 3).frequencies[0])
    True
    """

    part_of_cue: ClassVar[bool] = True

    position: Annotated[float, Quantity("m", "(0, inf)").with_typical_range(0.01, 1.6)]
    rotational_compliance: Annotated[float, Quantity("rad/(N m)", "[0, inf)")] = 0.0
    shear_compliance: Annotated[float, Quantity("m/N", "[0, inf)")] = 0.0

    @property
    def positions(self) -> tuple[float, ...]:
        """The position of the joint."""
        return (self.position,)

    @property
    def joint_positions(self) -> tuple[float, ...]:
        """The position of the joint, unless both compliances are zero."""
        return (self.position,) if self.rotational_compliance or self.shear_compliance else ()

    def check_on(self, cue: Cue, name: str) -> None:
        """ValueError unless the joint lies between the ends of the cue."""
        if not POSITION_TOLERANCE * cue.length < self.position < cue.length * (1 - POSITION_TOLERANCE):
            raise ValueError(
                f"{name}.position must be in (0, {cue.length}) m, between the ends of the cue; got {self.position}"
            )

    def add_to(self, terms: PointTerms) -> None:
        """Add the compliances; those of several joints at one position add."""
        if self.joint_positions:
            terms.join(self.position, self.shear_compliance, self.rotational_compliance)


@dataclass(frozen=True)
class StructuralDamping(CueEffect):
    """Dissipation of the cue's vibration by the loss factors of its materials.

    Parameters
    ----------
    loss : float or None, default None
        Loss factor used for every material, in [0, 1). Each material's own loss factor is used if it is None.

    Notes
    -----
    Adds: Each vibrating mode of angular frequency omega and loss factor eta is damped at the rate eta omega, its
    half-power width. The mode's loss factor is the mean of the materials' loss factors, weighted by the strain energy
    that each material stores in this mode. Springs and joints store energy without loss.

    Matters when: The decay of the free vibration is computed. Within one contact it has little effect: an oscillation
    loses pi times the loss factor of its amplitude in a period.

    Wrong when: The loss factors of E and G differ or vary with frequency, or the damping couples the modes.
    Stiffness-proportional damping is not used because its damping of high modes is too large.

    Limit: The effect vanishes in proportion to the loss factors as they go to zero.

    Source: handbook: Effects; modal strain energy, Ungar & Kerwin, JASA 34 (1962) 954.

    Examples
    --------
    >>> import cuefem as cf
    >>> wood = cf.Material(E=12.6e9, G=0.84e9, rho=700.0, loss=0.012)
    >>> shaft = cf.Cue((cf.Segment(0.7, 0.0125, 0.021, wood),), body_mass=0.42)
    >>> 0 < cf.end_mass(cf.Scene(shaft, effects=(cf.StructuralDamping(),)))
    True
    """

    trial_values: ClassVar[TrialValues | None] = TrialValues({"loss": 0.012}, "maple's loss factor, for every material")

    loss: Annotated[float | None, Quantity("", "[0, 1)")] = None

    def damp(self, tip: TipModes, families: Sequence[tuple[Cue, Modes | RodModes]]) -> TipModes:
        """The tip modes with every vibrating mode damped."""
        from cuefem.effects.damping import damp_tip_modes  # loaded when used: it solves the beam

        return damp_tip_modes(tip, families, loss=self.loss)


@dataclass(frozen=True)
class AxialWaves(CueEffect):
    """Axial waves: the cue is an elastic rod along its axis instead of a rigid body.

    Parameters
    ----------
    cue_length : float, optional
        Length of the whole cue, m. `Cue.body_mass` is then a rod that tapers from the end of the drawing to the butt.
        By default, and if the rod would be shorter than 5 cm, that mass is rigid at the end of the drawing. The rod is
        solid behind a bored segment too: only its mass, length and wave speed matter.
    butt_diameter : float, optional
        Diameter at the end of the butt, m; with ``cue_length``.
    wave_speed : float, optional
        Speed of axial waves in the butt, the root of E over its density, at least 100 m/s; with ``cue_length``.

    Notes
    -----
    Adds: Rod modes below the highest bending frequency join the rigid axial motion, with a truncation correction if the
    bending modes have one. Only axial motion uses the rod behind the drawing: bending, weights and natural frequencies
    are those of the drawing. Point masses act at their positions.
    Leather drawn at the tip (`Cue.leather_height`) is rigid along the axis, because the force-indentation law contains
    its compliance; its mass remains.

    Matters when: The contact is long enough for waves to run along the cue and back. The contact of a spring tip lasts
    longer, because the tip's stiffness is still defined with the rigid axial mass, and the ball leaves a little faster,
    because the rod returns all of its energy. A rigid mass at the joint reflects waves earlier than a butt, which
    changes squirt too.

    Wrong when: The butt's mass is uneven, as with a heavy pin or bolt. A support or a joint acts along the axis; here
    neither does. The compliance of a hard tip drawn into the cue (phenolic) counts in the force-indentation law and, a
    little, again in the rod.

    Limit: The effect vanishes as the axial stiffness EA goes to infinity; the longer contact and the changed squirt
    fall as 1/EA.

    Source: handbook: The beam, The strike, Effects.

    Examples
    --------
    >>> import cuefem as cf
    >>> wood = cf.Material(E=12.6e9, G=0.84e9, rho=700.0)
    >>> shaft = cf.Cue((cf.Segment(0.7, 0.0125, 0.021, wood),), body_mass=0.42)
    >>> rigid = cf.strike(cf.Scene(shaft))
    >>> waves = cf.AxialWaves(cue_length=1.47, butt_diameter=0.03, wave_speed=4430.0)
    >>> rigid.duration < cf.strike(cf.Scene(shaft, effects=(waves,))).duration
    True
    """

    once: ClassVar[bool] = True
    changes_bending: ClassVar[bool] = False
    trial_values: ClassVar[TrialValues | None] = TrialValues(
        {"cue_length": 1.4732, "butt_diameter": 0.03175, "wave_speed": 4430.0}, "a pool cue's: 58 in, 1.25 in, maple"
    )

    cue_length: Annotated[float | None, LENGTH] = None
    butt_diameter: Annotated[float | None, DIAMETER] = None
    wave_speed: Annotated[float | None, Quantity("m/s", "[100, inf)")] = None

    def __post_init__(self) -> None:
        super().__post_init__()
        if len({value is None for value in (self.cue_length, self.butt_diameter, self.wave_speed)}) > 1:
            raise ValueError(f"AxialWaves must be given {BUTT_FIELDS} together, or none of them; got {self}")

    def with_butt(self, cue: Cue) -> Cue:
        """The cue with its butt as a segment; unchanged without a butt, or with one that is too short.

        The butt begins at the last full section (`_full_segments`), and replaces what is drawn behind it.
        """
        if self.cue_length is None or self.butt_diameter is None or self.wave_speed is None or not cue.body_mass:
            return cue
        if self.cue_length - cue.length < MIN_BUTT_LENGTH:
            return cue
        full = _full_segments(cue)
        length, last = self.cue_length - float(cue.nodes[full]), cue.segments[full - 1]
        mass = cue.body_mass + math.fsum(segment.mass for segment in cue.segments[full:])
        first = last.butt_diameter
        area_ratio = first**2 + first * self.butt_diameter + self.butt_diameter**2
        rho = mass / (math.pi / 12 * area_ratio * length)
        modulus_ratio = rho * self.wave_speed**2 / last.material.E
        wood = replace(last.material, E=modulus_ratio * last.material.E, G=modulus_ratio * last.material.G, rho=rho)
        butt = Segment(length, first, self.butt_diameter, wood)
        return replace(cue, segments=(*cue.segments[:full], butt), body_mass=0.0)

    def axial_modes(self, bending: Modes, cue: Cue, effects: Sequence[CueEffect]) -> tuple[RodModes, ...]:
        """The rod modes."""
        from cuefem.beam.axial_modes import rod_modes  # loaded when used: it solves the beam

        rod, n_corrected = self.with_butt(cue), int(bending.radiation is not None)
        max_count = max(MAX_ROD_MODES, len(bending.omega))
        masses = tuple(point_masses_on(rod, effects))
        nodes = bending.system.mesh.nodes
        nodes = nodes[np.isin(nodes, [*rod.nodes, *(x for x, _ in masses)])]  # without those that divide a segment
        if rod is not cue:
            nodes = np.append(nodes, rod.length)
        resolved = rod_modes(
            rod,
            tuple(nodes.tolist()),
            masses,
            cutoff=bending.resolved,
            max_count=max_count,
            n_corrected=n_corrected,
        )
        return (resolved.below(bending.cutoff),)


@dataclass(frozen=True)
class GeometricStiffness(CueEffect):
    """Geometric stiffness: the axial force of the impact bends the bent shaft further (P-delta).

    Notes
    -----
    Adds: The second-order theory of a beam-column (geometric stiffness, P-delta). Bending shortens the cue by half the
    integral of p w'^2, where p is the share of the cue's mass behind each position and of the axial force there. The
    axial force loads the bending modes in proportion to their slopes. Energy is conserved. Slopes of rigid-body
    rotation count, and so does the piece from the end of the shaft to the centre of the dome.

    Matters when: Always for squirt, the more the harder the stroke; at small speeds in proportion to speed.

    Wrong when: The slope of the shaft exceeds 0.25 rad, which raises an error. The share p is that of a cue that is
    rigid along its axis, also with `AxialWaves`. Natural frequencies, side strikes and end masses other than "squirt"
    are without axial force. A joint with shear compliance has no length.

    Limit: The effect vanishes in proportion to the axial force, that is to the speed of the stroke.

    Source: handbook: The strike; S. P. Timoshenko and J. M. Gere, Theory of Elastic Stability (1961), chapters 1 and 2.

    Examples
    --------
    >>> import cuefem as cf
    >>> wood = cf.Material(E=12.6e9, G=0.84e9, rho=700.0)
    >>> shaft = cf.Cue((cf.Segment(0.7, 0.0125, 0.021, wood),), body_mass=0.42)
    >>> hard = cf.Stroke(speed=6.0, offset=0.3)
    >>> straight = cf.strike(cf.Scene(shaft, stroke=hard))
    >>> bent = cf.strike(cf.Scene(shaft, stroke=hard, effects=(cf.GeometricStiffness(),)))
    >>> bent.squirt < straight.squirt
    True
    """

    once: ClassVar[bool] = True
    changes_bending: ClassVar[bool] = False
    trial_values: ClassVar[TrialValues | None] = TrialValues({}, "the cue's own shape and mass")

    def geometric_stiffness(self, bending: Modes, cue: Cue, effects: Sequence[CueEffect]) -> Array | None:
        """Geometric stiffness of the bending modes per newton of axial force."""
        vectors = np.concatenate([bending.rigid_vectors, bending.vectors], axis=1)
        return bending.system.geometric_stiffness(vectors, point_masses_on(cue, effects))


def _full_segments(cue: Cue) -> int:
    """Number of segments up to the last full section, the widest end of a segment in the last `MIN_BUTT_LENGTH`.

    A joint end drawn narrower, such as a pin or a chamfer, is inside the butt or a step of its surface.
    """
    ends = [segment.butt_diameter for segment in cue.segments]
    near = np.flatnonzero(cue.nodes[1:] > cue.length - MIN_BUTT_LENGTH)
    return 1 + max(near.tolist(), key=lambda i: (ends[i], i))


def point_masses_on(cue: Cue, effects: Sequence[CueEffect]) -> list[tuple[float, float]]:
    """(position m, mass kg) of all point masses on a cue, with its body mass."""
    masses = [(effect, effect.mass_on(cue)) for effect in effects]
    return [*((effect.positions[0], mass) for effect, mass in masses if mass), (cue.length, cue.body_mass)]
