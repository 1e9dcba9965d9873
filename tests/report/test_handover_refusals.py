"""What cannot be handed over: refused in one line with status 2, and nothing written (bad input)."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import cuefem as cf
from cuefem.contact.motion import motion
from cuefem.squirt import alciatore_a31_mass_ratio
from tests.helpers.command_line import call

KIM = cf.Cue((cf.Segment(0.7, 0.012, 0.021, cf.Material(12.6e9, 0.84e9, 782.3284453057836), kappa=0.9),), 0.42)
SCENE = cf.Scene(KIM, cf.Ball(0.17, 0.028575), cf.Tip(0.75, 0.7, 1e-3), cf.Stroke(2.0, 0.3))


@pytest.fixture
def scene(tmp_path: Path) -> Path:
    cf.save(SCENE, tmp_path / "scene.toml")
    return tmp_path / "scene.toml"


def refused(*arguments: object) -> str:
    status, out, err = call(*arguments)
    assert (status, out, err.count("\n")) == (2, "", 1)
    return err


@pytest.mark.parametrize("squirt", [0.0, -0.01, 1.5])
def test_a_squirt_that_no_end_mass_has(squirt: float) -> None:
    with pytest.raises(ValueError, match=r"endless end mass in \[A.31\]; got .* rad at offset 0.3"):
        alciatore_a31_mass_ratio(0.3, squirt)


@pytest.mark.parametrize(
    ("options", "said"),
    [
        (["--offset", "0"], "end mass 'A.31' does not exist here: [A.31] has no squirt head on; got the offset 0"),
        (["--offset", "0.9"], "end mass 'A.31' does not exist here: the stroke miscues at offset 0.9; got no end mass"),
        (["--offset", "1.5"], "--offset: must be in (-1, 1)"),
    ],
)
def test_an_end_mass_that_is_not_there(scene: Path, tmp_path: Path, options: list[str], said: str) -> None:
    assert f"{scene}: {said}" in refused("handover", scene, *options, "-o", tmp_path / "cue.json")
    assert list(tmp_path.iterdir()) == [scene]


def test_a_head_on_stroke_has_its_stick_end_mass(scene: Path) -> None:
    assert call("handover", scene, "--offset", "0", "--drive", "stick")[0] == 0


def test_an_output_that_is_no_json(scene: Path, tmp_path: Path) -> None:
    assert "--output: must end in .json; got '.toml'" in refused("handover", scene, "-o", tmp_path / "cue.toml")


@pytest.mark.parametrize("times", [[-1e-3], [1e-3, 0.0], [np.nan], [], [np.inf]])
def test_times_that_are_none(times: list[float]) -> None:
    with pytest.raises(ValueError, match=r"motion takes ascending times in \[0, inf\) s; got"):
        motion(SCENE, times)


def test_a_cue_that_is_raised() -> None:
    with pytest.raises(ValueError, match="motion takes strokes in the plane of cue and ball; got Elevation"):
        motion(replace(SCENE, effects=(cf.Elevation(0.1),)), [0.0])


def test_a_lumped_cue_has_no_shape() -> None:
    with pytest.raises(
        ValueError, match=r"Scene.cue must be a Cue of segments: its modes or its shape are needed; got a LumpedCue"
    ):
        motion(replace(SCENE, cue=cf.LumpedCue(0.54, 0.005)), [0.0])


@pytest.mark.parametrize(
    ("options", "said"),
    [
        (["--until", "3"], "--until: must be in (0, inf) s, a time with its unit, such as \"1.2 ms\"; got '3'"),
        (["--until", "-1 ms"], "--until: must be in (0, inf) s; got '-1 ms'"),
        (["--scale", "nan"], "--scale: must be finite; got nan"),
    ],
)
def test_an_animation_of_bad_numbers(scene: Path, tmp_path: Path, options: list[str], said: str) -> None:
    assert said in refused("animate", scene, "-o", tmp_path / "seen", *options)
    assert list(tmp_path.iterdir()) == [scene]


@pytest.mark.parametrize("options", [("--count", "0"), ("--count", "101"), ("--frames", "1"), ("--frames", "10001")])
def test_an_animation_of_too_few_or_too_many(scene: Path, tmp_path: Path, options: tuple[str, ...]) -> None:
    status, out, err = call("animate", scene, "-o", tmp_path / "seen", *options)
    assert (status, out) == (2, "")
    assert f"Invalid value for '{options[0]}': {options[1]} is not in the range" in err
    assert list(tmp_path.iterdir()) == [scene]


@pytest.mark.parametrize("where", ["none/cue.json", "dir.json"])
def test_a_place_where_nothing_can_be_written(scene: Path, tmp_path: Path, where: str) -> None:
    (tmp_path / "dir.json").mkdir()
    assert f"{where}: cannot be written: " in refused("handover", scene, "-o", tmp_path / where)
    assert sorted(path.name for path in tmp_path.rglob("*")) == ["dir.json", "scene.toml"]


def test_an_animation_of_a_cue_that_is_raised(scene: Path, tmp_path: Path) -> None:
    cf.save(replace(SCENE, effects=(cf.Elevation(0.1),)), scene)
    assert "in the plane of cue and ball; got Elevation" in refused("animate", scene, "-o", tmp_path / "seen")
    assert list(tmp_path.iterdir()) == [scene]


def test_a_folder_that_is_there(scene: Path, tmp_path: Path) -> None:
    (tmp_path / "seen").mkdir()
    assert "seen: must be a new folder; there is one" in refused("animate", scene, "-o", tmp_path / "seen")
    assert list((tmp_path / "seen").iterdir()) == []


def test_a_folder_in_none(scene: Path, tmp_path: Path) -> None:
    said = refused("animate", scene, "-o", tmp_path / "none" / "seen", "--frames", "2")
    assert "seen: cannot be written: No such file or directory" in said


def test_an_animation_that_stops_half_way(scene: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def full(*_: object) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr("cuefem.io.paraview.save_pvd", full)
    said = refused("animate", scene, "-o", tmp_path / "seen", "--frames", "2")
    assert "seen: cannot be written: No space left on device" in said
    assert list(tmp_path.iterdir()) == [scene]
