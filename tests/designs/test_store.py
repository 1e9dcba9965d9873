"""Stores: interruption, resumption, edited studies, damage, tables (properties)."""

import csv
import os
import random
import re
import signal
import time
from pathlib import Path

import pytest

from cuefem.designs import evaluate
from cuefem.designs.study_file import load_study
from cuefem.files import InputError
from tests.helpers.command_line import as_json, call, stdout_of
from tests.helpers.invalid_input import assert_unchanged, file_contents
from tests.helpers.sweeps import (
    GRID,
    SCENE,
    STRIKES,
    STUDY,
    alter_store,
    computed_rows,
    start_study,
    stored_count,
    wait_for_rows,
    write_study,
)


# --- kill -9, Ctrl-C, edits ------------------------------------------------------------------------------------------
@pytest.mark.heavy
def test_study_killed_edited_and_resumed_has_same_table(tmp_path: Path) -> None:
    """200 designs; kill -9 after 1, 5 and 9 blocks and a random while."""
    study, store = write_study(tmp_path, STRIKES.replace("count = 150", "count = 200")), tmp_path / "study.sqlite"
    counts, rng = [0], random.Random(2)
    for blocks in (1, 5, 9):
        run = start_study(study, "--workers", "2")
        wait_for_rows(store, run, 16 * blocks)
        time.sleep(rng.uniform(0, 0.05))
        os.killpg(run.pid, signal.SIGKILL)
        run.communicate()
        counts.append(stored_count(store))
    assert 0 < counts[1] <= counts[2] <= counts[3]
    whole, own = tmp_path / "whole.csv", tmp_path / "own.csv"
    assert as_json("study", study, "-o", whole)["evaluated"] == 200 - counts[3]
    edited = study.read_text(encoding="utf-8").replace("high = 1.3", "high = 1.4")
    study = write_study(tmp_path, edited, name="edited.toml")
    stdout_of("study", study, "--store", store, "-o", tmp_path / "edited.csv")
    for name, path in (("study", whole), ("edited", tmp_path / "edited.csv")):
        stdout_of("study", tmp_path / f"{name}.toml", "--store", tmp_path / f"fresh_{name}.sqlite", "-o", own)
        assert path.read_bytes() == own.read_bytes()
        assert len(own.read_bytes().splitlines()) == 201


@pytest.mark.heavy
@pytest.mark.parametrize("workers", [(), ("--workers", "2")], ids=["alone", "two workers"])
def test_study_interrupted_prints_one_line_and_stores_designs(tmp_path: Path, workers: tuple[str, ...]) -> None:
    study, store = write_study(tmp_path, STRIKES.replace("count = 150", "count = 3000")), tmp_path / "study.sqlite"
    run = start_study(study, *workers)
    wait_for_rows(store, run, 100)
    os.killpg(run.pid, signal.SIGINT)
    out, err = run.communicate(timeout=60)
    count = stored_count(store)
    assert (run.returncode, out) == (130, b"")
    progress = f"{count} of 3000 designs are stored in {store}"
    assert err.decode() == f"cuefem: interrupted; {progress}; run the same command to resume\n"
    assert 100 <= count < 3000


EDITS = [  # the edit of the study, its designs, and how many of them are new
    (("", ""), 8, 8),
    (('"3 mm"', '"3 mm", "4 mm"'), 10, 2),
    (('"12 mm", "12.5 mm"', '"12.5 mm", "12 mm", "13 mm"'), 12, 4),
    (('name = "bore"', 'name = "hole"'), 8, 0),
    (('"end_mass", "mass"', '"mass"'), 8, 0),
    (('"end_mass", "mass"', '"mass", "tip_stiffness"'), 8, 8),
    (("modes = 4", "modes = 5"), 8, 8),
]


@pytest.mark.heavy
def test_edited_study_computes_only_new_designs(tmp_path: Path) -> None:
    store = tmp_path / "all.sqlite"
    for (old, new), size, fresh in EDITS:
        study = write_study(tmp_path, GRID.replace(old, new))
        record = as_json("study", study, "--store", store)
        assert (record["designs"], record["evaluated"]) == (size, fresh), new
        (tmp_path / "own.sqlite").unlink(missing_ok=True)
        assert computed_rows(study, store) == computed_rows(study, tmp_path / "own.sqlite")
    edited = SCENE.replace('tip_diameter = "12 mm"', 'tip_diameter = "12.5 mm"')
    assert as_json("study", write_study(tmp_path, GRID, edited), "--store", store)["evaluated"] == 0  # the same designs
    heavier = SCENE.replace("420 g", "421 g")
    assert as_json("study", write_study(tmp_path, GRID, heavier), "--store", store)["evaluated"] == 8


def test_parts_in_stores_of_their_own_are_one_study(tmp_path: Path) -> None:
    study = write_study(tmp_path, GRID)
    stdout_of("study", study, "--store", tmp_path / "whole.sqlite", "-o", tmp_path / "whole.csv")
    counts, stores = list[int](), list[object]()
    for number in (1, 2, 3):
        record = as_json("study", study, "--part", f"{number}/3")
        assert record["store"] == str(tmp_path / f"study.{number}_of_3.sqlite")
        counts.append(record["designs"])
        stores += ["--store", record["store"]]
    assert counts == [3, 3, 2]
    before = file_contents(tmp_path)
    assert as_json("study", study, *stores, "-o", tmp_path / "table.csv")["evaluated"] == 0
    assert (tmp_path / "table.csv").read_bytes() == (tmp_path / "whole.csv").read_bytes()
    assert {path: file_contents(tmp_path)[path] for path in before} == before
    assert as_json("study", study, *stores[:4])["evaluated"] == 2  # into the first
    assert [stored_count(Path(str(each))) for each in stores[1::2]] == [5, 3, 2]


# --- damage ----------------------------------------------------------------------------------------------------------
@pytest.mark.heavy
def test_store_flipped_byte_raises_or_is_harmless(tmp_path: Path) -> None:
    store, rng = tmp_path / "study.sqlite", random.Random(1)
    study = write_study(tmp_path, GRID)
    table = computed_rows(study, store)
    data, flipped, lines = store.read_bytes(), tmp_path / "flipped.sqlite", list[str]()
    used = [position for position, byte in enumerate(data) if byte]  # most of a small file is empty
    for _ in range(120):
        position, bit = rng.choice(used), rng.randrange(1, 256)
        flipped.write_bytes(data[:position] + bytes([data[position] ^ bit]) + data[position + 1 :])
        try:
            assert computed_rows(study, flipped) == table
        except InputError as error:
            lines.append(str(error))
    assert len(lines) > 10
    assert all(line.startswith(f"{flipped}: ") and len(line.splitlines()) == 1 for line in lines)


# --- the table -------------------------------------------------------------------------------------------------------
@pytest.mark.parametrize("text", [STUDY, STRIKES.replace("count = 150", "count = 16")], ids=["grid", "sample"])
def test_csv_has_every_design_exactly(text: str, tmp_path: Path) -> None:
    """Equal to each design evaluated alone; an invalid design has a reason and no responses."""
    study = write_study(tmp_path, text)
    definition = load_study(study)
    stdout_of("study", study, "-o", tmp_path / "out.csv")
    with (tmp_path / "out.csv").open(newline="", encoding="utf-8") as file:
        head, *lines = csv.reader(file)
    units = zip(definition.columns, definition.units, strict=True)
    assert head == ["design", *(f"{name} [{unit}]" if unit else name for name, unit in units), "failure"]
    assert [int(line[0]) for line in lines] == list(range(definition.size))
    for line, values in [*zip(lines, definition.designs(), strict=True)][::3]:
        inside, responses = line[1 : 1 + len(values)], line[1 + len(values) : -1]
        assert inside == [value if isinstance(value, str) else repr(value) for value in values]
        if values[0] >= 0.012:
            assert line[-1].startswith("Segment.tip_bore must be in [0, 0.012) m, its outer diameter; got 0.01")
            assert set(responses) == {""}
        else:
            (alone,) = evaluate([definition.scene(values)], definition.responses, at=definition.at).values
            assert [float(x) for x in responses] == pytest.approx(alone, rel=1e-12)
            assert line[-1] == ""


DAMAGED = [
    ("PRAGMA application_id = 7", "must be a store of `cuefem study`; got another database"),
    ("UPDATE blocks SET answers = zeroblob(length(answers))", "is damaged: a design was altered"),
    ("""UPDATE blocks SET failures = '{"0": "none"}'""", "is damaged: a design was altered"),
]


@pytest.mark.parametrize(("statement", "message"), DAMAGED)
def test_store_altered_raises_and_is_unchanged(tmp_path: Path, statement: str, message: str) -> None:
    study, store = write_study(tmp_path, GRID), tmp_path / "study.sqlite"
    computed_rows(study, store)
    assert store.read_bytes()[68:72] == b"CuFf"  # SQLite's application_id, by which later versions know a store
    alter_store(store, statement)
    assert_unchanged(tmp_path, message, "study", study)


@pytest.mark.heavy
def test_parquet_has_the_table_of_the_csv(tmp_path: Path) -> None:
    parquet = pytest.importorskip("pyarrow.parquet")
    study = write_study(tmp_path)
    stdout_of("study", study, "-o", tmp_path / "out.csv", "-o", tmp_path / "out.parquet")
    with (tmp_path / "out.csv").open(newline="", encoding="utf-8") as file:
        head, *lines = csv.reader(file)
    table = parquet.read_table(tmp_path / "out.parquet")
    assert table.column_names == head
    texts = [
        ["" if x is None else x if isinstance(x, str) else repr(x) for x in row.values()] for row in table.to_pylist()
    ]
    assert texts == lines


@pytest.mark.heavy
def test_long_study_prints_a_line_every_tenth(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("cuefem.cli.progress.FIRST_LINE", 0.0)
    _, _, err = call("study", write_study(tmp_path))
    shares = [int(share) for share in re.findall(r"^cuefem: (\d+) % of 32 designs after \d+ s$", err, re.M)]
    assert len(shares) == len(err.splitlines()) > 1
    assert shares[-1] == 100
    assert all(share % 10 == 0 for share in shares)
    assert sorted({*shares}) == shares
