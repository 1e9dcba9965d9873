"""Commands: JSON equals the library, and lists assumptions; printed text: tests/test_golden_files.py (regression)."""

import math
from dataclasses import replace
from pathlib import Path

import pytest

import cuefem as cf
from tests.helpers.command_line import stdout_of
from tests.helpers.cues import kim as kims_shaft

KIM = kims_shaft()
KIM_SCENE = cf.Scene(KIM, stroke=cf.Stroke(offset=0.3))
EFFECTS = (cf.PointMass(position=0.1, mass=0.005), cf.Elevation(math.radians(5)), cf.AxialWaves(1.45, 0.03, 4400.0))
SCENE = cf.Scene(KIM, cf.Ball(0.17, 0.028575), cf.Tip(0.8, 0.6, 1e-3), cf.Stroke(2.0, -0.2), EFFECTS)
CSV = "x [mm],diameter [mm]\n0,12\n700,21\n"


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    for name, item in (("cue", KIM), ("kim", KIM_SCENE), ("scene", SCENE)):
        cf.save(item, tmp_path / f"{name}.toml")
    (tmp_path / "shaft.csv").write_text(CSV)
    monkeypatch.chdir(tmp_path)
    return tmp_path


def test_convert_writes_equal_cue_or_scene(folder: Path) -> None:
    assert stdout_of("convert", "cue.toml", "cue.vtu") == "wrote cue.vtu\n"
    stdout_of("convert", "cue.toml", "new.toml", "--body-mass", "15 oz")
    assert cf.load("new.toml") == replace(cf.load("cue.toml"), body_mass=0.425242846875)
    assert stdout_of("convert", "shaft.csv", "shaft.toml", "--material", "ash").startswith("assumed:\n  no butt behind")
    assert cf.load("shaft.toml") == cf.load("shaft.csv", material="ash")
    stdout_of("convert", "scene.toml", "shaft.toml", "--body-mass", "0.4 kg", "--force")
    scene = cf.load("scene.toml")
    assert cf.load("shaft.toml") == replace(scene, cue=replace(scene.cue, body_mass=0.4))
