"""What a sweep refuses, each in one line with exit status 2, and the database as it was (properties)."""

from __future__ import annotations

import os
import sqlite3
import sys
from collections.abc import Callable
from pathlib import Path

import pytest

from cuefem.design import sweep
from cuefem.io import database as tables
from cuefem.io.study import load_study
from tests.helpers.command_line import call
from tests.helpers.sweeps import SCENE, STRUCK, STUDY, rows_of, written

CHANGES = {
    "a misspelt field": ('tip.contact_time"', 'tip.contact_tim"', "vary[1].path: must name a field of the scene; got "),
    "the nearest name": ('tip.contact_time"', 'tip.contact_tim"', "did you mean contact_time"),
    "no such segment": ("segments[0].material", "segments[3].material", "where cue.segments has 1 items"),
    "a whole table": ('path = "tip.contact_time"', 'path = "tip"', "must name one number or a material"),
    "an empty list": ('["0.8 ms", "1.2 ms"]', "[]", "vary[1].values: must be a list of one value at least"),
    "an empty range": ('low = "0 mm"', 'low = "15 mm"', "vary[0]: low must be below high; got low = '15 mm', high ="),
    "a range the wrong way": ('low = "0 mm"', 'low = "1 m"', "an empty range"),
    "no steps": ("count = 16", "count = 0", "vary[0]: count must be a whole number >= 1; got 0"),
    "half a step": ("count = 16", "count = 1.5", "count must be a whole number >= 1; got 1.5"),
    "no count": ("count = 16", "", "vary[0].count: must be given"),
    "a unit of another kind": ('"1.2 ms"]', '"1.2 mm"]', "vary[1].values[1]: must be in [1e-6, 10] s, a time with"),
    "contradictory units": ('high = "15 mm"', 'high = "15 g"', "vary[0].high: must be in [0, inf) m, a length with"),
    "no unit": ('high = "15 mm"', "high = 15", "vary[0].high: must be in [0, inf) m, a length with its unit"),
    "fields of two units": ('"cue.segments[0].butt_bore"', '"ball.mass"', "fields of one unit; got 'kg' and 'm'"),
    "an unknown material": ('"ash"]', '"ahs"]', "vary[2].values[1]: no material is called 'ahs'; nearest: ash"),
    "a number for a material": ('"ash"]', "5]", "must be the name of a material"),
    "a range of materials": ('values = ["hard maple", "ash"]', 'low = "ash"', "vary[2]: must have values, names"),
    "values and ends": (
        "count = 16",
        'count = 16\nvalues = ["1 mm"]',
        "or middle and sd; got values, and low and high",
    ),
    "neither": ('values = ["0.8 ms", "1.2 ms"]', "", "or middle and sd; got none of them"),
    "an unknown spacing": ("count = 16", 'count = 16\nspacing = "log"', "must be linear or logarithmic; got 'log'"),
    "logarithms of zero": ("count = 16", 'count = 16\nspacing = "logarithmic"', "low must be above 0"),
    "a misspelt key": ("count = 16", "cuont = 16", "did you mean 'count'?"),
    "a misspelt table": ("[resolution]", "[resolutoin]", "did you mean 'resolution'?"),
    "a misspelt response": ('"tip_stiffness"', '"tip_stifness"', "responses[1]: must be one of"),
    "the nearest response": ('"tip_stiffness"', '"tip_stifness"', "did you mean tip_stiffness"),
    "no responses": ('responses = ["end_mass", "tip_stiffness", "frequency(1)"]', "", "responses: must be a list"),
    "a response twice": ('"tip_stiffness"', '"end_mass"', "different names; got 'end_mass' twice"),
    "no scene": ('scene = "scene.toml"', "", "scene: must be the path of a scene or a cue"),
    "a scene that is not there": ('"scene.toml"', '"other.toml"', "other.toml: cannot be read: No such file"),
    "half a resolution": ("modes = 6", "", "resolution.modes: must be given"),
    "a factor of a name": ('"ash"]', '"ash"]\nfactor = true', "factor must multiply a number"),
    "a factor of nothing": ('"tip.contact_time"', '"tip.stiffness"\nfactor = true', "factor must multiply a number"),
    "a factor that is none": ("count = 16", 'count = 16\nfactor = "yes"', "vary[0].factor: must be true or false"),
    "a shift of a name": ('"ash"]', '"ash"]\nshift = true', "shift must move a number"),
    "a factor and a shift": ('"0 mm"\nhigh = "15 mm"', "1\nhigh = 2\nfactor = true\nshift = true", "give one"),
    "a shift without a unit": (
        '"0 mm"\nhigh',
        "0\nshift = true\nhigh",
        "low: must be in (-inf, inf) m, a length",
    ),
    "taken from no field": (
        "count = 16",
        'count = 16\ntaken_from = "cue.lenght"',
        "taken_from: must name a field",
    ),
    "taken from a mass": (
        "count = 16",
        'count = 16\ntaken_from = "ball.mass"',
        "must name numbers of the unit",
    ),
    "taken from a number": (
        "count = 16",
        "count = 16\ntaken_from = 5",
        "must be a field, or a list of them",
    ),
    "a normal range of a grid": ('low = "0 mm"\nhigh = "15 mm"\ncount = 16', 'middle = "9 mm"', "give [sample]"),
}


@pytest.mark.parametrize(("old", "new", "words"), CHANGES.values(), ids=CHANGES.keys())
def test_a_study_that_is_none(tmp_path: Path, old: str, new: str, words: str) -> None:
    assert old in STUDY
    study = written(tmp_path, STUDY.replace(old, new, 1))
    refused(words, "sweep", study)
    assert not (tmp_path / "study.sqlite").exists()


BORES = 'low = "0 mm"\nhigh = "13 mm"'
SAMPLES = {
    "an unknown method": ('"sobol"', '"sobel"', "sample: method must be one of grid, sobol, halton"),
    "no seed": ("seed = 5", "", "sample.seed: must be given, a whole number; got nothing"),
    "a negative seed": ("seed = 5", "seed = -5", "sample: seed must be a whole number >= 0; got -5"),
    "no designs": ("count = 150", "count = 0", "sample: count must be a whole number >= 1; got 0"),
    "a misspelt key": ("seed = 5", "sed = 5", "did you mean 'seed'?"),
    "no width": (BORES, 'middle = "9 mm"', "vary[0].sd: must be given: a normal range has middle and sd"),
    "a negative width": (BORES, 'middle = "9 mm"\nsd = "-1 mm"', "vary[0].sd: must be in (0, inf) m; got"),
    "logarithms of none": (BORES, 'middle = "0 mm"\nsd = 0.1\nspacing = "logarithmic"', "middle must be above 0"),
    "a width with a unit": (
        BORES,
        'middle = "9 mm"\nsd = "1 mm"\nspacing = "logarithmic"',
        "vary[0].sd: must be a bare number in (0, inf)",
    ),
}


@pytest.mark.parametrize(("old", "new", "words"), SAMPLES.values(), ids=SAMPLES.keys())
def test_a_sample_that_is_none(tmp_path: Path, old: str, new: str, words: str) -> None:
    refused(words, "sweep", written(tmp_path, STRUCK.replace(old, new, 1)))


def refused(words: str, *arguments: object) -> None:
    code, out, err = call(*arguments)
    assert code == 2, err
    assert out == ""
    assert len(err.splitlines()) == 1
    assert err.startswith("cuefem: ")
    assert words in err


def altered(path: Path, *statements: str) -> None:
    with sqlite3.connect(path) as file:
        for statement in statements:
            file.execute(statement)
    file.close()


DATABASES: dict[str, tuple[Callable[[Path], object], str]] = {
    "a newer schema": (lambda p: altered(p, "PRAGMA user_version = 99"), "must be of schema 2 or older; got 99"),
    "another program's": (lambda p: altered(p, "PRAGMA application_id = 7"), "must be a database of `cuefem sweep`"),
    "no database": (lambda p: p.write_bytes(b"design,end_mass\n" * 100), "file is not a database"),
    "a torn one": (lambda p: p.write_bytes(p.read_bytes()[:5000]), "cannot be read or written as a database"),
    "one without a study": (lambda p: altered(p, "DELETE FROM study"), "got a database without one"),
}


@pytest.mark.parametrize(("spoil", "words"), DATABASES.values(), ids=DATABASES.keys())
def test_a_database_that_is_not_ours(tmp_path: Path, spoil: Callable[[Path], object], words: str) -> None:
    study = written(tmp_path)
    call("sweep", study)
    spoil(tmp_path / "study.sqlite")
    untouched(tmp_path, words, "sweep", study)


def untouched(folder: Path, words: str, *arguments: object) -> None:
    """Refused, and every file of the folder as it was."""
    before = {path: path.read_bytes() for path in folder.iterdir()}
    refused(words, *arguments)
    assert {path: path.read_bytes() for path in folder.iterdir()} == before


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (lambda study, scene: (study.replace('"1.2 ms"]', '"1.3 ms"]'), scene), "with another vary"),
        (lambda study, scene: (study.replace('"tip_stiffness"', '"mass"'), scene), "with another responses"),
        (lambda study, scene: (study, scene.replace("420 g", "421 g")), "with another scene"),
        (lambda study, scene: (study.replace("modes = 6", "modes = 7"), scene), "with another resolution"),
    ],
)
def test_a_database_of_another_study(tmp_path: Path, change: Callable[[str, str], tuple[str, str]], words: str) -> None:
    study = written(tmp_path)
    call("sweep", study)
    written(tmp_path, *change(STUDY, SCENE))
    untouched(tmp_path, f"study.sqlite: must hold this study; got another one, {words}", "sweep", study)


def test_a_file_that_cannot_be_made(tmp_path: Path) -> None:
    study = written(tmp_path)
    untouched(tmp_path, "unable to open database file", "sweep", study, "--output", tmp_path / "none" / "out.sqlite")


def test_a_full_disk_loses_nothing_that_was_written(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """What was written before stays, whole blocks of it; with room again the sweep goes on to the same table."""
    study, open_file = written(tmp_path, STRUCK), tables.connect
    call("sweep", study, "--output", tmp_path / "whole.sqlite")

    def cramped(path: Path) -> sqlite3.Connection:
        file = open_file(path)
        file.execute("PRAGMA max_page_count = 9")
        return file

    with monkeypatch.context() as full:
        full.setattr(tables, "connect", cramped)
        refused("database or disk is full", "sweep", study)
        rows = rows_of(tmp_path / "study.sqlite")
        assert 0 < len(rows) < 150
        assert len(rows) % 16 == 0
        untouched(tmp_path, "database or disk is full", "sweep", study)
    call("sweep", study)
    assert rows_of(tmp_path / "study.sqlite") == rows_of(tmp_path / "whole.sqlite")


def test_a_second_sweep_on_a_file_is_refused_until_the_first_ends(tmp_path: Path) -> None:
    """At once, before it works or touches the file; the first goes on."""
    path = written(tmp_path)
    study = load_study(path)
    with tables.Database(tmp_path / "study.sqlite", study) as first:
        untouched(tmp_path, f"study.sqlite: another sweep (process {os.getpid()}) is at work on it", "sweep", path)
        sweep(study, first)
        untouched(tmp_path, "is at work on it: let it end, or name another file", "sweep", path)
    assert call("sweep", path)[0] == 0
    assert len(rows_of(tmp_path / "study.sqlite")) == 64
    assert not list(tmp_path.glob("*.lock"))


def test_a_second_sweep_by_another_name_of_the_file(tmp_path: Path) -> None:
    study = load_study(written(tmp_path))
    (tmp_path / "other.sqlite").symlink_to(tmp_path / "study.sqlite")
    with (
        tables.Database(tmp_path / "study.sqlite", study),
        pytest.raises(ValueError, match=r"other.sqlite: another sweep \(process \d+\) is at work on it"),
    ):
        tables.Database(tmp_path / "other.sqlite", study)


def test_a_lock_that_nobody_holds_any_more(tmp_path: Path) -> None:
    """What a killed sweep leaves behind keeps nobody out."""
    study = written(tmp_path)
    (tmp_path / "study.sqlite.lock").write_text("4242\n", encoding="utf-8")
    assert call("sweep", study)[0] == 0
    assert not (tmp_path / "study.sqlite.lock").exists()


def test_a_refused_database_is_not_left_locked(tmp_path: Path) -> None:
    (tmp_path / "study.sqlite").write_bytes(b"design,end_mass\n" * 100)
    untouched(tmp_path, "file is not a database", "sweep", written(tmp_path))
    (tmp_path / "study.sqlite").unlink()
    assert call("sweep", tmp_path / "study.toml")[0] == 0


@pytest.mark.parametrize("suffix", ["xlsx", "sqlite"])
def test_an_export_of_an_unknown_kind(tmp_path: Path, suffix: str) -> None:
    study = written(tmp_path)
    untouched(tmp_path, "must end in .csv or .parquet", "sweep", study, "--export", tmp_path / f"out.{suffix}")


def test_without_its_library_parquet_is_refused_before_the_run(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "pyarrow", None)
    study = written(tmp_path)
    untouched(tmp_path, "pip install '.[parquet]' in the clone", "sweep", study, "--export", tmp_path / "out.parquet")


def test_an_export_that_cannot_be_written_is_refused_before_the_run(tmp_path: Path) -> None:
    study = written(tmp_path)
    untouched(tmp_path, "No such file or directory", "sweep", study, "--export", tmp_path / "nowhere" / "out.csv")


def test_workers_and_a_cluster(tmp_path: Path) -> None:
    code, out, err = call("sweep", written(tmp_path), "--workers", 2, "--dask", "tcp://localhost:8786")
    assert (code, out) == (2, "")
    assert "give one" in err


def test_without_its_library_dask_is_refused_with_a_word(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "distributed", None)
    study = written(tmp_path)
    untouched(tmp_path, "pip install '.[distributed]' in the clone", "sweep", study, "--dask", "tcp://localhost:1")
