"""Commands on a drawing: default stroke, an option for each assumption, results without contact (regression)."""

import json
from pathlib import Path

import cuefem as cf
from cuefem.cue.materials import material
from tests.helpers.command_line import as_json, call

SHAFT = cf.Cue((cf.Segment(0.7, 0.0118, 0.021, material("hard maple")),), 0.42)


def test_report_leather_too_soft_omits_contact_results(tmp_path: Path) -> None:
    cf.save(SHAFT, tmp_path / "shaft.toml")
    soft = (tmp_path / "shaft.toml", "--leather", "1 MPa")
    status, out, err = call("report", *soft, "--json")
    report = json.loads(out)
    assert status == 2
    assert "(--tip-height, --leather, --speed)" in err
    assert report["modes"]["frequencies"] == as_json("modes", *soft)["frequencies"]
    assert "exceeds the valid range" in report["no_contact"]
