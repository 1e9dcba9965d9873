"""The mesh of a cue and its effects: nodes where the section jumps, elements of equal phase."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from cuefem.beam.mesh import Mesh, Resolution
from cuefem.beam.mode_count import MAX_PHASE, mode_phases, orders_for, segment_sections
from cuefem.beam.point_terms import BeamEffect
from cuefem.cue import POSITION_TOLERANCE, Array, Cue
from cuefem.quantity.fields import MAX_DOF

# An element continues across the end of a segment if the section there differs from the mean of its neighbourhood by
# less than this, relative. A smooth profile cut into many segments then needs few elements.
JUMP_TOLERANCE = 2e-3


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
    if isinstance(at, int):
        phases = mode_phases(cue, at)
        nodes, orders = _equal_phases(cue, phases, _required_nodes(cue, phases, _snap(cue, required)))
    else:
        ends = np.unique(np.append(cue.nodes, _snap(cue, required)))
        pieces = len(ends) - 1
        check_mesh_size(pieces * at.elements * (2 * at.order + 1), f"{pieces} pieces")
        nodes = _subdivide(ends, np.full(pieces, at.elements))
        orders = np.full(pieces * at.elements, at.order)
    return _number_dofs(nodes, orders, [x for effect in effects for x in effect.joint_positions])


def mesh_for_phases(cue: Cue, phases: Array, nodes: Array) -> Mesh:
    """Mesh a cue for waves of ``phases`` rad over its segments, ``nodes``, m from the tip, among others, no joint."""
    return _number_dofs(*_equal_phases(cue, phases, nodes), [])


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


def _equal_phases(cue: Cue, phases: Array, ends: Array) -> tuple[Array, NDArray[np.intp]]:
    """Nodes, ``ends`` among them, and orders for waves of ``phases`` rad over the segments: elements of equal phase."""
    check_mesh_size(2 * phases.sum(), "the shortest waves")
    tip_ends, butt_ends = segment_sections(cue).EA.T[[0, -1]]
    phase_at, log_taper = np.zeros((2, len(cue.nodes)))
    phase_at[1:], log_taper[1:] = np.cumsum(phases), np.cumsum(np.abs(np.log(butt_ends / tip_ends)))
    end_phases = np.interp(ends, cue.nodes, phase_at)
    counts = np.ceil(np.diff(end_phases) / MAX_PHASE).astype(int)
    nodes = np.interp(_subdivide(end_phases, counts), phase_at, cue.nodes)
    nodes[np.append(0, np.cumsum(counts))] = ends
    phase, taper = (np.diff(np.interp(nodes, cue.nodes, values)) for values in (phase_at, log_taper))
    return nodes, orders_for(phase, np.exp(taper))


def _required_nodes(cue: Cue, phases: Array, positions: Array) -> Array:
    """Positions of nodes: the ends of the cue, ``positions``, and the ends of segments that an element cannot cross.

    phases: (segments,) rad, of the shortest waves, which resolve the length of one radian. The end of a segment is no
    node if the section does not jump there and is the mean of the sections at equal distances before and behind, within
    that reach and no further than the next nodes.
    """
    sections, lengths = segment_sections(cue), cue.lengths / phases
    both_ends = np.array([sections.EA, sections.EI, sections.kGA, sections.rhoA])[..., [0, -1]]
    profile, logs = np.repeat(cue.nodes, 2)[1:-1], np.log(both_ends).reshape(len(both_ends), -1)
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
