"""Many cues of one topology at once: arrays of drawings in, arrays of frequencies, end masses and small-offset squirt
out.

The same formulas as for one cue, on stacks: sections by broadcasting, element matrices by one matrix product, dense
eigenproblems by NumPy's stacked LAPACK. Cues are worked through in blocks, so memory does not grow with their number.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from cuefem.beam.basis import element_matrices, gauss, table
from cuefem.beam.tail import tail
from cuefem.cue import Array, Cue, Section, SegmentRows, section_properties
from cuefem.endmass.impulse_response import ImpulseResponse
from cuefem.endmass.sticking_contact import StickLimit
from cuefem.results.solved_design import Stick
from cuefem.scene import Resolution, Scene

# Cues worked at a time: more of them, and their matrices no longer fit the cache (half as fast at 256).
BLOCK = 64
# Gauss points a segment of the static deflection, x^2/EI of a cone: 1e-13 for cones up to 1 : 10.
STATIC_POINTS = 48


@dataclass(frozen=True)
class CueBatch:
    """Cues with the same number of segments, as arrays.

    Parameters
    ----------
    rows : SegmentRows
        The numbers of the drawings in SI units, each an array (cues, segments).
    body_mass : array
        Mass of each cue that is not modelled by segments, kg, (cues,).

    Examples
    --------
    >>> import cuefem as cf
    >>> wood = cf.Material(12.6e9, 0.84e9, 700.0)
    >>> batch = cf.CueBatch.of([cf.Cue((cf.Segment(0.74, d, 0.0215, wood),), 0.42) for d in (0.0115, 0.0135)])
    >>> batch.shaft_mass.round(4)
    array([0.1142, 0.1268])
    """

    rows: SegmentRows
    body_mass: Array

    def __repr__(self) -> str:
        return f"CueBatch({self.rows.length.shape[0]} cues of {self.rows.length.shape[1]} segments)"

    @classmethod
    def of(cls, cues: Sequence[Cue]) -> CueBatch:
        """Stack cues; ValueError if their numbers of segments differ."""
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
        x, w, section = self.sections(*gauss(STATIC_POINTS))
        return np.asarray(1 / (w * (x**2 / section.EI + 1 / section.kGA)).sum(axis=(1, 2)))

    @property
    def mass(self) -> Array:
        """Mass of segments and body, kg, (cues,)."""
        return self.shaft_mass + self.body_mass


@dataclass(frozen=True)
class BatchModes:
    """Flexible bending modes of a batch: frequencies (cues, count), Hz; tip, (cues, count), w(0) of the mass-normalised
    shapes, 1/sqrt(kg); rigid, (cues,), the sum of the two rigid motions' squares of it, 1/kg.

    radiation: (cues, 2, 2), 1/s, of the tail that the last two of the numbers are (`TipModes`), or None.
    """

    frequencies: Array
    tip: Array
    rigid: Array
    radiation: Array | None = None

    @property
    def response(self) -> ImpulseResponse:
        """The impulse responses of the cues: the tail's vectors are coupled by what they radiate."""
        omega, still = 2 * np.pi * self.frequencies, np.zeros((len(self.rigid), 1))
        kept = omega.shape[1] - (0 if self.radiation is None else self.radiation.shape[1])
        rates, weights = [still, 1j * omega[:, :kept]], [self.rigid[:, None], self.tip[:, :kept] ** 2]
        if self.radiation is not None:
            size = self.radiation.shape[1]
            motion = np.zeros((len(omega), 2 * size, 2 * size))
            motion[:, size:, size:], turn = -self.radiation, omega[:, kept:, None] * np.eye(size)
            motion[:, :size, size:], motion[:, size:, :size] = turn, -turn
            across = np.concatenate([np.zeros((len(omega), size)), self.tip[:, kept:]], axis=1)
            own, vectors = np.linalg.eig(motion)
            read = (across[:, None] @ vectors)[:, 0]
            rates.append(own)
            weights.append(read * np.linalg.solve(vectors, across[..., None].astype(complex))[..., 0])
        return ImpulseResponse(np.concatenate(weights, axis=1).astype(complex), np.concatenate(rates, axis=1))


def batch_frequencies(batch: CueBatch, count: int, *, at: Resolution) -> Array:
    """The ``count`` lowest flexible frequencies of every cue, Hz, (cues, count). Cubic in the unknowns of a cue."""
    return np.concatenate([_block_frequencies(block, count, at) for block in batch.blocks()])


def batch_modes(batch: CueBatch, count: int, *, at: Resolution, ended: bool = False) -> BatchModes:
    """The ``count`` lowest flexible modes of every cue at the tip; ended: by the two vectors of `cuefem.beam.tail`."""
    return _joined([_block_modes(block, count, at, ended) for block in batch.blocks()])


def batch_stick(
    batch: CueBatch, scenes: Scene | Sequence[Scene] | StickLimit, *, at: Resolution, ended: bool = False
) -> Stick:
    """Stick end mass and small-offset squirt of many cues.

    Parameters
    ----------
    batch : CueBatch
        The cues.
    scenes : Scene, list of Scene, or StickLimit
        The ball, the tip and the contact time: one scene for all cues, one for each, or a `StickLimit` made with the
        cues' ``mass``, whose parts may be arrays (cues,). The cues of the scenes are not used. Scenes with effects are
        refused; `end_mass` takes them, one cue at a time.
    at : Resolution
        Elements, order and modes of every cue. Take an order of 5/3 of the modes.
    ended : bool
        Whether a tail (`cuefem.beam.tail`) stands for the modes that are left out. Without it the result is the plain
        sum of modes that `end_mass` gives for one cue at a resolution.

    Returns
    -------
    Stick
        Unpacks as ``end_mass, squirt``: kg, and squirt over phi = asin(b/R). A cue without an end mass gets nan, and
        ``reasons`` says why.

    Raises
    ------
    ValueError
        If there are neither one nor as many scenes as cues, or if a scene has effects.

    Examples
    --------
    >>> import cuefem as cf
    >>> wood = cf.Material(12.6e9, 0.84e9, 700.0)
    >>> cues = [cf.Cue((cf.Segment(0.74, d, 0.0215, wood),), 0.42) for d in (0.0115, 0.0135)]
    >>> scene = cf.Scene(cues[0], tip=cf.Tip(contact_time=1e-3))
    >>> end_mass, squirt = cf.batch_stick(cf.CueBatch.of(cues), scene, at=cf.Resolution(1, 30, 18))
    >>> bool(end_mass[0] < end_mass[1])
    True

    Notes
    -----
    Accuracy on 210 random wooden cues at 101 contact times from 0.5 to 3 ms (studies/accuracy/accuracy.md has fewer),
    ``ended``: median, 95 % and largest error of the end mass in 1e-3, of the worst of bare shafts, with ferrule, and
    with leather too:

    - ``Resolution(1, 20, 12)``: 1.9, 15.2, 48.0
    - ``Resolution(1, 30, 18)``: 1.1, 8.6, 31.6
    - ``Resolution(1, 60, 36)``: 0.9, 4.0, 14.4
    - ``Resolution(2, 52, 72)``: 0.7, 2.7, 8.7

    The largest errors occur near the contact time 2L/c, when the front of the shear wave is just back at the tip; only
    more modes reduce them.
    """
    law = _law(batch, scenes)
    parts = []
    for start, block in zip(range(0, len(batch), BLOCK), batch.blocks(), strict=True):
        block_modes = _block_modes(block, at.modes, at, ended)
        parts.append(stick_of(block, block_modes, law[start : start + BLOCK]))
    return Stick(*(np.concatenate(part) for part in zip(*parts, strict=True)))


def stick_of(batch: CueBatch, modes: BatchModes, scenes: Scene | Sequence[Scene] | StickLimit) -> Stick:
    """Stick end mass, kg, and small-offset squirt over phi, from the modes of cues, each in its own scene's place."""
    law = _law(batch, scenes)
    J = law.transverse_impulse(modes.response.held(law.c, law.T), law.T)
    return Stick(law.end_masses(J), law.slope(J))


def _law(batch: CueBatch, scenes: Scene | Sequence[Scene] | StickLimit) -> StickLimit:
    if isinstance(scenes, Scene):
        return StickLimit.of(scenes, batch.mass)
    if isinstance(scenes, StickLimit):
        sizes = {np.size(part) for part in vars(scenes).values() if np.ndim(part)}
    else:
        sizes = {len(scenes)}
    if sizes - {len(batch)}:
        raise ValueError(f"batch_stick takes one contact, or {len(batch)}, one a cue; got {max(sizes - {len(batch)})}")
    return scenes if isinstance(scenes, StickLimit) else StickLimit.of_each(scenes, batch.mass)


def _joined(parts: Sequence[BatchModes]) -> BatchModes:
    radiations = [part.radiation for part in parts if part.radiation is not None]
    frequencies, tip, rigid = (
        np.concatenate([getattr(part, name) for part in parts]) for name in ("frequencies", "tip", "rigid")
    )
    return BatchModes(frequencies, tip, rigid, np.concatenate(radiations) if radiations else None)


class Beams(NamedTuple):
    """Assembled beams of a block: K, M (cues, unknowns, unknowns), theta times the length, and shift, (cues,)."""

    K: Array
    M: Array
    shift: Array


def _beams(batch: CueBatch, at: Resolution) -> Beams:
    order, elements = at.order, at.elements if isinstance(at.elements, int) else max(at.elements)
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
    stiffness, mass = (
        np.einsum("be,beq,q->b", sizes, part, table(order).weights) for part in (section.EI, section.rhoA)
    )
    return Beams(K, M, 500 * stiffness / mass / length**4)


def _standard(beams: Beams) -> tuple[Array, Array]:
    """The inverse form M q = mu (K + shift M) q as a standard problem C y = mu y, q = back y: (C, back)."""
    B = beams.K + beams.shift[:, None, None] * beams.M
    scale = 1 / np.sqrt(np.einsum("bii->bi", B))
    lower = np.linalg.cholesky(B * scale[:, :, None] * scale[:, None, :])
    back = (_inverse(lower) * scale[:, None, :]).transpose(0, 2, 1)
    return back.transpose(0, 2, 1) @ beams.M @ back, back


def _inverse(lower: Array) -> Array:
    """Inverses of lower triangles (cues, n, n), row by row: three times as fast as by NumPy's stacked LU."""
    inverse = np.zeros_like(lower)
    over = 1 / np.einsum("bii->bi", lower)
    for i in range(lower.shape[1]):
        inverse[:, i, i] = over[:, i]
        if i:
            inverse[:, i, :i] = -over[:, i, None] * (lower[:, i, None, :i] @ inverse[:, :i, :i])[:, 0]
    return inverse


def _block_frequencies(batch: CueBatch, count: int, at: Resolution) -> Array:
    beams = _beams(batch, at)
    C, _ = _standard(beams)
    mu = np.linalg.eigvalsh(C)[:, ::-1][:, 2 : 2 + count]  # the first two are the rigid motions
    return np.asarray(np.sqrt(1 / mu - beams.shift[:, None]) / (2 * np.pi))


def _block_modes(batch: CueBatch, count: int, at: Resolution, ended: bool) -> BatchModes:
    beams = _beams(batch, at)
    C, back = _standard(beams)
    mu, y = (each[..., :-2][..., ::-1] for each in np.linalg.eigh(C))  # the last two are the rigid motions
    felt = (back[:, :1] @ y)[:, 0]
    omega, tip = np.sqrt(1 / mu[:, :count] - beams.shift[:, None]), np.abs(felt[:, :count] / np.sqrt(mu[:, :count]))
    # the rigid part: inverse of the 2 x 2 mass of translation and rotation about the tip, its translation entry
    rigid, radiation = _rigid_tip(batch), None
    if ended:
        rest = tail(mu[:, count:], felt[:, count:, None], shift=beams.shift, highest=omega[:, -1])
        across = (felt[:, None, count:] @ rest.mix)[:, 0]
        signs = np.where(across < 0, -1.0, 1.0)
        omega, tip = np.concatenate([omega, rest.omega], axis=1), np.concatenate([tip, abs(across)], axis=1)
        radiation = signs[:, :, None] * rest.radiation * signs[:, None]
    return BatchModes(omega / (2 * np.pi), tip, rigid, radiation)


def _rigid_tip(batch: CueBatch) -> Array:
    """1/m + xbar^2/I: the rigid body's inverse mass across the cue at the tip, 1/kg, (cues,)."""
    mass, moment, inertia = batch._moments()
    return np.asarray(1 / mass + (moment / mass) ** 2 / inertia)
