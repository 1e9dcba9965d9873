"""A sweep keeps what it has written: on a full disk, and against a second sweep on the same file (properties)."""

from __future__ import annotations

import os
import sqlite3
from pathlib import Path

import pytest

from cuefem.design import sweep
from cuefem.io import database as tables
from cuefem.io.study import load_study
from tests.helpers.command_line import call
from tests.helpers.refusals import command_refuses, untouched
from tests.helpers.sweeps import STRUCK, rows_of, written


@pytest.mark.heavy
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
        command_refuses("database or disk is full", "sweep", study)
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


def test_workers_and_a_cluster(tmp_path: Path) -> None:
    code, out, err = call("sweep", written(tmp_path), "--workers", 2, "--dask", "tcp://localhost:8786")
    assert (code, out) == (2, "")
    assert "give one" in err
