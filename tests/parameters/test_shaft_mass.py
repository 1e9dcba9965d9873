"""The mass of a shaft determines the density of its wood, which is then not uncertain (properties)."""

from dataclasses import replace
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

import cuefem as cf
from cuefem.designs.study_file import load_study
from cuefem.parameters.parts import main_material, with_shaft_mass
from cuefem.parameters.scene_changes import with_parameters
from tests.helpers.command_line import as_json, call
from tests.helpers.cues import pool
from tests.helpers.examples import examples

VARIED = '[[vary]]\npath = "offset"\nvalues = [0.3]'
FERRULED = ("--ferrule", "1 in melamine", "--body-mass", "15 oz")
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


def weighed(folder: Path, *options: str) -> Path:
    """A drawn shaft that was weighed when it was converted."""
    csv, toml = folder / "my.csv", folder / "weighed.toml"
    csv.write_text(CSV)
    assert call("convert", csv, toml, "--shaft-mass", "112 g", *options)[0] == 0
    return toml


def test_shaft_mass_option_and_file_key_agree(tmp_path: Path) -> None:
    toml = weighed(tmp_path)
    cue = cf.load_cue(toml)
    assert cue.shaft_mass_measured
    assert 0.111 < cue.shaft_mass < 0.112  # without the tip, which is not drawn
    answer = as_json("modes", tmp_path / "my.csv", "--shaft-mass", "112 g")
    assert answer["scene"]["cue"]["shaft_mass"] == pytest.approx(cue.shaft_mass, rel=1e-11)
    toml.write_text(toml.read_text().replace("shaft_mass_measured = true", f'shaft_mass = "{cue.shaft_mass!r} kg"'))
    assert main_material(cf.load_cue(toml)).rho == pytest.approx(main_material(cue).rho, rel=1e-12)


@pytest.mark.parametrize(
    "options",
    [{"bore": "8 mm wide, 127 mm deep"}, {"ferrule": "15 mm abs"}, {"material": "hard maple"}, {"body_mass": "16 oz"}],
    ids=str,
)
def test_options_keep_the_density_of_a_weighed_shaft_at_every_door(options: dict[str, str], tmp_path: Path) -> None:
    file = weighed(tmp_path, *FERRULED)
    density = main_material(cf.load_cue(file)).rho
    given = [text for key, value in options.items() for text in (f"--{key.replace('_', '-')}", value)]
    assert call("convert", file, tmp_path / "converted.toml", *given)[0] == 0
    study = tmp_path / "study.toml"
    lines = [f'{key} = "{value}"' for key, value in options.items()]
    study.write_text("\n".join(['scene = "weighed.toml"', 'responses = ["squirt"]', *lines, VARIED]))
    doors = {
        "convert": cf.load_cue(tmp_path / "converted.toml"),
        "strike": cf.load_cue(file, **options),
        "study": load_study(study).base.shaft,
    }
    for door, cue in doors.items():
        assert cue.shaft_mass_measured, door
        assert main_material(cue).rho == pytest.approx(density, rel=1e-9), door


def test_report_says_what_options_replace_and_how_a_shaft_was_weighed(tmp_path: Path) -> None:
    file, bore, ferrule = weighed(tmp_path, *FERRULED), "8 mm wide, 127 mm deep", "15 mm abs"

    def notes(*options: str) -> list[str]:
        return [*as_json("strike", file, *options)["assumptions"]]

    assert f"the ferrule in the file is replaced: {ferrule}" in notes("--ferrule", ferrule)
    both = notes("--ferrule", ferrule, "--bore", bore, "--shaft-mass", "110 g")
    assert "the shaft was weighed with its tip, this ferrule, this bore" in both
    assert any("the weighed wood is replaced" in note for note in notes("--material", "ash"))
