"""The tabulated basis of the line is scikit-fem's, function by function and point by point (verification)."""

from __future__ import annotations

import numpy as np
import pytest
from skfem import ElementLinePp
from skfem.quadrature import get_quadrature
from skfem.refdom import RefLine

from cuefem.beam.basis import line_basis, table
from cuefem.beam.waves import HIGHEST_ORDER


@pytest.mark.parametrize("degree", [1, 2, 3, 4, 7, 12, HIGHEST_ORDER, 40])
def test_every_basis_function_is_that_of_scikit_fem(degree: int) -> None:
    points = np.concatenate([[0.0, 1.0], np.random.default_rng(1).uniform(0, 1, 20)])
    values, slopes = line_basis(degree, points)
    theirs = ElementLinePp(max(degree, 3))  # hierarchical: lower degrees are its first functions
    for i in range(degree + 1):
        value, slope = theirs.lbasis(points[None, :], i)
        np.testing.assert_allclose(values[i], value, rtol=0, atol=1e-15 * (2 + i))
        np.testing.assert_allclose(slopes[i], slope[0], rtol=0, atol=1e-14 * (2 + i) ** 2)
    assert values.shape == slopes.shape == (degree + 1, len(points))


@pytest.mark.parametrize("order", [1, 6, HIGHEST_ORDER])
def test_gauss_points_are_those_of_scikit_fem(order: int) -> None:
    points, weights = get_quadrature(RefLine, 2 * order + 7)
    np.testing.assert_allclose(table(order).points, points[0], rtol=0, atol=1e-16)
    np.testing.assert_allclose(table(order).weights, weights, rtol=1e-15)
