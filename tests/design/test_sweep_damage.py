"""A byte of a sweep's file that is flipped changes no number that is exported; files without checksums load
(properties)."""

from __future__ import annotations

import json
import random
import sqlite3
from pathlib import Path

import pytest

from cuefem.design import sweep
from cuefem.io import InputError
from cuefem.io.database import Database, checksum, write_csv
from cuefem.io.study import load_study
from tests.helpers.command_line import call
from tests.helpers.sweeps import STRUCK, STUDY, rows_of, written

QUICK = STRUCK.replace('"squirt(0.3)", "end_mass", "vibration_energy(0.3)"', '"squirt(0.3)", "mass"')


@pytest.fixture
def study(tmp_path: Path) -> Path:
    """A study whose table is there."""
    path = written(tmp_path, QUICK.replace("count = 150", "count = 40"))
    call("sweep", path)
    return path


def altered(path: Path, command: str, *values: object) -> None:
    with sqlite3.connect(path) as file:
        file.execute(command, values)
    file.close()


def exported(study: Path, file: Path) -> str:
    """The table as CSV after the sweep went on with the file."""
    goal = file.with_suffix(".csv")
    with Database(file, load_study(study)) as database:
        sweep(database.study, database)
        write_csv(database, goal)
    return goal.read_text(encoding="utf-8")


def test_a_number_that_changed_in_the_file_is_computed_again(study: Path) -> None:
    """The command says which design, computes its block again, and exports the table as it was."""
    file = study.with_suffix(".sqlite")
    whole = rows_of(file)
    altered(file, "UPDATE designs SET mass = mass * 1.000001 WHERE design = 21")
    with sqlite3.connect(file) as other:
        (wrong,) = other.execute("SELECT mass FROM designs WHERE design = 21").fetchone()
    other.close()
    code, out, err = call("sweep", study, "--json", "--export", study.with_suffix(".csv"))
    assert code == 0
    assert err == f"damaged: {file}: design 21 is not as it was written; designs 16 to 31 are computed again\n"
    assert json.loads(out)["evaluated"] == 16
    assert rows_of(file) == whole
    assert repr(wrong) not in study.with_suffix(".csv").read_text(encoding="utf-8")
    assert call("sweep", study)[2] == ""


def test_rows_that_were_lost_are_computed_again(study: Path) -> None:
    file = study.with_suffix(".sqlite")
    whole = rows_of(file)
    altered(file, "DELETE FROM designs WHERE design = 33")
    code, _, err = call("sweep", study)
    assert code == 0
    assert err == f"damaged: {file}: 1 of the designs 32 to 39 are lost; designs 32 to 39 are computed again\n"
    assert rows_of(file) == whole


def test_a_row_that_changes_while_the_file_is_open_is_not_exported(study: Path) -> None:
    file = study.with_suffix(".sqlite")
    with Database(file, load_study(study)) as database:
        altered(file, "UPDATE designs SET failure = 'x' WHERE design = 7")
        with pytest.raises(
            InputError, match=r"study.sqlite: is damaged: design 7 is not as it was written; take a copy"
        ):
            list(database.rows())


def test_a_design_beyond_the_study(study: Path) -> None:
    altered(study.with_suffix(".sqlite"), "UPDATE designs SET design = 4096 WHERE design = 39")
    code, out, err = call("sweep", study)
    assert (code, out) == (2, "")
    assert "is damaged: it holds a design 4096, and the study has 40" in err


def flip(study: Path, data: bytes, place: int, bit: int, table: str) -> bool:
    """Whether a flipped byte was noticed or did no harm: refused in words, or the table is the same."""
    file = study.with_name("flipped.sqlite")
    for old in study.parent.glob("flipped.*"):
        old.unlink()
    file.write_bytes(data[:place] + bytes([data[place] ^ bit]) + data[place + 1 :])
    try:
        return exported(study, file) == table
    except InputError as error:
        return len(str(error).splitlines()) == 1 and str(file) in str(error)


@pytest.mark.parametrize("count", [60, pytest.param(600, marks=pytest.mark.heavy)])
def test_any_flipped_byte_is_noticed_or_does_no_harm(study: Path, count: int) -> None:
    file, rng = study.with_suffix(".sqlite"), random.Random(count)
    data, table = file.read_bytes(), exported(study, file)
    for _ in range(count):
        place, bit = rng.randrange(len(data)), rng.randrange(1, 256)
        assert flip(study, data, place, bit, table), (place, bit)


def first_schema(file: Path) -> None:
    """Make of it what the first schema was: the same tables without checksums."""
    altered(file, "DROP TABLE checksums")
    altered(file, "PRAGMA user_version = 1")


def test_a_file_of_the_first_schema_loads_as_it_stands(study: Path) -> None:
    file = study.with_suffix(".sqlite")
    whole = rows_of(file)
    first_schema(file)
    before = file.read_bytes()
    code, _, err = call("sweep", study, "--export", study.with_suffix(".csv"))
    assert (code, err) == (0, "")
    assert file.read_bytes() == before
    assert rows_of(file) == whole
    assert len(study.with_suffix(".csv").read_text(encoding="utf-8").splitlines()) == 41


def test_a_file_of_the_first_schema_goes_on_and_has_checksums_then(study: Path) -> None:
    file = study.with_suffix(".sqlite")
    whole = rows_of(file)
    first_schema(file)
    altered(file, "DELETE FROM designs WHERE design >= 16")
    assert call("sweep", study)[0] == 0
    assert rows_of(file) == whole
    altered(file, "UPDATE designs SET mass = 1.0 WHERE design = 3")
    assert "design 3 is not as it was written" in call("sweep", study)[2]
    assert rows_of(file) == whole


def test_a_checksum_is_of_what_the_file_gives_back(tmp_path: Path) -> None:
    """Whole numbers, zeros with a sign and nan in columns of numbers; names and reasons as text."""
    file = sqlite3.connect(tmp_path / "out.sqlite")
    file.execute("CREATE TABLE t (design INTEGER PRIMARY KEY, a REAL, b REAL, c REAL, d TEXT, failure TEXT)")
    row = (5, 1, -0.0, float("nan"), "hard maple", "zu schwer: 5 µm")
    file.execute("INSERT INTO t VALUES (?, ?, ?, ?, ?, ?)", row)
    assert checksum(file.execute("SELECT * FROM t").fetchone()) == checksum(row)
    file.close()
    assert checksum(row) != checksum((5, 1, 0.0, 5e-324, *row[4:]))


def test_the_table_of_a_grid_is_whole_too(tmp_path: Path) -> None:
    study = written(tmp_path, STUDY)
    call("sweep", study)
    with Database(study.with_suffix(".sqlite"), load_study(study)) as database:
        assert database.damaged == {}
        assert database.held() == 64
