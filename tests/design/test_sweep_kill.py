"""Whatever is killed, the table is the one that nothing interrupted (properties); heavy, for they start processes."""

from __future__ import annotations

import os
import random
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import psutil
import pytest

from cuefem.design import Row, dask, processes, sweep
from cuefem.io.database import Database
from cuefem.io.study import load_study
from tests.helpers.command_line import call
from tests.helpers.sweeps import STRUCK, count_of, rows_of, written

pytestmark = pytest.mark.heavy

ROOT = str(Path(__file__).parents[2])
ENVIRONMENT = os.environ | {"PYTHONPATH": ROOT}
STUDY = STRUCK.replace("count = 150", "count = 3000")


@pytest.fixture(scope="module")
def study(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return written(tmp_path_factory.mktemp("sweep"), STUDY)


@pytest.fixture(scope="module")
def whole(study: Path) -> list[tuple[Any, ...]]:
    """The table of an uninterrupted sweep."""
    call("sweep", study, "--output", study.with_name("whole.sqlite"))
    rows = rows_of(study.with_name("whole.sqlite"))
    assert len(rows) == 3000
    return rows


@pytest.fixture(scope="module")
def small(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A study of few blocks, for what starts a cluster."""
    return written(tmp_path_factory.mktemp("small"), STRUCK.replace("count = 150", "count = 500"))


@pytest.fixture(scope="module")
def whole_small(small: Path) -> list[tuple[Any, ...]]:
    """The table of an uninterrupted sweep of it."""
    call("sweep", small, "--output", small.with_name("whole.sqlite"))
    rows = rows_of(small.with_name("whole.sqlite"))
    assert len(rows) == 500
    return rows


def command(study: Path, output: Path, *more: str) -> list[str]:
    return [
        sys.executable,
        str(Path(__file__).parents[1] / "helpers" / "sweep_run.py"),
        "sweep",
        str(study),
        "--output",
        str(output),
        *more,
    ]


def started(study: Path, output: Path, *more: str) -> subprocess.Popen[bytes]:
    quiet = subprocess.DEVNULL
    return subprocess.Popen(command(study, output, *more), env=ENVIRONMENT, stdout=quiet, stderr=quiet)


def written_so_far(output: Path) -> int:
    return count_of(output) if output.exists() and output.stat().st_size else 0


@pytest.mark.parametrize(("workers", "times"), [((), 3), (("--workers", "2"), 10)], ids=["alone", "two workers"])
def test_killed_over_and_over(
    study: Path, whole: list[tuple[Any, ...]], tmp_path: Path, workers: tuple[str, ...], times: int
) -> None:
    """kill -9 at a random moment after a new block, ten times; then left to finish. No row is lost or repeated."""
    output, rng, kept = tmp_path / "out.sqlite", random.Random(len(workers)), [0]
    while len(kept) <= times:
        run = started(study, output, *workers)
        began = time.monotonic()
        while run.poll() is None and written_so_far(output) == kept[-1] and time.monotonic() - began < 60:
            time.sleep(0.02)
        time.sleep(rng.uniform(0, 0.15))
        if run.poll() is not None:  # a machine so quick that the study ended first: it must be whole; then afresh
            assert rows_of(output) == whole
            output.unlink()
            kept = [0]
            rng = random.Random(rng.random())
            continue
        children = psutil.Process(run.pid).children(recursive=True)
        run.send_signal(signal.SIGKILL)
        run.wait()
        _, alive = psutil.wait_procs(children, timeout=20)
        assert alive == []  # workers end with the process that started them
        rows = rows_of(output)
        kept.append(len(rows))
        there = {row[0] for row in rows}
        assert rows == [row for row in whole if row[0] in there]
    assert kept == sorted(kept)
    assert kept[-1] > kept[1] > 0
    assert (
        subprocess.run(command(study, output, *workers), env=ENVIRONMENT, capture_output=True, check=True).stderr == b""
    )
    assert rows_of(output) == whole


def test_a_second_sweep_is_refused_and_a_killed_one_lets_go(
    study: Path, whole: list[tuple[Any, ...]], tmp_path: Path
) -> None:
    """Two processes on one file: the second ends at once, in one line; once the first is killed it goes on."""
    output = tmp_path / "out.sqlite"
    first = started(study, output, "--workers", "1")
    began = time.monotonic()
    while written_so_far(output) == 0 and time.monotonic() - began < 60:
        time.sleep(0.02)
    second = subprocess.run(command(study, output), env=ENVIRONMENT, capture_output=True, check=False)
    assert first.poll() is None
    assert second.returncode == 2
    assert second.stdout == b""
    (line,) = second.stderr.decode().splitlines()
    assert (
        line
        == f"cuefem: {output}: another sweep (process {first.pid}) is at work on it: let it end, or name another file"
    )
    children = psutil.Process(first.pid).children(recursive=True)
    first.send_signal(signal.SIGKILL)
    first.wait()
    psutil.wait_procs(children, timeout=20)
    subprocess.run(command(study, output), env=ENVIRONMENT, capture_output=True, check=True)
    assert rows_of(output) == whole


def swept(study: Path, output: Path, **more: Any) -> list[tuple[Any, ...]]:
    with Database(output, load_study(study)) as database:
        sweep(database.study, database, **more)
    return rows_of(output)


def killing(victims: Callable[[], list[int]], after: int) -> Callable[[list[Row]], None]:
    """Kill one process once ``after`` blocks are written."""
    seen = [0]

    def progress(rows: list[Row]) -> None:
        seen[0] += 1
        if seen[0] == after:
            os.kill(victims()[0], signal.SIGKILL)

    return progress


def spawned() -> list[int]:
    """Worker processes of this one."""
    children = psutil.Process().children(recursive=True)
    return [child.pid for child in children if any("spawn_main" in part for part in child.cmdline())]


def test_a_worker_killed_in_mid_study(small: Path, whole_small: list[tuple[Any, ...]], tmp_path: Path) -> None:
    assert swept(small, tmp_path / "out.sqlite", pool=processes(2), progress=killing(spawned, 5)) == whole_small


@contextmanager
def cluster(folder: Path) -> Iterator[Any]:
    from distributed import LocalCluster

    with LocalCluster(
        n_workers=2, threads_per_worker=1, processes=True, dashboard_address=":0", local_directory=str(folder)
    ) as found:
        yield found


@pytest.mark.parametrize("killed", [False, True], ids=["whole", "a worker killed"])
def test_a_cluster_of_processes(small: Path, whole_small: list[tuple[Any, ...]], tmp_path: Path, killed: bool) -> None:
    with cluster(tmp_path) as found, dask(found.scheduler_address) as pool:

        def workers() -> list[int]:
            return [worker.pid for worker in found.workers.values()]

        progress = killing(workers, 5) if killed else (lambda rows: None)
        assert swept(small, tmp_path / "out.sqlite", pool=pool, progress=progress) == whole_small


def test_the_command_on_a_cluster(small: Path, whole_small: list[tuple[Any, ...]], tmp_path: Path) -> None:
    with cluster(tmp_path) as found:
        output = tmp_path / "out.sqlite"
        done = subprocess.run(
            command(small, output, "--dask", found.scheduler_address), env=ENVIRONMENT, capture_output=True, check=True
        )
    assert done.stderr == b""
    assert rows_of(output) == whole_small


def test_a_scheduler_that_does_not_answer(small: Path, tmp_path: Path) -> None:
    output = tmp_path / "out.sqlite"
    done = subprocess.run(
        command(small, output, "--dask", "tcp://127.0.0.1:9"), env=ENVIRONMENT, capture_output=True, check=False
    )
    assert done.returncode == 2
    assert done.stdout == b""
    assert done.stderr.decode().startswith("cuefem: no Dask scheduler answers at 'tcp://127.0.0.1:9'")
    assert len(done.stderr.splitlines()) == 1
    assert not output.exists()


def test_memory_stays_flat_over_a_hundred_thousand_designs(tmp_path: Path) -> None:
    """Of 10^5 designs in blocks, the last nine tenths add no more than a tenth to the memory of the first."""
    text = STRUCK.replace("count = 150", "count = 100000").replace(
        '["squirt(0.3)", "end_mass", "vibration_energy(0.3)"]', '["frequency(1)", "tip_stiffness"]'
    )
    text, seen, sizes = text.replace("order = 10", "order = 5"), [0], []

    def watch(rows: list[Row]) -> None:
        seen[0] += len(rows)
        if seen[0] % 10240 == 0:
            sizes.append(psutil.Process().memory_info().rss)

    study = load_study(written(tmp_path, text))
    with Database(tmp_path / "out.sqlite", study) as database:
        sweep(study, database, progress=watch)
        assert database.count()[0] == 100000
    assert len(sizes) == 9
    assert 0.8 < max(sizes[1:]) / sizes[0] < 1.1
