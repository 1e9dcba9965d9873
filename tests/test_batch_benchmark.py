"""How many shafts a second: batches, a sweep in one process and in two, and a million designs streamed.

The ordinary run only checks the answers, on few shafts. Numbers are printed, per second of this process's own time so
that a busy machine matters less, by

    OMP_NUM_THREADS=1 OPENBLAS_NUM_THREADS=1 python -m pytest -n 0 -s --benchmark-enable tests/test_batch_benchmark.py

No test asserts a time.
"""

from __future__ import annotations

import os
import time
from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
import psutil
import pytest
from cues import kim, scene

from cuefem import Resolution, Scene, Tip, end_mass, modes
from cuefem.batch import CueBatch, batch_frequencies, batch_stick
from cuefem.design import Levels, Pool, Response, Row, Sample, Span, Study, Vary, processes, sweep


def shafts(count: int) -> CueBatch:
    """[Kim]'s shaft with diameters and modulus 20 % up and down: one smooth piece, as arrays."""
    rng = np.random.default_rng(count)
    (segment,) = kim().segments
    cues = []
    for tip, butt, E in rng.uniform(0.8, 1.2, (count, 3)):
        wood = replace(segment.material, E=segment.material.E * E)
        one = replace(segment, tip_diameter=0.012 * tip, butt_diameter=0.021 * butt, material=wood)
        cues.append(replace(kim(), segments=(one,)))
    return CueBatch.of(cues)


def per_second(work: Callable[[], Any], count: int) -> float:
    began = time.process_time()
    work()
    return count / (time.process_time() - began)


@pytest.fixture
def count(request: pytest.FixtureRequest) -> int:
    return 4096 if request.config.getoption("--benchmark-enable") else 64


def test_five_frequencies(count: int) -> None:
    batch, at = shafts(count), Resolution(1, 15, 5)
    fine = batch_frequencies(batch[:64], 5, at=Resolution(2, 16, 5))
    np.testing.assert_allclose(batch_frequencies(batch[:64], 5, at=at), fine, rtol=3e-6)
    speed = per_second(lambda: batch_frequencies(batch, 5, at=at), count)
    print(f"\nf1 to f5 to 3e-6: {speed:.0f} shafts a second")


@pytest.mark.parametrize(("order", "kept"), [(24, 12), (36, 24)])
def test_stick_end_mass(count: int, order: int, kept: int) -> None:
    """Within 5e-3 of a hundred modes: the plain sum over modes converges slowly."""
    batch, struck, at = shafts(count), scene(kim(), 2e-3), Resolution(1, order, kept)
    fine, _ = batch_stick(batch[:16], struck, at=Resolution(4, 24, 100))
    found, _ = batch_stick(batch[:16], struck, at=at)
    np.testing.assert_allclose(found, fine, rtol=5e-3)
    speed = per_second(lambda: batch_stick(batch, struck, at=at), count)
    error = np.max(np.abs(found / fine - 1))
    print(f"\nstick end mass, {kept} modes, {error:.1e} from 100 modes: {speed:.0f} shafts a second")


def test_against_single_calls(count: int) -> None:
    cue, at = kim(), Resolution(1, 24, 12)
    one = scene(cue, 2e-3)
    single = per_second(lambda: [end_mass(one, at=at) for _ in range(50)], 50)
    together = per_second(lambda: batch_stick(CueBatch.of([cue] * count), one, at=at), count)
    tones = per_second(lambda: [modes(cue, 5, at=Resolution(1, 15, 5)) for _ in range(50)], 50)
    print(
        f"\nsingle calls: {tones:.0f} f1 to f5, {single:.0f} end masses a second; batch {together / single:.1f} times"
    )


def study(count: int, responses: tuple[str, ...], at: Resolution) -> Study:
    vary = (
        Vary(("cue.segments[0].tip_diameter",), Span(0.011, 0.0135)),
        Vary(("cue.segments[0].material.E",), Span(0.8, 1.2), factor=True),
        Vary(("tip.contact_time",), Levels((1e-3, 2e-3))),
    )
    base = Scene(kim(), tip=Tip(contact_time=1e-3))
    return Study(base, vary, tuple(map(Response.of, responses)), Sample("sobol", count, 1), at)


class Counted:
    """A store that keeps nothing but sums: the designs there were, and the memory at each tenth."""

    def __init__(self, size: int) -> None:
        self.size, self.designs, self.memory = size, 0, list[float]()

    def holds(self, first: int) -> bool:
        return False

    def write(self, rows: list[Row]) -> None:
        before, self.designs = self.designs, self.designs + len(rows)
        if before * 10 // self.size != self.designs * 10 // self.size:
            self.memory.append(psutil.Process(os.getpid()).memory_info().rss / 2**20)


def test_two_processes(request: pytest.FixtureRequest) -> None:
    """Wall time, and the processes' own, which a busy machine matters less to; a first study warms them."""
    size = 8192 if request.config.getoption("--benchmark-enable") else 512
    wanted, speeds, costs = study(size, ("end_mass",), Resolution(1, 24, 12)), [], []
    for workers in (1, 2):
        with processes(workers).open() as executor:
            pool = Pool(lambda executor=executor: _Kept(executor), 2 * workers + 1)  # type: ignore[misc]
            sweep(study(256 * workers, ("end_mass",), Resolution(1, 24, 12)), Counted(1), pool=pool)
            store, began, own, theirs = Counted(size), time.perf_counter(), time.process_time(), children_time()
            sweep(wanted, store, pool=pool)
            speeds.append(size / (time.perf_counter() - began))
            costs.append((children_time() - theirs, time.process_time() - own))
            assert store.designs == size
    (one, _), (two, driver) = costs
    print(
        f"\n{speeds[0]:.0f} designs a second in one process, {speeds[1] / speeds[0]:.2f} times as many in two; "
        f"a design costs {two / one:.2f} times the work in two, and the driver {driver / two:.1%} of theirs"
    )


def children_time() -> float:
    """What the processes that this one started have worked, s."""
    children = psutil.Process().children(recursive=True)
    return sum(child.cpu_times().user + child.cpu_times().system for child in children)


class _Kept:
    """An executor that outlives the sweep that opened it."""

    def __init__(self, executor: Any) -> None:
        self.executor = executor

    def __enter__(self) -> Any:
        return self.executor

    def __exit__(self, *_: object) -> None: ...


def test_a_million_designs_streamed(request: pytest.FixtureRequest) -> None:
    size = 2**20 if request.config.getoption("--benchmark-enable") else 2**12
    store = Counted(size)
    speed = per_second(lambda: sweep(study(size, ("frequency(1)", "mass"), Resolution(1, 5, 1)), store), size)
    assert store.designs == size
    print(f"\n{size} designs: {speed:.0f} a second; {min(store.memory):.0f} to {max(store.memory):.0f} MB")
