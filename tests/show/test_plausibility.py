"""Warnings for implausible values, and none for shipped cues (regression)."""

import json
from dataclasses import replace
from pathlib import Path

import pytest

import cuefem as cf
from cuefem.show.plausibility import plausibility_warnings
from tests.helpers.command_line import call

ROOT = Path(__file__).parents[2]
FILES = sorted(path for kind in ("meshes/*.toml", "meshes/*.stl", "studies/scenes/*.toml") for path in ROOT.glob(kind))
SCENE = """
game = "kim"
cue = "cue.toml"
[ball]
radius = "28.575 mm"
[stroke]
offset = 0.3
[[effects]]
type = "TipDome"
radius = "9.5 mm"
"""
CUE = """
body_mass = "420 g"
segments = [
  { length = "25 mm", tip_diameter = "12.7 mm", butt_diameter = "12.7 mm", material = "hard maple" },
  { length = "400 mm", tip_diameter = "12.8 mm", butt_diameter = "14 mm", material = "hard maple" },
  { length = "300 mm", tip_diameter = "14 mm", butt_diameter = "21 mm", material = "hard maple" },
]
"""
PROFILE = "x [mm],diameter [mm]\n0,12.5\n250,12.9\n737,21\n"


def warnings_of(path: Path) -> list[str]:
    loaded = cf.load(path)
    if isinstance(loaded, cf.Cue) and not loaded.body_mass and path.suffix != ".toml":  # a profile has no other mass
        loaded = replace(loaded, body_mass=0.43)
    return plausibility_warnings(loaded if isinstance(loaded, cf.Scene) else cf.Scene(loaded))


@pytest.mark.parametrize("path", FILES, ids=lambda path: path.name)
def test_plausibility_of_shipped_cues_has_no_warning(path: Path) -> None:
    assert warnings_of(path) == []


@pytest.mark.parametrize(
    ("old", "new", "line"),
    [
        ("28.575 mm", "57.15 mm", "ball radius 57.15 mm; expected 26 to 31 mm; is this the diameter?"),
        ("9.5 mm", "9.5 m", "dome radius 9500 mm; expected 9 to 10.6 mm"),
        ("offset = 0.3", 'speed = "200 m/s"', "stroke speed 200 m/s; expected 0.5 to 12 m/s"),
        ("[ball]", '[ball]\nmass = "170 kg"', "ball mass 170000 g; expected 140 to 210 g"),
        ("420 g", "15 kg", "mass of the whole cue 1509"),
        ("12.7 mm", "0.0127 mm", "segments[0].tip_diameter 0.0127 mm; expected 8.5 to 14 mm"),
        ("12.8 mm", "128 mm", "the diameter jumps from 12.7 to 128 mm between segments[0] and segments[1]"),
        ("12.8 mm", "8.1 mm", "the diameter jumps from 12.7 to 8.1 mm between segments[0] and segments[1]"),
        ("400 mm", "400 m", "drawn length 400325 mm; check the unit of the lengths"),
        ('"14 mm", mat', '"14 mm", butt_bore = "3 mm", mat', "the bore of segments[1] tapers to zero; is tip_bore"),
    ],
)
def test_plausibility_of_wrong_value_warns(tmp_path: Path, old: str, new: str, line: str) -> None:
    assert old in CUE + SCENE
    for changed, warned in (((old, old), False), ((old, new), True)):
        for name, content in (("cue.toml", CUE), ("scene.toml", SCENE)):
            (tmp_path / name).write_text(content.replace(*changed, 1))
        assert bool(warnings_of(tmp_path / "scene.toml")) is warned
    assert any(text.startswith(line) for text in warnings_of(tmp_path / "scene.toml"))


EXPECTED = "the whole cue weighs "


def test_strike_of_shaft_without_butt_warns(tmp_path: Path) -> None:
    shaft = tmp_path / "shaft.csv"
    shaft.write_text(PROFILE)
    light = cf.load(shaft)
    assert isinstance(light, cf.Cue)
    (line,) = plausibility_warnings(cf.Scene(light))
    assert line.startswith(f"{EXPECTED}{1e3 * light.mass:.4g} g, less than 250 g: squirt is too low")
    status, out, err = call("strike", shaft, "--body-mass", "0 g", "--json")
    assert (status, err.splitlines()) == (0, [f"warning: {json.loads(out)['warnings'][0]}"])
    assert EXPECTED in err
    assert call("strike", shaft)[2] == ""  # with the usual rest of a pool cue
    assert call("modes", shaft)[2] == ""  # frequencies do not depend on it


def test_solid_carbon_rod_warns(tmp_path: Path) -> None:
    """A lathe profile without a bore in carbon is a solid rod of twice a shaft's mass."""
    (shaft := tmp_path / "shaft.csv").write_text(PROFILE)
    (line,) = plausibility_warnings(cf.Scene(cf.load(shaft, material="carbon fibre", body_mass="15 oz")))
    assert line.startswith("a solid rod as stiff as carbon fibre, drawn mass 2")


BUTTS = {"chamfer": "1460,30\n1470,5\n", "bumper": "1440,30\n1440.1,12\n1470,12\n"}


@pytest.mark.parametrize("name", BUTTS)
def test_chamfer_or_bumper_at_the_butt_causes_no_warning(name: str, tmp_path: Path) -> None:
    (tmp_path / "cue.csv").write_text("x [mm],diameter [mm]\n0,12.75\n330,13.2\n736.6,21.5\n" + BUTTS[name])
    assert plausibility_warnings(cf.Scene(cf.load(tmp_path / "cue.csv"))) == []
