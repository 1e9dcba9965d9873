"""Studies on executors: the serial results, workers that die, another version (properties)."""

from collections.abc import Collection
from concurrent.futures import BrokenExecutor, Executor, Future, ThreadPoolExecutor
from contextlib import nullcontext
from pathlib import Path
from typing import Any

import pytest

import cuefem as cf
from cuefem.designs.blocks import Block, BlockResult, Blocks
from cuefem.designs.design_key import code_digest
from cuefem.designs.executors import in_parallel
from cuefem.designs.study import Study
from cuefem.designs.study_file import load_study
from tests.helpers.invalid_input import assert_rejects
from tests.helpers.sweeps import GRID, assert_deadly_design_fails_alone, write_study


class Elsewhere(Executor):
    """An executor that changes results, or fails, as a worker of another machine might."""

    def __init__(self, result: Any) -> None:
        self.result = result

    def submit(self, work: Any, /, *arguments: Any, **options: Any) -> Future[Any]:
        future: Future[Any] = Future()
        if isinstance(self.result, Exception):
            future.set_exception(self.result)
        else:
            future.set_result(self.result)
        return future


def test_study_on_executor_of_caller_equals_serial_and_resumes(tmp_path: Path) -> None:
    study = load_study(write_study(tmp_path, GRID))
    assert isinstance(study, Study)
    serial = cf.study(study)
    with ThreadPoolExecutor(2) as executor:
        for _ in range(2):  # into an empty store, and from it
            assert cf.study(study, workers=executor, store=tmp_path / "some.sqlite").columns == serial.columns
        assert executor.submit(int).result() == 0  # it is still open


@pytest.mark.parametrize(
    ("result", "message"),
    [
        ("another", "a worker has another version of cuefem: install the same version of cuefem on every worker"),
        (ModuleNotFoundError("No module named 'cuefem'"), "a worker cannot run cuefem: No module named 'cuefem'; inst"),
    ],
)
def test_study_on_worker_without_this_cuefem_is_rejected(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, result: Any, message: str
) -> None:
    study = write_study(tmp_path, GRID)
    monkeypatch.setattr("cuefem.cli.study_command.dask_executor", lambda address: nullcontext(Elsewhere(result)))
    assert_rejects(message, "study", study, "--scheduler", "tcp://elsewhere:8786")


def test_blocks_grow_while_they_are_short() -> None:
    blocks = Blocks((i, (float(i),)) for i in range(112))
    sizes = []
    for block in blocks:
        sizes.append(len(block.numbers))
        blocks.adapt(BlockResult(block, "", b"", None, {}, seconds=0.01 if len(sizes) < 3 else 1.0))
    assert sizes == [16, 32, 64]


class Killed(BrokenExecutor):
    """What a cluster or a pool says of a task that ended its workers."""


class Deadly(Executor):
    """An executor whose workers end at some designs."""

    def __init__(self, deadly: Collection[int]) -> None:
        self.deadly = deadly

    def submit(self, work: Any, /, *arguments: Any, **options: Any) -> Future[Any]:
        future: Future[Any] = Future()
        if any(self.deadly & {*block.numbers} for block in arguments):
            future.set_exception(Killed())
        else:
            future.set_result(work(*arguments))
        return future


@pytest.mark.parametrize("workers", [2, None])
def test_designs_that_end_their_workers_fail_alone_unless_they_are_many(
    monkeypatch: pytest.MonkeyPatch, workers: int | None
) -> None:
    """Designs of the same block do not fail; 16 failures in a row are not blamed on the designs."""
    monkeypatch.setattr("cuefem.designs.executors._errors", lambda workers: ((Killed,), (OSError,)))

    def lost(deadly: set[int], count: int = 49) -> dict[int, str]:
        pool = Deadly(deadly)
        monkeypatch.setattr("cuefem.designs.executors._executor", lambda count: nullcontext(pool))
        blocks = [Block([*range(i, min(i + 16, count))], [()] * min(16, count - i)) for i in range(0, count, 16)]
        results = in_parallel(
            lambda block=None: BlockResult(block, code_digest(), b"", None, {}),
            blocks,
            workers or pool,
            lambda block: BlockResult(block, "", b"", None, dict.fromkeys(block.numbers, "lost"), is_lost=True),
        )
        done = [*results]
        assert sorted(number for result in done for number in result.block.numbers) == [*range(count)]
        return {number: why for result in done for number, why in result.failures.items()}

    for deadly in ({5}, {48}, {*range(48)} - {15, 31, 47}, set[int]()):
        assert lost(deadly) == dict.fromkeys(deadly, "lost")
    every_block = {*range(0, 1600, 16)}
    assert {*lost(every_block, 1600)} == every_block
    with pytest.raises(RuntimeError, match="workers ended for 16 designs in a row"):
        lost({*range(16)})


@pytest.mark.heavy
def test_design_that_ends_its_worker_fails_alone(tmp_path: Path) -> None:
    assert_deadly_design_fails_alone(tmp_path, 2)
