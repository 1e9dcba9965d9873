"""Mesh of the meridian half-section of a cue, (z, r): conical quadrilaterals, graded towards both ends of a segment."""

from __future__ import annotations

from collections.abc import Iterator
from graphlib import CycleError, TopologicalSorter
from itertools import pairwise
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from skfem import MeshQuad

from cuefem.cue import Array, Cue, Material
from cuefem.solid.elasticity import SAME_POINT

MIN_WALL = 1e-6  # m: elements across a thinner wall would be too flat
MAX_MEMORY = 2**31  # bytes
# For each entry of the cells' matrices: triplets, sparse matrices and their factors.
BYTES_PER_ENTRY = 120


class Fineness(NamedTuple):
    """Element sizes of a solid shaft.

    order: of the polynomials. min_length: length of the elements at both ends of a segment, in radii there; each next
    one is ``growth`` times as long, up to ``max_length``, m. layers: elements across a layer of material.
    """

    order: int = 6
    min_length: float = 0.4
    max_length: float = 0.04
    growth: float = 2.0
    layers: int = 1


def mesh_lines(cue: Cue) -> tuple[Array, NDArray[np.intp], NDArray[np.intp]]:
    """The lines of the mesh along a cue, each from tip to butt and straight within a segment.

    Returns radii, (lines, stations) m, ascending with the line, and for each segment the line of its bore (0: solid)
    and of its outer surface. A line continues through segments that it does not bound. ValueError if the lines cross.
    """
    pieces = cue.segments
    ends = [[(s.tip_bore / 2, s.butt_bore / 2), (s.tip_diameter / 2, s.butt_diameter / 2)] for s in pieces]
    line_of: dict[tuple[int, int], int] = {}
    line_radii: list[dict[int, float]] = [{} for _ in range(len(pieces) + 1)]
    for i, bounds in enumerate(ends):
        for kind, (first, last) in enumerate(bounds):
            if kind == 0 and first == last == 0:
                continue
            alike = (k for k, r in line_radii[i].items() if abs(r - first) < SAME_POINT)
            line = next(alike, len(set(line_of.values())))
            line_of[i, kind] = line
            line_radii[i][line], line_radii[i + 1][line] = first, last
    order = TopologicalSorter[int]()
    for station_radii in line_radii:
        lines = sorted(station_radii, key=station_radii.__getitem__)
        for below, above in pairwise(lines):
            order.add(above, below)
        order.add(lines[0])
    try:
        ranks = {line: k for k, line in enumerate(order.static_order())}
    except CycleError:
        raise ValueError("Cue.segments must be a drawing whose lines do not cross; got bores that cross") from None
    radii = np.full((len(ranks) + 1, len(line_radii)), np.nan)
    radii[0] = 0.0
    for station, station_radii in enumerate(line_radii):
        rows = [0, *(1 + ranks[line] for line in station_radii)]
        radii[rows, station] = [0.0, *station_radii.values()]
        defined = np.sort(rows)
        radii[:, station] = np.interp(np.arange(len(radii)), defined, radii[defined, station])
        beyond = np.arange(len(radii)) - defined[-1]
        radii[:, station] *= 1 + 0.1 * np.maximum(beyond, 0)
    bore = np.array([1 + ranks[line_of[i, 0]] if (i, 0) in line_of else 0 for i in range(len(pieces))])
    return radii, bore, np.array([1 + ranks[line_of[i, 1]] for i in range(len(pieces))])


def element_ends(length: float, radii: tuple[float, float], fineness: Fineness) -> Array:
    """Ends of elements along a segment of ``length``, m, in [0, 1]; radii: at both ends, m."""
    lengths = [fineness.min_length * r * fineness.growth ** np.arange(40) for r in radii]
    left, right = (np.cumsum(g[g < fineness.max_length]) for g in lengths)
    left, right = left[left < 0.5 * length], length - right[right < 0.5 * length][::-1]
    first, last = [0.0, *left], [*right, length]
    if len(first) > 1 and last[0] - first[-1] < 0.5 * (first[-1] - first[-2]):
        first.pop()  # the two graded parts almost meet
    count = max(1, int(np.ceil((last[0] - first[-1]) / fineness.max_length - SAME_POINT)))
    return np.concatenate([first, np.linspace(first[-1], last[0], count + 1)[1:-1], last]) / length


class MeridianBlock(NamedTuple):
    """One layer of one segment, between two lines of the mesh; ends: the ends of its elements in [0, 1]."""

    piece: int
    layer: int
    material: Material
    ends: Array


def blocks(cue: Cue, fineness: Fineness) -> Iterator[MeridianBlock]:
    """Every layer of material of every segment."""
    radii, bore, outer = mesh_lines(cue)
    for i, piece in enumerate(cue.segments):
        ends = element_ends(piece.length, (radii[outer[i], i], radii[outer[i], i + 1]), fineness)
        for layer in range(outer[i]):
            material = piece.core if layer < bore[i] else piece.material
            if material is not None:
                yield MeridianBlock(i, layer, material, ends)


def check_mesh_size(cue: Cue, fineness: Fineness) -> None:
    """ValueError if a wall is too thin for the mesh, or if the solid needs more than 2 GiB."""
    for i, piece in enumerate(cue.segments):
        for end in ("tip", "butt"):
            bore, outer = getattr(piece, f"{end}_bore"), getattr(piece, f"{end}_diameter")
            if outer - bore < 2 * MIN_WALL:
                raise ValueError(
                    f"Segment.{end}_bore of segments[{i}] must leave a wall of {1e6 * MIN_WALL:g} um or more for a "
                    f"solid; got {1e6 * (outer - bore) / 2:.3g} um"
                )
    cells = fineness.layers * sum(len(block.ends) - 1 for block in blocks(cue, fineness))
    memory = BYTES_PER_ENTRY * cells * (3 * (fineness.order + 1) ** 2) ** 2
    if memory > MAX_MEMORY:
        raise ValueError(
            f"Solid.order must be lower for this drawing, whose solid of {cells} elements of order {fineness.order} "
            f"needs more than 2 GiB; got {memory / 2**30:.1f} GiB"
        )


def half_section(cue: Cue, fineness: Fineness) -> tuple[MeshQuad, list[Material]]:
    """The mesh in (z, r) and the material of each cell."""
    radii, _, _ = mesh_lines(cue)
    corners: list[Array] = []  # of each block, (quadrilaterals, 4, 2)
    materials: list[Material] = []
    fractions = np.arange(fineness.layers + 1)[:, None] / fineness.layers
    for i, layer, material, ends in blocks(cue, fineness):
        below, above = (radii[k, i] * (1 - ends) + radii[k, i + 1] * ends for k in (layer, layer + 1))
        r = below * (1 - fractions) + above * fractions
        z = np.broadcast_to(cue.nodes[i] * (1 - ends) + cue.nodes[i + 1] * ends, r.shape)
        grid = np.stack([z, r], axis=-1)
        corners.append(np.stack([grid[:-1, :-1], grid[:-1, 1:], grid[1:, 1:], grid[1:, :-1]], axis=2).reshape(-1, 4, 2))
        materials += [material] * len(corners[-1])
    points = np.concatenate(corners).reshape(-1, 2)
    keys = np.round(points / SAME_POINT).astype(np.int64)
    _, first, inverse = np.unique(keys, axis=0, return_index=True, return_inverse=True)
    return MeshQuad(np.ascontiguousarray(points[first].T), np.ascontiguousarray(inverse.reshape(-1, 4).T)), materials
