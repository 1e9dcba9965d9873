"""A cue alone on the command line: a game's usual stroke, the options that change it, and what is said (regression)."""

from __future__ import annotations

import json
import re
from dataclasses import replace
from pathlib import Path
from typing import Any

import click
import pytest

import cuefem as cf
from cuefem.cli import COMMANDS, main
from cuefem.games import GAMES
from cuefem.materials import LEATHERS, material
from tests.helpers.command_line import call
from tests.helpers.refusals import untouched

SHAFT = cf.Cue((cf.Segment(0.7, 0.0118, 0.021, material("hard maple")),), 0.42)
DRAWN = cf.Cue((cf.Segment(5e-3, 0.0118, 0.0118, material("leather")), *SHAFT.segments), 0.42)
STRUCK = {"game", "ball", "tip_height", "dome", "leather", "restitution", "friction", "speed", "contact_time"}


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    cf.save(SHAFT, tmp_path / "shaft.toml")
    cf.save(DRAWN, tmp_path / "drawn.toml")
    cf.save(cf.Scene(SHAFT, stroke=cf.Stroke(offset=0.3)), tmp_path / "spring.toml")
    cf.save(cf.usual_scene(SHAFT), tmp_path / "leather.toml")
    cf.save(cf.Scene(cf.LumpedCue(0.5, 0.01)), tmp_path / "lumped.toml")
    monkeypatch.chdir(tmp_path)
    return tmp_path


def as_json(*arguments: str) -> Any:
    status, out, err = call(*arguments, "--json")
    assert (status, err) == (0, "")
    return json.loads(out)


def test_a_cue_alone_is_struck_as_in_pool_and_says_so(folder: Path) -> None:
    found = as_json("strike", "shaft.toml")
    assert found["assumed"] == [
        *("a usual stroke of pool (--game)", "ball 170 g, 57.15 mm (--ball)"),
        *("a leather tip 6 mm high, put on what is drawn (--tip-height)", "its dome 9.5 mm (--dome)"),
        "its leather medium, E 140 MPa (--leather)",
        "e 0.73 of the whole cue head on: 0.63 of its tip, raised by waves along the cue (--restitution)",
        *("mu 0.7 (--friction)", "stroke 2 m/s (--speed)", "offset b/R 0.3 (--offset)"),
    ]
    squirt = found["models"]["coupled"]["squirt"]
    assert squirt == pytest.approx(cf.strike(cf.usual_scene(SHAFT)).squirt, rel=1e-12)


def test_the_tip_tells_how_the_whole_cue_rebounds() -> None:
    drawing = Path(__file__).parents[2] / GAMES["pool"].cue
    struck = as_json("tip", str(drawing))["struck"]
    assert struck["rebound"] == pytest.approx(GAMES["pool"].restitution, abs=1e-4)
    out = " ".join(call("tip", str(drawing))[1].split())
    assert "the whole cue rebounds with 0.730" in out
    timed = as_json("tip", str(drawing), "--contact-time", "1.2 ms")["struck"]
    assert timed["contact_time"] == pytest.approx(1.2e-3, rel=1e-6)


@pytest.mark.parametrize("game", GAMES)
def test_a_game_has_its_own_ball_and_tip(folder: Path, game: str) -> None:
    found, known = as_json("tip", "shaft.toml", "--game", game)["scene"], GAMES[game]
    assert (found["ball"]["mass"], found["ball"]["radius"]) == (known.ball.mass, known.ball.radius)
    assert found["stroke"] == {"speed": known.speed, "offset": known.offset}
    assert (found["effects"][0]["height"], found["effects"][0]["dome_radius"]) == (known.height, known.dome_radius)


def test_the_drawn_leather_is_replaced_by_a_tip_of_its_height(folder: Path) -> None:
    found = as_json("end-mass", "drawn.toml")
    assert found["scene"]["effects"][0]["height"] == 5e-3
    assert found["scene"]["cue"]["length"] == SHAFT.length
    assert "the drawn leather, 5 mm, taken as a leather tip of that height (--tip-height)" in found["assumed"]
    lower = as_json("end-mass", "drawn.toml", "--tip-height", "4 mm")
    assert lower["scene"]["effects"][0]["height"] == 4e-3
    assert "the drawn leather, 5 mm, left out: the leather tip stands in its place (--tip-height)" in lower["assumed"]


OPTIONS = {
    "--tip-height": ("4 mm", lambda scene: scene["effects"][0]["height"], 4e-3),
    "--dome": ("nickel", lambda scene: scene["effects"][0]["dome_radius"], 10.605e-3),
    "--leather": ("hard", lambda scene: scene["effects"][0]["E"], LEATHERS["hard"].E),
    "--restitution": ("0.8", lambda scene: scene["tip"]["restitution"], 0.8),
    "--friction": ("0.6", lambda scene: scene["tip"]["friction"], 0.6),
    "--speed": ("3 m/s", lambda scene: scene["stroke"]["speed"], 3.0),
    "--offset": ("0.2", lambda scene: scene["stroke"]["offset"], 0.2),
    "--ball": ("carom", lambda scene: scene["ball"]["mass"], 0.21),
}


def test_every_assumption_has_its_option(folder: Path) -> None:
    given = [word for name, (text, *_) in OPTIONS.items() for word in (name, text)]
    found = as_json("strike", "shaft.toml", *given)
    assert found["assumed"] == ["a usual stroke of pool (--game)"]
    for name, (_, value, wanted) in OPTIONS.items():
        assert value(found["scene"]) == pytest.approx(wanted, rel=1e-12), name
    changed = as_json("strike", "leather.toml", *given)
    assert changed["assumed"] == []
    assert changed["scene"] == found["scene"]
    assert as_json("tip", "shaft.toml", "--leather", "200 MPa", "--dome", "flat")["E"] == pytest.approx(200e6)


def test_the_commands_that_strike_have_all_the_options(folder: Path) -> None:
    context = click.Context(main)
    commands = {name: main.get_command(context, name) for name in COMMANDS}
    names = {name: {p.name for p in command.params} for name, command in commands.items() if command}
    on_files = {name for name, params in names.items() if {"body_mass", "as_json"} <= params}
    assert {name for name in on_files if names[name] >= STRUCK} == on_files - {
        "modes",
        "tip",
        "side",
        "weigh",
        "convert",
    }
    assert on_files >= {"strike", "end-mass", "effects", "cost", "report", "animate", "tap"}
    assert names["modes"] >= {"game", "tip_height", "dome", "leather"}
    assert names["tip"] >= {"game", "tip_height", "dome", "leather", "restitution", "speed"}


def test_all_start_from_the_same_scene(folder: Path) -> None:
    first, *others = (as_json(command, "drawn.toml")["scene"] for command in ("strike", "end-mass", "tip"))
    assert all(scene == first for scene in others)
    beam = as_json("modes", "drawn.toml")["scene"]
    assert beam == {name: first[name] for name in ("cue", "effects")}


def test_modes_assume_the_tip_alone(folder: Path) -> None:
    told = as_json("modes", "shaft.toml")["assumed"]
    assert [re.findall(r"--[a-z-]+", words) for words in told] == [
        ["--game"],
        ["--tip-height"],
        ["--dome"],
        ["--leather"],
    ]
    assert set(as_json("modes", "shaft.toml")["scene"]) == {"cue", "effects"}


def test_a_contact_time_takes_the_spring_and_the_cue_as_drawn(folder: Path) -> None:
    found = as_json("strike", "drawn.toml", "--contact-time", "1 ms", "--ball", "carom")
    spring = cf.Scene(DRAWN, cf.Ball(), cf.Tip(0.73, 0.7, 1e-3), cf.Stroke(2.0, 0.3))
    assert found["scene"]["effects"] == []
    assert found["models"]["coupled"]["squirt"] == pytest.approx(cf.strike(spring).squirt, rel=1e-12)
    assert not [words for words in found["assumed"] if "leather" in words]


@pytest.mark.heavy
def test_a_page_names_what_was_assumed(folder: Path) -> None:
    assert call("report", "shaft.toml", "-o", "page.html")[::2] == (0, "")
    page = (folder / "page.html").read_text(encoding="utf-8")
    plain = re.sub(r"\s+", " ", re.sub(r"<[^>]*>", "", page))
    for words in as_json("end-mass", "shaft.toml")["assumed"]:
        assert words in plain


def test_a_file_that_was_saved_says_all_of_it(folder: Path) -> None:
    """What the last version saved is explicit: no game touches it."""
    assert as_json("end-mass", "leather.toml")["assumed"] == []
    assert as_json("end-mass", "spring.toml")["scene"]["ball"]["mass"] == cf.Ball().mass
    assert cf.load(folder / "leather.toml") == cf.usual_scene(SHAFT)


@pytest.mark.parametrize(
    ("command", "message"),
    [
        ("strike spring.toml --game pool", "--game: must be left out: FILE is a scene"),
        ("strike spring.toml --dome dime", "--dome: must be left out: the scene has no LeatherTip among its effects"),
        ("strike lumped.toml --leather soft", "--leather: must be left out: the scene has no LeatherTip"),
        ("strike leather.toml --contact-time 1ms", "--contact-time: must be left out beside LeatherTip, from which it"),
        ("strike shaft.toml --contact-time 1ms --dome dime", "--dome: must be left out beside --contact-time"),
        ("strike shaft.toml --dome penny", 'such as "12 mm", or "dime", "nickel", "flat"; got \'penny\''),
        ("strike shaft.toml --leather sofd", "\"le professional\"; got 'sofd'"),
        ("strike shaft.toml --restitution 2", "shaft.toml: --restitution: must be 0 to 1; got 2.0"),
        (
            "strike shaft.toml --restitution 0.05",
            "Tip.restitution must be in [0.1, 1] beside LeatherTip; got 0.05: leather",
        ),
        ("strike shaft.toml --friction -1", "shaft.toml: --friction: must be 0 or more; got -1.0"),
        ("strike shaft.toml --speed fast", "cuefem: shaft.toml: --speed: must be a speed with its unit, such as"),
        ("tip shaft.toml --speed fast", "cuefem: shaft.toml: --speed: must be a speed with its unit, such as"),
        ("strike shaft.toml --tip-height 40mm", "got 40 mm (--tip-height, --dome, --contact-time change it)"),
        ("modes shaft.toml --tip-height 40mm", "got 40 mm (--tip-height, --dome change it)"),
        ("strike leather.toml --tip-height 40mm", " mm high; got 40 mm"),
        ("strike shaft.toml --leather 1MPa", "further than its law is known"),
        ("strike shaft.toml --leather 1MPa", "(--tip-height, --leather, --speed)"),
    ],
)
def test_refusals(folder: Path, command: str, message: str) -> None:
    untouched(folder, message, *command.split())


def test_leather_too_soft_for_the_stroke_stops_what_needs_the_contact_alone(folder: Path) -> None:
    found = as_json("modes", "shaft.toml", "--leather", "1 MPa")
    assert found["frequencies"] == as_json("modes", "shaft.toml")["frequencies"]
    report = as_json("report", "shaft.toml", "--leather", "1 MPa")
    assert report["modes"]["frequencies"] == found["frequencies"]
    assert "further than its law is known" in report["no_contact"]
    status, out, err = call("report", "shaft.toml", "--leather", "1 MPa")
    assert (status, err) == (0, "")
    assert "Bending modes" in out
    assert "no end mass and no squirt: the tip's leather is compressed by" in out


def test_a_shaft_that_thrust_would_buckle_is_refused_in_words_everywhere(folder: Path) -> None:
    wood = material("hard maple")
    front, thin = cf.Segment(0.03, 8.5e-3, 8.5e-3, wood), cf.Segment(0.95, 4.5e-3, 4.5e-3, wood)
    cf.save(cf.Cue((front, thin), 0.4), folder / "thin.toml")
    scene = cf.usual_scene(cf.Cue((front, thin), 0.4))
    leather = replace(scene.leather, E=LEATHERS["hard"].E)
    cf.save(replace(scene, effects=(leather, *scene.effects[1:])), folder / "struck.toml")
    bends = "bends the shaft by 0."
    for command in ("strike", "effects", "cost"):
        status, out, err = call(command, "thin.toml", "--leather", "hard", "--speed", "8 m/s", "--offset", "0.5")
        assert (status, out) == (2, "")
        assert bends in err.splitlines()[-1]
    reported = ("report", "thin.toml", "--leather", "hard", "--speed", "8 m/s")
    status, out, _ = call(*reported)
    assert status == 0
    assert "Bending modes" in out
    assert "no end mass and no squirt: the thrust of" in out
    assert bends in json.loads(call(*reported, "--json")[1])["no_contact"]
    study = "scene = 'struck.toml'\nresponses = ['squirt(0.5)', 'frequency(1)']\n"
    (folder / "study.toml").write_text(f"{study}[[vary]]\npath = 'stroke.speed'\nvalues = ['0.5 m/s', '8 m/s']\n")
    done = json.loads(call("sweep", "study.toml", "--json")[1])
    assert (done["designs"], done["failed"]) == (2, 1)
    assert bends in done["first_failure"]


def test_one_leather_that_is_too_soft_does_not_stop_a_sweep(folder: Path) -> None:
    scene = cf.usual_scene(SHAFT)
    cf.save(replace(scene, effects=(replace(scene.leather, E=1e6),)), folder / "soft.toml")
    study = "scene = 'soft.toml'\nresponses = ['squirt(0.3)', 'frequency(1)']\n"
    study += "[[vary]]\npath = 'effects[0].E'\nvalues = ['1 MPa', '140 MPa']\n"
    (folder / "study.toml").write_text(study)
    done = as_json("sweep", "study.toml")
    assert (done["designs"], done["failed"]) == (2, 1)
    assert "further than its law is known" in done["first_failure"]
