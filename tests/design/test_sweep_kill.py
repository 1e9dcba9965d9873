"""Whatever is killed, the table is the one that nothing interrupted (properties); heavy, for they start processes."""

from __future__ import annotations

import json
import os
import random
import signal
import socket
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Any

import psutil
import pytest

from cuefem.design import Row, dask, processes
from tests.helpers.command_line import call
from tests.helpers.sweeps import STRUCK, rows_of, swept, written

pytestmark = pytest.mark.heavy

ROOT = str(Path(__file__).parents[2])
ENVIRONMENT = os.environ | {"PYTHONPATH": ROOT}
STUDY = STRUCK.replace("count = 150", "count = 3000")
PATIENCE = 60  # s: only what hangs takes so long, on a busy machine too


@pytest.fixture(scope="module")
def study(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return written(tmp_path_factory.mktemp("sweep"), STUDY)


@pytest.fixture(scope="module")
def whole(study: Path) -> list[tuple[Any, ...]]:
    """The table of an uninterrupted sweep."""
    call("sweep", study, "--store", study.with_name("whole.sqlite"))
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
    call("sweep", small, "--store", small.with_name("whole.sqlite"))
    rows = rows_of(small.with_name("whole.sqlite"))
    assert len(rows) == 500
    return rows


def command(study: Path, output: Path, *more: str) -> list[str]:
    return [
        sys.executable,
        str(Path(__file__).parents[1] / "helpers" / "sweep_run.py"),
        "sweep",
        str(study),
        "--store",
        str(output),
        *more,
    ]


def started(
    study: Path, output: Path, *more: str, out: int = subprocess.DEVNULL, **options: Any
) -> subprocess.Popen[bytes]:
    return subprocess.Popen(command(study, output, *more), env=ENVIRONMENT, stdout=out, stderr=out, **options)


def written_so_far(output: Path) -> int:
    """How many designs can be read while a sweep is at work."""
    try:
        return len(rows_of(output))
    except ValueError:  # not begun yet
        return 0


def waited_for(output: Path, run: subprocess.Popen[bytes], rows: int) -> None:
    """Wait until so many rows are there, or the sweep has ended."""
    began = time.monotonic()
    while run.poll() is None and written_so_far(output) < rows and time.monotonic() - began < PATIENCE:
        time.sleep(0.02)


@pytest.mark.parametrize(("workers", "times"), [((), 3), (("--workers", "2"), 10)], ids=["alone", "two workers"])
def test_killed_over_and_over(
    study: Path, whole: list[tuple[Any, ...]], tmp_path: Path, workers: tuple[str, ...], times: int
) -> None:
    """kill -9 at a random moment after a new block, ten times; then left to finish. No row is lost or repeated."""
    output, rng, kept = tmp_path / "out.sqlite", random.Random(len(workers)), [0]
    while len(kept) <= times:
        run = started(study, output, *workers)
        waited_for(output, run, kept[-1] + 1)
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
        _, alive = psutil.wait_procs(children, timeout=PATIENCE)
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


def test_two_fresh_sweeps_at_once_share_the_work(study: Path, whole: list[tuple[Any, ...]], tmp_path: Path) -> None:
    """Two commands on one file, and a third while one of them is killed: the table is whole, little is done twice."""
    output, evaluated = tmp_path / "out.sqlite", 0
    runs = [started(study, output, "--json", out=subprocess.PIPE) for _ in range(2)]
    for run in runs:
        out, err = run.communicate()
        assert (run.returncode, err) == (0, b"")
        evaluated += json.loads(out)["evaluated"]
    assert 3000 <= evaluated <= 3000 + 10 * 16
    assert rows_of(output) == whole
    output.unlink()
    killed, other = started(study, output), started(study, output)
    waited_for(output, killed, 200)
    killed.send_signal(signal.SIGKILL)
    killed.wait()
    assert other.wait() == 0
    assert rows_of(output) == whole


def heard() -> None:
    """Ctrl-C reaches the command, although what runs in the background of a shell is made deaf to it."""
    signal.signal(signal.SIGINT, signal.SIG_DFL)


@pytest.mark.parametrize("workers", [(), ("--workers", "2")], ids=["alone", "two workers"])
def test_an_interrupt_says_what_is_there_and_how_to_go_on(
    study: Path, whole: list[tuple[Any, ...]], tmp_path: Path, workers: tuple[str, ...]
) -> None:
    """Ctrl-C, which a terminal sends to all processes of a command: one line, soon; the same command ends the work."""
    output = tmp_path / "out.sqlite"
    run = started(study, output, *workers, out=subprocess.PIPE, start_new_session=True, preexec_fn=heard)
    waited_for(output, run, 100)
    os.killpg(run.pid, signal.SIGINT)
    out, err = run.communicate(timeout=PATIENCE)
    (line,) = err.decode().splitlines()
    count = len(rows_of(output))
    assert (run.returncode, out) == (130, b"")
    assert line == f"cuefem: interrupted; {count} of 3000 designs are kept in {output}: the same command goes on"
    assert 100 <= count < 3000
    assert psutil.pids().count(run.pid) == 0
    done = subprocess.run(command(study, output, "--json"), env=ENVIRONMENT, capture_output=True, check=True)
    assert json.loads(done.stdout)["evaluated"] == 3000 - count
    assert rows_of(output) == whole


@pytest.mark.parametrize("delay", [0.0, 0.1, 0.3, 0.5, 0.8])
def test_an_interrupt_while_workers_start_is_one_line_too(study: Path, tmp_path: Path, delay: float) -> None:
    """Workers that are still importing say nothing of their end, nor does the thread that minds them."""
    output = tmp_path / "out.sqlite"
    run = started(study, output, "--workers", "2", out=subprocess.PIPE, start_new_session=True, preexec_fn=heard)
    while run.poll() is None and not spawned(run.pid):
        time.sleep(0.01)
    time.sleep(delay)
    os.killpg(run.pid, signal.SIGINT)
    _, err = run.communicate(timeout=PATIENCE)
    (line,) = err.decode().splitlines()
    assert run.returncode == 130
    assert line.startswith("cuefem: interrupted; ")


def killing(victims: Callable[[], list[int]], after: int) -> Callable[[list[Row]], None]:
    """Kill one process once ``after`` blocks are written."""
    seen = [0]

    def progress(rows: list[Row]) -> None:
        seen[0] += 1
        if seen[0] == after:
            os.kill(victims()[0], signal.SIGKILL)

    return progress


def spawned(parent: int | None = None) -> list[int]:
    """Worker processes of a process, this one by default."""
    found = []
    for child in psutil.Process(parent).children(recursive=True):
        with suppress(psutil.NoSuchProcess):  # it has ended, or is a zombie
            if any("spawn_main" in part for part in child.cmdline()):
                found.append(child.pid)
    return found


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


def test_a_scheduler_killed_in_mid_sweep(tmp_path: Path) -> None:
    """The command ends within 30 s, in one line that says what is there; without the cluster it goes on."""
    study, output = written(tmp_path, STUDY), tmp_path / "out.sqlite"
    quiet, address = subprocess.DEVNULL, f"tcp://127.0.0.1:{free_port()}"
    dask = [sys.executable, "-m", "distributed.cli.dask_scheduler", "--no-dashboard", "--port", address.split(":")[-1]]
    work = [sys.executable, "-m", "distributed.cli.dask_worker", address, "--nthreads", "1", "--no-dashboard"]
    scheduler = subprocess.Popen([*dask, "--host", "127.0.0.1"], cwd=tmp_path, stdout=quiet, stderr=quiet)
    worker = subprocess.Popen(work, cwd=tmp_path, env=ENVIRONMENT, stdout=quiet, stderr=quiet)
    try:
        run = started(study, output, "--dask", address, out=subprocess.PIPE)
        waited_for(output, run, 100)
        scheduler.kill()
        out, err = run.communicate(timeout=30)
    finally:
        for process in (scheduler, worker):
            process.kill()
            process.wait()
    count = len(rows_of(output))
    assert (run.returncode, out) == (1, b"")
    assert err.decode().splitlines() == [
        f"cuefem: the Dask scheduler at {address!r} answers no more; {count} of 3000 designs are kept in {output}: "
        "the same command goes on"
    ]
    assert count >= 100
    done = subprocess.run(command(study, output, "--json"), env=ENVIRONMENT, capture_output=True, check=True)
    assert json.loads(done.stdout)["evaluated"] == 3000 - count


def free_port() -> int:
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return int(probe.getsockname()[1])


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

    assert len(swept(written(tmp_path, text), tmp_path / "out.sqlite", progress=watch)) == 100000
    assert len(sizes) == 9
    assert 0.8 < max(sizes[1:]) / sizes[0] < 1.1
