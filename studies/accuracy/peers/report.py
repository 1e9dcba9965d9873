"""The table and the figure of a contest."""

from __future__ import annotations

import platform
from pathlib import Path
from textwrap import fill

import matplotlib.pyplot as plt
import numpy as np
import scipy

from studies.accuracy.peers.contest import TARGETS, Contest, Contestant
from studies.pages import processor

TITLES = {"modes": "modes: f3 to f5", "end_mass": "end_mass: force, median"}
# (task, contestant, at least so many times cuefem's seconds)
ASKED = (
    ("modes", "NGSolve + scipy, p = 10, x 2", 3.5),
    ("modes", "scikit-fem P2 x 150", 22.0),
    ("modes", "OpenSeesPy x 1240", 140.0),
    ("modes", "LAPACK dsygvd alone", 1 / 3),
    ("end_mass", "scikit-fem P2 x 80, 800 steps", 30.0),
    ("end_mass", "OpenSeesPy, factored once, x 160, 800 steps", 70.0),
)
NAMES = {
    "ours": "cuefem",
    "scikit_fem": "scikit-fem",
    "ngsolve_line": "NGSolve",
    "opensees": "OpenSeesPy",
    "ross_rotor": "ROSS",
    "calculix": "CalculiX",
    "sfepy_line": "sfepy",
}
# In the figure: colour and marker of the contestants whose label begins so, the first that fits
SERIES = {
    "cuefem,": ("C3", "."),
    "cuefem": ("C3", "o"),
    "LAPACK dsygvd alone": ("black", "s"),
    "scikit-fem P1": ("C0", "v"),
    "scikit-fem P2": ("C0", "s"),
    "scikit-fem Pp": ("C0", "D"),
    "NGSolve + scipy": ("C2", "P"),
    "NGSolve": ("C2", "X"),
    "OpenSeesPy,": ("C1", "d"),
    "OpenSeesPy": ("C1", "^"),
    "ROSS": ("C4", "h"),
    "CalculiX": ("C5", "*"),
    "sfepy": ("C6", "<"),
}
LEGEND = {"cuefem,": "cuefem at a Resolution", "OpenSeesPy,": "OpenSeesPy, factored once"}
NOTES = """\
A call is timed from the cone's numbers to the answer: mesh, assembly, solution; imports are not. Medians of processor
time, which is the clock's on a machine at rest, of warm calls (the first of each process stands beside); every peer has
a process of its own and one thread, and they take turns.
Modes are those of [Kim]'s shaft. End masses are of three cones (Kim's shaft, a slim one of a pool cue, the rod of a
whole snooker cue) at 24 contact times each, 0.5 to 3 ms: the error is the median of all 72, and 95 % of them are within
the next column; the time is that of one end mass, mesh and matrices included. No two calls have the same cone (they
differ by 1e-13 of its length), so nobody keeps anything of it; tables and compiled code that hold for any cone may be
kept. Errors are relative, of the worst of f3 to f5 or of the end mass, against cuefem with more elements and another
order, and for the end mass with 300 modes and a tail (median good to 2e-6). `cuefem` is the call as it is typed, which
holds f1 to f5 to 1e-9; with a Resolution, "elements x order", it may do less. Everyone computes mode shapes for the
modes, and no one for the end mass.

Not alike: LAPACK is handed cuefem's matrices; ROSS solves two planes, torsion and stretching; CalculiX is a solid,
whose distance from the beam is the model's and not the mesh's alone, and its time holds a process and its files;
OpenSeesPy factors once only where it says so. NGSolve's matrices are solved by its own Arnoldi method and, faster, by
scipy's LAPACK. ROSS, CalculiX and sfepy take no part in the end mass."""


def text(contest: Contest) -> str:
    """Tables: what was asked for, and every contestant."""
    versions = {"Python": platform.python_version(), "numpy": np.__version__, "scipy": scipy.__version__}
    versions |= {NAMES[peer]: version for peer, version in contest.versions.items()}
    lines = ["# Seconds against peers", "", f"{processor()}, one thread."]
    lines += [fill(", ".join(map(" ".join, versions.items())) + ".", 120)]
    lines += ["", *(f"{NAMES.get(peer, peer)}: {why}." for peer, why in contest.missing.items())]
    lines += [*([""] if contest.missing else []), NOTES, "", "## What was asked for", ""]
    lines += ["Times the seconds of `cuefem`, as it is typed and at its quickest within the error asked for.", ""]
    lines += ["| task | error | contestant | asked | as typed | quickest |", "|---|---|---|---|---|---|"]
    lines += [_asked(contest, *row) for row in ASKED]
    for task, title in TITLES.items():
        lines += ["", f"## {title}, {TARGETS[task]:.0e}", ""]
        lines += ["| contestant | error | 95 % | within | ms | times cuefem | first call, ms |"]
        lines += ["|---|---|---|---|---|---|---|"]
        lines += [_row(contest, c) for c in contest.contestants if c.task == task]
    return "\n".join(lines) + "\n"


def _asked(contest: Contest, task: str, label: str, least: float) -> str:
    rivals = contest.find(task, "cuefem"), contest.quickest(task, "ours")
    peer = contest.find(task, label)
    cells = [times(peer.seconds / own.seconds) if peer and own else "" for own in rivals]
    return f"| {task} | {TARGETS[task]:.0e} | {label} | at least {times(least)} | {' | '.join(cells)} |"


def times(ratio: float) -> str:
    """A ratio of seconds; two figures are what a busy machine leaves of it."""
    return f"{ratio:.0f}" if ratio > 9.9 else f"{ratio:.2g}"


def shown(error: float) -> str:
    """An error, two digits; below 1e-8 rounding speaks."""
    return "< 1e-08" if error < 1e-8 else f"{error:.1e}"


def _row(contest: Contest, c: Contestant) -> str:
    own = contest.find(c.task, "cuefem")
    ratio = times(c.seconds / own.seconds) if own else ""
    within = "yes" if c.error <= TARGETS[c.task] else ""
    high = "" if c.high is None else shown(c.high)
    return (
        f"| {c.label} | {shown(c.error)} | {high} | {within} | {1e3 * c.seconds:.2f} | {ratio} | {1e3 * c.first:.1f} |"
    )


def draw(contest: Contest, path: Path) -> None:
    """Error against seconds, both axes logarithmic, a panel a task."""
    canvas, axes = plt.subplots(1, 2, figsize=(11, 4.6), layout="constrained", sharex=True)
    for ax, (task, title) in zip(axes, TITLES.items(), strict=True):
        for name, (colour, marker) in SERIES.items():
            own = [c for c in contest.contestants if c.task == task and series(c.label) == name]
            own.sort(key=lambda c: c.error)
            at = [1e3 * c.seconds for c in own], [c.error for c in own]
            size = 10 if name == "cuefem" else 7
            ax.loglog(*at, marker, color=colour, ls="-", lw=0.8, ms=size, label=LEGEND.get(name, name))
        ax.axhline(TARGETS[task], color="black", ls=":", lw=1)
        ax.annotate("asked for", (1, TARGETS[task]), (-3, 3), ("axes fraction", "data"), "offset points", ha="right")
        ax.set(title=title, xlabel="processor milliseconds a call")
        ax.grid(alpha=0.3)
    axes[0].set_ylabel("relative error")
    canvas.legend(*axes[1].get_legend_handles_labels(), loc="outside right upper", frameon=False)
    canvas.savefig(path, dpi=100)
    plt.close(canvas)


def series(label: str) -> str:
    """The series of the figure that a contestant belongs to, "" for none."""
    return next((name for name in SERIES if label.startswith(name)), "")
