"""The matrices K and M of a cue and its effects, in the degrees of freedom that clamps and rigid joints leave."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple

import lazy_loader
import numpy as np
from numpy.typing import NDArray

from cuefem.beam.basis import EXTRA_POINTS, Basis, element_basis, gauss_rule, line_basis, tabulated
from cuefem.beam.blas_threads import one_blas_thread
from cuefem.beam.mesh import Mesh, Resolution
from cuefem.beam.meshing import mesh_cue
from cuefem.beam.mode_count import segment_sections
from cuefem.beam.point_terms import BeamEffect, PointTerms
from cuefem.cue import POSITION_TOLERANCE, Array, Cue, Section

if TYPE_CHECKING:
    import scipy.sparse as sp

scipy = lazy_loader.load("scipy")  # loaded when used: few cues need sparse matrices
# A sparse eigenproblem costs in proportion to the modes, a dense one to the cube of the degrees of freedom (dof). They
# cost the same at about dof^2/BREAK_EVEN modes: measured with 10 to 400 modes of 522 to 1,180 dof. Below DENSE_LIMIT
# dof a dense one is always faster.
BREAK_EVEN, DENSE_LIMIT = 8000, 220
# A spring softer than this times mass and `System.shift` leaves the cue free: the squared frequency of its mode would
# be round-off error.
MIN_STIFFNESS = 1e-10


class Points(NamedTuple):
    """Gauss points of the whole beam, element by element, and within an element segment by segment; or other points.

    x: (points,) m from the tip. weights: (points,) of the integral over x, m. segment: (points,) index of the point's
    segment; from_segment_end: (points,) m from the segment's tip end. section: arrays (points,). first_point: (elements
    + 1,) the first point of each element, and the number of points. is_tabulated: (elements,) whether the element's
    points are the Gauss points of one segment, at which the basis is tabulated.
    """

    mesh: Mesh
    x: Array
    weights: Array
    segment: NDArray[np.intp]
    from_segment_end: Array
    section: Section
    first_point: list[int]
    is_tabulated: list[bool]

    def element(self, e: int) -> slice:
        """The points of an element."""
        return slice(self.first_point[e], self.first_point[e + 1])

    def fractions(self, e: int) -> Array:
        """Where the points of an element lie between its ends, from 0 to 1."""
        start, end = self.mesh.nodes[e : e + 2]
        return np.asarray((self.x[self.element(e)] - start) / (end - start))

    def line_basis(self, e: int) -> Array:
        """The line basis in an element at its points, and its derivatives, 1/m: (2, degrees, q)."""
        return self._basis(line_basis, e, units=[1.0, 1 / self._element_length(e)])

    def beam_basis(self, e: int) -> Array:
        """w, w', theta, theta' per degree of freedom of an element at its points, (4, dof, q).

        Rotational degrees of freedom are theta times the cue's length.
        """
        size, length = self._element_length(e), self.mesh.nodes[-1]
        return self._basis(element_basis, e, units=[1.0, 1 / size, 1 / length, 1 / (size * length)])

    def _element_length(self, e: int) -> float:
        start, end = self.mesh.nodes[e : e + 2]
        return float(end - start)

    def _basis(self, basis: Basis, e: int, *, units: list[float]) -> Array:
        """A basis of an element of length 1, in these units."""
        order = int(self.mesh.orders[e])
        values = tabulated(basis, order) if self.is_tabulated[e] else basis(order, self.fractions(e))
        return np.asarray(np.array(units)[:, None, None] * values)


class Fields(NamedTuple):
    """Deflection w, rotation theta and their derivatives along x at points, (points, k), of k vectors.

    Units per unit of the vectors: w m, dw 1, theta rad, dtheta rad/m.
    """

    w: Array
    dw: Array
    theta: Array
    dtheta: Array


@dataclass(frozen=True, eq=False)
class System:
    """The assembled beam: K q = omega^2 M q, in w (m) and theta times the cue's length (m).

    K, M: (free, free), arrays or sparse (`is_dense_faster`), N/m and kg. index: (n_dof,), for each degree of freedom of
    the mesh its index among the free ones; -1 if clamped, and the same for both sides of a rigid joint. rigid_basis:
    (free, r), basis of the rigid-body motions that no support resists, not normalised; r = 2 for a free cue. dashpots:
    (free,), diagonal of the viscous damping matrix, N s/m; None without dashpots. shift: about the lowest squared
    angular frequency of the free-free cue, rad2/s2; K + shift M is non-singular.
    """

    cue: Cue
    mesh: Mesh
    points: Points
    K: Array | sp.csc_matrix
    M: Array | sp.csc_matrix
    index: NDArray[np.intp]
    rigid_basis: Array
    dashpots: Array | None
    shift: float

    @property
    def size(self) -> int:
        """Number of free degrees of freedom."""
        return len(self.rigid_basis)

    def all_dofs(self, vectors: Array) -> Array:
        """All degrees of freedom of the mesh, (n_dof, k), from the free ones ``vectors`` (free, k)."""
        return np.where(self.index[:, None] < 0, 0.0, vectors[self.index])

    def unit_loads_at(self, x: float) -> Array:
        """Loads (free, 2) at the node ``x``, m: force 1 N, and couple 1 N times the cue's length; 0 if clamped."""
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
        return _fields(self.points, self.all_dofs(vectors))

    def geometric_stiffness(self, vectors: Array, masses: Sequence[tuple[float, float]]) -> Array:
        """Geometric stiffness of ``vectors`` (free, k) per newton of axial force: integral p w_i' w_j' dx, (k, k).

        The cue shortens by half the integral of w'^2 as it bends. Relative to its centre of mass, the tip recedes by
        half the integral of p w'^2, p(x) being the share of the mass behind x. The axial force at x is p times that at
        the tip, because it accelerates the mass behind x. The slope is w', not the section's rotation, as in Engesser's
        column. masses: (position m, mass kg) of each point mass, also (cue.length, cue.body_mass).
        """
        root_weights = np.sqrt(self.share_behind(masses) * self.points.weights)
        rows = root_weights[:, None] * self.fields(vectors).dw
        return np.asarray(rows.T @ rows)

    def share_behind(self, masses: Sequence[tuple[float, float]]) -> Array:
        """Share of the cue's mass behind each Gauss point, (points,)."""
        points, lengths = self.points, self.cue.lengths
        # rho A of a cone is a parabola, a + b t + c t^2 at the fraction t of its length
        first, _, middle, _, last = segment_sections(self.cue).rhoA.T
        mass = lengths / 6 * (first + 4 * middle + last)
        a, b, c = lengths * np.array([first, 4 * middle - 3 * first - last, 2 * (first + last) - 4 * middle])
        segment = points.segment
        t = points.from_segment_end / lengths[segment]
        ahead = (np.cumsum(mass) - mass)[segment] + t * (a[segment] + t * (b[segment] / 2 + t * c[segment] / 3))
        for position, point_mass in masses:
            ahead = ahead + point_mass * (points.x > position)
        return np.asarray(1 - ahead / (mass.sum() + sum(point_mass for _, point_mass in masses)))

    def interpolate(self, vectors: Array, x: Array) -> tuple[Array, Array]:
        """(w, theta) of the degrees of freedom ``vectors`` (free, k) at positions ``x``: two arrays (k, *x.shape)."""
        order = np.argsort(x, axis=None, kind="stable")
        points = _points(self.cue, self.mesh, x.ravel()[order], np.ones(x.size), [False] * len(self.mesh.orders))
        fields = _fields(points, self.all_dofs(vectors))
        w, theta = np.empty_like(fields.w), np.empty_like(fields.w)
        w[order], theta[order] = fields.w, fields.theta
        return w.T.reshape(-1, *x.shape), theta.T.reshape(-1, *x.shape)


def _fields(points: Points, dof_values: Array) -> Fields:
    """The fields of all degrees of freedom of the mesh, (n_dof, k), at any points."""
    out, mesh = np.zeros((4, len(points.x), dof_values.shape[1])), points.mesh
    for e, (order, first) in enumerate(zip(mesh.orders.tolist(), mesh.first.tolist(), strict=True)):
        rows = points.element(e)
        if rows.start < rows.stop:
            out[:, rows] = points.beam_basis(e).swapaxes(1, 2) @ dof_values[first : first + 2 * order + 3]
    return Fields(*out)


def gauss_points(cue: Cue, mesh: Mesh) -> Points:
    """Gauss points between the nodes and the ends of segments; exact for a solid cone that is one element."""
    ends = cue.nodes[np.min(np.abs(cue.nodes[:, None] - mesh.nodes), axis=1) > POSITION_TOLERANCE * cue.length]
    x = np.sort(np.append(mesh.nodes, ends))
    sizes = np.diff(x)
    element = np.searchsorted(mesh.nodes, (x[:-1] + x[1:]) / 2) - 1
    # a polynomial varies fastest at the ends of its element, like cos(n arccos x): a part s needs n sqrt(s) points
    fraction = np.sqrt(sizes / np.diff(mesh.nodes)[element])
    counts = np.ceil(mesh.orders[element] * fraction - POSITION_TOLERANCE).astype(int) + EXTRA_POINTS
    rules = [gauss_rule(n) for n in counts.tolist()]
    return _points(
        cue,
        mesh,
        np.concatenate([a + h * points for a, h, (points, _) in zip(x, sizes, rules, strict=False)]),
        np.concatenate([h * weights for h, (_, weights) in zip(sizes, rules, strict=True)]),
        (np.bincount(element) == 1).tolist(),
    )


def _points(cue: Cue, mesh: Mesh, x: Array, weights: Array, is_tabulated: list[bool]) -> Points:
    """The points ``x``, ascending."""
    segment = np.searchsorted(cue.nodes[1:-1], x, side="right")
    from_end = x - cue.nodes[segment]
    first_point = [0, *np.searchsorted(x, mesh.nodes[1:-1]).tolist(), len(x)]
    return Points(mesh, x, weights, segment, from_end, cue.section_in(segment, from_end), first_point, is_tabulated)


@one_blas_thread
def assemble(
    cue: Cue,
    at: int | Resolution,
    effects: tuple[BeamEffect, ...] = (),
    count: int | None = None,
    positions: Sequence[float] = (),
) -> System:
    """Assemble a cue with the effects that act on it.

    at, positions: as in `mesh_cue`. count: number of modes that will be computed, which decides between dense and
    sparse matrices; by default ``at`` if it is a number of modes, 0 for a resolution.
    """
    mesh = mesh_cue(cue, at, effects, positions)
    points = gauss_points(cue, mesh)
    terms = PointTerms(mesh, cue)
    for effect in effects:
        effect.add_to(terms)
    scale = np.ones(mesh.n_dof)
    scale[np.append(mesh.first, mesh.last) + 1] = 1 / cue.length**2  # rotations are scaled by the length
    index = np.arange(mesh.n_dof)
    for (before, after), value in terms.compliance.items():
        index[before] = before if value else after
    if terms.compliance or terms.fixed:
        index[np.isin(index, list(terms.fixed))] = -1
        index[index >= 0] = np.unique(index[index >= 0], return_inverse=True)[1]
    size = int(index.max()) + 1

    stiffness, inertia = [], []  # (first degree of freedom, block) of each element and joint
    section, weights = points.section, points.weights
    root_EI, root_kGA, root_rhoA, root_rhoI = np.sqrt([section.EI, section.kGA, section.rhoA, section.rhoI] * weights)
    for e, first in enumerate(mesh.first.tolist()):
        rows, (w, dw, theta, dtheta) = points.element(e), points.beam_basis(e)
        strains = np.concatenate([root_EI[rows] * dtheta, root_kGA[rows] * (dw - theta)], axis=1)
        motions = np.concatenate([root_rhoA[rows] * w, root_rhoI[rows] * theta], axis=1)
        stiffness.append((first, strains @ strains.T))
        inertia.append((first, motions @ motions.T))
    for (before, _), value in terms.compliance.items():  # both sides have w and theta: those behind follow after two
        if value:
            jump = np.array([1.0, 0.0, -1.0])
            stiffness.append((before, scale[before] / value * np.outer(jump, jump)))

    dense = is_dense_faster(size, count or (at if isinstance(at, int) else 0))
    K = assemble_blocks(stiffness, terms.stiffness * scale, dense)
    M = assemble_blocks(inertia, terms.mass * scale, dense)
    if size < mesh.n_dof:
        K, M = (_free_part(matrix, index, size) for matrix in (K, M))

    def free_diagonal(values: Array) -> Array:
        return np.bincount(index % (size + 1), values * scale, size + 1)[:-1].astype(float)

    springs = free_diagonal(terms.stiffness)
    dashpots = free_diagonal(terms.dashpot) if terms.dashpot.any() else None
    shift, mass = _shift(cue, points), float(points.weights @ points.section.rhoA)
    rigid_basis = _rigid_basis(mesh, cue.length, index, springs > MIN_STIFFNESS * shift * mass)
    return System(cue, mesh, points, K, M, index, rigid_basis, dashpots, shift)


def _free_part(matrix: Array | sp.csc_matrix, index: NDArray[np.intp], size: int) -> Array | sp.csc_matrix:
    """The matrix in the free degrees of freedom: rows and columns of the same ``index`` add up."""
    free = np.flatnonzero(index >= 0)
    to = index[free]
    if isinstance(matrix, np.ndarray):
        part = np.zeros((size, size))
        np.add.at(part, np.ix_(to, to), matrix[np.ix_(free, free)])
        return part
    expansion = scipy.sparse.csc_matrix((np.ones(len(free)), (free, to)), (len(index), size))
    return expansion.T @ matrix @ expansion


def _shift(cue: Cue, points: Points) -> float:
    # 4.73^4 EI/(rhoA L^4), the lowest free mode of the uniform rod with the mean stiffness and mass
    return float(500 * (points.weights @ points.section.EI) / (points.weights @ points.section.rhoA) / cue.length**4)


def is_dense_faster(n_dof: int, count: int) -> bool:
    """Whether a dense eigenproblem computes the lowest ``count`` modes faster than a sparse one."""
    return n_dof <= DENSE_LIMIT or count > n_dof**2 / BREAK_EVEN


def assemble_blocks(blocks: Iterable[tuple[int, Array]], diagonal: Array, dense: bool) -> Array | sp.csc_matrix:
    """The sum of ``blocks``, each from its first degree of freedom on, and a ``diagonal``, as a matrix."""
    if dense:
        matrix = np.diag(diagonal)
        for first, block in blocks:
            span = slice(first, first + len(block))
            matrix[span, span] += block
        return matrix
    positions = [first + np.indices(block.shape).reshape(2, -1) for first, block in blocks]
    values = np.concatenate([block.ravel() for _, block in blocks])
    matrix = scipy.sparse.coo_matrix((values, np.concatenate(positions, axis=1)), shape=(len(diagonal),) * 2)
    return scipy.sparse.csc_matrix(matrix + scipy.sparse.diags(diagonal))


def _rigid_basis(mesh: Mesh, length: float, index: NDArray[np.intp], has_spring: NDArray[np.bool_]) -> Array:
    """The combinations of translation and rotation about the tip that no spring or clamp resists, (free, r)."""
    motions = np.zeros((mesh.n_dof, 2))
    for w, x in ((mesh.first, mesh.nodes[:-1]), (mesh.last, mesh.nodes[1:])):
        motions[w, 0], motions[w, 1] = 1.0, x / length
        motions[w + 1, 1] = 1.0
    basis = np.zeros((len(has_spring) + 1, 2))
    basis[index] = motions
    resisted_motions = np.concatenate([motions[index < 0], basis[:-1][has_spring]])
    if not len(resisted_motions):
        return basis[:-1]
    return np.asarray(basis[:-1] @ scipy.linalg.null_space(resisted_motions, rcond=1e-12))
