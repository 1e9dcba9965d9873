"""README and the handbook's chapters on use: commands and Python run, files load, paths exist (regression)."""

import itertools
import os
import re
import shlex
import shutil
import subprocess
import sys
import tomllib
from collections import Counter
from pathlib import Path

import pytest

import cuefem
from tests.helpers.command_line import call
from tests.helpers.surfaces import outline_of, revolve, write_surface

ROOT = Path(__file__).parents[1]
README = (ROOT / "README.md").read_text(encoding="utf-8")
# chapters of the handbook with further examples
MORE = [
    (ROOT / "cuefem" / "handbook" / f"{name}.md").read_text(encoding="utf-8")
    for name in ("files", "working", "accuracy", "side")
]
TEXT = "\n".join([README, *MORE])
BLOCKS = re.findall(r"^```(\w+)\n(.*?)^```", TEXT, flags=re.MULTILINE | re.DOTALL)
SHAFT = cuefem.Cue((cuefem.Segment(0.7, 0.0128, 0.021, cuefem.Material(13.9e9, 1.2e9, 705.0)),), 0.42)
LINKS = re.findall(r"\]\(([^)#]+)\)", README)


def blocks(kind: str) -> list[str]:
    return [text for name, text in BLOCKS if name == kind]


FIRST, OWN_SHAFT, *COMMANDS = blocks("sh")


def test_sample_output_equals_command() -> None:
    (sample,) = re.findall(r"^```text\n(.*?)```", README, flags=re.MULTILINE | re.DOTALL)
    status, out, _ = call("report", ROOT / "meshes" / "pool_maple.toml")
    assert status == 0
    assert " ".join(sample.split()) in " ".join(out.split())


def test_code_blocks_are_of_tested_languages() -> None:
    assert {name for name, _ in BLOCKS} == {"sh", "csv", "toml", "python", "text"}  # text: formulas
    assert TEXT.count("```") == 2 * len(BLOCKS)


def test_own_shaft_example_writes_report(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The block after the installation, which `.ci/run` tests."""
    monkeypatch.chdir(tmp_path)
    _, drawing, report = OWN_SHAFT.splitlines()
    subprocess.run(["bash", "-c", drawing], check=True)
    status, out, err = call(*shlex.split(report)[1:])
    assert (status, err, out.splitlines()[-1]) == (0, "", "wrote my_shaft.html")


@pytest.mark.parametrize("block", COMMANDS, ids=lambda block: " ".join(block.split()[:3]))
def test_command_blocks_run(block: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
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


@pytest.mark.parametrize("code", blocks("python"))
def test_python_blocks_run(
    code: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    for name in ("meshes", "studies"):
        (tmp_path / name).symlink_to(ROOT / name)
    monkeypatch.chdir(tmp_path)  # a writable folder
    namespace: dict[str, object] = {}
    exec(compile(code, "README.md", "exec"), namespace)
    for value in re.findall(r"# (\d+\.\d+) g$", code, flags=re.MULTILINE):
        assert value in capsys.readouterr().out


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


def test_links_and_paths_exist() -> None:
    assert [link for link in LINKS if not (ROOT / link).exists()] == []
    paths = re.findall(r"`cuefem [^`]*?((?:studies|meshes)/[\w./]+)", TEXT)
    assert paths != []
    assert [path for path in paths if not (ROOT / path).exists()] == []


def test_citation_names_current_release() -> None:
    cited = (ROOT / "CITATION.cff").read_text(encoding="utf-8")
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    keys = dict(re.findall(r"^([a-z-]+): (.+)$", cited, flags=re.MULTILINE))
    assert keys["cff-version"] == "1.2.0"
    assert (keys["version"], keys["title"]) == (project["version"], project["name"])
    assert keys["license"] == project["license"]
    released = re.search(r"^## (\S+), (\d{4}-\d\d-\d\d)$", (ROOT / "CHANGELOG.md").read_text(), flags=re.MULTILINE)
    assert released is not None
    assert (released[1], released[2]) == (cuefem.__version__, keys["date-released"])
