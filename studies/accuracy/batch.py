"""How accurate are the numbers of a batch: frequencies at low order, end mass by few modes and a tail that fades?

What: eleven one-piece shafts 70 to 75 cm long, solid and hollow, of wood and carbon; (a) f1 to f5 at order 15; (b)
the stick end mass by few modes: as a plain sum, ended by the tail with its dashpot that single cues have by default,
and by the tail that fades (`cuefem.design.batch`, ended). At T = 0.7, 1 and 2 ms, and at 1.2, 1.3 and 1.4 ms, when the
fastest bending waves return from the joint as the contact ends. Reference: 250 modes with a tail, single cues; from
about 170 modes on it changes by less than 1e-5. Equations: handbook: The beam, Effective end mass. Writes batch.md and
batch.svg beside itself. Then how many shafts are computed in a second, of one piece, of wood, half of them bored, 20 %
up and down in diameters and modulus: in batches, one at a time, by the public `sweep` in one and in two worker
processes, in a stream of a million designs, with the memory at each tenth. Per second of a process's own time, the best
of a few rounds in turns, so that a busy machine matters less; sweeps in processes also in elapsed time. Writes
batch_seconds.md; takes a minute, and five more for the seconds.
"""

from __future__ import annotations

import os
import time
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import Executor
from contextlib import contextmanager
from dataclasses import dataclass, field, replace
from functools import cache
from statistics import median
from typing import Any, NamedTuple

import numpy as np
import psutil

from cuefem import Cue, CueBatch, Material, Resolution, Scene, Segment, StickLimit, Tip, batch_stick, end_mass, modes
from cuefem.beam.modes import Modes, solve
from cuefem.beam.system import assemble
from cuefem.beam.tail import flexibility, tail
from cuefem.beam.waves import mesh_for
from cuefem.cue import SegmentRows
from cuefem.design import Levels, Pool, Response, Row, Sample, Span, Study, Task, Vary, processes, sweep
from cuefem.design.batch import batch_frequencies
from cuefem.design.ranges import Value
from cuefem.design.sweep import scenes_of, tasks_of
from cuefem.endmass.drives import flexible, stick
from cuefem.tip_modes import tip_modes_from
from studies import pages
from studies.pages import table
from studies.strokes import cue, scene

MAPLE, ASH = Material(12.6e9, 0.84e9, 700.0), Material(13e9, 0.9e9, 680.0)
SOFT, STIFF = Material(9e9, 0.6e9, 600.0), Material(14e9, 1.1e9, 750.0)
CARBON, FOAM = Material(60e9, 6e9, 1550.0), Material(0.07e9, 0.025e9, 60.0)
TIMES, RETURNS = (0.7e-3, 1e-3, 2e-3), (1.2e-3, 1.3e-3, 1.4e-3)
FREQUENCIES_AT = Resolution(1, 15, 5)
# (order, modes): an order near 5/3 of the modes holds them well enough.
FADING = (Resolution(1, 20, 12), Resolution(1, 24, 14), Resolution(1, 30, 18), Resolution(1, 36, 22))
PLAIN = (Resolution(1, 24, 12), Resolution(1, 36, 24))
CHOSEN = FADING[2]
FINE, KEPT = 250, (8, 10, 12, 14, 16, 18, 22, 26, 32, 40, 50, 64)


def _shaft(
    length: float, tip: float, butt: float, material: Material, *bores: float, core: Material | None = None
) -> Cue:
    return Cue((Segment(length, tip, butt, material, *bores, core=core),), body_mass=0.42)


SHAFTS = {
    "[Kim]'s": cue("kim"),
    "slim maple": _shaft(0.74, 0.0115, 0.0205, MAPLE),
    "stout maple": _shaft(0.70, 0.0135, 0.0225, MAPLE),
    "maple bored 6 mm": _shaft(0.73, 0.0125, 0.0210, MAPLE, 0.006, 0.006),
    "maple bored 8 to 2 mm": _shaft(0.73, 0.0128, 0.0210, MAPLE, 0.008, 0.002),
    "ash": _shaft(0.74, 0.0127, 0.0215, ASH),
    "ash, snooker": _shaft(0.75, 0.0095, 0.0195, ASH),
    "stiff wood": _shaft(0.74, 0.0125, 0.0240, STIFF),
}
HARD = {
    "soft wood": _shaft(0.72, 0.0130, 0.0200, SOFT),
    "carbon over foam, wall 1 mm": _shaft(0.74, 0.0124, 0.0215, CARBON, 0.0104, 0.0185, core=FOAM),
    "carbon over foam, wall 1.5 mm": _shaft(0.72, 0.0120, 0.0210, CARBON, 0.0090, 0.0150, core=FOAM),
}
ALL = SHAFTS | HARD


@cache
def solved(name: str) -> Modes:
    """The modes of a shaft, many."""
    elements, order = mesh_for(ALL[name], FINE)
    return solve(assemble(ALL[name], elements=elements, order=order), FINE)


@cache
def exact(name: str, contact_time: float) -> float:
    """The stick end mass of a shaft, kg."""
    return by_modes(name, contact_time, FINE).dashpot


class Sums(NamedTuple):
    """The stick end mass of a shaft by its lowest modes, kg: a plain sum, and the two tails."""

    plain: float
    dashpot: float
    fading: float


def by_modes(name: str, contact_time: float, count: int) -> Sums:
    """The stick end mass by so many modes, all of them exact."""
    whole, struck = solved(name), scene(ALL[name], contact_time)
    kept = replace(whole, frequencies=whole.frequencies[:count], vectors=whole.vectors[:, :count])
    ended, limit = tip_modes_from(tail(kept, deflect=_deflect(name)), struck), StickLimit.of(struck)
    J = limit.transverse_impulse(*flexible(ended), top=kept.omega[-1])
    return Sums(stick(tip_modes_from(kept, struck), struck), stick(ended, struck), float(limit.end_mass(J)))


@cache
def _deflect(name: str) -> Callable[[np.ndarray], np.ndarray]:
    return flexibility(solved(name).system)


def errors(names: tuple[str, ...], contact_time: float, at: Resolution, ended: bool) -> np.ndarray:
    """Relative errors of the batch's stick end masses."""
    batch = CueBatch.of([ALL[name] for name in names])
    found, _ = batch_stick(batch, scene(cue("kim"), contact_time), at=at, ended=ended)
    return found / [exact(name, contact_time) for name in names] - 1


def frequency_errors() -> np.ndarray:
    """Largest relative error of f1 to f5 of every shaft at `FREQUENCIES_AT`."""
    found = batch_frequencies(CueBatch.of(list(ALL.values())), 5, at=FREQUENCIES_AT)
    return np.abs(found / [solved(name).frequencies[:5] for name in ALL] - 1).max(axis=1)


def each() -> Iterator[list[str | float]]:
    """Error of f1 to f5, and of the end mass at `CHOSEN`, in 1e-3."""
    names = tuple(ALL)
    off = np.transpose([errors(names, T, CHOSEN, True) for T in (*TIMES, *RETURNS)])
    for name, tones, row in zip(names, frequency_errors(), off, strict=True):
        yield [name, f"{max(tones, 1e-8):.0e}", *(f"{1e3 * value:.2f}" for value in row)]


def schemes() -> Iterator[list[str | float]]:
    """Largest and median errors of the eight shafts at `TIMES` and at `RETURNS`, in 1e-3, and largest of the others."""
    for ended, resolutions in ((False, PLAIN), (True, FADING)):
        for at in resolutions:
            off = lambda family, times, at=at, ended=ended: [errors(tuple(family), T, at, ended) for T in times]  # noqa: E731
            what = "batch, fading tail" if ended else "batch, plain sum"
            yield [what, f"{at.modes}", f"{at.order}", *_cells(off)]
    for count in (12, 18, 36, 72):
        yield [
            "tail with a dashpot",
            f"{count}",
            "–",
            *_cells(_single(lambda name, T, count=count: by_modes(name, T, count).dashpot)),
        ]
    for count in (36, 72):
        yield [
            "fading tail",
            f"{count}",
            "–",
            *_cells(_single(lambda name, T, count=count: by_modes(name, T, count).fading)),
        ]
    yield ["`end_mass` by default", "–", "–", *_cells(_single(lambda name, T: end_mass(scene(ALL[name], T))))]


Family = Iterable[str]
Errors = Callable[[Family, tuple[float, ...]], list[Any]]


def _single(value: Callable[[str, float], float]) -> Errors:
    """Errors of single cues."""
    return lambda family, times: [[value(name, T) / exact(name, T) - 1 for name in family] for T in times]


def _cells(off: Errors) -> list[str | float]:
    own, back, others = (
        np.abs(off(family, times)).ravel() for family, times in ((SHAFTS, TIMES), (SHAFTS, RETURNS), (HARD, TIMES))
    )
    values = (np.max(own), np.median(own), np.max(back), np.median(back), np.max(others))
    return [f"{1e3 * value:.2f}" for value in values]


def text() -> str:
    """The tables."""
    times = [f"{1e3 * T:g} ms" for T in (*TIMES, *RETURNS)]
    columns = ["largest", "median", "largest, 1.2 to 1.4 ms", "median", "largest of the last three"]
    return (
        "# What a batch's numbers are worth\n\n"
        f"One-piece shafts; f1 to f5 at order {FREQUENCIES_AT.order}; stick end mass by order {CHOSEN.order},\n"
        f"{CHOSEN.modes} modes and the tail that fades: errors in 1e-3.\n\n"
        + table(["shaft", "f1 to f5, relative", *times], each())
        + "\nErrors of the stick end mass in 1e-3: of the first eight shafts at 0.7, 1 and 2 ms and at 1.2, 1.3 and\n"
        "1.4 ms, and of the last three shafts at 0.7, 1 and 2 ms. Rows without an order are single cues with exact "
        "modes;\n"
        "the tail with a dashpot is the one that `end_mass` uses.\n\n"
        + table(["scheme", "modes", "order", *columns], schemes())
        + "\nThe error left at 18 modes comes from waves of higher frequencies that return to the tip just as the "
        "contact\n"
        "ends: on wood the fastest bending waves, of 10 to 40 kHz, at 1.2 to 1.4 ms, and near 1 ms those of 50 to\n"
        "80 kHz, at the tip's shear cut-off and above, where Timoshenko's beam no longer describes a shaft. No tail\n"
        "accounts for them; only more modes do. The study batch_wood.md covers all contact times.\n"
    )


def draw(axes: Any) -> None:
    """Error against modes, at the two sets of contact times."""
    labels = {"plain": "plain sum", "dashpot": "tail with a dashpot", "fading": "tail that fades"}
    for axis, times in zip(axes, (TIMES, RETURNS), strict=True):
        found = [[by_modes(name, T, n) for name in SHAFTS for T in times] for n in KEPT]
        off = np.abs(np.array(found) / [[exact(name, T)] for name in SHAFTS for T in times] - 1)
        for i, (name, mark) in enumerate(zip(labels, "s^o", strict=True)):
            (line,) = axis.loglog(KEPT, off[:, :, i].max(axis=1), mark + "-", ms=4, label=labels[name])
            axis.loglog(KEPT, np.median(off[:, :, i], axis=1), "--", color=line.get_color())
        axis.set_xticks(KEPT[::2], KEPT[::2])
        axis.minorticks_off()
        axis.set(xlabel="modes kept", ylim=(1e-4, 5e-2))
        axis.set_title("T = " + ", ".join(f"{1e3 * T:g}" for T in times) + " ms", fontsize=10)
    axes[0].set_ylabel("relative error of the stick end mass")
    axes[0].legend(fontsize=8, title="solid: largest of eight shafts\ndashed: median", title_fontsize=8)


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
    tones_at = FREQUENCIES_AT

    def several(work: Callable[[], Any]) -> Callable[[], Any]:
        return lambda: [work() for _ in range(few)]

    def sticks(at: Resolution, ended: bool) -> Callable[[], Any]:
        return lambda: batch_stick(many, struck, at=at, ended=ended)

    found: Works = {f"f1 to f5, order {tones_at.order}": (lambda: batch_frequencies(many, 5, at=tones_at), len(many))}
    for ended, resolutions in ((False, PLAIN), (True, FADING)):
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

    study: Study
    designs: int = 0
    memory: list[float] = field(default_factory=list)

    def take(self, designs: dict[int, tuple[Value, ...]], *, from_others: bool) -> list[Task] | None:
        """Everything."""
        return tasks_of(self.study, designs, *scenes_of(self.study, designs))

    def write(self, rows: list[Row]) -> None:
        """Count them; ValueError where one failed."""
        if any(row.failure for row in rows):
            raise ValueError(f"a design failed: {next(row.failure for row in rows if row.failure)}")
        before, self.designs = self.designs, self.designs + len(rows)
        if before * 10 // self.study.size != self.designs * 10 // self.study.size:
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
    store = Counted(study(count, ("end_mass",), SWEPT_AT))
    began, own, theirs = time.perf_counter(), time.process_time(), _children()
    sweep(store.study, store, pool=pool)
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
        warm = study(512 * workers, ("end_mass",), SWEPT_AT)
        sweep(warm, Counted(warm), pool=pool)
        yield pool


def streamed(count: int) -> tuple[float, list[float]]:
    """Designs a second of this process's own time in a long sweep of light ones, and the memory at each tenth, MiB."""
    store, began = Counted(study(count, ("frequency(1)", "mass"), Resolution(1, 5, 1))), time.process_time()
    sweep(store.study, store)
    return store.designs / (time.process_time() - began), store.memory


def seconds(size: Size, tell: Callable[[str], object] = lambda line: None) -> str:
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
    return (
        f"# Shafts a second\n\n{pages.machine()[:-1]}; load {os.getloadavg()[0]:.1f} when written. "
        "Per second of one core's own time; errors: [batch.md](batch.md).\n\n"
        f"{table(['what', 'shafts a second and core'], rows)}\n{sweeps}\n\n{stream}\n"
    )


STUDY = pages.Study(
    __file__, text, {"batch.svg": pages.Figure(draw, (1, 2), (9.6, 4.2))}, seconds=lambda: seconds(Size(), print)
)


if __name__ == "__main__":
    STUDY.write()
