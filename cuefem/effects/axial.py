"""Modes of a cue as a rod along its axis, on the mesh of the beam: stiffness EA, mass rhoA, and lumps at nodes."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from cuefem.beam.basis import line_basis, table
from cuefem.beam.modes import lowest
from cuefem.beam.system import System, gather
from cuefem.beam.tail import inverse, ritz
from cuefem.cue import Array, Section


@dataclass(frozen=True)
class RodModes:
    """Flexible rod modes with ascending frequency.

    vectors: (unknowns, n), the axial displacement in each mode, mass-normalised and positive at the tip. radiation:
    (tail, tail), 1/s, the damping of the last modes if they are a tail (`cuefem.beam.tail`); None without a tail.
    """

    vectors: Array
    system: System
    radiation: Array | None = None

    @cached_property
    def strains(self) -> Array:
        """Strain times the root of stiffness at the Gauss points, (elements, q, n)."""
        mesh = self.system.mesh
        _, slopes = _chain_basis(mesh.order)
        own = self.vectors[_first(self.system)[:, None] + np.arange(len(slopes))]  # (elements, unknowns of one, n)
        root = np.sqrt(self.system.section.EA * table(mesh.order).weights / mesh.sizes[:, None])
        return np.asarray(root[:, :, None] * (slopes.T @ own))

    @property
    def omega(self) -> Array:
        """Angular frequencies, rad/s, (n,), from the strain energy, which is exact to rounding for low modes too."""
        return np.sqrt(np.sum(self.strains**2, axis=(0, 1)))

    @property
    def along(self) -> Array:
        """Displacement of the tip, 1/sqrt(kg), (n,)."""
        return self.vectors[0]

    def loss_factors(self, loss: Section) -> Array:
        """Loss factor of every mode, (n,), from the loss factor of EA at the Gauss points, (elements, q)."""
        return np.einsum("eq,eqn->n", loss.EA, self.strains**2) / self.omega**2


def _chain_basis(order: int) -> tuple[Array, Array]:
    """Basis functions and their derivatives at the Gauss points, each (order + 1, q): tip end, bubbles, butt end."""
    values, slopes = line_basis(order, table(order).points)
    chain = np.r_[0, 2 : order + 1, 1]
    return values[chain], slopes[chain]


def _first(system: System) -> NDArray[np.intp]:
    """The first unknown of every element; neighbours share one unknown."""
    return system.mesh.order * np.arange(len(system.mesh.piece))


def rod_modes(
    system: System, masses: Sequence[tuple[float, float]], *, below: float, leather: float = 0.0, tailed: bool = False
) -> RodModes:
    """Rod modes up to the angular frequency ``below``, rad/s, of an assembled beam that is free at both ends.

    masses: (position m, mass kg) of each lump. leather: length, m, of the piece that moves rigidly with the tip; it
    ends at a node. tailed: whether to add the tail of the modes left out. The element matrices are exact; the cost is
    one symmetric eigenproblem with order times elements unknowns.
    """
    front = system.mesh.node(leather)
    K, M = _matrices(system, masses, front)
    shift = _shift(system)
    count = min(_modes_below(system, below) + len(masses), K.shape[0] - 2)
    _, vectors = lowest(K, M, count=count + 1, shift=shift)
    vectors *= np.where(vectors[0] < 0, -1.0, 1.0)
    flexible = RodModes(_whole(vectors[:, 1:], system, front), system)  # the first is the rigid motion
    kept = vectors[:, : 1 + int(np.sum(flexible.omega <= below))]
    radiation = None
    if tailed:
        tip = np.eye(len(vectors), 1)
        more = ritz(kept, K, M, tip, shift=shift, deflect=inverse(K + shift * M), highest=below)
        kept, radiation = np.concatenate([kept, more.vectors], axis=1), more.radiation
    return RodModes(_whole(kept[:, 1:], system, front), system, radiation)


def _matrices(system: System, masses: Sequence[tuple[float, float]], front: int) -> tuple[Any, Any]:
    """K and M of the rod behind node ``front``, which carries the mass of everything before it."""
    mesh, section = system.mesh, system.section
    values, slopes = _chain_basis(mesh.order)
    weights, sizes = table(mesh.order).weights, mesh.sizes[:, None]
    stiff = np.einsum("eq,iq,jq->eij", (section.EA * weights / sizes)[front:], slopes, slopes)
    heavy = np.einsum("eq,iq,jq->eij", (section.rhoA * weights * sizes)[front:], values, values)
    first = _first(system)[: len(stiff)]
    unknowns = int(first[-1]) + mesh.order + 1
    lumps = np.zeros(unknowns)
    lumps[0] = np.sum((section.rhoA * weights * sizes)[:front])
    for x, mass in masses:
        lumps[mesh.order * max(mesh.node(x) - front, 0)] += mass
    return gather(first, unknowns, stiff, point=np.zeros(unknowns)), gather(first, unknowns, heavy, point=lumps)


def _whole(vectors: Array, system: System, front: int) -> Array:
    """Vectors of all unknowns of the cue from those behind node ``front``.

    The nodes before it move with it, and the bubbles there vanish.
    """
    order = system.mesh.order
    before = np.zeros((order * front, vectors.shape[1]))
    before[::order] = vectors[0]
    return np.concatenate([before, vectors])


def _modes_below(system: System, omega: float) -> int:
    """About how many flexible rod modes lie below ``omega`` rad/s: the phase of the waves over pi, and one a piece."""
    section, mesh = system.section, system.mesh
    slowness = np.sqrt(section.rhoA / section.EA) @ table(mesh.order).weights
    return int(omega * (slowness @ mesh.sizes) / np.pi) + 2 + int(mesh.piece[-1])


def _shift(system: System) -> float:
    # pi^2 EA/(rhoA L^2), the lowest free mode of the uniform rod with the mean stiffness and mass
    stiffness, mass = (
        float(system.mesh.sizes @ part.mean(axis=1)) for part in (system.section.EA, system.section.rhoA)
    )
    return 10 * stiffness / mass / system.length**2
