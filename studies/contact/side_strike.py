"""How does a ball rebound from the side of a beam: closed forms, and claims of published experiments.

(1) The apparent restitution e_A of an elastic spring on infinite Euler beams against its closed form. (2) Claims of
three published experiments, as far as their text was accessible, with assumed beams: e_A along a free aluminium rod
and a bat, rigid, flexible and with the far end clamped; the number of contacts of a heavy steel sphere with a steel
beam in one fall. No number is fitted or quoted from memory. Equations: handbook: The side strike.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from functools import cache
from itertools import groupby
from typing import Any

import numpy as np
from scipy.integrate import quad
from scipy.optimize import brentq
from scipy.special import wofz

import cuefem as cf
from studies import pages
from studies.pages import table

T, DIAMETER, DENSITY = 1e-3, 1e-2, 700.0  # s, m, kg/m3
THIN, STIFF = 250.0, 1e4  # distance of the waves over the diameter, and G/E: nearly an Euler beam
PARAMETERS = (0.05, 0.1, 0.2, 0.5, 1.0, 2.0, 3.0)
LENGTHS = {"middle": 16.0, "end": 8.0}  # of the beams, over the distance that waves spread in T


def exact(parameter: float) -> float:
    """e_A of an elastic spring on an infinite Euler beam: the force is a sum over the roots of u^4 + L u + 1.

    Above a parameter of 3.59 the force never vanishes: striker and beam do not separate.
    """
    u = np.roots([1.0, 0.0, 0.0, parameter, 1.0])
    weights = u / (4 * u**3 + parameter)

    def force(t: float) -> float:
        return float((weights * wofz(-1j * u * math.sqrt(t))).sum().real)

    after = next(t for t in np.linspace(0.05, 40, 800) if force(t) < 0)
    last = brentq(force, after - 0.05, after, xtol=1e-14)
    return float(quad(lambda x: 2 * x * force(x * x), 0, math.sqrt(last), epsabs=1e-13, limit=200)[0]) - 1


@cache
def compute(where: str, parameter: float) -> float:
    """e_A of a long beam, nearly Euler's."""
    spread = THIN * DIAMETER
    E = 16 * DENSITY * (spread**2 / T) ** 2 / DIAMETER**2
    material = cf.Material(E, STIFF * E, DENSITY, nu=0.0)
    cue = cf.Cue((cf.Segment(LENGTHS[where] * spread, DIAMETER, DIAMETER, material, kappa=1.0),))
    section, unit = cue.section(0.0), T / math.pi
    C = (1 if where == "middle" else 4) / (2 * math.sqrt(2) * float(section.EI) ** 0.25 * float(section.rhoA) ** 0.75)
    mass = parameter / C * math.sqrt(unit)
    striker = cf.Striker(mass, 1.0, stiffness=mass / unit**2)
    position = cue.length / 2 if where == "middle" else 0.0
    return cf.side_strike(cf.SideStrike(cue, striker, position)).apparent_restitution


def curve_table() -> str:
    """e_A over the parameter: exact, and by long beams."""
    rows = [[f"{p:g}", *(f"{e:.4f}" for e in (exact(p), *(compute(w, p) for w in LENGTHS)))] for p in PARAMETERS]
    return table(["Λ", "exact", "struck in the middle", "struck at the end"], rows)


ALUMINIUM = cf.Material(70e9, 26e9, 2700.0)
ROD = cf.Cue((cf.Segment(0.6, 0.015, 0.015, ALUMINIUM),))  # ours, no source's
WOOD = cf.Material(13e9, 1e9, 650.0)
BAT = cf.Cue(  # ours, of the size of a bat; the tip end is the barrel's
    (cf.Segment(0.25, 0.064, 0.064, WOOD), cf.Segment(0.30, 0.064, 0.025, WOOD), cf.Segment(0.29, 0.025, 0.025, WOOD))
)
CASES = {
    "rod": (ROD, cf.Striker(0.045, 0.85, contact_time=2e-3), (0.0, 0.02, 0.05, 0.1, 0.15, 0.2, 0.25, 0.3), 0.0),
    "bat": (BAT, cf.Striker(0.145, 0.5, contact_time=1e-3), (0.0, 0.03, 0.06, 0.1, 0.14, 0.18, 0.24, 0.3), 0.1),
}


@cache
def bounces(name: str, position: float) -> tuple[float, float, float]:
    """e_A at a position: of a rigid beam, of the flexible one, and with its far end clamped (a bat's last 10 cm)."""
    cue, striker, _, clamp_position = CASES[name]
    free = cf.SideStrike(cue, striker, position)
    ratio = striker.mass / free.rigid_mass
    rigid = (striker.restitution - ratio) / (1 + ratio)
    clamp = cf.Support(cue.length - clamp_position, math.inf, math.inf)
    clamped = replace(free, effects=(clamp,))
    return rigid, *(cf.side_strike(each).apparent_restitution for each in (free, clamped))


def bounce_table(name: str) -> str:
    """e_A along a beam."""
    rows = [[f"{1e3 * x:.0f}", *(f"{value:.3f}" for value in bounces(name, x))] for x in CASES[name][2]]
    return table(["from the end, mm", "rigid", "flexible", "flexible, far end clamped"], rows)


def rectangular(width: float, height: float, length: float, material: cf.Material) -> cf.Cue:
    """A beam of rectangular section as a round one: EI, rhoA, rhoI and kappa G A are the same, with kappa = 5/6."""
    d = 2 * height / math.sqrt(3)  # of the same radius of gyration
    factor = width * height / (math.pi / 4 * d**2)
    scaled = cf.Material(material.E * factor, material.G * factor, material.rho * factor, nu=0.0)
    return cf.Cue((cf.Segment(length, d, d, scaled, kappa=5 / 6),))


STEEL = cf.Material(206e9, 79.4e9, 7850.0)
SPHERE = 0.07  # m, and the beam 60 x 27.8 x 780 mm, simply supported: [Part II]'s abstract
SPEED, WINDOW = 0.5, 6e-3  # m/s, s: assumed, because those of the experiments were not accessible


def touches(phases: Sequence[Any]) -> tuple[tuple[float, float], ...]:
    """Contacts (start, duration), s: phases of contact without separation between them."""
    contacts = [list(part) for apart, part in groupby(phases, lambda phase: phase.state == "separated") if not apart]
    return tuple((part[0].start, part[-1].end - part[0].start) for part in contacts)


@cache
def fall() -> tuple[tuple[tuple[float, float], ...], tuple[float, float, float]]:
    """Contacts (start, duration) of the sphere at midspan, s, and durations of the first by Hertz's law.

    Contacts are counted with a spring that has the contact time of Hertz's law on a wall at that speed. Durations: on
    the beam, on a free rigid one, and against a wall.
    """
    beam = rectangular(0.06, 0.0278, 0.78, STEEL)
    mass = STEEL.rho * 4 / 3 * math.pi * SPHERE**3
    hertz = cf.Striker(mass, 1.0, modulus=STEEL.E / (1 - 0.3**2) / 2, radius=SPHERE)
    wall = hertz.wall_time(SPEED)
    supports = (cf.Support(0.0, math.inf), cf.Support(beam.length, math.inf))
    once = cf.SideStrike(beam, hertz, beam.length / 2, SPEED, supports)
    spring = cf.Striker(mass, 1.0, contact_time=wall)
    often = replace(once, striker=spring, effects=(*supports, cf.SecondHit(WINDOW)))
    contacts = touches(cf.side_strike(often).phases)
    first = cf.side_strike(once, cf.Resolution(2, 16, 20)).duration
    return contacts, (first, hertz.contact_time_on(beam.shaft_mass, SPEED), wall)


SOURCES = """\
- R. Cross, *Impact of a ball with a bat or racket*, Am. J. Phys. 67 (1999): abstract and first lines.
- A. M. Nathan, *Dynamics of the baseball-bat collision*, Am. J. Phys. 68 (2000) 979: abstract.
- Impact of a steel sphere on a steel beam, Parts I and II, doi 10.1177/1687814016668089 and
  10.1177/1687814016683351: both abstracts, with the sizes of beam and sphere.

Not accessible: their tables of e_A, sizes of beams, speeds and measured durations; C. Lindsey (Tennis
Warehouse University, 2020), arXiv:2207.00795 (abstracts only) and W. Goldsmith, *Impact* (1960)."""


def text() -> str:
    worst = max(abs(compute(w, p) - exact(p)) for w in LENGTHS for p in PARAMETERS)
    rod, bat = (np.array([bounces(name, x) for x in CASES[name][2]]) for name in CASES)
    contacts, (first, free, wall) = fall()
    insensitive = [f"{1e3 * x:.0f}" for x, row in zip(CASES["bat"][2], bat, strict=True) if abs(row[1] - row[0]) < 0.02]
    return pages.page(
        "Transverse impact of a ball on a beam",
        "How does a ball rebound from the side of a beam, and does the model agree with publications?",
        "The apparent restitution e_A on infinite Euler beams is a closed form of one parameter Λ; the model is within "
        f"{worst:.0e} of it. No published table of e_A was accessible. The model agrees with claims of the accessible "
        "abstracts: a bat acts as a rigid body only over a few centimetres of its barrel, a clamped handle changes "
        "nothing there, and a heavy steel sphere has several contacts with a steel beam.",
        "## Infinite Euler beams, elastic spring: e_A",
        curve_table(),
        "Above a parameter of 3.59 a striker would not separate from an infinite beam.",
        "## A free aluminium rod of 600 x 15 mm, a ball of 45 g, e 0.85, 2 ms (assumed)",
        "[Cross] finds that rigid models are of limited use and that the hand's force can usually be neglected. Here "
        f"the error of the rigid model is up to {np.abs(rod[:, 0] - rod[:, 1]).max():.2f}; a clamp at the far end "
        "hardly changes e_A within 10 cm.",
        bounce_table("rod"),
        "## A wooden bat of 840 mm, 64 mm at the barrel, a ball of 145 g, e 0.5, 1 ms (assumed)",
        "[Nathan] finds the rigid exit speed only over a small region of the barrel, for any support of the handle. "
        f"Here rigid and flexible agree within 0.02 at {', '.join(insensitive)} mm from the end and differ by up to "
        f"{np.abs(bat[:, 0] - bat[:, 1]).max():.2f}.",
        bounce_table("bat"),
        "## A steel sphere of 70 mm radius on a steel beam of 60 x 27.8 x 780 mm, 0.5 m/s, midspan",
        "The experiments find several contacts in most falls, the first of about the duration by Hertz's law. "
        f"Computed: {len(contacts)} contacts in {1e3 * (contacts[-1][0] + contacts[-1][1]):.1f} ms, of "
        f"{1e3 * min(d for _, d in contacts):.1f} to {1e3 * max(d for _, d in contacts):.1f} ms; by Hertz's law the "
        f"first lasts {1e3 * first:.2f} ms, {1e3 * free:.2f} on a free rigid beam, {1e3 * wall:.2f} against a wall. "
        "Speed, position, E = 206 GPa and e = 1 are assumed.",
        "## Sources",
        SOURCES,
    )


def draw(panels: Any) -> None:
    """The curve of infinite beams, and the bat."""
    grid = np.geomspace(0.03, 3.5, 60)
    panels[0].plot(grid, [exact(float(p)) for p in grid], "k-", lw=1, label="infinite Euler beam, exact")
    for where, marker in zip(LENGTHS, "o+", strict=True):
        values = [compute(where, p) for p in PARAMETERS]
        panels[0].plot(PARAMETERS, values, marker, ms=7, mfc="none", label=f"computed, {where}")
    panels[0].set(xscale="log", xlabel="inelasticity Λ", ylabel="apparent restitution $e_A$", title="long beam")
    panels[0].legend(fontsize=8)
    x = np.array(CASES["bat"][2])
    for i, (label, style) in enumerate((("rigid", "k:"), ("flexible", "C0-"), ("handle clamped", "C1--"))):
        panels[1].plot(1e3 * x, [bounces("bat", p)[i] for p in CASES["bat"][2]], style, label=label)
    panels[1].set(xlabel="from the end of the barrel, mm", ylabel="apparent restitution $e_A$", title="bat")
    panels[1].legend(fontsize=8)


EXAMPLE = """\
import cuefem as cf

bat = cf.load_cue("meshes/kim.toml")
ball = cf.Striker(mass=0.02, restitution=0.8, contact_time=1e-3)
for position in (0.05, 0.15, 0.35):
    outcome = cf.side_strike(cf.SideStrike(bat, ball, position=position))
    print(f"{100 * position:.0f} cm from the end: e_A {outcome.apparent_restitution:+.3f}")
"""
STUDY = pages.Study(__file__, text, {"side_strike.svg": pages.Figure(draw, (1, 2), (10, 4.2))}, example=EXAMPLE)


if __name__ == "__main__":
    STUDY.write()
