"""Cues by name, in calls, commands and files (regression)."""

import tomllib
from pathlib import Path

import pytest

import cuefem as cf
from cuefem.files.cue_names import CUES, cue_name, named_path
from cuefem.files.parts_catalogue import data_folder
from tests.helpers.command_line import as_json, call, stdout_of

ROOT = Path(__file__).parents[2]


@pytest.mark.parametrize("name", CUES)
def test_every_name_loads_its_drawing_and_comes_with_the_wheel(name: str) -> None:
    path = data_folder() / CUES[name].file
    assert cf.load(name) == cf.load(name.upper().replace(" ", "_")) == cf.load(path)
    assert cue_name(named_path(Path(name))) == name
    build = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))["tool"]["hatch"]["build"]
    folder = Path(CUES[name].file).parent.as_posix()
    assert build["targets"]["wheel"]["force-include"][folder] == f"cuefem/ready/{folder}"


def test_words_of_one_name_are_enough_and_files_come_first(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    assert cue_name(named_path(Path("z2"))) == "predator z2"
    assert cue_name(named_path(Path("predator"))) == "predator z2"
    monkeypatch.chdir(tmp_path)
    (tmp_path / "carbon").mkdir()
    assert named_path(Path("carbon")) == Path("carbon")


@pytest.mark.heavy
def test_compared_columns_carry_the_name() -> None:
    record = as_json("compare", "plain maple", "predator z2")
    assert [*record["cues"]] == record["files"] == ["plain maple", "predator z2"]
    assert "predator z2: inside and taper assumed (studies/measured)" in record["assumptions"]


def test_command_carries_the_name_and_what_is_assumed(tmp_path: Path) -> None:
    shown = stdout_of("strike", "low deflection")
    assert shown.startswith("low deflection: 730.6 mm")
    assert "a size that is sold, its inside assumed" in shown
    (tmp_path / "scene.toml").write_text('cue = "carbon"\ngame = "pool"\n', encoding="utf-8")
    assert "a size that is sold" in stdout_of("modes", tmp_path / "scene.toml")
    assert "predator z2" in stdout_of("parts")


@pytest.mark.heavy
def test_name_of_measured_cue_stands_for_its_folder() -> None:
    assert "Predator Z-2" in stdout_of("compare", "predator z2")
    assert cf.compare("predator z2").rows
    status, _, err = call("compare", "carbon")
    assert (status, "needs another FILE" in err) == (2, True)


def test_errors_and_hints_carry_the_name_instead_of_the_path() -> None:
    _, _, err = call("compare", "plain maple", "carbon", "--body-mass", "15 oz")
    assert err.startswith("cuefem: plain maple: --body-mass: would replace")
    _, _, err = call("strike", "carbon", "--offset", "2")
    assert err.startswith("cuefem: carbon: --offset: must be b/R")


@pytest.mark.heavy
def test_hint_quotes_a_name_of_two_words() -> None:
    assert "Design changes: cuefem improve 'plain maple'," in stdout_of("report", "plain maple")
