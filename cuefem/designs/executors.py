"""Blocks of designs on executors: worker processes of this machine, or any `concurrent.futures.Executor`.

The blocks in a worker that ends are computed again last, one design at a time. A design that ends its worker when it is
alone needs more memory than there is: it fails.
"""

from __future__ import annotations

import os
import signal
import sys
import threading
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import FIRST_COMPLETED, BrokenExecutor, CancelledError, Executor, Future, ProcessPoolExecutor
from concurrent.futures import wait as wait_for
from contextlib import AbstractContextManager, contextmanager, nullcontext
from importlib import import_module
from itertools import chain, islice
from multiprocessing import get_context, parent_process, resource_tracker
from typing import Any

from cuefem.designs.blocks import Block, BlockResult
from cuefem.designs.design_key import code_digest
from cuefem.quantity.display import one_line

AHEAD = 256  # blocks submitted to an executor whose number of workers is unknown, and may grow
MAX_LOST = 16  # designs in a row that end their workers: there is another reason than a design
CHECK_INTERVAL = 1.0  # s, of waits: on Windows Ctrl-C does not interrupt a wait without a limit
SAME_VERSION = "install the same version of cuefem on every worker"

Work = Callable[[Block], BlockResult]
Lost = Callable[[Block], BlockResult]
Errors = tuple[type[Exception], ...]


def in_parallel(
    work: Work, blocks: Iterable[Block], workers: int | Executor | None, lost: Lost
) -> Iterator[BlockResult]:
    """The results of blocks as they end, with a bounded number of blocks submitted ahead.

    lost: the result of a design that ends its workers. RuntimeError if no worker can compute; ValueError for a worker
    without cuefem or with another version.
    """
    if workers is None:
        yield from map(work, blocks)
        return
    killed, broken = _errors(workers)
    queue, suspects, n_lost = iter(blocks), list[Block](), 0

    def unless_all_are_lost() -> Iterator[Block]:
        while n_lost < MAX_LOST and (block := next(queue, None)):
            yield block

    try:
        with _executor(workers) as executor:
            ahead = 2 * workers if isinstance(workers, int) else AHEAD
            for block, result in _ended(executor, work, unless_all_are_lost(), ahead, killed):
                n_lost = 0 if result else n_lost + 1
                if result:
                    yield result
                else:
                    suspects.append(block)
        n_lost, singles = 0, (single for block in chain(suspects, queue) for single in block.singles())
        if not suspects:
            return
        with _executor(1 if isinstance(workers, int) else workers) as executor:
            for block, result in _ended(executor, work, singles, 1, killed):
                n_lost = 0 if result else n_lost + 1
                if n_lost == MAX_LOST:
                    raise RuntimeError(f"workers ended for {MAX_LOST} designs in a row")
                yield result or lost(block)
    except broken as error:
        raise RuntimeError(f"the workers were lost: {one_line(str(error)) or type(error).__name__}") from error
    except (ImportError, AttributeError, TypeError) as error:
        raise ValueError(f"a worker cannot run cuefem: {one_line(str(error))}; {SAME_VERSION}") from error


def _executor(workers: int | Executor) -> AbstractContextManager[Executor]:
    """New worker processes, or the executor of the caller, who closes it."""
    if isinstance(workers, int):
        return WorkerProcesses(workers)
    _check_version(workers.submit(code_digest).result())
    return nullcontext(workers)


def _ended(
    executor: Executor, work: Work, blocks: Iterator[Block], ahead: int, killed: Errors
) -> Iterator[tuple[Block, BlockResult | None]]:
    """Blocks with their results as they end, None if one was in a worker that ended; so many are submitted ahead."""
    running = dict[Future[BlockResult], Block]()
    while True:
        running |= {executor.submit(work, block): block for block in islice(blocks, ahead - len(running))}
        if not running:
            return
        for future in wait_for(running, timeout=CHECK_INTERVAL, return_when=FIRST_COMPLETED).done:
            try:
                result = future.result()
            except killed:
                yield running.pop(future), None
            else:
                _check_version(result.version)
                yield running.pop(future), result


def _errors(workers: int | Executor) -> tuple[Errors, Errors]:
    """The exceptions for a task that was in workers that ended, and for lost workers; also Dask's if it is loaded.

    Dask cancels all tasks when its scheduler is lost. They are not submitted again: a task that is submitted while the
    client tries to reconnect never ends.
    """
    if isinstance(workers, int):
        return (BrokenExecutor,), ()
    broken: Errors = (BrokenExecutor, CancelledError)
    if "distributed" not in sys.modules:
        return (), broken
    killed = import_module("distributed").KilledWorker
    return (killed,), (*broken, import_module("distributed.client").ClosedClientError)


def _check_version(version: str) -> None:
    if version != code_digest():
        raise ValueError(f"a worker has another version of cuefem: {SAME_VERSION}")


class WorkerProcesses(Executor):
    """Worker processes of this machine, each a pool: one that ends fails only its own tasks, and is replaced.

    They are spawned (a fork would copy locks of the threads of this process), and end with this process, even if it is
    killed. RuntimeError if they end when they start.
    """

    def __init__(self, workers: int) -> None:
        resource_tracker.ensure_running()  # starting it enables Ctrl-C again: not during `submit`
        self._tasks = dict(_started_pool() for _ in range(workers))
        try:
            for (start,) in self._tasks.values():
                start.result()
        except BrokenExecutor:
            self.shutdown()
            raise RuntimeError("worker processes end when they start: out of memory, or killed") from None

    def submit(self, work: Any, /, *arguments: Any, **options: Any) -> Future[Any]:
        """Submit to the process that has the fewest tasks, or to a new one in its place if it has ended."""
        tasks = {pool: [task for task in tasks if not task.done()] for pool, tasks in self._tasks.items()}
        pool = min(tasks, key=lambda each: len(tasks[each]))
        try:
            tasks[pool].append(pool.submit(work, *arguments, **options))
        except BrokenExecutor:
            del tasks[pool]
            pool.shutdown()
            pool, tasks[pool] = _started_pool()
            tasks[pool].append(pool.submit(work, *arguments, **options))
        self._tasks = tasks
        return tasks[pool][-1]

    def shutdown(self, wait: bool = True, *, cancel_futures: bool = True) -> None:
        """End the processes; tasks not begun are cancelled, by the pools: cancelled here they would break a pool."""
        for waits in (False, wait):
            for pool in self._tasks:
                pool.shutdown(wait=waits, cancel_futures=True)


def _started_pool() -> tuple[Executor, list[Future[Any]]]:
    """A pool of one process, and its tasks: that of its start."""
    pool = ProcessPoolExecutor(1, mp_context=get_context("spawn"), initializer=_end_with_parent)
    with _without_interrupts():  # inherited by the process: only this one handles Ctrl-C
        return pool, [pool.submit(int)]


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
