"""A study on a cue alone gives what it always gave and says so; with a game it is struck as every command strikes it
(properties)."""

from __future__ import annotations

from pathlib import Path

import pytest

import cuefem as cf
from cuefem.io.study_files import load_study
from tests.helpers.command_line import call
from tests.helpers.refusals import command_refuses
from tests.helpers.sweeps import OPTIMUM, SCATTER, SCENE, STUDY, written

CUE = SCENE.split("[tip]")[0].replace('game = "kim"\n[cue]\n', "").replace("cue.segments", "segments")
FEW = """
scene = "scene.toml"
responses = ["squirt(0.3)"]
[resolution]
elements = 1
order = 8
modes = 4
[[vary]]
path = "cue.segments[0].tip_diameter"
low = "11 mm"
high = "13 mm"
count = 3
"""
BARE = "scene.toml is a cue alone, struck with a ball of 210 g and a flat tip in contact for 2 ms, b/R 0.3 (game)"
USUAL = "scene.toml is a cue alone, struck with a usual stroke of pool (game)"


def test_of_kim_it_is_his_bare_stroke_and_without_a_game_that_of_pool(tmp_path: Path) -> None:
    study = written(tmp_path, f'game = "kim"\n{FEW}', scene=CUE)
    cue = cf.load(tmp_path / "scene.toml")
    assert isinstance(cue, cf.Cue)
    assert load_study(study).base == cf.Scene(cue, stroke=cf.Stroke(offset=0.3))
    status, out, err = call("study", study)
    assert (status, err) == (0, "")
    assert f"assumed: {BARE}" in " ".join(out.split())
    study = written(tmp_path, FEW, scene=CUE)
    assert load_study(study).base == cf.usual_scene(cue)
    assert USUAL in " ".join(call("study", study)[1].split())


@pytest.mark.parametrize("text", [FEW, SCATTER, OPTIMUM])
def test_a_game_gives_its_usual_stroke(tmp_path: Path, text: str) -> None:
    text = text.replace(
        'path = "tip.contact_time"\nlow = "0.8 ms"\nhigh = "1.5 ms"',
        'path = "stroke.speed"\nlow = "1 m/s"\nhigh = "3 m/s"',
    )
    study = written(tmp_path, f'game = "carom"\n{text}', scene=CUE)
    cue = cf.load(tmp_path / "scene.toml")
    assert isinstance(cue, cf.Cue)
    found = load_study(study)
    assert getattr(found, "study", found).base == cf.usual_scene(cue, "carom")


def test_a_game_is_for_a_cue_alone(tmp_path: Path) -> None:
    study = written(tmp_path, f'game = "pool"\n{STUDY}')
    command_refuses("study.toml: game: must be left out: scene.toml is a scene, which has", "study", study)
    study = written(tmp_path, f'game = "chess"\n{FEW}', scene=CUE)
    command_refuses("study.toml: game: must be one of pool, carom, snooker, kim; got 'chess'", "study", study)
