"""A cue alone on the command line: a game's usual stroke, the options that change it, what is typed, and what the tip
alone does (regression)."""

from __future__ import annotations

import json
import math
import re
from dataclasses import replace
from pathlib import Path

import click
import pytest

import cuefem as cf
from cuefem.cli import COMMANDS, main
from cuefem.cue.materials import LEATHERS, material
from cuefem.report.tip_table import SPEEDS
from cuefem.scene.default_scene import GAMES
from tests.helpers.command_line import as_json, call, said

SHAFT = cf.Cue((cf.Segment(0.7, 0.0118, 0.021, material("hard maple")),), 0.42)
DRAWN = cf.Cue((cf.Segment(5e-3, 0.0118, 0.0118, material("leather")), *SHAFT.segments), 0.42)
STRUCK = {"game", "tip_height", "dome", "leather", "restitution", "friction", "speed"}


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    cf.save(SHAFT, tmp_path / "shaft.toml")
    cf.save(DRAWN, tmp_path / "drawn.toml")
    cf.save(cf.Scene(SHAFT, stroke=cf.Stroke(offset=0.3)), tmp_path / "spring.toml")
    cf.save(cf.usual_scene(SHAFT), tmp_path / "leather.toml")
    cf.save(cf.Scene(cf.LumpedCue(0.5, 0.01)), tmp_path / "lumped.toml")
    monkeypatch.chdir(tmp_path)
    return tmp_path


def test_a_cue_alone_is_struck_as_in_pool_and_says_so(folder: Path) -> None:
    found = as_json("strike", "shaft.toml")
    assert found["assumed"] == [
        *("a usual stroke of pool (--game)", "ball 170 g, 57.15 mm"),
        *("a leather tip 6 mm high, put on what is drawn (--tip-height)", "its dome 9.5 mm (--dome)"),
        "its leather medium, E 140 MPa (--leather)",
        "e 0.73 of the whole cue head on: 0.63 of its tip, raised by waves along the cue (--restitution)",
        *("mu 0.7 (--friction)", "stroke 2 m/s (--speed)", "offset b/R 0.3 (--offset)"),
    ]
    squirt = found["models"]["coupled"]["squirt"]
    assert squirt == pytest.approx(cf.strike(cf.usual_scene(SHAFT)).squirt, rel=1e-12)


@pytest.mark.parametrize("game", GAMES)
def test_a_game_has_its_own_ball_and_tip(folder: Path, game: str) -> None:
    found, known = as_json("strike", "shaft.toml", "--game", game)["scene"], GAMES[game]
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
}


def test_every_assumption_has_its_option(folder: Path) -> None:
    given = [word for name, (text, *_) in OPTIONS.items() for word in (name, text)]
    found = as_json("strike", "shaft.toml", *given)
    assert found["assumed"] == ["a usual stroke of pool (--game)", "ball 170 g, 57.15 mm"]
    for name, (_, value, wanted) in OPTIONS.items():
        assert value(found["scene"]) == pytest.approx(wanted, rel=1e-12), name
    changed = as_json("strike", "leather.toml", *given)
    assert changed["assumed"] == []
    assert changed["scene"] == found["scene"]


def test_the_commands_that_strike_have_all_the_options() -> None:
    commands = {name: main.get_command(click.Context(main), name) for name in COMMANDS}
    names = {name: {p.name for p in command.params} for name, command in commands.items() if command}
    on_files = {name for name, params in names.items() if {"body_mass", "as_json"} <= params}
    others = {"modes", "convert", "designer"}
    assert {name for name in on_files if names[name] >= STRUCK} == on_files - others
    assert on_files >= {"strike", "end-mass", "effects", "cost", "report"}
    assert names["modes"] >= {"game", "tip_height", "dome", "leather"}


def test_all_start_from_the_same_scene(folder: Path) -> None:
    first, *others = (as_json(command, "drawn.toml")["scene"] for command in ("strike", "end-mass"))
    assert all(scene == first for scene in others)
    beam = as_json("modes", "drawn.toml")["scene"]
    assert beam == {name: first[name] for name in ("cue", "effects")}


def test_modes_assume_the_tip_alone(folder: Path) -> None:
    told = as_json("modes", "shaft.toml")["assumed"]
    options = ["--game", "--tip-height", "--dome", "--leather"]
    assert [re.findall(r"--[a-z-]+", words) for words in told] == [[option] for option in options]
    assert set(as_json("modes", "shaft.toml")["scene"]) == {"cue", "effects"}


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


def test_leather_too_soft_for_the_stroke_stops_what_needs_the_contact_alone(folder: Path) -> None:
    found = as_json("modes", "shaft.toml", "--leather", "1 MPa")
    assert found["frequencies"] == as_json("modes", "shaft.toml")["frequencies"]
    report = as_json("report", "shaft.toml", "--leather", "1 MPa")
    assert report["modes"]["frequencies"] == found["frequencies"]
    assert "further than its law is known" in report["no_contact"]
    assert "no end mass and no squirt: the tip's leather is compressed by" in said(
        "report", "shaft.toml", "--leather", "1 MPa"
    )


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
    assert bends in json.loads(call(*reported, "--json")[1])["no_contact"]
    one_of_two_fails(folder, "struck.toml", "path = 'stroke.speed'\nvalues = ['0.5 m/s', '8 m/s']", bends)


def test_one_leather_that_is_too_soft_does_not_stop_a_sweep(folder: Path) -> None:
    soft = "path = 'leather.E'\nvalues = ['1 MPa', '140 MPa']"
    one_of_two_fails(folder, "leather.toml", soft, "further than its law is known")


def one_of_two_fails(folder: Path, scene: str, vary: str, words: str) -> None:
    """Of a sweep's two designs one has an answer, and the words say why the other has none."""
    asked = f"scene = '{scene}'\nresponses = ['squirt(0.5)', 'frequency(1)']\n[[vary]]\n{vary}\n"
    (folder / "study.toml").write_text(asked)
    done = json.loads(call("study", "study.toml", "--json")[1])
    assert (done["designs"], done["failed"]) == (2, 1)
    assert words in done["first_failure"]


@pytest.mark.parametrize(("game", "radius"), [("pool", 28.575), ("carom", 30.75)])
@pytest.mark.parametrize(("typed", "mm"), [("8 mm", 8.0), ("-0.25 in", -6.35), ("1 cm", 10.0)])
def test_an_offset_is_a_length_over_the_radius_of_the_ball(
    folder: Path, game: str, radius: float, typed: str, mm: float
) -> None:
    scene = as_json("strike", "shaft.toml", "--game", game, "--offset", typed)["scene"]
    assert scene["stroke"]["offset"] == pytest.approx(mm / radius, rel=1e-12)


def test_the_report_tells_what_the_tip_does(folder: Path) -> None:
    found = as_json("report", "leather.toml", "--speed", "3 m/s", "--leather", "200 MPa")["tip"]
    assert found["E"] == pytest.approx(200e6)
    assert [impact["speed"] for impact in found["impacts"]] == list(SPEEDS)
    times, forces, stiffness, patches = (
        [impact[name] for impact in found["impacts"]] for name in ("contact_time", "force", "stiffness", "patch")
    )
    assert times == sorted(times, reverse=True)
    for rising in (forces, stiffness, patches):
        assert rising == sorted(rising)
    mass = 1 / (1 / 0.17 + 1 / SHAFT.mass)  # of a half-sine of that contact time, F is within a third
    assert forces[3] == pytest.approx(mass * 3.0 * math.pi / times[3], rel=1 / 3)
    assert found["tip_mass"] == cf.usual_scene(SHAFT).leather.mass(0.0118)


def test_a_speed_beyond_the_law_has_no_numbers(folder: Path) -> None:
    out = said("report", "leather.toml", "--leather", "20 MPa", "--speed", "0.5 m/s")
    assert "–: the leather would be pressed further than its law is known" in out
