"""What are the numbers of a batch worth: frequencies at low order, end mass by few modes and a tail that fades?

What: eleven one-piece shafts 70 to 75 cm long, solid and hollow, of wood and carbon; (a) f1 to f5 at order 15; (b)
the stick end mass by few modes: as a plain sum, ended by the tail with its dashpot that single cues have by default,
and by the tail that fades (`cuefem.design.batch`, ended). At T = 0.7, 1 and 2 ms, and at 1.2, 1.3 and 1.4 ms, when the
fastest bending waves are back from the joint as the contact ends. Reference: 250 modes with a tail, single cues; from
about 170 modes on it stands to 1e-5. Equations: physics.md sections 4 and 6. Writes batch.md and batch.svg (values)
beside itself; takes about a minute. What it costs: batch_seconds.py.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from dataclasses import replace
from functools import cache
from typing import Any, NamedTuple

import numpy as np

from cuefem import Cue, Material, Resolution, Segment
from cuefem.beam.modes import Modes, solve
from cuefem.beam.system import assemble
from cuefem.beam.tail import flexibility, tail
from cuefem.beam.waves import mesh_for
from cuefem.design.batch import CueBatch, batch_frequencies, batch_stick
from cuefem.endmass.drives import end_mass, flexible, stick
from cuefem.endmass.undamped import StickLimit
from cuefem.tip_modes import tip_modes_from
from studies.common import STUDIES, cue, figure, scene, table

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
        "1.4 ms, and of the last three shafts at 0.7, 1 and 2 ms. Without an order: single cues with exact modes; the\n"
        "tail with a dashpot is `end_mass`'s own.\n\n"
        + table(["scheme", "modes", "order", *columns], schemes())
        + "\nWhat is left at 18 modes is waves of higher frequencies that are just back at the tip when the contact\n"
        "ends: on wood the fastest bending waves, of 10 to 40 kHz, at 1.2 to 1.4 ms, and about 1 ms those of 50 to\n"
        "80 kHz at the tip's shear cut-off and above it, where Timoshenko's beam is a picture of a shaft no more. No\n"
        "tail knows of them, only more modes do. Over all contact times: batch_wood.md.\n"
    )


def draw() -> None:
    """Error against modes, at the two sets of contact times."""
    labels = {"plain": "plain sum", "dashpot": "tail with a dashpot", "fading": "tail that fades"}
    with figure(STUDIES / "batch.svg", (1, 2), (9.6, 4.2)) as axes:
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


if __name__ == "__main__":
    (STUDIES / "batch.md").write_text(text(), encoding="utf-8")
    draw()
