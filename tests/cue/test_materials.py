"""The table of materials against its sources and ranges (validation)."""

import dataclasses

import pytest

import cuefem as cf
from cuefem.cue.materials import LEATHERS, MATERIALS, material

FIELDS = {"E", "G", "rho", "loss", "nu"}


@pytest.mark.parametrize("name", MATERIALS)
def test_material_has_source_and_valid_ranges(name: str) -> None:
    entry = MATERIALS[name]
    assert name == name.lower().strip()
    assert len(entry.source) > 20
    assert "[" in entry.source or "," in entry.source
    assert set(entry.ranges) == FIELDS
    for key, (low, high) in entry.ranges.items():
        assert low <= getattr(entry.material, key) <= high, key
        assert low < high, key
        for end in (low, high):
            assert getattr(dataclasses.replace(entry.material, **{key: end}), key) == end


@pytest.mark.parametrize(
    ("name", "E", "G", "rho", "nu"),
    [
        # by hand from [FPL]: 1.1 MOE, mean shear ratio, 1120 specific gravity, mean Poisson's ratio
        ("hard maple", 13.86e9, 1.20582e9, 705.6, 0.450),
        ("ash", 13.2e9, 1.2276e9, 672.0, 0.4055),
        ("yellow birch", 15.29e9, 1.08559e9, 694.4, 0.4385),
    ],
)
def test_wood_equals_wood_handbook(name: str, E: float, G: float, rho: float, nu: float) -> None:
    wood = material(name)
    assert (wood.E, wood.G, wood.rho, wood.nu) == pytest.approx((E, G, rho, nu), rel=1e-12)


def test_carbon_equals_laminate_theory() -> None:
    """Classical lamination theory: membrane stiffness of 50 % at 0, 30 % at +-45, 20 % at 90 degrees."""
    E1, E2, G12, nu12 = 135e9, 10e9, 5e9, 0.3
    d = 1 - nu12**2 * E2 / E1
    Q11, Q22, Q12 = E1 / d, E2 / d, nu12 * E2 / d
    angle = (Q11 + Q22 + 2 * Q12) / 4
    A11 = 0.5 * Q11 + 0.3 * (angle + G12) + 0.2 * Q22
    A22 = 0.5 * Q22 + 0.3 * (angle + G12) + 0.2 * Q11
    A12 = 0.7 * Q12 + 0.3 * (angle - G12)
    A66 = 0.7 * G12 + 0.3 * (Q11 + Q22 - 2 * Q12) / 4
    carbon = material("carbon fibre")
    assert pytest.approx(A11 - A12**2 / A22, rel=2e-3) == carbon.E
    assert pytest.approx(A66, rel=5e-3) == carbon.G
    assert carbon.nu == pytest.approx(A12 / A22, rel=0.02)


def test_leather_ranges_are_soft_to_hard() -> None:
    """The stiffness of a 1 ms contact as the entry's source states it; E and loss from soft to hard leather."""
    scene = cf.Scene(cf.LumpedCue(0.567, 0.008), cf.Ball(0.170, 0.028575), cf.Tip(0.73, 0.7, contact_time=1e-3))
    assert scene.stiffness == pytest.approx(0.97e6, rel=0.01)
    assert MATERIALS["leather"].ranges["E"] == pytest.approx((LEATHERS["soft"].E, LEATHERS["hard"].E), rel=0.02)
    losses = {name: (1 - entry.restitution**2) / 3.141592653589793 for name, entry in LEATHERS.items()}
    assert material("leather").loss == pytest.approx(losses["medium"], rel=0.02)
    assert MATERIALS["leather"].ranges["loss"] == pytest.approx((losses["soft"], losses["hard"]), rel=0.02)


SPELT = {
    "hard maple": ("Hard Maple", " HARD_MAPLE", "sugar maple", "Maple"),
    "carbon fibre": ("Carbon Fiber",),
    "yellow birch": ("Birch",),
    "aluminium": ("aluminum",),
    "abs": ("ABS",),
    "linen melamine": ("LBM",),
    "acetal": ("Delrin",),
    "cast resin": ("juma",),
}


def test_material_of_another_spelling_is_that_of_the_table() -> None:
    for name, variants in SPELT.items():
        assert [material(variant) for variant in variants] == [MATERIALS[name].material] * len(variants)
