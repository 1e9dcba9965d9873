"""How many shafts are computed in a second: in batches, in sweeps in one and two processes, in a stream of a million?

What: shafts of one piece, of wood, half of them bored, 20 % up and down in diameters and modulus, at the resolutions
whose errors are in batch.md; single calls beside them; the public `sweep` in one and in two worker processes, taking
turns; a million designs through `sweep`, and the memory at each tenth. Per second of a process's own time, the best of
a few rounds in turns, so that a busy machine matters less; sweeps in processes also in elapsed time.

    python -m studies.batch_seconds

prints all numbers and writes batch_seconds.md beside itself; takes some five minutes, most of them the million.
"""

from __future__ import annotations

import os
import platform
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from concurrent.futures import Executor
from contextlib import contextmanager
from dataclasses import dataclass, field
from statistics import median
from typing import Any

import numpy as np
import psutil
import scipy

from cuefem import Resolution, Scene, Tip, end_mass, modes
from cuefem.cue import SegmentRows
from cuefem.design import Levels, Pool, Response, Row, Sample, Span, Study, Vary, processes, sweep
from cuefem.design.batch import CueBatch, batch_frequencies, batch_stick
from studies import batch
from studies.common import STUDIES, cue, processor, scene, table

THREADS = ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS")
SWEPT_AT = Resolution(1, 24, 12)


@dataclass(frozen=True)
class Size:
    """How much to measure: shafts of a batch, rounds of it, designs of a sweep in processes, designs streamed."""

    shafts: int = 2048
    rounds: int = 5
    swept: int = 8192
    streamed: int = 2**20


def shafts(count: int) -> CueBatch:
    """[Kim]'s shaft with diameters and modulus 20 % up and down, every other one bored by up to half its tip."""
    rng = np.random.default_rng(count)
    (segment,) = cue("kim").segments
    tip, butt, E, bore = rng.uniform(0.8, 1.2, (4, count, 1))
    rows = SegmentRows(*(np.full((count, 1), value) for value in segment.constants))
    bored = 0.4 * bore * rows.tip_diameter * (np.arange(count) % 2)[:, None]
    rows = rows._replace(
        tip_diameter=tip * rows.tip_diameter,
        butt_diameter=butt * rows.butt_diameter,
        tip_bore=bored,
        butt_bore=bored,
        E=E * rows.E,
    )
    return CueBatch(rows, np.full(count, 0.42))


Works = dict[str, tuple[Callable[[], Any], int]]


def works(size: Size) -> Works:
    """What is measured in turns, by name: work, and the shafts that it does."""
    many, struck = shafts(size.shafts), scene(cue("kim"), 1e-3)
    few, single = 16, scene(cue("kim"), 1e-3)
    tones_at = batch.FREQUENCIES_AT

    def several(work: Callable[[], Any]) -> Callable[[], Any]:
        return lambda: [work() for _ in range(few)]

    def sticks(at: Resolution, ended: bool) -> Callable[[], Any]:
        return lambda: batch_stick(many, struck, at=at, ended=ended)

    found: Works = {f"f1 to f5, order {tones_at.order}": (lambda: batch_frequencies(many, 5, at=tones_at), len(many))}
    for ended, resolutions in ((False, batch.PLAIN), (True, batch.FADING)):
        for at in resolutions:
            how = "fading tail" if ended else "plain sum"
            found[f"stick end mass, {at.modes} modes, order {at.order}, {how}"] = (sticks(at, ended), len(many))
    found["one at a time: f1 to f5"] = (several(lambda: modes(cue("kim"), 5, at=tones_at)), few)
    found["one at a time: stick end mass, 12 modes, order 24"] = (several(lambda: end_mass(single, at=SWEPT_AT)), few)
    return found


def rates(size: Size) -> dict[str, float]:
    """Shafts a second of this process's own time, by the name of the work; works take turns, the best round counts."""
    found, best = works(size), dict[str, float]()
    for _ in range(size.rounds):
        for name, (work, count) in found.items():
            began = time.process_time()
            work()
            best[name] = max(best.get(name, 0.0), count / (time.process_time() - began))
    return best


def study(count: int, responses: tuple[str, ...], at: Resolution) -> Study:
    """A quasi-random study of [Kim]'s shaft."""
    vary = (
        Vary(("cue.segments[0].tip_diameter",), Span(0.011, 0.0135)),
        Vary(("cue.segments[0].material.E",), Span(0.8, 1.2), factor=True),
        Vary(("tip.contact_time",), Levels((1e-3, 2e-3))),
    )
    base = Scene(cue("kim"), tip=Tip(contact_time=1e-3))
    return Study(base, vary, tuple(map(Response.of, responses)), Sample("sobol", count, 1), at)


@dataclass
class Counted:
    """A store that keeps nothing but sums: the designs there were, and the memory at each tenth, MiB."""

    size: int
    designs: int = 0
    memory: list[float] = field(default_factory=list)

    def holds(self, first: int) -> bool:
        """Nothing."""
        return False

    def write(self, rows: list[Row]) -> None:
        """Count them; ValueError where one failed."""
        if any(row.failure for row in rows):
            raise ValueError(f"a design failed: {next(row.failure for row in rows if row.failure)}")
        before, self.designs = self.designs, self.designs + len(rows)
        if before * 10 // self.size != self.designs * 10 // self.size:
            self.memory.append(psutil.Process(os.getpid()).memory_info().rss / 2**20)


@dataclass(frozen=True)
class Shared:
    """A sweep in worker processes: designs a second by the wall; seconds that workers and this process worked."""

    speed: float
    workers: float
    driver: float


def shared(count: int, rounds: int) -> tuple[list[Shared], list[Shared]]:
    """The same sweep in one and in two worker processes in turns, each pool opened and warmed beforehand."""
    one: list[Shared] = []
    two: list[Shared] = []
    with _warm(1) as first, _warm(2) as second:
        for _ in range(rounds):
            for pool, found in ((first, one), (second, two)):
                found.append(_timed(count, pool))
    return one, two


def _timed(count: int, pool: Pool) -> Shared:
    store, began, own, theirs = Counted(count), time.perf_counter(), time.process_time(), _children()
    sweep(study(count, ("end_mass",), SWEPT_AT), store, pool=pool)
    seconds = time.perf_counter() - began
    if store.designs != count:
        raise RuntimeError(f"{store.designs} designs of {count}")
    return Shared(count / seconds, _children() - theirs, time.process_time() - own)


def _children() -> float:
    """What the processes that this one started have worked, s."""
    times = [child.cpu_times() for child in psutil.Process().children(recursive=True)]
    return sum(part.user + part.system for part in times)


@contextmanager
def _warm(workers: int) -> Iterator[Pool]:
    """A pool that stays open from one sweep to the next."""
    with processes(workers).open() as executor:

        @contextmanager
        def opened() -> Iterator[Executor]:
            yield executor

        pool = Pool(opened, 2 * workers + 1)
        sweep(study(512 * workers, ("end_mass",), SWEPT_AT), Counted(512 * workers), pool=pool)
        yield pool


def streamed(count: int) -> tuple[float, list[float]]:
    """Designs a second of this process's own time in a long sweep of light ones, and the memory at each tenth, MiB."""
    store, began = Counted(count), time.process_time()
    sweep(study(count, ("frequency(1)", "mass"), Resolution(1, 5, 1)), store)
    return store.designs / (time.process_time() - began), store.memory


def text(size: Size, tell: Callable[[str], object] = lambda line: None) -> str:
    """The table of this machine; every number is told as soon as it is known."""
    rows = [[name, f"{rate:.0f}"] for name, rate in rates(size).items()]
    for row in rows:
        tell(": ".join(row))
    one, two = shared(size.swept, max(size.rounds // 2, 1))
    ratio = median(b.speed / a.speed for a, b in zip(one, two, strict=True))
    work = median(b.workers / a.workers for a, b in zip(one, two, strict=True))
    driver = median(b.driver / b.workers for b in two)
    walls, own = (max(a.speed for a in one), max(b.speed for b in two)), size.swept / min(a.workers for a in one)
    sweeps = (
        f"`sweep` of {size.swept} designs (stick end mass, 12 modes, order 24): {own:.0f} per second of a worker's\n"
        f"own time; by the wall {walls[0]:.0f} a second in one worker process, {walls[1]:.0f} in two,\n"
        f"{ratio:.2f} times as many (median of turns). A design costs {work:.2f} times the work in two; the driver\n"
        f"works {driver:.1%} of theirs."
    )
    tell(sweeps)
    speed, memory = streamed(size.streamed)
    stream = (
        f"`sweep` of {size.streamed} designs (f1 at order 5, mass), nothing kept: {speed:.0f} a second; memory at\n"
        f"each tenth {min(memory):.1f} to {max(memory):.1f} MiB."
    )
    tell(stream)
    machine = f"{processor()}, one BLAS thread, Python {platform.python_version()}"
    return (
        f"# Shafts a second\n\n{machine},\nnumpy {np.__version__}, scipy {scipy.__version__}; load "
        f"{os.getloadavg()[0]:.1f} when written. Per second of one core's own time; errors: [batch.md](batch.md).\n\n"
        f"{table(['what', 'shafts a second and core'], rows)}\n{sweeps}\n\n{stream}\n"
    )


def main() -> None:
    """Print and write it, in a process of one BLAS thread."""
    if any(os.environ.get(name) != "1" for name in THREADS):
        pinned = {**os.environ, **dict.fromkeys(THREADS, "1")}
        subprocess.run([sys.executable, "-m", "studies.batch_seconds"], env=pinned, cwd=STUDIES.parent, check=True)
        return
    found = text(Size(), lambda line: print(line, flush=True))
    (STUDIES / "batch_seconds.md").write_text(found, encoding="utf-8")


if __name__ == "__main__":
    main()
