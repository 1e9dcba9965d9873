"""Which part of a cue determines its end mass: the effect of a point mass by its position.

For each cue of meshes/ and contact times of 0.7, 1 and 2 ms the stick end mass with a small point mass on the shaft,
less that without it, over the mass. Equations: handbook: Effective end mass.
"""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from typing import Any

import numpy as np

import cuefem as cf
from studies import pages
from studies.pages import table
from studies.strokes import INCH, NAMES, cue, scene

TIMES, POSITIONS, SMALL = (0.7e-3, 1e-3, 2e-3), (0.01, 0.025, 0.05, 0.1, 0.15, 0.2, 0.3), 1e-4  # s, m from the tip, kg


@cache
def end_mass(name: str, time: float, position: float | None = None) -> float:
    """Stick end mass, kg, with `SMALL` at a position, or without it."""
    lump = () if position is None else (cf.PointMass(position=position, mass=SMALL),)
    return float(cf.end_mass(replace(scene(cue(name), time), effects=lump)))


def added(name: str, time: float, position: float) -> float:
    """Grams of end mass that one gram at a position adds."""
    return (end_mass(name, time, position) - end_mass(name, time)) / SMALL


def text() -> str:
    rows = [
        [name, f"{1e3 * T:g}", 1e3 * end_mass(name, T), *(f"{added(name, T, x) + 0.0:.2f}" for x in POSITIONS)]
        for name in NAMES
        for T in TIMES
    ]
    front, back = ([added(name, 1e-3, x) for name in NAMES] for x in (0.025, 0.1))
    return pages.page(
        "End-mass distribution along the shaft",
        "Which part of a cue determines its end mass?",
        f"The first 10 cm. At 1 ms a point mass of 1 g at 2.5 cm from the tip adds {pages.span(front, 1)} g to the "
        f"stick end mass, at 10 cm {pages.span(back, 1)} g; at larger distances it may reduce it. At 2 ms a longer "
        "part counts.",
        "Increase of the stick end mass, g, by a point mass of 1 g, against its distance from the tip:",
        table(["cue", "T, ms", "end mass, g", *(f"{100 * position:g} cm" for position in POSITIONS)], rows),
    )


def draw(axes: Any) -> None:
    """Increase of the end mass by 1 g, along three cues, at 1 ms."""
    positions = np.linspace(0.006, 0.4, 50)
    for name in ("kim", "pool_maple", "carbon"):
        axes.plot(positions / INCH, [added(name, 1e-3, float(x)) for x in positions], label=name)
    axes.axhline(0, color="black", lw=0.8)
    axes.set(xlabel="inches from the tip", ylabel="grams of end mass that one gram adds, T = 1 ms")
    axes.legend(fontsize=8)


EXAMPLE = """\
from dataclasses import replace
import cuefem as cf

scene = cf.Scene(cf.load("meshes/pool_maple.toml"), tip=cf.Tip(contact_time=1e-3))
for position in (0.01, 0.025, 0.1, 0.2):
    heavier = replace(scene, effects=(cf.PointMass(position=position, mass=1e-3),))
    print(f"1 g at {100 * position:.1f} cm adds {1e3 * (cf.end_mass(heavier) - cf.end_mass(scene)):+.2f} g")
"""
STUDY = pages.Study(__file__, text, {"distribution.svg": pages.Figure(draw)}, example=EXAMPLE)

if __name__ == "__main__":
    STUDY.write()
