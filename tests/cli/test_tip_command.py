"""The command on a tip of leather: numbers of the library, options, words (regression)."""

from __future__ import annotations

import json
import re
from dataclasses import replace
from pathlib import Path

import pytest

import cuefem as cf
from cuefem.report.tip_table import SHEAR_OFFSETS, SPEEDS
from tests.helpers.command_line import call
from tests.helpers.leather_scenes import LEATHER, SHAFT, leather_scene


@pytest.fixture
def file(tmp_path: Path) -> Path:
    cf.save(leather_scene(), tmp_path / "tip.toml")
    return tmp_path / "tip.toml"


def test_numbers(file: Path) -> None:
    status, out, err = call("tip", file, "--json", "--speed", "3 m/s", "--leather", "200 MPa")
    assert (status, err) == (0, "")
    found = json.loads(out)
    assert found["E"] == pytest.approx(200e6)
    assert [blow["speed"] for blow in found["blows"]] == list(SPEEDS)
    times = [blow["contact_time"] for blow in found["blows"]]
    assert times == sorted(times, reverse=True)
    assert found["contact_time"] == pytest.approx(times[SPEEDS.index(3.0)], rel=1e-12)
    assert found["tip_mass"] == LEATHER.mass(SHAFT.segments[0].tip_diameter)
    assert [at["offset"] for at in found["shear_ratios"]] == list(SHEAR_OFFSETS)
    assert all(0.25 < at["ratio"] < 0.5 for at in found["shear_ratios"])


def test_modulus_from_a_contact_time(file: Path) -> None:
    status, out, err = call("tip", file, "--contact-time", "1 ms")
    assert (status, err) == (0, "")
    assert "E is what makes a head-on blow at 2 m/s last 1 ms" in out
    assert re.search(r"^ +2 m/s +1\.000 ms ", out, flags=re.MULTILINE)
    assert "head-on contact time" in out


def test_a_fixed_normal_is_named(tmp_path: Path) -> None:
    cf.save(leather_scene(leather=replace(LEATHER, rolls=False)), tmp_path / "fixed.toml")
    status, out, err = call("tip", tmp_path / "fixed.toml")
    assert (status, err) == (0, "")
    assert "rolls false" in out


def test_a_speed_beyond_the_law_has_no_numbers(file: Path) -> None:
    status, out, err = call("tip", file, "--leather", "20 MPa")
    assert (status, err) == (0, "")
    assert "–: the leather would be pressed further than its law is known" in out


@pytest.mark.parametrize(
    ("options", "line"),
    [
        (("--leather", "0 MPa"), "--leather: must be more than 0 MPa; got 0 MPa"),
        (("--leather", "9 MPa", "--contact-time", "1 ms"), "--leather: must be left out with --contact-time"),
        (("--contact-time", "8 ms"), "the tip's leather is compressed by"),
    ],
)
def test_refusals(file: Path, options: tuple[str, ...], line: str) -> None:
    status, out, err = call("tip", file, *options)
    assert (status, out) == (2, "")
    assert err.count("\n") == 1
    assert line in err


def test_a_scene_without_such_a_tip(tmp_path: Path) -> None:
    cf.save(cf.Scene(SHAFT), tmp_path / "spring.toml")
    status, out, err = call("tip", tmp_path / "spring.toml")
    assert (status, out) == (2, "")
    assert "Scene.effects must hold a LeatherTip; got none" in err


def test_a_constant_stiffness_along_the_surface_is_what_the_ratio_shows(tmp_path: Path) -> None:
    ratios = []
    for shear in (1e5, 2e5):
        cf.save(leather_scene(leather=replace(LEATHER, shear=shear)), tmp_path / "steady.toml")
        found = json.loads(call("tip", tmp_path / "steady.toml", "--json")[1])
        ratios.append([at["ratio"] for at in found["shear_ratios"]])
    assert ratios[1] == pytest.approx([2 * ratio for ratio in ratios[0]], rel=1e-12)
