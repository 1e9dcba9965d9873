"""Commands on a drawing: default stroke, an option for each assumption, results without contact (regression)."""

import json
from pathlib import Path

import pytest

import cuefem as cf
from cuefem.cue.materials import material
from tests.helpers.command_line import as_json, call

SHAFT = cf.Cue((cf.Segment(0.7, 0.0118, 0.021, material("hard maple")),), 0.42)
DRAWN = cf.Cue((cf.Segment(5e-3, 0.0118, 0.0118, material("leather")), *SHAFT.segments), 0.42)


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    cf.save(SHAFT, tmp_path / "shaft.toml")
    cf.save(DRAWN, tmp_path / "drawn.toml")
    cf.save(cf.usual_scene(SHAFT), tmp_path / "leather.toml")
    monkeypatch.chdir(tmp_path)
    return tmp_path


def test_report_leather_too_soft_omits_contact_results(folder: Path) -> None:
    soft = ("shaft.toml", "--leather", "1 MPa")
    status, out, err = call("report", *soft, "--json")
    report = json.loads(out)
    assert status == 2
    assert "(--tip-height, --leather, --speed)" in err
    assert report["modes"]["frequencies"] == as_json("modes", *soft)["frequencies"]
    assert "exceeds the valid range" in report["no_contact"]
    assert_one_fails("leather.toml", "path = 'leather.E'\nvalues = ['1 MPa', '140 MPa']", "exceeds the valid range")


def assert_one_fails(scene: str, vary: str, message: str) -> None:
    """One of a sweep's two designs fails, and its reason contains ``message``."""
    Path("study.toml").write_text(f"scene = '{scene}'\nresponses = ['squirt(0.5)', 'frequency(1)']\n[[vary]]\n{vary}\n")
    record = json.loads(call("study", "study.toml", "--json")[1])
    assert (record["designs"], record["lacking"]["squirt(0.5)"]) == (2, 1)
    assert message in record["first_failure"]
