"""What is handed to pooltool: its own squirt from our number, and the JSON's words (verification).

pooltool 0.6.0 pins a development build of its graphics that PyPI has not, so that pip takes 0.3.3, which knows no end
mass: no extra `cuefem[pooltool]` can be. .ci/pooltool makes an environment that has it, and POOLTOOL_PYTHON names it.
"""

from __future__ import annotations

import json
import math
import os
import subprocess
import sys
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import cuefem as cf
from cuefem.endmass.drives import DEFINITIONS
from cuefem.report.handover_table import NICKEL, POOLTOOL, POOLTOOL_LINE, handover_sheet, pooltool_record
from cuefem.squirt import alciatore_a31, alciatore_a31_mass_ratio
from tests.helpers.command_line import as_json, said

KIM = cf.Cue((cf.Segment(0.7, 0.012, 0.021, cf.Material(12.6e9, 0.84e9, 782.3284453057836), kappa=0.9),), 0.42)
SCENE = cf.Scene(KIM, cf.Ball(0.17, 0.028575), cf.Tip(0.75, 0.7, 1e-3), cf.Stroke(2.0, 0.3), (cf.TipDome(0.0095),))
LETS_GO = replace(SCENE, tip=cf.Tip(0.75, 0.4), effects=(cf.LeatherTip(0.006, 0.0095, 140e6),))
# CueSpecs of pooltool 0.6.0, in its order
CUE_SPECS = ("brand", "M", "length", "tip_radius", "shaft_radius_at_tip", "shaft_radius_at_butt", "end_mass")
OF_A_SHAFT = {*CUE_SPECS} - {"shaft_radius_at_butt"}  # a file that draws the shaft alone


def pooltool_squirt(mass: float, end_mass: float, a: float) -> float:
    """Its get_squirt_angle, 0.6.0, written again: alpha, rad, positive to the left; a positive on the left."""
    A = 1 - a**2
    return -math.atan2(2.5 * a * math.sqrt(A), 1 + mass / end_mass + 2.5 * A)


def handed(*arguments: object) -> Any:
    return as_json("strike", *arguments, "--for", "pooltool")


@pytest.fixture
def scene(tmp_path: Path) -> Path:
    cf.save(SCENE, tmp_path / "scene.toml")
    return tmp_path / "scene.toml"


@pytest.mark.parametrize("side", [-1, 1])
def test_the_inverse_of_a31(side: int) -> None:
    offset = side * np.array([0.01, 0.1, 0.3, 0.5, 0.9])
    ratio = np.geomspace(1e-3, 1e3, 13)[:, None]
    squirt = alciatore_a31(offset, mass_ratio=ratio, inertia=0.37)
    np.testing.assert_allclose(
        alciatore_a31_mass_ratio(offset, squirt, inertia=0.37), np.broadcast_to(ratio, squirt.shape), rtol=1e-10
    )


@pytest.mark.parametrize("offset", [-0.3, 0.1, 0.5])
def test_their_formula_turns_the_ball_as_our_strike_does(offset: float) -> None:
    struck = replace(SCENE, stroke=replace(SCENE.stroke, offset=offset))
    record = pooltool_record("kim", struck)
    against = record["by_offset"]
    for mass in (record["CueSpecs"]["end_mass"], against["end_mass"][against["offsets"].index(abs(offset))]):
        alpha = pooltool_squirt(record["BallParams"]["m"], mass, a=offset)
        assert -alpha == pytest.approx(cf.strike(struck).squirt, rel=1e-12)
    assert not against["speed_matters"]
    for row in against["end_mass_at_speeds"]:
        assert row == pytest.approx(against["end_mass"], rel=1e-9)


HANDED = ("A.31", *DEFINITIONS)


@pytest.mark.parametrize("drive", HANDED)
def test_each_end_mass_and_its_squirt(drive: Any) -> None:
    found = pooltool_record("kim", SCENE, drive=drive)
    mass, squirt = found["CueSpecs"]["end_mass"], found["squirt"]
    if drive != "A.31":
        assert mass == pytest.approx(cf.end_mass(SCENE, drive), rel=1e-12)
    assert found["end_mass"]["drive"] == drive
    assert set(found["end_mass"]["others"]) == set(HANDED) - {drive}
    for offset, ours, theirs in zip(squirt["offsets"], squirt["coupled"], squirt["pooltool"], strict=True):
        assert theirs == pytest.approx(-pooltool_squirt(0.17, mass, offset), rel=1e-12)
        struck = replace(SCENE, stroke=replace(SCENE.stroke, offset=offset))
        assert ours == pytest.approx(cf.strike(struck).squirt, rel=1e-12)


def test_the_json_of_the_command(scene: Path, tmp_path: Path) -> None:
    found = handed(scene)
    assert set(found["CueSpecs"]) == OF_A_SHAFT
    specs = found["CueSpecs"]
    expected = {"M": KIM.mass, "length": 1.4732, "tip_radius": 0.0095, "shaft_radius_at_tip": 0.006}
    assert {name: specs[name] for name in expected} == expected
    assert specs["brand"] == "scene"
    assert (found["version"], found["line"]) == (POOLTOOL, POOLTOOL_LINE)
    assert found["end_mass"]["drive"] == "A.31"
    assert found["end_mass"]["contact_time"] == 1e-3
    assert (found["units"]["end_mass"], found["units"]["length"]) == ("kg", "m")
    assert "alpha(a) = -squirt" in found["signs"]
    told = said("strike", scene, "--for", "pooltool", "-o", tmp_path / "cue.json")
    assert told.splitlines()[0] == f"wrote {tmp_path / 'cue.json'}"
    assert "the speed drops out" in told
    assert json.loads((tmp_path / "cue.json").read_text(encoding="utf-8")) == found
    assert handed(scene, "-o", tmp_path / "again.json") == found
    assert (tmp_path / "again.json").read_bytes() == (tmp_path / "cue.json").read_bytes()
    told = said("strike", scene, "--for", "pooltool")
    assert f"handed over: end mass {1e3 * specs['end_mass']:.3f} g by A.31, at b/R 0.3" in told
    assert handed(scene, "--length", "57 in")["CueSpecs"]["length"] == pytest.approx(1.4478, rel=1e-12)


def test_how_the_speed_matters_with_leather() -> None:
    leather = replace(LETS_GO, tip=cf.Tip(0.75, 0.7))
    record = pooltool_record("kim", leather)
    found = record["by_offset"]
    assert found["speeds"] == [1.0, 2.0, 4.0]
    assert found["speed_matters"]
    assert found["words"] in record["notes"]
    assert "from 1 to 4 m/s" in found["words"]
    heads = list(handover_sheet(record).head)
    assert heads == ["offset b/R", *(f"end mass at {speed} m/s" for speed in (1, 2, 4)), "squirt at 2 m/s"]
    for speed, row in zip(found["speeds"], found["end_mass_at_speeds"], strict=True):
        struck = cf.strike(replace(leather, stroke=cf.Stroke(speed, 0.3)))
        assert -pooltool_squirt(0.17, row[2], a=0.3) == pytest.approx(struck.squirt, rel=1e-9)


def test_a_miscue_has_no_end_mass() -> None:
    """Beyond the cone of friction, b/R 0.37 at mu 0.4, leather holds at first only: the regime says "stick"."""
    slippery = replace(SCENE, tip=cf.Tip(0.75, 0.3, 1e-3), stroke=cf.Stroke(2.0, 0.1))
    record = pooltool_record("kim", slippery)
    missed = [regime == "miscue" for regime in record["squirt"]["regimes"]]
    assert any(missed)
    assert [mass is None for mass in record["by_offset"]["end_mass"]] == missed
    record = pooltool_record("kim", LETS_GO)
    assert record["squirt"]["regimes"] == ["stick"] * 5
    assert record["squirt"]["grips"][:3] == ["stick"] * 3
    assert record["squirt"]["grips"][4] == "lets go"
    assert [mass is None for mass in record["by_offset"]["end_mass"]][::2] == [False, False, True]
    with pytest.raises(ValueError, match=r"the stroke miscues at offset 0\.5; got no end mass"):
        pooltool_record("kim", replace(LETS_GO, stroke=cf.Stroke(2.0, 0.5)))


def test_what_a_drawing_leaves_out() -> None:
    whole = pooltool_record("drawn whole", replace(SCENE, cue=replace(KIM, body_mass=0.0)))["CueSpecs"]
    assert (whole["length"], whole["shaft_radius_at_butt"]) == (0.7, 0.0105)
    lumped = replace(SCENE, cue=cf.LumpedCue(0.54, 0.005), effects=())
    record = pooltool_record("two parts", lumped, drive="stick")
    assert record["CueSpecs"] == {"brand": "two parts", "M": 0.54, "tip_radius": NICKEL, "end_mass": 0.005}
    assert any("nickel" in note for note in record["notes"])


def test_a_table_for_any_other_simulator(tmp_path: Path) -> None:
    """Every row turns the ball by its own definition as `cf.strike` does; CSV and JSON hold the same numbers."""
    cf.save(LETS_GO, tmp_path / "leather.toml")
    ranges = ("--offsets", "-0.3 to 0.5 in 9", "--speeds", "1 m/s, 4 m/s")
    for name in ("table.csv", "table.json"):
        told = said("strike", tmp_path / "leather.toml", "--for", "table", *ranges, "-o", tmp_path / name)
        assert told == f"wrote {tmp_path / name}\n"
    record = json.loads((tmp_path / "table.json").read_text(encoding="utf-8"))
    assert record["units"] == {"speed": "m/s", "offset": "", "ball_mass": "kg", "end_mass": "kg", "squirt": "rad"}
    lines = (tmp_path / "table.csv").read_text(encoding="utf-8").splitlines()
    assert lines[:2] == [f"# {record['definition']}", f"# {record['signs']}"]
    assert lines[3] == "speed [m/s],offset [1],end_mass [kg],squirt [rad],miscue"
    names = ("speed", "offset", "end_mass", "squirt")
    assert [line.split(",") for line in lines[4:]] == [
        ["" if row[name] is None else repr(row[name]) for name in names] + [str(int(row["miscue"]))]
        for row in record["rows"]
    ]
    assert {row["miscue"] for row in record["rows"]} == {False, True}
    for row in record["rows"]:
        struck = cf.strike(replace(LETS_GO, stroke=cf.Stroke(row["speed"], row["offset"])))
        assert row["squirt"] == pytest.approx(struck.squirt, rel=1e-9, abs=1e-15)
        assert (row["end_mass"] is None) == (row["miscue"] or abs(row["offset"]) < 1e-12)
        if row["end_mass"] is not None:
            alpha = pooltool_squirt(record["ball_mass"], row["end_mass"], row["offset"])
            assert -alpha == pytest.approx(struck.squirt, rel=1e-9)


IN_POOLTOOL = """
import json, sys
import pooltool as pt
from pooltool.physics.resolve.stick_ball.instantaneous_point import InstantaneousPoint
from pooltool.physics.resolve.stick_ball.squirt import get_squirt_angle

answers = []
for offset, found in json.load(sys.stdin):
    specs = pt.objects.CueSpecs(**found["CueSpecs"])
    cue = pt.Cue(V0=2.0, phi=90.0, a=offset, b=0.0, specs=specs)
    ball = pt.Ball("cue", params=pt.BallParams(**found["BallParams"]))
    alpha = get_squirt_angle(ball.params.m, specs.end_mass, offset, 1.0)
    _, after = InstantaneousPoint().resolve(cue, ball)
    answers.append((alpha, after.state.rvw[1].tolist(), specs.length))
print(json.dumps([pt.__version__, answers]))
"""


def pooltool_python() -> str:
    """A Python that has pooltool: this one, or that of its own environment, whose pins are not ours."""
    has_it = "from importlib.util import find_spec; raise SystemExit(find_spec('pooltool') is None)"
    for python in (sys.executable, os.environ.get("POOLTOOL_PYTHON", "")):
        if python and subprocess.run([python, "-c", has_it], capture_output=True).returncode == 0:
            return python
    pytest.skip("no pooltool here: POOLTOOL_PYTHON names the Python of an environment that has it")


def test_a_ball_that_pooltool_strikes(scene: Path) -> None:
    """pooltool reads what is handed over; its own stroke leaves its aim by our squirt, away from the struck side."""
    python = pooltool_python()
    offsets = (-0.4, 0.1, 0.3, 0.5)
    sent = json.dumps([(offset, handed(scene, f"--offset={offset}")) for offset in offsets])
    done = subprocess.run([python, "-c", IN_POOLTOOL], input=sent, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    version, answers = json.loads(done.stdout)
    assert version == POOLTOOL
    for offset, (alpha, (x, y, _), length) in zip(offsets, answers, strict=True):
        ours = cf.strike(replace(SCENE, stroke=replace(SCENE.stroke, offset=offset))).squirt
        assert -alpha == pytest.approx(ours, rel=1e-12)
        assert math.atan2(x, y) == pytest.approx(ours, rel=1e-9)  # aimed along y, struck on the left
        assert length == 1.4732


@pytest.mark.heavy
def test_a_raised_cue_is_remarked() -> None:
    raised = replace(SCENE, effects=(cf.Elevation(0.1),))
    note = "the cue is raised by 5.73°: its end mass includes the table's push, which pooltool's squirt does not know"
    assert note in pooltool_record("raised", raised)["notes"]
    assert not any("raised" in note for note in pooltool_record("level", SCENE)["notes"])


@pytest.mark.heavy
def test_a31_with_the_stick_end_mass_turns_the_ball_too_little() -> None:
    """The module's figures, and why the end mass handed over is another."""
    less: list[float] = []
    for path in sorted((Path(__file__).parents[2] / "studies" / "scenes").glob("*.toml")):
        squirt = pooltool_record(path.stem, cf.load(path), drive="stick")["squirt"]
        less += (1 - np.array(squirt["pooltool"]) / squirt["coupled"]).tolist()
    assert [round(min(less), 2), round(max(less), 2)] == [0.11, 0.42]
