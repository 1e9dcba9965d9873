"""Convergence study of a strike: error against run time and degrees of freedom, and recommended resolutions."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from time import perf_counter
from typing import Any

import numpy as np

from cuefem.contact.refinement import Level, refinement_levels, relative_error
from cuefem.quantity.display_units import significant, to_display
from cuefem.quantity.fields import check_count
from cuefem.results.progress import Progress
from cuefem.results.records import ColumnEntry, Record, Table, tabulate
from cuefem.scene import Scene, check_scene
from cuefem.show.analysis import Analysis, Rows
from cuefem.show.charts import Axis, Chart, Curve, chart

RECOMMENDED_RTOLS = (1e-2, 1e-3, 1e-4, 1e-6)
DEFAULT_MAX_MODES = 150


@dataclass(frozen=True)
class ConvergenceStudy(Rows, Analysis):
    """Error of a strike against degrees of freedom and run time, and the resolution for some accuracies.

    Parameters
    ----------
    scene : Scene
        The analysed stroke.
    levels : list of dict
        For each refinement level "modes", "steps"; "unknowns", the number of degrees of freedom; "estimate", its
        estimated relative error; "difference", relative, from the last level; "seconds", the run time of all levels up
        to it, which `cuefem.strike` takes with rtol.
    recommended_resolutions : list of dict
        For each of some accuracies, "rtol", the first level within it, or the last, with "is_reached" False.
    """

    levels: list[Record]
    recommended_resolutions: list[Record]

    def frame_rows(self) -> list[Record]:
        """A row for each level."""
        return self.levels

    def tables(self) -> list[Table | str]:
        """The refinement levels, and the recommended resolutions."""
        sizes: dict[str, ColumnEntry] = {"modes": "{modes}", "steps": "{steps}"}
        errors = {"estimate": "{estimate:error}", "difference": "{difference:error}"}
        times: dict[str, ColumnEntry] = {
            "ms, sequence": lambda row: significant(float(to_display(row["seconds"], "s")), 3),
        }
        last: dict[str, ColumnEntry] = {"estimate": "{estimate:error}", "ms": times["ms, sequence"]}
        return [
            tabulate(
                "Convergence",
                sizes | errors | times,
                self.levels,
                "Relative error, the largest of squirt, ball speed and spin: estimate, and difference from the last "
                "row.",
                "ms, sequence: time of all rows down to this one, which `strike(scene, rtol=...)` runs.",
            ),
            tabulate(
                "Recommended resolution",
                {"accuracy": _accuracy} | sizes | last,
                self.recommended_resolutions,
                "With the truncation correction, as `strike(scene, rtol=...)` and [accuracy] of a file take it.",
            ),
        ]

    def charts(self) -> list[Chart]:
        """Error against run time."""
        ms = [math.log10(to_display(row["seconds"], "s")) for row in self.levels]
        curves = [
            Curve(name, ms, np.log10([row[name] or np.nan for row in self.levels]), style)
            for name, style in (("estimate", "c1"), ("difference", "c3"))
        ]
        return [chart("Error against time", curves, x=Axis("time in ms, log10"), y=Axis("relative error, log10"))]


def convergence_study(
    scene: Scene, max_modes: int = DEFAULT_MAX_MODES, *, progress: Progress = iter
) -> ConvergenceStudy:
    """Run a convergence study of a strike, and recommend a resolution for each of some accuracies.

    Parameters
    ----------
    scene : Scene
        A stroke with a cue of segments, or with a lumped cue, of which only the steps are refined.
    max_modes : int
        Refinement ends at so many modes, or the default number if that is larger.
    progress : callable, optional
        Wraps the list of levels, to show progress.

    Returns
    -------
    ConvergenceStudy
        Show it with ``print``, in a notebook, or by ``.save("cost.html")``.

    Examples
    --------
    >>> import cuefem as cf
    >>> wood = cf.Material(E=12.6e9, G=0.84e9, rho=700.0)
    >>> cue = cf.Cue((cf.Segment(0.7, 0.012, 0.021, wood),), body_mass=0.43)
    >>> scene = cf.Scene(cue, tip=cf.Tip(contact_time=1e-3), stroke=cf.Stroke(offset=0.3))
    >>> [level["steps"] for level in cf.convergence_study(scene, max_modes=24).levels][:2]
    [400, 800]
    """
    check_scene("convergence_study scene", scene)
    check_count("convergence_study max_modes", max_modes, 1)
    refined = _timed_levels(scene, max_modes, progress)
    best = refined[-1][0].outcome
    rows = [_level_record(scene, level, seconds, best) for level, seconds in refined]
    return ConvergenceStudy(scene, rows, [_recommended(rtol, rows) for rtol in RECOMMENDED_RTOLS])


def _timed_levels(scene: Scene, max_modes: int, progress: Progress) -> list[tuple[Level, float]]:
    """Levels with the run time, s, up to each: to ``max_modes`` modes or the smallest of `RECOMMENDED_RTOLS`.

    A second run of the sequence is timed, so that the time includes nothing that a process does only once.
    """
    finest = min(RECOMMENDED_RTOLS)
    refined = list(refinement_levels(scene, finest, max_modes=max_modes))
    again, start = refinement_levels(scene, finest, max_modes=max_modes), perf_counter()
    return [(next(again), perf_counter() - start) for _ in progress(refined)]


def _level_record(scene: Scene, level: Level, seconds: float, best: Any) -> Record:
    return {
        "modes": level.modes,
        "steps": level.steps,
        "unknowns": level.outcome.unknowns,
        "estimate": level.error,
        "difference": None if level.outcome is best else relative_error(level.outcome, best, scene),
        "seconds": seconds,
    }


def _recommended(rtol: float, rows: Sequence[Record]) -> Record:
    """The first level with an estimated error of at most ``rtol``; otherwise the last, with "is_reached" False."""
    first = next((row for row in rows if row["estimate"] <= rtol), None)
    names = ("modes", "steps", "unknowns", "estimate", "seconds")
    return {"rtol": rtol, "is_reached": first is not None, **{name: (first or rows[-1])[name] for name in names}}


def _accuracy(row: Mapping[str, Any]) -> str:
    return f"{row['rtol']:.0e}" + ("" if row["is_reached"] else ", not reached; the best:")
