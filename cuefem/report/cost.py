"""What accuracy costs for one's own scene: errors against seconds and unknowns, and the resolutions to take."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping, Sequence
from time import perf_counter
from typing import Any

import numpy as np

from cuefem.report.charts import Axis, Chart, Curve, chart
from cuefem.results.convergence import MOST, Level, levels, relative_error
from cuefem.results.quantities import scaled, significant
from cuefem.results.records import Entry, Record, Sheet, sheet
from cuefem.scene import Scene

WANTED = (1e-2, 1e-3, 1e-4, 1e-6)

Track = Callable[[Sequence[Any]], Iterable[Any]]


def cost_record(scene: Scene, *, most: int = MOST, track: Track = iter) -> Record:
    """Levels of resolution up to ``most`` modes, each with its errors and seconds; what to take for `WANTED`.

    Of each level: "modes", "steps", "elements", "order", "unknowns"; "estimate", its estimated relative error (None on
    the first two); "difference" from the last level; "seconds" of all levels up to it, as `cuefem.resolve` takes.
    ValueError for a lumped cue, which is exact.
    """
    climbed = _climbed(scene, most, track)
    best = climbed[-1][0].outcome
    rows = [_level_record(scene, level, seconds, best) for level, seconds in climbed]
    return {"levels": rows, "wanted": [_recommended(rtol, rows) for rtol in WANTED]}


def _climbed(scene: Scene, most: int, track: Track) -> list[tuple[Level, float]]:
    """Levels with the seconds of the climb to each: up to ``most`` modes or the finest accuracy wanted.

    The climb is timed when it is done again, so that nothing is in it that a process does once.
    """
    climbed: list[Level] = []
    for level in levels(scene, min(WANTED)):
        if len(climbed) > 2 and level.at.modes > most:
            break
        climbed.append(level)
    again, start = levels(scene, min(WANTED)), perf_counter()
    return [(next(again), perf_counter() - start) for _ in track(climbed)]


def _level_record(scene: Scene, level: Level, seconds: float, best: Any) -> Record:
    return {
        "modes": level.at.modes,
        "steps": level.at.steps,
        "elements": level.at.elements,
        "order": level.at.order,
        "unknowns": level.outcome.unknowns,
        "estimate": level.outcome.error,
        "difference": None if level.outcome is best else relative_error(level.outcome, best, scene),
        "seconds": seconds,
    }


def _recommended(rtol: float, rows: Sequence[Record]) -> Record:
    """The first level whose estimate is within ``rtol``; none: the best, which says how far it gets."""
    judged = [row for row in rows if row["estimate"] is not None]
    first = next((row for row in judged if row["estimate"] <= rtol), None)
    names = ("modes", "steps", "elements", "order", "unknowns", "estimate", "seconds")
    last = judged[-1] if judged else rows[-1]
    return {"rtol": rtol, "reached": first is not None, **{name: (first or last)[name] for name in names}}


def cost_sheets(record: Record) -> list[Sheet]:
    """The levels, and what to take."""
    sizes: dict[str, Entry] = {"modes": "{modes}", "steps": "{steps}", "elements x order": _mesh}
    errors = {"estimate": "{estimate:error}", "difference": "{difference:error}"}
    times: dict[str, Entry] = {
        "ms, sequence": lambda row: significant(float(scaled(row["seconds"], "s")), 3),
    }
    last: dict[str, Entry] = {"estimate": "{estimate:error}", "ms": times["ms, sequence"]}
    return [
        sheet(
            "Convergence",
            sizes | errors | times,
            record["levels"],
            "Relative error, the largest of squirt, ball speed and spin: estimate, and difference from the last row.",
            "ms, sequence: time of all rows down to this one, which `resolve` runs.",
            "elements: number for all segments together; order: degree of their polynomials.",
        ),
        sheet(
            "Recommended resolution",
            {"accuracy": _asked} | sizes | last,
            record["wanted"],
            "With the truncation correction, as `resolve(scene, rtol)` and the rtol of a file's [accuracy] table.",
        ),
    ]


def _asked(row: Mapping[str, Any]) -> str:
    return f"{row['rtol']:.0e}" + ("" if row["reached"] else ", not reached; the best:")


def _mesh(row: Mapping[str, Any]) -> str:
    elements = row["elements"]
    return f"{sum(elements) if isinstance(elements, list) else elements} x {row['order']}"


def cost_charts(record: Record) -> list[Chart]:
    """Error against the time of the sequence, for a page."""
    levels = record["levels"]
    ms = [math.log10(scaled(row["seconds"], "s")) for row in levels]
    curves = [
        Curve(name, ms, np.log10([row[name] or np.nan for row in levels]), style)
        for name, style in (("estimate", "c1"), ("difference", "c3"))
    ]
    return [chart("Error against time", curves, x=Axis("time in ms, log10"), y=Axis("relative error, log10"))]
