"""The committed table of the leather tip is what its program gives (regression)."""

from __future__ import annotations

from importlib.resources import files

import numpy as np

from cuefem.effects import leather_table as lt
from cuefem.solid.tip import Shape, loads
from studies.beam.leather_elasticity import COUNTS, OFF, SHEETS, curvatures, geometry, patches, shape_at


def test_one_geometry() -> None:
    """One curvature, height and Poisson's ratio out of the table: three patches of every sheet, and all head on."""
    panel, i, j, u = 1, 2, 3, 1
    kept = lt.table()
    k = curvatures(panel, COUNTS["curvature"])[i]
    shape = shape_at(k, lt.nodes(*lt.heights(k), COUNTS["height"])[j])
    nu = (1 - np.exp(-lt.nodes(*lt.NU, COUNTS["nu"]))) / 2
    chosen = [(name, s, a) for name in SHEETS for s, a in ((0, 2), (2, 5), (4, 7))]
    where = [patches(name, k)[s][a] for name, s, a in chosen]
    load = np.array([loads(Shape(1.0, k), patch, OFF) for patch in where])
    rows, head = geometry(shape, where, load, nu[u : u + 1], COUNTS)
    for row, (name, s, a) in zip(rows[0], chosen, strict=True):
        np.testing.assert_allclose(row, getattr(kept, name)[panel, i, j, u, s, a], rtol=2e-5, atol=2e-6)
    np.testing.assert_allclose(head[0], kept.head_on[panel, i, j, u], rtol=2e-5, atol=2e-6)


def test_the_file_is_small() -> None:
    """Under a megabyte in the package, all finite."""
    assert len(files("cuefem.effects").joinpath("leather_table.npz").read_bytes()) < 1e6
    assert all(np.all(np.isfinite(part)) for part in lt.table())
