"""README and the handbook's chapters on use: commands and Python run, files load, paths exist (regression)."""

import itertools
import os
import re
import shlex
import shutil
import subprocess
import sys
from collections import Counter
from pathlib import Path
from typing import Any

import pytest

import cuefem
from cuefem.analysis import strike_grid
from cuefem.results.uncertainty import MODEL_ERROR, SHAFT_ERROR, SPRING_ERROR
from studies.paper import chain
from tests.helpers.command_line import call
from tests.helpers.contributors_guide import GUIDE
from tests.helpers.surfaces import outline_of, revolve, write_surface

ROOT = Path(__file__).parents[1]
README = (ROOT / "README.md").read_text(encoding="utf-8")
SENTENCES = " ".join(README.split())
# chapters of the handbook with further examples
MORE = [
    (ROOT / "cuefem" / "handbook" / f"{name}.md").read_text(encoding="utf-8")
    for name in ("files", "working", "accuracy", "side")
]
TEXT = "\n".join([README, *MORE])
BLOCKS = re.findall(r"^```(\w+)\n(.*?)^```", TEXT, flags=re.MULTILINE | re.DOTALL)
SHAFT = cuefem.Cue((cuefem.Segment(0.7, 0.0128, 0.021, cuefem.Material(13.9e9, 1.2e9, 705.0)),), 0.42)


def blocks(kind: str) -> list[str]:
    return [text for name, text in BLOCKS if name == kind]


FIRST, OWN_SHAFT, *COMMANDS = blocks("sh")


def test_sample_output_equals_command() -> None:
    (sample,) = re.findall(r"^```text\n(.*?)```", README, flags=re.MULTILINE | re.DOTALL)
    status, out, _ = call("report", ROOT / "meshes" / "pool_maple.toml")
    assert status == 0
    assert " ".join(sample.split()) in " ".join(out.split())


def test_chain_of_readme_equals_reduction_and_study() -> None:
    """Every number of the section on Kim's 12 g; the study's page is compared with its program."""
    scene = cuefem.load(ROOT / "studies" / "scenes" / "kim.toml")
    assert isinstance(scene, cuefem.Scene)
    own = cuefem.reduction(scene)
    rows = [line for line in README.splitlines() if line.startswith(("| Kim's guess", "| this shaft"))]
    assert rows == [f"| {' | '.join([*row[:4], *row[5:]])} |" for row in chain.chain_rows(own)]
    frequencies = ", ".join(f"{frequency:.0f}" for frequency in own.frequencies)
    assert f"has modes at {frequencies} Hz" in SENTENCES
    for phrase in ("2.3 to 2.7 times", "1.79", "1.52 ms", "1.71° and 2.82°", "1.135 ms", "20 to 23 g"):
        assert phrase in SENTENCES
        assert phrase in chain.STUDY.committed
    assert "squirt is twice as large" in SENTENCES


def test_trust_list_states_uncertainties_of_the_model() -> None:
    errors = (100 * error for error in (MODEL_ERROR, SPRING_ERROR))
    assert "{:.0f} % with a leather tip, {:.0f} % with a spring tip".format(*errors) in SENTENCES
    assert f"{100 * SHAFT_ERROR:.0f} % of the difference" in SENTENCES


def test_readme_is_short_and_begins_with_two_commands() -> None:
    assert len(README.splitlines()) <= 110
    assert len(FIRST.splitlines()) == 2
    assert FIRST.splitlines()[1] in GUIDE  # contributors install and test by the same line


@pytest.mark.heavy
def test_own_shaft_example_writes_report(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The block after the installation, which `.ci/run` tests."""
    monkeypatch.chdir(tmp_path)
    _, drawing, report = OWN_SHAFT.splitlines()
    subprocess.run(["bash", "-c", drawing], check=True)
    status, out, err = call(*shlex.split(report)[1:])
    assert (status, err, out.splitlines()[-1]) == (0, "", "wrote my_shaft.html")


def weighed(block: str) -> Any:
    """The block as a case; nightly where it computes three tables of strokes."""
    marks = pytest.mark.nightly if "table.json" in block else ()
    return pytest.param(block, id=" ".join(block.split()[:3]), marks=marks)


@pytest.mark.parametrize("block", [weighed(block) for block in COMMANDS])
def test_command_blocks_run(block: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    for name, few in (("COARSE", 3), ("STROKES", 12)):
        monkeypatch.setattr(strike_grid, name, few)  # of a table of strikes
    for name in ("meshes", "studies"):
        shutil.copytree(ROOT / name, tmp_path / name, ignore=shutil.ignore_patterns("*.svg", "*.png", "*.py", "data"))
    write_surface(tmp_path / "my_shaft.stl", *revolve(outline_of(SHAFT), 32))
    monkeypatch.chdir(tmp_path)
    for line in block.splitlines():
        program, *arguments = shlex.split(line, comments=True)
        if program == "python":
            subprocess.run([sys.executable, *arguments], env=os.environ | {"PYTHONPATH": str(ROOT)}, check=True)
            continue
        assert program == "cuefem"
        status, _, err = call(*arguments)
        assert (status, err) == (0, "")
        for option, path in itertools.pairwise(arguments):
            assert option != "-o" or (tmp_path / path).exists()


@pytest.mark.heavy
@pytest.mark.parametrize("code", blocks("python"))
def test_python_blocks_run(
    code: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    for name in ("meshes", "studies"):
        (tmp_path / name).symlink_to(ROOT / name)
    monkeypatch.chdir(tmp_path)  # a writable folder
    if "(CueEffect)" in code:  # a class of effects stays known to its process
        environment = os.environ | {"PYTHONPATH": str(ROOT)}
        ran = subprocess.run([sys.executable, "-c", code], env=environment, capture_output=True, text=True, check=True)
        assert float(ran.stdout) > 1
        return
    namespace: dict[str, object] = {}
    exec(compile(code, "README.md", "exec"), namespace)
    printed = capsys.readouterr().out
    for value in re.findall(r"# (\d+\.\d+) g$", code, flags=re.MULTILINE):
        assert value in printed


@pytest.mark.filterwarnings("ignore::cuefem.PlausibilityWarning")
def test_drawing_and_scene_blocks_load(tmp_path: Path) -> None:
    kinds = []
    for kind in ("toml", "csv"):
        for i, text in enumerate(blocks(kind)):
            path = tmp_path / f"{i}.{kind}"
            path.write_text(text, encoding="utf-8")
            if named := re.search(r'^cue = "(.*)"', text, flags=re.MULTILINE):
                cuefem.save(SHAFT, tmp_path / named[1])
            loaded = cuefem.load(path)
            assert type(loaded) is (cuefem.Scene if named else cuefem.Cue)
            kinds.append((kind, type(loaded).__name__))
    assert Counter(kinds) == {("csv", "Cue"): 2, ("toml", "Cue"): 2, ("toml", "Scene"): 2}
