"""What a store holds is what was written: altered, lost, old, linked and by many sweeps at once (properties)."""

from __future__ import annotations

import json
import random
import sqlite3
import threading
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from contextlib import closing
from pathlib import Path
from typing import Any, ClassVar

import pytest

import cuefem as cf
from cuefem.design import Pool, Task, sweep
from cuefem.io import InputError
from cuefem.io.store import Store, opened, unlocked
from cuefem.io.study_files import load_study
from tests.helpers.command_line import call
from tests.helpers.refusals import command_refuses, untouched
from tests.helpers.sweeps import SCENE, STRUCK, changed, rows_of, swept, written

QUICK = STRUCK.replace('"squirt(0.3)", "end_mass", "vibration_energy(0.3)"', '"squirt(0.3)", "mass"')
GRID = """
scene = "scene.toml"
responses = ["end_mass", "mass"]
[resolution]
elements = 1
order = 8
modes = 4
[[vary]]
name = "bore"
path = "cue.segments[0].tip_bore"
values = ["0 mm", "1 mm", "2 mm", "3 mm"]
[[vary]]
path = "cue.segments[0].tip_diameter"
values = ["12 mm", "12.5 mm"]
"""


@pytest.fixture
def study(tmp_path: Path) -> Path:
    """A study whose table is there."""
    path = written(tmp_path, QUICK.replace("count = 150", "count = 40"))
    call("sweep", path)
    return path


def told(study: Path, *options: object) -> dict[str, Any]:
    """What `sweep --json` says."""
    code, out, _ = call("sweep", study, "--json", *options)
    assert code == 0
    return dict(json.loads(out))


# --- designs are known by what they are ------------------------------------------------------------------------------
EDITS = [  # what the study becomes, its designs, and how many of them were not there
    (("", ""), 8, 8),
    (('"3 mm"', '"3 mm", "4 mm"'), 10, 2),
    (('"12 mm", "12.5 mm"', '"12.5 mm", "12 mm", "13 mm"'), 12, 4),
    (('name = "bore"', 'name = "hole"'), 8, 0),
    (('path = "cue.segments[0].tip_diameter"\nvalues = ["12 mm", "12.5 mm"]', 'path = "tip.restitution"\n@'), 8, 4),
    (('"end_mass", "mass"', '"mass", "tip_stiffness"'), 8, 8),
    (("modes = 4", "modes = 5"), 8, 8),
]


def test_a_sweep_edited_time_after_time_computes_each_design_once(tmp_path: Path) -> None:
    """In one store, whatever the study is called; its table is the one of a store of its own."""
    for (old, new), size, fresh in EDITS:
        text = GRID.replace(old, new).replace("@", "values = [0.75, 0.8]")
        study = written(tmp_path, text)
        found = told(study, "--store", tmp_path / "all.sqlite")
        assert (found["designs"], found["evaluated"]) == (size, fresh), new
        (tmp_path / "own.sqlite").unlink(missing_ok=True)
        assert rows_of(tmp_path / "all.sqlite") == swept(study, tmp_path / "own.sqlite")
    assert told(written(tmp_path, GRID), "--store", tmp_path / "all.sqlite")["evaluated"] == 0


class Watched(ThreadPoolExecutor):
    """Notes what is known already of the designs that it is to compute."""

    known: ClassVar[set[tuple[str, ...]]] = set()

    def submit(self, work: Any, task: Task) -> Any:
        self.known.update(tuple(known) for known in task.known)
        return super().submit(work, task)


def test_a_response_more_is_all_that_is_computed(tmp_path: Path) -> None:
    """No strike is made again when a study that had struck asks for more."""
    call("sweep", written(tmp_path, QUICK))
    study = written(tmp_path, QUICK.replace('"mass"]', '"mass", "shaft_mass"]'))
    rows = swept(study, tmp_path / "study.sqlite", pool=Pool(lambda: Watched(1), 3))
    assert Watched.known == {("squirt(0.3)", "mass")}
    assert rows == swept(study, tmp_path / "own.sqlite")


def test_a_base_that_reaches_the_same_design_shares_it(tmp_path: Path) -> None:
    """A design is its scene, not the way to it; another scene, or another version of cuefem, is another design."""
    call("sweep", written(tmp_path, GRID))
    moved = SCENE.replace('tip_diameter = "12 mm"', 'tip_diameter = "12 mm"\ntip_bore = "2 mm"')
    assert told(written(tmp_path, GRID, moved))["evaluated"] == 0
    assert told(written(tmp_path, GRID, SCENE.replace("420 g", "421 g")))["evaluated"] == 8


def test_another_version_computes_again_and_says_so(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    study = written(tmp_path, GRID)
    call("sweep", study)
    monkeypatch.setattr("cuefem.io.store.physics", lambda: "another")
    code, out, err = call("sweep", study, "--json")
    assert (code, json.loads(out)["evaluated"]) == (0, 8)
    assert err.startswith(f"{tmp_path / 'study.sqlite'}: another version of cuefem computed this study before")
    study = written(tmp_path, GRID.replace("modes = 4", "modes = 5"))
    assert "the resolution changed from Resolution(elements=1, order=8, modes=4) to " in call("sweep", study)[2]


def test_studies_in_one_store_are_read_by_their_names(tmp_path: Path) -> None:
    store = tmp_path / "all.sqlite"
    call("sweep", written(tmp_path, GRID, name="grid.toml"), "--store", store)
    call("sweep", written(tmp_path, QUICK, name="quick.toml"), "--store", store)
    assert list(cf.frames.of_sweep(store).columns[-3:]) == ["squirt(0.3)", "mass", "failure"]
    assert len(cf.frames.of_sweep(store, "grid")) == 8
    assert cf.frames.sweep_grid(store, "grid").sizes["bore"] == 4
    with pytest.raises(InputError, match="must hold a study other; got quick, grid"):
        cf.frames.of_sweep(store, "other")


# --- what was altered is noticed -------------------------------------------------------------------------------------
ALTERED = [
    """UPDATE designs SET answer = replace(answer, '"mass": 0.5', '"mass": 0.6') WHERE design = 21""",
    "UPDATE designs SET answer = replace(answer, 'values', 'valued') WHERE design = 21",
    "UPDATE designs SET digest = x'00' WHERE design = 21",
    "UPDATE designs SET scene = x'00' WHERE design = 21",
    "UPDATE designs SET scene = (SELECT scene FROM designs WHERE design = 22) WHERE design = 21",
    "UPDATE designs SET answer = (SELECT answer FROM designs WHERE design = 22) WHERE design = 21",
]


@pytest.mark.parametrize("command", ALTERED)
def test_an_altered_design_is_computed_again(study: Path, command: str) -> None:
    """The command says which; a frame and an export never show it; the table is then as it was."""
    file = study.with_suffix(".sqlite")
    whole = rows_of(file)
    changed(file, command)
    with pytest.raises(InputError, match=r"study.sqlite: design 21 is not as it was written: `cuefem sweep` computes"):
        cf.frames.of_sweep(file)
    code, out, err = call("sweep", study, "--json")
    assert (code, json.loads(out)["evaluated"]) == (0, 1)
    assert err == f"damaged: {file}: design 21 was not as it was written and is computed again\n"
    assert rows_of(file) == whole
    assert call("sweep", study)[2] == ""


def test_designs_that_were_lost_are_computed_again(study: Path) -> None:
    whole = rows_of(study.with_suffix(".sqlite"))
    changed(study.with_suffix(".sqlite"), "DELETE FROM designs WHERE design IN (2, 33)")
    assert told(study)["evaluated"] == 2
    assert rows_of(study.with_suffix(".sqlite")) == whole


def test_an_altered_design_helps_no_other_study(tmp_path: Path) -> None:
    call("sweep", written(tmp_path, GRID))
    changed(tmp_path / "study.sqlite", "UPDATE designs SET answer = replace(answer, '0.', '1.') WHERE design = 3")
    assert told(written(tmp_path, GRID.replace('"12 mm", "12.5 mm"', '"12.5 mm", "12 mm"')))["evaluated"] == 1


def flip(study: Path, data: bytes, place: int, bit: int, table: list[Any]) -> bool:
    """Whether a flipped byte was noticed or did no harm: refused in words, or the table is the same."""
    file = study.with_name("flipped.sqlite")
    for old in study.parent.glob("flipped.*"):
        old.unlink()
    file.write_bytes(data[:place] + bytes([data[place] ^ bit]) + data[place + 1 :])
    return all(right(read, table) for read in (lambda: rows_of(file), lambda: swept(study, file)))


def right(read: Callable[[], list[Any]], table: list[Any]) -> bool:
    """Whether it reads the table, or refuses in one line."""
    try:
        return read() == table
    except InputError as error:
        return len(str(error).splitlines()) == 1 and "flipped.sqlite: " in str(error)


@pytest.mark.parametrize("count", [60, pytest.param(600, marks=pytest.mark.heavy)])
def test_any_flipped_byte_is_noticed_or_does_no_harm(study: Path, count: int) -> None:
    file, rng = study.with_suffix(".sqlite"), random.Random(count)
    data, table = file.read_bytes(), rows_of(file)
    for _ in range(count):
        place, bit = rng.randrange(len(data)), rng.randrange(1, 256)
        assert flip(study, data, place, bit, table), (place, bit)


# --- files from before designs were kept by what they are ------------------------------------------------------------
OLD = """
CREATE TABLE columns (name TEXT PRIMARY KEY, unit TEXT NOT NULL, role TEXT NOT NULL);
INSERT INTO "columns" VALUES('bore','m','varied');
INSERT INTO "columns" VALUES('cue.segments[0].material','','varied');
INSERT INTO "columns" VALUES('end_mass','kg','response');
CREATE TABLE designs (design INTEGER PRIMARY KEY, "bore" REAL, "cue.segments[0].material" TEXT, "end_mass" REAL,
failure TEXT);
INSERT INTO "designs" VALUES(0,0.0,'ash',5.32077548530270668519e-03,NULL);
INSERT INTO "designs" VALUES(1,0.015,'ash',NULL,
'Segment.tip_bore must be in [0, 0.012) m, its outer diameter; got 0.015');
CREATE TABLE study (key TEXT PRIMARY KEY, value TEXT NOT NULL);
INSERT INTO "study" VALUES('record','{"cuefem": "0.1.0", "sample": "None", "block": 256}');
PRAGMA application_id = 1131759205;
PRAGMA user_version = 1;
"""
SUMS = """
CREATE TABLE checksums (design INTEGER PRIMARY KEY, checksum BLOB NOT NULL);
INSERT INTO "checksums" VALUES(0,X'98AC55546E32B2FA');
INSERT INTO "checksums" VALUES(1,X'249F767A3867E826');
PRAGMA user_version = 2;
"""


@pytest.mark.parametrize("text", [OLD, OLD + SUMS], ids=["first", "second"])
def test_a_file_of_an_older_version_is_read_and_says_what_to_do(tmp_path: Path, text: str) -> None:
    file, study = tmp_path / "study.sqlite", written(tmp_path)
    with sqlite3.connect(file) as old:
        old.executescript(text)
    old.close()
    frame = cf.frames.of_sweep(file)
    assert frame["end_mass"].tolist()[0] == 5.320775485302707e-03
    assert frame["failure"].tolist()[1].startswith("Segment.tip_bore must be in [0, 0.012) m")
    assert frame.attrs["units"] == {"bore": "m", "cue.segments[0].material": "", "end_mass": "kg"}
    assert cf.frames.sweep_grid(file).sizes == {"bore": 2, "cue.segments[0].material": 1}
    untouched(tmp_path, "rename it, or name another file with --store", "sweep", study)
    assert call("sweep", study, "--store", tmp_path / "new.sqlite")[0] == 0
    if text != OLD:
        changed(file, "UPDATE designs SET end_mass = end_mass + 1e-9 WHERE design = 0")
        with pytest.raises(InputError, match="design 0 is not as it was written"):
            cf.frames.of_sweep(file)


# --- many sweeps, a full disk, a read-only folder --------------------------------------------------------------------
def test_sweeps_at_once_share_the_work(tmp_path: Path) -> None:
    """Five fresh sweeps on one file: hardly more is computed than by one; each has the whole table; nothing is left."""
    study, out = written(tmp_path, QUICK), tmp_path / "study.sqlite"
    barrier, computed, errors = threading.Barrier(5), list[int](), list[BaseException]()

    def run() -> None:
        wanted = load_study(study)
        _ = wanted.resolution
        barrier.wait()
        try:
            with Store(out, wanted, "study") as store:
                sweep(wanted, store)
                assert len(list(store.rows())) == 150
                computed.append(store.computed)
        except BaseException as error:
            errors.append(error)

    runs = [threading.Thread(target=run) for _ in range(5)]
    for thread in runs:
        thread.start()
    for thread in runs:
        thread.join()
    assert errors == []
    assert 150 <= sum(computed) <= 150 + 5 * 5 * 16  # a sweep that is done takes blocks over on which others are
    assert rows_of(out) == swept(study, tmp_path / "alone.sqlite")
    assert sorted(path.name for path in tmp_path.glob("study.sqlite*")) == ["study.sqlite"]


def test_blocks_of_a_sweep_that_was_killed_are_taken_over(tmp_path: Path) -> None:
    study = written(tmp_path, QUICK)
    wanted = load_study(study)
    killed = Store(tmp_path / "study.sqlite", wanted)
    block = dict(enumerate(next(wanted.blocks())))
    assert killed.take(block, from_others=False) is not None
    with Store(tmp_path / "study.sqlite", wanted) as other:
        assert other.take(block, from_others=False) is None
    call("sweep", study)
    assert rows_of(tmp_path / "study.sqlite") == swept(study, tmp_path / "own.sqlite")
    killed.close()


def test_another_name_of_the_file(tmp_path: Path) -> None:
    """By a symbolic link it is the same file; by a hard link SQLite would lose its journal, and nobody may have it."""
    study = written(tmp_path, GRID)
    call("sweep", study)
    (tmp_path / "soft.sqlite").symlink_to(tmp_path / "study.sqlite")
    assert told(study, "--store", tmp_path / "soft.sqlite")["evaluated"] == 0
    (tmp_path / "hard.sqlite").hardlink_to(tmp_path / "study.sqlite")
    for name in ("hard", "study", "soft"):
        untouched(tmp_path, "must have one name", "sweep", study, "--store", tmp_path / f"{name}.sqlite")
        with pytest.raises(InputError, match=f"{name}.sqlite: must have one name; got a file with hard links"):
            cf.frames.of_sweep(tmp_path / f"{name}.sqlite")
    (tmp_path / "study.sqlite").unlink()
    assert told(study, "--store", tmp_path / "hard.sqlite")["evaluated"] == 0


def test_a_full_disk_loses_nothing_that_was_written(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """What was written before stays, whole blocks of it; with room again the sweep goes on to the same table."""
    study, connect = written(tmp_path, QUICK), sqlite3.connect

    def cramped(*arguments: Any, **options: Any) -> sqlite3.Connection:
        file: sqlite3.Connection = connect(*arguments, **options)
        file.execute("PRAGMA max_page_count = 14")
        return file

    with monkeypatch.context() as full:
        full.setattr(sqlite3, "connect", cramped)
        command_refuses("database or disk is full", "sweep", study)
    rows, whole = rows_of(tmp_path / "study.sqlite"), swept(study, tmp_path / "whole.sqlite")
    there = {row[0] for row in rows}
    assert 16 < len(there) < 150
    assert rows == [row for row in whole if row[0] in there]
    assert told(study)["evaluated"] == 150 - len(rows)
    assert rows_of(tmp_path / "study.sqlite") == whole


def test_a_table_that_is_there_is_read_without_a_change(study: Path) -> None:
    before = study.with_suffix(".sqlite").read_bytes()
    found = told(study, "--export", study.with_suffix(".csv"))
    assert (found["evaluated"], found["designs"]) == (0, 40)
    assert study.with_suffix(".sqlite").read_bytes() == before
    assert len(study.with_suffix(".csv").read_text(encoding="utf-8").splitlines()) == 41
    assert sorted(path.suffix for path in study.parent.glob("study.*")) == [".csv", ".sqlite", ".toml"]


def test_what_sqlite_refuses_at_once_is_asked_again(tmp_path: Path) -> None:
    """It waits for no lock where two turn a new file to write-ahead: 17 of 1,200 sweeps begun together failed so."""
    path = tmp_path / "locked.sqlite"
    with closing(opened(path)) as first, closing(opened(path)) as second:
        second.execute("PRAGMA busy_timeout = 0")
        first.execute("BEGIN EXCLUSIVE")
        asked = [0]

        def ask() -> None:
            asked[0] += 1
            if asked[0] == 3:
                first.execute("COMMIT")
            second.execute("PRAGMA journal_mode = WAL")

        unlocked(ask)
        assert asked == [3]
        assert second.execute("PRAGMA journal_mode").fetchone() == ("wal",)
        with pytest.raises(sqlite3.OperationalError, match="syntax"):
            unlocked(lambda: second.execute("no SQL"))
