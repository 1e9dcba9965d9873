"""Closed surfaces of revolution with facets, as CAD programs write them; no tests."""

from collections.abc import Sequence
from itertools import pairwise
from pathlib import Path

import meshio
import numpy as np

from cuefem import Cue

Outline = Sequence[tuple[float, float]]


def revolve(outline: Outline, facets: int) -> tuple[np.ndarray, np.ndarray]:
    """Corners (along x) and triangles of an outline of (position, radius), turned about the axis; radius 0 is on it.

    Corners lie on the true surface. An outline that runs up the tip's face, along and down the butt's faces outwards.
    """
    turn = 2 * np.pi * np.arange(facets) / facets
    points: list[tuple[float, ...]] = []
    rings = []
    for x, r in outline:
        rings.append(len(points) + (np.zeros(facets, int) if r == 0 else np.arange(facets)))
        points += [(x, 0.0, 0.0)] if r == 0 else [(x, r * np.cos(t), r * np.sin(t)) for t in turn]
    faces = []
    for a, b in pairwise(rings):
        for p, q, r, s in zip(a, b, np.roll(b, -1), np.roll(a, -1), strict=True):
            faces += [face for face in ((p, q, r), (p, r, s)) if len(set(face)) == 3]
    return np.array(points), np.array(faces)


def outline_of(cue: Cue) -> Outline:
    """The outline of a shaft, along its bore (open at the tip, where it has one) and back along its outside."""
    x, pieces = cue.nodes, cue.segments
    inner = [
        p for i, s in enumerate(pieces) if s.tip_bore for p in ((x[i], s.tip_bore / 2), (x[i + 1], s.butt_bore / 2))
    ]
    outer = [p for i, s in enumerate(pieces) for p in ((x[i], s.tip_diameter / 2), (x[i + 1], s.butt_diameter / 2))]
    start = [(inner[-1][0], 0.0), *reversed(inner)] if inner else [(0.0, 0.0)]
    whole = [*start, *outer, (float(x[-1]), 0.0)]
    return [p for p, before in zip(whole, [None, *whole], strict=False) if p != before]


def write_surface(
    path: Path, points: np.ndarray, faces: np.ndarray, *, unit: float = 1e-3, binary: bool = True
) -> Path:
    """The surface as a file, in millimetres."""
    mesh = meshio.Mesh(points / unit, [("triangle", faces)])
    mesh.write(path) if path.suffix == ".obj" else mesh.write(path, binary=binary)
    return path
