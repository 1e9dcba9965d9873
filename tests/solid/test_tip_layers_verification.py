"""Layers under a leather tip: a plain tip in two parts, a rod of two moduli, a thin bonded pad, and what is refused."""

from __future__ import annotations

import math

import numpy as np
import pytest

from cuefem.solid.tip_solid import (
    Layer,
    Patch,
    Shape,
    TipFineness,
    TipSolid,
    compliance,
    layered,
    loads,
    surfaces,
    usual,
)


def give(shape: Shape, nu: float, patch: Patch, how: TipFineness) -> np.ndarray:
    """E D times the compliance of one Hertz-weighted patch."""
    return compliance(surfaces(TipSolid(shape, how), nu), loads(shape, patch, how))


@pytest.mark.heavy
def test_equal_layers_under_a_dome_are_the_plain_one() -> None:
    """One pad in two halves is the pad to 1e-10; a pad of the leather itself is the leather but for the mesh, which is
    another one inside a dome: 1e-3."""
    patch, whole, halves = Patch(0.5, 0.15), (Layer(0.1, 0.3, 0.3),), (Layer(0.05, 0.3, 0.3),) * 2
    how = layered(usual(4, 5, 4, 12), Shape(0.5, 1.3, halves))
    of_one, of_two = (give(Shape(0.5, 1.3, layers), 0.4, patch, how) for layers in (whole, halves))
    np.testing.assert_allclose(of_one, of_two, rtol=1e-10)
    leather = Shape(0.5, 1.3, (Layer(0.1, 1.0, 0.4),))
    same = give(leather, 0.4, patch, how)
    plain = give(Shape(0.5, 1.3), 0.4, patch, usual(4, 5, 4, 12))
    np.testing.assert_allclose(np.diagonal(same), np.diagonal(plain), rtol=1e-3)


def test_a_rod_of_two_moduli() -> None:
    """Two diameters of twice the modulus in a long rod give 2 (1 - 1/2)/A less than the leather, to 1 %: where the
    moduli meet, each holds or widens the other over about a diameter (0.7 % here)."""
    how, patch = usual(4, 4, 6, 1), Patch(0.0, 0.45)
    plain, stiff = (
        Shape(8.0, 0.0, (Layer(2.0, 1.0, 0.3), Layer(2.0, E, 0.3), Layer(2.0, 1.0, 0.3))) for E in (1.0, 2.0)
    )
    less = [give(shape, 0.3, patch, layered(how, shape))[0, 0] for shape in (plain, stiff)]
    assert abs((less[0] - less[1]) / (4 / math.pi) - 1) < 0.01


@pytest.mark.heavy
@pytest.mark.parametrize("nu", [0.3])
def test_a_thin_soft_pad_is_a_bonded_layer(nu: float) -> None:
    """t/(A M), M the modulus of a layer that cannot widen; the free edge gives more, in proportion to t."""
    errors = []
    for t in (0.02, 0.01):
        shape = Shape(0.5 + t, 0.0, (Layer(t, 1e-7, nu),))
        found = give(shape, 0.3, Patch(0.0, 0.4), layered(usual(5, 10, 4, 1), shape))[0, 0]
        bonded = t / 1e-7 * (1 + nu) * (1 - 2 * nu) / (1 - nu) * 4 / math.pi
        errors.append(found / bonded - 1)
    assert 0 < errors[1] < errors[0] < 0.05
    assert abs(errors[0] / errors[1] / 2 - 1) < 0.03


@pytest.mark.parametrize(
    ("layer", "words"),
    [
        ((0.0, 1.0, 0.3), "Layer.height"),
        ((math.nan, 1.0, 0.3), "Layer.height"),
        ((0.1, 0.0, 0.3), "Layer.modulus"),
        ((0.1, -1.0, 0.3), "Layer.modulus"),
        ((0.1, 1.0, 0.5), "Layer.nu"),
        ((0.1, 1.0, -1.0), "Layer.nu"),
        ((0.4, 1.0, 0.3), "Shape.layers must end below the dome"),
    ],
)
def test_refusals(layer: tuple[float, float, float], words: str) -> None:
    """A layer of no thickness, constants that are not positive definite, layers that reach into the dome."""
    with pytest.raises(ValueError, match=words):
        Shape(0.5, 1.3, (Layer(*layer),))
