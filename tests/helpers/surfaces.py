"""Closed surfaces of revolution with facets, as CAD programs write them; no tests."""

from collections.abc import Sequence
from itertools import pairwise
from pathlib import Path

import meshio
import numpy as np

from cuefem import Cue

Outline = Sequence[tuple[float, float]]


def revolve(outline: Outline, facets: int) -> tuple[np.ndarray, np.ndarray]:
    """Corners, (n, 3), and triangles, (m, 3), of an outline of (position, radius), m, revolved about the x axis.

    Corners lie on the true surface; radius 0 is one corner on the axis. The triangles of an outline that runs outwards
    on the tip's face, along the shaft, and inwards on the butt's have normals that point inwards.
    """
    angles = 2 * np.pi * np.arange(facets) / facets
    points: list[tuple[float, ...]] = []
    rings = []
    for x, r in outline:
        rings.append(len(points) + (np.zeros(facets, int) if r == 0 else np.arange(facets)))
        points += [(x, 0.0, 0.0)] if r == 0 else [(x, r * np.cos(t), r * np.sin(t)) for t in angles]
    faces = []
    for a, b in pairwise(rings):
        for p, q, r, s in zip(a, b, np.roll(b, -1), np.roll(a, -1), strict=True):
            faces += [face for face in ((p, q, r), (p, r, s)) if len(set(face)) == 3]
    return np.array(points), np.array(faces)


def outline_of(cue: Cue) -> Outline:
    """The outline of a shaft, m: along its bore, if any, to the tip, and back along its outside."""
    x, segments = cue.nodes, cue.segments
    inner = [
        p for i, s in enumerate(segments) if s.tip_bore for p in ((x[i], s.tip_bore / 2), (x[i + 1], s.butt_bore / 2))
    ]
    outer = [p for i, s in enumerate(segments) for p in ((x[i], s.tip_diameter / 2), (x[i + 1], s.butt_diameter / 2))]
    start = [(inner[-1][0], 0.0), *reversed(inner)] if inner else [(0.0, 0.0)]
    outline = [*start, *outer, (float(x[-1]), 0.0)]
    return [p for p, before in zip(outline, [None, *outline], strict=False) if p != before]


def write_surface(
    path: Path, points: np.ndarray, faces: np.ndarray, *, unit: float = 1e-3, binary: bool = True
) -> Path:
    """Write a surface, with coordinates in ``unit``, m; the path."""
    mesh = meshio.Mesh(points / unit, [("triangle", faces)])
    mesh.write(path, **({"binary": binary} if path.suffix in (".stl", ".ply") else {}))
    return path


def two_bodies(gap: float, facets: int = 16) -> tuple[np.ndarray, np.ndarray]:
    """Corners and triangles of a cone of 12.75 to 21.5 mm by 736.6 mm, cut at 31 mm by a gap, m."""

    def radius(x: float) -> float:
        return 6.375e-3 + 4.375e-3 * x / 0.7366

    ends = ((0.0, 0.031 - gap), (0.031, 0.7366))
    bodies = [revolve([(x, 0), (x, radius(x)), (y, radius(y)), (y, 0)], facets) for x, y in ends]
    (front, faces), (back, more) = bodies
    return np.concatenate([front, back]), np.concatenate([faces, more + len(front)])
