"""A study's table, block by block: evaluated anywhere, written by one, so that nothing is lost or done twice."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from concurrent.futures import FIRST_COMPLETED, BrokenExecutor, CancelledError, Future, wait
from typing import Any, NamedTuple, Protocol

from cuefem.design.evaluation import Failed, evaluate
from cuefem.design.ranges import Value
from cuefem.design.study import Study
from cuefem.design.workers import Pool

# A pool that breaks is opened again; this often in a row without a block done is too often.
ATTEMPTS = 3

Block = tuple[int, list[tuple[Value, ...]]]


class Row(NamedTuple):
    """A design: its number, what varied, its responses in SI (None if missing), and why one is missing, or None."""

    design: int
    values: tuple[Value, ...]
    responses: tuple[float | None, ...]
    failure: str | None


class Store(Protocol):
    """Where a sweep's rows go: ``write`` keeps the whole of a block, for good, or nothing of it."""

    def holds(self, first: int) -> bool:
        """Whether the block that begins with design number ``first`` is there."""

    def write(self, rows: list[Row]) -> None:
        """Add a block."""


def evaluated(study: Study, first: int, designs: list[tuple[Value, ...]]) -> list[Row]:
    """The rows of a block of designs, the first of them number ``first``. The same block gives the same bits."""
    scenes, reasons = {}, dict[int, str | None]()
    for i, values in enumerate(designs):
        try:
            scenes[i] = study.scene(values)
        except Failed as error:
            reasons[i] = " ".join(str(error).split())
    found = evaluate(list(scenes.values()), study.responses, at=study.resolution)
    numbers = dict(zip(scenes, found.values.tolist(), strict=True))
    reasons |= dict(zip(scenes, found.reasons, strict=True))
    nothing = [math.nan] * len(study.responses)
    return [
        Row(first + i, values, tuple(None if x != x else x for x in numbers.get(i, nothing)), reasons[i])
        for i, values in enumerate(designs)
    ]


def sweep(
    study: Study, store: Store, *, pool: Pool | None = None, progress: Callable[[list[Row]], object] = lambda rows: None
) -> None:
    """Evaluate the designs of a study that the store does not hold yet, and write them, a block at a time.

    Parameters
    ----------
    study : Study
        What to evaluate.
    store : Store
        Where the rows go. Only this process writes, and blocks may come in any order.
    pool : Pool, optional
        Executors that evaluate the blocks; by default this process does.
    progress : callable, optional
        Called with the rows of every block once they are written.

    Raises
    ------
    RuntimeError
        If the pool breaks time after time.
    """
    if pool is None:
        for first, designs in _missing(study, store):
            _keep(evaluated(study, first, designs), store, progress)
        return
    failures = 0
    while failures < ATTEMPTS:
        written = 0

        def told(rows: list[Row]) -> None:
            nonlocal written
            written += 1
            progress(rows)

        try:
            return _share(study, store, pool, told)
        except (BrokenExecutor, CancelledError):
            failures = 1 if written else failures + 1
    raise RuntimeError(f"worker processes died {ATTEMPTS} times without a block done: out of memory, or killed")


def _missing(study: Study, store: Store) -> Iterator[Block]:
    """Number of the first design, and designs, of the blocks that the store has not."""
    first = 0
    for designs in study.blocks():
        if not store.holds(first):
            yield first, designs
        first += len(designs)


def _keep(rows: list[Row], store: Store, progress: Callable[[list[Row]], object]) -> None:
    store.write(rows)
    progress(rows)


def _share(study: Study, store: Store, pool: Pool, progress: Callable[[list[Row]], object]) -> None:
    """Keep the pool's workers busy, never more than a few blocks ahead: memory does not grow with the study."""
    missing, waiting = _missing(study, store), set[Future[Any]]()
    with pool.open() as executor:
        try:
            while True:
                for first, designs in missing:
                    waiting.add(executor.submit(evaluated, study, first, designs))
                    if len(waiting) >= pool.ahead:
                        break
                if not waiting:
                    return
                done, waiting = wait(waiting, return_when=FIRST_COMPLETED)
                for future in done:
                    _keep(future.result(), store, progress)
        finally:
            for future in waiting:
                future.cancel()
