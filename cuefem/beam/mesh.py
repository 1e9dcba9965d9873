"""The mesh of a cue, and the point terms that effects add at its nodes."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple, Protocol

import numpy as np
from numpy.typing import NDArray

from cuefem.cue import Array, Cue
from cuefem.quantity.fields import MOST_UNKNOWNS

# Two points count as one if they are closer than this fraction of the cue's length.
NEAR = 1e-9


class ActsOnCue(Protocol):
    """What an effect that acts on the cue must offer to the beam."""

    @property
    def positions(self) -> tuple[float, ...]:
        """Positions that must be mesh nodes, m from the tip."""

    @property
    def splits(self) -> tuple[float, ...]:
        """Positions where deflection and rotation may jump, m from the tip."""

    def check_on(self, cue: Cue, name: str) -> None:
        """ValueError, naming the effect ``name``, unless all its positions lie on the cue."""

    def add_to(self, terms: Terms) -> None:
        """Add the effect's point terms."""


@dataclass(frozen=True)
class ForcedNode:
    """A place on the cue, m from the tip, that must be a node of the mesh, because a force acts there."""

    position: float

    @property
    def positions(self) -> tuple[float, ...]:
        """The place."""
        return (self.position,)

    @property
    def splits(self) -> tuple[float, ...]:
        """None: the beam goes on through it."""
        return ()

    def check_on(self, cue: Cue, name: str) -> None:
        """Nothing: `mesh_cue` refuses places off the cue."""

    def add_to(self, terms: Terms) -> None:
        """Nothing is there but the node."""


@dataclass(frozen=True)
class Mesh:
    """Elements of a cue: a node at every end of a segment and at every position an effect asks for.

    nodes: (elements + 1,) m. piece: (elements,) index of the segment an element lies in. offset: (elements,) m from
    that segment's tip end to the element's. first: (elements,) the element's first unknown. unknowns: their number.
    orders: (elements,) the polynomial orders; order: the highest of them, by which all are tabulated. Neighbouring
    elements share the two unknowns of their node, unless a joint splits the node.
    """

    nodes: Array
    piece: NDArray[np.intp]
    offset: Array
    first: NDArray[np.intp]
    unknowns: int
    orders: NDArray[np.intp]

    @cached_property
    def order(self) -> int:
        """The highest order of an element."""
        return int(self.orders.max())

    @cached_property
    def sizes(self) -> Array:
        """Lengths of the elements, m."""
        return np.diff(self.nodes)

    def node(self, x: float) -> int:
        """Index of the node at position ``x``."""
        return int(np.argmin(np.abs(self.nodes - x)))

    @property
    def last(self) -> NDArray[np.intp]:
        """The deflection of every element's butt end, its last unknown but one: (elements,)."""
        return self.first + 2 * self.orders + 1

    @cached_property
    def _columns(self) -> list[NDArray[np.intp]]:
        """For each element, which of the unknowns of the highest order it has."""
        p = self.order
        orders = self.orders.tolist()
        columns = {q: np.r_[0, 1, 2 : 2 + q, 2 + p : 1 + p + q, 2 * p + 1, 2 * p + 2] for q in set(orders)}
        return [columns[q] for q in orders]

    def own(self, vectors: Array) -> Array:
        """The elements' own unknowns of the highest order, (elements, u, k), of ``vectors`` (unknowns, k)."""
        if np.all(self.orders == self.order):
            return vectors[self.first[:, None] + np.arange(2 * self.order + 3)]
        spread = np.zeros((len(self.orders), 2 * self.order + 3, vectors.shape[1]))
        for each, start, columns in zip(spread, self.first, self._columns, strict=True):
            each[columns] = vectors[start : start + len(columns)]
        return spread

    def blocks(self, roots: Array) -> Sequence[Array]:
        """roots' roots of every element, exactly symmetric, in the unknowns that it has; roots: (elements, rows, u)."""
        if np.all(self.orders == self.order):
            squared: Array = roots.swapaxes(-1, -2) @ roots
            return list(squared)
        parts = (each[:, columns] for each, columns in zip(roots, self._columns, strict=True))
        return [part.T @ part for part in parts]

    def unknowns_at(self, node: int) -> tuple[int, int]:
        """Unknowns (w, theta) of a node; if a joint splits it, those of the butt side."""
        first = int(self.first[node]) if node < len(self.first) else self.unknowns - 2
        return first, first + 1

    def unknowns_before(self, node: int) -> tuple[int, int]:
        """Unknowns (w, theta) of the tip side of a node inside the cue."""
        last = int(self.last[node - 1])
        return last, last + 1


def mesh_cue(
    cue: Cue,
    *,
    elements: int | tuple[int, ...],
    order: int | tuple[int, ...],
    positions: tuple[float, ...] = (),
    splits: tuple[float, ...] = (),
) -> Mesh:
    """Mesh a cue: a node at every end of a segment and at ``positions``, split at ``splits``.

    elements: of every smooth piece between such nodes; or one number a segment, which are shared out over its smooth
    pieces by their lengths, at least one to each. order: of every element; or one number a segment.
    """
    breaks = list(cue.nodes)
    for x in sorted(set(positions)):
        if not 0 <= x <= cue.length * (1 + NEAR):
            raise ValueError(f"an effect's position must be in [0, {cue.length}] m, on the cue; got {x}")
        if np.min(np.abs(np.array(breaks) - x)) > NEAR * cue.length:  # else the two points are one
            breaks.append(x)
    ends = np.sort(np.array(breaks))
    counts = _elements_between(cue, ends, elements)
    check_work(sum(counts.tolist()) * (2 * int(np.max(order)) + 1), f"{len(counts)} pieces")
    shares = zip(ends, np.diff(ends), counts, strict=False)
    nodes = np.append(np.concatenate([start + span * (np.arange(n) / n) for start, span, n in shares]), ends[-1])
    middles = (nodes[:-1] + nodes[1:]) / 2
    piece = np.searchsorted(cue.nodes, middles, side="right") - 1
    orders = np.broadcast_to(order, len(cue.segments))[piece]
    strides = 2 * orders + 1
    first = np.cumsum(strides) - strides
    for node in {int(np.argmin(np.abs(nodes - x))) for x in splits}:
        first[node:] += 2
    return Mesh(nodes, piece, nodes[:-1] - cue.nodes[piece], first, int(first[-1] + strides[-1]) + 2, orders)


def check_work(unknowns: float, what: str) -> None:
    """ValueError if a mesh would have more unknowns than can be solved in a reasonable time and memory."""
    if unknowns > MOST_UNKNOWNS:
        asked = "ask for fewer modes or elements, draw fewer segments, or check sizes and materials"
        raise ValueError(f"the mesh must have at most {MOST_UNKNOWNS} unknowns; got {unknowns:.6g}, of {what}: {asked}")


def _elements_between(cue: Cue, ends: Array, elements: int | tuple[int, ...]) -> NDArray[np.intp]:
    """Number of elements in each smooth piece between ``ends``: (len(ends) - 1,)."""
    if not isinstance(elements, tuple):
        return np.full(len(ends) - 1, elements)
    if len(elements) != len(cue.segments):
        raise ValueError(
            f"Resolution.elements must be one number or {len(cue.segments)} of them, one a segment; got {len(elements)}"
        )
    segment = np.searchsorted(cue.nodes, (ends[:-1] + ends[1:]) / 2, side="right") - 1
    part = np.diff(ends) / np.diff(cue.nodes)[segment]
    return np.maximum(np.ceil(np.array(elements)[segment] * part - NEAR), 1).astype(int)


class Links(NamedTuple):
    """Springs between pairs of unknowns: (n,) the two unknowns, (n,) stiffness. Zero length: a joint's two sides."""

    before: NDArray[np.intp]
    after: NDArray[np.intp]
    stiffness: Array


class Terms:
    """The point terms that effects add: springs, dashpots, masses and clamps at nodes, compliances between two sides.

    At a joint the butt side's unknowns are the node's.
    """

    def __init__(self, mesh: Mesh, cue: Cue) -> None:
        self.mesh, self.cue = mesh, cue
        self.stiffness: dict[int, float] = {}
        self.dashpot: dict[int, float] = {}
        self.mass: dict[int, float] = {}
        self.compliance: dict[tuple[int, int], float] = {}
        self.fixed: set[int] = set()

    def add(self, x: float, kind: str, w: float, theta: float) -> None:
        """Add diagonal terms at position ``x``: ``w`` for the deflection, ``theta`` for the rotation; inf clamps."""
        terms: dict[int, float] = getattr(self, kind)
        for unknown, value in zip(self.mesh.unknowns_at(self.mesh.node(x)), (w, theta), strict=True):
            if np.isinf(value):
                if unknown in self.fixed:
                    raise ValueError(f"a clamp must be the only one at its place; got two at {x} m")
                self.fixed.add(unknown)
            elif value:
                terms[unknown] = terms.get(unknown, 0.0) + value

    def join(self, x: float, w: float, theta: float) -> None:
        """Let deflection and rotation jump at position ``x``, with compliances ``w`` and ``theta``; zero: no jump."""
        node = self.mesh.node(x)
        pairs = zip(self.mesh.unknowns_before(node), self.mesh.unknowns_at(node), strict=True)
        for pair, value in zip(pairs, (w, theta), strict=True):
            self.compliance[pair] = self.compliance.get(pair, 0.0) + value

    def links(self, scale: Array) -> Links:
        """The springs of the joints, in scaled unknowns."""
        soft = {pair: 1 / value for pair, value in self.compliance.items() if value > 0}
        before, after = np.array(list(soft), dtype=np.intp).reshape(-1, 2).T
        return Links(before, after, np.array(list(soft.values())) * scale[before])

    def ties(self) -> NDArray[np.intp]:
        """Pairs of unknowns (tip side, butt side) that a joint keeps equal: (n, 2)."""
        stiff = [pair for pair, value in self.compliance.items() if value == 0]
        return np.array(stiff, dtype=np.intp).reshape(-1, 2)
