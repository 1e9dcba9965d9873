"""One BLAS thread while small matrices are solved, and the caller's number afterwards (properties)."""

from concurrent.futures import ThreadPoolExecutor
from threading import Barrier

import pytest
from threadpoolctl import threadpool_info, threadpool_limits

import cuefem as cf
from cuefem.beam.blas_threads import one_blas_thread
from cuefem.beam.eigensolver import solve_eigenproblem
from tests.helpers.cues import kim


def blas_threads() -> set[int]:
    """The numbers of threads of the BLAS libraries of this process."""
    return {library["num_threads"] for library in threadpool_info() if library["user_api"] == "blas"}


def test_modes_are_solved_by_one_blas_thread(monkeypatch: pytest.MonkeyPatch) -> None:
    during, solve = list[set[int]](), solve_eigenproblem

    def recorded(*arguments: object, **options: object) -> object:
        during.append(blas_threads())
        return solve(*arguments, **options)

    monkeypatch.setattr("cuefem.beam.modes.solve_eigenproblem", recorded)
    with threadpool_limits(2, user_api="blas"):
        cf.modes(kim(), 3)
        cf.strike(cf.Scene(kim()))
        assert blas_threads() == {2}
    assert during == [{1}] * 2


class Library:
    """A BLAS library of another process."""

    def __init__(self, filepath: str) -> None:
        self.filepath, self.threads = filepath, 2

    def get_num_threads(self) -> int:
        return self.threads

    def set_num_threads(self, threads: int) -> None:
        self.threads = threads


def test_library_loaded_between_nested_uses_is_limited_and_restored(monkeypatch: pytest.MonkeyPatch) -> None:
    """SciPy's library is loaded when the first beam of a process is solved, within the limit around its strike."""
    numpy, scipy = Library("numpy"), Library("scipy")
    loaded = [numpy]
    monkeypatch.setattr("cuefem.beam.blas_threads._libraries", lambda scipy_is_loaded: loaded)
    with one_blas_thread:
        loaded = [numpy, scipy]
        with one_blas_thread:
            assert (numpy.threads, scipy.threads) == (1, 1)
        assert scipy.threads == 1
    assert (numpy.threads, scipy.threads) == (2, 2)


def test_blas_threads_are_restored_after_concurrent_uses() -> None:
    """The second thread begins before the first ends, and ends after it."""
    both, first_has_ended = Barrier(2), Barrier(2)

    def use(first: bool) -> set[int]:
        with one_blas_thread:
            both.wait(timeout=10)
            if not first:
                first_has_ended.wait(timeout=10)
                return blas_threads()
        first_has_ended.wait(timeout=10)
        return blas_threads()

    with threadpool_limits(2, user_api="blas"), ThreadPoolExecutor(2) as pool:
        during = [*pool.map(use, (True, False))]
        assert blas_threads() == {2}
    assert during[1] == {1}


def test_limits_of_others_hold_after_a_use_in_a_living_thread() -> None:
    def use() -> None:
        with one_blas_thread:
            pass

    with ThreadPoolExecutor(1) as pool:
        pool.submit(use).result()
        with threadpool_limits(2, user_api="blas"):
            assert blas_threads() == {2}
