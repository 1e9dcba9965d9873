"""Effects that act on the cue: lumps, supports, joints, damping, waves along the axis."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Annotated, ClassVar

from cuefem.cue import Cue
from cuefem.effects.base import NEAR, AxialVibrations, CueEffect, Vibrations
from cuefem.quantity import Quantity

if TYPE_CHECKING:
    from cuefem.beam.mesh import Terms
    from cuefem.beam.modes import Modes
    from cuefem.beam.tip import TipModes


@dataclass(frozen=True)
class PointMass(CueEffect):
    """A lump on the cue: clay, a pin, a weight bolt.

    Adds: mass, kg, to deflection and to the axial motion, and rotary_inertia, kg m2, to rotation, at position, m from
    the tip. Matters: near the tip, within the distance that bending waves travel in a contact. Wrong: where the lump
    is longer than a bending wave of interest, or stiffens the shaft. Source: physics.md section 8; [BD Feb 2008] clay.
    """

    position: Annotated[float, Quantity("m", "[0, inf)")]
    mass: Annotated[float, Quantity("kg", "[0, inf)")]
    rotary_inertia: Annotated[float, Quantity("kg m^2", "[0, inf)")] = 0.0

    @property
    def axial_mass(self) -> float:
        """The lump moves with the cue."""
        return self.mass

    @property
    def positions(self) -> tuple[float, ...]:
        """The lump's own."""
        return (self.position,)

    def add_to(self, terms: Terms) -> None:
        """The lump's inertia."""
        terms.add(self.position, "mass", self.mass, self.rotary_inertia)


@dataclass(frozen=True)
class Support(CueEffect):
    """What holds the cue from aside: a bridge hand, a grip, a clamp in a test stand.

    Adds: springs stiffness, N/m, and rotational_stiffness, N m/rad, and a dashpot, N s/m, across the cue at position, m
    from the tip; infinite stiffness takes the unknown out (a clamp). Nothing along the axis. Matters: stiff and near
    the tip; a hand (up to 1e4 N/m) 8 in behind it changes squirt by 1 % at most, 1e6 N/m by up to a quarter.
    Wrong: a hand is no linear spring and lets the cue slide; a clamped beam is softer than a clamped solid face by 1e-3
    in frequency. Source: physics.md section 8.
    """

    position: Annotated[float, Quantity("m", "[0, inf)")]
    stiffness: Annotated[float, Quantity("N/m", "[0, inf]")] = 0.0
    rotational_stiffness: Annotated[float, Quantity("N m/rad", "[0, inf]")] = 0.0
    dashpot: Annotated[float, Quantity("N s/m", "[0, inf)")] = 0.0

    @property
    def positions(self) -> tuple[float, ...]:
        """The support's own."""
        return (self.position,)

    @property
    def clamps(self) -> tuple[tuple[str, float], ...]:
        """Deflection, rotation, or both, where the stiffness is infinite."""
        names = ("stiffness", "rotational_stiffness")
        return tuple((name, self.position) for name in names if math.isinf(getattr(self, name)))

    def add_to(self, terms: Terms) -> None:
        """The support's springs and dashpot."""
        terms.add(self.position, "stiffness", self.stiffness, self.rotational_stiffness)
        terms.add(self.position, "dashpot", self.dashpot, 0.0)


@dataclass(frozen=True)
class Joint(CueEffect):
    """A joint of the cue that gives: a pin and its collars, a loose ferrule.

    Adds: at position, m from the tip, between the ends of the cue, a jump of rotation by rotational_compliance,
    rad/(N m), and of deflection by shear_compliance, m/N; zero keeps the two sides together. Two more unknowns, of
    which a zero takes one out again; other effects at its place hold on to the butt side. Matters: within the distance
    that bending waves travel in a contact; at a cue's middle joint hardly. Wrong: a joint that rattles or dissipates.
    Source: two springs in series with the beam; physics.md section 8.
    """

    position: Annotated[float, Quantity("m", "(0, inf)")]
    rotational_compliance: Annotated[float, Quantity("rad/(N m)", "[0, inf)")] = 0.0
    shear_compliance: Annotated[float, Quantity("m/N", "[0, inf)")] = 0.0

    @property
    def positions(self) -> tuple[float, ...]:
        """The joint's own."""
        return (self.position,)

    @property
    def splits(self) -> tuple[float, ...]:
        """The joint's own place, unless it is stiff in both."""
        return (self.position,) if self.rotational_compliance or self.shear_compliance else ()

    def check_on(self, cue: Cue, name: str) -> None:
        """A joint has cue on both sides."""
        if not NEAR * cue.length < self.position < cue.length * (1 - NEAR):
            raise ValueError(
                f"{name}.position must be in (0, {cue.length}) m, between the ends of the cue; got {self.position}"
            )

    def add_to(self, terms: Terms) -> None:
        """The joint's compliances; those of joints at one place add up."""
        if self.splits:
            terms.join(self.position, self.shear_compliance, self.rotational_compliance)


@dataclass(frozen=True)
class StructuralDamping(CueEffect):
    """What the cue's materials lose in every swing.

    Adds: to each vibrating mode k the viscous damping eta_k omega_k, 1/s, that loses in a free swing what the mode's
    loss factor eta_k says (half-power width eta_k omega_k); eta_k is the mean of the materials' loss factors (or of
    loss, a pure number in [0, 1), for every material instead), weighted with the strain energy that each material
    stores in that mode; springs and joints store theirs without loss. Matters: hardly within a contact (maple's 0.012
    loses 4 % of a swing's amplitude in a period), much for how long a cue rings. Wrong: loss factors of E and G differ
    and vary with frequency; the coupling of modes by damping is left out. Never proportional to stiffness, which
    overdamps high modes. Source: physics.md section 8; modal strain energy, Ungar & Kerwin, JASA 34 (1962) 954.
    """

    loss: Annotated[float | None, Quantity("", "[0, 1)")] = None

    def damp(self, tip: TipModes, cue: Cue, families: Sequence[Vibrations]) -> TipModes:
        """Diagonal damping of the vibrating modes of every family."""
        from cuefem.effects.loss import damped  # loaded when used: it needs scikit-fem

        return damped(tip, cue, families, loss=self.loss)


@dataclass(frozen=True)
class AxialWaves(CueEffect):
    """Waves along the cue: it is a rod, not rigid along its axis.

    Adds: rod modes (EA u', rho A; body_mass rigid at the butt end, point masses at their places) beside the rigid axial
    motion, as many as lie below the highest bending frequency kept, with a tail where bending has one. Leather drawn at
    the tip (`Cue.leather`) moves as one along the axis: its give is in the tip's law, its mass stays. Matters: a
    contact of 1 ms sees the far end of a cue (4.2 m/ms in maple). It lasts longer, because the tip's stiffness stays
    defined by m_a, and the ball leaves a little faster, because the rod gives back all that it takes: head on 1.1 ms
    and e 0.73 become 1.27 ms and 0.78 on meshes/pool_maple.toml. Wrong: supports do not act along the axis, joints are
    stiff along it; a hard tip drawn into the cue (phenolic, above 1 GPa) gives way in the tip's law and, by about
    1 % of that, in the rod. Source: physics.md sections 4, 5, 8.
    """

    once: ClassVar[bool] = True

    def vibrations(self, found: Modes, cue: Cue, effects: Sequence[CueEffect]) -> tuple[AxialVibrations, ...]:
        """The rod modes."""
        from cuefem.effects.axial import rod_modes  # loaded when used: it needs scikit-fem

        masses = [(effect.positions[0], effect.axial_mass) for effect in effects if effect.axial_mass]
        masses.append((cue.length, cue.body_mass))
        tailed = found.radiation is not None
        return (rod_modes(found.system, masses, below=found.highest, leather=cue.leather, tailed=tailed),)
