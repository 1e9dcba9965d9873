"""Computation of a study's designs, block by block, in this process or worker processes."""

from __future__ import annotations

import os
import signal
import threading
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import FIRST_COMPLETED, BrokenExecutor, Executor, Future, ProcessPoolExecutor
from concurrent.futures import wait as wait_for
from contextlib import contextmanager
from dataclasses import dataclass, field
from functools import partial
from itertools import chain, count, islice
from multiprocessing import get_context, parent_process, resource_tracker
from typing import NamedTuple, ParamSpec, Protocol, TypeVar

from cuefem.design.sampling import Value
from cuefem.design.study import Study

BLOCK = 16  # designs that are evaluated and stored at a time
ATTEMPTS = 3  # at a pool that breaks without a result in between
CHECK_INTERVAL = 1.0  # s, of waits: on Windows Ctrl-C does not interrupt a wait without a limit

T = TypeVar("T")
R = TypeVar("R")
P = ParamSpec("P")


class Row(NamedTuple):
    """A design: its number, parameter values, responses in SI (None if missing), and the first error, or None."""

    design: int
    values: tuple[Value, ...]
    responses: tuple[float | None, ...]
    failure: str | None


class Store(Protocol):
    """Stored rows of a study."""

    def missing(self, designs: dict[int, tuple[Value, ...]]) -> dict[int, tuple[Value, ...]]:
        """The designs of a block, by number, that are not stored."""

    def write(self, rows: list[Row]) -> None:
        """Store the rows of a task, all or none of them."""

    def rows(self) -> Iterator[Row]:
        """All rows in the order of the designs."""


@dataclass
class MemoryStore:
    """A store in memory."""

    results: list[Row] = field(default_factory=list)

    def missing(self, designs: dict[int, tuple[Value, ...]]) -> dict[int, tuple[Value, ...]]:
        """All designs."""
        return designs

    def write(self, rows: list[Row]) -> None:
        """Store rows."""
        self.results += rows

    def rows(self) -> Iterator[Row]:
        """All rows in the order of the designs."""
        return iter(sorted(self.results, key=lambda row: row.design))


def compute_rows(study: Study, designs: dict[int, tuple[Value, ...]]) -> list[Row]:
    """The rows of designs, bit for bit independent of the other designs of the block."""
    evaluation = study.evaluate([*designs.values()])
    results = zip(designs.items(), evaluation.values.tolist(), evaluation.reasons, strict=True)
    return [
        Row(design, values, tuple(None if x != x else x for x in numbers), reason)
        for (design, values), numbers, reason in results
    ]


def sweep(
    study: Study,
    store: Store,
    *,
    workers: int | None = None,
    progress: Callable[[list[Row]], object] = lambda rows: None,
) -> None:
    """Compute the designs of a study that are not stored, and store them, block by block.

    Parameters
    ----------
    study : Study
        The study.
    store : Store
        The store. Blocks are written in any order.
    workers : int, optional
        Number of worker processes that compute the blocks; by default this process does.
    progress : callable, optional
        Called with the rows of every block after they are stored.

    Raises
    ------
    RuntimeError
        If worker processes die repeatedly. Stored rows remain.
    """
    designs = enumerate(study.designs())
    blocks = iter(lambda: dict(islice(designs, BLOCK)), {})
    for rows in in_parallel(partial(compute_rows, study), filter(None, map(store.missing, blocks)), workers):
        store.write(rows)
        progress(rows)


def in_parallel(work: Callable[[T], R], tasks: Iterable[T], workers: int | None) -> Iterator[R]:
    """The results of tasks as they end, with a bounded number of tasks submitted ahead."""
    if workers is None:
        yield from map(work, tasks)
        return
    queue, numbers, failures = iter(tasks), count(), 0
    while failures < ATTEMPTS:
        pending, running = dict[int, T](), dict[Future[R], int]()
        try:
            with process_pool(workers) as executor:
                while True:
                    for number, task in zip(numbers, islice(queue, 2 * workers + 1 - len(running)), strict=False):
                        pending[number] = task
                        running[executor.submit(work, task)] = number
                    if not running:
                        return
                    for future in wait_for(running, timeout=CHECK_INTERVAL, return_when=FIRST_COMPLETED).done:
                        result = future.result()
                        del pending[running.pop(future)]
                        failures = 0
                        yield result
        except BrokenExecutor:
            queue, failures = chain(pending.values(), queue), failures + 1
    raise RuntimeError(f"worker processes ended {ATTEMPTS} times without a result: out of memory, or killed")


@contextmanager
def process_pool(workers: int) -> Iterator[Executor]:
    """A pool of worker processes, which end with this process, even if it is killed; tasks not begun are cancelled.

    They are spawned: a fork would copy locks of the threads of this process.
    """

    executor = ProcessPoolExecutor(workers, mp_context=get_context("spawn"), initializer=_end_with_parent)
    resource_tracker.ensure_running()  # starting it enables Ctrl-C again: not during `submit`
    with _without_interrupts():  # inherited by workers: only this process handles Ctrl-C
        for _ in range(workers):  # a submission starts a worker while none is idle
            executor.submit(int)
    try:
        yield executor
    finally:
        # the pool's own thread cancels: a future cancelled here while a worker dies would break that thread
        executor.shutdown(wait=True, cancel_futures=True)


@contextmanager
def _without_interrupts() -> Iterator[None]:
    """Ignore Ctrl-C, in the main thread."""
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    before = signal.signal(signal.SIGINT, signal.SIG_IGN)
    try:
        yield
    finally:
        signal.signal(signal.SIGINT, before)


def _end_with_parent() -> None:
    """End this worker when its parent ends, and ignore Ctrl-C."""
    parent = parent_process()
    assert parent is not None

    def exit_after_parent() -> None:
        parent.join()
        os._exit(1)

    signal.signal(signal.SIGINT, signal.SIG_IGN)
    threading.Thread(target=exit_after_parent, daemon=True).start()
