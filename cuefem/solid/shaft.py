"""A cue as a solid body: 3-D elasticity of its bending and of its motion along the axis (handbook: The solid).

With t the angle about the axis, bending is the Fourier harmonic u_r = U(r, z) cos t, u_t = V(r, z) sin t,
u_z = W(r, z) cos t, and the motion along the axis is u_r = U(r, z), u_z = W(r, z). Every strain is then a function of
(r, z) times cos t, sin t or 1, and the integral over t leaves pi or 2 pi. The unknowns of bending are U, S = U + V, W:
on the axis S = W = 0, so that nothing is singular there; along the axis they are U and W, and U = 0 on the axis.
`bending_strains` and `axial_strains` are the weak forms; elements are scikit-fem's quadrilaterals of any order.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np
import scipy.linalg as la
import scipy.sparse as sp
import scipy.sparse.linalg as sla
from numpy.typing import NDArray
from skfem import Basis, ElementQuadP, FacetBasis, MeshQuad

from cuefem.cue import Array, Cue, Material
from cuefem.quantity.display import brief
from cuefem.quantity.fields import check_count, check_kind
from cuefem.solid.half_section import SAME, Fineness, check_size, half_section
from cuefem.solid.resolution import Solid

# A square frequency, (rad/s)^2, well below the first mode of every cue: K is singular, K plus it times M is not.
SHIFT = (2 * np.pi * 30.0) ** 2


class Displacement(NamedTuple):
    """An unknown field's value and slopes, at some points."""

    value: Any
    dz: Any
    dr: Any


def bending_strains(U: Displacement, S: Displacement, W: Displacement, r: Any) -> list[Any]:
    """Strains (rr, tt, zz, 2 rz, 2 rt, 2 tz) of bending, without their cos t or sin t."""
    return [
        U.dr,
        S.value / r,
        W.dz,
        U.dz + W.dr,
        S.dr - U.dr - S.value / r,
        S.dz - U.dz - W.value / r,
    ]


def bending_displacements(U: Displacement, S: Displacement, W: Displacement) -> list[Any]:
    """Displacements (u_r, u_t, u_z) of bending, without their cos t or sin t."""
    return [U.value, S.value - U.value, W.value]


def axial_strains(U: Displacement, W: Displacement, r: Any) -> list[Any]:
    """Strains (rr, tt, zz, 2 rz, 2 rt, 2 tz) of the motion along the axis."""
    none = 0 * U.value
    return [U.dr, U.value / r, W.dz, U.dz + W.dr, none, none]


def axial_displacements(U: Displacement, W: Displacement) -> list[Any]:
    """Displacements (u_r, u_t, u_z) of the motion along the axis."""
    return [U.value, 0 * U.value, W.value]


class Harmonic(NamedTuple):
    """A Fourier harmonic: number of fields, weak forms, the integral over the angle, and the number of rigid motions.

    on_axis: which fields vanish on the axis.
    """

    fields: int
    strains: Callable[..., list[Any]]
    displacements: Callable[..., list[Any]]
    round: float
    rigid: int
    on_axis: tuple[int, ...]


BENDING = Harmonic(3, bending_strains, bending_displacements, np.pi, 2, (1, 2))
AXIAL = Harmonic(2, axial_strains, axial_displacements, 2 * np.pi, 1, (0,))


def stiffness(material: Material) -> Array:
    """The stress of strains (rr, tt, zz, 2 rz, 2 rt, 2 tz), Pa, (6, 6), of a material transversely isotropic about the
    axis."""
    E, nu, E_T, nu_T = material.E, material.nu, material.E_across, material.nu_in_plane
    compliance = np.diag([1 / E_T, 1 / E_T, 1 / E, 1 / material.G, 2 * (1 + nu_T) / E_T, 1 / material.G])
    compliance[0, 1] = compliance[1, 0] = -nu_T / E_T
    compliance[:2, 2] = compliance[2, :2] = -nu / E
    if np.linalg.eigvalsh(compliance * np.sqrt(np.outer(1 / compliance.diagonal(), 1 / compliance.diagonal())))[0] <= 0:
        raise ValueError(
            "Material must store energy under every strain, (1 - nu_across) > 2 nu^2 across_ratio; got "
            f"nu = {nu}, nu_across = {nu_T}, across_ratio = {E_T / E:.6g}"
        )
    return np.linalg.inv(compliance)


@dataclass(frozen=True, eq=False)
class Body:
    """The solid of a cue, meshed, in one of its motions."""

    cue: Cue
    how: Fineness
    motion: Harmonic = BENDING

    def __post_init__(self) -> None:
        check_size(self.cue, self.how)

    @cached_property
    def cells(self) -> tuple[MeshQuad, list[Material]]:
        """Quadrilaterals in (z, r), and their materials."""
        return half_section(self.cue, self.how)

    @cached_property
    def basis(self) -> Basis:
        """scikit-fem's basis of one unknown field."""
        return Basis(self.cells[0], ElementQuadP(self.how.order), intorder=2 * self.how.order + 2)

    @property
    def unknowns(self) -> int:
        """Unknowns of all fields."""
        return int(self.motion.fields * self.basis.N)

    def _strains(self) -> Iterator[tuple[NDArray[np.intp], Array, Array]]:
        """Of every cell: its unknowns, its strains and its displacements of them, times roots of stiffness and mass.

        The squares of both are the cell's stiffness and mass. scikit-fem's own assembly calls a form for each pair of
        functions, which takes a hundred times as long at these orders.
        """
        basis, (_, materials), motion = self.basis, self.cells, self.motion
        value = np.array([np.broadcast_to(np.asarray(f[0]), basis.dx.shape) for f in basis.basis])
        dz, dr = np.moveaxis(np.array([f[0].grad for f in basis.basis]), 1, 0)
        roots = {m: np.linalg.cholesky(stiffness(m)).T for m in set(materials)}
        radius = np.asarray(basis.global_coordinates())[1]
        zero = np.zeros(value.shape[::2])  # (functions, points)
        none = Displacement(zero, zero, zero)
        for cell, material in enumerate(materials):
            function = Displacement(value[:, cell], dz[:, cell], dr[:, cell])
            alone = [[none] * k + [function] + [none] * (motion.fields - 1 - k) for k in range(motion.fields)]
            strain = np.array([motion.strains(*fields, radius[cell]) for fields in alone])
            move = np.array([motion.displacements(*fields) for fields in alone])
            root = np.sqrt(motion.round * radius[cell] * basis.dx[cell])
            strain = np.tensordot(roots[material], strain, (1, 1)) * root  # (strains, fields, functions, points)
            move = move.swapaxes(0, 1) * (np.sqrt(material.rho) * root)
            own = (basis.N * np.arange(motion.fields)[:, None] + basis.element_dofs[:, cell]).ravel()
            yield own, *(a.transpose(0, 3, 1, 2).reshape(-1, len(own)) for a in (strain, move))

    @cached_property
    def matrices(self) -> tuple[sp.csc_matrix, sp.csc_matrix]:
        """K and M of all unknowns."""
        rows, columns, stiff, heavy = [], [], [], []
        for own, strain, move in self._strains():
            rows.append(np.repeat(own, len(own)))
            columns.append(np.tile(own, len(own)))
            stiff.append((strain.T @ strain).ravel())
            heavy.append((move.T @ move).ravel())
        at = (np.concatenate(rows), np.concatenate(columns))
        K, M = (sp.coo_matrix((np.concatenate(v), at), shape=(self.unknowns,) * 2).tocsc() for v in (stiff, heavy))
        return K, M

    def _on(self, place: Callable[[Any], Any]) -> NDArray[np.intp]:
        """Unknowns of one field on the part of the boundary where ``place`` of (z, r) holds."""
        return np.asarray(self.basis.get_dofs(self.cells[0].facets_satisfying(place, boundaries_only=True)).all())

    def free(self, *, supported: bool = False) -> NDArray[np.intp]:
        """Unknowns that are free; supported: no motion within both end faces, where a standing wave has its nodes."""
        N, motion, length = self.basis.N, self.motion, self.cue.length
        axis = self._on(lambda x: x[1] < SAME)
        fixed = [k * N + axis for k in motion.on_axis]
        if supported:
            faces = self._on(lambda x: np.minimum(x[0], length - x[0]) < SAME)
            fixed += [k * N + faces for k in range(motion.fields - 1)]
        return np.setdiff1d(np.arange(self.unknowns), np.concatenate(fixed))

    def _face(self, z: float) -> tuple[FacetBasis, Array]:
        """The face of an end, as scikit-fem's basis, and its points' weights."""
        ends = self.cells[0].facets_satisfying(lambda x: np.abs(x[0] - z) < SAME, boundaries_only=True)
        face = FacetBasis(self.cells[0], self.basis.elem, facets=ends, intorder=2 * self.how.order + 2)
        return face, np.asarray(face.global_coordinates())[1] * face.dx

    def _mean(self, z: float, parts: dict[int, float], power: int = 0) -> Array:
        """The mean over an end's face of a sum of fields times ``parts`` and r^power, as a row on the unknowns."""
        face, weights = self._face(z)
        radius = np.asarray(face.global_coordinates())[1]
        row = np.zeros(self.unknowns)
        for i, function in enumerate(face.basis):
            mean = (np.asarray(function[0]) * weights * radius**power).sum(axis=1)
            for field, part in parts.items():
                np.add.at(row, field * self.basis.N + face.element_dofs[i], part * mean)
        return row / weights.sum()

    @cached_property
    def tip(self) -> Array:
        """The mean displacement of the tip's face, a row on the unknowns: of u_x = U - S/2 in bending, of W along."""
        return self._deflection(0.0)

    def _deflection(self, z: float) -> Array:
        return self._mean(z, {0: 1.0, 1: -0.5} if self.motion is BENDING else {1: 1.0})

    @cached_property
    def turning(self) -> Array:
        """The rotation of the tip's face in bending, a row on the unknowns: -u_z over the distance from its axis, by
        least squares."""
        face, weights = self._face(0.0)
        square = float((weights * np.asarray(face.global_coordinates())[1] ** 2).sum() / weights.sum())
        return self._mean(0.0, {2: -1 / square}, 1)

    def modes(self, count: int, *, supported: bool = False, mass: float = 0.0) -> SolidModes:
        """The ``count`` lowest modes, those without frequency included; mass: kg, spread over the tip's face."""
        free = self.free(supported=supported)
        if not count < len(free):
            raise ValueError(f"Solid.modes must be below {len(free)}, the unknowns of the solid; got {count}")
        K, M = (m[free][:, free] for m in self.matrices)
        tip = self.tip[free]
        if mass:
            M = (M + sp.csc_matrix(np.sqrt(mass) * tip[:, None]) @ sp.csc_matrix(np.sqrt(mass) * tip[None])).tocsc()
        solve = _factors(K + SHIFT * M)
        inverse = sla.LinearOperator(K.shape, matvec=solve)
        squares, shapes = sla.eigsh(K, count, M, sigma=-SHIFT, OPinv=inverse, v0=np.ones(len(free)))
        vectors = np.zeros((self.unknowns, count))
        vectors[free] = shapes[:, np.argsort(squares)]
        return self._polished(vectors, 0 if supported else self.motion.rigid, mass)

    def _polished(self, vectors: Array, rigid: int, mass: float) -> SolidModes:
        """One Rayleigh-Ritz step with the energy taken from the strains: K has lost eps times its largest entry, which
        is 1e-6 of the lowest mode's; the strains have not, and the vectors' error enters squared."""
        stored, moved = self._energies(vectors)
        tip = self.tip @ vectors
        squares, mix = la.eigh(stored, moved + mass * np.outer(tip, tip))
        omega = np.sqrt(np.abs(squares))
        omega[:rigid] = 0.0
        across = tip @ mix
        sign = np.where(across < 0, -1.0, 1.0)
        turning = self.turning @ vectors @ mix * sign if self.motion is BENDING else np.zeros(len(omega))
        return SolidModes(omega, across * sign, turning, rigid)

    def _energies(self, vectors: Array) -> tuple[Array, Array]:
        """Twice the strain energy and twice the kinetic energy at unit rates of every pair of displacements."""
        stored, moved = np.zeros((2, vectors.shape[1], vectors.shape[1]))
        for own, strain, move in self._strains():
            e, u = strain @ vectors[own], move @ vectors[own]
            stored += e.T @ e
            moved += u.T @ u
        return stored, moved

    @property
    def give(self) -> float:
        """Mean displacement of the tip's face under one newton spread over it, m/N, while the butt's face stays plane,
        upright and, in the mean, where it is."""
        N, length, motion = self.basis.N, self.cue.length, self.motion
        butt = self._on(lambda x: np.abs(x[0] - length) < SAME)
        free = np.setdiff1d(self.free(), (motion.fields - 1) * N + butt)
        K, _ = self.matrices
        K = K[free][:, free]
        if motion is BENDING:
            still = sp.csc_matrix(self._deflection(length)[free]) * abs(K).max()
            K = sp.bmat([[K, still.T], [still, None]], format="csc")
        load = np.zeros(K.shape[0])
        load[: len(free)] = self.tip[free]
        moved = np.zeros((self.unknowns, 1))
        moved[free, 0] = _factors(K)(load)[: len(free)]
        return float((self.tip @ moved[:, 0]) ** 2 / self._energies(moved)[0][0, 0])


def _factors(matrix: Any) -> Callable[[Array], Array]:
    """The solution of a symmetric sparse system."""
    solve: Callable[[Array], Array] = sla.splu(matrix.tocsc()).solve
    return solve


@dataclass(frozen=True, eq=False)
class SolidModes:
    """Modes of a solid cue, the rigid ones first, ascending in frequency, mass-normalised.

    omega: (n,) rad/s. tip: (n,) mean displacement of the tip's face, 1/sqrt(kg), positive. turning: (n,) its rotation,
    1/(m sqrt(kg)). rigid: how many of them are rigid motions.
    """

    omega: Array
    tip: Array
    turning: Array
    rigid: int

    def __repr__(self) -> str:
        return f"SolidModes({brief(self.frequencies[:6])} Hz, {len(self.frequencies)} in all, {self.rigid} rigid)"

    @property
    def frequencies(self) -> Array:
        """Hz, the rigid motions left out."""
        return self.omega[self.rigid :] / (2 * np.pi)

    @property
    def at_tip(self) -> tuple[Array, Array]:
        """Deflection, 1/sqrt(kg), and rotation, 1/(m sqrt(kg)), of the tip in the rigid motions, then in the modes."""
        return self.tip, self.turning


def solid_modes(cue: Cue, count: int = 6, at: Solid | None = None) -> SolidModes:
    """Flexible bending modes of a cue that is computed as a solid, and its two rigid motions.

    Parameters
    ----------
    cue
        A `Cue` of segments; the shear coefficients that its segments may have are not asked for.
    count
        How many flexible modes.
    at
        How finely; of a `Solid` the order counts.

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
    return Body(cue, Fineness(order)).modes(count + 2)


def face_loaded_modes(cue: Cue, at: Solid, mass: float) -> SolidModes:
    """As many modes of a cue as ``at`` asks for, with a mass on the tip's face, kg."""
    return Body(cue, Fineness(at.order)).modes(at.modes + 2, mass=mass)
