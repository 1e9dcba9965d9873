"""The tip modes, which are all that a ball feels of a cue. This file needs numpy alone."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from cuefem.cue import Array, LumpedCue

if TYPE_CHECKING:
    from cuefem.beam.modes import Modes


@dataclass(frozen=True, eq=False)
class TipModes:
    """All that an impact sees of a cue: B(t) = sum of a_k a_k' cos(omega_k t), the inverse mass at the contact.

    omega: (n,) rad/s, the rigid ones (zero) first. amplitude: (n, 2), the mass-normalised displacement of the contact
    along and across the cue (u, w), 1/sqrt(kg). approach: (n,), the modal velocities of a cue that moves at unit speed
    along its axis, sqrt(kg). rotation: (n,) of the tip's section, 1/(m sqrt(kg)). damping: (n, n) viscous, 1/s, of the
    modal equations q'' + damping q' + omega^2 q = f, or None. radiation: (n, n), likewise, but its energy is not lost:
    it stands for waves that leave the tip in the modes left out. geometric: (n, n), 1/(m kg), what a thrust of 1 N
    takes of the modal stiffness where the shaft bends, or None. In a lumped cue all omega are 0.
    """

    omega: Array
    amplitude: Array
    approach: Array
    rotation: Array
    damping: Array | None = None
    radiation: Array | None = None
    geometric: Array | None = None

    @property
    def resistance(self) -> Array | None:
        """Damping and radiation together, (n, n), 1/s; None without either."""
        parts = [part for part in (self.damping, self.radiation) if part is not None]
        return sum(parts[1:], parts[0]) if parts else None

    @cached_property
    def straight(self) -> TipModes:
        """These modes without the thrust on the bent shaft."""
        return self if self.geometric is None else replace(self, geometric=None)

    def those(self, index: NDArray[np.intp]) -> TipModes:
        """Some of the modes alone, in the order of their numbers ``index``."""
        pairs = (self.damping, self.radiation, self.geometric)
        parts = (None if part is None else part[np.ix_(index, index)] for part in pairs)
        damping, radiation, geometric = (part if part is not None and part.any() else None for part in parts)
        omega, amplitude, approach, rotation = self.omega, self.amplitude, self.approach, self.rotation
        return TipModes(omega[index], amplitude[index], approach[index], rotation[index], damping, radiation, geometric)

    def beside(self, omega: Array, along: Array, radiation: Array | None = None) -> TipModes:
        """These modes followed by n vibrating ones that move the tip by ``along``, (n,), along the cue, undamped.

        radiation: that of the last of them, if they end in a tail.
        """
        n, before = len(omega), len(self.omega)
        own = None if self.radiation is None else np.pad(self.radiation, (0, n))
        if radiation is not None:
            theirs = np.pad(radiation, (before + n - len(radiation), 0))
            own = theirs if own is None else own + theirs
        return TipModes(
            np.concatenate([self.omega, omega]),
            np.concatenate([self.amplitude, np.column_stack([along, np.zeros(n)])]),
            np.concatenate([self.approach, np.zeros(n)]),
            np.concatenate([self.rotation, np.zeros(n)]),
            None if self.damping is None else np.pad(self.damping, (0, n)),
            own,
            None if self.geometric is None else np.pad(self.geometric, (0, n)),
        )

    def ascending(self) -> TipModes:
        """The same modes in the order of their frequencies."""
        return self.those(np.argsort(self.omega, kind="stable"))

    @property
    def uncoupled(self) -> TipModes:
        """The modes for a head-on blow, where a lumped cue's coupling is 0, since it changes sign with the offset."""
        if not np.any(self.amplitude[:, 0] * self.amplitude[:, 1]):
            return self
        along, across = np.sqrt(np.sum(self.amplitude**2, axis=0))
        return replace(self, amplitude=np.diag([along, across]), approach=np.array([1 / along, 0.0]))


def lumped_tip_modes(cue: LumpedCue) -> TipModes:
    """The two modes of zero frequency that give a lumped cue's inverse mass."""
    root = math.sqrt(cue.mass)
    across = math.sqrt(1 / cue.end_mass - cue.coupling**2 * cue.mass)
    amplitude = np.array([[1 / root, cue.coupling * root], [0.0, across]])
    return TipModes(np.zeros(2), amplitude, np.linalg.solve(amplitude.T, [1.0, 0.0]), np.zeros(2))


def tip_modes(bending: Modes, axial_mass: float) -> TipModes:
    """Tip modes of a beam's bending modes beside a rigid axial motion of ``axial_mass`` kg (the first mode)."""
    omega = np.concatenate([np.zeros(bending.rigid), bending.omega])
    damping, radiation = _resistances(bending, 1 + len(omega))
    return replace(free_tip_modes(omega, *bending.at_tip, axial_mass), damping=damping, radiation=radiation)


def free_tip_modes(omega: Array, across: Array, turning: Array, axial_mass: float) -> TipModes:
    """Tip modes of bending modes, the rigid ones among them, beside a rigid axial motion of ``axial_mass`` kg."""
    amplitude = np.zeros((1 + len(across), 2))
    amplitude[0, 0], amplitude[1:, 1] = axial_mass**-0.5, across
    approach = np.zeros(len(amplitude))
    approach[0] = axial_mass**0.5
    return TipModes(np.append(0.0, omega), amplitude, approach, np.append(0.0, turning))


def side_modes(bending: Modes) -> TipModes:
    """All that a body feels which strikes the beam from the side at the node where the modes' loads act.

    The first direction of the contact is that of the body's rebound, against the deflection w of the beam; nothing
    moves along the second. The beam is at rest.
    """
    deflection, turning = bending.at_tip
    omega = np.concatenate([np.zeros(bending.rigid), bending.omega])
    damping, radiation = _resistances(bending, len(omega))
    amplitude = np.column_stack([-deflection, np.zeros(len(omega))])
    return TipModes(omega, amplitude, np.zeros(len(omega)), turning, damping, radiation)


def _resistances(bending: Modes, count: int) -> tuple[Array | None, Array | None]:
    """Damping by dashpots and radiation by a tail of ``count`` modes, of which the ``bending`` ones are the last."""
    damping = None
    if bending.system.dashpots is not None:
        vectors = np.concatenate([bending.rigid_vectors, bending.vectors], axis=1)
        own = vectors.T @ (bending.system.dashpots[:, None] * vectors)
        damping = np.pad(own, (count - len(own), 0))
    radiation = None if bending.radiation is None else np.pad(bending.radiation, (count - len(bending.radiation), 0))
    return damping, radiation
