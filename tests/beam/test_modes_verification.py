"""Modes: orthogonality, `near` and the default mesh (verification)."""

from __future__ import annotations

import numpy as np
import pytest

from cuefem import Cue, modes
from cuefem.beam.eigensolver import solve_eigenproblem
from tests.helpers.cues import FAMILY, isotropic_kim, kim, scaled, stiff_ferrule

SHAFTS = {**FAMILY, "stiff ferrule": stiff_ferrule()}


def scalar_product(
    cue: Cue, first: tuple[np.ndarray, np.ndarray], second: tuple[np.ndarray, np.ndarray], nodes: np.ndarray
) -> np.ndarray:
    """Integral of rhoA w1 w2 + rhoI theta1 theta2 over the cue; each pair (w, theta) at `stations` between nodes."""
    x, weights = stations(nodes)
    s = cue.section(x)
    return first[0] * (weights * s.rhoA) @ second[0].T + first[1] * (weights * s.rhoI) @ second[1].T


def stations(nodes: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Gauss points and weights between ``nodes``, m."""
    points, weights = np.polynomial.legendre.leggauss(40)
    lengths = np.diff(nodes)
    return (nodes[:-1, None] + lengths[:, None] * (points + 1) / 2).ravel(), np.outer(lengths, weights / 2).ravel()


@pytest.mark.parametrize("size", range(2, 9))
def test_few_unknowns_have_a_truncation_correction(size: int) -> None:
    """Modes and Ritz vectors have the static compliance of a chain of masses, and its first moment in mu."""
    rng = np.random.default_rng(size)
    springs, masses, shift = 10 ** rng.uniform(2, 6, size + 1), 10 ** rng.uniform(-3, 0, size), 1e3
    K = np.diag(springs[:-1] + springs[1:]) - np.diag(springs[1:-1], 1) - np.diag(springs[1:-1], -1)
    loads = np.eye(size, 2)
    static = np.linalg.solve(K + shift * np.diag(masses), loads)
    for count in range(1, size + 1):
        spectrum = solve_eigenproblem(K, np.diag(masses), loads, shift=shift, rigid=0, count=count, n_corrected=2)
        work = spectrum.work
        np.testing.assert_allclose(work @ work.T, loads.T @ static, rtol=1e-9, atol=1e-20)
        np.testing.assert_allclose((work * spectrum.mu) @ work.T, static.T @ (masses[:, None] * static), rtol=1e-9)
        lowest = spectrum.lowest(count)
        assert np.isfinite(lowest.participation).all()
        if lowest.radiation is not None and lowest.radiation.size:  # NumPy 2.1 has no rank of an empty matrix
            assert np.linalg.matrix_rank(lowest.radiation) == min(2, size - count)


@pytest.mark.parametrize("name", SHAFTS)
def test_modes_are_orthonormal_in_mass(name: str) -> None:
    """By an independent integral, and orthogonal to translation and rotation."""
    cue = SHAFTS[name]
    result = modes(cue, 8)
    nodes = result.system.mesh.nodes
    x, _ = stations(nodes)
    shape = result.shape(x)
    np.testing.assert_allclose(scalar_product(cue, shape, shape, nodes), np.eye(8), rtol=0, atol=1e-9)
    rigid = np.array([np.ones_like(x), x]), np.array([np.zeros_like(x), np.ones_like(x)])
    sizes = np.sqrt(np.diag(scalar_product(cue, rigid, rigid, nodes)))
    np.testing.assert_allclose(scalar_product(cue, rigid, shape, nodes) / sizes[:, None], 0, atol=1e-9)


@pytest.mark.parametrize("mode", [0, 1, 2])
def test_modes_near_natural_frequency_include_it(mode: int) -> None:
    """E and G scaled so that a mode has exactly 250 Hz: no singular matrix, and that mode is the first."""
    cue = kim()
    ratio = (250.0 / modes(cue, 3).frequencies[mode]) ** 2
    tuned = scaled(cue, E=ratio, G=ratio)
    np.testing.assert_allclose(modes(tuned, 1, near=250.0).frequencies, [250.0], rtol=1e-9)
    three = modes(tuned, 3, near=250.0)
    assert np.min(np.abs(three.frequencies / 250.0 - 1)) < 1e-9
    assert np.all(np.isfinite(three.vectors))
    exact = float(modes(tuned, 1, near=250.0).frequencies[0])
    np.testing.assert_allclose(modes(tuned, 1, near=exact).frequencies, [exact], rtol=1e-12)


@pytest.mark.parametrize("name", [*SHAFTS, "isotropic"])
@pytest.mark.parametrize("count", [1, 5, 12, 40])
def test_default_mesh_resolves_requested_modes(name: str, count: int) -> None:
    cue = SHAFTS.get(name, isotropic_kim())
    finer = modes(cue, 2 * count + 4).frequencies[:count]
    np.testing.assert_allclose(modes(cue, count).frequencies, finer, rtol=1e-6)
