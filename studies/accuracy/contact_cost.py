"""What do exactly propagated phases cost compared with a general ODE solver, at equal accuracy?

What: strokes of meshes/kim.toml (24 flexible modes, T = 1 ms, e = 3/4, mu = 0.7, a ball of 210 g) at four offsets, from
little slip to a miscue, by exact phases and by scipy's solve_ivp (DOP853, and Radau with its Jacobian) on the very same
linear phases, their ends found by solve_ivp's events. All follow the matrices of linear_phases.py, which are the
study's own; a test holds its exact phases against `cuefem.strike`, whose contact the seconds are of. Each solver's rtol
is the loosest power of ten that holds squirt and ball speed of all four strokes to 1e-8 of the exact phases; those are
checked against cells a third as long. Equations: handbook: The strike. Values and seconds stand on pages of their own;
takes about 5 s.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import cache
from statistics import median
from time import perf_counter
from typing import Any

import numpy as np

from cuefem import Resolution
from cuefem.tip_modes import tip_modes_of
from studies import pages, strokes
from studies.accuracy.linear_phases import Follow, Stroke, by_solver, exactly

MODES, OFFSETS, ACCURACY = 24, (0.1, 0.3, 0.5, 0.8), 1e-8
AT = Resolution(4, 22, MODES)
TOLERANCES = dict.fromkeys(("DOP853", "Radau"), 10.0 ** -np.arange(3, 13))


@cache
def stroke(offset: float) -> Stroke:
    """One of the strokes."""
    scene = strokes.scene(strokes.cue("kim"), offset=offset)
    return Stroke(scene, tip_modes_of(scene, AT))


def worst(follow: Follow) -> float:
    """Largest error of squirt or speed over the strokes, against the exact phases."""
    pairs = [(stroke(offset).run(follow), stroke(offset).run(exactly())) for offset in OFFSETS]
    return max(max(abs(end.squirt - best.squirt), abs(end.speed - best.speed)) for end, best in pairs)


@cache
def tolerance(method: str) -> tuple[float, float]:
    """The loosest rtol of a solver that holds the accuracy on all strokes, and its worst error."""
    for rtol in TOLERANCES[method]:
        error = worst(by_solver(method, rtol))
        if error < ACCURACY:
            return rtol, error
    raise RuntimeError(f"{method} does not reach {ACCURACY} with an rtol down to {rtol}")


def in_the_package(offset: float) -> object:
    """The contact as cuefem follows it."""
    return strokes.strike_modes(stroke(offset).scene, stroke(offset).tip)


def bound(error: float) -> str:
    """The power of ten just above an error."""
    return f"1e{math.ceil(math.log10(max(error, 1e-13)))}"


def report() -> str:
    """The values, without seconds."""
    lines = [
        "# Exactly propagated phases against a general ODE solver",
        "",
        f"Kim's cue, {MODES} modes, T = 1 ms; b/R {', '.join(map(str, OFFSETS))}. Errors are the largest over the",
        "strokes, of squirt (rad) or ball speed (relative to the cue's), rounded up to a power of ten. What it costs:",
        "[contact_cost_seconds.md](contact_cost_seconds.md).",
        "",
        "| solver | rtol | error below |",
        "|---|---|---|",
        f"| exact phases | | {bound(worst(exactly(3)))} |",
    ]
    for method in TOLERANCES:
        rtol, error = tolerance(method)
        lines.append(f"| solve_ivp {method} | {rtol:.0e} | {bound(error)} |")
    lines += ["", "| b/R | squirt, degrees | phases |", "|---|---|---|"]
    for offset in OFFSETS:
        end = stroke(offset).run(exactly())
        lines.append(f"| {offset} | {np.degrees(end.squirt):.6f} | {', '.join(end.phases)} |")
    return "\n".join(lines) + "\n"


def seconds() -> str:
    """The cost table of this machine; solvers take turns, so that a busy machine is busy for all."""
    solvers: dict[str, tuple[Callable[[float], Any], int]] = {"exact phases": (in_the_package, 25)}
    for method in TOLERANCES:
        rtol = tolerance(method)[0]
        solvers[f"solve_ivp {method}"] = (lambda b, m=method, r=rtol: stroke(b).run(by_solver(m, r)), 5)
    solvers["solve_ivp Radau"] = (solvers["solve_ivp Radau"][0], 1)
    cost = {
        name: [pages.seconds_of(lambda b=b, w=work: w(b), repeats, perf_counter) for b in OFFSETS]
        for name, (work, repeats) in solvers.items()
    }
    expm = pages.seconds_of(pages.expm_50(), 200, perf_counter)
    exact = np.array(cost["exact phases"])
    lines = [
        "# Seconds of one stroke",
        "",
        pages.machine(),
        f"Medians, milliseconds, at an accuracy of {ACCURACY:.0e}.",
        "",
        "| solver | " + " | ".join(f"b/R {b}" for b in OFFSETS) + " | median ratio to exact phases |",
        "|---|" + "---|" * (len(OFFSETS) + 1),
    ]
    for name, times in cost.items():
        cells = " | ".join(f"{1e3 * t:.2f}" for t in times)
        lines.append(f"| {name} | {cells} | {np.median(np.array(times) / exact):.1f} |")
    share = median(exact) / expm
    lines += [
        "",
        f"One scipy.linalg.expm of a 50 x 50 matrix: {1e3 * expm:.3f} ms; a stroke costs {share:.1f} of them.",
    ]
    return "\n".join(lines) + "\n"


STUDY = pages.Study(__file__, report, seconds=seconds, heavy=False)


if __name__ == "__main__":
    STUDY.write()
