"""The public names under the type checker of a careful user: no error, and mistakes found."""

import re
import subprocess
import sys
from pathlib import Path

import pytest

pytest.importorskip("mypy")
pytestmark = [pytest.mark.heavy, pytest.mark.nightly]

ROOT = Path(__file__).parents[1]
USER = """
import cuefem as cf

scene: cf.Scene = cf.load_scene("plain maple", game="carom")
solved: cf.SolvedDesign = cf.solve(scene)
verdict: cf.Verdict = cf.verdict(solved)
squirt: float = cf.strike(scene).squirt
many: cf.Outcomes = cf.batch_strike([scene, scene])
one: cf.Outcome = many[0]
rows: int = len(many.to_frame())
cue: cf.Cue = cf.load_cue("plain maple")
curve: cf.SquirtCurve = cf.squirt_curve(scene)
cf.end_mass(scene, "ofset")
cf.load_scene("plain maple", game="darts")
cf.squirt_curve(cue)
curve.sqirt
"""
MISTAKES = {13: "arg-type", 14: "arg-type", 15: "arg-type", 16: "attr-defined"}


def test_a_users_program_passes_strict_types_and_its_mistakes_are_found(tmp_path: Path) -> None:
    (tmp_path / "user.py").write_text(USER, encoding="utf-8")
    command = [sys.executable, "-m", "mypy", "--strict", "--config-file=", "--follow-imports=silent", "--no-pretty"]
    checked = subprocess.run(
        [*command, "--cache-dir", str(tmp_path / "cache"), "user.py"],
        cwd=tmp_path,
        env={"MYPYPATH": str(ROOT), "PATH": ""},
        capture_output=True,
        text=True,
    )
    errors = re.findall(r"^user\.py:(\d+): error: .*\[([a-z-]+)\]$", checked.stdout, re.MULTILINE)
    assert {int(line): kind for line, kind in errors} == MISTAKES, checked.stdout
