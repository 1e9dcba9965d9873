"""The committed table of the leather tip is what its program gives (regression)."""

from __future__ import annotations

import numpy as np

from cuefem.solid import leather_table as lt
from cuefem.solid.tip_sheets import gains
from studies.beam.leather import COUNTS, shape_at

NUS = (1 - np.exp(-lt.nodes(*lt.NU, COUNTS["nu"]))) / 2


def test_what_a_patch_that_sticks_gives_less() -> None:
    """One height of the table, all radii and Poisson's ratios."""
    j = 3
    shape = shape_at(0.0, lt.nodes(*lt.heights(0.0), COUNTS["height"])[j])
    np.testing.assert_allclose(gains(shape, NUS), lt.table().punch[j], rtol=2e-5, atol=2e-6)
