"""Many cues of one topology at once: arrays of drawings in, arrays of frequencies, end masses and small-offset squirt
out.

The same formulas as for one cue, on stacks: sections by broadcasting, element matrices by one matrix product, dense
eigenproblems by NumPy's stacked LAPACK. Cues are worked through in blocks, so memory does not grow with their number.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cache

import numpy as np

from cuefem.beam import element_matrices, table
from cuefem.cue import Array, Cue, Section, SegmentRows, section_properties
from cuefem.scene import Resolution, Scene
from cuefem.transverse import StickLimit

# Cues worked at a time: the element and eigenvector stacks of a block stay within some tens of megabytes.
BLOCK = 256
# Gauss points a segment of the static deflection, x^2/EI of a cone: 1e-13 for cones up to 1 : 10.
STATIC_POINTS = 48


@dataclass(frozen=True)
class CueBatch:
    """Cues with the same number of segments, as arrays.

    rows: `cuefem.cue.SegmentRows` of arrays (cues, segments), one row of numbers a segment. body_mass: (cues,), kg.
    """

    rows: SegmentRows
    body_mass: Array

    @classmethod
    def of(cls, cues: Sequence[Cue]) -> CueBatch:
        """Stack cues; ValueError where their numbers of segments differ."""
        counts = sorted({len(cue.segments) for cue in cues})
        if len(counts) != 1:
            raise ValueError(f"CueBatch takes cues of one topology; got {counts} segments")
        constants = np.array([[segment.constants for segment in cue.segments] for cue in cues])
        return cls(SegmentRows(*np.moveaxis(constants, -1, 0)), np.array([cue.body_mass for cue in cues]))

    def __len__(self) -> int:
        return len(self.body_mass)

    def __getitem__(self, part: slice) -> CueBatch:
        return CueBatch(SegmentRows(*(row[part] for row in self.rows)), self.body_mass[part])

    def blocks(self) -> Iterator[CueBatch]:
        """The batch in pieces of `BLOCK` cues."""
        for start in range(0, len(self), BLOCK):
            yield self[start : start + BLOCK]

    def sections(self, points: Array, weights: Array) -> tuple[Array, Array, Section]:
        """(x, m from the tip; its weight, m; section properties) at ``points`` in [0, 1] of every segment.

        Arrays (cues, segments, points).
        """
        starts = np.cumsum(self.rows.length, axis=1) - self.rows.length
        s = self.rows.length[..., None] * points
        section = section_properties(SegmentRows(*(row[..., None] for row in self.rows)), s)
        return starts[..., None] + s, weights * self.rows.length[..., None], section

    @property
    def shaft_mass(self) -> Array:
        """Mass of the segments, kg, (cues,)."""
        return self._moments()[0]

    @property
    def balance_point(self) -> Array:
        """Centre of mass of the segments, m from the tip, (cues,)."""
        mass, moment, _ = self._moments()
        return moment / mass

    def _moments(self) -> tuple[Array, Array, Array]:
        """Mass, kg, its moment about the tip, kg m, and inertia about the centre of mass, kg m2: exact for cones."""
        x, w, section = self.sections(table(4).points, table(4).weights)
        mass, moment = (w * section.rhoA).sum(axis=(1, 2)), (w * section.rhoA * x).sum(axis=(1, 2))
        across = section.rhoA * (x - (moment / mass)[:, None, None]) ** 2 + section.rhoI
        return mass, moment, (w * across).sum(axis=(1, 2))

    @property
    def tip_stiffness(self) -> Array:
        """Static tip stiffness, N/m, (cues,): force across the tip over its deflection, the butt end clamped.

        The shaft is held at the end of its last segment, the joint. Statically determinate, so exact for Timoshenko's
        beam: 1/k = integral of x^2/EI + 1/kGA; by quadrature, see `STATIC_POINTS`.
        """
        x, w, section = self.sections(*_gauss(STATIC_POINTS))
        return np.asarray(1 / (w * (x**2 / section.EI + 1 / section.kGA)).sum(axis=(1, 2)))

    @property
    def mass(self) -> Array:
        """Mass of segments and body, kg, (cues,)."""
        return self.shaft_mass + self.body_mass


@dataclass(frozen=True)
class BatchModes:
    """Flexible bending modes of a batch: frequencies (cues, count), Hz; tip, (cues, count), w(0) of the mass-normalised
    shapes, 1/sqrt(kg); rigid, (cues,), the sum of the two rigid motions' squares of it, 1/kg."""

    frequencies: Array
    tip: Array
    rigid: Array


def batch_frequencies(batch: CueBatch, count: int, *, at: Resolution) -> Array:
    """The ``count`` lowest flexible frequencies of every cue, Hz, (cues, count). Cubic in the unknowns of a cue."""
    return np.concatenate([_block_frequencies(block, count, at) for block in batch.blocks()])


def batch_modes(batch: CueBatch, count: int, *, at: Resolution) -> BatchModes:
    """The ``count`` lowest flexible modes of every cue at the tip."""
    parts = [_block_modes(block, count, at) for block in batch.blocks()]
    return BatchModes(*(np.concatenate([getattr(p, name) for p in parts]) for name in ("frequencies", "tip", "rigid")))


def batch_stick(batch: CueBatch, scenes: Scene | Sequence[Scene], *, at: Resolution) -> tuple[Array, Array]:
    """(stick end mass, kg; small-offset squirt over phi) of every cue in its scene's place: two arrays (cues,).

    scenes: one for every cue, or one for all. They give ball, tip and contact time; their cues are not used, and
    effects are not taken (one cue at a time has them).
    """
    places = [scenes] * len(batch) if isinstance(scenes, Scene) else scenes
    parts = []
    for start, block in zip(range(0, len(batch), BLOCK), batch.blocks(), strict=True):
        parts.append(stick_of(block, _block_modes(block, at.modes, at), places[start : start + BLOCK]))
    end_mass, slope = (np.concatenate(part) for part in zip(*parts, strict=True))
    return end_mass, slope


@dataclass(frozen=True)
class Beams:
    """Assembled beams of a block: K, M (cues, unknowns, unknowns), theta times the length; see `cuefem.beam.System`.

    sizes: (cues, elements), m. length, shift: (cues,). section: arrays (cues, elements, q).
    """

    K: Array
    M: Array
    length: Array
    shift: Array
    sizes: Array
    section: Section
    order: int

    def strains(self, vectors: Array) -> Array:
        """Strains of ``vectors`` (cues, unknowns, k) times roots of stiffness: (cues, rows, k); K = S'S of all."""
        t, stride, elements = table(self.order), 2 * self.order + 1, self.sizes.shape[1]
        own = vectors[:, stride * np.arange(elements)[:, None] + np.arange(len(t.w))]  # (cues, elements, unknowns, k)
        h, length = self.sizes[..., None, None], self.length[:, None, None, None]
        bent, sheared = t.dtheta.T @ own / (h * length), t.dw.T @ own / h - t.theta.T @ own / length
        roots = (np.sqrt(part * t.weights * self.sizes[..., None]) for part in (self.section.EI, self.section.kGA))
        both = [part * root[..., None] for part, root in zip((bent, sheared), roots, strict=True)]
        return np.concatenate([part.reshape(len(vectors), -1, vectors.shape[2]) for part in both], axis=1)


def _beams(batch: CueBatch, at: Resolution) -> Beams:
    order, elements = at.order, at.elements
    pieces = batch.rows.length.shape[1]
    sizes = np.repeat(batch.rows.length / elements, elements, axis=1)
    steps = np.tile(np.arange(elements), pieces)[:, None] + table(order).points
    rows = SegmentRows(*(np.repeat(row, elements, axis=1)[..., None] for row in batch.rows))
    section = Section(*section_properties(rows, sizes[..., None] * steps))
    length = batch.rows.length.sum(axis=1)
    stiff, heavy = element_matrices(section, sizes, length[:, None, None], order)
    stride, count = 2 * order + 1, elements * pieces
    K = np.zeros((len(batch), stride * count + 2, stride * count + 2))
    M = np.zeros_like(K)
    for e in range(count):
        here = slice(e * stride, e * stride + stride + 2)
        K[:, here, here] += stiff[:, e]
        M[:, here, here] += heavy[:, e]
    stiffness, mass = (np.einsum("be,be->b", sizes, part.mean(axis=2)) for part in (section.EI, section.rhoA))
    return Beams(K, M, length, 500 * stiffness / mass / length**4, sizes, section, order)


@cache
def _gauss(count: int) -> tuple[Array, Array]:
    """Points and weights on [0, 1]."""
    points, weights = np.polynomial.legendre.leggauss(count)
    return (points + 1) / 2, weights / 2


def _standard(beams: Beams) -> tuple[Array, Array]:
    """The inverse form M q = mu (K + shift M) q as a standard problem C y = mu y, q = back y: (C, back)."""
    return _reduced(beams.K + beams.shift[:, None, None] * beams.M, beams.M)


def _reduced(B: Array, A: Array) -> tuple[Array, Array]:
    """A q = mu B q, B positive definite, as C y = mu y with q = back y and q' B q = y' y: (C, back)."""
    scale = 1 / np.sqrt(np.einsum("bii->bi", B))
    lower = np.linalg.cholesky(B * scale[:, :, None] * scale[:, None, :])
    back = (_inverse(lower) * scale[:, None, :]).transpose(0, 2, 1)
    return back.transpose(0, 2, 1) @ A @ back, back


def _inverse(lower: Array) -> Array:
    """Inverses of lower triangles (cues, n, n), row by row: three times as fast as by NumPy's stacked LU."""
    found = np.zeros_like(lower)
    over = 1 / np.einsum("bii->bi", lower)
    for i in range(lower.shape[1]):
        found[:, i, i] = over[:, i]
        if i:
            found[:, i, :i] = -over[:, i, None] * (lower[:, i, None, :i] @ found[:, :i, :i])[:, 0]
    return found


def _block_frequencies(batch: CueBatch, count: int, at: Resolution) -> Array:
    beams = _beams(batch, at)
    C, _ = _standard(beams)
    mu = np.linalg.eigvalsh(C)[:, ::-1][:, 2 : 2 + count]  # the first two are the rigid motions
    return np.asarray(np.sqrt(1 / mu - beams.shift[:, None]) / (2 * np.pi))


def _block_modes(batch: CueBatch, count: int, at: Resolution) -> BatchModes:
    beams = _beams(batch, at)
    C, back = _standard(beams)
    mu, y = np.linalg.eigh(C)
    chosen = slice(-3, -3 - count, -1)  # the last two are the rigid motions
    vectors = back @ (y[:, :, chosen] / np.sqrt(mu[:, None, chosen]))
    omega, mix = _polished(beams, vectors)
    tip = np.einsum("bj,bjk->bk", vectors[:, 0], mix)
    # the rigid part: inverse of the 2 x 2 mass of translation and rotation about the tip, its translation entry
    return BatchModes(omega / (2 * np.pi), np.abs(tip), _rigid_tip(batch))


def _polished(beams: Beams, vectors: Array) -> tuple[Array, Array]:
    """(omega, combinations of the vectors) of one Rayleigh-Ritz step with energies from strains: `cuefem.modes`."""
    strains = beams.strains(vectors)
    energy = strains.transpose(0, 2, 1) @ strains
    C, back = _reduced(energy, vectors.transpose(0, 2, 1) @ beams.M @ vectors)
    inverse, y = np.linalg.eigh(C)
    return 1 / np.sqrt(inverse[:, ::-1]), back @ (y / np.sqrt(inverse)[:, None])[:, :, ::-1]


def _rigid_tip(batch: CueBatch) -> Array:
    """1/m + xbar^2/I: the rigid body's inverse mass across the cue at the tip, 1/kg, (cues,)."""
    mass, moment, inertia = batch._moments()
    return np.asarray(1 / mass + (moment / mass) ** 2 / inertia)


def stick_of(batch: CueBatch, found: BatchModes, scenes: Sequence[Scene]) -> tuple[Array, Array]:
    """(stick end mass, kg; small-offset squirt over phi) from the modes of cues, each in its own scene's place."""
    end_mass, slope = np.empty(len(batch)), np.empty(len(batch))
    axial_mass, omega = batch.mass, 2 * np.pi * found.frequencies
    for same in _alike(scenes):
        limit = StickLimit.of(scenes[same[0]], axial_mass=axial_mass[same])
        J = limit.transverse_impulse(omega[same], found.tip[same], found.rigid[same])
        end_mass[same], slope[same] = limit.end_mass(J), limit.slope(J)
    return end_mass, slope


def _alike(scenes: Sequence[Scene]) -> list[list[int]]:
    """Indices of scenes that share one law of contact, of which `StickLimit` takes a stack of cues."""
    groups: dict[tuple[object, ...], list[int]] = {}
    for i, scene in enumerate(scenes):
        law = (scene.ball.mass, scene.ball.inertia, scene.tip.restitution, scene.contact_time)
        groups.setdefault(law, []).append(i)
    return list(groups.values())
