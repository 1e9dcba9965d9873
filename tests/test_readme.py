"""The README's words are kept: its two commands, its files load, its Python runs, its commands exist."""

import re
from pathlib import Path

import pytest

import cuefem
from cuefem.cli import main

ROOT = Path(__file__).parents[1]
TEXT = (ROOT / "README.md").read_text(encoding="utf-8")
BLOCKS = re.findall(r"^```(\w+)\n(.*?)^```", TEXT, flags=re.MULTILINE | re.DOTALL)
SHAFT = cuefem.Cue((cuefem.Segment(0.7, 0.0128, 0.021, cuefem.Material(13.9e9, 1.2e9, 705.0)),), 0.42)


def blocks(kind: str) -> list[str]:
    return [text for name, text in BLOCKS if name == kind]


def test_the_first_block_is_two_complete_commands() -> None:
    assert BLOCKS[0][0] == "sh"
    lines = BLOCKS[0][1].splitlines()
    assert len(lines) == 2
    assert lines[0].endswith("cuefem report meshes/kim.toml")
    assert lines[1].endswith("pytest")
    assert all(line.startswith("python3 -m venv") for line in lines)


@pytest.mark.parametrize("code", blocks("python"))
def test_python_runs(code: str, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    monkeypatch.chdir(ROOT)
    exec(compile(code, "README.md", "exec"), {})
    assert "5.26" in capsys.readouterr().out


def test_drawings_and_scenes_load(tmp_path: Path) -> None:
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
    assert sorted(kinds) == [("csv", "Cue"), ("toml", "Cue"), ("toml", "Scene")]


def test_commands_exist() -> None:
    named = set(re.findall(r"`cuefem ([a-z][a-z-]*)", TEXT))
    assert named <= set(main.commands)
    assert {"report", "modes", "end-mass", "strike"} <= named
