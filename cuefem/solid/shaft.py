"""A cue as a solid body: 3-D elasticity of bending and axial motion (handbook: The solid).

The weak forms are in `cuefem.solid.elasticity`; bending is harmonic 1, axial motion harmonic 0. The elements are
scikit-fem's quadrilaterals of arbitrary order.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
import scipy.sparse as sp
import scipy.sparse.linalg as sla
from numpy.typing import NDArray
from skfem import Basis, ElementQuadP, FacetBasis, LinearForm, MeshQuad

from cuefem.cue import Array, Cue, Material
from cuefem.quantity.display import brief
from cuefem.quantity.fields import check_count, check_kind
from cuefem.solid import elasticity
from cuefem.solid.elasticity import SAME_POINT
from cuefem.solid.meridian_mesh import Fineness, check_mesh_size, half_section
from cuefem.solid.solid_resolution import Solid

BENDING, AXIAL = 1, 0  # Fourier harmonics
# (rad/s)^2, far below the first natural frequency of every cue: K is singular, K + SHIFT M is not.
SHIFT = (2 * np.pi * 30.0) ** 2


@dataclass(frozen=True, eq=False)
class SolidBody:
    """The meshed solid of a cue in one Fourier harmonic."""

    cue: Cue
    fineness: Fineness
    harmonic: int = BENDING

    def __post_init__(self) -> None:
        check_mesh_size(self.cue, self.fineness)

    @cached_property
    def cells(self) -> tuple[MeshQuad, list[Material]]:
        """The mesh in (z, r) and the material of each cell."""
        return half_section(self.cue, self.fineness)

    @cached_property
    def basis(self) -> Basis:
        """scikit-fem's basis of one field."""
        return Basis(self.cells[0], ElementQuadP(self.fineness.order), intorder=2 * self.fineness.order + 2)

    @cached_property
    def matrices(self) -> tuple[sp.csc_matrix, sp.csc_matrix]:
        """K and M of all degrees of freedom."""
        stiffness = {m: elasticity.stiffness(m.E, m.nu, m.G, m.E_transverse, m.nu_in_plane) for m in self.cells[1]}
        return elasticity.matrices(
            self.basis, self.harmonic, [stiffness[m] for m in self.cells[1]], [m.rho for m in self.cells[1]]
        )

    def free(self, *fixed: NDArray[np.intp]) -> NDArray[np.intp]:
        """Degrees of freedom that are neither ``fixed`` nor zero on the axis."""
        return elasticity.free_dofs(self.basis, self.harmonic, *fixed)

    def _mean(self, z: float, fields: tuple[float, float, float], power: int = 0) -> Array:
        """Row of the mean over an end face of r^power times a sum of the fields, over the mean of r^(2 power)."""
        facets = self.cells[0].facets_satisfying(lambda x: np.abs(x[0] - z) < SAME_POINT, boundaries_only=True)
        face_basis = FacetBasis(self.cells[0], self.basis.elem, facets=facets, intorder=2 * self.fineness.order + 2)
        row = LinearForm(lambda v, w: w.x[1] ** (1 + power) * v).assemble(face_basis)
        area = np.sum(np.asarray(face_basis.global_coordinates())[1] ** (1 + 2 * power) * face_basis.dx)
        return np.outer(fields, row / area).ravel()

    @cached_property
    def tip(self) -> Array:
        """Row of the mean displacement of the tip's face: u_x = U - S/2 in bending, W in axial motion."""
        return self._deflection(0.0)

    def _deflection(self, z: float) -> Array:
        return self._mean(z, (1.0, -0.5, 0.0) if self.harmonic == BENDING else (0.0, 0.0, 1.0))

    @cached_property
    def rotation(self) -> Array:
        """Row of the rotation of the tip's face in bending: the least-squares slope of -u_z over the distance from the
        axis."""
        return self._mean(0.0, (0.0, 0.0, -1.0), 1)

    def modes(self, count: int, *, supported: bool = False, mass: float = 0.0) -> SolidModes:
        """The ``count`` lowest modes, including rigid-body modes.

        supported: no motion within both end faces, where a standing wave has its nodes. mass: kg, distributed over the
        tip's face.
        """
        N, fixed = self.basis.N, np.zeros(0, dtype=np.intp)
        if supported:
            faces = [elasticity.boundary_dofs(self.basis, 0, z) for z in (0.0, self.cue.length)]
            fixed = np.concatenate([*faces, *(N + face for face in faces)])
        free = self.free(fixed)
        if not count < len(free):
            raise ValueError(f"Solid.modes must be below {len(free)}, the degrees of freedom of the solid; got {count}")
        K, M = (m[free][:, free] for m in self.matrices)
        tip, rigid = self.tip[free], 0 if supported else 1 + self.harmonic
        if mass:
            row = sp.csc_matrix(tip)
            M = (M + mass * row.T @ row).tocsc()
        squares, vectors = sla.eigsh(K, count, M, sigma=-SHIFT, v0=np.ones(len(free)))
        omega = np.sqrt(np.abs(squares))
        omega[:rigid] = 0.0
        sign = np.where(tip @ vectors < 0, -1.0, 1.0)
        rotation = self.rotation[free] @ vectors * sign if self.harmonic == BENDING else np.zeros(count)
        return SolidModes(omega, tip @ vectors * sign, rotation, rigid)

    @property
    def compliance(self) -> float:
        """Static compliance at the tip, m/N: mean displacement of its face by a distributed unit force.

        The butt's face remains plane and upright, and does not move on average.
        """
        free = self.free(2 * self.basis.N + elasticity.boundary_dofs(self.basis, 0, self.cue.length))
        K = self.matrices[0][free][:, free]
        load = self.tip[free]
        if self.harmonic == BENDING:
            clamp = sp.csc_matrix(self._deflection(self.cue.length)[free]) * abs(K).max()
            K, load = sp.bmat([[K, clamp.T], [clamp, None]], format="csc"), np.append(load, 0.0)
        return float(load @ sla.splu(K).solve(load))


@dataclass(frozen=True, eq=False)
class SolidModes:
    """Mass-normalised modes of a solid cue, ascending in frequency, the rigid-body modes first.

    Attributes
    ----------
    omega : (n,) array
        Angular frequencies, rad/s.
    tip : (n,) array
        Mean displacement of the tip's face, 1/sqrt(kg), positive.
    rotation : (n,) array
        Rotation of the tip's face, 1/(m sqrt(kg)).
    rigid : int
        Number of rigid-body modes.
    """

    omega: Array
    tip: Array
    rotation: Array
    rigid: int

    def __repr__(self) -> str:
        return f"SolidModes({brief(self.frequencies[:6])} Hz, {len(self.frequencies)} in all, {self.rigid} rigid)"

    @property
    def frequencies(self) -> Array:
        """Natural frequencies, Hz, without the rigid-body modes."""
        return self.omega[self.rigid :] / (2 * np.pi)

    @property
    def at_tip(self) -> tuple[Array, Array]:
        """Deflection, 1/sqrt(kg), and rotation, 1/(m sqrt(kg)), of the tip in every mode, rigid-body modes first."""
        return self.tip, self.rotation


def solid_modes(cue: Cue, count: int = 6, at: Solid | None = None) -> SolidModes:
    """Bending modes of a cue by 3-D elasticity: the two rigid-body modes and the lowest flexible ones.

    Parameters
    ----------
    cue : Cue
        Its segments; their shear coefficients have no effect.
    count : int
        Number of flexible modes.
    at : Solid, optional
        Resolution; only its ``order`` has an effect.

    Returns
    -------
    SolidModes
        ``.frequencies`` in Hz, ascending; ``.at_tip``, deflection and rotation of the tip in every mode.

    Raises
    ------
    ValueError
        If a wall is thinner than a micrometre, if constants of a material are not positive definite, or if the solid
        needs more than 2 GiB.

    Notes
    -----
    3-D elasticity of a solid of revolution in the Fourier harmonic of bending (handbook: The solid).

    Examples
    --------
    >>> import cuefem as cf
    >>> cone = cf.Cue((cf.Segment(0.7, 0.012, 0.021, cf.Material(E=12.6e9, G=4.85e9, rho=700.0)),))
    >>> beam, solid = cf.modes(cone, 2).frequencies, cf.solid_modes(cone, 2).frequencies
    >>> bool(abs(beam / solid - 1).max() < 1e-5)
    True
    """
    check_kind("solid_modes cue", cue, Cue)
    check_kind("solid_modes at", at, (Solid, type(None)))
    check_count("solid_modes count", count, 1)
    order = Solid().order if at is None else at.order
    return SolidBody(cue, Fineness(order)).modes(count + 2)


def face_loaded_modes(cue: Cue, at: Solid, mass: float) -> SolidModes:
    """Modes of a cue at a resolution, with a mass on the tip's face, kg."""
    return SolidBody(cue, Fineness(at.order)).modes(at.modes + 2, mass=mass)
