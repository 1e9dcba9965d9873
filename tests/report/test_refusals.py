"""What cannot be handed over or moved: calls and commands, each with a part of the one line that says why."""

from __future__ import annotations

import shlex
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import cuefem as cf
from cuefem.contact.motion import motion
from studies.paper.closed_forms import alciatore_a31_mass_ratio
from tests.helpers.refusals import refuses, untouched
from tests.helpers.strike_scenes import KIM
from tests.helpers.sweeps import STUDY

SCENE = cf.Scene(KIM, cf.Ball(0.17, 0.028575), cf.Tip(0.75, 0.7, 1e-3), cf.Stroke(2.0, 0.3))
RAISED = replace(SCENE, effects=(cf.Elevation(0.1),))
LUMPED = replace(SCENE, cue=cf.LumpedCue(0.54, 0.005))
TIMES = "motion takes ascending times in [0, inf) s; got"
CALLS: list[tuple[Callable[[], object], str]] = [
    (lambda: alciatore_a31_mass_ratio(0.3, 0.0), "endless end mass in [A.31]; got 0 rad at offset 0.3"),
    (lambda: alciatore_a31_mass_ratio(0.3, -0.01), "endless end mass in [A.31]; got -0.01 rad at offset 0.3"),
    (lambda: alciatore_a31_mass_ratio(0.3, 1.5), "endless end mass in [A.31]; got 1.5 rad at offset 0.3"),
    (lambda: motion(SCENE, [-1e-3]), TIMES),
    (lambda: motion(SCENE, [1e-3, 0.0]), TIMES),
    (lambda: motion(SCENE, [np.nan]), TIMES),
    (lambda: motion(SCENE, []), TIMES),
    (lambda: motion(SCENE, [np.inf]), TIMES),
    (lambda: motion(RAISED, [0.0]), "motion takes strokes in the plane of cue and ball; got Elevation"),
    (lambda: motion(LUMPED, [0.0]), "Scene.cue must be a Cue of segments: its modes or its shape are needed"),
    (lambda: cf.save_motion(SCENE, "seen", frames=1), "save_motion: frames must be an integer in [2, 10000]; got 1"),
    (lambda: cf.save_motion(SCENE, "seen", until=0.0), "save_motion: until must be in (0, inf) s; got 0.0"),
    (lambda: cf.save_motion(SCENE, "seen", scale=np.nan), "save_motion: scale must be finite; got nan"),
    (lambda: cf.save_motion(RAISED, "seen"), "motion takes strokes in the plane of cue and ball; got Elevation"),
    (lambda: cf.save_motion(SCENE, Path(__file__)), "must be a new folder; there is one, or a file, of that name"),
    (lambda: cf.save_motion(SCENE, "none/seen", frames=2), "seen: cannot be written: No such file or directory"),
]
COMMANDS = [
    ("strike scene.toml --format pooltool --offset 0", "[A.31] has no squirt at the offset 0: --offset takes another"),
    (
        "strike scene.toml --format pooltool -o cue.json --offset 0.9",
        "the stroke miscues at offset 0.9, so",
    ),
    ("strike scene.toml --format pooltool -o cue.toml", "--output: must end in .html or .json; got '.toml'"),
    ("strike scene.toml --format pooltool -o none/cue.json", "none/cue.json: cannot be written: "),
    ("strike scene.toml --format pooltool -o dir.json", "dir.json: cannot be written: "),
    ("cost scene.toml --output cost.pdf", "must end in .html or .png or .svg; got '.pdf'"),
    ("cost lumped.toml", "must be a Cue of segments"),
    ("report lumped.toml -o page.pdf", "page.pdf: --output: must end in .html or .json; got '.pdf'"),
    ("report lumped.toml -o page.html --json", "page.html: --output: must be left out with --json"),
    ("report lumped.toml -o none/page.html", "none/page.html: cannot be written: No such file or directory"),
    ("report lumped.toml -o page.html --offset 1", "lumped.toml: --offset: must be between -1 and 1; got 1.0"),
    ("study study.toml -o page.pdf", "page.pdf: --output: must end in .html or .csv or .json or .toml; got '.pdf'"),
]


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    cf.save(SCENE, tmp_path / "scene.toml")
    cf.save(RAISED, tmp_path / "raised.toml")
    cf.save(LUMPED, tmp_path / "lumped.toml")
    (tmp_path / "study.toml").write_text(STUDY)
    (tmp_path / "dir.json").mkdir()
    monkeypatch.chdir(tmp_path)
    return tmp_path


@pytest.mark.parametrize(("ask", "message"), CALLS)
def test_calls(ask: Callable[[], object], message: str) -> None:
    refuses(ask, message)


@pytest.mark.parametrize(("command", "message"), COMMANDS, ids=[command for command, _ in COMMANDS])
def test_commands(folder: Path, command: str, message: str) -> None:
    untouched(folder, message, *shlex.split(command))
