"""Modes of a cue as a rod along its axis, on the elements of the beam: stiffness EA, mass rhoA, and lumps at nodes.

Waves along the cue are several times as long as bending waves of the same frequency, so that the rod has polynomial
orders of its own.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from cuefem.beam.basis import line_basis, table
from cuefem.beam.modes import lowest
from cuefem.beam.system import System, gather
from cuefem.beam.tail import inverse, ritz
from cuefem.beam.waves import taper_orders
from cuefem.cue import Array, Cue, Section

# Orders of an element beyond half the phase of the waves along it: frequencies are then right to 1e-12.
SPARE_OF_ROD = 10


@dataclass(frozen=True)
class RodModes:
    """Flexible rod modes with ascending frequency.

    vectors: (unknowns, n), the axial displacement in each mode behind the leather, mass-normalised and positive at the
    tip. chain: the unknowns of the elements there. radiation: (tail, tail), 1/s, the damping of the last modes if they
    are a tail (`cuefem.beam.tail`); None without a tail.
    """

    vectors: Array
    system: System
    chain: _Chain
    radiation: Array | None = None

    @cached_property
    def strains(self) -> Array:
        """Strain times the root of stiffness at the Gauss points, (elements, q, n)."""
        mesh, chain = self.system.mesh, self.chain
        root = np.sqrt(self.system.section.EA * table(mesh.order).weights / mesh.sizes[:, None])
        strained = np.zeros((*root.shape, self.vectors.shape[1]))  # what lies before the chain moves as one piece
        for element, (start, (_, slopes)) in enumerate(zip(chain.first, chain.bases, strict=True), chain.front):
            strained[element] = root[element, :, None] * (slopes.T @ self.vectors[start : start + len(slopes)])
        return strained

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


class _Chain:
    """The unknowns of the elements from node ``front`` on: neighbours share that of their node.

    orders: (elements,), as high as the waves along the cue up to the angular frequency ``below`` and the taper of the
    segments ask for, but no higher than those of the beam. first: (elements,) the first unknown of each.
    """

    def __init__(self, system: System, cue: Cue, front: int, below: float) -> None:
        mesh, section = system.mesh, system.section
        phase = below * mesh.sizes * (np.sqrt(section.rhoA / section.EA) @ table(mesh.order).weights)
        elements = np.bincount(mesh.piece, minlength=len(cue.segments))
        wanted = np.maximum(np.ceil(phase / 2) + SPARE_OF_ROD, taper_orders(cue, elements)[mesh.piece])
        self.front, self.points = front, table(mesh.order).points
        self.orders = np.minimum(wanted, mesh.orders).astype(int)[front:]
        self.first = np.cumsum(self.orders) - self.orders
        self.unknowns = int(self.orders.sum()) + 1

    @cached_property
    def bases(self) -> list[tuple[Array, Array]]:
        """Basis functions of each element and their derivatives at its Gauss points: tip end, bubbles, butt end."""
        values, slopes = line_basis(int(self.orders.max()), self.points)
        rows = [np.r_[0, 2 : order + 1, 1] for order in self.orders.tolist()]
        return [(values[each], slopes[each]) for each in rows]

    def at(self, node: int) -> int:
        """The unknown of a node of the mesh; of those before the chain its first."""
        behind = max(node - self.front, 0)
        return int(self.first[behind]) if behind < len(self.first) else self.unknowns - 1


def rod_modes(
    system: System, cue: Cue, masses: Sequence[tuple[float, float]], *, below: float, tailed: bool = False
) -> RodModes:
    """Rod modes up to the angular frequency ``below``, rad/s, of a cue, free at both ends, that was assembled.

    masses: (position m, mass kg) of each lump. Leather drawn at the tip (`Cue.leather`) moves rigidly with it. tailed:
    whether to add the tail of the modes left out. The element matrices are exact; the cost is one symmetric
    eigenproblem with as many unknowns as the elements' orders add up to.
    """
    chain = _Chain(system, cue, system.mesh.node(cue.leather), below)
    K, M = _matrices(system, masses, chain)
    shift = _shift(system)
    count = min(_modes_below(system, below) + len(masses), K.shape[0] - 2)
    _, vectors = lowest(K, M, count=count + 1, shift=shift)
    vectors *= np.where(vectors[0] < 0, -1.0, 1.0)
    flexible = RodModes(vectors[:, 1:], system, chain)  # the first is the rigid motion
    chosen = vectors[:, : 1 + int(np.sum(flexible.omega <= below))]
    radiation = None
    if tailed:
        tip = np.eye(len(vectors), 1)
        more = ritz(chosen, K, M, tip, shift=shift, deflect=inverse(K + shift * M), highest=below)
        chosen, radiation = np.concatenate([chosen, more.vectors], axis=1), more.radiation
    return RodModes(chosen[:, 1:], system, chain, radiation)


def _matrices(system: System, masses: Sequence[tuple[float, float]], chain: _Chain) -> tuple[Any, Any]:
    """K and M of the rod, whose first unknown carries the mass of everything before it."""
    mesh, section, front = system.mesh, system.section, chain.front
    weights, sizes = table(mesh.order).weights, mesh.sizes[:, None]
    stiffness, mass = section.EA * weights / sizes, section.rhoA * weights * sizes
    stiff = [(slopes * k) @ slopes.T for k, (_, slopes) in zip(stiffness[front:], chain.bases, strict=True)]
    heavy = [(values * m) @ values.T for m, (values, _) in zip(mass[front:], chain.bases, strict=True)]
    lumps = np.zeros(chain.unknowns)
    lumps[0] = np.sum(mass[:front])
    for x, lump in masses:
        lumps[chain.at(mesh.node(x))] += lump
    none = np.zeros(chain.unknowns)
    return gather(chain.first, len(none), stiff, point=none), gather(chain.first, len(none), heavy, point=lumps)


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
