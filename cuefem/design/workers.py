"""Executors that a sweep can share its blocks among: processes of this machine, or a Dask cluster."""

from __future__ import annotations

import os
import threading
from collections.abc import Callable, Iterator
from concurrent.futures import Executor, ProcessPoolExecutor
from contextlib import AbstractContextManager, contextmanager
from dataclasses import dataclass
from multiprocessing import get_context, parent_process

# A scheduler that does not answer for so long is not there, s.
PATIENCE = 10


@dataclass(frozen=True)
class Pool:
    """How to open an executor, and reopen it if it breaks, and how many blocks to hand out ahead."""

    open: Callable[[], AbstractContextManager[Executor]]
    ahead: int


def processes(count: int) -> Pool:
    """That many worker processes of this machine. They end when the process that opened them does, killed or not."""

    def start() -> Executor:
        # spawned: a fork would copy locks that threads of this process hold
        return ProcessPoolExecutor(count, mp_context=get_context("spawn"), initializer=_follow)

    return Pool(start, 2 * count + 1)


def _follow() -> None:
    """End this worker when its parent has: a killed parent cannot tell it to."""
    parent = parent_process()
    assert parent is not None

    def until_it_ends() -> None:
        parent.join()
        os._exit(1)

    threading.Thread(target=until_it_ends, daemon=True).start()


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
    with client:
        workers = sum(client.nthreads().values())
        yield Pool(lambda: client.get_executor(pure=False), 2 * max(workers, 1) + 1)
