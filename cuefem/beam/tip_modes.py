"""Tip modes: the motion of a cue's modes at the tip, which determines an impact. This file imports only numpy."""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from cuefem.cue import Array, LumpedCue

if TYPE_CHECKING:
    from cuefem.beam.modes import Modes


def _none() -> Array:
    return np.zeros((0, 0))


@dataclass(frozen=True, eq=False)
class TipModes:
    """Modes of a cue at the contact: the inverse mass there is B(t) = sum of a_k a_k' cos(omega_k t).

    omega: (n,) rad/s, rigid-body modes (zero) first. amplitude: (n, 2), mass-normalised axial and transverse
    displacement (u, w) of the contact, 1/sqrt(kg). approach: (n,), modal velocities of a cue that moves axially at 1
    m/s, sqrt(kg). rotation: (n,) of the tip's section, 1/(m sqrt(kg)). geometric: (n, n), 1/(m kg), the decrease of the
    modal stiffness per newton of axial force; None without it. A lumped cue has omega = 0 throughout.

    The modal equations are q'' + damping q' + omega^2 q = f. Their damping, (n, n), 1/s, has three parts. loss: (n,),
    in [0, 1), the loss factor of each mode, which damps it at the rate loss omega. dashpots: (d, n), 1/sqrt(s), a row r
    for each dashpot, which dissipates the power (r v)^2 at the modal velocities v. radiation: (n, n), 1/s, whose energy
    is not dissipated: waves carry it into the truncated modes. By default there is no damping.
    """

    omega: Array
    amplitude: Array
    approach: Array
    rotation: Array
    loss: Array = field(default_factory=_none)
    dashpots: Array = field(default_factory=_none)
    radiation: Array = field(default_factory=_none)
    geometric: Array | None = None

    def __post_init__(self) -> None:
        n = len(self.omega)
        for name, shape in (("loss", (n,)), ("dashpots", (0, n)), ("radiation", (n, n))):
            if getattr(self, name).size == 0:
                object.__setattr__(self, name, np.zeros(shape))

    @property
    def damping(self) -> Array:
        """Damping matrix of the modal equations, all parts together, (n, n), 1/s."""
        return np.asarray(np.diag(self.loss * self.omega) + self.dashpots.T @ self.dashpots + self.radiation)

    @cached_property
    def without_geometric_stiffness(self) -> TipModes:
        """These modes without geometric stiffness."""
        return self if self.geometric is None else replace(self, geometric=None)

    @cached_property
    def lateral(self) -> TipModes:
        """The modes that move the tip transversely, without geometric stiffness."""
        return self.without_geometric_stiffness.subset(np.flatnonzero(self.amplitude[:, 1]))

    def subset(self, index: NDArray[np.intp]) -> TipModes:
        """The modes of these indices, in their order."""
        square = np.ix_(index, index)
        return TipModes(
            omega=self.omega[index],
            amplitude=self.amplitude[index],
            approach=self.approach[index],
            rotation=self.rotation[index],
            loss=self.loss[index],
            dashpots=self.dashpots[:, index],
            radiation=self.radiation[square],
            geometric=None if self.geometric is None else self.geometric[square],
        )

    def with_axial_modes(self, omega: Array, axial: Array, radiation: Array | None = None) -> TipModes:
        """These modes followed by n undamped axial modes of tip amplitude ``axial``, (n,), 1/sqrt(kg).

        radiation: of the last of them, if they have a truncation correction.
        """
        total, none = len(self.omega) + len(omega), np.zeros(len(omega))
        of_bending = embedded(self.radiation, total)
        return TipModes(
            omega=np.append(self.omega, omega),
            amplitude=np.concatenate([self.amplitude, np.column_stack([axial, none])]),
            approach=np.append(self.approach, none),
            rotation=np.append(self.rotation, none),
            loss=np.append(self.loss, none),
            dashpots=np.pad(self.dashpots, ((0, 0), (0, len(omega)))),
            radiation=of_bending if radiation is None else of_bending + embedded(radiation, total, -len(radiation)),
            geometric=None if self.geometric is None else embedded(self.geometric, total),
        )

    def ascending(self) -> TipModes:
        """The same modes in the order of their frequencies."""
        return self.subset(np.argsort(self.omega, kind="stable"))

    @property
    def uncoupled(self) -> TipModes:
        """The modes for a centre-ball impact, where a lumped cue's coupling is 0: it changes sign with the offset."""
        if not np.any(self.amplitude[:, 0] * self.amplitude[:, 1]):
            return self
        axial, lateral = np.sqrt(np.sum(self.amplitude**2, axis=0))
        return replace(self, amplitude=np.diag([axial, lateral]), approach=np.array([1 / axial, 0.0]))


def embedded(block: Array, size: int, first: int = 0) -> Array:
    """A square matrix of zeros, (size, size), with a square ``block`` from the index ``first`` on, < 0 from the end."""
    before = first % size
    return np.pad(block, (before, size - before - len(block)))


def lumped_tip_modes(cue: LumpedCue) -> TipModes:
    """The two modes of zero frequency of a lumped cue."""
    root = math.sqrt(cue.mass)
    lateral = math.sqrt(1 / cue.end_mass - cue.coupling**2 * cue.mass)
    amplitude = np.array([[1 / root, cue.coupling * root], [0.0, lateral]])
    return TipModes(np.zeros(2), amplitude, np.linalg.solve(amplitude.T, [1.0, 0.0]), np.zeros(2))


def tip_modes(bending: Modes, axial_mass: float) -> TipModes:
    """Tip modes from bending modes and a rigid-body axial mode of ``axial_mass`` kg, which comes first."""
    omega = np.concatenate([np.zeros(bending.rigid), bending.omega])
    dashpots, radiation = _dampers(bending, 1 + len(omega))
    return replace(free_tip_modes(omega, *bending.at_tip, axial_mass), dashpots=dashpots, radiation=radiation)


def free_tip_modes(omega: Array, deflection: Array, rotation: Array, axial_mass: float) -> TipModes:
    """Tip modes from bending modes, rigid-body modes included, and a rigid-body axial mode of ``axial_mass`` kg."""
    amplitude = np.zeros((1 + len(deflection), 2))
    amplitude[0, 0], amplitude[1:, 1] = axial_mass**-0.5, deflection
    approach = np.zeros(len(amplitude))
    approach[0] = axial_mass**0.5
    return TipModes(np.append(0.0, omega), amplitude, approach, np.append(0.0, rotation))


def side_modes(bending: Modes) -> TipModes:
    """Modes at the contact of a body that strikes the resting beam from the side, at the node of the modes' loads.

    The first direction of the contact is that of the body's rebound, opposite to the deflection w of the beam; in the
    second the beam does not move.
    """
    deflection, rotation = bending.at_tip
    omega = np.concatenate([np.zeros(bending.rigid), bending.omega])
    dashpots, radiation = _dampers(bending, len(omega))
    amplitude = np.column_stack([-deflection, np.zeros(len(omega))])
    return TipModes(omega, amplitude, np.zeros(len(omega)), rotation, dashpots=dashpots, radiation=radiation)


def _dampers(bending: Modes, count: int) -> tuple[Array, Array]:
    """Dashpots and radiation of ``count`` modes, the last of which are ``bending``, as in `TipModes`."""
    dashpots, radiation = _none(), _none()
    if bending.system.dashpots is not None:
        vectors = np.concatenate([bending.rigid_vectors, bending.vectors], axis=1)
        at = np.flatnonzero(bending.system.dashpots)
        rows = np.sqrt(bending.system.dashpots[at])[:, None] * vectors[at]
        dashpots = np.pad(rows, ((0, 0), (count - rows.shape[1], 0)))
    if bending.radiation is not None:
        radiation = embedded(bending.radiation, count, -len(bending.radiation))
    return dashpots, radiation
