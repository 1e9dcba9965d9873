"""A cue as a solid body: 3-D elasticity of its bending, by the Fourier harmonic m = 1 on an (z, r) mesh. Not a study.

With t the angle about the axis, u_r = U(r, z) cos t, u_t = V(r, z) sin t, u_z = W(r, z) cos t; every strain is then a
function of (r, z) times cos t or sin t (`_strains`), and the integral over t leaves pi. Unknowns are U, S = U + V, W:
on the axis S = W = 0, so that nothing is singular there. Elements are scikit-fem's quadrilaterals of any order
(ElementQuadP) on rows of conical elements, graded towards every end of a piece.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from graphlib import TopologicalSorter
from itertools import pairwise
from typing import NamedTuple

import numpy as np
import scipy.linalg as la
import scipy.sparse as sp
import scipy.sparse.linalg as sla
from numpy.typing import NDArray
from skfem import Basis, ElementQuadP, FacetBasis, MeshQuad

from cuefem import Cue, Material

Array = NDArray[np.float64]
SAME = 1e-9  # m: radii closer than this are one line of the mesh


@dataclass(frozen=True)
class Transverse:
    """What a beam does not know of a material: E_T over E across the axis, and Poisson's ratio nu_T within that plane.

    The material is transversely isotropic about the axis of the cue; its other constants are those of `Material`.
    """

    E_ratio: float
    nu: float


# Sugar maple, Wood Handbook (FPL-GTR-282) tables 5-1 and 5-2: the mean of E_R/E_L = 0.132 and E_T/E_L = 0.065, and the
# geometric mean of nu_RT = 0.774 and nu_TR = 0.349. A turned shaft shows both planes: the mean over the angle.
MAPLE = Transverse(0.0985, 0.52)


def stiffness(material: Material, across: Transverse | None) -> Array:
    """The stress of strains (rr, tt, zz, 2 rz, 2 rt, 2 tz), Pa, (6, 6); ValueError unless positive definite."""
    E, nu = material.E, material.nu
    E_T, nu_T = (E, nu) if across is None else (across.E_ratio * E, across.nu)
    compliance = np.diag([1 / E_T, 1 / E_T, 1 / E, 1 / material.G, 2 * (1 + nu_T) / E_T, 1 / material.G])
    compliance[0, 1] = compliance[1, 0] = -nu_T / E_T
    compliance[:2, 2] = compliance[2, :2] = -nu / E
    if np.linalg.eigvalsh(compliance * np.sqrt(np.outer(1 / compliance.diagonal(), 1 / compliance.diagonal())))[0] <= 0:
        raise ValueError(f"stiffness: nu {nu}, nu_T {nu_T}, E_T/E {E_T / E} make a material that gains energy")
    return np.linalg.inv(compliance)


class Fineness(NamedTuple):
    """order: of the polynomials. finest: length of the elements at the ends of a piece, in radii there; they grow
    by ``growth`` each to ``longest`` m. layers: elements across a layer of material."""

    order: int = 6
    finest: float = 0.4
    longest: float = 0.04
    growth: float = 2.0
    layers: int = 1


def lines(cue: Cue) -> tuple[Array, NDArray[np.intp], NDArray[np.intp]]:
    """The lines of the mesh along a cue, each from tip to butt and straight within a piece.

    radii: (lines, stations) m, rising with the line; bore, outer: (pieces,) the line that bounds a piece inside (-1: it
    is solid) and outside. Lines run on through pieces that they do not bound.
    """
    pieces = cue.segments
    ends = [[(s.tip_bore / 2, s.butt_bore / 2), (s.tip_diameter / 2, s.butt_diameter / 2)] for s in pieces]
    name: dict[tuple[int, int], int] = {}
    known: list[dict[int, float]] = [{} for _ in range(len(pieces) + 1)]
    for i, both in enumerate(ends):
        for kind, (first, last) in enumerate(both):
            if kind == 0 and first == last == 0:
                continue
            line = next((k for k, r in known[i].items() if abs(r - first) < SAME), len(set(name.values())))
            name[i, kind] = line
            known[i][line], known[i + 1][line] = first, last
    order = TopologicalSorter[int]()
    for radii in known:
        ranked = sorted(radii, key=radii.__getitem__)
        for below, above in pairwise(ranked):
            order.add(above, below)
        order.add(ranked[0])
    ranks = {line: k for k, line in enumerate(order.static_order())}
    radii = np.full((len(ranks) + 1, len(known)), np.nan)
    radii[0] = 0.0
    for station, found in enumerate(known):
        rows = [0, *(1 + ranks[line] for line in found)]
        radii[rows, station] = [0.0, *found.values()]
        given = np.sort(rows)
        radii[:, station] = np.interp(np.arange(len(radii)), given, radii[given, station])
        beyond = np.arange(len(radii)) - given[-1]
        radii[:, station] *= 1 + 0.1 * np.maximum(beyond, 0)
    bore = np.array([1 + ranks[name[i, 0]] if (i, 0) in name else 0 for i in range(len(pieces))])
    return radii, bore, np.array([1 + ranks[name[i, 1]] for i in range(len(pieces))])


def steps(length: float, near: tuple[float, float], how: Fineness) -> Array:
    """Positions in [0, 1] of the ends of elements along a piece of ``length``, radii ``near`` its two ends."""
    grown = [how.finest * r * how.growth ** np.arange(40) for r in near]
    left, right = (np.cumsum(g[g < how.longest]) for g in grown)
    left, right = left[left < 0.5 * length], length - right[right < 0.5 * length][::-1]
    first, last = [0.0, *left], [*right, length]
    if len(first) > 1 and last[0] - first[-1] < 0.5 * (first[-1] - first[-2]):
        first.pop()  # two rows that all but meet in the middle
    count = max(1, int(np.ceil((last[0] - first[-1]) / how.longest - SAME)))
    return np.concatenate([first, np.linspace(first[-1], last[0], count + 1)[1:-1], last]) / length


@dataclass(frozen=True)
class Body:
    """The solid of a cue, meshed. across: transverse constants by material; others have E_T = E and nu_T = nu."""

    cue: Cue
    across: dict[Material, Transverse]
    how: Fineness

    @cached_property
    def cells(self) -> tuple[MeshQuad, list[Material]]:
        """Quadrilaterals in (z, r), and their materials."""
        radii, bore, outer = lines(self.cue)
        points, cells, materials = [], [], []
        sub = np.arange(self.how.layers + 1) / self.how.layers
        for i, piece in enumerate(self.cue.segments):
            at = steps(piece.length, (radii[outer[i], i], radii[outer[i], i + 1]), self.how)
            for layer in range(outer[i]):
                material = piece.core if layer < bore[i] else piece.material
                if material is None:
                    continue
                r = radii[:, i, None] * (1 - at) + radii[:, i + 1, None] * at
                z = self.cue.nodes[i] * (1 - at) + self.cue.nodes[i + 1] * at
                rows = r[layer] + (r[layer + 1] - r[layer]) * sub[:, None]
                for j in range(self.how.layers):
                    for k in range(len(at) - 1):
                        points += [(z[k], rows[j, k]), (z[k + 1], rows[j, k + 1])]
                        points += [(z[k + 1], rows[j + 1, k + 1]), (z[k], rows[j + 1, k])]
                        cells.append(len(points) - 4 + np.arange(4))
                        materials.append(material)
        where = np.array(points)
        _, first, same = np.unique(
            np.round(where / SAME).astype(np.int64), axis=0, return_index=True, return_inverse=True
        )
        return MeshQuad(where[first].T, same.ravel()[np.array(cells)].T), materials

    @cached_property
    def basis(self) -> Basis:
        """scikit-fem's basis of one unknown field."""
        return Basis(self.cells[0], ElementQuadP(self.how.order), intorder=2 * self.how.order + 2)

    @property
    def unknowns(self) -> int:
        """Unknowns of the three fields."""
        return 3 * self.basis.N

    def _strains(self) -> Iterator[tuple[NDArray[np.intp], Array, Array]]:
        """Of every cell: its unknowns, its strains and its displacements of them, times roots of stiffness and mass.

        e_rr = U,r; e_tt = (U + V)/r = S/r; e_zz = W,z; 2 e_rz = U,z + W,r; 2 e_rt = V,r - (U + V)/r;
        2 e_tz = V,z - W/r.
        """
        basis, (_, materials) = self.basis, self.cells
        value = np.array([np.broadcast_to(np.asarray(f[0]), basis.dx.shape) for f in basis.basis])
        z, r = np.moveaxis(np.array([f[0].grad for f in basis.basis]), 1, 0)
        roots = {m: np.linalg.cholesky(stiffness(m, self.across.get(m))).T for m in set(materials)}
        radius, weights = np.asarray(basis.global_coordinates())[1], basis.dx
        none = np.zeros(value.shape[::2])  # (functions, points)
        for cell, material in enumerate(materials):
            f, fz, fr, fa = value[:, cell], z[:, cell], r[:, cell], value[:, cell] / radius[cell]
            strain = np.array(
                [
                    [fr, none, none],
                    [none, fa, none],
                    [none, none, fz],
                    [fz, none, fr],
                    [-fr, fr - fa, none],
                    [-fz, fz, -fa],
                ]
            )  # (6, 3, functions, points)
            move = np.array([[f, none, none], [-f, f, none], [none, none, f]])
            root = np.sqrt(np.pi * radius[cell] * weights[cell])
            strain = np.tensordot(roots[material], strain, 1) * root
            move = move * (np.sqrt(material.rho) * root)
            own = (basis.N * np.arange(3)[:, None] + basis.element_dofs[:, cell]).ravel()
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

    def free(self, *, supported: bool = False) -> NDArray[np.intp]:
        """Unknowns that are free; supported: U = V = 0 on both end faces, where a standing wave has its nodes."""
        mesh, N = self.cells[0], self.basis.N
        axis = self.basis.get_dofs(mesh.facets_satisfying(lambda x: x[1] < SAME, boundaries_only=True)).all()
        held = [N + axis, 2 * N + axis]
        if supported:
            length = self.cue.length
            ends = mesh.facets_satisfying(lambda x: np.minimum(x[0], length - x[0]) < SAME, boundaries_only=True)
            faces = self.basis.get_dofs(ends).all()
            held += [faces, N + faces]
        return np.setdiff1d(np.arange(self.unknowns), np.concatenate(held))

    @cached_property
    def tip(self) -> Array:
        """The mean deflection of the tip's face, as a row on the unknowns: that of u_x = U - S/2 over its area."""
        mesh, N = self.cells[0], self.basis.N
        face = FacetBasis(
            mesh,
            self.basis.elem,
            facets=mesh.facets_satisfying(lambda x: x[0] < SAME, boundaries_only=True),
            intorder=2 * self.how.order + 2,
        )
        weights = np.asarray(face.global_coordinates())[1] * face.dx
        row = np.zeros(self.unknowns)
        for i, function in enumerate(face.basis):
            parts = (np.asarray(function[0]) * weights).sum(axis=1)
            np.add.at(row, face.element_dofs[i], parts)
            np.add.at(row, N + face.element_dofs[i], -parts / 2)
        return row / weights.sum()

    def modes(self, count: int, *, supported: bool = False, near: float = 0.0) -> SolidModes:
        """The ``count`` lowest modes, those without frequency included; near: Hz, close below the lowest wanted."""
        free = self.free(supported=supported)
        K, M = (m[free][:, free] for m in self.matrices)
        shift = -((2 * np.pi * 30.0) ** 2) if near == 0 else (2 * np.pi * near) ** 2
        start = np.ones(len(free))
        squares, found = sla.eigsh(K, count, M, sigma=shift, v0=start)
        vectors = np.zeros((self.unknowns, count))
        vectors[free] = found[:, np.argsort(squares)]
        return self._polished(vectors)

    def _polished(self, vectors: Array) -> SolidModes:
        """One Rayleigh-Ritz step with the energy taken from the strains: K has lost eps times its largest entry, which
        is 1e-6 of the lowest mode's; the strains have not, and the vectors' error enters squared."""
        count = vectors.shape[1]
        stored, moved = np.zeros((2, count, count))
        for own, strain, move in self._strains():
            e, u = strain @ vectors[own], move @ vectors[own]
            stored += e.T @ e
            moved += u.T @ u
        squares, mix = la.eigh(stored, moved)
        return SolidModes(np.sqrt(np.abs(squares)), self.tip @ vectors @ mix)


class SolidModes(NamedTuple):
    """omega: (n,) rad/s, ascending, rigid ones first (zero to rounding). tip: (n,) mean deflection of the tip's face in
    mass-normalised modes, 1/sqrt(kg)."""

    omega: Array
    tip: Array

    @property
    def frequencies(self) -> Array:
        """Hz, the two rigid motions left out."""
        return self.omega[2:] / (2 * np.pi)
