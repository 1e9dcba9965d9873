"""The matrices K and M of a cue and its effects, and the unknowns that clamps and stiff joints take out."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache
from typing import TYPE_CHECKING, Any

import lazy_loader
import numpy as np
from numpy.typing import NDArray

from cuefem.beam.basis import local_basis, products, table
from cuefem.beam.mesh import ActsOnCue, Links, Mesh, Terms, mesh_cue
from cuefem.beam.waves import EVEN
from cuefem.cue import Array, Cue, Section

if TYPE_CHECKING:
    import scipy.sparse as sp

scipy = lazy_loader.load("scipy")  # loaded when used: few cues need sparse matrices
# Below this many unknowns a dense eigenproblem is faster than a sparse one, however many modes are wanted.
DENSE_LIMIT = 220


@dataclass(frozen=True)
class System:
    """The assembled beam: K q = omega^2 M q, in w (m) and theta times the cue's length (m).

    K, M: (unknowns, unknowns), arrays or sparse (`suits_dense`). rigid: (unknowns, r), the exact
    rigid motions that stay free (two for a free cue). dashpots: diagonal of the viscous matrix, None without one.
    fixed: unknowns that a clamp takes out. shift: a square frequency of the order of the lowest mode's, rad2/s2, with
    which K + shift M is regular where K is not. section: at the Gauss points, arrays (elements, q). roots:
    (elements, 2 q, u): roots.T @ roots is an element's stiffness (`stiffness_roots`).
    springs: the part of K's diagonal that effects add. links: the springs of joints. tied: (n, 2) pairs of unknowns
    (tip side, butt side) that a joint keeps equal.
    """

    mesh: Mesh
    K: Array | sp.csc_matrix
    M: Array | sp.csc_matrix
    rigid: Array
    length: float
    dashpots: Array | None
    fixed: NDArray[np.intp]
    shift: float
    section: Section
    roots: Array
    springs: Array
    links: Links
    tied: NDArray[np.intp]

    @property
    def free(self) -> sp.csc_matrix | None:
        """Matrix from the free unknowns to all of them, (unknowns, free); None if no clamp or tie takes any out."""
        if len(self.fixed) + len(self.tied) == 0:
            return None
        source = np.arange(self.mesh.unknowns)
        source[self.tied[:, 0]] = self.tied[:, 1]
        rows = np.flatnonzero(~np.isin(source, self.fixed))
        free, columns = np.unique(source[rows], return_inverse=True)
        return scipy.sparse.csc_matrix((np.ones(len(rows)), (rows, columns)), shape=(self.mesh.unknowns, len(free)))

    def strains(self, vectors: Array) -> Array:
        """Strains of unknowns ``vectors`` (unknowns, k), times roots of stiffness, (rows, k): K = strains.T @ strains.

        First those of bending and of shear at the Gauss points, element by element, then of springs and links. For a
        rigid motion the strains are zero to rounding, while K times it is rounding times the stiffest element.
        So energies taken from strains keep low frequencies exact beside a stiff short piece.
        """
        own = self.mesh.own(vectors)
        strained = (self.roots @ own).reshape(-1, own.shape[2])
        supported = np.flatnonzero(self.springs)
        if len(supported) + len(self.links.stiffness) == 0:
            return np.asarray(strained)
        sprung = np.sqrt(self.springs[supported])[:, None] * vectors[supported]
        jumps = np.sqrt(self.links.stiffness)[:, None] * (vectors[self.links.after] - vectors[self.links.before])
        return np.concatenate([strained, sprung, jumps])

    def tip_displacement(self, vectors: Array) -> tuple[Array, Array]:
        """Deflection w and rotation theta of unknowns ``vectors`` (unknowns, k) at the tip: two arrays (k,)."""
        return vectors[0], vectors[1] / self.length

    def geometric_stiffness(self, vectors: Array, masses: Sequence[tuple[float, float]]) -> Array:
        """What a newton of thrust at the tip does to ``vectors`` (unknowns, k): integral p w_i' w_j' dx, (k, k).

        The cue shortens by half the integral of w'^2 as it bends. Seen from its centre of mass, the tip goes back by
        half the integral of p w'^2, p(x) being the share of the mass behind x, and p is also the share of the thrust
        that the cue bears there, which accelerates what is behind. The slope is w' and not the section's rotation, as
        in Engesser's column. masses: (position m, mass kg) of each lump.
        """
        mesh = self.mesh
        _, slope, _ = slopes(mesh.own(vectors), mesh.sizes[:, None, None], self.length, mesh.order)
        root = np.sqrt(self.share_behind(masses) * table(mesh.order).weights * mesh.sizes[:, None])
        rows = (root[:, :, None] * slope).reshape(-1, vectors.shape[1])
        return np.asarray(rows.T @ rows)

    def share_behind(self, masses: Sequence[tuple[float, float]]) -> Array:
        """Share of the cue's mass behind each Gauss point, (elements, q)."""
        mesh, t = self.mesh, table(self.mesh.order)
        rho, sizes = self.section.rhoA, mesh.sizes[:, None]
        each = (sizes * rho * t.weights).sum(axis=1)
        ahead = np.concatenate([[0.0], np.cumsum(each)[:-1]])[:, None] + sizes * (rho @ _integrals(mesh.order).T)
        x = mesh.nodes[:-1, None] + sizes * t.points
        total = each.sum() + sum(mass for _, mass in masses)
        for position, mass in masses:
            ahead = ahead + mass * (x > position)
        return np.asarray(1 - ahead / total)

    def interpolate(self, vectors: Array, x: Array) -> tuple[Array, Array]:
        """(w, theta) of unknowns ``vectors`` (unknowns, k) at positions ``x``: two arrays (k, *x.shape)."""
        mesh = self.mesh
        element = np.clip(np.searchsorted(mesh.nodes, x.ravel(), side="right") - 1, 0, len(mesh.piece) - 1)
        local = (x.ravel() - mesh.nodes[element]) / mesh.sizes[element]
        w, _, theta, _ = local_basis(mesh.order, local)
        own = mesh.own(vectors)[element]  # (points, unknowns of an element, k)
        values = (np.einsum("iq,qik->kq", basis, own).reshape(-1, *x.shape) for basis in (w, theta))
        deflection, rotation = values
        return deflection, rotation / self.length


def slopes(own: Array, h: Array, length: Any, order: int) -> tuple[Array, Array, Array]:
    """(theta', w', theta) at the Gauss points from elements' own unknowns (..., elements, u, k): (..., elements, q, k).

    h: sizes of the elements, m; length: that scales theta, m; both broadcast against the results.
    """
    t = table(order)
    return t.dtheta.T @ own / (h * length), t.dw.T @ own / h, t.theta.T @ own / length


def weighted_strains(own: Array, section: Section, sizes: Array, length: Any, order: int) -> tuple[Array, Array]:
    """Curvature and shear of elements' own unknowns (..., elements, u, k), times the roots of stiffness and weight."""
    bent, slope, turned = slopes(own, sizes[..., None, None], length, order)
    weights = table(order).weights * sizes[..., None]
    bent *= np.sqrt(section.EI * weights)[..., None]
    return bent, (slope - turned) * np.sqrt(section.kGA * weights)[..., None]


def stiffness_roots(section: Section, sizes: Array, length: float, order: int) -> Array:
    """The weighted strains of each element's unknowns, (elements, 2 q, u): its stiffness is roots.T @ roots.

    Curvatures, then shears, at the Gauss points; ``length`` scales theta.
    """
    t, h = table(order), sizes[:, None, None]
    weights = t.weights * sizes[:, None]
    bent = np.sqrt(section.EI * weights)[..., None] * (t.dtheta.T / (h * length))
    sheared = np.sqrt(section.kGA * weights)[..., None] * (t.dw.T / h - t.theta.T / length)
    return np.concatenate([bent, sheared], axis=1)


def mass_roots(section: Section, sizes: Array, length: float, order: int) -> Array:
    """As `stiffness_roots`, for the mass: deflections, then rotations."""
    t, weights = table(order), table(order).weights * sizes[:, None]
    moved = np.sqrt(section.rhoA * weights)[..., None] * t.w.T
    turned = (np.sqrt(section.rhoI * weights) / length)[..., None] * t.theta.T
    return np.concatenate([moved, turned], axis=1)


def sections(cue: Cue, mesh: Mesh) -> Section:
    """Section properties at the Gauss points of every element: arrays (elements, q)."""
    s = mesh.offset[:, None] + mesh.sizes[:, None] * table(mesh.order).points
    return cue.section_in(mesh.piece[:, None], s)


def element_matrices(section: Section, sizes: Array, length: float, order: int) -> tuple[Array, Array]:
    """Element K and M, each (..., elements, u, u), from section properties (..., elements, q) and element sizes.

    One matrix product each; ``length`` scales theta.
    """
    t, h = table(order), sizes[..., None]
    EI, kGA = section.EI * t.weights, section.kGA * t.weights
    stiff = np.concatenate([EI / (h * length**2), kGA / h, kGA / length, kGA * h / length**2], axis=-1)
    heavy = np.concatenate([section.rhoA * t.weights * h, section.rhoI * t.weights * h / length**2], axis=-1)
    shape = (*stiff.shape[:-1], len(t.w), len(t.w))
    of_stiffness, of_mass = products(order)
    return (stiff @ of_stiffness).reshape(shape), (heavy @ of_mass).reshape(shape)


def assemble(
    cue: Cue,
    *,
    elements: int | tuple[int, ...],
    order: int | tuple[int, ...],
    effects: tuple[ActsOnCue, ...] = (),
    count: int = 0,
) -> System:
    """Assemble a cue with the effects that act on it; elements and order as a Resolution has them, or as `mesh_cue`.

    count: how many modes will be wanted of it; by default few.
    """
    for effect in effects:
        effect.check_on(cue, type(effect).__name__)
    positions = tuple(x for effect in effects for x in effect.positions)
    splits = tuple(x for effect in effects for x in effect.splits)
    mesh = mesh_cue(cue, elements=elements, order=order, positions=positions, splits=splits)
    section = sections(cue, mesh)
    roots, heavy = (each(section, mesh.sizes, cue.length, mesh.order) for each in (stiffness_roots, mass_roots))
    terms = Terms(mesh, cue)
    for effect in effects:
        effect.add_to(terms)
    scale = np.ones(mesh.unknowns)
    scale[np.append(mesh.first, mesh.last) + 1] = 1 / cue.length**2  # rotations stand times the length

    def point(values: dict[int, float]) -> Array:
        diagonal = np.zeros(mesh.unknowns)
        if values:
            diagonal[list(values)] = list(values.values())
        return diagonal * scale

    springs, links = point(terms.stiffness), terms.links(scale)
    dense = suits_dense(mesh.unknowns, count)
    K = gather(mesh.first, mesh.unknowns, mesh.blocks(roots), point=springs, links=links, dense=dense)
    M = gather(mesh.first, mesh.unknowns, mesh.blocks(heavy), point=point(terms.mass), dense=dense)
    fixed = np.array(sorted(terms.fixed), dtype=np.intp)
    rigid = _rigid_motions(mesh, cue.length, springs, fixed)
    dashpots = point(terms.dashpot) if terms.dashpot else None
    shift = _shift(cue, section, mesh.sizes)
    return System(mesh, K, M, rigid, cue.length, dashpots, fixed, shift, section, roots, springs, links, terms.ties())


def _shift(cue: Cue, section: Section, sizes: Array) -> float:
    # 4.73^4 EI/(rhoA L^4), the lowest free mode of the uniform rod with the mean stiffness and mass
    stiffness, mass = (float(np.sum(sizes @ part)) for part in (section.EI, section.rhoA))
    return 500 * stiffness / mass / cue.length**4


def suits_dense(unknowns: int, count: int) -> bool:
    """Whether a dense eigenproblem gives the lowest ``count`` modes faster than a sparse one."""
    return unknowns <= DENSE_LIMIT or count > (unknowns / EVEN) ** 3


def gather(
    first: NDArray[np.intp],
    unknowns: int,
    blocks: Sequence[Array] | Array,
    *,
    point: Array,
    links: Links | None = None,
    dense: bool | None = None,
) -> Array | sp.csc_matrix:
    """The matrix summed from element blocks, each (u, u) from its unknown ``first`` on, and point terms."""
    if suits_dense(unknowns, 0) if dense is None else dense:
        whole = np.diag(point)
        for start, block in zip(first, blocks, strict=True):
            here = slice(start, start + len(block))
            whole[here, here] += block
        return whole if links is None or not len(links.stiffness) else whole + _linked(links, unknowns).toarray()
    places = [start + np.indices(block.shape).reshape(2, -1) for start, block in zip(first, blocks, strict=True)]
    values = np.concatenate([block.ravel() for block in blocks])
    whole = scipy.sparse.coo_matrix(
        (values, np.concatenate(places, axis=1)), shape=(unknowns,) * 2
    ) + scipy.sparse.diags(point)
    return scipy.sparse.csc_matrix(whole if links is None else whole + _linked(links, unknowns))


def _linked(links: Links, unknowns: int) -> sp.csc_matrix:
    before, after, k = links
    rows, columns = np.r_[before, after, before, after], np.r_[before, after, after, before]
    return scipy.sparse.csc_matrix((np.r_[k, k, -k, -k], (rows, columns)), shape=(unknowns, unknowns))


def _rigid_motions(mesh: Mesh, length: float, springs: Array, fixed: NDArray[np.intp]) -> Array:
    """The combinations of translation and rotation about the tip that no spring or clamp resists."""
    motions = np.zeros((mesh.unknowns, 2))
    for w, x in ((mesh.first, mesh.nodes[:-1]), (mesh.last, mesh.nodes[1:])):
        motions[w, 0], motions[w, 1] = 1.0, x / length
        motions[w + 1, 1] = 1.0
    resisted = springs != 0
    resisted[fixed] = True
    if not resisted.any():
        return motions
    _, strength, directions = np.linalg.svd(motions[resisted])
    rank = int(np.sum(strength > 1e-12 * strength[0]))
    return motions @ directions[rank:].T


@cache
def _integrals(order: int) -> Array:
    """From values at the Gauss points of an element to their integral from its tip end to each of these, (q, q)."""
    z = 2 * table(order).points - 1
    waves = np.polynomial.legendre.legvander(z, len(z))
    count = 2 * np.arange(len(z)) + 1
    before = np.column_stack([-np.ones(len(z)), waves[:, :-2]])  # the integral of P_n is (P_(n+1) - P_(n-1))/(2 n + 1)
    return np.asarray((waves[:, 1:] - before) / count / 2 @ np.linalg.inv(waves[:, :-1]))
