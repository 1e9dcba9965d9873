"""Export for pooltool: its formula with the exported end mass has the same squirt (verification)."""

import math
import runpy
import sys
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

import cuefem as cf
from cuefem.analysis.simulator_export import DEFAULT, VERSION, pooltool_record
from studies.pages import STUDIES
from tests.helpers.command_line import as_json
from tests.helpers.cues import kim
from tests.helpers.pooltool import in_pooltool

KIM = kim()
SCENE = cf.Scene(KIM, cf.Ball(0.17, 0.028575), cf.Tip(0.75, 0.7, 1e-3), cf.Stroke(2.0, 0.3), (cf.TipDome(0.0095),))
# CueSpecs of pooltool 0.6.0, in its order


def pooltool_squirt(mass: float, end_mass: float, a: float) -> float:
    """get_squirt_angle of pooltool 0.6.0: alpha, rad, positive to the left; a positive on the left."""
    A = 1 - a**2
    return -math.atan2(2.5 * a * math.sqrt(A), 1 + mass / end_mass + 2.5 * A)


def exported(*arguments: object) -> Any:
    return as_json("strike", *arguments, "--format", "pooltool")


@pytest.fixture
def scene(tmp_path: Path) -> Path:
    cf.save(SCENE, tmp_path / "scene.toml")
    return tmp_path / "scene.toml"


@pytest.mark.parametrize("offset", [-0.3, 0.1, 0.5])
def test_pooltool_formula_with_exported_end_mass_equals_strike(offset: float) -> None:
    case = replace(SCENE, stroke=replace(SCENE.stroke, offset=offset))
    record = pooltool_record("kim", case)
    squirt = cf.strike(case).squirt
    assert record["squirt"] == pytest.approx(squirt, rel=1e-12)
    assert -pooltool_squirt(0.17, record["CueSpecs"]["end_mass"], offset) == pytest.approx(squirt, rel=1e-12)
    assert -pooltool_squirt(0.17, 0.170097 / 30, offset) == pytest.approx(record["default_squirt"], rel=1e-12)


def test_model_for_pooltool_names_the_version_that_it_needs(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """pip chooses 0.3.3, which has other modules."""
    (tmp_path / "pooltool").mkdir()
    (tmp_path / "pooltool" / "__init__.py").touch()
    (tmp_path / "pooltool_billiards-0.3.3.dist-info").mkdir()
    (tmp_path / "pooltool_billiards-0.3.3.dist-info" / "METADATA").write_text(
        "Name: pooltool-billiards\nVersion: 0.3.3\n"
    )
    monkeypatch.syspath_prepend(tmp_path)
    for name in [name for name in sys.modules if name.partition(".")[0] == "pooltool"]:
        monkeypatch.delitem(sys.modules, name)
    with pytest.raises(ImportError, match=r"needs pooltool 0\.6\.0; 0\.3\.3 is installed.*pip install --no-deps"):
        runpy.run_path(str(STUDIES / "games" / "pooltool_model.py"))
    monkeypatch.delitem(sys.modules, "pooltool")


@pytest.mark.parametrize("offset", [-0.3, 0.0001, 0.5])
def test_pooltool_speeds_conserve_momentum_and_energy(offset: float) -> None:
    """A point of a rigid cue strikes without loss; a strike with restitution 0.75 gives the ball less."""
    record = pooltool_record("kim", replace(SCENE, stroke=replace(SCENE.stroke, offset=offset)))
    m, M, R, V = 0.17, record["CueSpecs"]["M"], 0.028575, SCENE.stroke.speed
    v, spin = record["pooltool_ball_speed"], record["pooltool_spin"]
    assert 0.4 * m * R**2 * spin == pytest.approx(m * v * offset * R, rel=1e-12)
    energy = M * (V - m * v / M) ** 2 + m * v**2 + 0.4 * m * (R * spin) ** 2
    assert energy == pytest.approx(M * V**2, rel=1e-12)
    assert 0 < record["ball_speed"] < v
    assert 0 < record["spin"] / spin < 1


@pytest.mark.filterwarnings("ignore::cuefem.PlausibilityWarning")
def test_pooltool_export_without_dimension_has_its_default() -> None:
    whole = pooltool_record("drawn whole", replace(SCENE, cue=replace(KIM, body_mass=0.0)))["CueSpecs"]
    assert (whole["length"], whole["shaft_radius_at_butt"]) == (0.7, 0.0105)
    record = pooltool_record("two parts", replace(SCENE, cue=cf.LumpedCue(0.54, 0.005), effects=()))
    same = {name: value for name, value in DEFAULT.items() if name not in ("brand", "M", "end_mass")}
    assert same.items() <= record["CueSpecs"].items()
    assert f"not drawn, pooltool's default: {', '.join(sorted(same, key=list(DEFAULT).index))}" in record["notes"]


IN_POOLTOOL = """
import json, sys
import pooltool as pt
from pooltool.physics.resolve.stick_ball.instantaneous_point import InstantaneousPoint
from pooltool.physics.resolve.stick_ball.squirt import get_squirt_angle

answers = []
for offset, record in json.load(sys.stdin):
    specs = pt.objects.CueSpecs(**record["CueSpecs"])
    cue = pt.Cue(V0=2.0, phi=90.0, a=offset, b=0.0, specs=specs)
    ball = pt.Ball("cue", params=pt.BallParams(**record["BallParams"]))
    alpha = get_squirt_angle(ball.params.m, specs.end_mass, offset, 1.0)
    _, after = InstantaneousPoint().resolve(cue, ball)
    answers.append((alpha, after.state.rvw[1].tolist(), after.state.rvw[2][2], specs.length))
print(json.dumps([pt.__version__, answers]))
"""


def test_pooltool_with_exported_cue_computes_same_squirt(scene: Path) -> None:
    """pooltool reads the exported file; its own stroke has the same squirt, away from the struck side."""
    offsets = (-0.4, 0.1, 0.3, 0.5)
    sent = [(offset, exported(scene, f"--offset={offset}")) for offset in offsets]
    version, results = in_pooltool(IN_POOLTOOL, sent)
    assert version == VERSION
    for (offset, record), (alpha, (x, y, _), spin, length) in zip(sent, results, strict=True):
        assert math.hypot(x, y) == pytest.approx(record["pooltool_ball_speed"], rel=1e-12)
        assert -spin == pytest.approx(record["pooltool_spin"], rel=1e-12)  # about the vertical, to the left
        ours = cf.strike(replace(SCENE, stroke=replace(SCENE.stroke, offset=offset))).squirt
        assert -alpha == pytest.approx(ours, rel=1e-12)
        assert math.atan2(x, y) == pytest.approx(ours, rel=1e-9)  # aimed along y, struck on the left
        assert length == 1.4732
