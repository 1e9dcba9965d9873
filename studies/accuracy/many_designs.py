"""How many designs a second does a study compute on processes and on a cluster, and what does its own process need?

A design is one stroke of pool_maple, whose moduli and density vary. The study's own process (the parent) is measured
with workers that return random numbers at once, so that blocks, pickles, store and columns remain: three parameters,
eight responses. Run it with OMP_NUM_THREADS=1 OPENBLAS_NUM_THREADS=1; it needs the extra [cluster].
"""

from __future__ import annotations

import os
import re
import tempfile
from collections.abc import Callable
from concurrent.futures import ProcessPoolExecutor
from functools import partial
from multiprocessing import get_context
from pathlib import Path
from statistics import median
from time import perf_counter, process_time
from typing import Any

import numpy as np

import cuefem as cf
from cuefem.designs import Response, Study, Vary
from cuefem.designs.blocks import Block, BlockResult, Blocks, lost_block
from cuefem.designs.design_key import KEY_BYTES, code_digest
from cuefem.designs.executors import in_parallel
from cuefem.designs.many_designs import Columns
from cuefem.designs.sampling import Sample, Span
from cuefem.designs.store import SqliteStore
from studies import pages, strokes
from studies.pages import table

STROKES, SIZES, ROUNDS = 384, (10_000, 100_000, 1_000_000), 3
RESPONSES = ("squirt", "end_mass", "mass", "shaft_mass", "balance_point", "tip_stiffness", "ball_speed", "pivot_length")
CORES = 1000


def study(count: int, *responses: str, seed: int = 1) -> Study:
    """Strokes of pool_maple with other wood."""
    fields = {"E": 0.2, "G": 0.3, "rho": 0.1}
    wood = tuple(
        Vary((f"cue.segments[*].material.{name}",), Span(1 - half, 1 + half), name=name, factor=True)
        for name, half in fields.items()
    )
    base = strokes.full_model(strokes.cue("pool_maple"))
    return Study(base, wood, tuple(map(Response, responses)), Sample(count, seed))


def random_block(responses: int, block: Block) -> BlockResult:
    """A block as a worker returns it, without its computation."""
    rng, size = np.random.default_rng(block.numbers[0]), len(block.numbers)
    return BlockResult(block, code_digest(), rng.bytes(KEY_BYTES * size), rng.normal(size=(size, responses)), {})


def peak_memory() -> float:
    """Largest memory of this process so far, MB; `resource` counts that of the process before it too."""
    status = Path("/proc/self/status").read_text(encoding="utf-8")
    return int(re.findall(r"VmHWM:\s*(\d+) kB", status)[0]) / 1024


def parent(count: int) -> dict[str, float]:
    """What the parent needs for designs that cost nothing, on two processes."""
    designs, before = study(count, *RESPONSES), peak_memory()
    with tempfile.TemporaryDirectory() as folder, SqliteStore(Path(folder) / "a.sqlite", designs) as store:
        begun, columns, blocks = process_time(), Columns.of(designs), Blocks(enumerate(designs.designs()))
        work = partial(random_block, len(RESPONSES))
        for result in in_parallel(work, blocks, 2, partial(lost_block, designs)):
            store.write(result)
            assert result.values is not None
            columns.add(result.block.numbers, result.values, result.failures)
            blocks.adapt(result)
        spent = process_time() - begun
        assert np.isfinite(columns.values).all()
        peak = peak_memory()
        size = store.path.stat().st_size
    return {"ms": 1e3 * spent / count, "MB": peak - before, "bytes": size / count}


def parents() -> list[list[str]]:
    """A row a size, each in a process of its own."""
    rows = []
    for count in SIZES:
        with ProcessPoolExecutor(1, mp_context=get_context("spawn")) as fresh:
            found = fresh.submit(parent, count).result()
        rows.append([f"1e{len(str(count)) - 1}", f"{found['ms']:.4f}", f"{found['MB']:.0f}", f"{found['bytes']:.0f}"])
    return rows


def executor_rows() -> list[list[str]]:
    """Designs a second and the parent's processor time: one process, two, and a cluster of two workers."""
    from distributed import LocalCluster  # loaded when used: a second

    designs = study(STROKES, "squirt")
    spent: dict[str, list[tuple[float, float]]] = {"one process": [], "2 processes": [], "Dask, 2 workers": []}
    with (
        LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None) as cluster,
        cluster.get_client() as dask,
    ):
        on_cluster = dask.get_executor(pure=False)
        places: dict[str, Any] = {"one process": None, "2 processes": 2, "Dask, 2 workers": on_cluster}
        for turn in range(ROUNDS + 1):  # the first warms up
            for name, workers in places.items():
                begun = perf_counter(), process_time()
                cf.study(designs, workers=workers)
                taken = perf_counter() - begun[0], process_time() - begun[1]
                spent[name] += [taken] if turn else []
    walls = {name: median(wall for wall, _ in each) for name, each in spent.items()}
    own = {name: 1e3 * median(cpu for _, cpu in each) / STROKES for name, each in spent.items()}
    return [
        [name, f"{STROKES / walls[name]:.0f}", f"{walls['one process'] / walls[name]:.2f}", f"{own[name]:.2f}"]
        for name in spent
    ]


def round_rows() -> list[list[str]]:
    """Processor time with a store, over that without: what the round of keys costs and saves."""
    designs, other = study(STROKES, "squirt"), study(16, "squirt", seed=2)
    half = study(STROKES // 2, "squirt")  # the first half of the same sequence

    def seconds(work: Callable[[], object]) -> float:
        begun = process_time()
        work()
        return process_time() - begun

    alone = median(seconds(lambda: cf.study(designs)) for _ in range(ROUNDS))
    rows = []
    for name, before in {"none": other, "half of them": half, "all": designs}.items():
        times = []
        for _ in range(ROUNDS):
            with tempfile.TemporaryDirectory() as folder:
                store = Path(folder) / "a.sqlite"
                cf.study(before, store=store)
                times.append(seconds(partial(cf.study, designs, store=store)))
        rows.append([name, f"{median(times) / alone:.2f}"])
    return rows


def text() -> str:
    rows, own, rounds = executor_rows(), parents(), round_rows()
    serial, parent_ms = 1e3 / float(rows[0][3]), float(own[-1][1])
    fed = 1e3 / parent_ms  # designs a second that one parent hands out
    return pages.page(
        "Studies of many designs",
        "How many designs a second does a study compute on processes and on a cluster? What does its own process need?",
        f"The parent needs {own[-1][1]} ms a design, so that {CORES} cores wait for it where a design takes less than "
        f"{CORES * parent_ms:.0f} ms. A million designs with eight responses need {own[-1][2]} MB, and {own[-1][3]} B "
        "of the store each.",
        f"{pages.machine()}, one thread, medians of {ROUNDS} runs of {STROKES} strokes; load average "
        f"{os.getloadavg()[2]:.0f}. Two processes start anew in each run. One process is the parent and computes too.",
        table(["where", "designs a second", "times one process", "parent, ms a design"], rows),
        "## The parent, if designs cost nothing",
        "Two processes that return random numbers; three parameters, eight responses. MB: growth of the peak.",
        table(["designs", "parent, ms a design", "MB", "store, B a design"], own),
        f"On paper, {CORES} cores at {serial:.0f} designs a second of processor time compute {CORES * serial:.2g} a "
        f"second; this parent hands out and stores at most {fed:.2g}.",
        "## The round of keys",
        "Processor time with a store that holds designs, over that without a store: a first round makes all keys.",
        table(["stored before", "times without a store"], rounds),
    )


EXAMPLE = """\
from time import perf_counter
import cuefem as cf

start = perf_counter()
result = cf.study("studies/sweeps/bore.toml", workers=2)
print(f"{result.count / (perf_counter() - start):.0f} designs a second")
"""
STUDY = pages.Study(__file__, text, seconds=True, example=EXAMPLE)

if __name__ == "__main__":
    STUDY.write()
