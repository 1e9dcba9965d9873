"""Verification of the beam: closed forms, an independent shooting method, orders at every level, rounding."""

from __future__ import annotations

import numpy as np
import pytest

from cuefem import Cue, Material, Resolution, Segment, modes
from cuefem.beam import system
from cuefem.beam.mesh import mesh_cue
from tests.helpers.cues import CARBON, FOAM, MAPLE, isotropic_kim, kim, rod, soft_tip, stiff_ferrule
from tests.helpers.exact import shot_frequency, uniform_frequencies
from tests.helpers.orders import assert_order

KIM_FREE = np.array([121.4816650127, 328.8249787923, 637.9759377717])  # Hz


def frequencies(cue: Cue, elements: int, order: int, count: int = 3) -> np.ndarray:
    return modes(cue, count, at=Resolution(elements, order, count)).frequencies


def test_kim_free_isotropic() -> None:
    np.testing.assert_allclose(modes(isotropic_kim(), 3).frequencies, KIM_FREE, rtol=1e-9)


@pytest.mark.parametrize("mode", [0, 1, 2])
def test_kim_free_by_shooting(mode: int) -> None:
    np.testing.assert_allclose(shot_frequency(isotropic_kim(), KIM_FREE[mode]), KIM_FREE[mode], rtol=1e-12)


COMPOSITE = Cue(
    (
        Segment(0.006, 0.013, 0.0128, Material(0.1e9, 0.04e9, 950.0), kappa=0.88),
        Segment(0.3, 0.0128, 0.014, CARBON, 0.009, 0.010, core=FOAM, kappa=0.6),
        Segment(0.4, 0.015, 0.021, MAPLE, 0.0, 0.012, kappa=0.8),
    )
)


@pytest.mark.parametrize("mode", [0, 1, 5])
def test_tapered_bored_cored_jumping_cue_by_shooting(mode: int) -> None:
    found = modes(COMPOSITE, 6).frequencies[mode]
    np.testing.assert_allclose(shot_frequency(COMPOSITE, found), found, rtol=1e-9)


@pytest.mark.parametrize("slenderness", [10, 30, 100, 1e3, 1e4])
def test_uniform_rod_closed_form(slenderness: float) -> None:
    """At slenderness 10 the ten modes pass the shear cut-off, where the second branch of waves begins."""
    cue = rod(slenderness)
    exact = uniform_frequencies(cue, 10)
    np.testing.assert_allclose(frequencies(cue, 2, 24, 10), exact, rtol=1e-11)
    np.testing.assert_allclose(modes(cue, 5).frequencies, exact[:5], rtol=1e-9)


LEVELS = {1: [4, 8, 16, 32, 64, 128], 2: [4, 8, 16, 32, 64], 3: [4, 8, 16, 32]}


@pytest.mark.parametrize("mode", [0, 1, 2])
@pytest.mark.parametrize("order", [1, 2, 3])
def test_order_2p(order: int, mode: int) -> None:
    """The frequency error is of order 2p; its next term is h^2 smaller, so the bound tightens like 1/elements^2."""
    exact = frequencies(isotropic_kim(), 2, 20)
    elements = np.array(LEVELS[order])
    errors = [frequencies(isotropic_kim(), int(n), order)[mode] / exact[mode] - 1 for n in elements]
    assert_order(2 * order, 1 / elements, errors, within=20.0 / elements[:-1] ** 2)


@pytest.mark.parametrize("cue", [kim(), soft_tip(), stiff_ferrule()], ids=["kim", "soft tip", "stiff ferrule"])
def test_low_modes_keep_their_digits(cue: Cue) -> None:
    """Trap 1: `eigh(K, M)` loses f1 by 2e-8 at 800 unknowns, by 1e-6 and more beside a stiff or soft short piece."""
    reference = frequencies(cue, 1, 24, 4)
    for elements, order in ((2, 18), (4, 18), (8, 12), (8, 20), (40, 8)):
        np.testing.assert_allclose(frequencies(cue, elements, order, 4), reference, rtol=1e-13)


def test_dense_and_sparse_agree(monkeypatch: pytest.MonkeyPatch) -> None:
    cue = stiff_ferrule()
    found = {}
    monkeypatch.setattr(system, "EVEN", 1)  # however many modes are wanted
    for limit in (0, 10**6):
        monkeypatch.setattr(system, "DENSE_LIMIT", limit)
        found[limit] = modes(cue, 8, at=Resolution(2, 16, 8))
    assert isinstance(found[10**6].system.K, np.ndarray)
    assert not isinstance(found[0].system.K, np.ndarray)
    np.testing.assert_allclose(found[0].frequencies, found[10**6].frequencies, rtol=1e-13)
    x = np.linspace(0, cue.length, 50)
    for sparse, dense in zip(found[0].shape(x), found[10**6].shape(x), strict=True):
        np.testing.assert_allclose(sparse, dense, rtol=0, atol=1e-7 * np.abs(dense).max())


def test_a_node_at_every_jump_and_position() -> None:
    """A smooth piece is one polynomial: element ends stand at segment ends and at positions, none twice."""
    mesh = mesh_cue(COMPOSITE, elements=2, order=3, positions=(0.1, 0.006, 0.1))
    for x in (0.0, 0.006, 0.1, 0.306, 0.706):
        assert np.min(np.abs(mesh.nodes - x)) < 1e-15
    assert len(mesh.nodes) == 2 * 4 + 1
    assert mesh.unknowns == 2 * 9 + 8 * (2 * 3 - 1)
