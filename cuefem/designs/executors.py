"""Blocks of designs on executors: worker processes of this machine, or any `concurrent.futures.Executor`.

Worker processes that die are replaced. The blocks that were in them are computed again one at a time, and in halves if
they end their worker again, until the one design is left that needs more memory than there is: it fails. An executor
of the caller, such as a cluster's, replaces its workers itself.
"""

from __future__ import annotations

import os
import signal
import sys
import threading
from collections import deque
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import FIRST_COMPLETED, BrokenExecutor, CancelledError, Executor, Future, ProcessPoolExecutor
from concurrent.futures import wait as wait_for
from contextlib import contextmanager
from importlib import import_module
from itertools import count, islice
from multiprocessing import get_context, parent_process, resource_tracker

from cuefem.designs.blocks import Block, BlockResult
from cuefem.designs.design_key import code_digest
from cuefem.quantity.display import one_line

AHEAD = 256  # blocks submitted to an executor whose number of workers is unknown, and may grow
ATTEMPTS = 3  # number of workers that a design ends before it fails
MAX_LOST = 16  # designs in a row that end their workers: there is another reason than a design
CHECK_INTERVAL = 1.0  # s, of waits: on Windows Ctrl-C does not interrupt a wait without a limit
SAME_VERSION = "install the same version of cuefem on every worker"

Work = Callable[[Block], BlockResult]
Lost = Callable[[Block, str], BlockResult]
Errors = tuple[type[Exception], ...]


def in_parallel(
    work: Work, blocks: Iterable[Block], workers: int | Executor | None, lost: Lost
) -> Iterator[BlockResult]:
    """The results of blocks as they end, with a bounded number of blocks submitted ahead.

    lost: the result of a block whose designs end their workers. RuntimeError if no worker can compute; ValueError for
    a worker without cuefem or with another version.
    """
    if workers is None:
        return map(work, blocks)
    if isinstance(workers, int):
        return _in_processes(work, blocks, workers, lost)
    return _on_executor(work, blocks, workers, lost)


class _Submitted:
    """A queue of blocks, the submitted blocks that have not ended, and their futures."""

    def __init__(self, work: Work, blocks: Iterable[Block]) -> None:
        self.work, self.queue, self.numbers = work, iter(blocks), count()
        self.pending, self.running = dict[int, Block](), dict[Future[BlockResult], int]()

    def submit(self, executor: Executor, blocks: Iterable[Block]) -> None:
        """Submit blocks, each pending before the executor can break."""
        for number, block in zip(self.numbers, blocks, strict=False):
            self.pending[number] = block
            self.running[executor.submit(self.work, block)] = number

    def ended(self, executor: Executor, ahead: int) -> Iterator[Future[BlockResult]]:
        """The futures as they end; `take` removes their blocks."""
        while True:
            self.submit(executor, islice(self.queue, max(0, ahead - len(self.running))))
            if not self.running:
                return
            yield from wait_for(self.running, timeout=CHECK_INTERVAL, return_when=FIRST_COMPLETED).done

    def take(self, future: Future[BlockResult]) -> Block:
        """Remove a future; its block."""
        return self.pending.pop(self.running.pop(future))

    def take_all(self) -> list[Block]:
        """Remove all futures; their blocks."""
        blocks = [*self.pending.values()]
        self.pending.clear()
        self.running.clear()
        return blocks


def _in_processes(work: Work, blocks: Iterable[Block], workers: int, lost: Lost) -> Iterator[BlockResult]:
    submitted, n_lost = _Submitted(work, blocks), 0
    while True:
        try:
            with process_pool(workers) as executor:
                for future in submitted.ended(executor, 2 * workers + 1):
                    result = future.result()
                    submitted.take(future)
                    n_lost = 0
                    yield result
                return
        except BrokenExecutor:
            for result in _one_by_one(work, submitted.take_all(), lost):
                n_lost = n_lost + 1 if result.is_lost else 0
                if n_lost == MAX_LOST:
                    raise RuntimeError(f"worker processes ended for {MAX_LOST} designs in a row") from None
                yield result


def _one_by_one(work: Work, blocks: list[Block], lost: Lost) -> Iterator[BlockResult]:
    """The results of blocks of which one ended its worker process."""
    suspects = deque((block, 1) for block in blocks)
    while suspects:
        (block, n_ended), is_started = suspects[0], False
        try:
            with process_pool(1) as executor:
                executor.submit(int).result()
                is_started = True
                while suspects:
                    block, n_ended = suspects[0]
                    result = executor.submit(work, block).result()
                    suspects.popleft()
                    yield result
        except BrokenExecutor:
            if not is_started:
                raise RuntimeError("worker processes end when they start: out of memory, or killed") from None
            suspects.popleft()
            if len(block.numbers) > 1:
                suspects.extendleft((half, n_ended + 1) for half in reversed(block.halves()))
            elif n_ended + 1 < ATTEMPTS:
                suspects.appendleft((block, n_ended + 1))
            else:
                yield lost(block, f"ended its worker process {n_ended + 1} times: out of memory, or killed")


def _on_executor(work: Work, blocks: Iterable[Block], executor: Executor, lost: Lost) -> Iterator[BlockResult]:
    """The results on an executor of the caller.

    When a worker ends, also the blocks that wait there are suspected: suspects are computed last and one at a time, in
    halves if they end their workers again, so that only the design that does it fails.
    """
    suspects, n_lost, (killed, broken) = deque[Block](), 0, _lost_errors()
    try:
        _check_version(executor.submit(code_digest).result())
        for block, result in _ended(_Submitted(work, blocks), executor, AHEAD, killed):
            if result is None:
                suspects.append(block)
            else:
                yield result
        while suspects:
            for block, result in _ended(_Submitted(work, [suspects.popleft()]), executor, 1, killed):
                if result is not None:
                    n_lost = 0
                    yield result
                elif len(block.numbers) > 1:
                    suspects.extendleft(reversed(block.halves()))
                else:
                    n_lost += 1
                    if n_lost == MAX_LOST:
                        raise RuntimeError(f"workers ended for {MAX_LOST} designs in a row")
                    yield lost(block, "ended several workers: out of memory, or killed")
    except broken as error:
        raise RuntimeError(f"the workers were lost: {one_line(str(error)) or type(error).__name__}") from error
    except (ImportError, AttributeError, TypeError) as error:
        raise ValueError(f"a worker cannot run cuefem: {one_line(str(error))}; {SAME_VERSION}") from error


def _ended(
    submitted: _Submitted, executor: Executor, ahead: int, killed: Errors
) -> Iterator[tuple[Block, BlockResult | None]]:
    """Blocks with their results as they end, None if one ended its workers."""
    for future in submitted.ended(executor, ahead):
        try:
            result = future.result()
        except killed:
            yield submitted.take(future), None
        else:
            _check_version(result.version)
            yield submitted.take(future), result


def _lost_errors() -> tuple[Errors, Errors]:
    """The exceptions for a task that ended several workers, and for lost workers; also Dask's if it is loaded.

    Dask cancels all tasks when its scheduler is lost. They are not submitted again: a task that is submitted while the
    client tries to reconnect never ends.
    """
    broken: Errors = (BrokenExecutor, CancelledError)
    if "distributed" not in sys.modules:
        return (), broken
    killed = import_module("distributed").KilledWorker
    return (killed,), (*broken, import_module("distributed.client").ClosedClientError)


def _check_version(version: str) -> None:
    if version != code_digest():
        raise ValueError(f"a worker has another version of cuefem: {SAME_VERSION}")


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
