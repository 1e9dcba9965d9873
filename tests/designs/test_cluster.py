"""Studies on a real Dask cluster: a scheduler and two workers as processes of the loopback address (verification)."""

import os
import socket
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path

import psutil
import pytest

from cuefem.designs.study_file import load_study
from cuefem.designs.study_result import compute_study
from tests.helpers.command_line import stdout_of
from tests.helpers.invalid_input import assert_rejects
from tests.helpers.sweeps import OPTIMUM, SCENE, STRIKES, start_study, stored_count, wait_for_rows, write_study

distributed = pytest.importorskip("distributed")
loky = pytest.importorskip("loky")

STUDY = STRIKES.replace("count = 150", "count = 500")
Processes = dict[str, subprocess.Popen[bytes]]


def end(process: subprocess.Popen[bytes]) -> None:
    """Kill a process and its children."""
    for each in (*psutil.Process(process.pid).children(recursive=True), psutil.Process(process.pid)):
        each.kill()
    process.wait()


@pytest.fixture
def cluster(tmp_path: Path) -> Iterator[tuple[str, Processes]]:
    """The address of a scheduler, and the processes: "scheduler", and two workers of one process each."""
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        port = free.getsockname()[1]
    address, folder = f"tcp://127.0.0.1:{port}", tmp_path / "dask"
    folder.mkdir()
    environment = os.environ | {"PYTHONPATH": str(Path(__file__).parents[2])}
    processes: Processes = {}

    def start(name: str, *arguments: str) -> None:
        with (folder / f"{name}.log").open("wb") as log:
            command = [sys.executable, "-m", f"distributed.cli.dask_{name.partition(' ')[0]}", *arguments]
            processes[name] = subprocess.Popen(command, env=environment, cwd=folder, stdout=log, stderr=log)

    try:
        start("scheduler", "--host", "127.0.0.1", "--port", str(port), "--dashboard-address", ":0", "--no-dashboard")
        for i in (1, 2):
            start(f"worker {i}", address, "--nthreads", "1", "--no-dashboard", "--local-directory", str(folder))
        with distributed.Client(address, timeout=60, set_as_default=False) as client:
            client.wait_for_workers(2, timeout=120)
        yield address, processes
    finally:
        for process in processes.values():
            if process.poll() is None:
                end(process)


@pytest.mark.heavy
def test_study_on_cluster_with_killed_worker_and_client_has_serial_table(
    tmp_path: Path, cluster: tuple[str, Processes]
) -> None:
    address, processes = cluster
    study, store = write_study(tmp_path, STUDY), tmp_path / "study.sqlite"
    whole, table = tmp_path / "whole.csv", tmp_path / "table.csv"
    stdout_of("study", study, "--store", tmp_path / "whole.sqlite", "-o", whole)
    run = start_study(study, "--scheduler", address)
    wait_for_rows(store, run, 64)
    run.kill()
    run.communicate()
    stored = stored_count(store)
    assert 64 <= stored < 500
    run = start_study(study, "--scheduler", address, "-o", str(table))
    wait_for_rows(store, run, stored + 64)
    nanny = psutil.Process(processes["worker 1"].pid)
    victims = [each for each in nanny.children(recursive=True) if "spawn_main" in " ".join(each.cmdline())]
    victims[0].kill()
    out, err = run.communicate(timeout=120)
    assert (run.returncode, err) == (0, b""), out
    assert table.read_bytes() == whole.read_bytes()
    assert stored_count(store) == 500


@pytest.mark.heavy
def test_study_lost_scheduler_prints_one_line_and_resumes(tmp_path: Path, cluster: tuple[str, Processes]) -> None:
    address, processes = cluster
    study, store = write_study(tmp_path, STUDY), tmp_path / "study.sqlite"
    run = start_study(study, "--scheduler", address)
    wait_for_rows(store, run, 64)
    end(processes["scheduler"])
    _, err = run.communicate(timeout=120)
    count = stored_count(store)
    message = f"{count} of 500 designs are stored in {store}; run the same command to resume\n"
    assert run.returncode == 1
    assert err.decode().startswith("cuefem: the ")
    assert err.decode().endswith(message)
    assert len(err.decode().splitlines()) == 1
    whole, table = tmp_path / "whole.csv", tmp_path / "table.csv"
    stdout_of("study", study, "-o", table)
    stdout_of("study", study, "--store", tmp_path / "whole.sqlite", "-o", whole)
    assert table.read_bytes() == whole.read_bytes()


@pytest.mark.heavy
def test_study_on_loky_equals_serial(tmp_path: Path) -> None:
    study = load_study(write_study(tmp_path, STRIKES))
    with loky.ProcessPoolExecutor(2) as executor:
        assert compute_study(study, workers=executor).columns == compute_study(study).columns


@pytest.mark.heavy
def test_study_without_scheduler_exits_within_seconds(tmp_path: Path) -> None:
    begun = time.monotonic()
    expected = "--scheduler: no Dask scheduler responds at tcp://127.0.0.1:9"
    assert_rejects(expected, "study", write_study(tmp_path), "--scheduler", "tcp://127.0.0.1:9")
    assert time.monotonic() - begun < 30


@pytest.mark.parametrize(
    ("text", "options", "message"),
    [
        (STUDY, ("--workers", "2"), "--workers (of this machine) and --scheduler (of a cluster) cannot be combined"),
        (OPTIMUM, (), "--store, --workers and --scheduler do not apply to an optimum"),
        (STUDY, (), "no Dask scheduler responds at nowhere: missing port number"),
    ],
)
def test_study_invalid_scheduler_is_rejected(tmp_path: Path, text: str, options: tuple[str, ...], message: str) -> None:
    assert_rejects(message, "study", write_study(tmp_path, text, SCENE), "--scheduler", "nowhere", *options)
