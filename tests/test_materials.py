"""The table of materials against its sources and ranges."""

import dataclasses

import pytest

import cuefem as cf
from cuefem.materials import MATERIALS, WOODS, material

FIELDS = {"E", "G", "rho", "loss", "nu"}
ISOTROPIC = ["abs", "melamine", "phenolic", "nylon", "leather", "foam", "brass", "steel", "aluminium", "titanium"]


@pytest.mark.parametrize("name", MATERIALS)
def test_every_entry_names_its_source_and_may_have_any_number_of_its_ranges(name: str) -> None:
    known = MATERIALS[name]
    assert name == name.lower().strip()
    assert len(known.source) > 20
    assert "[" in known.source or "," in known.source
    assert set(known.ranges) == FIELDS
    for key, (low, high) in known.ranges.items():
        assert low <= getattr(known.material, key) <= high, key
        assert low < high, key
        for end in (low, high):
            assert getattr(dataclasses.replace(known.material, **{key: end}), key) == end


def test_keys_of_sources_are_explained() -> None:
    import re

    import cuefem.materials

    keys = {key for found in MATERIALS.values() for key in re.findall(r"\[\w+\]", found.source + found.note)}
    assert keys == set(re.findall(r"\[\w+\]", cuefem.materials.__doc__ or ""))


@pytest.mark.parametrize("name", WOODS)
def test_shear_of_woods(name: str) -> None:
    wood = material(name)
    assert 9 <= wood.E / wood.G <= 16  # handbook: The beam
    assert 15 <= wood.E / wood.rho / 1e6 <= 25  # the specific modulus of hardwoods, GPa m3/Mg


@pytest.mark.parametrize(
    ("name", "E", "G", "rho", "nu"),
    [
        # by hand from [FPL]: 1.1 MOE, mean shear ratio, 1120 specific gravity, mean Poisson's ratio
        ("hard maple", 13.86e9, 1.20582e9, 705.6, 0.450),
        ("ash", 13.2e9, 1.2276e9, 672.0, 0.4055),
        ("yellow birch", 15.29e9, 1.08559e9, 694.4, 0.4385),
    ],
)
def test_woods_from_the_wood_handbook(name: str, E: float, G: float, rho: float, nu: float) -> None:
    wood = material(name)
    assert (wood.E, wood.G, wood.rho, wood.nu) == pytest.approx((E, G, rho, nu), rel=1e-12)


def test_maple_against_bats() -> None:
    """Appl. Sci. 12 (2022) 3494, table A1: maple bats of 592 to 673 kg/m3, E_L 14.7 to 15.5 GPa, G 0.111 E_L."""
    low, high = MATERIALS["hard maple"].ranges["E"]
    assert low < 14.7e9 < 15.5e9 < high
    assert MATERIALS["hard maple"].ranges["G"][1] == pytest.approx(0.111 * 13.86e9, rel=0.01)


@pytest.mark.parametrize("name", ISOTROPIC)
def test_isotropic_materials(name: str) -> None:
    found = material(name)
    assert pytest.approx(found.E / (2 * (1 + found.nu)), rel=0.03) == found.G


def test_carbon_from_its_plies() -> None:
    """Classical lamination theory, rebuilt: membrane stiffness of 50 % at 0, 30 % at +-45, 20 % at 90 degrees."""
    E1, E2, G12, nu12 = 135e9, 10e9, 5e9, 0.3
    d = 1 - nu12**2 * E2 / E1
    Q11, Q22, Q12 = E1 / d, E2 / d, nu12 * E2 / d
    angle = (Q11 + Q22 + 2 * Q12) / 4
    A11 = 0.5 * Q11 + 0.3 * (angle + G12) + 0.2 * Q22
    A22 = 0.5 * Q22 + 0.3 * (angle + G12) + 0.2 * Q11
    A12 = 0.7 * Q12 + 0.3 * (angle - G12)
    A66 = 0.7 * G12 + 0.3 * (Q11 + Q22 - 2 * Q12) / 4
    found = material("carbon fibre")
    assert pytest.approx(A11 - A12**2 / A22, rel=2e-3) == found.E
    assert pytest.approx(A66, rel=5e-3) == found.G
    assert found.nu == pytest.approx(A12 / A22, rel=0.02)


def test_leather_from_contact_time() -> None:
    """The lower E is a disc that holds the whole compliance of a 1 ms head-on contact of a pool ball."""
    scene = cf.Scene(cf.LumpedCue(0.567, 0.008), cf.Ball(0.170, 0.028575), cf.Tip(0.73, 0.7, contact_time=1e-3))
    area = 3.141592653589793 / 4 * 12.75e-3**2
    assert scene.stiffness == pytest.approx(0.97e6, rel=0.01)
    assert MATERIALS["leather"].ranges["E"][0] == pytest.approx(scene.stiffness * 6e-3 / area, rel=0.02)
    assert material("leather").loss == pytest.approx((1 - 0.73**2) / 3.141592653589793, rel=0.02)


@pytest.mark.parametrize(
    ("name", "offer"),
    [
        ("hard mapel", "hard maple"),
        ("Maple", "hard maple"),
        ("carbon fiver", "carbon fibre"),
        ("alu", "aluminium"),
        ("ABS plastic", "abs"),
        ("steal", "steel"),
        ("Birch", "yellow birch"),
        ("ebony", "hard maple"),
        ("ivory", "melamine"),
    ],
)
def test_an_unknown_name_offers_near_ones(name: str, offer: str) -> None:
    with pytest.raises(ValueError, match=f"no material is called {name!r}; nearest: .*{offer}"):
        material(name)


def test_a_name_like_none_offers_all() -> None:
    with pytest.raises(ValueError, match=r"no material is called 'xyzzy'; known: hard maple, ash, .*titanium"):
        material("xyzzy")


def test_the_table_cannot_be_written_to() -> None:
    with pytest.raises(TypeError):
        MATERIALS["wood"] = MATERIALS["ash"]  # type: ignore[index]
    with pytest.raises(TypeError):
        MATERIALS["ash"].ranges["E"] = (0, 1)  # type: ignore[index]


@pytest.mark.parametrize(
    ("name", "meant"),
    [
        ("Hard Maple", "hard maple"),
        (" HARD_MAPLE", "hard maple"),
        ("sugar maple", "hard maple"),
        ("Carbon Fiber", "carbon fibre"),
        ("aluminum", "aluminium"),
        ("ABS", "abs"),
    ],
)
def test_a_name_in_another_spelling(name: str, meant: str) -> None:
    assert material(name) is MATERIALS[meant].material
