"""What does accuracy cost: in the beam, in the modes kept, in the contact, and in the model itself?

What: (a) element order against number of elements, in f1 to f10 and the velocity end mass (2 ms, 24 modes); (b) modes
kept, as a plain sum and with `cuefem.beam.tail`, in squirt, ball speed and spin; (c) exactly propagated phases against
scipy's solve_ivp and Newmark's steps on the very same phases; (d) the ladder of models from the paper's closed form to
the coupled strike with effects, in squirt against the most complete model. Errors are the largest over a family: five
cues of meshes/ x (0.7 ms, b/R 0.4), (1 ms, 0.3), (2 ms, 0.1); in (c) Kim's four strokes of contact_cost.py. References:
12 elements of order 14; 220 modes with a tail on a mesh of another order; exact phases in cells a third as long. Left
out: AxialWaves, which lengthens the contact time that all the models share; SecondHit, which changes only what follows
the stroke; the tip's geometry, material data and friction, which no refinement improves. Equations: handbook: The beam,
The strike, Effective end mass, What the paper says, Effects. Parts: accuracy_cost_points.py computes. Writes
accuracy_cost.md and accuracy_cost.svg (values), accuracy_cost_seconds.md and accuracy_cost_seconds.png (seconds of the
machine named there) beside itself; takes about two minutes.
"""

from __future__ import annotations

import os
import platform
import subprocess
import sys
from collections.abc import Callable, Sequence
from functools import cache
from importlib import import_module
from pathlib import Path
from statistics import median
from time import process_time
from typing import Any

import numpy as np
import scipy
import scipy.linalg as la

from cuefem import resolve

HERE = Path(__file__).parent
if str(HERE) not in sys.path:
    sys.path.append(str(HERE))  # studies are files, not a package
common, contact_cost, points = (
    import_module("common"),
    import_module("contact_cost"),
    import_module("accuracy_cost_points"),
)

TICKS = (25, 30, 50, 100, 200, 400, 600, 1000, 2000, 4000)
NOISE = 1e-9  # errors below it are rounding and differ from machine to machine


@cache
def curves(part: str) -> dict[str, list[Any]]:
    """The points of one part, by the name of their curve."""
    if part == "beam":
        return {a_piece(n): points.beam_points(n) for n in points.ELEMENTS}
    if part == "modes":
        return {name: points.mode_points(by_tail=name == "tail") for name in ("plain sum", "tail")}
    return {kind: points.contact_points(kind) for kind in ("exact", "DOP853", "Radau", "Newmark")}


def a_piece(elements: int) -> str:
    """So many elements a piece, in words."""
    return f"{elements} element{'s' if elements > 1 else ''} a piece"


def size(error: float) -> str:
    """An error to one digit, or that it is below the noise."""
    return f"< {NOISE:.0e}" if error < NOISE else f"{error:.0e}"


def beam_table() -> str:
    """Errors by order and elements."""
    by_name = {point.name: point for curve in curves("beam").values() for point in curve}
    rows = []
    for order in points.ORDERS:
        cells = [by_name.get(f"{n} x {order}") for n in points.ELEMENTS]
        rows.append([str(order), *("" if p is None else f"{size(p.error)} ({p.unknowns})" for p in cells)])
    return str(common.table(["order", *(a_piece(n) for n in points.ELEMENTS)], rows))


def modes_table() -> str:
    """Errors by modes kept, plain and with a tail."""
    plain, ended = curves("modes")["plain sum"], curves("modes")["tail"]
    rows = [
        [p.name.split()[0], size(p.error), size(t.error), str(t.unknowns)] for p, t in zip(plain, ended, strict=True)
    ]
    return str(common.table(["modes kept", "plain sum", "with a tail", "unknowns"], rows))


def contact_table() -> str:
    """Errors of the contact's solvers."""
    rows = [[kind, p.name, size(p.error)] for kind, curve in curves("contact").items() for p in curve]
    return str(common.table(["solver", "how finely", "error"], rows))


def model_table() -> str:
    """Errors of the models."""
    rows = []
    for name in points.models():
        errors = 100 * points.model_errors(name)
        rows.append([name, *(f"{value:.0f}" for value in (np.median(errors), errors.min(), errors.max()))])
    return str(common.table(["model", "median, %", "lowest, %", "highest, %"], rows))


def point(elements: int, order: int) -> Any:
    """A point of the beam's part."""
    return next(p for p in curves("beam")[a_piece(elements)] if p.name == f"{elements} x {order}")


def conclusions() -> list[str]:
    """Three sentences, of numbers that the tables hold."""
    low, high, more, most = point(8, 4), point(4, 8), point(8, 8), point(4, 16)
    plain, ended = curves("modes")["plain sum"][-1], curves("modes")["tail"][-1]
    coarse = curves("contact")["Newmark"][0]
    names = list(points.models())
    off = {name: f"{100 * np.median(np.abs(points.model_errors(name))):.0f} %" for name in names}
    return [
        "A higher order pays more than more elements. With a thousand unknowns, 8 elements of order 4 leave an error "
        f"of {size(low.error)} and 4 elements of order 8 leave {size(high.error)}; with two thousand, 8 of order 8 "
        f"leave {size(more.error)} and 4 of order 16 {size(most.error)}.",
        f"{ended.name.capitalize()} with a tail leave an error of {size(ended.error)}; without it the error is "
        f"{size(plain.error)}, {plain.error / ended.error:.0f} times as large. The contact adds nothing to that: even "
        f"{coarse.name} of Newmark leave only {size(coarse.error)}, and exact phases {size(0.0)}.",
        f"No refinement makes up for a wrong model. In the median the paper's 12 g is {off[names[0]]} off, the stick "
        f"end mass {off['lumped, stick end mass']}, the bare coupled strike {off['coupled']}, the coupled strike with "
        f"the dome of the tip {off['... and dome']}, and with the shear of the tip too {off['... and tip shear']}.",
    ]


def report() -> str:
    """The values, without seconds."""
    return "\n".join(
        [
            "# What accuracy costs\n",
            f"Largest relative errors over {points.SAID}; below {NOISE:.0e} they are",
            "rounding. Seconds: [accuracy_cost_seconds.md](accuracy_cost_seconds.md).\n",
            *(f"{i}. {sentence}" for i, sentence in enumerate(conclusions(), 1)),
            "\n## (a) The beam: order against elements\n\nf1 to f10 and the velocity end mass (2 ms, 24 modes). "
            "Brackets hold the unknowns of the largest cue; a cell is empty if there are fewer than 24 modes.\n",
            beam_table(),
            "## (b) The modes kept\n\nSquirt, ball speed and spin, on a mesh that holds the modes to 2e-7.\n",
            modes_table(),
            "## (c) The contact\n\nThe four strokes of [contact_cost.md](contact_cost.md), 24 modes; Newmark's steps "
            "are those of one head-on contact time.\n",
            contact_table(),
            "## (d) The ladder of models\n\nThe error of squirt relative to the last row.\n",
            model_table(),
        ]
    )


def draw_values(path: Path) -> None:
    """Error against unknowns: beam and modes."""
    with common.figure(path, (1, 2), (9.6, 4.2)) as axes:
        for panel, part in zip(axes, ("beam", "modes"), strict=True):
            for name, curve in curves(part).items():
                panel.loglog([p.unknowns for p in curve], [max(p.error, 1e-13) for p in curve], "o-", label=name)
            panel.legend()
        axes[0].set(xlabel="unknowns of the largest cue", ylabel="largest relative error", title="(a) the beam")
        axes[1].set(xlabel="unknowns of the strike", title="(b) the modes kept")
        for panel in axes:
            plain_ticks(panel.xaxis, TICKS)


def seconds_of(work: Callable[[], Any], repeats: int) -> float:
    """Median seconds of the processor, which what else runs on the machine does not lengthen much."""
    times = []
    for _ in range(repeats):
        start = process_time()
        work()
        times.append(process_time() - start)
    return median(times)


def plain_ticks(axis: Any, ticks: Sequence[float]) -> None:
    """Ticks as plain numbers, where powers of ten are too few."""
    low, high = axis.get_view_interval()
    axis.set_ticks([t for t in ticks if low <= t <= high], [f"{t:g}" for t in ticks if low <= t <= high])
    axis.set_tick_params(which="minor", label1On=False)


@cache
def seconds(part: str, name: str) -> list[float]:
    """Median seconds of a curve's points."""
    return [seconds_of(point.work, 5) for point in curves(part)[name]]


@cache
def model_seconds(name: str) -> float:
    """Median seconds of one stroke (pool_maple, 1 ms, b/R 0.3) by a model."""
    work, scene = points.models()[name], points.family()[4]
    work(scene)
    return float(seconds_of(lambda: work(scene), 5))


def draw_seconds(path: Path) -> None:
    """Error against seconds, all four parts, and how the cost grows."""
    with common.figure(path, (2, 3), (10.6, 6.4)) as grid:
        axes = grid.ravel()
        titles = ("(a) the beam: f1 to f10 of Kim's shaft", "(b) the modes kept", "(c) the contact")
        for panel, part, title in zip(axes[:3], ("beam", "modes", "contact"), titles, strict=True):
            for name, curve in curves(part).items():
                panel.loglog(seconds(part, name), [max(p.error, 1e-13) for p in curve], "o-", label=name)
            panel.set(title=title, xlabel="seconds", ylabel="largest relative error")
            panel.legend()
        axes[2].set_xlim(right=30)  # room for the legend
        plain_ticks(axes[1].xaxis, (0.005, 0.01, 0.02, 0.05, 0.1, 0.2))
        for i, name in enumerate(list(points.models())[:-1]):
            error = float(np.median(np.abs(points.model_errors(name))))
            axes[3].loglog(model_seconds(name), error, "os^v<>DPX*"[i % 10], label=name)
        axes[3].set(title="(d) models", xlabel="seconds", ylabel="median relative error of squirt", xlim=(1e-7, 1))
        plain_ticks(axes[3].yaxis, (0.01, 0.02, 0.05, 0.1, 0.2, 0.5))
        axes[3].legend(fontsize=7, loc="lower left")
        for panel, (name, rows) in zip(axes[4:], grown().items(), strict=True):
            n, t = np.array([row[0] for row in rows]), np.array([row[1] for row in rows])
            power = 3 if "modes kept" in name else 1
            panel.loglog(n, t, "o-", label=name)
            panel.loglog(n, t[-1] * (n / n[-1]) ** power, "k:", label=f"power {power}")
            panel.set(title=f"growth: {name}", xlabel=name.split(", ")[1], ylabel="seconds")
            plain_ticks(panel.xaxis, TICKS)
            panel.legend()


@cache
def grown() -> dict[str, list[tuple[int, float]]]:
    """Median seconds of the work that grows."""
    found = {}
    for name, rows in points.growth().items():
        for _, work in rows:
            work()
        found[name] = [(n, seconds_of(work, 3)) for n, work in rows]
    return found


def seconds_report() -> str:
    """The cost table of this machine."""
    matrix = np.random.default_rng(0).normal(size=(50, 50))
    matrix /= np.linalg.norm(matrix, 2)
    expm = seconds_of(lambda: la.expm(matrix), 200)
    line = "| {} | {} | {} | {:.2f} |".format
    rows = [
        line(part, f"{name}: {p.name}", size(p.error), 1e3 * t)
        for part in ("beam", "modes", "contact")
        for name, curve in curves(part).items()
        for p, t in zip(curve, seconds(part, name), strict=True)
    ]
    for name in points.models():
        error = float(np.median(np.abs(points.model_errors(name))))
        rows.append(line("models", name, f"{error:.0e}" if error else "", 1e3 * model_seconds(name)))
    ratios, wanted = [], []
    for rtol in (1e-2, 1e-3, 1e-4):
        scene = points.family()[1]
        t = seconds_of(lambda r=rtol, s=scene: resolve(s, r), 5)
        wanted.append(f"| {rtol:.0e} | {1e3 * t:.1f} | {t / expm:.0f} |")
    for name, found in grown().items():
        steep = np.log(found[-1][1] / found[-2][1]) / np.log(found[-1][0] / found[-2][0])
        times = ", ".join(f"{n}: {1e3 * t:.0f} ms" for n, t in found)
        ratios.append(f"- {name}: {times}; power {steep:.1f} at the last step")
    return (
        "\n".join(
            [
                "# Seconds of accuracy\n",
                f"{common.processor()}, one BLAS thread, Python {platform.python_version()}, numpy "
                f"{np.__version__}, scipy {scipy.__version__}. Median processor\nseconds of five; the models: one "
                "stroke of pool_maple, 1 ms, b/R 0.3.\n",
                "| part | how | error | ms |\n|---|---|---|---|",
                *rows,
                "\n`resolve` of Kim's stroke (1 ms, b/R 0.3), all rungs included, against one scipy.linalg.expm of a "
                f"50 x 50\nmatrix of norm 1, {1e3 * expm:.3f} ms:\n",
                "| rtol | ms | expm |\n|---|---|---|",
                *wanted,
                "\nGrowth:\n",
                *ratios,
            ]
        )
        + "\n"
    )


def main() -> None:
    """Write tables and figures, in a process of one BLAS thread: small products on two can take far longer."""
    if any(os.environ.get(name) != "1" for name in contact_cost.THREADS):
        pinned = {**os.environ, **dict.fromkeys(contact_cost.THREADS, "1")}
        subprocess.run([sys.executable, "-m", "studies.accuracy_cost"], env=pinned, cwd=HERE.parent, check=True)
        return
    (HERE / "accuracy_cost.md").write_text(report(), encoding="utf-8")
    draw_values(HERE / "accuracy_cost.svg")
    (HERE / "accuracy_cost_seconds.md").write_text(seconds_report(), encoding="utf-8")
    draw_seconds(HERE / "accuracy_cost_seconds.png")


if __name__ == "__main__":
    main()
