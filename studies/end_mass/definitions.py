"""Which definition of effective end mass predicts the squirt of a vibrating shaft?

The definitions of `cuefem.end_mass` on the cues of meshes/ for contacts of 0.5 to 4 ms, each fed to the impulse solver
at b/R 0.1, 0.3 and 0.5, against the coupled strike; Kim's 12 g (3 g at the tip) likewise. e = 3/4, mu = 0.7, a ball of
210 g, no effects. Equations: handbook: Effective end mass; of a semi-infinite Euler beam m = C rhoA sqrt(T
sqrt(EI/rhoA)).
"""

from __future__ import annotations

from functools import cache
from typing import Any

import numpy as np

import cuefem as cf
from studies import pages, strokes
from studies.pages import table

TIMES, OFFSETS = (0.5e-3, 1.0e-3, 2.0e-3, 4.0e-3), (0.1, 0.3, 0.5)
DRIVES = {"stick at the offset": "offset", "stick": "stick", "velocity": "velocity", "force": "force"}
DEFINITIONS = (*DRIVES, "Kim's 3 g")


@cache
def mass(definition: str, name: str, time: float, offset: float) -> float:
    """An end mass, kg; of Kim's 12 g with nu_c = 1/3 a quarter acts at the tip."""
    if definition not in DRIVES:
        return 0.003
    at = offset if definition == "stick at the offset" else 0.0
    return float(cf.end_mass(strokes.scene(strokes.cue(name), time, at), DRIVES[definition]))


@cache
def squirt(name: str, time: float, offset: float) -> float:
    """Squirt of the coupled strike, rad."""
    return float(cf.strike(strokes.scene(strokes.cue(name), time, offset)).squirt)


@cache
def errors(definition: str, offset: float) -> np.ndarray:
    """Relative errors of squirt that a definition makes, over all cues and times."""
    ratios = []
    for name in strokes.NAMES:
        for time in TIMES:
            lumped = strokes.lumped_squirt(
                strokes.scene(strokes.cue(name), time, offset), mass(definition, name, time, offset)
            )
            ratios.append(lumped / squirt(name, time, offset) - 1)
    return np.array(ratios)


def error_table() -> str:
    """How wrong the squirt of each definition is."""
    columns = ["definition", *(f"b/R {b:g}, {which}" for b in OFFSETS for which in ("median", "worst"))]
    rows = []
    for definition in DEFINITIONS:
        sizes = [100 * np.abs(errors(definition, b)) for b in OFFSETS]
        rows.append([definition, *(f"{f(x):.1f} %" for x in sizes for f in (np.median, np.max))])
    return table(columns, rows)


def mass_table() -> str:
    """End masses, g."""
    rows = []
    for name in strokes.NAMES:
        for time in TIMES:
            grams = [1e3 * mass(d, name, time, 0.3) for d in ("stick", "velocity", "force", "stick at the offset")]
            equal = 1e3 * float(cf.end_mass(strokes.scene(strokes.cue(name), time, 0.3), "squirt"))
            rows.append([name, f"{1e3 * time:g}", *grams, equal])
    return table(["cue", "T, ms", *list(DRIVES)[1:], "stick at b/R 0.3", "squirt-equivalent at b/R 0.3"], rows, 2)


def growth_table() -> str:
    """Exponents of end mass in contact time."""
    rows = []
    for name in strokes.NAMES:
        powers = (pages.slope(TIMES, [mass(d, name, T, 0.0) for T in TIMES]) for d in list(DRIVES)[1:])
        rows.append([name, *(f"{power:.2f}" for power in powers)])
    return table(["cue", *list(DRIVES)[1:]], [*rows, ["semi-infinite beam", "0.50", "0.50", "0.50"]])


def text() -> str:
    offset, stick, kim = (
        [100 * float(np.median(np.abs(errors(d, b)))) for b in OFFSETS]
        for d in ("stick at the offset", "stick", "Kim's 3 g")
    )
    return pages.page(
        "End mass: which definition predicts squirt",
        "Which definition of effective end mass gives a lumped cue the squirt of the vibrating shaft?",
        f"Stick, computed at the offset: median errors of {offset[0]:.1f}, {offset[1]:.1f} and {offset[2]:.0f} % at "
        f"b/R 0.1, 0.3 and 0.5 (20 strokes). Stick in the limit of small offsets has {stick[0]:.0f}, {stick[1]:.0f} "
        f"and {stick[2]:.0f} %, the paper's 12 g {kim[1]:.0f} % at b/R 0.3, because it does not grow with the contact "
        "time.",
        "## Error of squirt",
        error_table(),
        "## End mass, g",
        mass_table(),
        "## Exponent of the contact time, 0.5 to 4 ms",
        growth_table(),
    )


def draw(axes: Any) -> None:
    """Stick end mass against contact time."""
    fine = np.geomspace(TIMES[0], TIMES[-1], 24)
    for i, name in enumerate(strokes.NAMES):
        axes.loglog(1e3 * fine, [1e3 * mass("stick", name, float(T), 0.0) for T in fine], f"C{i}", label=name)
    axes.axhline(3, color="0.5", lw=0.9, label="3 g: end mass of Kim's 12 g cue end")
    axes.set(xlabel="contact time, ms", ylabel="stick end mass, g")
    axes.set_xticks([0.5, 1, 2, 4], ["0.5", "1", "2", "4"])
    axes.set_yticks([2, 3, 5, 10], ["2", "3", "5", "10"])
    axes.minorticks_off()
    axes.legend(fontsize=8)


EXAMPLE = """\
from math import degrees
import cuefem as cf

scene = cf.load_scene("studies/scenes/kim.toml")
for definition in ("stick", "offset", "velocity", "force"):
    print(f"{definition:9}{1e3 * cf.end_mass(scene, definition):.2f} g")
print(f"squirt by the end mass at the offset: {degrees(cf.impulse(scene).squirt):.2f} degrees")
print(f"squirt of the vibrating shaft: {degrees(cf.strike(scene).squirt):.2f} degrees")
"""
STUDY = pages.Study(__file__, text, {"definitions.svg": pages.Figure(draw)}, example=EXAMPLE)

if __name__ == "__main__":
    STUDY.write()
