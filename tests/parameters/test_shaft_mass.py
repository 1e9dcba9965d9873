"""The mass of a shaft determines the density of its wood, which is then not uncertain (properties)."""

from dataclasses import replace
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

import cuefem as cf
from cuefem.parameters.parts import main_material, with_shaft_mass
from cuefem.parameters.scene_changes import with_parameters
from cuefem.results.uncertainty import squirt_changes
from cuefem.scene.solved_scene import SolvedScene
from tests.helpers.command_line import as_json, call
from tests.helpers.cues import pool
from tests.helpers.examples import examples

CSV = "x [mm],diameter [mm]\n0,12.75\n330,13.2\n736.6,21.5\n"


@examples(25)
@given(st.floats(0.03, 0.4))
def test_shaft_mass_sets_the_main_density_alone(mass: float) -> None:
    cue = with_shaft_mass(pool(), mass)
    assert cue.shaft_mass == pytest.approx(mass, rel=1e-12)
    wood = main_material(cue)
    assert replace(wood, rho=main_material(pool()).rho) == main_material(pool())
    assert [s.material for s in cue.segments[:2]] == [s.material for s in pool().segments[:2]]
    assert cue.segments[1].core == wood


def test_shaft_mass_includes_tip_and_precedes_other_changes() -> None:
    scene = cf.usual_scene(pool())
    weighed = with_parameters(scene, {"shaft mass": 0.112})
    tip = scene.leather_tip.mass_on(scene.shaft)
    assert weighed.shaft.shaft_mass + tip == pytest.approx(0.112, rel=1e-12)
    bored = with_parameters(scene, {"shaft mass": 0.112, "bore depth": 0.1})
    assert bored == with_parameters(weighed, {"bore depth": 0.1})
    assert bored.shaft.shaft_mass < weighed.shaft.shaft_mass
    assert not with_parameters(weighed, {"shaft material": "ash"}).shaft.shaft_mass_measured


def test_weighed_density_is_not_uncertain() -> None:
    scene = cf.usual_scene(pool())
    inputs = [
        squirt_changes(SolvedScene(each), cf.strike(each).squirt).of("squirt")
        for each in (scene, with_parameters(scene, {"shaft mass": 0.112}))
    ]
    assert inputs[0]["rho"] > 0.02
    assert {*inputs[0]} - {*inputs[1]} == {"rho"}


def test_shaft_mass_option_and_file_key_agree(tmp_path: Path) -> None:
    (csv := tmp_path / "my.csv").write_text(CSV)
    toml = tmp_path / "my.toml"
    assert call("convert", csv, toml, "--shaft-mass", "112 g")[0] == 0
    cue = cf.load(toml)
    assert isinstance(cue, cf.Cue)
    assert cue.shaft_mass_measured
    assert 0.111 < cue.shaft_mass < 0.112  # without the tip, which is not drawn
    assert as_json("modes", csv, "--shaft-mass", "112 g")["scene"]["cue"]["shaft_mass"] == pytest.approx(
        cue.shaft_mass, rel=1e-11
    )
    toml.write_text(toml.read_text().replace("shaft_mass_measured = true", f'shaft_mass = "{cue.shaft_mass!r} kg"'))
    other = cf.load(toml)
    assert isinstance(other, cf.Cue)
    assert main_material(other).rho == pytest.approx(main_material(cue).rho, rel=1e-12)


@pytest.mark.parametrize("options", [{"material": "ash"}, {"bore": "6 mm wide, 127 mm deep"}, {"ferrule": "25 mm abs"}])
def test_load_weighed_shaft_with_options_preserves_mass(options: dict[str, str], tmp_path: Path) -> None:
    bare = cf.Cue((cf.Segment(0.73, 0.0127, 0.0215, main_material(pool())),), 0.42)
    for item in (with_shaft_mass(bare, 0.112), cf.Scene(with_shaft_mass(bare, 0.112))):
        cf.save(item, tmp_path / "weighed.toml")
        loaded = cf.load(tmp_path / "weighed.toml", **options)
        cue = loaded if isinstance(loaded, cf.Cue) else loaded.cue
        assert isinstance(cue, cf.Cue)
        assert (cue.shaft_mass_measured, cue.shaft_mass) == (True, pytest.approx(0.112, rel=1e-12))
        assert len(cue.segments) > 1 or main_material(cue).E != main_material(bare).E


@pytest.mark.parametrize(("mass", "noted"), [("112 g", False), ("300 g", True), ("60 g", True)])
def test_shaft_mass_implausible_density_is_noted(mass: str, noted: bool, tmp_path: Path) -> None:
    (csv := tmp_path / "my.csv").write_text(CSV)
    status, _, err = call("strike", csv, "--body-mass", "15 oz", "--shaft-mass", mass)
    assert (status, "density of its hard maple" in err) == (0, noted)
