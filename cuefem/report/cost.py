"""What accuracy costs for one's own scene: errors against seconds and unknowns, and the resolutions to take."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from time import perf_counter
from typing import Any

import numpy as np

from cuefem.accuracy import FIRST, JUDGED, MOST, RATIO, Rung, ladder, relative_error
from cuefem.contact.strike import strike
from cuefem.report.figures import figure_content
from cuefem.results.quantities import NONE, TRADE, significant
from cuefem.results.records import Entry, Record, Sheet, sheet
from cuefem.scene import Scene

WANTED = (1e-2, 1e-3, 1e-4, 1e-6)
# A plain sum past so many modes takes seconds and says nothing new.
MOST_PLAIN = 150
TICKS = (10, 20, 30, 50, 100, 200, 300, 500, 1000)

Track = Callable[[Sequence[Any]], Iterable[Any]]


def cost_record(scene: Scene, *, most: int = MOST, track: Track = iter) -> Record:
    """A ladder of resolutions up to ``most`` modes, each with its errors and seconds; what to take for `WANTED`.

    Of each rung: "modes", "elements", "order", "unknowns"; "estimate", its estimated relative error (None on the first
    rungs); "difference" from the last rung; "seconds" of all rungs up to it, which is what `cuefem.resolve` takes, and
    "plain", the sum without a tail: its own difference and seconds. ValueError for a lumped cue, which is exact.
    """
    climbed = _climbed(scene, most, track)
    best = climbed[-1][0].outcome
    rungs = [_rung_record(scene, rung, seconds, best) for rung, seconds in track(climbed)]
    return {"rungs": rungs, "wanted": [_recommended(rtol, rungs) for rtol in WANTED]}


def _climbed(scene: Scene, most: int, track: Track) -> list[tuple[Rung, float]]:
    """Rungs with the seconds of the climb to each: up to ``most`` modes or the finest accuracy wanted.

    The climb is timed when it is done again, so that nothing is in it that a process does once.
    """
    climbed: list[Rung] = []
    rungs = ladder(scene)
    for _ in track(range(_rungs_up_to(most))):
        rung = next(rungs, None)
        if rung is None or (len(climbed) > JUDGED and rung.at.modes > most):
            break
        climbed.append(rung)
        if rung.outcome.error is not None and rung.outcome.error <= min(WANTED):
            break
    again, start = ladder(scene), perf_counter()
    return [(next(again), perf_counter() - start) for _ in track(climbed)]


def _rungs_up_to(most: int) -> int:
    """No fewer than a ladder from its lowest possible start has."""
    return JUDGED + 3 + int(np.log(max(most, FIRST) / FIRST) / np.log(RATIO))


def _rung_record(scene: Scene, rung: Rung, seconds: float, best: Any) -> Record:
    plain = None
    if rung.at.modes <= MOST_PLAIN:
        start = perf_counter()
        outcome = strike(scene, rung.at)
        plain = {"seconds": perf_counter() - start, "difference": relative_error(outcome, best, scene)}
    return {
        "modes": rung.at.modes,
        "elements": list(rung.at.elements) if isinstance(rung.at.elements, tuple) else rung.at.elements,
        "order": rung.at.order,
        "unknowns": rung.outcome.unknowns,
        "estimate": rung.outcome.error,
        "difference": None if rung.outcome is best else relative_error(rung.outcome, best, scene),
        "seconds": seconds,
        "plain": plain,
    }


def _recommended(rtol: float, rungs: Sequence[Record]) -> Record:
    """The first rung whose estimate is within ``rtol``; none: the best, which says how far it gets."""
    judged = [rung for rung in rungs if rung["estimate"] is not None]
    first = next((rung for rung in judged if rung["estimate"] <= rtol), None)
    names = ("modes", "elements", "order", "unknowns", "estimate", "seconds")
    last = judged[-1] if judged else rungs[-1]
    return {"rtol": rtol, "reached": first is not None, **{name: (first or last)[name] for name in names}}


def cost_sheets(record: Record) -> list[Sheet]:
    """The ladder, and what to take."""
    sizes: dict[str, Entry] = {"modes": "{modes}", "elements x order": _mesh, "unknowns": "{unknowns}"}
    errors = {"estimate": "{estimate:error}", "difference": "{difference:error}"}
    times: dict[str, Entry] = {
        "ms, climb": lambda row: _milliseconds(row["seconds"]),
        "plain sum": "{plain[difference]:error}",
        "ms, plain": lambda row: _milliseconds((row["plain"] or {}).get("seconds")),
    }
    last: dict[str, Entry] = {"estimate": "{estimate:error}", "ms": times["ms, climb"]}
    return [
        sheet(
            "Error against cost",
            sizes | errors | times,
            record["rungs"],
            "Largest relative error of squirt, ball speed and spin: as estimated, and as the difference from the last "
            "row.",
            "ms, climb: time of all rows down to this one, as `resolve` takes it. Plain sum: the same modes without "
            "what the modes left out add (the tail).",
            "elements: number for all segments together; order: degree of their polynomials.",
        ),
        sheet(
            "What to take",
            {"accuracy": _asked} | sizes | last,
            record["wanted"],
            "With the tail, as `resolve(scene, rtol)` and a file's [accuracy] rtol compute.",
        ),
    ]


def _asked(row: Mapping[str, Any]) -> str:
    return f"{row['rtol']:.0e}" + ("" if row["reached"] else ", not reached: the best is")


def _mesh(row: Mapping[str, Any]) -> str:
    elements = row["elements"]
    return f"{sum(elements) if isinstance(elements, list) else elements} x {row['order']}"


def _milliseconds(value: float | None) -> str:
    return NONE if value is None else significant(TRADE["s"][0] * value, 3)


def cost_figure(record: Record, title: str, kind: str) -> bytes:
    """Error against seconds and against unknowns, both axes logarithmic, as a file's content; kind: "png", "svg"."""

    def draw(canvas: Any, panels: Any) -> None:
        for axes, name in zip(panels, ("seconds", "unknowns"), strict=True):
            _draw(axes, record["rungs"], name)
        panels[0].set(xlabel="seconds (tail: the whole climb)", ylabel="largest relative error")
        panels[1].set(xlabel="unknowns of the strike")
        panels[0].legend()
        low, high = panels[1].get_xlim()
        ticks = [tick for tick in TICKS if low <= tick <= high]
        panels[1].set_xticks(ticks, [str(tick) for tick in ticks])
        panels[1].minorticks_off()
        canvas.suptitle(title)

    return figure_content(kind, draw, ncols=2, figsize=(9, 4.2), sharey=True)


def _draw(axes: Any, rungs: Sequence[Record], name: str) -> None:
    judged = [rung for rung in rungs if rung["estimate"] is not None]
    known = [rung for rung in rungs if rung["difference"]]
    plain = [rung for rung in rungs if rung["plain"]]
    sizes = [rung["plain"]["seconds"] if name == "seconds" else rung["unknowns"] for rung in plain]
    axes.loglog([r[name] for r in judged], [r["estimate"] for r in judged], "o-", color="C0", label="tail: estimate")
    axes.loglog(
        [r[name] for r in known], [r["difference"] for r in known], "o--", color="C0", mfc="w", label="tail: difference"
    )
    axes.loglog(sizes, [r["plain"]["difference"] for r in plain], "s:", color="C1", label="plain sum: difference")
