"""Modes of a cue as a rod along its axis, on a mesh of its own: stiffness EA, mass rhoA, and lumps at nodes.

Waves along the cue are several times as long as bending waves of the same frequency, and the rod may go on where the
drawing ends (`cuefem.effects.AxialWaves`), so that the rod has elements and polynomial orders of its own.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from cuefem.beam.basis import line_basis, table
from cuefem.beam.mesh import Mesh, mesh_cue
from cuefem.beam.modes import lowest
from cuefem.beam.system import gather, sections
from cuefem.beam.tail import inverse, ritz
from cuefem.beam.waves import WIDEST, taper_orders
from cuefem.cue import Array, Cue, Section

# Orders of an element beyond half the phase of the waves along it: frequencies are then right to 1e-12.
SPARE_OF_ROD = 14


@dataclass(frozen=True)
class Rod:
    """A cue's elements along its axis. front: the node that ends the leather; what lies before moves as one piece.

    The unknowns are those of the elements from ``front`` on; neighbours share that of their node.
    """

    cue: Cue
    mesh: Mesh
    section: Section
    front: int

    @classmethod
    def of(cls, cue: Cue, positions: Sequence[float], below: float) -> Rod:
        """Elements and orders, one number a segment each, for waves up to ``below`` rad/s and the segments' taper."""
        phase = below * np.diff(cue.nodes) * _slowness(cue)
        elements = np.ceil(phase / (2 * (WIDEST - SPARE_OF_ROD))).astype(int)
        taper = np.minimum(taper_orders(cue, elements), WIDEST)
        orders = np.maximum(np.ceil(phase / (2 * elements)) + SPARE_OF_ROD, taper).astype(int)
        mesh = mesh_cue(cue, elements=tuple(elements), order=tuple(orders), positions=tuple(positions))
        return cls(cue, mesh, sections(cue, mesh), mesh.node(cue.leather))

    @cached_property
    def first(self) -> Any:
        """The first unknown of each element."""
        orders = self.mesh.orders[self.front :]
        return np.cumsum(orders) - orders

    @property
    def unknowns(self) -> int:
        """Their number."""
        return int(self.mesh.orders[self.front :].sum()) + 1

    @cached_property
    def bases(self) -> list[tuple[Array, Array]]:
        """Basis functions of each element and their derivatives at its Gauss points: tip end, bubbles, butt end."""
        values, slopes = line_basis(self.mesh.order, table(self.mesh.order).points)
        rows = [np.r_[0, 2 : order + 1, 1] for order in self.mesh.orders[self.front :].tolist()]
        return [(values[each], slopes[each]) for each in rows]

    def at(self, node: int) -> int:
        """The unknown of a node of the mesh; of those before the front its first."""
        behind = max(node - self.front, 0)
        return int(self.first[behind]) if behind < len(self.first) else self.unknowns - 1

    def matrices(self, masses: Sequence[tuple[float, float]]) -> tuple[Any, Any]:
        """K and M of the rod, whose first unknown carries the mass of everything before it."""
        mesh, section, front = self.mesh, self.section, self.front
        weights, sizes = table(mesh.order).weights, mesh.sizes[:, None]
        stiffness, mass = section.EA * weights / sizes, section.rhoA * weights * sizes
        stiff = [(slopes * k) @ slopes.T for k, (_, slopes) in zip(stiffness[front:], self.bases, strict=True)]
        heavy = [(values * m) @ values.T for m, (values, _) in zip(mass[front:], self.bases, strict=True)]
        lumps = np.zeros(self.unknowns)
        lumps[0] = np.sum(mass[:front])
        for x, lump in masses:
            lumps[self.at(mesh.node(x))] += lump
        none = np.zeros(self.unknowns)
        return gather(self.first, len(none), stiff, point=none), gather(self.first, len(none), heavy, point=lumps)

    def modes_below(self, omega: float) -> int:
        """About how many flexible modes lie below ``omega`` rad/s: the phase of the waves over pi, and one a piece."""
        phase = omega * float(np.diff(self.cue.nodes) @ _slowness(self.cue))
        return int(phase / np.pi) + 2 + int(self.mesh.piece[-1])

    @property
    def shift(self) -> float:
        """About pi^2 EA/(rhoA L^2), the lowest free mode of the uniform rod with the mean stiffness and mass."""
        stiffness, mass = (float(self.mesh.sizes @ part.mean(axis=1)) for part in (self.section.EA, self.section.rhoA))
        return 10 * stiffness / mass / self.cue.length**2


def _slowness(cue: Cue) -> Array:
    """Mean of sqrt(rho/E) over each segment, s/m, by three points."""
    lengths, pieces = np.diff(cue.nodes), np.arange(len(cue.segments))
    s = cue.section_in(pieces[:, None], lengths[:, None] * np.array([0.5 - 0.15**0.5, 0.5, 0.5 + 0.15**0.5]))
    return np.asarray(np.sqrt(s.rhoA / s.EA) @ np.array([5, 8, 5]) / 18)


@dataclass(frozen=True)
class RodModes:
    """Flexible rod modes with ascending frequency.

    vectors: (unknowns, n), the axial displacement in each mode behind the leather, mass-normalised and positive at the
    tip. radiation: (tail, tail), 1/s, the damping of the last modes if they are a tail (`cuefem.beam.tail`); None
    without a tail.
    """

    vectors: Array
    rod: Rod
    radiation: Array | None = None

    @property
    def system(self) -> Rod:
        """The rod, by the name that it has among all vibrations."""
        return self.rod

    @property
    def cue(self) -> Cue:
        """The rod as a cue."""
        return self.rod.cue

    @cached_property
    def strains(self) -> Array:
        """Strain times the root of stiffness at the Gauss points, (elements, q, n)."""
        mesh, rod = self.rod.mesh, self.rod
        root = np.sqrt(rod.section.EA * table(mesh.order).weights / mesh.sizes[:, None])
        strained = np.zeros((*root.shape, self.vectors.shape[1]))  # what lies before the front moves as one piece
        for element, (start, (_, slopes)) in enumerate(zip(rod.first, rod.bases, strict=True), rod.front):
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


def rod_modes(cue: Cue, masses: Sequence[tuple[float, float]], *, below: float, tailed: bool = False) -> RodModes:
    """Rod modes up to the angular frequency ``below``, rad/s, of a cue that is free at both ends.

    masses: (position m, mass kg) of each lump. Leather drawn at the tip (`Cue.leather`) moves rigidly with it. tailed:
    whether to add the tail of the modes left out. The element matrices are exact; the cost is one symmetric
    eigenproblem with as many unknowns as the elements' orders add up to.
    """
    rod = Rod.of(cue, [x for x, _ in masses], below)
    (K, M), shift = rod.matrices(masses), rod.shift
    count = min(rod.modes_below(below) + len(masses), rod.unknowns - 2)
    _, vectors = lowest(K, M, count=count + 1, shift=shift)
    vectors *= np.where(vectors[0] < 0, -1.0, 1.0)
    flexible = RodModes(vectors[:, 1:], rod)  # the first is the rigid motion
    chosen = vectors[:, : 1 + int(np.sum(flexible.omega <= below))]
    radiation = None
    if tailed:
        tip = np.eye(len(vectors), 1)
        more = ritz(chosen, K, M, tip, shift=shift, deflect=inverse(K + shift * M), highest=below)
        chosen, radiation = np.concatenate([chosen, more.vectors], axis=1), more.radiation
    return RodModes(chosen[:, 1:], rod, radiation)
