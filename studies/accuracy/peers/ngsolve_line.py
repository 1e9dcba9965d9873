"""NGSolve in one dimension: H1 of order p for deflection and rotation; its own matrices and Newmark steps, one thread.

Modes by its own `ArnoldiSolver` (which wants a complex space), and by scipy's LAPACK from its matrices.
"""

from __future__ import annotations

from functools import partial
from itertools import pairwise
from typing import Any

import ngsolve as ng
import numpy as np
import scipy.sparse as sp
from netgen.meshing import Element1D, MeshPoint, Pnt
from netgen.meshing import Mesh as NetgenMesh

from studies.accuracy.peers.cone import CONE, MODES, lowest

VERSION = ng.__version__
KRYLOV = 12  # vectors of Arnoldi's method
ng.SetNumThreads(1)


def line(elements: int) -> ng.Mesh:
    """Equal elements from the tip to the butt."""
    mesh = NetgenMesh(dim=1)
    nodes = [mesh.Add(MeshPoint(Pnt(x, 0, 0))) for x in np.linspace(0, CONE.length, elements + 1)]
    beam = mesh.AddRegion("beam", dim=1)
    for ends in pairwise(nodes):
        mesh.Add(Element1D(list(ends), index=beam))
    return ng.Mesh(mesh)


def forms(order: int, elements: int, *, complex_valued: bool = False) -> tuple[Any, Any, Any]:
    """The space and the assembled K and M."""
    single = ng.H1(line(elements), order=order, complex=complex_valued)
    space = single * single
    (w, turn), (v, other) = space.TnT()
    A, second = CONE.area(ng.x), CONE.inertia(ng.x)
    dx = ng.dx(bonus_intorder=4)
    sheared = (ng.grad(w) - turn) * (ng.grad(v) - other)
    K = ng.BilinearForm((CONE.E * second * ng.grad(turn) * ng.grad(other) + CONE.kappa * CONE.G * A * sheared) * dx)
    M = ng.BilinearForm(CONE.rho * (A * w * v + second * turn * other) * dx)
    return space, K.Assemble().mat, M.Assemble().mat


def _csr(matrix: Any) -> sp.csr_matrix:
    values, columns, starts = (np.array(part) for part in matrix.CSR())
    return sp.csr_matrix((values, columns, starts), shape=(matrix.height, matrix.width))


def modes(order: int, elements: int) -> np.ndarray:
    """f1 to f5, Hz, by Arnoldi's method."""
    space, K, M = forms(order, elements, complex_valued=True)
    vectors = ng.GridFunction(space, multidim=KRYLOV).vecs
    squares = ng.ArnoldiSolver(K, M, space.FreeDofs(), list(vectors), shift=-CONE.shift)
    return np.sqrt(np.sort([square.real for square in squares])[2 : 2 + MODES]) / (2 * np.pi)


def modes_by_lapack(order: int, elements: int) -> np.ndarray:
    """f1 to f5, Hz, by scipy from NGSolve's matrices."""
    _, K, M = forms(order, elements)
    return lowest(_csr(K), _csr(M))


def end_mass(order: int, elements: int, steps: int) -> float:
    """Force end mass, kg, by Newmark steps (average acceleration)."""
    space, K, M = forms(order, elements)
    dt = CONE.contact_time / steps
    effective = M.CreateMatrix()
    effective.AsVector().data = M.AsVector() + dt**2 / 4 * K.AsVector()
    inverse = effective.Inverse(space.FreeDofs(), inverse="sparsecholesky")
    u, v, a, new, ahead, force = (K.CreateColVector() for _ in range(6))
    for vector in (u, v, a, force):
        vector[:] = 0.0
    for step in range(1, steps + 1):
        force[0] = np.sin(np.pi * step / steps)  # unknown 0: the deflection of the first vertex, the tip
        ahead.data = u + dt * v + dt**2 / 4 * a
        new.data = inverse * (force - K * ahead)
        v.data += dt / 2 * (a + new)
        u.data = ahead + dt**2 / 4 * new
        a.data = new
    return 2 * CONE.contact_time / np.pi / v[0]


CONTESTANTS = {
    "modes": {
        f"{name}, p = {p}, x {n}": partial(solve, p, n)
        for name, solve in (("NGSolve", modes), ("NGSolve + scipy", modes_by_lapack))
        for p, n in ((6, 2), (8, 2), (10, 2), (12, 2))
    },
    "end_mass": {
        f"NGSolve, p = {p}, x {n}, {steps} steps": partial(end_mass, p, n, steps)
        for p, n, steps in ((2, 80, 800), (8, 10, 800))
    },
}
