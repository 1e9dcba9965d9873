"""The mesh of a cue."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Protocol

import numpy as np
from numpy.typing import NDArray

from cuefem.beam.mode_count import MAX_PHASE, mode_phases, orders_for
from cuefem.cue import Array, Cue
from cuefem.quantity.fields import MAX_DOF, check_count

if TYPE_CHECKING:
    from cuefem.beam.point_terms import PointTerms

# Positions count as one if they are closer than this fraction of the cue's length.
POSITION_TOLERANCE = 1e-9
# An element continues across the end of a segment if the section there differs from the mean of its neighbourhood by
# less than this, relative. A smooth profile cut into many segments then needs few elements.
JUMP_TOLERANCE = 2e-3
MIN_STEPS, MAX_STEPS = 20, 1_000_000  # in a head-on contact time


class BeamEffect(Protocol):
    """Interface of an effect that acts on the cue."""

    @property
    def positions(self) -> tuple[float, ...]:
        """Positions that must be mesh nodes, m from the tip."""

    @property
    def joint_positions(self) -> tuple[float, ...]:
        """Positions where deflection and rotation may jump, m from the tip."""

    def check_on(self, cue: Cue, name: str) -> None:
        """ValueError, naming the effect ``name``, unless all its positions lie on the cue."""

    def add_to(self, terms: PointTerms) -> None:
        """Add the effect's point terms."""


@dataclass(frozen=True)
class Resolution:
    """Resolution of a finite-element cue and of its contact.

    Parameters
    ----------
    elements
        Number of elements in each smooth piece of the cue.
    order
        Polynomial degree p of the rotation; the deflection has degree p + 1.
    modes
        Number of flexible bending modes; the rigid-body modes are always included.
    steps
        Steps of the contact in a head-on contact time, 20 to 1,000,000; by default 400, with a
        `LeatherTip` 200.

    Raises
    ------
    TypeError
        If a number is not whole.
    ValueError
        If a number is out of bounds.

    Examples
    --------
    >>> import cuefem as cf
    >>> fine = cf.Resolution(elements=4, order=16, modes=60)
    """

    elements: int
    order: int
    modes: int
    steps: int | None = None

    def __post_init__(self) -> None:
        if self.steps is not None:
            check_count("Resolution.steps", self.steps, MIN_STEPS, MAX_STEPS)
        for name in ("elements", "order", "modes"):
            check_count(f"Resolution.{name}", getattr(self, name), 1)


@dataclass(frozen=True)
class Mesh:
    """Elements of a cue.

    nodes: (elements + 1,) m. orders: (elements,) polynomial degrees of the rotation. first: (elements,) each element's
    first degree of freedom. n_dof: number of degrees of freedom. Neighbouring elements share the two of their node,
    unless a joint divides the node.
    """

    nodes: Array
    orders: NDArray[np.intp]
    first: NDArray[np.intp]
    n_dof: int

    def node(self, x: float) -> int:
        """Index of the node at position ``x``."""
        return int(np.argmin(np.abs(self.nodes - x)))

    @property
    def last(self) -> NDArray[np.intp]:
        """Degree of freedom of the deflection at each element's butt end: (elements,)."""
        return self.first + 2 * self.orders + 1

    def dofs_at(self, node: int) -> tuple[int, int]:
        """Degrees of freedom (w, theta) of a node; at a joint, those of the butt side."""
        first = int(self.first[node]) if node < len(self.first) else self.n_dof - 2
        return first, first + 1

    def dofs_before(self, node: int) -> tuple[int, int]:
        """Degrees of freedom (w, theta) on the tip side of a node inside the cue."""
        last = int(self.last[node - 1])
        return last, last + 1


def mesh_cue(
    cue: Cue, at: int | Resolution, effects: Sequence[BeamEffect] = (), positions: Sequence[float] = ()
) -> Mesh:
    """Mesh a cue, with nodes at ``positions``, m from the tip, and at the positions of effects.

    at: how many of the lowest flexible modes the mesh must resolve; or the user's resolution, with a node at the end of
    every segment. A joint doubles its node.
    """
    for effect in effects:
        effect.check_on(cue, type(effect).__name__)
    required = np.unique([cue.leather_height, *positions, *(x for effect in effects for x in effect.positions)])
    for x in required:
        if not 0 <= x <= cue.length * (1 + POSITION_TOLERANCE):
            raise ValueError(f"an effect's position must be in [0, {cue.length}] m, on the cue; got {x}")
    if isinstance(at, int):
        nodes, orders = _equal_phases(cue, mode_phases(cue, at), _snap(cue, required))
    else:
        ends = np.unique(np.append(cue.nodes, _snap(cue, required)))
        pieces = len(ends) - 1
        check_mesh_size(pieces * at.elements * (2 * at.order + 1), f"{pieces} pieces")
        nodes = _subdivide(ends, np.full(pieces, at.elements))
        orders = np.full(pieces * at.elements, at.order)
    return _number_dofs(nodes, orders, [x for effect in effects for x in effect.joint_positions])


def mesh_for_phases(cue: Cue, phases: Array, positions: Sequence[float]) -> Mesh:
    """Mesh a cue for waves of ``phases`` rad over its segments, nodes at ``positions``, and no joint."""
    return _number_dofs(*_equal_phases(cue, phases, _snap(cue, np.array([cue.leather_height, *positions]))), [])


def _snap(cue: Cue, positions: Array) -> Array:
    """The positions, moved to the end of a segment where they coincide with it."""
    nearest = cue.nodes[np.argmin(np.abs(positions[:, None] - cue.nodes), axis=1)]
    return np.where(np.abs(positions - nearest) > POSITION_TOLERANCE * cue.length, positions, nearest)


def _number_dofs(nodes: Array, orders: NDArray[np.intp], joint_positions: Sequence[float]) -> Mesh:
    """The mesh, its degrees of freedom numbered from the tip; joint nodes have two of each kind."""
    strides = 2 * orders + 1
    first = np.cumsum(strides) - strides
    for node in {int(np.argmin(np.abs(nodes - x))) for x in joint_positions}:
        first[node:] += 2
    n_dof = int(first[-1] + strides[-1]) + 2
    check_mesh_size(n_dof, f"{len(orders)} elements")
    return Mesh(nodes, orders, first, n_dof)


def _equal_phases(cue: Cue, phases: Array, positions: Array) -> tuple[Array, NDArray[np.intp]]:
    """Nodes and orders for waves of ``phases`` rad over the segments: elements of equal phase."""
    check_mesh_size(2 * phases.sum(), f"waves of {phases.sum():.6g} rad")
    sides = cue.section_in(np.arange(len(phases))[:, None], np.diff(cue.nodes)[:, None] * np.array([0.0, 1.0]))
    logs = np.log([sides.EA, sides.EI, sides.kGA, sides.rhoA])
    ends = _required_nodes(cue, positions, logs, np.diff(cue.nodes) / phases)
    phase_at, log_taper = (np.append(0.0, np.cumsum(values)) for values in (phases, np.abs(np.diff(logs[0])[:, 0])))
    end_phases = np.interp(ends, cue.nodes, phase_at)
    counts = np.ceil(np.diff(end_phases) / MAX_PHASE).astype(int)
    nodes = np.interp(_subdivide(end_phases, counts), phase_at, cue.nodes)
    nodes[np.append(0, np.cumsum(counts))] = ends
    phase, taper = (np.diff(np.interp(nodes, cue.nodes, values)) for values in (phase_at, log_taper))
    return nodes, orders_for(phase, np.exp(taper))


def _required_nodes(cue: Cue, positions: Array, logs: Array, lengths: Array) -> Array:
    """Positions of nodes: the ends of the cue, ``positions``, and the ends of segments that an element cannot cross.

    logs: (kinds, segments, 2) of the section at both ends of every segment. lengths: (segments,) the length that the
    shortest waves resolve, m. The end of a segment is no node if the section does not jump there and is the mean of the
    sections at equal distances before and behind, within reach and no further than the next nodes.
    """
    profile, logs = np.repeat(cue.nodes, 2)[1:-1], logs.reshape(len(logs), -1)
    jumps = np.abs(np.diff(logs)[:, 1::2]).max(axis=0) > 2 * JUMP_TOLERANCE
    fixed = np.unique(np.concatenate([[0.0, cue.length], positions, cue.nodes[1:-1][jumps]]))
    ends, last = fixed.tolist(), 0.0
    for i in np.flatnonzero(~jumps) + 1:
        x, next_node = cue.nodes[i], np.searchsorted(fixed, cue.nodes[i])
        last = max(last, fixed[next_node - 1])
        distance = min(lengths[i - 1], lengths[i], x - last, fixed[next_node] - x) / 2
        sides = np.array([x - distance, x + distance])
        k = np.searchsorted(profile, sides) // 2 * 2  # the tip side of the segment that holds it
        fraction = (sides - profile[k]) / (profile[k + 1] - profile[k])
        mean = (logs[:, k] + fraction * (logs[:, k + 1] - logs[:, k])).mean(axis=1)
        if np.abs(logs[:, 2 * i - 1 : 2 * i + 1] - mean[:, None]).max() > JUMP_TOLERANCE:
            ends.append(x)
            last = x
    return np.unique(ends)


def _subdivide(ends: Array, counts: NDArray[np.intp]) -> Array:
    """``counts`` equal steps between each two of the ``ends``."""
    steps = [a + (b - a) * np.arange(n) / n for a, b, n in zip(ends[:-1], ends[1:], counts, strict=True)]
    return np.append(np.concatenate(steps), ends[-1])


def check_mesh_size(n_dof: float, item: str) -> None:
    """ValueError if a mesh has more degrees of freedom than can be solved in reasonable time and memory."""
    if n_dof > MAX_DOF:
        remedy = "request fewer modes or elements, draw fewer segments, or check sizes and materials"
        limit = f"the mesh must have at most {MAX_DOF} degrees of freedom"
        raise ValueError(f"{limit}; got {n_dof:.6g}, of {item}: {remedy}")
