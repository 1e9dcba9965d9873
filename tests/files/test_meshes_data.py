"""The reference cues of meshes/ against the numbers of meshes/README.md (regression)."""

import math
from pathlib import Path

import pytest

import cuefem as cf

FOLDER = Path(__file__).parents[2] / "meshes"
INCH, OUNCE = 0.0254, 0.028349523125
CUES = ["kim", "pool_maple", "pool_hollow", "carbon", "whole_cue"]


def load(name: str) -> cf.Cue:
    cue = cf.load(FOLDER / f"{name}.toml")
    assert isinstance(cue, cf.Cue)
    return cue


def test_meshes_readme_lists_all_cues() -> None:
    assert sorted(path.stem for path in FOLDER.glob("*.toml")) == sorted(CUES)
    text = (FOLDER / "README.md").read_text()
    assert all(f"{name}.toml" in text for name in CUES)


def test_kim_mesh_has_published_dimensions() -> None:
    """[Kim] sec. 4: radius 6 to 10.5 mm over 0.70 m, 120 g, a cue of 540 g; E 12.6 GPa, G = E/15."""
    cue = load("kim")
    (cone,) = cue.segments
    assert cue.shaft_mass == pytest.approx(0.120, rel=1e-12)
    assert cue.mass == pytest.approx(0.540, rel=1e-12)
    assert (cone.length, cone.tip_diameter, cone.butt_diameter, cone.kappa) == (0.70, 0.012, 0.021, 0.9)
    assert pytest.approx((12.6e9, 15), rel=1e-14) == (cone.material.E, cone.material.E / cone.material.G)


@pytest.mark.parametrize(
    ("name", "grams", "centre"), [("pool_maple", 99.98, 17.04), ("pool_hollow", 89.69, 18.17), ("carbon", 90.26, 19.26)]
)
def test_pool_meshes_have_stated_masses(name: str, grams: float, centre: float) -> None:
    """29 in long, 3 to 4 oz, on a cue of 20 oz, 0.846 in at the joint; centre of mass in inches from the tip."""
    cue = load(name)
    assert cue.length == pytest.approx(29 * INCH, rel=1e-12)
    assert cue.shaft_mass == pytest.approx(grams * 1e-3, abs=5e-6)
    assert 3 <= cue.shaft_mass / OUNCE <= 4
    assert cue.mass == pytest.approx(20 * OUNCE, abs=1e-4)
    assert cue.segments[-1].butt_diameter == pytest.approx(0.846 * INCH, abs=2e-5)
    assert cue.balance_point == pytest.approx(centre * INCH, abs=0.005 * INCH)


def test_whole_cue_mesh_has_stated_mass_and_balance() -> None:
    """58 in, about 19 oz, balanced 18.2 in from the butt, body_mass 0."""
    cue = load("whole_cue")
    assert cue.body_mass == 0
    assert cue.length == pytest.approx(58 * INCH, rel=1e-12)
    assert cue.mass == pytest.approx(19 * OUNCE, rel=5e-3)
    assert (cue.length - cue.balance_point) / INCH == pytest.approx(18.2, abs=0.1)
    joint = next(i for i, x in enumerate(cue.nodes) if math.isclose(x, 29 * INCH))
    assert cue.segments[joint - 1].butt_diameter == cue.segments[joint].tip_diameter
