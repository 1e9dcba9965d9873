"""Files, command, pages and pictures of a strike from the side; and what it refuses (regression)."""

from __future__ import annotations

import json
import math
import xml.etree.ElementTree as ET
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import meshio
import numpy as np
import pytest

import cuefem as cf
from tests.helpers.command_line import call
from tests.helpers.cues import kim, pool
from tests.helpers.refusals import command_refuses, refuses

BALL = cf.Striker(0.02, 0.8, contact_time=1e-3)
SCENE = cf.SideStrike(kim(), BALL, 0.05, 2.0, (cf.PointMass(0.1, 2e-3), cf.Support(0.6, 5e3)))
LAWS = [BALL, cf.Striker(0.1, 0.5, stiffness=3e5), cf.Striker(0.03, 1.0, modulus=1e9, radius=0.01)]


@pytest.mark.parametrize("striker", LAWS)
def test_a_file_reads_back(tmp_path: Path, striker: cf.Striker) -> None:
    scene = replace(SCENE, striker=striker)
    cf.save(scene, tmp_path / "side.toml")
    assert cf.load(tmp_path / "side.toml") == scene


def test_a_file_may_name_its_cue(tmp_path: Path) -> None:
    cf.save(pool(), tmp_path / "pool.toml")
    text = 'cue = "pool.toml"\n\n[striker]\nmass = "20 g"\nrestitution = 0.8\ncontact_time = "1 ms"\n'
    (tmp_path / "side.toml").write_text(text, encoding="utf-8")
    assert cf.load(tmp_path / "side.toml") == cf.SideStrike(pool(), BALL)


def test_the_command_says_what_the_library_says(tmp_path: Path) -> None:
    cf.save(SCENE, tmp_path / "side.toml")
    status, out, err = call("side", tmp_path / "side.toml", "--places", 3, "--json")
    assert (status, err) == (0, "")
    found, outcome = json.loads(out), cf.side_strike(SCENE)
    for name in ("rebound_speed", "apparent_restitution", "effective_mass", "impulse", "duration", "energy"):
        assert found[name] == getattr(outcome, name)
    assert found["scene"]["striker"]["contact_time"] == 1e-3
    assert [row["position"] for row in found["along"]] == [0.0, 0.35, 0.7]
    middle = cf.side_strike(replace(SCENE, position=0.35))
    assert found["along"][1]["effective_mass"] == middle.effective_mass
    status, out, err = call("side", tmp_path / "side.toml", "--places", 3)
    assert (status, err) == (0, "")
    assert f"{outcome.apparent_restitution:.4f}" in out
    assert "effects: PointMass" in out


def test_the_command_takes_a_bare_shaft_and_options(tmp_path: Path) -> None:
    cf.save(kim(), tmp_path / "kim.toml")
    options = (
        "--mass",
        "5 g",
        "--restitution",
        0.9,
        "--contact-time",
        "1.5 ms",
        "--position",
        "2 in",
        "--speed",
        "3 m/s",
    )
    status, out, err = call("side", tmp_path / "kim.toml", *options, "--places", 2, "--json")
    assert (status, err) == (0, "")
    found = json.loads(out)
    assert found["assumed"] == []
    scene = cf.SideStrike(kim(), cf.Striker(0.005, 0.9, contact_time=1.5e-3), 0.0508, 3.0)
    assert found["effective_mass"] == pytest.approx(cf.side_strike(scene).effective_mass, rel=1e-12)
    status, out, _ = call("side", tmp_path / "kim.toml", "--places", 2)
    assert status == 0
    assert "assumed: striker 20 g (--mass); e 0.8" in out


def test_an_accuracy_in_the_file_is_reached(tmp_path: Path) -> None:
    cf.save(SCENE, tmp_path / "side.toml")
    text = (tmp_path / "side.toml").read_text(encoding="utf-8")
    (tmp_path / "side.toml").write_text(f"{text}\n[accuracy]\nrtol = 1e-3\n", encoding="utf-8")
    found = json.loads(call("side", tmp_path / "side.toml", "--places", 2, "--json")[1])
    assert 0 < found["error"] <= 1e-3


def test_paraview_gets_the_motion(tmp_path: Path) -> None:
    cf.save(SCENE, tmp_path / "side.toml")
    seen = tmp_path / "seen"
    assert call("side", tmp_path / "side.toml", "--places", 2, "-o", seen, "--frames", 4)[::2] == (0, "")
    sets = ET.parse(seen / "strike.pvd").getroot().findall("./Collection/DataSet")
    assert len(sets) == 8
    outcome = cf.side_strike(SCENE)
    times = np.linspace(0, 3 * outcome.duration, 4)
    moved = cf.side_motion(SCENE, times)
    shaft = meshio.read(seen / "strike" / "shaft_0003.vtu")
    w, _ = moved.deflection(shaft.point_data["x"])
    np.testing.assert_allclose(shaft.point_data["w"], w[3], rtol=1e-12)
    first, last = (meshio.read(seen / "strike" / f"ball_{i:04d}.vtu").points for i in (0, 3))
    np.testing.assert_allclose(last - first, [[0, moved.striker[3], 0]] * len(first), atol=1e-12)
    across = (0.012 + 0.05 / 0.7 * 0.009) / 2  # the ball begins where it touches the side
    np.testing.assert_allclose(first[:, 1].max(), -across, rtol=1e-9)


WRONG: list[tuple[Callable[[], object], str]] = [
    (lambda: cf.Striker(0.02, 0.8), "takes one law of contact"),
    (
        lambda: cf.Striker(0.02, 0.8, stiffness=1e5, contact_time=1e-3),
        "got stiffness 100000.0 N/m, contact_time 0.001 s",
    ),
    (lambda: cf.Striker(0.02, 0.8, modulus=1e9), "got modulus 1000000000.0 Pa"),
    (lambda: cf.Striker(0.0, 0.8, stiffness=1e5), "Striker.mass must be in (0, inf) kg; got 0.0"),
    (lambda: cf.Striker(0.02, 1.1, stiffness=1e5), "Striker.restitution must be in [0, 1]; got 1.1"),
    (lambda: cf.Striker(math.nan, 0.8, stiffness=1e5), "Striker.mass must be in (0, inf) kg; got nan"),
    (lambda: cf.SideStrike(kim(), BALL, 0.71), "SideStrike.position must be in [0, 0.7] m, on the cue; got 0.71"),
    (lambda: cf.SideStrike(kim(), BALL, speed=0.0), "SideStrike.speed must be in (0, inf) m/s; got 0.0"),
    (lambda: cf.SideStrike(cf.LumpedCue(0.5, 0.006), BALL), "TypeError: SideStrike.cue must be a Cue; got a LumpedCue"),  # type: ignore[arg-type]
    (lambda: cf.SideStrike(kim(), 0.02), "TypeError: SideStrike.striker must be a Striker; got 0.02"),  # type: ignore[arg-type]
    (
        lambda: cf.SideStrike(kim(), BALL, effects=cf.PointMass(0.1, 1e-3)),
        "TypeError: SideStrike.effects must be a sequence",
    ),  # type: ignore[arg-type]
    (
        lambda: cf.SideStrike(kim(), BALL, effects=(cf.PointMass(0.9, 1e-3),)),
        "SideStrike.effects[0].position must be in",
    ),
    (lambda: cf.SideStrike(kim(), BALL, effects=(cf.TipDome(0.01),)), "does not touch the cue's tip; got TipDome"),
    (lambda: cf.side_strike(kim()), "TypeError: side_strike scene must be a SideStrike; got a Cue"),  # type: ignore[arg-type]
    (
        lambda: cf.side_strike(cf.SideStrike(kim(), cf.Striker(0.02, 1.0, stiffness=1e15))),
        "contact time in [1e-6, 10] s",
    ),
    (lambda: cf.side_motion(SCENE, [1e-3, 0.0]), "motion takes ascending times"),
    (lambda: cf.resolve_side_strike(SCENE, 0.0), "resolve_side_strike rtol must be in (0, 1); got 0.0"),
    (lambda: cf.strike(SCENE), "TypeError: strike scene must be a Scene"),  # type: ignore[arg-type]
]


@pytest.mark.parametrize(("ask", "message"), WRONG, ids=[message for _, message in WRONG])
def test_what_it_refuses(ask: Callable[[], object], message: str) -> None:
    refuses(ask, message)


def test_other_commands_refuse_its_file_in_words(tmp_path: Path) -> None:
    cf.save(SCENE, tmp_path / "side.toml")
    command_refuses("striker: must be absent here: `cuefem side` takes", "strike", tmp_path / "side.toml")
    command_refuses("--position: must be 0 mm or more; got", "side", tmp_path / "side.toml", "--position", "-1 mm")
    command_refuses("SideStrike.position must be in", "side", tmp_path / "side.toml", "--position", "2 m")
    (tmp_path / "lumped.toml").write_text('game = "kim"\n[cue]\nmass = "540 g"\nend_mass = "4 g"\n', encoding="utf-8")
    command_refuses("a lumped cue has no side", "side", tmp_path / "lumped.toml")


def test_a_scene_with_a_whole_tip_keeps_the_mass_of_its_leather(tmp_path: Path) -> None:
    scene = cf.usual_scene(pool())
    cf.save(scene, tmp_path / "scene.toml")
    status, out, err = call("side", str(tmp_path / "scene.toml"), "--json")
    assert (status, err) == (0, "")
    (mass,) = (effect["mass"] for effect in json.loads(out)["scene"]["effects"] if "mass" in effect)
    assert mass == pytest.approx(scene.leather.mass_on(scene.shaft))


@pytest.mark.parametrize("ask", [cf.end_mass, cf.lump, lambda cue: cf.resolve(cue, 1e-2), cf.resolve_end_mass])
def test_a_cue_alone_is_refused_where_a_scene_is_meant(ask: Callable[[cf.Cue], object]) -> None:
    with pytest.raises(TypeError, match="scene must be a Scene; got a Cue"):
        ask(kim())
