"""The matrices K and M of a cue and its effects, in the degrees of freedom that clamps and rigid joints leave."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple

import lazy_loader
import numpy as np
from numpy.typing import NDArray

from cuefem.beam.basis import EXTRA_POINTS, element_basis, gauss_rule, line_basis, tabulated_line_basis
from cuefem.beam.mesh import POSITION_TOLERANCE, BeamEffect, Mesh, MeshOptions, PointTerms, mesh_cue
from cuefem.cue import Array, Cue, Section

if TYPE_CHECKING:
    import scipy.sparse as sp

scipy = lazy_loader.load("scipy")  # loaded when used: few cues need sparse matrices
# A sparse eigenproblem costs in proportion to the modes, a dense one to the cube of the degrees of freedom (dof). They
# cost the same when the number of modes is (dof/EVEN)^3. Measured: 6 modes of 270 dof, 30 of 450, 150 of 780.
# Below DENSE_LIMIT dof a dense one is always faster.
EVEN, DENSE_LIMIT = 145, 220
# A spring softer than this, relative to the first mode, leaves the cue free: its mode would be round-off error.
MIN_STIFFNESS = 1e-10


class Points(NamedTuple):
    """Gauss points of the whole beam, element by element, and within an element segment by segment; or other points.

    x: (points,) m from the tip. weights: m. piece: index of the point's segment; offset: m from the segment's tip end.
    section: arrays (points,). rows: (elements + 1,) the first point of each element. tabulated: (elements,) whether its
    points are the Gauss points of one segment, at which the basis is tabulated.
    """

    mesh: Mesh
    x: Array
    weights: Array
    piece: NDArray[np.intp]
    offset: Array
    section: Section
    rows: list[int]
    tabulated: list[bool]

    def element(self, e: int) -> slice:
        """The points of an element."""
        return slice(self.rows[e], self.rows[e + 1])

    def line_basis(self, e: int) -> tuple[Array, Array]:
        """scikit-fem's hierarchical line basis in an element at its points, and its derivatives, 1/m: (degrees, q)."""
        start, end = self.mesh.nodes[e : e + 2]
        if self.tabulated[e]:
            values, slopes = tabulated_line_basis(int(self.mesh.orders[e]))
        else:
            values, slopes = line_basis(int(self.mesh.orders[e]) + 1, (self.x[self.element(e)] - start) / (end - start))
        return values, slopes / (end - start)


class Fields(NamedTuple):
    """Deflection, rotation and their derivatives along x at points, each (points, k)."""

    w: Array
    dw: Array
    theta: Array
    dtheta: Array


@dataclass(frozen=True)
class System:
    """The assembled beam: K q = omega^2 M q, in w (m) and theta times the cue's length (m).

    K, M: (free, free), arrays or sparse (`is_dense_faster`). index: (unknowns,) the free degree of freedom of each one
    of the mesh, -1 if clamped; the two sides of a rigid joint are one. rigid: (free, r), the exact rigid-body modes
    that no support resists (two for a free cue). dashpots: (free,) diagonal of the viscous matrix, None without
    dashpots. shift: rad2/s2, of the order of the lowest mode's squared frequency; it makes K + shift M regular.
    """

    cue: Cue
    mesh: Mesh
    points: Points
    K: Array | sp.csc_matrix
    M: Array | sp.csc_matrix
    index: NDArray[np.intp]
    rigid: Array
    dashpots: Array | None
    shift: float

    @property
    def size(self) -> int:
        """Number of free degrees of freedom."""
        return int(self.K.shape[0])

    def all_dofs(self, vectors: Array) -> Array:
        """All degrees of freedom of the mesh, (unknowns, k), from the free ones ``vectors`` (free, k)."""
        return np.asarray(np.concatenate([vectors, np.zeros((1, vectors.shape[1]))])[self.index])

    def unit_loads_at(self, x: float) -> Array:
        """A unit force and a unit couple over the length at the node ``x``, m, (free, 2); zero where clamped."""
        forces = np.zeros((self.size + 1, 2))
        forces[self.index[list(self.mesh.dofs_at(self.mesh.node(x)))], [0, 1]] = 1.0
        return forces[:-1]

    def static_stiffness(self, x: float) -> float:
        """Force over deflection at the node ``x``, N/m, of a supported cue."""
        force = self.unit_loads_at(x)[:, 0]
        solve = np.linalg.solve if isinstance(self.K, np.ndarray) else scipy.sparse.linalg.spsolve
        return float(1 / (force @ solve(self.K, force)))

    def fields(self, vectors: Array) -> Fields:
        """The fields of the degrees of freedom ``vectors`` (free, k) at the Gauss points."""
        return _fields(self.cue.length, self.points, self.all_dofs(vectors))

    def geometric_stiffness(self, vectors: Array, masses: Sequence[tuple[float, float]]) -> Array:
        """Geometric stiffness of ``vectors`` (free, k) per newton of axial force: integral p w_i' w_j' dx, (k, k).

        The cue shortens by half the integral of w'^2 as it bends. Relative to its centre of mass, the tip recedes by
        half the integral of p w'^2, p(x) being the share of the mass behind x. The axial force at x is p times that at
        the tip, because it accelerates the mass behind x. The slope is w', not the section's rotation, as in Engesser's
        column. masses: (position m, mass kg) of each point mass.
        """
        root = np.sqrt(self.share_behind(masses) * self.points.weights)
        rows = root[:, None] * self.fields(vectors).dw
        return np.asarray(rows.T @ rows)

    def share_behind(self, masses: Sequence[tuple[float, float]]) -> Array:
        """Share of the cue's mass behind each Gauss point, (points,)."""
        points, cue = self.points, self.cue
        first, middle = (cue.section_in(points.piece, part * points.offset).rhoA for part in (0.0, 0.5))
        mass = np.bincount(points.piece, points.section.rhoA * points.weights, len(cue.segments))
        # Simpson's rule is exact for the area of a cone
        ahead = (np.cumsum(mass) - mass)[points.piece] + points.offset / 6 * (first + 4 * middle + points.section.rhoA)
        for position, lump in masses:
            ahead = ahead + lump * (points.x > position)
        return np.asarray(1 - ahead / (mass.sum() + sum(lump for _, lump in masses)))

    def interpolate(self, vectors: Array, x: Array) -> tuple[Array, Array]:
        """(w, theta) of the degrees of freedom ``vectors`` (free, k) at positions ``x``: two arrays (k, *x.shape)."""
        order = np.argsort(x, axis=None, kind="stable")
        points = _points(self.cue, self.mesh, x.ravel()[order], np.ones(x.size), [False] * len(self.mesh.orders))
        fields = _fields(self.cue.length, points, self.all_dofs(vectors))
        w, theta = np.empty_like(fields.w), np.empty_like(fields.w)
        w[order], theta[order] = fields.w, fields.theta
        return w.T.reshape(-1, *x.shape), theta.T.reshape(-1, *x.shape)


def _fields(length: float, points: Points, unknowns: Array) -> Fields:
    """The fields of all degrees of freedom ``unknowns`` (unknowns, k) at any points."""
    out, mesh = np.zeros((4, len(points.x), unknowns.shape[1])), points.mesh
    for e, (order, first) in enumerate(zip(mesh.orders.tolist(), mesh.first.tolist(), strict=True)):
        rows = points.element(e)
        if rows.start < rows.stop:
            basis = element_basis(order, *points.line_basis(e), length)
            out[:, rows] = basis.swapaxes(1, 2) @ unknowns[first : first + 2 * order + 3]
    return Fields(*out)


def gauss_points(cue: Cue, mesh: Mesh) -> Points:
    """Gauss points between the nodes and the ends of segments, exact for a cone that is one element."""
    ends = cue.nodes[np.min(np.abs(cue.nodes[:, None] - mesh.nodes), axis=1) > POSITION_TOLERANCE * cue.length]
    x = np.sort(np.append(mesh.nodes, ends))
    sizes = np.diff(x)
    element = np.searchsorted(mesh.nodes, (x[:-1] + x[1:]) / 2) - 1
    # polynomials vary fastest near the ends of an element: like cos(n arccos x)
    part = np.sqrt(sizes / np.diff(mesh.nodes)[element])
    counts = np.ceil(mesh.orders[element] * part - POSITION_TOLERANCE).astype(int) + EXTRA_POINTS
    rules = [gauss_rule(n) for n in counts.tolist()]
    return _points(
        cue,
        mesh,
        np.concatenate([a + h * points for a, h, (points, _) in zip(x, sizes, rules, strict=False)]),
        np.concatenate([h * weights for h, (_, weights) in zip(sizes, rules, strict=True)]),
        (np.bincount(element) == 1).tolist(),
    )


def _points(cue: Cue, mesh: Mesh, x: Array, weights: Array, tabulated: list[bool]) -> Points:
    """The points ``x``, ascending."""
    piece = np.searchsorted(cue.nodes[1:-1], x, side="right")
    offset = x - cue.nodes[piece]
    rows = [0, *np.searchsorted(x, mesh.nodes[1:-1]).tolist(), len(x)]
    return Points(mesh, x, weights, piece, offset, cue.section_in(piece, offset), rows, tabulated)


def assemble(
    cue: Cue,
    at: int | MeshOptions,
    effects: tuple[BeamEffect, ...] = (),
    count: int | None = None,
    positions: Sequence[float] = (),
) -> System:
    """Assemble a cue with the effects that act on it.

    at, positions: as in `mesh_cue`. count: how many modes will be computed, by default those of ``at``, or few.
    """
    mesh = mesh_cue(cue, at, effects, positions)
    points = gauss_points(cue, mesh)
    terms = PointTerms(mesh, cue)
    for effect in effects:
        effect.add_to(terms)
    scale = np.ones(mesh.unknowns)
    scale[np.append(mesh.first, mesh.last) + 1] = 1 / cue.length**2  # rotations are scaled by the length
    index = np.arange(mesh.unknowns)
    for (before, after), value in terms.compliance.items():
        index[before] = before if value else after
    if terms.compliance or terms.fixed:
        index[np.isin(index, list(terms.fixed))] = -1
        index[index >= 0] = np.unique(index[index >= 0], return_inverse=True)[1]
    size = int(index.max()) + 1

    stiff, heavy = [], []
    section, weights = points.section, points.weights
    EI, kGA, rhoA, rhoI = np.sqrt([section.EI, section.kGA, section.rhoA, section.rhoI] * weights)
    for e, (order, first) in enumerate(zip(mesh.orders.tolist(), mesh.first.tolist(), strict=True)):
        rows, own = points.element(e), index[first : first + 2 * order + 3]
        w, dw, theta, dtheta = element_basis(order, *points.line_basis(e), cue.length)
        strains = np.concatenate([EI[rows] * dtheta, kGA[rows] * (dw - theta)], axis=1)
        motions = np.concatenate([rhoA[rows] * w, rhoI[rows] * theta], axis=1)
        stiff.append((own, strains @ strains.T))
        heavy.append((own, motions @ motions.T))
    for (before, after), value in terms.compliance.items():
        if value:
            stiff.append((index[[before, after]], scale[before] / value * np.array([[1.0, -1.0], [-1.0, 1.0]])))

    def point(values: Array) -> Array:
        return np.bincount(index % (size + 1), values * scale, size + 1)[:-1].astype(float)

    springs = point(terms.stiffness)
    dense = is_dense_faster(size, count or (at if isinstance(at, int) else 0))
    K, M = assemble_blocks(stiff, springs, dense), assemble_blocks(heavy, point(terms.mass), dense)
    dashpots = point(terms.dashpot) if terms.dashpot.any() else None
    shift, mass = _shift(cue, points), float(points.weights @ points.section.rhoA)
    rigid = _free_rigid_modes(mesh, cue.length, index, springs > MIN_STIFFNESS * shift * mass)
    return System(cue, mesh, points, K, M, index, rigid, dashpots, shift)


def _shift(cue: Cue, points: Points) -> float:
    # 4.73^4 EI/(rhoA L^4), the lowest free mode of the uniform rod with the mean stiffness and mass
    return float(500 * (points.weights @ points.section.EI) / (points.weights @ points.section.rhoA) / cue.length**4)


def is_dense_faster(unknowns: int, count: int) -> bool:
    """Whether a dense eigenproblem computes the lowest ``count`` modes faster than a sparse one."""
    return unknowns <= DENSE_LIMIT or count > (unknowns / EVEN) ** 3


def assemble_blocks(
    blocks: Iterable[tuple[NDArray[np.intp], Array]], diagonal: Array, dense: bool
) -> Array | sp.csc_matrix:
    """The sum of ``blocks``, each with its indices (-1: omitted), and a ``diagonal``, as a matrix."""
    size = len(diagonal)
    if dense:
        whole = np.diag(diagonal)
        for own, block in blocks:
            first, kept = int(own[0]), own >= 0
            if kept.all() and np.array_equal(own, np.arange(first, first + len(own))):
                whole[first : first + len(own), first : first + len(own)] += block
            else:
                whole[np.ix_(own[kept], own[kept])] += block[np.ix_(kept, kept)]
        return whole
    places = np.concatenate([[np.repeat(own, len(own)), np.tile(own, len(own))] for own, _ in blocks], axis=1) % (
        size + 1
    )
    values = np.concatenate([block.ravel() for _, block in blocks])
    summed = scipy.sparse.coo_matrix((values, places), shape=(size + 1,) * 2).tocsc()[:size, :size]
    return scipy.sparse.csc_matrix(summed + scipy.sparse.diags(diagonal))


def _free_rigid_modes(mesh: Mesh, length: float, index: NDArray[np.intp], sprung: NDArray[np.bool_]) -> Array:
    """The combinations of translation and rotation about the tip that no spring or clamp resists, (free, r)."""
    motions = np.zeros((mesh.unknowns, 2))
    for w, x in ((mesh.first, mesh.nodes[:-1]), (mesh.last, mesh.nodes[1:])):
        motions[w, 0], motions[w, 1] = 1.0, x / length
        motions[w + 1, 1] = 1.0
    free = np.zeros((len(sprung) + 1, 2))
    free[index] = motions
    resisted = np.concatenate([motions[index < 0], free[:-1][sprung]])
    if not len(resisted):
        return free[:-1]
    _, strength, directions = np.linalg.svd(resisted)
    rank = int(np.sum(strength > 1e-12 * strength[0]))
    return free[:-1] @ directions[rank:].T
