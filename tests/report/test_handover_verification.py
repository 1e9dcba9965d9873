"""What is handed to pooltool: its own squirt from our number, and the JSON's words (verification).

pooltool pins a development build of its graphics; for the two tests that want it (0.6.0): pip install --no-deps
pooltool-billiards, and then what it imports: numba numpy-quaternion panda3d panda3d-gltf panda3d-simplepbr pillow
cattrs msgpack msgpack-numpy pyyaml h5py h11.
"""

from __future__ import annotations

import json
import math
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import cuefem as cf
from cuefem.endmass.drives import DEFINITIONS
from cuefem.report.handover import NICKEL, pooltool_record
from cuefem.squirt import alciatore_a31, alciatore_a31_mass_ratio
from tests.helpers.command_line import call

KIM = cf.Cue((cf.Segment(0.7, 0.012, 0.021, cf.Material(12.6e9, 0.84e9, 782.3284453057836), kappa=0.9),), 0.42)
SCENE = cf.Scene(KIM, cf.Ball(0.17, 0.028575), cf.Tip(0.75, 0.7, 1e-3), cf.Stroke(2.0, 0.3), (cf.TipDome(0.0095),))
# CueSpecs of pooltool 0.6.0, in its order
CUE_SPECS = ("brand", "M", "length", "tip_radius", "shaft_radius_at_tip", "shaft_radius_at_butt", "end_mass")


def pooltool_squirt(mass: float, end_mass: float, a: float) -> float:
    """Its get_squirt_angle, 0.6.0, written again: alpha, rad, positive to the left; a positive on the left."""
    A = 1 - a**2
    return -math.atan2(2.5 * a * math.sqrt(A), 1 + mass / end_mass + 2.5 * A)


def as_json(*arguments: object) -> Any:
    status, out, err = call("handover", *arguments)
    assert (status, err) == (0, "")
    return json.loads(out)


@pytest.fixture
def scene(tmp_path: Path) -> Path:
    cf.save(SCENE, tmp_path / "scene.toml")
    return tmp_path / "scene.toml"


@pytest.mark.parametrize("side", [-1, 1])
def test_the_inverse_of_a31(side: int) -> None:
    offset = side * np.array([0.01, 0.1, 0.3, 0.5, 0.9])
    ratio = np.geomspace(1e-3, 1e3, 13)[:, None]
    squirt = alciatore_a31(offset, mass_ratio=ratio, inertia=0.37)
    np.testing.assert_allclose(
        alciatore_a31_mass_ratio(offset, squirt, inertia=0.37), np.broadcast_to(ratio, squirt.shape), rtol=1e-10
    )


@pytest.mark.parametrize("offset", [-0.3, 0.2, 0.5])
def test_their_formula_turns_the_ball_as_our_strike_does(offset: float) -> None:
    struck = replace(SCENE, stroke=replace(SCENE.stroke, offset=offset))
    found = pooltool_record("kim", struck)
    alpha = pooltool_squirt(found["BallParams"]["m"], found["CueSpecs"]["end_mass"], a=offset)
    assert -alpha == pytest.approx(cf.strike(struck).squirt, rel=1e-12)


HANDED = ("A.31", *DEFINITIONS)


@pytest.mark.parametrize("drive", HANDED)
def test_each_end_mass_and_its_squirt(drive: Any) -> None:
    found = pooltool_record("kim", SCENE, drive=drive)
    mass, squirt = found["CueSpecs"]["end_mass"], found["squirt"]
    if drive != "A.31":
        assert mass == pytest.approx(cf.end_mass(SCENE, drive), rel=1e-12)
    assert found["end_mass"]["drive"] == drive
    assert set(found["end_mass"]["others"]) == set(HANDED) - {drive}
    for offset, ours, theirs in zip(squirt["offsets"], squirt["coupled"], squirt["pooltool"], strict=True):
        assert theirs == pytest.approx(-pooltool_squirt(0.17, mass, offset), rel=1e-12)
        struck = replace(SCENE, stroke=replace(SCENE.stroke, offset=offset))
        assert ours == pytest.approx(cf.strike(struck).squirt, rel=1e-12)


def test_the_json_of_the_command(scene: Path, tmp_path: Path) -> None:
    found = as_json(scene)
    assert tuple(sorted(found["CueSpecs"])) == tuple(sorted(CUE_SPECS))
    specs = found["CueSpecs"]
    expected = {"M": KIM.mass, "length": 0.7, "tip_radius": 0.0095}
    expected |= {"shaft_radius_at_tip": 0.006, "shaft_radius_at_butt": 0.0105}
    assert {name: specs[name] for name in expected} == expected
    assert specs["brand"] == "scene"
    assert found["end_mass"]["drive"] == "A.31"
    assert found["end_mass"]["contact_time"] == 1e-3
    assert (found["units"]["end_mass"], found["units"]["length"]) == ("kg", "m")
    assert "alpha(a) = -squirt" in found["signs"]
    status, out, err = call("handover", scene, "--for", "pooltool", "-o", tmp_path / "cue.json")
    assert (status, out, err) == (0, f"wrote {tmp_path / 'cue.json'}\n", "")
    assert json.loads((tmp_path / "cue.json").read_text(encoding="utf-8")) == found
    assert as_json(scene, "-o", tmp_path / "again.json", "--json") == found
    assert (tmp_path / "again.json").read_bytes() == (tmp_path / "cue.json").read_bytes()


def test_what_a_lumped_cue_leaves_out() -> None:
    lumped = replace(SCENE, cue=cf.LumpedCue(0.54, 0.005), effects=())
    found = pooltool_record("two parts", lumped, drive="stick")
    assert found["CueSpecs"] == {"brand": "two parts", "M": 0.54, "tip_radius": NICKEL, "end_mass": 0.005}


def test_pooltool_itself(scene: Path) -> None:
    datatypes = pytest.importorskip("pooltool.objects.cue.datatypes")
    theirs = pytest.importorskip("pooltool.physics.resolve.stick_ball.squirt")
    for offset in (-0.4, 0.1, 0.3, 0.5):
        struck = replace(SCENE, stroke=replace(SCENE.stroke, offset=offset))
        found = as_json(scene, f"--offset={offset}")
        cue = datatypes.Cue(a=offset, b=0.0, specs=datatypes.CueSpecs(**found["CueSpecs"]))
        alpha = theirs.get_squirt_angle(found["BallParams"]["m"], cue.specs.end_mass, cue.a, 1.0)
        assert -alpha == pytest.approx(cf.strike(struck).squirt, rel=1e-12)
        assert {name for name in CUE_SPECS if not hasattr(cue.specs, name)} == set()


def test_a_ball_that_pooltool_strikes(scene: Path) -> None:
    """pooltool's own stroke leaves its aim by our squirt, to the side that is not struck."""
    resolver = pytest.importorskip("pooltool.physics.resolve.stick_ball.instantaneous_point")
    objects = pytest.importorskip("pooltool.objects")
    found = as_json(scene)
    cue = objects.Cue(V0=2.0, phi=90.0, a=0.3, b=0.0, specs=objects.CueSpecs(**found["CueSpecs"]))
    ball = objects.Ball("cue", params=objects.BallParams(**found["BallParams"]))
    _, after = resolver.InstantaneousPoint().resolve(cue, ball)
    x, y, _ = after.state.rvw[1]
    assert math.atan2(x, y) == pytest.approx(cf.strike(SCENE).squirt, rel=1e-9)  # aimed along y, struck on the left


def test_a_scene_without_a_dome() -> None:
    found = pooltool_record("bare", cf.Scene(KIM, stroke=cf.Stroke(offset=0.3)))
    assert found["CueSpecs"]["tip_radius"] == NICKEL
    assert any("nickel" in note for note in found["notes"])


@pytest.mark.heavy
def test_a_raised_cue_is_remarked() -> None:
    raised = replace(SCENE, effects=(cf.Elevation(0.1),))
    note = "the cue is raised by 5.73°: its end mass includes the table's push, which pooltool's squirt does not know"
    assert note in pooltool_record("raised", raised)["notes"]
    assert not any("raised" in note for note in pooltool_record("level", SCENE)["notes"])


@pytest.mark.heavy
def test_a31_with_the_stick_end_mass_turns_the_ball_too_little() -> None:
    """The module's figures, and why the end mass handed over is another."""
    less: list[float] = []
    for path in sorted((Path(__file__).parents[2] / "studies" / "scenes").glob("*.toml")):
        squirt = pooltool_record(path.stem, cf.load(path), drive="stick")["squirt"]
        less += (1 - np.array(squirt["pooltool"]) / squirt["coupled"]).tolist()
    assert [round(min(less), 2), round(max(less), 2)] == [0.11, 0.42]
