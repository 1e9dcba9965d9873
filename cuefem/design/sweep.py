"""Computation of a study's designs, block by block, in this process, worker processes or a Dask cluster."""

from __future__ import annotations

import logging
import os
import signal
import threading
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import FIRST_COMPLETED, BrokenExecutor, CancelledError, Executor, Future, ProcessPoolExecutor
from concurrent.futures import wait as wait_for
from contextlib import AbstractContextManager, contextmanager
from dataclasses import dataclass, field
from functools import partial
from itertools import chain, count, islice
from multiprocessing import get_context, parent_process, resource_tracker
from typing import NamedTuple, ParamSpec, Protocol, TypeVar

from cuefem.design.sampling import Value
from cuefem.design.study import Study

BLOCK = 16  # designs that are evaluated, and written, at a time
ATTEMPTS = 3  # to open a broken pool again, without a block in between
SCHEDULER_TIMEOUT = 10.0  # s, without a Dask scheduler
POLL_INTERVAL = 1.0  # s, between checks of a scheduler while no task ends
# Loggers that write to stderr when a scheduler is lost, for which `dask_pool` raises a one-line error.
LOGS = ("distributed", "distributed.client", "tornado.application")

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

    stored: list[Row] = field(default_factory=list)

    def missing(self, designs: dict[int, tuple[Value, ...]]) -> dict[int, tuple[Value, ...]]:
        """All designs."""
        return designs

    def write(self, rows: list[Row]) -> None:
        """Store rows."""
        self.stored += rows

    def rows(self) -> Iterator[Row]:
        """All rows in the order of the designs."""
        return iter(sorted(self.stored, key=lambda row: row.design))


def compute_rows(study: Study, designs: dict[int, tuple[Value, ...]]) -> list[Row]:
    """The rows of designs, bit for bit independent of the other designs of the block."""
    evaluation = study.evaluated([*designs.values()])
    answers = zip(designs.items(), evaluation.values.tolist(), evaluation.reasons, strict=True)
    return [
        Row(design, values, tuple(None if x != x else x for x in numbers), reason)
        for (design, values), numbers, reason in answers
    ]


def sweep(
    study: Study, store: Store, *, pool: Pool | None = None, progress: Callable[[list[Row]], object] = lambda rows: None
) -> None:
    """Compute the designs of a study that are not stored, and store them, block by block.

    Parameters
    ----------
    study : Study
        The study.
    store : Store
        The store. Blocks are written in any order.
    pool : Pool, optional
        Executors that compute the blocks; by default this process does.
    progress : callable, optional
        Called with the rows of every block after they are stored.

    Raises
    ------
    RuntimeError
        If the pool breaks repeatedly, or its scheduler is lost. Stored rows remain.
    """
    designs = enumerate(study.designs())
    blocks = iter(lambda: dict(islice(designs, BLOCK)), {})
    for rows in in_parallel(partial(compute_rows, study), filter(None, map(store.missing, blocks)), pool):
        store.write(rows)
        progress(rows)


@dataclass(frozen=True)
class Pool:
    """How to open an executor, again if it breaks, and how many tasks to submit ahead.

    open: its context manager cancels, on exit, the tasks that have not begun.
    check: called about every `POLL_INTERVAL` seconds while no task ends; raises if the workers are lost.
    """

    open: Callable[[], AbstractContextManager[Executor]]
    ahead: int
    check: Callable[[], object] = lambda: None


def in_parallel(work: Callable[[T], R], tasks: Iterable[T], pool: Pool | None) -> Iterator[R]:
    """The results of tasks as they end, with a bounded number of tasks submitted ahead."""
    if pool is None:
        yield from map(work, tasks)
        return
    queue, numbers, failures = iter(tasks), count(), 0
    while failures < ATTEMPTS:
        pending, running = dict[int, T](), dict[Future[R], int]()
        try:
            with pool.open() as executor:
                while True:
                    for number, task in zip(numbers, islice(queue, pool.ahead - len(running)), strict=False):
                        pending[number] = task
                        running[executor.submit(work, task)] = number
                    if not running:
                        return
                    done, _ = wait_for(running, timeout=POLL_INTERVAL, return_when=FIRST_COMPLETED)
                    if not done:
                        pool.check()
                    for future in done:
                        result = future.result()
                        del pending[running.pop(future)]
                        failures = 0
                        yield result
        except (BrokenExecutor, CancelledError):
            queue, failures = chain(pending.values(), queue), failures + 1
    raise RuntimeError(f"worker processes ended {ATTEMPTS} times without a result: out of memory, or killed")


def process_pool(number: int) -> Pool:
    """A pool of worker processes on this machine, which end with this process, even if it is killed.

    They are spawned: a fork would copy locks of the threads of this process.
    """

    @contextmanager
    def opened() -> Iterator[Executor]:
        executor = ProcessPoolExecutor(number, mp_context=get_context("spawn"), initializer=_follow)
        resource_tracker.ensure_running()  # starting it enables Ctrl-C again: not during `submit`
        with _without_interrupts():  # inherited by workers: only this process handles Ctrl-C
            for _ in range(number):  # a submission starts a worker while none is idle
                executor.submit(int)
        try:
            yield executor
        finally:
            # the pool's own thread cancels: a future cancelled here while a worker dies would break that thread
            executor.shutdown(wait=True, cancel_futures=True)

    return Pool(opened, 2 * number + 1)


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


def _follow() -> None:
    """End this worker when its parent ends, and ignore Ctrl-C."""
    parent = parent_process()
    assert parent is not None

    def until_it_ends() -> None:
        parent.join()
        os._exit(1)

    signal.signal(signal.SIGINT, signal.SIG_IGN)
    threading.Thread(target=until_it_ends, daemon=True).start()


@contextmanager
def open_pool(workers: int | None, address: str | None) -> Iterator[Pool | None]:
    """Worker processes or a Dask cluster; None for this process; ValueError for both."""
    if workers and address:
        raise ValueError("workers and dask must not both be set: this machine, or a cluster")
    if address:
        with dask_pool(address) as pool:
            yield pool
    else:
        yield process_pool(workers) if workers else None


@contextmanager
def dask_pool(address: str) -> Iterator[Pool]:
    """The workers of the Dask scheduler at an address; ValueError if the library or the scheduler is missing."""
    try:
        from distributed import Client
    except ImportError:
        raise ValueError(
            "a Dask cluster needs the library distributed: pip install '.[distributed]' in the clone"
        ) from None
    try:
        client = Client(address, timeout=SCHEDULER_TIMEOUT, set_as_default=False)
    except (OSError, ValueError, TypeError) as error:
        raise ValueError(f"no Dask scheduler responds at {address!r}: {error}") from None
    lost = 0.0

    def check() -> None:
        """RuntimeError if the scheduler has been lost for `SCHEDULER_TIMEOUT` seconds."""
        nonlocal lost
        lost = 0.0 if client.status == "running" else lost + POLL_INTERVAL
        if lost >= SCHEDULER_TIMEOUT:
            raise RuntimeError(f"the Dask scheduler at {address!r} no longer responds")

    @contextmanager
    def opened() -> Iterator[Executor]:
        executor = client.get_executor(pure=False)
        try:
            yield executor
        finally:
            executor.shutdown(wait=False)  # which cancels

    levels = {log: log.level for log in map(logging.getLogger, LOGS)}
    for log in levels:
        log.setLevel(logging.CRITICAL)  # a lost scheduler is one line of error: `check`
    try:
        workers = sum(client.nthreads().values())
        yield Pool(opened, 2 * max(workers, 1) + 1, check)
    finally:
        client.close(timeout=POLL_INTERVAL)
        for log, level in levels.items():
            log.setLevel(level)
