"""Modes: orthogonality, `near`, the default mesh, and tip modes (verification)."""

from __future__ import annotations

import numpy as np
import pytest

from cuefem import Cue, modes
from cuefem.beam.eigensolver import solve_eigenproblem
from cuefem.beam.tip_modes import tip_modes
from tests.helpers.cues import FAMILY, isotropic_kim, kim, scaled, stiff_ferrule

SHAFTS = {**FAMILY, "stiff ferrule": stiff_ferrule()}


def scalar_product(
    cue: Cue, first: tuple[np.ndarray, np.ndarray], second: tuple[np.ndarray, np.ndarray], nodes: np.ndarray
) -> np.ndarray:
    """Integral of rhoA w1 w2 + rhoI theta1 theta2 over the cue; each pair (w, theta) at `stations` between nodes."""
    x, weights = stations(cue, nodes)
    s = cue.section(x)
    return first[0] * (weights * s.rhoA) @ second[0].T + first[1] * (weights * s.rhoI) @ second[1].T


def stations(cue: Cue, nodes: np.ndarray | None = None) -> tuple[np.ndarray, np.ndarray]:
    """Gauss points and weights of every segment, or between ``nodes``, m."""
    points, weights = np.polynomial.legendre.leggauss(40)
    ends = cue.nodes if nodes is None else nodes
    lengths = np.diff(ends)
    return (ends[:-1, None] + lengths[:, None] * (points + 1) / 2).ravel(), np.outer(lengths, weights / 2).ravel()


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
    x, _ = stations(cue, nodes)
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


def test_tip_modes_sum_to_inverse_mass_at_tip() -> None:
    """The rigid-body part of the sum of a a' over the modes is the inverse mass, axial and transverse."""
    cue = kim()
    result = modes(cue, 5)
    tip = tip_modes(result, cue.mass)
    np.testing.assert_array_equal(tip.omega[:3], 0.0)
    np.testing.assert_allclose(tip.omega[3:], result.omega, rtol=1e-15)
    np.testing.assert_allclose(tip.amplitude[3:, 1], result.shape(0.0)[0], rtol=1e-13)
    np.testing.assert_allclose(tip.rotation[3:], result.shape(0.0)[1], rtol=1e-13)
    np.testing.assert_allclose(tip.amplitude[:, 0] @ tip.amplitude[:, 0], 1 / cue.mass, rtol=1e-14)
    np.testing.assert_allclose(tip.approach @ tip.approach, cue.mass, rtol=1e-14)
    x, weights = stations(cue)
    s, centre = cue.section(x), cue.balance_point
    inertia = weights @ (s.rhoA * (x - centre) ** 2 + s.rhoI)
    rigid = tip.amplitude[:3, 1] @ tip.amplitude[:3, 1]
    np.testing.assert_allclose(rigid, 1 / cue.shaft_mass + centre**2 / inertia, rtol=1e-12)
