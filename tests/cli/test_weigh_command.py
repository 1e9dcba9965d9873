"""The command that weighs a shaft's end: numbers of the library, through the drawing, without one, the plan."""

from __future__ import annotations

from pathlib import Path

import pytest

import cuefem as cf
from cuefem.measured.kinds import Setup
from cuefem.measured.pendulum import Bounces, PendulumTest, choices, lumped_squirt, pressed_time
from tests.helpers.command_line import as_json, said
from tests.helpers.documented import SCENE

OPTIONS = (
    *("--ball-mass", "8 g", "--before", "200 mm", "--after", "-34 mm", "--after", "-35 mm"),
    *("--held-after", "162 mm", "--held-after", "161 mm", "--thread", "1 m"),
)
FREE = Bounces("swing", (0.2,), (-0.034, -0.035), 1e-3, 1.0)
WALL = Bounces("swing", (0.2,), (0.162, 0.161), 1e-3, 1.0)
TEST = PendulumTest(8e-3, 1e-4, FREE, 1e-3, wall=WALL, contact_time_error=1e-4)


def test_numbers() -> None:
    found, weighed = as_json("weigh", *OPTIONS, "--contact-time", "1 ms"), TEST.weighed()
    assert found["end_mass"] == pytest.approx(weighed.end_mass, rel=1e-12)
    assert found["interval_68"] == pytest.approx(weighed.interval())
    assert found["budget"] == pytest.approx(weighed.budget)
    expected = lumped_squirt(weighed.end_mass, 0.54, cf.Ball(0.170, 0.028575), cf.Tip(), cf.Stroke(1.0, 0.3))
    assert found["lumped_squirt"] == pytest.approx(expected, rel=1e-12)
    assert "pool ball" in found["assumed"]
    assert found["units"]["end_mass"] == "kg"
    for offset in ("8.5725 mm", "0.3"):
        again = as_json("weigh", *OPTIONS, "--contact-time", "1 ms", "--offset", offset)
        assert again["assumed"] == found["assumed"]
        assert again["lumped_squirt"] == pytest.approx(expected, rel=1e-12)


def test_through_the_drawing(tmp_path: Path) -> None:
    cf.save(SCENE, tmp_path / "scene.toml")
    more = ("--contact-time", "1 ms", "--scene", tmp_path / "scene.toml", "--position", "10 mm")
    found, measured = as_json("weigh", *OPTIONS, *more)["squirt"], TEST.as_measured(TEST.weighed(), 0.01)
    assert found["drawn_end_mass"] == pytest.approx(measured.computed(Setup(SCENE)), rel=1e-9)
    assert (found["before"], found["offset"]) == (pytest.approx(cf.strike(SCENE).squirt, rel=1e-9), 0.3)
    assert (found["after"] > found["before"]) == (measured.value > found["drawn_end_mass"])
    assert 0.1 < found["after_error"] / found["after"] < found["before_error"] / found["before"]


def test_a_table_for_people() -> None:
    out = said("weigh", *OPTIONS, "--press", "50 N", "--press-depth", "0.5 mm")
    time = pressed_time(50.0, 0.5e-3, 8e-3, FREE.impact_speed or 0.0, WALL.ratio[0])
    assert f"for a contact of {1e3 * time:.3g} ms" in out
    assert "the reading that counts most: mass of the ball" in out
    assert "a lumped cue with this end mass" in out


def test_remarks() -> None:
    hard = ("--ball-mass", "30 g", "--before", "2 m/s", "--after", "-1.4 m/s", "--read", "speed")
    out = said("weigh", *hard, "--contact-time", "0.1 ms", "--restitution", "0.8", "--restitution-error", "0.2")
    assert "take a softer ball" in out
    assert "as heavy as the end mass, would tell more" in out
    assert "errors over a tenth" in out


def test_the_plan() -> None:
    found = as_json("weigh", "--plan", "--end-mass", "8 g")
    assert [ball["error"] for ball in found["balls"]] == pytest.approx([one.error for one in choices(8e-3)])
    for swing in found["swings"]:
        assert swing["speed"] == pytest.approx(Bounces("swing", (swing["swing"],), (0.0,), 1e-3, 1.0).impact_speed)
    assert "The thread" in said("weigh", "--plan")
