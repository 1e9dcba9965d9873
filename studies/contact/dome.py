"""How much squirt does the round end of the tip make?

What: squirt against the radius of the tip's dome, 0 to 12 mm, for all cues of meshes/ and for pool_maple with a wooden
tip; the limit b -> 0, b/R 0.3 and 0.5; the lumped end mass with that squirt; and the contact time. T = 1 ms except
where stated, e = 3/4, mu = 0.7, a ball of 210 g; default resolution (0.5 %).
Equations: handbook: Effects. The contact lies r sin(phi) off the cue's axis, on the side of the ball's centre. The
ball's push along the cue is there a couple F r sin(phi) on the tip's section, which bends the shaft towards that side;
the turning ball carries the tip to the other. The end of a semi-infinite Euler beam moves across at the velocity
couple/sqrt(EI rhoA), at every moment (w = -i C/(EI k^2), k^2 = omega sqrt(rhoA/EI)), so to first order in r, before a
heavy ball, the dome raises the end mass by the part

    (1 + e) m_n r/(T sqrt(EI rhoA)) * int P'(x)/sqrt(1 - x) dx / int (K P - 1)/sqrt(1 - x) dx

x = t/T, P the normal impulse so far over its total. The end mass itself grows like sqrt(T), this part like 1/T.

Last squirt at b/R 0.3 and 2 m/s of three shafts in the whole stroke against the dome of LeatherTip (6 mm high, nu 0.4,
E 140 MPa), 7 mm to flat, beside the patchwork of dome and shear that is told the contact time that LeatherTip has head
on; and leather of other moduli. Takes about 60 s.
"""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from typing import Any, NamedTuple

import numpy as np
from scipy.integrate import quad

import cuefem as cf
from cuefem import Cue, Resolution, StickLimit, TipDome
from cuefem.beam.tip import TipModes
from cuefem.endmass.drives import equivalent_end_mass, small_offset_slope, stick
from cuefem.tip_modes import tip_modes_of
from studies import pages, strokes
from studies.measured import pool
from studies.strokes import strike_modes

RADII = (0.0, 3e-3, 6e-3, 9e-3, 12e-3)
USUAL = 9e-3  # a dime's 8.95 mm
OFFSETS = (0.3, 0.5)
MODES = (60, 120, 240)
TIMES = (0.5e-3, 0.7e-3, 1.0e-3, 1.4e-3, 2.0e-3, 2.8e-3)
WOODEN = "pool_maple, wooden tip"
NAMES = ("kim", "pool_maple", WOODEN, "pool_hollow", "carbon", "whole_cue")
MEASURED = (5.8e-3, 14e-3)  # kg: end masses measured on real cues, handbook: Effective end mass


class Case(NamedTuple):
    """A cue and dome: squirt over phi as b -> 0, end mass with that squirt, kg; at OFFSETS squirt, rad, and such."""

    name: str
    radius: float
    time: float
    slope: float
    end_mass: float
    squirts: tuple[float, ...]
    equivalents: tuple[float, ...]


def cue(name: str) -> Cue:
    """A cue by its name in NAMES."""
    return pool.wooden_tip(strokes.cue("pool_maple")) if name == WOODEN else strokes.cue(name)


@cache
def tip(name: str, time: float) -> TipModes:
    """The cue's tip modes."""
    return tip_modes_of(strokes.scene(cue(name), time))


def _equivalent(outcome: cf.Outcome, scene: cf.Scene) -> float:
    """The lumped end mass with that squirt, kg; nan if no end mass has it (a light cue that runs ahead of the ball)."""
    try:
        return equivalent_end_mass(outcome, scene)
    except ValueError:
        return float("nan")


@cache
def case(name: str, radius: float, time: float = 1e-3) -> Case:
    """One cue, dome and contact time."""
    effects = (TipDome(radius),) if radius else ()
    struck, modes = replace(strokes.scene(cue(name), time), effects=effects), tip(name, time)
    there = [strokes.at_offset(struck, b) for b in OFFSETS]
    outcomes = [strike_modes(s, modes) for s in there]
    equivalents = tuple(_equivalent(o, s) for o, s in zip(outcomes, there, strict=True))
    squirts = tuple(float(o.squirt) for o in outcomes)
    limit = small_offset_slope(modes, struck)
    return Case(name, radius, time, limit, stick(modes, struck), squirts, equivalents)


def gain(name: str, radius: float = USUAL, time: float = 1e-3) -> float:
    """Part by which a dome raises small-offset squirt."""
    return case(name, radius, time).slope / case(name, 0.0, time).slope - 1


def beam_gain(EI: float, rhoA: float, limit: StickLimit) -> float:
    """Part by which a dome of 1 m raises the end mass of a semi-infinite Euler beam before a heavy ball, 1/m."""
    e, peak = limit.e, 1 / (1 + limit.e)
    a = np.pi / 2 / peak

    def rate(x: float) -> float:  # P': sin while loading, cos slower by e after it
        return float((np.sin(a * x) if x < peak else np.cos((x - peak) * a / e)) * a / (1 + e))

    spans = ((0.0, peak), (peak, 1.0))
    couple = sum(quad(lambda x: rate(x) / np.sqrt(1 - x), *span)[0] for span in spans)
    passed = sum(quad(lambda x: rate(x) * np.sqrt(1 - x), *span)[0] for span in spans)
    push = (1 + e) * limit.head_on_mass / limit.T / np.sqrt(EI * rhoA)
    return float(push * couple / (2 * (limit.K * passed - 1)))


def estimate(name: str, radius: float = USUAL, time: float = 1e-3) -> float:
    """`beam_gain` with the section of the cue behind its tip and ferrule (Kim's: at the tip)."""
    struck = cue(name)
    section = struck.section(0.0 if name == "kim" else sum(s.length for s in struck.segments[:2]) + 1e-6)
    return radius * beam_gain(float(section.EI), float(section.rhoA), StickLimit.of(strokes.scene(struck, time)))


def growth(name: str, radius: float) -> float:
    """Exponent of end mass in contact time over TIMES."""
    return float(pages.slope(TIMES, [case(name, radius, T).end_mass for T in TIMES]))


def radius_table() -> str:
    """Squirt against radius."""
    columns = ["cue", "r, mm", "psi/phi, b -> 0", "end mass, g", "over bare"]
    for b in OFFSETS:
        columns += [f"squirt at {b:g}, deg", "over bare", "end mass, g"]
    rows = []
    for name in NAMES:
        bare = case(name, 0.0)
        for r in RADII:
            c = case(name, r)
            row: list[Any] = [name, f"{1e3 * r:g}", c.slope, 1e3 * c.end_mass, f"{c.slope / bare.slope:.3f}"]
            for i in range(len(OFFSETS)):
                over = c.squirts[i] / bare.squirts[i]
                row += [np.degrees(c.squirts[i]), f"{over:.3f}", 1e3 * c.equivalents[i]]
            rows.append(row)
    return pages.table(columns, rows, 4)


def time_table() -> str:
    """End mass against contact time, bare and domed."""
    columns = ["cue", "r, mm", *(f"{1e3 * T:g} ms" for T in TIMES), "exponent"]
    rows = [
        [name, f"{1e3 * r:g}", *(1e3 * case(name, r, T).end_mass for T in TIMES), f"{growth(name, r):.2f}"]
        for name in NAMES
        for r in (0.0, USUAL, 12e-3)
    ]
    return pages.table(columns, rows, 3)


def estimate_table() -> str:
    """The gain in end mass at USUAL beside the semi-infinite beam's."""
    rows = []
    for name in NAMES:
        found = case(name, USUAL).end_mass / case(name, 0.0).end_mass - 1
        rows.append([name, f"{100 * found:.0f} %", f"{100 * estimate(name):.0f} %"])
    return pages.table(["cue", f"end mass gained with {1e3 * USUAL:g} mm", "semi-infinite beam"], rows)


@cache
def with_modes(name: str, modes: int, *, sheared: bool) -> float:
    """Squirt, deg, at OFFSETS[0] with USUAL and a number of modes kept; modes 0: the default resolution."""
    effects = (TipDome(USUAL), pool.SHEAR) if sheared else (TipDome(USUAL),)
    struck = replace(strokes.scene(cue(name), 1e-3, OFFSETS[0]), effects=effects)
    kept = tip_modes_of(struck, Resolution(12, 12, modes)) if modes else tip(name, 1e-3)
    return float(np.degrees(strike_modes(struck, kept).squirt))


def shortfall(name: str, *, sheared: bool) -> float:
    """Squirt at the default resolution over that of the most modes, minus 1."""
    return with_modes(name, 0, sheared=sheared) / with_modes(name, MODES[-1], sheared=sheared) - 1


def modes_table() -> str:
    """Squirt against the modes kept."""
    rows = [
        [name, "yes" if sheared else "no", *(f"{with_modes(name, m, sheared=sheared):.3f}" for m in (0, *MODES))]
        for name in NAMES[:-1]
        for sheared in (False, True)
    ]
    return pages.table(["cue", "shear 0.75", "default", *(f"{m} modes" for m in MODES)], rows)


def span(radius: float) -> tuple[float, float]:
    """Smallest and largest small-offset end mass over NAMES, g."""
    masses = [1e3 * case(name, radius).end_mass for name in NAMES]
    return min(masses), max(masses)


def conclusions() -> list[str]:
    """What the numbers say."""
    kim = {r: case("kim", r) for r in RADII}
    gains = {name: 100 * gain(name) for name in NAMES}
    larger = [100 * (case(n, USUAL).squirts[i] / case(n, 0.0).squirts[i] - 1) for i in (0, 1) for n in NAMES]
    low, high = span(0.0)
    low_dome, high_dome = span(USUAL)
    far = [1e3 * c.equivalents[0] for c in (case(n, USUAL) for n in NAMES)]
    inside = sum(case(n, USUAL).end_mass >= MEASURED[0] for n in NAMES)
    return [
        f"On Kim's shaft psi/phi at small offsets is {kim[0.0].slope:.4f} bare, {kim[6e-3].slope:.4f} with a dome of "
        f"6 mm and {kim[9e-3].slope:.4f} with 9 mm; squirt grows linearly with the radius. The end mass that has this "
        f"squirt grows from {1e3 * kim[0.0].end_mass:.2f} g to {1e3 * kim[9e-3].end_mass:.2f} g at 9 mm.",
        f"A dome of 9 mm raises the squirt at small offsets by {min(gains.values()):.0f} % "
        f"({min(gains, key=gains.get)}) to {max(gains.values()):.0f} % ({max(gains, key=gains.get)}), and the squirt "
        f"at b/R 0.3 and 0.5 by {min(larger):.0f} to {max(larger):.0f} %. A slender leather segment takes up much of "
        f"the couple: on pool_maple the gain is {gains['pool_maple']:.0f} % with leather and {gains[WOODEN]:.0f} % "
        "with wood in its place.",
        f"Measured end masses are {1e3 * MEASURED[0]:g} to {1e3 * MEASURED[1]:g} g. Bare, these cues have {low:.1f} "
        f"to {high:.1f} g; with a dome of 9 mm they have {low_dome:.1f} to {high_dome:.1f} g, and {inside} of "
        f"{len(NAMES)} lie in the measured range. The squirt-equivalent end mass at b/R 0.3 is {min(far):.1f} to "
        f"{max(far):.1f} g. The dome thus leads into the lower half of the measured range, but not up to 14 g.",
        "Why squirt grows: the force along the cue acts on the side of the tip that faces the ball's centre, and "
        "bends the tip to that side. The turning ball carries the tip to the other side, so it must push harder "
        "across the cue, and is itself pushed farther off its line. In the model of a semi-infinite beam the end "
        f"mass grows by {100 * estimate('kim'):.0f} % for Kim's tip section and 9 mm; on the shaft it grows by "
        f"{100 * (kim[9e-3].end_mass / kim[0.0].end_mass - 1):.0f} %.",
        "Why squirt with a dome hardly depends on the contact time: the share of the beam grows like sqrt(T), and "
        "the share of the dome falls like 1/sqrt(T). From 0.5 to 2.8 ms the end mass grows like "
        f"T^{growth('kim', 0.0):.2f} for Kim's bare shaft and like T^{growth('kim', USUAL):.2f} with a dome of 9 mm.",
        "A dome on a slender leather needs many modes, because its couple turns the light end of the leather. The "
        f"default resolution differs from {MODES[-1]} modes by {100 * shortfall('pool_maple', sheared=False):+.1f} % "
        f"for pool_maple, by {100 * shortfall('pool_maple', sheared=True):+.1f} % with shear too "
        f"({100 * shortfall('carbon', sheared=True):+.1f} % for carbon), and still more modes go on adding. With a "
        f"wooden tip the differences are {100 * shortfall(WOODEN, sheared=False):+.2f} and "
        f"{100 * shortfall(WOODEN, sheared=True):+.2f} %. A beam is also a poor model of a stub half as long as it is "
        "wide.",
    ]


def report() -> str:
    """The committed table."""
    parts = ["# Squirt and the dome of the tip", strokes.CAROM, *conclusions()]
    parts += ["## Against the radius, T = 1 ms", radius_table()]
    parts += ["## End mass of b -> 0 against the contact time, g", time_table()]
    parts += ["## Size of the effect", estimate_table()]
    parts += ["## Modes kept: squirt at b/R 0.3 with 9 mm, degrees", modes_table()]
    return pages.paragraphs(*parts)


def draw(panels: Any) -> None:
    """Against the radius, against the contact time, and LeatherTip."""
    left, right, third = panels
    for i, name in enumerate(NAMES):
        slopes = [case(name, r).slope for r in RADII]
        style = "--" if name in (WOODEN, "whole_cue") else "-"
        left.plot(1e3 * np.array(RADII), slopes, style, color=f"C{i}", label=name)
    for i, name in enumerate(("kim", "pool_maple", WOODEN)):
        for r, style in ((0.0, ":"), (USUAL, "-")):
            masses = [1e3 * case(name, r, T).end_mass for T in TIMES]
            label = f"{name}, {'9 mm' if r else 'flat'}"
            right.plot(1e3 * np.array(TIMES), masses, style, color=f"C{i}", label=label)
    left.axvspan(8.95, 10.6, color="0.5", alpha=0.2, lw=0)
    left.text(9.75, 0.003, "dime to\nnickel", ha="center", fontsize=8)
    left.set(xlabel="radius of the dome, mm", ylabel="squirt over φ, b → 0", ylim=(0, None), title="T = 1 ms")
    left.legend(fontsize=8)
    right.set(xlabel="contact time T, ms", ylabel="end mass that has the squirt, b → 0, g", ylim=(0, None))
    right.set(title="A dome takes out the contact time")
    right.legend(fontsize=8)
    leather_draw(third)


LEATHERED, DOMES = ("pool_maple", "pool_hollow", "carbon"), (7e-3, 9.5e-3, 12e-3, 15e-3, np.inf)
HARDNESSES = (40e6, 100e6, 140e6, 400e6)  # Pa; a flat tip of the softest is pressed further than its law is known
THERE = 0.3
# What LeatherTip alone should say, from leather_tip.md of then, written down before it was run here. Not to be changed.
PREDICTED = {
    "pool_maple, b/R 0.3, dome 7 mm over 9.5 mm": "0.89",
    "pool_maple, b/R 0.3, dome 12 mm over 9.5 mm": "1.08",
    "pool_maple, b/R 0.3, flat over 9.5 mm": "1.25",
    "pool_hollow, b/R 0.3, flat over 9.5 mm": "1.35",
    "pool_maple, dome 9.5 mm, E 400 over 40 MPa": "1.01",
    "pool_maple, flat, E 400 over 40 MPa": "1.15",
}


@cache
def leather(name: str, radius: float, E: float = pool.LEATHER.E) -> float:
    """Squirt, deg, at THERE and 2 m/s of the whole stroke, its dome of a radius, m; inf: flat."""
    return float(np.degrees(cf.strike(_with_leather(name, radius, E)).squirt))


@cache
def _with_leather(name: str, radius: float, E: float) -> cf.Scene:
    tip = replace(pool.LEATHER, dome_radius=radius, E=E)
    shaft = pool.without_leather(strokes.cue(name))
    return cf.Scene(shaft, stroke=cf.Stroke(pool.SPEED, THERE), effects=(tip,))


@cache
def patchwork(name: str, radius: float, E: float = pool.LEATHER.E) -> float:
    """Squirt, deg, of dome and shear with the contact time that LeatherTip has head on; flat: no dome."""
    time = float(_with_leather(name, radius, E).contact_time)
    effects = (TipDome(radius), pool.SHEAR) if np.isfinite(radius) else (pool.SHEAR,)
    return float(np.degrees(cf.strike(replace(strokes.scene(strokes.cue(name), time, THERE), effects=effects)).squirt))


def _radius(radius: float) -> str:
    return f"{1e3 * radius:g} mm" if np.isfinite(radius) else "flat"


def leather_radius_table() -> str:
    """Squirt of the patchwork and of the whole stroke against the radius."""
    rows = [
        [name, model.__name__.replace("leather", pool.MODERN), *(f"{model(name, r):.2f}" for r in DOMES)]
        for name in LEATHERED
        for model in (patchwork, leather)
    ]
    return pages.table(["cue", "tip", *map(_radius, DOMES)], rows)


def hardness_table() -> str:
    """Squirt against the leather's modulus, round and flat."""
    rows = [
        [name, _radius(radius), *_by_hardness(name, radius), f"{hard(name, radius):.2f}"]
        for name in LEATHERED
        for radius in (pool.LEATHER.dome_radius, np.inf)
    ]
    return pages.table(["cue", "dome", *(f"{E / 1e6:g} MPa" for E in HARDNESSES), "hardest over softest"], rows)


def _by_hardness(name: str, radius: float) -> list[str]:
    squirts = [f"{leather(name, radius, E):.2f}" for E in _hardnesses(radius)]
    return ["too soft"] * (len(HARDNESSES) - len(squirts)) + squirts


def _hardnesses(radius: float) -> tuple[float, ...]:
    return HARDNESSES if np.isfinite(radius) else HARDNESSES[1:]


def hard(name: str, radius: float) -> float:
    """Squirt with the hardest leather over that with the softest."""
    moduli = _hardnesses(radius)
    return leather(name, radius, moduli[-1]) / leather(name, radius, moduli[0])


def leather_found() -> dict[str, str]:
    """What was found, by the names of PREDICTED."""
    usual = pool.LEATHER.dome_radius
    over = [leather("pool_maple", r) / leather("pool_maple", usual) for r in (7e-3, 12e-3, np.inf)]
    over.append(leather("pool_hollow", np.inf) / leather("pool_hollow", usual))
    numbers = (*over, hard("pool_maple", usual), hard("pool_maple", np.inf))
    said = {name: f"{value:.2f}" for name, value in zip(PREDICTED, numbers, strict=True)}
    last = list(PREDICTED)[-1]
    return {**said, last: f"{said[last]} from 100 MPa"}


def leather_conclusions() -> str:
    """What LeatherTip says of the dome."""
    flat = [leather(n, np.inf) / leather(n, pool.LEATHER.dome_radius) - 1 for n in LEATHERED]
    apart = [leather(n, r) / patchwork(n, r) - 1 for n in LEATHERED for r in DOMES[:-1]]
    return (
        f"The whole stroke is LeatherTip with waves along the cue and thrust on the bent shaft. In it a rounder tip "
        f"squirts less, too. A flat tip, which the ball meets on its rim, squirts "
        f"{100 * min(flat):.0f} to {100 * max(flat):.0f} % more than one with a dome of 9.5 mm. The patchwork cannot "
        "say that: without its dome the force acts on the axis. With a dome the two differ by "
        f"{100 * min(apart):+.0f} to {100 * max(apart):+.0f} %. How little squirt depends on the hardness of the "
        "tip is a matter of the dome: with 9.5 mm it changes by a factor of "
        f"{', '.join(f'{hard(n, 9.5e-3):.2f} ({n})' for n in LEATHERED)} from 40 to 400 MPa, with a flat tip by "
        f"{', '.join(f'{hard(n, np.inf):.2f}' for n in LEATHERED)} from 100 to 400 MPa."
    )


def leather_report() -> str:
    """The end of the page: LeatherTip."""
    parts = [
        f"## LeatherTip beside the patchwork: squirt at b/R 0.3 and {pool.SPEED:g} m/s, degrees",
        leather_conclusions(),
    ]
    parts += [leather_radius_table(), "## LeatherTip: squirt against the leather's modulus, degrees", hardness_table()]
    parts += [pages.predictions(PREDICTED, leather_found())]
    return pages.paragraphs(*parts)


def leather_draw(axes: Any) -> None:
    """Squirt against the dome."""
    for i, name in enumerate(LEATHERED):
        for model, style in ((leather, "o-"), (patchwork, "s:")):
            squirts = [model(name, r) for r in DOMES]
            label = f"{name}, {pool.MODERN if model is leather else 'patchwork'}"
            axes.plot(range(len(squirts)), squirts, style, color=f"C{i}", label=label)
    axes.set_xticks(range(len(DOMES)), [_radius(r) for r in DOMES])
    axes.set(xlabel="dome", ylabel="squirt at b/R 0.3, degrees", ylim=(0, None))
    axes.set(title=f"{pool.MODERN} beside the patchwork")
    axes.legend(fontsize=8, loc="lower left")


STUDY = pages.Study(
    __file__,
    lambda: pages.paragraphs(report(), leather_report()),
    {"dome.svg": pages.Figure(draw, (1, 3), (14, 4.2))},
    predicted=PREDICTED,
)


if __name__ == "__main__":
    STUDY.write()
