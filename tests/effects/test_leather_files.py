"""Leather tips in scene files: hardness by name, dome by coin, length or flat (regression)."""

from __future__ import annotations

from math import inf
from pathlib import Path

import pytest

import cuefem as cf
from cuefem.cue.materials import LEATHERS
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


def tip_of(file: Path) -> cf.LeatherTip:
    scene = cf.load(file)
    assert isinstance(scene, cf.Scene)
    return scene.leather_tip


@pytest.mark.parametrize("name", LEATHERS)
def test_leather_name_in_file_sets_constants(file: Path, name: str) -> None:
    leather, tip = LEATHERS[name], tip_of(write_scene(file, leather=f"'{name}'"))
    assert tip == cf.LeatherTip(6e-3, 9.5e-3, leather.E, leather.nu, leather.rho)


@pytest.mark.parametrize(
    ("text", "radius"),
    [
        *(("'dime'", 17.91e-3 / 2), ("'nickel'", 21.21e-3 / 2), ("'Nickel'", 21.21e-3 / 2), ("'9 mm'", 9e-3)),
        *(("'flat'", inf), ("inf", inf), ("'inf'", inf), ("'inf m'", inf)),
    ],
)
def test_dome_radius_by_coin_length_or_flat_is_read(file: Path, text: str, radius: float) -> None:
    assert tip_of(write_scene(file, dome_radius=text)).dome_radius == pytest.approx(radius, rel=1e-12)
    cf.save(cf.load(file), file)
    assert tip_of(file).dome_radius == pytest.approx(radius, rel=1e-12)


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
