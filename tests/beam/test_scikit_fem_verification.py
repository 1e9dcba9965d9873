"""The beam's matrices against those that scikit-fem assembles of the same weak forms (verification)."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
import scipy.linalg as la
import scipy.sparse as sp
from skfem import Basis, BilinearForm, ElementLinePp, MeshLine

from cuefem import Cue
from cuefem.beam.system import assemble
from studies.strokes import NAMES, cue


@BilinearForm
def bending(theta: Any, phi: Any, at: Any) -> Any:
    """EI theta' phi'."""
    return at.EI * theta.grad[0] * phi.grad[0]


@BilinearForm
def sheared(w: Any, v: Any, at: Any) -> Any:
    """kappa G A w' v'."""
    return at.kGA * w.grad[0] * v.grad[0]


@BilinearForm
def crossed(w: Any, phi: Any, at: Any) -> Any:
    """-kappa G A w' phi."""
    return -at.kGA * w.grad[0] * phi


@BilinearForm
def weighed(u: Any, v: Any, at: Any) -> Any:
    """The product of two fields, times a property of the section."""
    return at.of * u * v


def by_scikit_fem(cue: Cue, nodes: np.ndarray, order: int) -> tuple[sp.csr_matrix, sp.csr_matrix]:
    """K and M of the Timoshenko beam as scikit-fem assembles its weak forms: deflection of a degree more than the
    rotation, on elements between these nodes, m."""
    across = Basis(MeshLine(nodes), ElementLinePp(order + 1), intorder=2 * order + 6)  # a taper's EI has degree 4
    turning = across.with_element(ElementLinePp(order))
    section = cue.section(np.asarray(across.global_coordinates())[0])
    K = [
        [sheared.assemble(across, kGA=section.kGA), crossed.assemble(across, turning, kGA=section.kGA).T],
        [
            crossed.assemble(across, turning, kGA=section.kGA),
            bending.assemble(turning, EI=section.EI) + weighed.assemble(turning, of=section.kGA),
        ],
    ]
    M = [weighed.assemble(across, of=section.rhoA), weighed.assemble(turning, of=section.rhoI)]
    return sp.bmat(K, format="csr"), sp.block_diag(M, format="csr")


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
