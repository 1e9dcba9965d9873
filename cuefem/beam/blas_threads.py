"""One BLAS thread while a beam is solved and struck.

The matrices have 30 to 300 rows. More threads do not shorten that, and on a busy machine they take several times the
processor time.
"""

from __future__ import annotations

import sys
from contextlib import ContextDecorator
from functools import cache
from threading import Lock
from typing import Any

from threadpoolctl import LibController, OpenBLASController, ThreadpoolController


@cache
def _libraries(scipy_is_loaded: bool) -> list[LibController]:
    """The BLAS libraries of the process; SciPy has its own."""
    return ThreadpoolController().select(user_api="blas").lib_controllers


class _OneThread(ContextDecorator):
    """Limit BLAS to one thread, for all threads of the process, until the last of nested or concurrent uses ends."""

    def __init__(self) -> None:
        self._lock = Lock()
        self._users = 0
        self._before: dict[str, tuple[LibController, int]] = {}  # the threads of each library, by its file

    def __enter__(self) -> None:
        with self._lock:
            if self._users == 0:
                OpenBLASController.clear_controlling_thread(force=True)
            for library in _libraries("scipy.linalg" in sys.modules):  # perhaps loaded since the first of nested uses
                if library.filepath not in self._before:
                    self._before[library.filepath] = library, library.get_num_threads()
                    library.set_num_threads(1)
            self._users += 1

    def __exit__(self, *error: Any) -> None:
        with self._lock:
            self._users -= 1
            if self._users == 0:  # perhaps in another thread than the first use, whose limit OpenBLAS would keep
                OpenBLASController.clear_controlling_thread(force=True)
                for library, threads in self._before.values():
                    library.set_num_threads(threads)
                self._before.clear()
                OpenBLASController.clear_controlling_thread(force=True)  # so that any thread may limit it afterwards


one_blas_thread = _OneThread()
