"""The beam's two weak forms in scikit-fem, with point terms of effects: the definition of `cuefem.beam.assembly`.

The package solves beams by `cuefem.beam.assembly`, five times as fast. This file assembles the same beam independently,
for `cuefem check` and the tests; only this file loads scikit-fem, which takes long.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
import scipy.linalg as la
import scipy.sparse as sp
from numpy.typing import ArrayLike
from skfem import Basis, BilinearForm, ElementLinePp, MeshLine

from cuefem.beam.point_terms import MIN_COMPLIANCE, BeamEffect
from cuefem.cue import POSITION_TOLERANCE, Array, Cue


@BilinearForm
def stiffness(w: Any, theta: Any, v: Any, eta: Any, x: Any) -> Any:
    """Bending and shear."""
    return x.EI * theta.grad[0] * eta.grad[0] + x.kGA * (w.grad[0] - theta) * (v.grad[0] - eta)


@BilinearForm
def inertia(w: Any, theta: Any, v: Any, eta: Any, x: Any) -> Any:
    """Transverse and rotary inertia."""
    return x.rhoA * w * v + x.rhoI * theta * eta


class _PointTerms:
    """What effects add at nodes ``x`` of the mesh; a joint has two nodes, and other terms act on the butt side's."""

    def __init__(self, cue: Cue, basis: Basis, x: Array) -> None:
        self.cue, self.x, self.dofs = cue, x, basis.nodal_dofs.T  # (nodes, 2): w, theta
        size = basis.N
        self.stiffness, self.mass, self.dashpot = (sp.lil_matrix((size, size)) for _ in range(3))
        self.source = np.arange(size)  # the degree of freedom that each is equal to; -1 where clamped

    def dofs_at(self, x: float) -> Any:
        """Degrees of freedom (w, theta) of the nodes at ``x``: (1 or 2, 2)."""
        return self.dofs[abs(self.x - x) < POSITION_TOLERANCE * self.cue.length]

    def add_mass(self, x: float, mass: float, rotary_inertia: float = 0.0) -> None:
        """A mass, and its rotary inertia."""
        self._add(self.mass, x, mass, rotary_inertia)

    def add_dashpot(self, x: float, lateral: float) -> None:
        """A dashpot to the ground, for the deflection."""
        self._add(self.dashpot, x, lateral, 0.0)

    def add_springs(self, x: float, lateral: float, rotational: float) -> None:
        """Springs to the ground, for deflection and rotation; inf clamps."""
        values = np.array([lateral, rotational])
        self.source[self.dofs_at(x)[-1][np.isinf(values)]] = -1
        self._add(self.stiffness, x, *np.where(np.isinf(values), 0.0, values))

    def _add(self, matrix: Any, x: float, *values: float) -> None:
        for dof, value in zip(self.dofs_at(x)[-1], values, strict=True):
            matrix[dof, dof] += value

    def join(self, x: float, *compliances: float) -> None:
        """Springs between the two sides of a joint; no jump if the compliance is negligible."""
        section = self.cue.section(min(x, self.cue.length))
        stiffness = (section.kGA, section.EI)
        for (before, after), compliance, rigidity in zip(self.dofs_at(x).T, compliances, stiffness, strict=True):
            if compliance * rigidity > MIN_COMPLIANCE * self.cue.length:
                jump = np.array([1.0, -1.0])
                self.stiffness[np.ix_([before, after], [before, after])] += np.outer(jump, jump) / compliance
            else:
                self.source[before] = after


class Matrices(NamedTuple):
    """Stiffness, mass and damping of the free degrees of freedom, (free, free), and the tip's rows, (2, free)."""

    K: sp.csc_matrix
    M: sp.csc_matrix
    C: sp.csc_matrix
    tip: sp.csc_matrix


def assemble(cue: Cue, nodes: ArrayLike, *, order: int, effects: tuple[BeamEffect, ...] = ()) -> Matrices:
    """The matrices of the free degrees of freedom (w in m, theta in rad) of a cue on elements between ``nodes``, m.

    w has the polynomial degree order + 1, theta order. Nodes must lie at the ends of segments and at effects.
    """
    x = np.sort(np.append(nodes, [x for effect in effects for x in effect.joint_positions]))
    elements = np.flatnonzero(np.diff(x) > POSITION_TOLERANCE * cue.length)
    mesh = MeshLine(x[None], np.array([elements, elements + 1]))
    # EI of a solid cone has degree 4
    basis = Basis(mesh, ElementLinePp(order + 1) * ElementLinePp(order), intorder=2 * order + 6)
    fields = cue.section(np.asarray(basis.global_coordinates())[0])._asdict()
    points = _PointTerms(cue, basis, x)
    for effect in effects:
        effect.add_to(points)  # type: ignore[arg-type]
    clamped = points.source < 0
    free, column = np.unique(points.source[~clamped], return_inverse=True)
    expansion = sp.csc_matrix((np.ones(len(column)), (np.flatnonzero(~clamped), column)), (basis.N, len(free)))
    coefficients = {name: fields[name] for name in ("EI", "kGA", "rhoA", "rhoI")}
    K = stiffness.assemble(basis, **coefficients) + points.stiffness
    M = inertia.assemble(basis, **coefficients) + points.mass
    free_K, free_M, C = (sp.csc_matrix(expansion.T @ matrix @ expansion) for matrix in (K, M, points.dashpot))
    return Matrices(free_K, free_M, C, tip=expansion[basis.nodal_dofs[:, 0]])


def frequencies(beam: Matrices, *, shift: float) -> Array:
    """All natural frequencies, Hz, ascending, rigid-body modes near zero; shift: that of `System`, rad2/s2."""
    inverse = la.eigh(beam.M.toarray(), (beam.K + shift * beam.M).toarray(), eigvals_only=True)[::-1]
    return np.sqrt(np.maximum(1 / inverse - shift, 0)) / (2 * np.pi)
