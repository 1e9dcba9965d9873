"""A cue alone on the command line: a game's usual stroke, its options, and leather that is too soft (regression)."""

import json
import re
from dataclasses import replace
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


def test_the_drawn_leather_is_replaced_by_a_tip_of_its_height(folder: Path) -> None:
    found = as_json("strike", "drawn.toml")
    assert (found["scene"]["effects"][0]["height"], found["scene"]["cue"]["length"]) == (5e-3, SHAFT.length)
    assert as_json("strike", "drawn.toml", "--tip-height", "4 mm")["scene"]["effects"][0]["height"] == 4e-3
    told = as_json("modes", "drawn.toml")
    assert told["scene"] == {name: found["scene"][name] for name in ("cue", "effects")}
    assert [re.findall(r"--[a-z-]+", words) for words in told["assumed"]] == [
        [option] for option in ("--game", "--tip-height", "--dome", "--leather")
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


def test_every_assumption_has_its_option(folder: Path) -> None:
    given = [word for name, (text, *_) in OPTIONS.items() for word in (name, text)]
    found, plain = as_json("strike", "shaft.toml", *given), as_json("strike", "shaft.toml")
    assert found["assumed"] == plain["assumed"][:3]  # the game and its ball
    assert {*OPTIONS} <= {*re.findall(r"--[a-z-]+", " ".join(plain["assumed"]))}
    for name, (_, value, wanted) in OPTIONS.items():
        assert value(found["scene"]) == pytest.approx(wanted, rel=1e-12), name
    changed = as_json("strike", "leather.toml", *given)  # a file that says all
    assert (changed["assumed"], changed["scene"]) == ([], found["scene"])


def test_leather_too_soft_for_the_stroke_stops_what_needs_the_contact_alone(folder: Path) -> None:
    soft = ("shaft.toml", "--leather", "1 MPa")
    report = as_json("report", *soft)
    assert report["modes"]["frequencies"] == as_json("modes", *soft)["frequencies"]
    assert "beyond the range of its law" in report["no_contact"]
    one_of_two_fails("leather.toml", "path = 'leather.E'\nvalues = ['1 MPa', '140 MPa']", "beyond the range of its law")


def test_a_shaft_that_thrust_would_buckle_is_refused_in_words_everywhere(folder: Path) -> None:
    wood = material("hard maple")
    thin = cf.Cue((cf.Segment(0.03, 8.5e-3, 8.5e-3, wood), cf.Segment(0.95, 4.5e-3, 4.5e-3, wood)), 0.4)
    scene = cf.usual_scene(thin)
    hard = replace(scene.leather, E=LEATHERS["hard"].E)
    cf.save(replace(scene, effects=(hard, *scene.effects[1:])), "struck.toml")
    fast = ("struck.toml", "--speed", "8 m/s")
    status, out, err = call("strike", *fast, "--offset", "0.5")
    assert (status, out) == (2, "")
    assert "bends the shaft by 0." in err.splitlines()[-1]
    one_of_two_fails("struck.toml", "path = 'stroke.speed'\nvalues = ['0.5 m/s', '8 m/s']", "bends the shaft by 0.")


def one_of_two_fails(scene: str, vary: str, words: str) -> None:
    """Of a sweep's two designs one has an answer, and the words say why the other has none."""
    Path("study.toml").write_text(f"scene = '{scene}'\nresponses = ['squirt(0.5)', 'frequency(1)']\n[[vary]]\n{vary}\n")
    done = json.loads(call("study", "study.toml", "--json")[1])
    assert (done["designs"], done["failed"]) == (2, 1)
    assert words in done["first_failure"]
