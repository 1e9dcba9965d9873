"""Computation of a study's designs, block by block: in this process, worker processes, or any executor."""

from __future__ import annotations

from collections.abc import Callable
from concurrent.futures import Executor
from dataclasses import dataclass
from functools import partial
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from cuefem.cue import Array
from cuefem.designs.blocks import Blocks, block_keys, compute_block, lost_block
from cuefem.designs.executors import in_parallel
from cuefem.designs.sampling import Value
from cuefem.designs.store import SqliteStore
from cuefem.designs.study import Study
from cuefem.quantity.equality import equal_fields
from cuefem.quantity.fields import check_count

ALONE = 2048  # designs whose keys this process makes faster than worker processes start


class Row(NamedTuple):
    """A design: its number, parameter values, responses in SI (None if missing), and the first error, or None."""

    design: int
    values: tuple[Value, ...]
    responses: tuple[float | None, ...]
    failure: str | None


@dataclass(frozen=True, eq=False)
class Columns:
    """The responses of all designs, (designs, responses) in SI, nan if missing, and reasons by the design's number."""

    values: Array
    failures: dict[int, str]

    @classmethod
    def of(cls, study: Study) -> Columns:
        """Columns without a value."""
        return cls(np.full((study.size, len(study.responses)), np.nan), {})

    __eq__ = equal_fields

    def row(self, design: int, values: tuple[Value, ...]) -> Row:
        """A design as a row."""
        numbers = tuple(None if x != x else x for x in self.values[design].tolist())
        return Row(design, values, numbers, self.failures.get(design))

    def add(self, numbers: list[int], values: Array, failures: dict[int, str]) -> None:
        """Fill in designs by number; failures: by place in ``numbers``."""
        self.values[numbers] = values
        self.failures.update({numbers[i]: reason for i, reason in failures.items()})


def compute_designs(
    study: Study,
    store: SqliteStore | None = None,
    *,
    workers: int | Executor | None = None,
    progress: Callable[[int], object] = lambda count: None,
    part: slice = slice(None),
) -> Columns:
    """Compute the designs of a study that are not stored, and store them, block by block.

    Parameters
    ----------
    study : Study
        The study.
    store : SqliteStore, optional
        The store, by default none. Blocks are written in any order.
    workers : int or Executor, optional
        Number of worker processes, or the executor of a cluster, such as Dask's ``Client.get_executor()`` or MPI's
        ``MPIPoolExecutor``, which the caller closes. By default this process computes.
    progress : callable, optional
        Called with the number of designs that were added to the result: stored ones, then each computed block.
    part : slice, optional
        Which of the designs are computed, by default all.

    Returns
    -------
    Columns
        The responses of all designs. They do not depend on the blocks or on where they are computed.

    Raises
    ------
    RuntimeError
        If worker processes die repeatedly, or an executor is lost. Stored designs remain.
    TypeError
        If ``workers`` is neither a number nor an executor.
    ValueError
        If ``workers`` is below 1, or a worker of an executor has no cuefem, or another version.

    Notes
    -----
    If the store holds designs, the keys of all designs are made first, by the workers, and only designs that are not
    stored are computed. Into an empty store the keys come with the responses.
    """
    if workers is not None and not isinstance(workers, Executor):
        check_count("workers", workers, 1)
    columns, missing = Columns.of(study), np.zeros(study.size, bool)
    missing[part] = True
    if store is not None and not store.is_empty:
        _add_stored(study, store, columns, missing, workers, progress)
    designs = ((i, values) for i, values in enumerate(study.designs()) if missing[i])
    blocks, work = Blocks(designs), partial(compute_block, study, store is not None)
    for result in in_parallel(work, blocks, workers, partial(lost_block, study)):
        if store is not None and not result.is_lost:
            store.write(result)
        assert result.values is not None
        columns.add(result.block.numbers, result.values, result.failures)
        blocks.adapt(result)
        progress(len(result.block.numbers))
    return columns


def _add_stored(
    study: Study,
    store: SqliteStore,
    columns: Columns,
    missing: NDArray[np.bool_],
    workers: int | Executor | None,
    progress: Callable[[int], object],
) -> None:
    """Add those of the missing designs that are stored to the columns; missing: (designs,), whether each is."""
    blocks = Blocks((i, values) for i, values in enumerate(study.designs()) if missing[i])
    where = None if isinstance(workers, int) and study.size <= ALONE else workers
    for result in in_parallel(partial(block_keys, study), blocks, where, partial(lost_block, study)):
        stored = store.read(result.keys)
        numbers = [result.block.numbers[place] for place in stored.places]
        columns.add(numbers, stored.values, stored.failures)
        missing[numbers] = False
        blocks.adapt(result)
        progress(len(numbers))
