"""`cuefem optimize`: the committed study, what it writes, and a problem without exact gradients (regression)."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

import cuefem as cf
from studies.common import STUDIES
from tests.helpers.command_line import call
from tests.helpers.sweeps import OPTIMUM, written

STUDY = STUDIES / "optimum.toml"


def test_the_committed_study(tmp_path: Path) -> None:
    """The number of studies/low_squirt.md; the scene that is written is as stiff as was asked."""
    goal = tmp_path / "best.toml"
    code, out, err = call("optimize", STUDY, "--json", "-o", goal)
    assert (code, err) == (0, "")
    said = json.loads(out)
    assert said["value"] == pytest.approx(0.03952, abs=5e-6)
    assert (said["evaluations"], said["exact_gradients"]) == (18, True)
    assert said["objective"] == {"minimize": "squirt_slope"}
    assert said["active"][:2] == ["tip_stiffness >= 386.7", "wall >= 0.002"]
    wanted = {"squirt_slope": said["value"], "tip_stiffness": 386.7, "wall": 0.002}
    assert said["values"] == pytest.approx(wanted, rel=1e-6)
    assert said["units"]["tip_stiffness"] == "N/m"
    best = cf.load(goal)
    assert isinstance(best, cf.Scene)
    assert cf.CueBatch.of([best.cue]).tip_stiffness[0] == pytest.approx(386.7, rel=1e-6)
    assert best.cue.segments[0].tip_diameter == said["numbers"]["tip diameter"]


def test_what_a_person_reads(tmp_path: Path) -> None:
    code, out, err = call("optimize", written(tmp_path, OPTIMUM))
    assert (code, err) == (0, "")
    lines = out.splitlines()
    assert lines[0].startswith("minimize squirt_slope: ")
    assert lines[0].endswith("evaluations by exact gradients")
    assert any(line.startswith("bore") and line.endswith(" m") for line in lines)
    assert lines[-1] == "held by: bore <= 0.009, tip >= 0.01"


def test_a_coupled_strike_has_no_exact_gradients(tmp_path: Path) -> None:
    """Ball speed by differential evolution: the widest bore that the wall allows, to a few per cent."""
    study = written(tmp_path, OPTIMUM.replace('minimize = "squirt_slope"', 'minimize = "squirt(0.3)"'))
    code, out, err = call("optimize", study, "--json", "--iterations", 3, "--seed", 4)
    assert (code, err) == (0, "")
    said = json.loads(out)
    assert said["exact_gradients"] is False
    assert said["values"]["tip_stiffness"] >= 300
    assert call("optimize", study, "--json", "--iterations", 3, "--seed", 4)[1] == out


def test_a_drawing_is_not_replaced_unasked(tmp_path: Path) -> None:
    goal = tmp_path / "best.toml"
    goal.write_text("mine", encoding="utf-8")
    code, _, err = call("optimize", written(tmp_path, OPTIMUM), "-o", goal)
    assert code == 2
    assert "--force replaces it" in err
    assert goal.read_text(encoding="utf-8") == "mine"
    assert call("optimize", tmp_path / "study.toml", "-o", goal, "--force")[0] == 0
    assert isinstance(cf.load(goal), cf.Scene)
