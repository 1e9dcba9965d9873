"""What options of compare fill in of drawings without their butt (regression)."""

from pathlib import Path

import pytest

import cuefem as cf
from tests.helpers.command_line import as_json

OUNCE = 0.028349523125  # kg
PROFILE = "x [mm],diameter [mm]\n0,12.75\n330,13.2\n736.6,21.5\n"
PREDATOR = Path(__file__).parents[2] / "studies/measured/predator_z2/cue.toml"


@pytest.fixture
def shaft(tmp_path: Path) -> Path:
    path = tmp_path / "shaft.csv"
    path.write_text(PROFILE, encoding="utf-8")
    return path


@pytest.mark.heavy
def test_compare_options_fill_in_what_each_file_leaves_open(shaft: Path) -> None:
    options = ("--body-mass", "15 oz", "--ferrule", "1 in melamine", "--shaft-mass", "3.9 oz", "--game", "pool")
    record = as_json("compare", shaft, PREDATOR, *options)
    own = cf.load(PREDATOR)
    assert isinstance(own, cf.Cue)
    filled, named = (scene["cue"] for scene in record["scenes"].values())
    assert filled["body_mass"] == pytest.approx(15 * OUNCE)
    assert filled["shaft_mass"] + 6e-4 == pytest.approx(3.9 * OUNCE, rel=1e-2)  # with its tip
    assert (named["body_mass"], named["mass"]) == (pytest.approx(own.body_mass), pytest.approx(own.mass, rel=0.02))
    for text in ("--body-mass 15 oz", "--ferrule 1 in melamine", "--shaft-mass 3.9 oz"):
        assert f"{text}: for shaft; predator z2 has its own" in record["assumptions"]
