"""The weak forms of a solid of revolution in a Fourier harmonic, and their matrices.

With t the angle about the axis, the harmonic m is u_r = U(r, z) cos mt, u_t = V(r, z) sin mt, u_z = W(r, z) cos mt:
bending of a cue is m = 1, axial motion m = 0. Every strain is a function of (r, z) times cos mt or sin mt, and the
integral over t is pi (2 pi for m = 0). The fields are U, S and W with S = V, but S = U + V if m = 1: then S = W = 0 on
the axis, which removes the singularity there (handbook: The solid).
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray
from skfem import Basis

from cuefem.cue import Array

SAME_POINT = 1e-9  # m: points of the mesh closer than this coincide


def strains(m: int, U: Any, S: Any, W: Any, r: Any) -> list[Any]:
    """Amplitudes of the strains (rr, tt, zz, 2 rz, 2 rt, 2 tz), the factors of cos mt or sin mt.

    U, S, W: value, d/dz and d/dr each.
    """
    V = displacements(m, U, S, W)[1]
    return [
        U[2],
        (U[0] + m * V[0]) / r,
        W[1],
        U[1] + W[2],
        V[2] - (m * U[0] + V[0]) / r,
        V[1] - m * W[0] / r,
    ]


def displacements(m: int, U: Any, S: Any, W: Any) -> list[Any]:
    """The displacement amplitudes U, V and W."""
    return [U, S - U if m == 1 else S, W]


def stiffness(E: float, nu: float, G: float, E_transverse: float, nu_transverse: float) -> Array:
    """Stiffness matrix, Pa, (6, 6), from strains (rr, tt, zz, 2 rz, 2 rt, 2 tz) to stresses, of a material that is
    transversely isotropic about the axis."""
    compliance = np.diag(
        [1 / E_transverse, 1 / E_transverse, 1 / E, 1 / G, 2 * (1 + nu_transverse) / E_transverse, 1 / G]
    )
    compliance[0, 1] = compliance[1, 0] = -nu_transverse / E_transverse
    compliance[:2, 2] = compliance[2, :2] = -nu / E
    return np.linalg.inv(compliance)


def matrices(
    basis: Basis, m: int, stiffnesses: Sequence[Array], densities: Sequence[float]
) -> tuple[sp.csc_matrix, sp.csc_matrix]:
    """K and M of the fields U, S, W from a basis of one field; `stiffness` and density of each cell.

    scikit-fem's own assembly calls a form for each pair of functions, which takes far longer at these orders.
    """
    value = np.array([np.broadcast_to(np.asarray(f[0]), basis.dx.shape) for f in basis.basis])
    slopes = np.moveaxis(np.array([f[0].grad for f in basis.basis]), 1, 0)
    functions = np.array([value, *slopes])  # (value and slopes, functions, cells, points)
    radius, zero = np.asarray(basis.global_coordinates())[1], np.zeros((3, *value.shape[::2]))
    rows, columns, entries = [], [], []
    for cell, (C, rho) in enumerate(zip(stiffnesses, densities, strict=True)):
        f, r = functions[:, :, cell], radius[cell]
        fields: list[tuple[Array, Array, Array]] = [(f, zero, zero), (zero, f, zero), (zero, zero, f)]
        root = np.sqrt((np.pi if m else 2 * np.pi) * r * basis.dx[cell])
        strain = root * np.array([strains(m, *field, r) for field in fields]).swapaxes(0, 1)
        motion = root * np.array([displacements(m, *field) for field in fields])[:, :, 0].swapaxes(0, 1)
        dofs = (basis.N * np.arange(3)[:, None] + basis.element_dofs[:, cell]).ravel()
        pairs = (strain, np.tensordot(C, strain, 1)), (motion, rho * motion)  # (components, fields, functions, points)
        rows.append(np.repeat(dofs, len(dofs)))
        columns.append(np.tile(dofs, len(dofs)))
        entries.append([np.tensordot(a, b, ((0, 3), (0, 3))).ravel() for a, b in pairs])
    indices = np.concatenate(rows), np.concatenate(columns)
    K, M = (sp.csc_matrix((values, indices), shape=(3 * basis.N,) * 2) for values in np.concatenate(entries, axis=1))
    return K, M


def boundary_dofs(basis: Basis, coordinate: int, position: float) -> NDArray[np.intp]:
    """Degrees of freedom of one field on the part of the boundary where z (coordinate 0) or r (1) is ``position``."""
    facets = basis.mesh.facets_satisfying(lambda x: np.abs(x[coordinate] - position) < SAME_POINT, boundaries_only=True)
    return np.asarray(basis.get_dofs(facets).all())


def free_dofs(basis: Basis, m: int, *fixed: NDArray[np.intp]) -> NDArray[np.intp]:
    """Degrees of freedom that are neither ``fixed`` nor zero on the axis because of the harmonic's regularity."""
    axis, N = boundary_dofs(basis, 1, 0.0), basis.N
    zero = {0: [axis, N + np.arange(N)], 1: [N + axis, 2 * N + axis]}.get(m, [axis, N + axis, 2 * N + axis])
    return np.setdiff1d(np.arange(3 * N), np.concatenate([*zero, *fixed]))
