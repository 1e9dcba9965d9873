"""Layers under a leather tip: a plain tip in two parts, a rod of two moduli, a thin bonded pad."""

from __future__ import annotations

import math

import numpy as np
import pytest

from cuefem.solid.tip_compliance import Patch, Shape, TipFineness, TipSolid, compliance, loads, surfaces, usual


def give(shape: Shape, nu: float, patch: Patch, how: TipFineness) -> np.ndarray:
    """E D times the compliance of one Hertz-weighted patch."""
    return compliance(surfaces(TipSolid(shape, how), nu), loads(shape, patch, how))


@pytest.mark.heavy
def test_equal_layers_under_a_dome_are_the_plain_one() -> None:
    """One pad in two halves is the pad, and a pad of the leather itself is the leather, but for the mesh, which has
    three rows in every layer: 1e-4 and 1e-3."""
    patch, how = Patch(0.5, 0.15), usual(4, 5, 4, 12)
    whole, halves = (Shape(0.5, 1.3, ((0.1 / n, 0.3, 0.3),) * n) for n in (1, 2))
    of_one, of_two = (give(shape, 0.4, patch, how) for shape in (whole, halves))
    np.testing.assert_allclose(np.diagonal(of_one), np.diagonal(of_two), rtol=1e-4)
    leather = Shape(0.5, 1.3, ((0.1, 1.0, 0.4),))
    same = give(leather, 0.4, patch, how)
    plain = give(Shape(0.5, 1.3), 0.4, patch, how)
    np.testing.assert_allclose(np.diagonal(same), np.diagonal(plain), rtol=1e-3)


def test_a_rod_of_two_moduli() -> None:
    """Two diameters of twice the modulus in a long rod give 2 (1 - 1/2)/A less than the leather, to 1 %: where the
    moduli meet, each holds or widens the other over about a diameter (0.7 % here)."""
    how, patch = usual(4, 4, 6, 1), Patch(0.0, 0.45)
    plain, stiff = (Shape(8.0, 0.0, ((2.0, 1.0, 0.3), (2.0, E, 0.3), (2.0, 1.0, 0.3))) for E in (1.0, 2.0))
    less = [give(shape, 0.3, patch, how)[0, 0] for shape in (plain, stiff)]
    assert abs((less[0] - less[1]) / (4 / math.pi) - 1) < 0.01


@pytest.mark.heavy
def test_a_thin_soft_pad_is_a_bonded_layer() -> None:
    """t/(A M), M the modulus of a layer that cannot widen; the free edge gives more, in proportion to t."""
    errors, nu = [], 0.3
    for t in (0.02, 0.01):
        shape = Shape(0.5 + t, 0.0, ((t, 1e-7, nu),))
        found = give(shape, 0.3, Patch(0.0, 0.4), usual(5, 10, 4, 1))[0, 0]
        bonded = t / 1e-7 * (1 + nu) * (1 - 2 * nu) / (1 - nu) * 4 / math.pi
        errors.append(found / bonded - 1)
    assert 0 < errors[1] < errors[0] < 0.05
    assert abs(errors[0] / errors[1] / 2 - 1) < 0.03
