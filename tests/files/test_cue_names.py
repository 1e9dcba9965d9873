"""Cues by name, in calls, commands and files (regression)."""

import tomllib
from pathlib import Path

import pytest

import cuefem as cf
from cuefem.files.cue_names import CUES, cue_name, named_path
from cuefem.files.parts_catalogue import data_folder

ROOT = Path(__file__).parents[2]


def test_every_name_loads_its_drawing_and_comes_with_the_wheel() -> None:
    build = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))["tool"]["hatch"]["build"]
    included = build["targets"]["wheel"]["force-include"]
    for name, cue in CUES.items():
        assert cf.load(name) == cf.load(name.upper().replace(" ", "_")) == cf.load(data_folder() / cue.file)
        assert cue_name(named_path(Path(name))) == name
        folder = Path(cue.file).parent.as_posix()
        assert included[folder] == f"cuefem/ready/{folder}"


def test_words_of_one_name_are_enough_and_files_come_first(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    assert cue_name(named_path(Path("z2"))) == "predator z2"
    assert cue_name(named_path(Path("predator"))) == "predator z2"
    monkeypatch.chdir(tmp_path)
    (tmp_path / "carbon").mkdir()
    assert named_path(Path("carbon")) == Path("carbon")
