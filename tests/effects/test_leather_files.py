"""Leather tips in scene files: hardness by name, dome by coin, length or flat (regression)."""

from __future__ import annotations

from pathlib import Path

import pytest

import cuefem as cf
from tests.helpers.invalid_input import assert_raises
from tests.helpers.leather_scenes import SHAFT

ENTRIES = {"height": '"6 mm"', "dome_radius": '"9.5 mm"', "leather": '"medium"'}


@pytest.fixture
def file(tmp_path: Path) -> Path:
    cf.save(SHAFT, tmp_path / "shaft.toml")
    return tmp_path / "scene.toml"


def write_scene(file: Path, **entries: str | None) -> Path:
    """A scene with a leather tip of these entries; None removes an entry."""
    rows = [f"{name} = {value}" for name, value in (ENTRIES | entries).items() if value is not None]
    file.write_text("\n".join(["cue = 'shaft.toml'", "game = 'kim'", "[[effects]]", "type = 'LeatherTip'", *rows]))
    return file


@pytest.mark.parametrize(
    ("entries", "message"),
    [
        ({"leather": None}, "effects[0].leather: must be one of soft, medium, hard, kamui soft"),
        ({"leather": "'sofd'"}, "got 'sofd'; did you mean 'soft'?"),
        ({"E": "'1 MPa'"}, "effects[0].E: must be omitted with leather, which sets it"),
        ({"leather": None, "lether": "'soft'"}, "unknown key; did you mean 'leather'?"),
        ({"dome_radius": "'penny'"}, 'such as "12 mm", or "dime", "nickel", "flat"; got \'penny\''),
        ({"dome_radius": "9.5"}, 'needs a unit: "12 mm" or "0.5 in", or "dime", "nickel", "flat"; got 9.5'),
        ({"height": "inf"}, "effects[0].height: must be a length with its unit"),
        ({"rolling": "'no'"}, "effects[0].rolling: must be true or false; got 'no'"),
    ],
)
def test_leather_tip_in_file_invalid_raises(file: Path, entries: dict[str, str | None], message: str) -> None:
    assert_raises(lambda: cf.load(write_scene(file, **entries)), message)
