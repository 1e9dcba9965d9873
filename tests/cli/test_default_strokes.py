"""Commands on a drawing: default stroke, an option for each assumption, results without contact (regression)."""

import json
import re
from pathlib import Path

import pytest

import cuefem as cf
from cuefem.cue.materials import LEATHERS, material
from tests.helpers.command_line import as_json, call

SHAFT = cf.Cue((cf.Segment(0.7, 0.0118, 0.021, material("hard maple")),), 0.42)
DRAWN = cf.Cue((cf.Segment(5e-3, 0.0118, 0.0118, material("leather")), *SHAFT.segments), 0.42)


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    cf.save(SHAFT, tmp_path / "shaft.toml")
    cf.save(DRAWN, tmp_path / "drawn.toml")
    cf.save(cf.usual_scene(SHAFT), tmp_path / "leather.toml")
    monkeypatch.chdir(tmp_path)
    return tmp_path


def test_drawn_leather_becomes_leather_tip_of_its_height(folder: Path) -> None:
    result = as_json("strike", "drawn.toml")
    assert (result["scene"]["effects"][0]["height"], result["scene"]["cue"]["length"]) == (5e-3, SHAFT.length)
    assert as_json("strike", "drawn.toml", "--tip-height", "4 mm")["scene"]["effects"][0]["height"] == 4e-3
    modes = as_json("modes", "drawn.toml", "--game", "pool")
    assert modes["scene"] == {name: result["scene"][name] for name in ("cue", "effects")}
    assert [re.findall(r"--[a-z-]+", line) for line in modes["assumptions"]] == [
        [option] for option in ("--tip-height", "--dome", "--leather")
    ]


OPTIONS = {
    "--tip-height": ("4 mm", lambda scene: scene["effects"][0]["height"], 4e-3),
    "--dome": ("nickel", lambda scene: scene["effects"][0]["dome_radius"], 10.605e-3),
    "--leather": ("hard", lambda scene: scene["effects"][0]["E"], LEATHERS["hard"].E),
    "--restitution": ("0.8", lambda scene: scene["tip"]["restitution"], 0.8),
    "--friction": ("0.6", lambda scene: scene["tip"]["friction"], 0.6),
    "--speed": ("3 m/s", lambda scene: scene["stroke"]["speed"], 3.0),
    "--offset": ("0.2", lambda scene: scene["stroke"]["offset"], 0.2),
}


def test_every_assumption_has_an_option(folder: Path) -> None:
    arguments = [word for name, (text, *_) in OPTIONS.items() for word in (name, text)]
    result, plain = as_json("strike", "shaft.toml", *arguments), as_json("strike", "shaft.toml")
    assert result["assumptions"] == plain["assumptions"][:3]  # the game and its ball
    assert {*OPTIONS} <= {*re.findall(r"--[a-z-]+", " ".join(plain["assumptions"]))}
    for name, (_, value, expected) in OPTIONS.items():
        assert value(result["scene"]) == pytest.approx(expected, rel=1e-12), name
    changed = as_json("strike", "leather.toml", *arguments)  # a complete scene
    assert (changed["assumptions"], changed["scene"]) == ([], result["scene"])


def test_report_leather_too_soft_omits_contact_results(folder: Path) -> None:
    soft = ("shaft.toml", "--leather", "1 MPa")
    status, out, err = call("report", *soft, "--json")
    report = json.loads(out)
    assert status == 2
    assert "(--tip-height, --leather, --speed)" in err
    assert report["modes"]["frequencies"] == as_json("modes", *soft)["frequencies"]
    assert "exceeds the valid range" in report["no_contact"]
    assert_one_fails("leather.toml", "path = 'leather.E'\nvalues = ['1 MPa', '140 MPa']", "exceeds the valid range")


def assert_one_fails(scene: str, vary: str, message: str) -> None:
    """One of a sweep's two designs fails, and its reason contains ``message``."""
    Path("study.toml").write_text(f"scene = '{scene}'\nresponses = ['squirt(0.5)', 'frequency(1)']\n[[vary]]\n{vary}\n")
    record = json.loads(call("study", "study.toml", "--json")[1])
    assert (record["designs"], record["lacking"]["squirt(0.5)"]) == (2, 1)
    assert message in record["first_failure"]
