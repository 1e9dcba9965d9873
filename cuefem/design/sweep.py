"""A study's designs, computed a block at a time, here, in processes or on a Dask cluster, and handed to a store."""

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

from cuefem.design.ranges import Value
from cuefem.design.study import Study

BLOCK = 16  # designs that are evaluated, and written, at a time
# A pool that breaks is opened again; this often in a row without a block done is too often.
ATTEMPTS = 3
# A Dask scheduler that does not answer for so long is not there; how often one is asked while nothing comes, s.
PATIENCE, GLANCE = 10.0, 1.0
# What writes to stderr when a scheduler is gone, which `dask` tells in one line.
LOGS = ("distributed", "distributed.client", "tornado.application")

T = TypeVar("T")
R = TypeVar("R")
P = ParamSpec("P")


class Row(NamedTuple):
    """A design: its number, what varied, its responses in SI (None if missing), and why one is missing, or None."""

    design: int
    values: tuple[Value, ...]
    responses: tuple[float | None, ...]
    failure: str | None


class Store(Protocol):
    """Where a study's rows go, and what is known already."""

    def take(self, designs: dict[int, tuple[Value, ...]]) -> dict[int, tuple[Value, ...]]:
        """What is left to compute of a block, designs by number."""

    def write(self, rows: list[Row]) -> None:
        """Store the rows of a task, all or none of them."""

    def rows(self) -> Iterator[Row]:
        """All rows in the order of the designs."""


@dataclass
class MemoryStore:
    """A store that ends with the process."""

    kept: list[Row] = field(default_factory=list)

    def take(self, designs: dict[int, tuple[Value, ...]]) -> dict[int, tuple[Value, ...]]:
        """All of them."""
        return designs

    def write(self, rows: list[Row]) -> None:
        """Store rows."""
        self.kept += rows

    def rows(self) -> Iterator[Row]:
        """All rows in the order of the designs."""
        return iter(sorted(self.kept, key=lambda row: row.design))


def computed(study: Study, designs: dict[int, tuple[Value, ...]]) -> list[Row]:
    """The rows of designs. The same designs give the same bits, whatever else is in the block."""
    found = study.evaluated([*designs.values()])
    answers = zip(designs.items(), found.values.tolist(), found.reasons, strict=True)
    return [
        Row(design, values, tuple(None if x != x else x for x in numbers), reason)
        for (design, values), numbers, reason in answers
    ]


def sweep(
    study: Study, store: Store, *, pool: Pool | None = None, progress: Callable[[list[Row]], object] = lambda rows: None
) -> None:
    """Compute the designs of a study that the store does not hold yet, and write them, a block at a time.

    Parameters
    ----------
    study : Study
        What to compute.
    store : Store
        Where the rows go. Blocks may come in any order.
    pool : Pool, optional
        Executors that compute the blocks; by default this process does.
    progress : callable, optional
        Called with the rows of every block once they are written.

    Raises
    ------
    RuntimeError
        If the pool breaks time after time, or its scheduler is gone. What was written stays.
    """
    designs = enumerate(study.designs())
    blocks = iter(lambda: dict(islice(designs, BLOCK)), {})
    for rows in in_parallel(partial(computed, study), filter(None, map(store.take, blocks)), pool):
        store.write(rows)
        progress(rows)


@dataclass(frozen=True)
class Pool:
    """How to open an executor, and reopen it if it breaks, and how many tasks to hand out ahead.

    open: what it gives cancels, when it closes, the tasks that have not begun.
    check: called about every `GLANCE` seconds while no task ends; raises an exception if none ever will.
    """

    open: Callable[[], AbstractContextManager[Executor]]
    ahead: int
    check: Callable[[], object] = lambda: None


def in_parallel(work: Callable[[T], R], tasks: Iterable[T], pool: Pool | None) -> Iterator[R]:
    """The results of tasks as they end: never more than a few tasks ahead, so that memory does not grow with them."""
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
                    done, _ = wait_for(running, timeout=GLANCE, return_when=FIRST_COMPLETED)
                    if not done:
                        pool.check()
                    for future in done:
                        result = future.result()
                        del pending[running.pop(future)]
                        failures = 0
                        yield result
        except (BrokenExecutor, CancelledError):
            queue, failures = chain(pending.values(), queue), failures + 1
    raise RuntimeError(f"worker processes died {ATTEMPTS} times without a block done: out of memory, or killed")


def processes(number: int) -> Pool:
    """That many worker processes of this machine. They end when the process that opened them does, killed or not.

    They are spawned, since a fork would copy locks that threads of this process hold.
    """

    @contextmanager
    def opened() -> Iterator[Executor]:
        executor = ProcessPoolExecutor(number, mp_context=get_context("spawn"), initializer=_follow)
        resource_tracker.ensure_running()  # whoever starts it lets Ctrl-C through again: not in the midst of `submit`
        with _without_interrupts():  # which workers inherit: Ctrl-C is this process's to answer, while they start too
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
    """Ignore Ctrl-C for a moment, where this thread may."""
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    before = signal.signal(signal.SIGINT, signal.SIG_IGN)
    try:
        yield
    finally:
        signal.signal(signal.SIGINT, before)


def _follow() -> None:
    """End this worker when its parent has, killed or by Ctrl-C, and not by itself."""
    parent = parent_process()
    assert parent is not None

    def until_it_ends() -> None:
        parent.join()
        os._exit(1)

    signal.signal(signal.SIGINT, signal.SIG_IGN)
    threading.Thread(target=until_it_ends, daemon=True).start()


@contextmanager
def pool_of(workers: int | None, address: str | None) -> Iterator[Pool | None]:
    """The worker processes, or the Dask cluster, to work on; None for this process; ValueError if both are asked."""
    if workers and address:
        raise ValueError("workers are for this machine, dask for a cluster: give one")
    if address:
        with dask(address) as pool:
            yield pool
    else:
        yield processes(workers) if workers else None


@contextmanager
def dask(address: str) -> Iterator[Pool]:
    """The workers of the Dask scheduler at an address; ValueError if the library or the scheduler is missing."""
    try:
        from distributed import Client
    except ImportError:
        raise ValueError(
            "a Dask cluster needs the library distributed: pip install '.[distributed]' in the clone"
        ) from None
    try:
        client = Client(address, timeout=PATIENCE, set_as_default=False)
    except (OSError, ValueError, TypeError) as error:
        raise ValueError(f"no Dask scheduler answers at {address!r}: {error}") from None
    lost = 0.0

    def check() -> None:
        """RuntimeError if the scheduler has not been there for `PATIENCE` seconds."""
        nonlocal lost
        lost = 0.0 if client.status == "running" else lost + GLANCE
        if lost >= PATIENCE:
            raise RuntimeError(f"the Dask scheduler at {address!r} answers no more")

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
        client.close(timeout=GLANCE)
        for log, level in levels.items():
            log.setLevel(level)
