"""Which definition of effective end mass predicts the squirt of a vibrating shaft?

What: the five definitions (force, velocity, stick, stick at the offset, squirt-equivalent) on all cues of
meshes/ for contacts of 0.5 to 4 ms; each fed to the impulse solver at b/R 0.1, 0.3 and 0.5, against the coupled
strike; [Kim]'s 12 g (m_c; m_e = 3 g at the tip) likewise; and end mass against contact time, beside the square-root law
of a semi-infinite beam. e = 3/4, mu = 0.7, a ball of 210 g; modes kept by frequency (0.5 %).
Equations: handbook: Effective end mass; `stick_at_offset`; a semi-infinite Euler beam: m = C rhoA sqrt(T
sqrt(EI/rhoA)).
Takes about 5 s.
"""

from __future__ import annotations

from functools import cache
from typing import Any, NamedTuple

import numpy as np
from scipy.integrate import quad

from cuefem import StickLimit
from cuefem.endmass.drives import force, squirt_equivalent, stick, stick_at_offset, velocity
from cuefem.tip_modes import tip_modes_of
from studies import pages, strokes
from studies.strokes import strike_modes

TIMES = (0.5e-3, 0.7e-3, 1.0e-3, 1.4e-3, 2.0e-3, 2.8e-3, 4.0e-3)
SHOWN = (0.5e-3, 1.0e-3, 2.0e-3, 4.0e-3)
OFFSETS = (0.1, 0.3, 0.5)
KIM_END = 0.012 / 4  # kg: the paper's m_c = 12 g with nu_c = 1/3, as the tip feels it
DEFINITIONS = ("stick at the offset", "stick", "velocity", "force", "Kim's 3 g")
BEAM = {"force": 0.79021, "velocity": 0.54814}  # C of a semi-infinite Euler beam, handbook: Effective end mass
STEP = np.sqrt(2 / np.pi)  # C of a step of velocity


class Case(NamedTuple):
    """One cue, contact time and offset: end masses, kg; squirt, rad; what each mass predicts of it, minus 1."""

    name: str
    time: float
    offset: float
    masses: dict[str, float]
    equivalent: float
    squirt: float
    errors: dict[str, float]


def case(name: str, time: float, offset: float, tip: object) -> Case:
    """A case from the cue's tip modes."""
    struck = strokes.scene(strokes.cue(name), time, offset)
    drives = {"stick at the offset": stick_at_offset, "stick": stick, "velocity": velocity, "force": force}
    masses = {**{drive: mass(tip, struck) for drive, mass in drives.items()}, "Kim's 3 g": KIM_END}
    outcome = strike_modes(struck, tip)
    errors = {drive: strokes.lumped_squirt(struck, m) / outcome.squirt - 1 for drive, m in masses.items()}
    return Case(name, time, offset, masses, squirt_equivalent(tip, struck), float(outcome.squirt), errors)


@cache
def cases() -> tuple[Case, ...]:
    """All cues, times and offsets."""
    found = []
    for name in strokes.NAMES:
        for time in TIMES:
            tip = tip_modes_of(strokes.scene(strokes.cue(name), time))
            found += [case(name, time, offset, tip) for offset in OFFSETS]
    return tuple(found)


def sizes(definition: str, offset: float) -> np.ndarray:
    """Sizes of the relative errors of squirt that a definition makes at an offset, over all cues and times."""
    return np.array([abs(c.errors[definition]) for c in cases() if c.offset == offset])


def growth(name: str, definition: str) -> float:
    """Exponent of end mass in contact time, fitted over TIMES."""
    masses = [c.masses[definition] for c in cases() if c.name == name and c.offset == OFFSETS[0]]
    return pages.slope(TIMES, masses)


def stick_constant() -> float:
    """C of the stick end mass of a semi-infinite Euler beam, the ball's own inertia across left out (light end).

    A step of velocity takes an impulse growing like sqrt(t), so K P - 1 takes sqrt(T) (K I - 1), I the integral of
    sqrt(1 - x) dP(x), and the end mass is that over K - 1.
    """
    limit = StickLimit.of(strokes.scene(strokes.cue("kim")))
    e, peak = limit.e, 1 / (1 + limit.e)
    a = np.pi / 2 / peak

    def weighted(x: float) -> float:  # P' is sin while loading, cos slower by e after it
        rate = np.sin(a * x) if x < peak else np.cos((x - peak) * a / e)
        return np.sqrt(1 - x) * rate * a / (1 + e)

    share = sum(quad(weighted, *span)[0] for span in ((0, peak), (peak, 1)))
    return float(STEP * (limit.K * share - 1) / (limit.K - 1))


def beam_end_mass(name: str, time: float, constant: float, position: float = 0.0) -> float:
    """The square-root law with the cue's section at ``position``, kg."""
    section = strokes.cue(name).section(position)
    return float(constant * section.rhoA * np.sqrt(time * np.sqrt(section.EI / section.rhoA)))


def summary_table() -> str:
    """How wrong each definition is."""
    columns = ["definition", *(f"b/R {b:g}, {which}" for b in OFFSETS for which in ("median", "worst"))]
    rows = []
    for definition in DEFINITIONS:
        found = [sizes(definition, b) for b in OFFSETS]
        rows.append([definition, *(f"{100 * f(x):.1f} %" for x in found for f in (np.median, np.max))])
    return pages.table(columns, rows)


def mass_table() -> str:
    """End masses in grams."""
    columns = ["cue", "T, ms", "stick", "velocity", "force"]
    columns += [f"{name}, b/R {b:g}" for b in OFFSETS for name in ("squirt", "stick at the offset")]
    rows = []
    for name in strokes.NAMES:
        for time in SHOWN:
            three = [c for c in cases() if (c.name, c.time) == (name, time)]
            there = [x for c in three for x in (c.equivalent, c.masses["stick at the offset"])]
            grams = [1e3 * m for m in (*(three[0].masses[d] for d in ("stick", "velocity", "force")), *there)]
            rows.append([name, f"{1e3 * time:g}", *grams])
    return pages.table(columns, rows, 3)


def error_table() -> str:
    """What each definition makes of the coupled squirt, per cent, at b/R 0.3."""
    rows = [
        [c.name, f"{1e3 * c.time:g}", np.degrees(c.squirt), *(f"{100 * c.errors[d]:.1f}" for d in DEFINITIONS)]
        for c in cases()
        if c.offset == 0.3 and c.time in SHOWN
    ]
    return pages.table(["cue", "T, ms", "squirt, deg", *DEFINITIONS], rows, 4)


def growth_table() -> str:
    """Exponents of end mass in contact time, and Kim's against the square-root law."""
    names = ("stick", "velocity", "force")
    rows = [[name, *(f"{growth(name, d):.2f}" for d in names)] for name in strokes.NAMES]
    constants = {"stick": stick_constant(), **BEAM}
    rows.append(["C of a semi-infinite beam", *(f"{constants[d]:.3f}" for d in names)])
    kim = next(c for c in cases() if (c.name, c.time) == ("kim", 1e-3))
    ratios = [kim.masses[d] / beam_end_mass("kim", 1e-3, constants[d]) for d in names]
    rows.append(["Kim's shaft at 1 ms over the law, section at the tip", *(f"{ratio:.2f}" for ratio in ratios)])
    return pages.table(["cue", *names], rows)


def conclusions() -> list[str]:
    """What the numbers say."""
    own, small = ([100 * f(sizes(d, b)) for b in OFFSETS for f in (np.median, np.max)] for d in DEFINITIONS[:2])
    low, high = (1e3 * f([c.equivalent for c in cases() if c.offset == 0.3]) for f in (min, max))
    over = [c.masses[d] / c.equivalent for d in ("velocity", "force") for c in cases() if c.offset == 0.3]
    half = len(over) // 2
    paper, powers = np.median(sizes(DEFINITIONS[-1], 0.3)), [growth(name, "stick") for name in strokes.NAMES]
    return [
        "Of the definitions force, velocity and stick, stick predicts the coupled squirt best: at b/R 0.1 it is "
        f"{small[0]:.1f} % off in the median (worst {small[1]:.1f} %). It is the limit of small offsets, so it is "
        f"{small[2]:.0f} % off (worst {small[3]:.0f} %) at 0.3 and {small[4]:.0f} % (worst {small[5]:.0f} %) at 0.5. "
        f"Stick taken at the offset itself is {own[2]:.1f} % off (worst {own[3]:.1f} %) at 0.3 and {own[4]:.1f} % "
        f"(worst {own[5]:.0f} %) at 0.5.",
        f"At b/R 0.3 the squirt-equivalent end mass is {low:.1f} to {high:.1f} g. The definition velocity gives "
        f"{min(over[:half]):.2f} to {max(over[:half]):.2f} times as much, force {min(over[half:]):.2f} to "
        f"{max(over[half:]):.2f} times.",
        "[Kim]'s cue end of 12 g is an end mass of 3 g at the tip. At b/R 0.3 the squirt that it gives is off by "
        f"{100 * paper:.0f} % in the median, and it does not depend on the contact time, while the stick end mass "
        f"grows like T^{min(powers):.2f} to T^{max(powers):.2f}.",
    ]


def report() -> str:
    """The committed table."""
    parts = ["# Effective end mass: which definition predicts squirt", *conclusions()]
    parts += [
        "## How wrong the squirt is",
        "Size of the relative error over all cues and contact times of 0.5 to 4 ms.",
        summary_table(),
    ]
    parts += ["## End mass, g", mass_table(), "## Squirt predicted at b/R 0.3, per cent off", error_table()]
    parts += ["## Growth with the contact time, exponent from 0.5 to 4 ms", growth_table()]
    return pages.paragraphs(*parts)


def draw_growth(axes: object) -> None:
    """Stick end mass against contact time, and the square-root law."""
    fine = np.geomspace(TIMES[0], TIMES[-1], 40)
    for i, name in enumerate(strokes.NAMES):
        struck = [strokes.scene(strokes.cue(name), T) for T in fine]
        tip = tip_modes_of(struck[0])
        axes.plot(1e3 * fine, [1e3 * stick(tip, s) for s in struck], color=f"C{i}", label=name)
    law = [1e3 * beam_end_mass("kim", T, stick_constant()) for T in fine]
    axes.plot(1e3 * fine, law, "k--", lw=1, label="√T law, Kim's tip section")
    axes.axhline(3, color="0.5", lw=0.9)
    axes.text(0.51, 2.75, "the paper's 12 g", fontsize=8, color="0.3", va="top")
    axes.set(xscale="log", yscale="log", xlabel="contact time T, ms", ylabel="stick end mass, g")
    axes.set_xticks([0.5, 1, 2, 4], ["0.5", "1", "2", "4"])
    axes.set_yticks([2, 3, 5, 10, 20], ["2", "3", "5", "10", "20"])
    axes.minorticks_off()
    axes.legend(fontsize=8)


def draw_errors(axes: object) -> None:
    """Squirt predicted over coupled, the range over all cues, at b/R 0.3."""
    for i, definition in enumerate(DEFINITIONS):
        rows = [[c.errors[definition] + 1 for c in cases() if (c.time, c.offset) == (T, 0.3)] for T in TIMES]
        times = 1e3 * np.array(TIMES)
        axes.fill_between(times, [min(r) for r in rows], [max(r) for r in rows], color=f"C{i}", alpha=0.25, lw=0)
        axes.plot(times, [np.median(r) for r in rows], color=f"C{i}", label=definition)
    axes.axhline(1, color="k", lw=0.8)
    axes.set(xscale="log", xlabel="contact time T, ms", ylabel="squirt of the lumped cue over the coupled", ylim=(0, 3))
    axes.set_xticks([0.5, 1, 2, 4], ["0.5", "1", "2", "4"])
    axes.minorticks_off()
    axes.legend(fontsize=8, loc="upper left")


def draw(panels: Any) -> None:
    """Growth, and what each definition predicts."""
    left, right = panels
    draw_growth(left)
    draw_errors(right)
    left.set(title="End mass against contact time")
    right.set(title="b/R 0.3: median and range over five cues")


STUDY = pages.Study(__file__, report, {"end_mass.svg": pages.Figure(draw, (1, 2), (10, 4.2))}, drawn=True)


if __name__ == "__main__":
    STUDY.write()
