"""The commands as a user meets them: tables, JSON that agrees with the library, what was assumed (regression)."""

from __future__ import annotations

import json
import math
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import pytest

import cuefem as cf
from cuefem.cli.printing import print_all
from studies.paper.closed_forms import alciatore_a31, natural_pivot_length
from tests.helpers.command_line import as_json, call, said

KIM = cf.Cue((cf.Segment(0.7, 0.012, 0.021, cf.Material(12.6e9, 0.84e9, 782.3284453057836), kappa=0.9),), 0.42)
BALL = cf.Ball()
BLOW = cf.Stroke(offset=0.3)


@pytest.fixture
def cue(tmp_path: Path) -> str:
    cf.save(KIM, tmp_path / "cue.toml")
    return str(tmp_path / "cue.toml")


@pytest.fixture
def kim(tmp_path: Path) -> str:
    """Kim's shaft with the base model's ball and tip: what a cue alone gets is tested in test_usual_strokes.py."""
    cf.save(cf.Scene(KIM, stroke=BLOW), tmp_path / "kim.toml")
    return str(tmp_path / "kim.toml")


@pytest.fixture
def scene(tmp_path: Path) -> str:
    cf.save(SCENE, tmp_path / "scene.toml")
    return str(tmp_path / "scene.toml")


SCENE = cf.Scene(
    KIM,
    cf.Ball(0.17, 0.028575),
    cf.Tip(0.8, 0.6, 1e-3),
    cf.Stroke(2.0, -0.2),
    (cf.PointMass(0.1, 0.005), cf.Elevation(math.radians(5)), cf.AxialWaves()),
)


def test_modes(kim: str) -> None:
    found = as_json("modes", kim, "--near", "250", "--count", "2")
    expected = cf.modes(KIM, 2, 250.0)
    assert found["frequencies"] == pytest.approx(expected.frequencies.tolist(), rel=1e-12)
    assert found["tip_amplitudes"] == pytest.approx(expected.shape(0.0)[0].tolist(), rel=1e-12)
    assert (found["rigid"], found["near"], found["units"]["frequencies"]) == (2, 250.0, "Hz")
    assert as_json("modes", kim, "--near", "0.25 kHz", "--count", "2")["frequencies"] == found["frequencies"]
    lowest = as_json("modes", kim)["frequencies"]
    assert lowest == pytest.approx(cf.modes(KIM).frequencies.tolist(), rel=1e-12)
    shown = said("modes", kim, "--count", "1")
    assert f"{lowest[0]:.2f} Hz" in shown
    assert "2 rigid motions" in shown


def test_end_mass(kim: str) -> None:
    found = as_json("end-mass", kim)
    assert found["contact_time"] == 2e-3
    blow = cf.Scene(KIM)
    for drive in ("stick", "velocity", "force"):
        values = found["drives"][drive]
        assert values["end_mass"] == pytest.approx(cf.end_mass(blow, drive), rel=1e-12)
        assert values["cue_end_mass"] == pytest.approx(4 * values["end_mass"], rel=1e-12)
        assert values["eps"] == pytest.approx(values["cue_end_mass"] / 0.21, rel=1e-12)
        assert values["lowest"] <= values["end_mass"] <= values["highest"] < 1.02 * values["lowest"]
    shown = said("end-mass", kim)
    assert f"{1e3 * found['drives']['stick']['end_mass']:.3f} g" in shown
    assert "head-on contact time 2 ms, e 0.75, mu 0.7" in shown


def test_the_papers_own_end_mass_is_shown_where_it_is_asked_for(kim: str) -> None:
    plain, paper = (" ".join(said("end-mass", kim, *more).split()) for more in ((), ("--paper",)))
    assert "m_c" not in plain
    assert "eps" not in plain
    assert "m_c = 4 m_e: cue end of the paper's two-part cue" in paper
    assert "eps: m_c as a part of the ball's mass" in paper


def test_strike(kim: str) -> None:
    found = as_json("strike", kim, "--offset", "0.3")["models"]
    blow = cf.Scene(KIM, stroke=BLOW)
    for name, expected in (("two-part", cf.impulse(blow)), ("coupled", cf.strike(blow))):
        model = found[name]
        assert model["squirt"] == pytest.approx(expected.squirt, rel=1e-12)
        assert model["ball_velocity"] == pytest.approx(expected.ball_velocity.tolist(), rel=1e-12)
        assert model["spin"] == pytest.approx(expected.spin, rel=1e-12)
        assert model["regime"] == expected.regime
        pivot = natural_pivot_length(0.3, expected.squirt, radius=BALL.radius)
        assert model["pivot_length"] == pytest.approx(pivot, rel=1e-12)
    a31 = alciatore_a31(0.3, mass_ratio=BALL.mass / cf.end_mass(blow, "offset"))
    assert found["A.31"]["squirt"] == pytest.approx(a31, rel=1e-12)
    assert f"{math.degrees(a31):.3f}°" in said("strike", kim)


def test_a_miscue_is_said_first(kim: str) -> None:
    caption = said("strike", kim, "--offset", "0.85").split("grip")[1]
    assert "miscue" in caption.splitlines()[0]
    assert caption.index("this stroke miscues: ") < caption.index("head-on contact time 2 ms")
    assert "miscues" not in said("strike", kim)


def test_head_on_there_is_no_pivot(kim: str) -> None:
    model = as_json("strike", kim, "--offset", "0")["models"]["two-part"]
    assert (model["squirt"], model["pivot_length"]) == (0, None)
    assert "Strike at offset b/R = 0" in said("strike", kim, "--offset", "0")


def test_a_scene_file_uses_its_own(scene: str) -> None:
    found = as_json("strike", scene)
    assert found["assumed"] == []
    assert found["scene"]["effects"][0] == {"type": "PointMass", "position": 0.1, "mass": 0.005, "rotary_inertia": 0}
    assert found["models"]["coupled"]["squirt"] == pytest.approx(cf.strike(SCENE).squirt, rel=1e-12)
    shown = said("strike", scene)
    assert "effects: PointMass (position 100 mm, mass 5 g), Elevation (angle 5 deg), AxialWaves" in shown
    assert "assumed" not in shown


def test_options_replace_what_a_scene_says(scene: str) -> None:
    told = as_json("strike", scene, "--offset", "0.1", "--friction", "0.5", "--body-mass", "14 oz")["scene"]
    assert (told["stroke"]["offset"], told["tip"]["friction"]) == (0.1, 0.5)
    assert told["cue"]["body_mass"] == 0.39689332375


def test_report(kim: str) -> None:
    found = as_json("report", kim)
    assert found["modes"]["frequencies"] == as_json("modes", kim)["frequencies"]
    assert found["end_masses"]["drives"] == as_json("end-mass", kim)["drives"]
    assert found["squirt"]["offsets"] == [0.1, 0.2, 0.3, 0.4, 0.5]
    models, one = found["squirt"]["models"], as_json("strike", kim)["models"]
    for many, single in (("coupled", "coupled"), ("two-part", "two-part"), ("A.31", "A.31")):
        for key in ("squirt", "pivot_length"):
            assert models[f"{many}, this cue"][key][2] == pytest.approx(one[single][key], rel=1e-12)
    paper = cf.Scene(cf.LumpedCue.two_part(KIM.mass, 0.012), stroke=BLOW)
    assert models["two-part, 12 g"]["squirt"][2] == pytest.approx(cf.impulse(paper).squirt, rel=1e-12)
    shown = said("report", kim)
    for title in ("Bending modes", "Squirt against the offset"):
        assert f"\n{title} " in shown


@pytest.mark.heavy
def test_a_report_says_first_that_the_stroke_miscues(kim: str, tmp_path: Path) -> None:
    shown = said("report", kim, "--offset", "0.7")
    assert 0 < shown.index("this stroke miscues: ") < shown.index("Bending modes")
    assert as_json("report", kim, "--offset", "0.7")["regime"] == "miscue"
    assert "miscue" not in said("report", kim)
    slippery = cf.Scene(KIM, tip=cf.Tip(friction=0.35), stroke=BLOW)
    cf.save(slippery, tmp_path / "slippery.toml")
    regimes = [cf.strike(cf.Scene(KIM, tip=slippery.tip, stroke=cf.Stroke(offset=b))).regime for b in (0.1, 0.4, 0.5)]
    assert regimes[0] != "miscue"
    assert regimes[1:] == ["miscue", "miscue"]
    rows = [line for line in said("report", str(tmp_path / "slippery.toml")).splitlines() if line.strip()[:3] == "0.4"]
    assert all("miscue" in row for row in rows)
    assert len(rows) == 1


def test_a_lumped_cue_has_no_modes_but_the_rest(tmp_path: Path) -> None:
    cf.save(cf.Scene(cf.LumpedCue(0.54, 0.006), stroke=BLOW), tmp_path / "lumped.toml")
    found = as_json("report", str(tmp_path / "lumped.toml"))
    assert "modes" not in found
    assert found["end_masses"]["drives"]["force"]["end_mass"] == 0.006
    assert "lumped cue, 540.0 g, end mass 6.000 g" in said("report", str(tmp_path / "lumped.toml"))


def test_a_profile_announces_its_material_and_that_nothing_is_behind_it(tmp_path: Path) -> None:
    (tmp_path / "shaft.csv").write_text("x [mm],diameter [mm]\n0,12\n700,21\n")
    shaft = str(tmp_path / "shaft.csv")
    assert as_json("modes", shaft)["assumed"][0] == "material hard maple (choose with --material)"
    assert "material hard maple" not in said("modes", shaft, "--material", "ash")
    said("convert", shaft, str(tmp_path / "shaft.toml"), "--material", "ash")
    assert cf.load(tmp_path / "shaft.toml") == cf.load(shaft, material="ash")
    words = "no mass behind the shaft (--body-mass gives it)"
    assert words in json.loads(call("strike", shaft, "--json")[1])["assumed"]  # and a remark on stderr
    whole = as_json("strike", shaft, "--body-mass", "15 oz")
    assert words not in whole["assumed"]
    bare = json.loads(call("strike", shaft, "--json")[1])["models"]["coupled"]["ball_speed"]
    assert 0.4 * whole["models"]["coupled"]["ball_speed"] < bare < 0.75 * whole["models"]["coupled"]["ball_speed"]


def test_a_scene_announces_what_it_leaves_out(cue: str, tmp_path: Path) -> None:
    scene = tmp_path / "short.toml"
    scene.write_text("game = 'kim'\ncue = 'cue.toml'\n[ball]\nmass = '170 g'\n[tip]\nfriction = 0.6\n")
    left = ["what is left out as in Kim's stroke", "ball 61.5 mm"]
    left += ["head-on contact time 2 ms; about 1 ms is usual", "e 0.75 (--restitution)"]
    left += ["stroke 1 m/s (--speed)"]
    assert as_json("end-mass", str(scene))["assumed"] == [*left, "offset b/R 0"]
    assert as_json("strike", str(scene), "--offset", "0.2")["assumed"] == left
    assert as_json("strike", str(scene))["assumed"][-1] == "offset b/R 0 (--offset)"
    scene.write_text("game = 'kim'\ncue = 'shaft.csv'\n[stroke]\noffset = 0.1\n")
    (tmp_path / "shaft.csv").write_text("x [mm],diameter [mm]\n0,12\n700,21\n")
    told = as_json("modes", str(scene))["assumed"]
    assert told[:2] == ["material hard maple", "no mass behind the shaft (--body-mass gives it)"]
    assert not [words for words in told if "ball " in words]  # which no mode depends on


SOLID = (
    'no ferrule, no bore: add them with --ferrule "25 mm melamine" and --bore "6 mm wide, 127 mm deep" or columns '
    'of those names; the drawing begins at the ferrule, and the tip is put in front (--begins "leather 6 mm" if it has '
    "the leather)"
)


def test_convert(cue: str, scene: str, tmp_path: Path) -> None:
    mesh = str(tmp_path / "cue.vtu")
    assert said("convert", cue, mesh) == f"wrote {mesh}\n"
    assert cf.load(mesh) == KIM
    assert said("convert", cue, mesh, "--force", "--body-mass", "15 oz") == f"wrote {mesh}\n"
    assert cf.load(mesh) == replace(KIM, body_mass=0.425242846875)
    (tmp_path / "shaft.csv").write_text("x [mm],diameter [mm]\n0,12\n700,21\n")
    shaft, goal = str(tmp_path / "shaft.csv"), str(tmp_path / "shaft.toml")
    left = "material hard maple (choose with --material); no mass behind the shaft (--body-mass gives it)"
    assert said("convert", shaft, goal) == f"assumed: {left}; {SOLID}\nwrote {goal}\n"
    told = said("convert", shaft, goal, "--body-mass", "420 g", "--material", "ash", "--force")
    assert told == f"assumed: {SOLID}\nwrote {goal}\n"
    assert cf.load(goal).body_mass == 0.42
    said("convert", scene, goal, "--body-mass", "0.4 kg", "--force")
    assert cf.load(goal) == replace(SCENE, cue=replace(KIM, body_mass=0.4))


def test_the_package_of_commands_runs_as_a_program() -> None:
    done = subprocess.run([sys.executable, "-m", "cuefem.cli", "--version"], capture_output=True, text=True)
    assert (done.returncode, done.stderr) == (0, "")
    assert done.stdout.startswith("cuefem, version ")


def test_colons_in_a_name_are_no_emoji(capsys: pytest.CaptureFixture[str]) -> None:
    print_all([":smile: cue"])
    assert capsys.readouterr().out == ":smile: cue\n"
