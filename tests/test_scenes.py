"""The ready scenes of studies/scenes, and what a scene file means to the commands (regression)."""

from __future__ import annotations

import json
import math
import re
import tomllib
from pathlib import Path
from typing import Any

import pytest

import cuefem as cf
from cuefem.accuracy import resolve
from cuefem.io import load_accuracy
from tests.helpers.command_line import call

SCENES = Path(__file__).parent.parent / "studies" / "scenes"
MESHES = SCENES.parent.parent / "meshes"
READY = ("break_cue", "carom", "clay_on_shaft", "kim", "pool_low_deflection", "snooker")
CAROM, POOL, SNOOKER = (0.21, 61.5e-3), (0.17, 57.15e-3), (0.142, 52.5e-3)
BALLS = {"kim": CAROM, "carom": CAROM, "snooker": SNOOKER, "pool_low_deflection": POOL, "break_cue": POOL}


def rows() -> dict[str, list[str]]:
    """The scenes' README by name: what, ball, offset, squirt, effects."""
    lines = (SCENES / "README.md").read_text(encoding="utf-8").splitlines()
    cells = [[cell.strip() for cell in line.split("|")[1:-1]] for line in lines if line.startswith("| [")]
    return {row[0][1:].partition("]")[0]: row[1:] for row in cells}


def scene(name: str) -> cf.Scene:
    found = cf.load(SCENES / f"{name}.toml")
    assert isinstance(found, cf.Scene)
    return found


def as_json(*arguments: object) -> Any:
    status, out, err = call(*arguments, "--json")
    assert (status, err) == (0, "")
    return json.loads(out)


def test_these_are_all() -> None:
    assert tuple(sorted(path.stem for path in SCENES.glob("*.toml"))) == tuple(sorted(rows())) == READY


@pytest.mark.parametrize("name", READY)
def test_a_ready_scene_says_what_it_rests_on(name: str) -> None:
    text = (SCENES / f"{name}.toml").read_text(encoding="utf-8")
    assert text.startswith("# ")
    assert load_accuracy(SCENES / f"{name}.toml") == 1e-2
    assert list(tomllib.loads(text)) == [
        key for key in ("game", "cue", "ball", "tip", "stroke", "effects", "accuracy") if key in tomllib.loads(text)
    ]


@pytest.mark.parametrize("name", BALLS)
def test_balls_are_those_of_the_game(name: str) -> None:
    mass, diameter = BALLS[name]
    assert scene(name).ball == cf.Ball(mass, diameter / 2)


@pytest.mark.parametrize(
    ("name", "ounces"),
    [("carom", 17.5), ("pool_low_deflection", 20), ("break_cue", 19), ("snooker", 18), ("clay_on_shaft", 20)],
)
def test_cues_weigh_what_their_comments_say(name: str, ounces: float) -> None:
    assert scene(name).cue.mass == pytest.approx(ounces * 0.028349523125, rel=2e-3)


def test_the_readme_of_the_drawings_has_their_squirts() -> None:
    text = (SCENES.parents[1] / "meshes" / "README.md").read_text(encoding="utf-8")
    told = re.findall(
        r"([\d.]+)° \((\w+)\)", text.partition("At b/R 0.3 this gives squirts of ")[2].partition(".\n")[0]
    )
    assert len(told) == 5
    for squirt, name in told:
        cue = cf.load(SCENES.parents[1] / "meshes" / f"{name}.toml")
        assert isinstance(cue, cf.Cue)
        assert f"{math.degrees(cf.strike(cf.usual_scene(cue)).squirt):.2f}" == squirt


@pytest.mark.heavy
@pytest.mark.parametrize("name", READY)
def test_a_ready_scene_is_what_its_readme_says(name: str) -> None:
    found, outcome = scene(name), resolve(scene(name), 1e-3)
    _, ball, offset, squirt, effects = rows()[name]
    assert ball == f"{2e3 * found.ball.radius:g} mm, {1e3 * found.ball.mass:g} g"
    assert float(offset) == found.stroke.offset
    assert effects == (", ".join(type(effect).__name__ for effect in found.effects) or "none")
    assert outcome.regime == "stick"
    assert math.degrees(outcome.squirt) == pytest.approx(float(squirt), rel=1e-3, abs=5e-4)


def test_a_bare_scene_is_the_coupled_strike_alone(tmp_path: Path) -> None:
    bare = cf.Scene(scene("kim").cue, stroke=cf.Stroke(offset=0.3))
    cf.save(bare, tmp_path / "bare.toml")
    found, alone = as_json("strike", tmp_path / "bare.toml")["models"]["coupled"], cf.strike(bare)
    assert (found["unknowns"], found["squirt"], found["regime"]) == (alone.unknowns, alone.squirt, alone.regime)
    assert cf.strike(cf.load(tmp_path / "bare.toml")).phases == alone.phases  # type: ignore[arg-type]


def test_the_accuracy_of_a_file_is_the_strikes(tmp_path: Path) -> None:
    text = (
        (SCENES / "kim.toml").read_text(encoding="utf-8").replace("../../meshes", str(SCENES.parent.parent / "meshes"))
    )
    found = {}
    for rtol in (1e-2, 1e-3):
        (tmp_path / "scene.toml").write_text(text.replace("rtol = 1e-2", f"rtol = {rtol}"), encoding="utf-8")
        found[rtol] = as_json("strike", tmp_path / "scene.toml")["models"]["coupled"]
        expected = resolve(scene("kim"), rtol)
        assert (found[rtol]["squirt"], found[rtol]["error"]) == (expected.squirt, expected.error)
        assert found[rtol]["error"] <= rtol
    assert found[1e-3]["unknowns"] > found[1e-2]["unknowns"]
