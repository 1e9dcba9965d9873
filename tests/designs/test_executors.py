"""Studies on executors: the serial results, workers that die, another version (properties)."""

import os
from concurrent.futures import Executor, Future, ThreadPoolExecutor
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import cuefem as cf
from cuefem.designs.blocks import Block, BlockResult, Blocks, compute_block, lost_block
from cuefem.designs.executors import in_parallel
from cuefem.designs.study import Study
from cuefem.designs.study_file import load_study
from tests.helpers.sweeps import GRID, write_study

DEADLY = 21  # the design that ends its worker


def deadly_block(study: Study, block: Block) -> BlockResult:
    """Compute a block; the process ends at `DEADLY`, as if it was killed for its memory."""
    if DEADLY in block.numbers:
        os._exit(9)
    return compute_block(study, False, block)


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
    ("result", "error", "message"),
    [
        ("another", ValueError, "a worker has another version of cuefem: install the same version"),
        (ModuleNotFoundError("No module named 'cuefem'"), ValueError, "a worker cannot run cuefem: No module named"),
    ],
)
def test_study_on_worker_without_this_cuefem_raises(
    tmp_path: Path, result: Any, error: type[Exception], message: str
) -> None:
    study = load_study(write_study(tmp_path, GRID))
    with pytest.raises(error, match=message):
        cf.study(study, workers=Elsewhere(result))


def test_blocks_grow_while_they_are_short() -> None:
    blocks = Blocks((i, (float(i),)) for i in range(112))
    sizes = []
    for block in blocks:
        sizes.append(len(block.numbers))
        blocks.adapt(BlockResult(block, "", b"", None, {}, seconds=0.01 if len(sizes) < 3 else 1.0))
    assert sizes == [16, 32, 64]


@pytest.mark.heavy
def test_design_that_ends_its_worker_fails_alone(tmp_path: Path) -> None:
    study = load_study(
        write_study(tmp_path, GRID.replace('"12.5 mm"]', '"12.5 mm", "12.6 mm", "12.7 mm", "13 mm", "13.5 mm"]'))
    )
    assert isinstance(study, Study)
    whole, found = cf.study(study).columns, np.full((study.size, 2), np.nan)
    failures = dict[int, str]()
    blocks = Blocks(enumerate(study.designs()))
    for result in in_parallel(partial(deadly_block, study), blocks, 2, partial(lost_block, study)):
        assert result.values is not None
        found[result.block.numbers] = result.values
        failures |= {result.block.numbers[i]: reason for i, reason in result.failures.items()}
    assert [*failures] == [DEADLY]
    assert failures[DEADLY].endswith("times: out of memory, or killed")
    others = np.arange(study.size) != DEADLY
    np.testing.assert_array_equal(found[others], whole.values[others])
    assert np.isnan(found[DEADLY]).all()
