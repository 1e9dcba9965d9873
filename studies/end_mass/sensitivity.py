"""Which part of a cue makes its end mass: how much does a gram added here add?

For each cue of meshes/ and contacts of 0.7, 1 and 2 ms, the stick end mass's density of derivatives to mass
(`cuefem.design.sensitivity`): one gram at x adds so many grams of end mass. The gram moves along the axis too; its
share of that, m_a dm/dm_a, is counted in the curves and under 0.001 g. The table splits the end mass by the sum rule of
handbook: Effective end mass into the shares of mass (rho A), its turning (rho I), bending (EI) and shear (kGA)
stiffness; the rest to 100 % is the stick law's own dependence on ball and axial mass.

The sums are plain, over the modes up to 30 periods in a contact. In the first 6 mm, soft leather whose own modes lie
near that limit, the curves still depend on the number of modes kept, so they are drawn from 6 mm on. About 25 s.
"""

from __future__ import annotations

import math
from functools import cache
from typing import Any

import numpy as np

from cuefem.design.sensitivity import Sensitivity, sensitivity
from cuefem.tip_modes import default_resolution
from studies import pages
from studies.pages import table
from studies.strokes import NAMES, cue, scene

TIMES = (0.7e-3, 1e-3, 2e-3)
PLACES = (0.01, 0.025, 0.05, 0.1, 0.15, 0.2, 0.3)  # m from the tip
INCH = 0.0254
LEATHER = 0.006  # m
LABELS = {
    "kim": "Kim's cone",
    "pool_maple": "solid pro taper",
    "pool_hollow": "hollow front",
    "carbon": "carbon tube",
    "whole_cue": "whole cue, solid pro taper",
}


@cache
def found(name: str, contact_time: float) -> Sensitivity:
    struck = scene(cue(name), contact_time)
    return sensitivity(struck, at=default_resolution(struck))


def gram(name: str, contact_time: float) -> tuple[np.ndarray, np.ndarray]:
    """(x, m; grams of end mass a gram at x adds), its motion along the axis included."""
    here = found(name, contact_time)
    return here.x, here.rhoA + here.axial_mass


def rows() -> list[list[str | float]]:
    lines: list[list[str | float]] = []
    for name in NAMES:
        for contact_time in TIMES:
            here, (x, weight) = found(name, contact_time), gram(name, contact_time)
            section = cue(name).section(x)
            parts = [
                100 * math.fsum(here.weights * getattr(here, part) * getattr(section, part)) / here.end_mass
                for part in ("rhoA", "rhoI", "EI", "kGA")
            ]
            places = [f"{value:.2f}" for value in np.interp(PLACES, x, weight)]
            shares = [f"{part:.1f}" for part in parts]
            lines.append([name, f"{1e3 * contact_time:g}", f"{1e3 * here.end_mass:.3f}", *places, *shares])
    return lines


def text() -> str:
    head = ["cue", "T, ms", "end mass, g", *(f"{100 * place:g} cm" for place in PLACES)]
    head += ["mass, %", "its turning, %", "bending, %", "shear, %"]
    return (
        "# Which part of the cue makes the end mass\n\nGrams of stick end mass that one gram adds at a distance from "
        "the tip, and the"
        " shares of the end mass by the sum rule.\n\n" + table(head, rows())
    )


def draw(axes: Any) -> None:
    for axis, name in zip(axes, NAMES, strict=True):
        for contact_time, colour in zip(TIMES, ("tab:blue", "tab:green", "tab:red"), strict=True):
            x, weight = gram(name, contact_time)
            mass = 1e3 * found(name, contact_time).end_mass
            axis.plot(
                x[x > LEATHER] / INCH, weight[x > LEATHER], colour, label=f"T = {1e3 * contact_time:g} ms: {mass:.1f} g"
            )
        axis.axhline(0, color="black", lw=0.8)
        axis.set(xlim=(0, 20), ylim=(-0.25, 1.3))
        axis.set_title(f"{LABELS[name]} ({name})", fontsize=10)
        axis.legend(fontsize=8)
    axes[2].set_ylabel("grams of end mass that one gram here adds")
    axes[-1].set_xlabel("inches from the tip")


STUDY = pages.Study(__file__, text, {"sensitivity.svg": pages.Figure(draw, (5, 1), (6.6, 10.0))})


if __name__ == "__main__":
    STUDY.write()
