"""Modes of a cue as a rod along its axis, by the beam's mesh rule: stiffness EA, mass rhoA, and lumps at nodes."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from cuefem.beam.assembly import Points, assemble_blocks, gauss_points, is_dense_faster
from cuefem.beam.basis import element_rows
from cuefem.beam.eigensolver import EigenSolution, solve_eigenproblem
from cuefem.beam.meshing import mesh_for_phases
from cuefem.beam.mode_count import segment_sections
from cuefem.cue import Array, Cue, Section


@dataclass(frozen=True, eq=False)
class RodModes(EigenSolution):
    """Flexible rod modes of a cue, of the chain of elements behind the leather, and their participation at the tip.

    element_dofs: degrees of freedom of each element in the chain, from the element ``front`` on; the elements before it
    move as one rigid body.
    """

    cue: Cue
    points: Points
    front: int
    element_dofs: list[NDArray[np.intp]]

    @property
    def tip_displacement(self) -> Array:
        """Displacement of the tip, 1/sqrt(kg), (n,)."""
        return self.participation[0]

    def below(self, cutoff: float) -> RodModes:
        """Those of the modes up to an angular frequency, rad/s, without another eigenproblem."""
        return self if cutoff >= self.cutoff else self.lowest(len(self.spectrum.mu), cutoff)

    def loss_factors(self, loss: Section) -> Array:
        """Loss factor of every mode, (n,), from the loss factor of EA at the Gauss points, (points,)."""
        loss_sum, stiffness = np.zeros(len(self.omega)), loss.EA * self.points.section.EA * self.points.weights
        for e, dofs in enumerate(self.element_dofs, start=self.front):
            strains = _rod_basis(self.points, e)[1].T @ self.vectors[dofs]
            loss_sum += stiffness[self.points.element(e)] @ strains**2
        return loss_sum / self.omega**2


@lru_cache(maxsize=4)
def rod_modes(
    cue: Cue,
    nodes: tuple[float, ...],
    masses: tuple[tuple[float, float], ...] = (),
    *,
    cutoff: float,
    max_count: float = np.inf,
    n_corrected: int = 0,
) -> RodModes:
    """Rod modes up to the angular frequency ``cutoff``, rad/s, of a cue that is free at both ends.

    max_count: about the largest number of modes; where waves are slow it lowers it. nodes: m from the tip, those
    of the beam where its section jumps or a mass is, and the end of the rod. masses: (position m, mass kg) of each
    lump, at nodes. Leather drawn at the tip (`Cue.leather_height`) moves rigidly with it.
    n_corrected: number of loads with a truncation correction, 1 or 0. The cost is one symmetric eigenproblem with as
    many degrees of freedom as the elements' orders add up to; the last four are kept, for fewer modes of the same rod.
    """
    lengths, sections = cue.lengths, segment_sections(cue)
    EA, rhoA = sections.EA[:, 2], sections.rhoA[:, 2]  # in the middle of each segment
    # about pi^2 EA/(rhoA L^2), the lowest free mode of the uniform rod with the mean stiffness and mass
    shift = float(10 * (lengths @ EA) / (lengths @ rhoA) / cue.length**2)
    phases = lengths * np.sqrt(rhoA / EA)  # at 1 rad/s; the correction needs waves of twice the cutoff
    cutoff = min(cutoff, np.pi * max_count / phases.sum())
    mesh = mesh_for_phases(cue, phases * max(2 * cutoff, 4 * shift**0.5), np.array(nodes))
    points, front, orders = gauss_points(cue, mesh), mesh.node(cue.leather_height), mesh.orders
    EA, rhoA = points.section.EA * points.weights, points.section.rhoA * points.weights
    first = np.append(np.zeros(front, int), np.append(0, np.cumsum(orders[front:])))  # of each element, and the butt
    element_dofs = [first[e] + np.arange(orders[e] + 1) for e in range(front, len(orders))]
    stiffness, inertia = [], []
    for e, dofs in enumerate(element_dofs, start=front):
        rows, (values, slopes) = points.element(e), _rod_basis(points, e)
        stiffness.append((int(dofs[0]), (slopes * EA[rows]) @ slopes.T))
        inertia.append((int(dofs[0]), (values * rhoA[rows]) @ values.T))
    lumps = np.zeros(first[-1] + 1)
    lumps[0] = rhoA[: points.first_point[front]].sum()
    for x, mass in masses:
        lumps[first[mesh.node(x)]] += mass
    # jumps of the section and lumps may let a few more modes lie below than the phase says
    count = min(int(2 * cutoff * phases.sum() / np.pi) + 3 + len(masses), len(lumps) - 1)
    dense = is_dense_faster(len(lumps), count)
    K, M = assemble_blocks(stiffness, np.zeros(len(lumps)), dense), assemble_blocks(inertia, lumps, dense)
    spectrum = solve_eigenproblem(
        K, M, np.eye(len(lumps), 1), shift=shift, rigid=1, count=count, n_corrected=n_corrected
    )
    solution = spectrum.lowest(count, cutoff)
    return RodModes(**vars(solution), cue=cue, points=points, front=front, element_dofs=element_dofs)


def _rod_basis(points: Points, e: int) -> tuple[Array, Array]:
    """Displacement and strain of an element's degrees of freedom, tip end, bubbles, butt end: (order + 1, q) each."""
    *_, functions = element_rows(int(points.mesh.orders[e]))  # the same as of the rotation
    values, slopes = points.line_basis(e)
    return values[functions], slopes[functions]
