"""Cues as line meshes (.vtu) for other programs: one cell per segment, its fields as cell data."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import meshio
import numpy as np

from cuefem.cue import Cue, Material, Segment
from cuefem.quantity.fields import quantity_fields


def save_line_mesh(cue: Cue, path: Path) -> None:
    """Write a cue as .vtu, points along x from tip to butt, m; cell data in SI units, 0 for an absent value."""
    data: dict[str, list[Any]] = {}
    for prefix, kind, things in (
        ("", Segment, cue.segments),
        ("", Material, [segment.material for segment in cue.segments]),
        ("core_", Material, [segment.core for segment in cue.segments]),
    ):
        for name, *_ in quantity_fields(kind):
            data[f"{prefix}{name}"] = [np.array([getattr(thing, name, None) or 0.0 for thing in things])]
    data["body_mass"] = [np.full(len(cue.segments), cue.body_mass)]
    points = np.column_stack([cue.nodes, np.zeros((len(cue.nodes), 2))])
    cells = np.arange(len(cue.segments))[:, None] + np.array([0, 1])
    meshio.vtu.write(str(path), meshio.Mesh(points, [("line", cells)], cell_data=data), binary=True)
