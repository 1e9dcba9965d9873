"""The beam's matrices against those that scikit-fem assembles of the same weak forms (verification)."""

from __future__ import annotations

import numpy as np
import pytest
import scipy.linalg as la

from cuefem.beam.system import assemble
from studies.accuracy.speed import by_scikit_fem
from studies.strokes import NAMES, cue


@pytest.mark.parametrize("name", NAMES)
def test_the_tones_of_both(name: str) -> None:
    """Twelve flexible modes on one mesh, to 1e-9: the bases differ, the spaces are the same."""
    drawn, order = cue(name), 8
    ours = assemble(drawn, elements=2, order=order)
    K, M = (matrix.toarray() for matrix in by_scikit_fem(drawn, ours.mesh.nodes, order))
    assert K.shape == ours.K.shape
    tones = []
    for stiff, mass in ((K, M), (ours.K, ours.M)):
        dense = [np.asarray(part.todense()) if hasattr(part, "todense") else part for part in (stiff, mass)]
        mixed = dense[0] + ours.shift * dense[1]
        tones.append(1 / la.eigh(dense[1], mixed, eigvals_only=True)[::-1][2:14] - ours.shift)
    np.testing.assert_allclose(tones[0], tones[1], rtol=1e-9)
