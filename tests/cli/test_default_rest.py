"""A drawing without its butt: the same usual rest of the cue from every door, and what options of compare fill in."""

from dataclasses import replace
from pathlib import Path

import pytest

import cuefem as cf
from cuefem.designs.study_file import load_study
from tests.helpers.command_line import as_json

OUNCE = 0.028349523125  # kg
PROFILE = "x [mm],diameter [mm]\n0,12.75\n330,13.2\n736.6,21.5\n"
PREDATOR = Path(__file__).parents[2] / "studies/measured/predator_z2/cue.toml"
STUDY = 'scene = "{scene}"\nresponses = ["squirt"]\n{more}[[vary]]\npath = "speed"\nvalues = ["2 m/s"]\n'


@pytest.fixture
def shaft(tmp_path: Path) -> Path:
    path = tmp_path / "shaft.csv"
    path.write_text(PROFILE, encoding="utf-8")
    (tmp_path / "scene.toml").write_text('cue = "shaft.csv"\n[stroke]\nspeed = "2 m/s"\n', encoding="utf-8")
    return path


def study_scene(shaft: Path, scene: str, more: str = "") -> cf.Scene:
    path = shaft.parent / "study.toml"
    path.write_text(STUDY.format(scene=scene, more=more), encoding="utf-8")
    return load_study(path).base


@pytest.mark.filterwarnings("ignore::cuefem.PlausibilityWarning")
def test_scene_file_of_light_drawing_gets_usual_rest(shaft: Path) -> None:
    scene = cf.load(shaft.parent / "scene.toml")
    assert scene == cf.usual_scene(cf.load(shaft))
    assert scene == study_scene(shaft, "scene.toml")
    cf.save(scene, shaft.parent / "saved.toml")
    assert cf.load(shaft.parent / "saved.toml") == scene
    bare = replace(scene, cue=replace(scene.cue, body_mass=0.0))
    cf.save(bare, shaft.parent / "bare.toml")
    assert cf.load(shaft.parent / "bare.toml").cue.body_mass == 0.0


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
