"""A sweep loses nothing, does nothing twice, and its table does not depend on how it came about (properties)."""

from __future__ import annotations

import csv
import json
import random
from collections.abc import Callable
from concurrent.futures import BrokenExecutor, Executor, Future, ThreadPoolExecutor
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow.parquet as pq
import pytest

from cuefem import Resolution
from cuefem.design import Pool, Row, evaluate
from cuefem.io.study_files import load_study
from tests.helpers.command_line import call
from tests.helpers.sweeps import SCENE, STRUCK, STUDY, rows_of, swept, written


@pytest.fixture(params=[STUDY, STRUCK], ids=["grid", "sample"])
def study(request: pytest.FixtureRequest, tmp_path: Path) -> Path:
    return written(tmp_path, request.param)


@pytest.mark.heavy
def test_the_table_holds_every_design(study: Path, tmp_path: Path) -> None:
    """Each evaluated alone, from what the table says of it, gives the same to 1e-10."""
    found = load_study(study)
    rows = swept(study, tmp_path / "out.sqlite")
    assert [row[0] for row in rows] == list(range(found.size))
    varied = len(found.vary)
    good = [row for row in rows if row[-1] is None]
    chosen = random.Random(1).sample(good, min(100, len(good)))
    assert len(chosen) == (100 if found.sample else 48)
    for row in chosen:
        (alone,) = evaluate([found.scene(row[1 : 1 + varied])], found.responses, at=found.resolution).values
        np.testing.assert_allclose(row[1 + varied : -1], alone, rtol=1e-10)


def test_designs_that_fail_say_why(study: Path, tmp_path: Path) -> None:
    """A bore wider than the shaft; their responses are empty, and only theirs."""
    found = load_study(study)
    for row in swept(study, tmp_path / "out.sqlite"):
        responses, failure = row[1 + len(found.vary) : -1], row[-1]
        if row[1] >= 0.012:
            assert failure.startswith("Segment.tip_bore must be in [0, 0.012) m, its outer diameter; got 0.01")
            assert set(responses) == {None}
        else:
            assert failure is None
            assert all(number > 0 for number in responses)


class Stopped(Exception):
    """What interrupts a sweep in a test."""


@pytest.mark.parametrize("after", [1, 2, 5])
def test_an_interrupted_sweep_goes_on(tmp_path: Path, after: int) -> None:
    study = written(tmp_path, STRUCK)
    seen: list[Row] = []

    def interrupt(rows: list[Row]) -> None:
        seen.extend(rows)
        if len(seen) >= 16 * after:
            raise Stopped

    with pytest.raises(Stopped):
        swept(study, tmp_path / "out.sqlite", progress=interrupt)
    assert len(rows_of(tmp_path / "out.sqlite")) == 16 * after
    later: list[Row] = []
    rows = swept(study, tmp_path / "out.sqlite", progress=later.extend)
    assert len(later) == 150 - 16 * after
    assert rows == swept(study, tmp_path / "whole.sqlite")


def threads(count: int) -> Pool:
    return Pool(lambda: ThreadPoolExecutor(count), 2 * count + 1)


@pytest.mark.heavy
@pytest.mark.parametrize("count", [1, 3])
def test_any_executor_gives_the_same_table(tmp_path: Path, count: int) -> None:
    study = written(tmp_path, STRUCK)
    rows = swept(study, tmp_path / "pool.sqlite", pool=threads(count))
    assert rows == swept(study, tmp_path / "alone.sqlite")


class Breaking(ThreadPoolExecutor):
    """Breaks after a number of blocks, as a process pool does whose worker is killed."""

    def __init__(self, blocks: int) -> None:
        super().__init__(1)
        self.blocks = blocks

    def submit(self, *arguments: Any, **more: Any) -> Future[Any]:
        self.blocks -= 1
        if self.blocks < 0:
            broken: Future[Any] = Future()
            broken.set_exception(BrokenExecutor("a worker died"))
            return broken
        return super().submit(*arguments, **more)


def breaking(blocks: Callable[[], int]) -> Pool:
    def start() -> Executor:
        return Breaking(blocks())

    return Pool(start, 2)


@pytest.mark.heavy
def test_a_pool_that_breaks_is_opened_again(tmp_path: Path) -> None:
    study = written(tmp_path, STRUCK)
    rows = swept(study, tmp_path / "pool.sqlite", pool=breaking(lambda: 3))
    assert rows == swept(study, tmp_path / "alone.sqlite")


def test_a_pool_that_only_breaks_is_given_up(tmp_path: Path) -> None:
    study, opened = written(tmp_path, STRUCK), []

    def none() -> int:
        opened.append(1)
        return 0

    with pytest.raises(RuntimeError, match="worker processes died 3 times without a block done"):
        swept(study, tmp_path / "pool.sqlite", pool=breaking(none))
    assert len(opened) == 3
    assert rows_of(tmp_path / "pool.sqlite") == []


def test_few_blocks_wait_at_once(tmp_path: Path) -> None:
    """Memory does not grow with the study: no more blocks are handed out than the pool asks for."""
    study, waiting, most = written(tmp_path, STRUCK), [0], [0]

    class Counting(ThreadPoolExecutor):
        def submit(self, *arguments: Any, **more: Any) -> Future[Any]:
            waiting[0] += 1
            most[0] = max(most[0], waiting[0])
            return super().submit(*arguments, **more)

    def done(rows: list[Row]) -> None:
        waiting[0] -= 1

    swept(study, tmp_path / "out.sqlite", pool=Pool(lambda: Counting(1), 3), progress=done)
    assert most[0] == 3
    assert waiting[0] == 0


HEADINGS = [
    *("design", "bore [m]", "tip.contact_time [s]", "cue.segments[0].material"),
    *("end_mass [kg]", "tip_stiffness [N/m]", "frequency(1) [Hz]", "failure"),
]


def test_csv_holds_every_bit(tmp_path: Path) -> None:
    call("sweep", written(tmp_path), "--export", tmp_path / "out.csv")
    with (tmp_path / "out.csv").open(newline="", encoding="utf-8") as file:
        headings, *lines = csv.reader(file)
    assert headings == HEADINGS
    read = [
        (int(d), float(b), float(t), m, *(float(x) if x else None for x in rest), failure or None)
        for d, b, t, m, *rest, failure in lines
    ]
    assert read == rows_of(tmp_path / "study.sqlite")


def test_parquet_holds_every_bit(tmp_path: Path) -> None:
    call("sweep", written(tmp_path), "--export", tmp_path / "out.parquet")
    table = pq.read_table(tmp_path / "out.parquet")
    assert table.column_names == HEADINGS
    rows = list(zip(*(column.to_pylist() for column in table.columns), strict=True))
    assert rows == rows_of(tmp_path / "study.sqlite")


def test_a_base_scene_in_a_wrong_unit_is_remarked(tmp_path: Path) -> None:
    study = written(tmp_path, scene=SCENE.replace('"420 g"', '"42 kg"'))
    code, _, err = call("sweep", study)
    assert code == 0
    assert err.startswith("unusual: mass of the whole cue 42.1")
    assert err.count("\n") == 1


def test_the_command_sweeps_and_goes_on(tmp_path: Path) -> None:
    study = written(tmp_path)
    code, out, err = call("sweep", study)
    assert (code, err) == (0, "")
    assert out.splitlines()[0] == f"64 designs in {tmp_path / 'study.sqlite'}"
    assert out.splitlines()[1].startswith(
        "16 failed, the first of them design 48: Segment.tip_bore must be in [0, 0.012)"
    )
    found = json.loads(call("sweep", study, "--json")[1])
    assert (found["designs"], found["evaluated"], found["failed"]) == (64, 0, 16)
    assert found["resolution"] == {"elements": 1, "order": 12, "modes": 6}


SWEEPS = sorted((Path(__file__).parents[2] / "studies" / "sweeps").glob("*.toml"))


@pytest.mark.parametrize("path", SWEEPS, ids=lambda path: path.stem)
def test_the_ready_studies_have_answers(path: Path) -> None:
    """The first design of each, evaluated coarsely."""
    found = load_study(path)
    first = next(found.blocks())[0]
    answer = evaluate([found.scene(first)], found.responses, at=Resolution(1, 12, 6))
    assert answer.reasons == (None,)
    assert np.all(answer.values > 0)


def test_a_bare_cue_is_struck_at_the_default_offset(tmp_path: Path) -> None:
    cue = SCENE.replace("cue.segments", "segments").replace('game = "kim"\n[cue]\n', "").partition("[tip]")[0]
    found = load_study(written(tmp_path, f'game = "kim"\n{STUDY}', cue))
    assert found.base.stroke.offset == 0.3
