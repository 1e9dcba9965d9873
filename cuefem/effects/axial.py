"""Rod modes of a cue on the beam's own mesh: stiffness EA (u')^2, mass rhoA u'^2 (in time), and lumps at nodes."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from cuefem.beam import System, gather, line_basis, table
from cuefem.cue import Array, Section
from cuefem.modes import lowest


@dataclass(frozen=True)
class RodModes:
    """Flexible rod modes, ascending: vectors (unknowns, n) of the axial displacement, mass-normalised, u(0) > 0."""

    vectors: Array
    system: System

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
        """Angular frequencies, rad/s, (n,): the root of the strain energy, exact to rounding for low modes too."""
        return np.sqrt(np.sum(self.strains**2, axis=(0, 1)))

    @property
    def along(self) -> Array:
        """Displacement of the tip, 1/sqrt(kg), (n,)."""
        return self.vectors[0]

    def loss_factors(self, loss: Section) -> Array:
        """Loss factor of every mode, (n,), from that of EA, (elements, q)."""
        return np.einsum("eq,eqn->n", loss.EA, self.strains**2) / self.omega**2

    def below(self, omega: float) -> RodModes:
        """Those of the modes whose angular frequency is no higher, rad/s."""
        return RodModes(self.vectors[:, self.omega <= omega], self.system)


def _chain_basis(order: int) -> tuple[Array, Array]:
    """Basis and its derivative at the Gauss points: tip end, bubbles, butt end; each (order + 1, q)."""
    values, slopes = line_basis(order, table(order).points)
    chain = np.r_[0, 2 : order + 1, 1]
    return values[chain], slopes[chain]


def _first(system: System) -> NDArray[np.intp]:
    """Every element's first unknown: neighbours share one."""
    return system.mesh.order * np.arange(len(system.mesh.piece))


def rod_modes(system: System, masses: Sequence[tuple[float, float]], *, below: float) -> RodModes:
    """Rod modes up to the angular frequency ``below``, rad/s, of an assembled beam's cue, free at both ends.

    masses: (position m, mass kg) of lumps. Element matrices are exact; cost: one symmetric eigenproblem of order times
    elements unknowns.
    """
    mesh, section = system.mesh, system.section
    values, slopes = _chain_basis(mesh.order)
    weights, sizes = table(mesh.order).weights, mesh.sizes[:, None]
    stiff = np.einsum("eq,iq,jq->eij", section.EA * weights / sizes, slopes, slopes)
    heavy = np.einsum("eq,iq,jq->eij", section.rhoA * weights * sizes, values, values)
    first = _first(system)
    unknowns = int(first[-1]) + mesh.order + 1
    lumps = np.zeros(unknowns)
    for x, mass in masses:
        lumps[mesh.order * mesh.node(x)] += mass
    K = gather(first, unknowns, stiff, point=np.zeros(unknowns))
    M = gather(first, unknowns, heavy, point=lumps)
    count = min(_modes_below(system, below) + len(masses), unknowns - 2)
    vectors = lowest(K, M, count=count + 1, shift=_shift(system))[:, 1:]  # the first is the rigid motion
    return RodModes(vectors * np.where(vectors[0] < 0, -1.0, 1.0), system).below(below)


def _modes_below(system: System, omega: float) -> int:
    """About how many flexible rod modes lie below ``omega`` rad/s: the waves' phase over pi, one more a piece."""
    section, mesh = system.section, system.mesh
    slowness = np.sqrt(section.rhoA / section.EA) @ table(mesh.order).weights
    return int(omega * (slowness @ mesh.sizes) / np.pi) + 2 + int(mesh.piece[-1])


def _shift(system: System) -> float:
    # pi^2 EA/(rhoA L^2), the lowest free mode of the uniform rod with the mean stiffness and mass
    stiffness, mass = (
        float(system.mesh.sizes @ part.mean(axis=1)) for part in (system.section.EA, system.section.rhoA)
    )
    return 10 * stiffness / mass / system.length**2
