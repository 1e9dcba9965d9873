"""Squirt of a billiard cue from its geometry: a short paper whose every number and figure this program makes.

What: the whole stroke of cuefem (leather tip, waves along the cue, thrust on the bent shaft) on a maple shaft: its
equations, how it was checked, what it gives beside what was measured, and what is not known.
Equations: handbook: Effects, The contact. Data: studies/measured/data.
`python -m studies.article.article` writes article.md and its figures, and article.pdf where WeasyPrint is installed
(`pip install weasyprint`). Takes about a minute.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
from markdown_it import MarkdownIt

import cuefem as cf
from studies import pages, strokes
from studies.contact import leather_release
from studies.measured import measured_shafts as shafts
from studies.measured import pool

SPEEDS = (0.8, 1.4, 2.0, 2.8, 4.0, 5.6, 7.0)  # m/s
OFFSETS = (0.1, 0.187, 0.25, 0.32, 0.375, 0.453, 0.5)
ROBOT = (3.6 * 0.44704, 7.8 * 0.44704)  # m/s
INCHES = (2, 3, 4, 5, 6, 6.5, 7, 8, 10)
STEPS = ("leather", "and waves", "and thrust")
PARTS: dict[str, tuple[cf.Effect, ...]] = {
    STEPS[0]: (),
    STEPS[1]: pool.WHOLE[:1],
    STEPS[2]: pool.WHOLE,
}
STYLE = """
@page { size: A4; margin: 22mm 20mm; @bottom-center { content: counter(page); font: 9pt serif } }
body { font: 11pt/1.45 serif; hyphens: auto; text-align: justify }
h1 { font-size: 19pt; text-align: left; line-height: 1.2 } h2 { font-size: 13pt; break-after: avoid }
table { border-collapse: collapse; margin: 1em auto; font-size: 9pt; break-inside: avoid }
th, td { padding: .2em .7em; text-align: right; border-bottom: .4pt solid #999 } th { border-bottom: .9pt solid #333 }
th:first-child, td:first-child { text-align: left }
img { width: 100%; margin: .6em 0 } pre { font: 9pt/1.35 monospace; margin-left: 1.5em; white-space: pre-wrap }
"""


@cache
def outcome(speed: float = pool.SPEED, offset: float = pool.OFFSET, step: str = STEPS[2], **leather: float) -> Any:
    """A stroke of the maple shaft with the pool ball; step: which effects; leather: what differs of the usual tip."""
    return cf.strike(scene(speed, offset, step, **leather))


def scene(speed: float, offset: float, step: str, **leather: float) -> cf.Scene:
    """The scene of `outcome`. Every step has the tip of the whole stroke, so that only the effects differ."""
    tip = replace(pool.LEATHER, **leather)  # type: ignore[arg-type]
    whole = pool.leather_scene(maple(), offset, speed=speed, leather=tip)
    return replace(whole, effects=(tip, *PARTS[step]))


def maple() -> cf.Cue:
    """The maple shaft."""
    return strokes.cue("pool_maple")


def squirt(*of: Any, **leather: float) -> float:
    """Squirt, deg."""
    return math.degrees(outcome(*of, **leather).squirt)


@cache
def bare(speed: float, offset: float = pool.OFFSET) -> float:
    """Squirt, deg, of a spring along the normal alone whose contact lasts as long as the leather's, in Hertz's way."""
    time = pool.TIME * (pool.SPEED / speed) ** 0.2
    return pool.squirt(pool.scene(maple(), time, offset))


def spread(values: list[float]) -> float:
    """Largest over smallest less one, per cent."""
    return 100 * (max(values) / min(values) - 1)


def speed_table() -> str:
    """Squirt over the speed."""
    rows = [
        [f"{U:g}", f"{bare(U):.2f}", *(f"{squirt(U, pool.OFFSET, step):.2f}" for step in STEPS)]
        for U in (0.8, 2.0, 4.0, 7.0)
    ]
    every = [[bare(U) for U in SPEEDS], *([squirt(U, pool.OFFSET, step) for U in SPEEDS] for step in STEPS)]
    rows.append(["largest over smallest", *(f"{spread(values):.0f} %" for values in every)])
    return pages.table(["speed, m/s", "bare", *STEPS], rows)


def offset_table() -> str:
    """Squirt over the offset, with what was measured."""
    told = {0.187: "0.84 (0.55 to 1.13)", 0.32: "1.43", 0.375: "2.30, 2.43", 0.453: "2.5"}
    rows = [
        [f"{b:g}", measured, f"{bare(pool.SPEED, b):.2f}", *(f"{squirt(pool.SPEED, b, step):.2f}" for step in STEPS)]
        for b, measured in told.items()
    ]
    return pages.table(["b/R", "measured", "bare", *STEPS], rows)


@cache
def hollow_ratio(bore: float) -> float:
    """Squirt of the hollow shaft over that of the maple one at b/R 0.453."""
    return pool.leather_strike(pool.leather_scene(pool.hollow(bore), 0.453))[0] / squirt(pool.SPEED, 0.453)


@cache
def with_mass(inches: float) -> float:
    """Squirt with 11 g on the shaft over that without them."""
    lump = (cf.PointMass(inches * pool.INCH, 11e-3),)
    return pool.leather_strike(pool.leather_scene(maple(), effects=lump))[0] / squirt()


def mass_miss() -> float:
    """Root mean square of what the ratios with 11 g are off by."""
    return math.sqrt(np.mean([(with_mass(x) - pool.added_mass(x)) ** 2 for x in INCHES]))


@cache
def energy_miss() -> float:
    """Largest part of the energy that is missing in the account of 40 whole strokes drawn at random."""
    draw, worst = np.random.default_rng(23), 0.0
    for _ in range(40):
        speed, offset = float(np.exp(draw.uniform(math.log(0.8), math.log(7.0)))), float(draw.uniform(0.05, 0.6))
        account = cf.strike(scene(speed, offset, STEPS[2], E=float(draw.uniform(8e7, 4e8)))).energy
        spent = sum(value for name, value in account.items() if name != "initial")
        worst = max(worst, abs(spent / account["initial"] - 1))
    return worst


@cache
def stepped_miss() -> float:
    """Squirt of the leather step by step, in plain kicks of a microsecond, over cuefem's, less one."""
    struck = scene(pool.SPEED, pool.OFFSET, STEPS[1])
    return leather_release.stepped(struck, "rings that slip", 1e-6).squirt / squirt(2.0, pool.OFFSET, STEPS[1]) - 1


@cache
def modes_miss() -> float:
    """Squirt with twice the modes and elements over the default's, less one."""
    usual = scene(pool.SPEED, pool.OFFSET, STEPS[2])
    return math.degrees(cf.strike(usual, cf.Resolution(8, 12, 120)).squirt) / squirt() - 1


def series_miss(model: Callable[[float], float]) -> float:
    """Root mean square of the relative differences in the series of 2007."""
    return float(np.sqrt(np.mean([(model(row.offset) / row.squirt - 1) ** 2 for row in shafts.series()])))


ABSTRACT = """\
A cue that strikes a billiard ball off centre sends it a little aside. Programs take the size of this *squirt* from a
number that is typed in, the effective end mass. We compute it from the drawing of the shaft: a tapered Timoshenko
beam meets the ball through a tip of leather that is known by its height, its dome and its modulus. Three things are
needed that are usually left out: a patch of contact that slips ring by ring, waves along the cue, and the thrust of
the stroke on the bent shaft. Nothing is fitted.
"""

QUESTION = """\
## 1 The question

A player who strikes off centre to give the ball spin must aim for squirt; makers sell shafts that have less of it.
What the ball feels at the tip is an inertia. H.-C. Kim (*Motions of a billiard ball after a cue stroke*) takes it for
a mass at the end of a rigid cue, and guesses 12 g from a tone of 250 Hz. But in the 1.3 ms of a contact only the
first part of the shaft has begun to move. Which mass that is depends on how long the contact lasts, on how the tip
holds the ball, and on what the stroke itself does to the shaft.

Measured squirt sets a riddle. It depends neither on the speed of the stroke nor on the hardness of the tip, as a
robot (Alciatore, Billiards Digest, February 2008) and players find. A softer tip and a slower stroke, though, make
longer contacts, and a longer contact sees more of the shaft.
"""

MODEL = """\
## 2 The model

**The shaft** is a beam with shear and rotary inertia (Timoshenko), tapered, of wood, with its ferrule, bore and joint
as they are drawn; the rest of the cue is a rigid body behind it. Finite elements of high order give its free modes,
and what the modes that are left out would give way is added as a compliance. Bars of the same drawing carry waves
along the cue, which do not bend it.

**The tip** is a short cylinder of leather with a domed end on a ferrule. 3-D elasticity, solved once for all heights,
domes and Poisson's ratios, gives the force F(d) of a ball pressed in by d, head on, and the stiffness k(a) along the
surface of a patch of radius a. What the tip loses in a blow is told by its restitution e: it unloads along the same
curve with d scaled by e^2. With waves along the cue a head-on blow loses speed to them as well, or gains some back:
the 0.73 that is measured is of the whole cue.

**The patch** grows and shrinks during the contact. Each ring of it is strained by what the surfaces have shifted
since it touched, and bears mu times its part of the normal force at most (Cattaneo, Mindlin and Deresiewicz):

```text
F_t = sum of f_r          f_r -> clip(f_r + dk_r dv, +- mu dN_r)
```

The rim touched last and is strained least, so that a patch lets go of little as it shrinks. The ball rolls over the
dome while this goes on, and the normal turns with it.

**The thrust.** A stroke presses the shaft together; at the tip the force F_x is some 500 N at 2 m/s. Where the shaft
is bent this force has a part across it (second-order theory, the P-delta of columns). With the share p(x) of the
cue's mass behind x and the deflection w, the energy and the way of the contact along the axis are

```text
V = -1/2 F_x  integral of p w'^2 dx
s = -1/2 (q'G q + l theta^2),        G_ij = integral of p w_i' w_j' dx
```

over all modes, theta the rotation at the ferrule's end and l the way from there to the centre of the dome.

**The contact** is solved as it is: between the contact's forces cue and ball move linearly, so that a step with
forces that are polynomials in time is exact, and the forces at the steps' nodes follow from the laws above by
Newton's method.
"""


def verification() -> str:
    """How it was checked."""
    return (
        "## 3 Verification\n\n"
        "Each part was checked against something that is not of it. The beam: against 3-D elasticity of the same shaft "
        "in Fourier harmonics on scikit-fem, six modes of Kim's cone within 4.3e-6 (studies/beam/solid.md). The patch: "
        "a boundary-element solver with vector friction gives the squirt of a half-space to 0.0 %, of a bonded layer "
        "of 6 mm to 0.04, 0.3 and 1.1 % at b/R 0.187, 0.375 and 0.453. The contact: a second program in plain kicks of "
        f"a microsecond gives the squirt of this page's stroke without thrust to {100 * abs(stepped_miss()):.2f} %, "
        "and one in NumPy, written from the equations alone, hundreds of random strokes to 1e-10 (to 3e-5 where rings "
        "slip). The thrust: columns buckle at Engesser's load, and a geometrically exact chain of links with its own "
        "time stepping changes its squirt by 12 to 57 % where its links may turn, of which the model has all but a "
        "thousandth (tests/effects/test_geometric_stiffness.py). The account of energies of 40 whole strokes drawn at "
        f"random closes to {energy_miss():.0e}. Twice the modes and elements change squirt by "
        f"{100 * abs(modes_miss()):.2f} %.\n"
    )


def stroke() -> str:
    """What goes on in a contact."""
    found = outcome()
    time = np.linspace(0, found.duration, 200)
    most = float(found.history(time)["force_n"].max())
    moved = cf.motion(scene(pool.SPEED, pool.OFFSET, STEPS[2]), np.array([found.duration]))
    along = np.linspace(0, 0.7, 200)
    bent = moved.deflection(along)[0][0]
    flat = along[np.abs(bent) > 0.05 * np.abs(bent).max()].max()
    return (
        "## 4 What goes on in a stroke\n\n"
        f"Figure 1 shows the stroke at {pool.SPEED:g} m/s and b/R {pool.OFFSET:g}. The contact lasts "
        f"{1e3 * found.duration:.2f} ms and the force along the normal reaches {most:.0f} N. When the ball leaves, the "
        f"tip stands {1e3 * abs(bent[0]):.1f} mm aside and the bend has come {100 * flat:.0f} cm down the shaft: what "
        "lies behind takes no part. The thrust acts where the shaft is bent, on its first decimetres, and there p(x) "
        "is still nearly one.\n\n"
        "![the forces of a stroke, and the shaft as the ball leaves](article_stroke.svg)\n\n"
        "*Figure 1.* Left: the forces on the ball. Right: the shaft at four times, the last as the ball leaves.\n\n"
        "Why squirt is flat. The slopes w' of the shaft grow with the momentum that the tip has taken up, so with the "
        "speed U; the thrust grows with U too. The part of the force across the shaft is their product, and its share "
        "in all forces grows like U. It pushes the tip further aside, so that the tip gives way more and the ball is "
        "pushed less: squirt falls in proportion to U. A stiffening tip does the opposite: fast strokes press the "
        "patch wide and make the contact short, and a lateral force that is let go late makes more squirt. Between the "
        "speeds of play these two nearly cancel.\n"
    )


@cache
def input_worth() -> dict[str, tuple[float, float]]:
    """Change of squirt, per cent, with one input at its low and at its high value."""
    usual = scene(pool.SPEED, pool.OFFSET, STEPS[2])
    cue, tip, base = usual.shaft, usual.tip, squirt()

    def wood(factor: float) -> cf.Scene:
        parts = (
            replace(each, material=replace(each.material, E=factor * each.material.E, G=factor * each.material.G))
            for each in cue.segments
        )
        return replace(usual, cue=replace(cue, segments=tuple(parts)))

    def leather(**more: float) -> cf.Scene:
        return scene(pool.SPEED, pool.OFFSET, STEPS[2], **more)

    scenes = {
        "E and G of wood and ferrule, 0.9 and 1.1 times": (wood(0.9), wood(1.1)),
        "height of the tip, 5 and 7 mm": (leather(height=5e-3), leather(height=7e-3)),
        "radius of the dome, 8.96 mm (dime) and 10.6 mm (nickel)": (
            leather(dome_radius=8.955e-3),
            leather(dome_radius=10.605e-3),
        ),
        "E of the leather, 70 and 280 MPa": (leather(E=70e6), leather(E=280e6)),
        "Poisson's ratio of the leather, 0.3 and 0.45": (leather(nu=0.3), leather(nu=0.45)),
        "restitution of the tip, 0.58 and 0.68": tuple(  # type: ignore[dict-item]
            replace(usual, tip=replace(tip, restitution=e)) for e in (0.58, 0.68)
        ),
        "friction, 0.6 and 0.8": tuple(replace(usual, tip=replace(tip, friction=mu)) for mu in (0.6, 0.8)),  # type: ignore[dict-item]
        "restitution along the surface, 0.9 and 0.95": (
            leather(surface_restitution=0.9),
            leather(surface_restitution=0.95),
        ),
    }
    return {
        name: tuple(100 * (math.degrees(cf.strike(each).squirt) / base - 1) for each in pair)  # type: ignore[misc]
        for name, pair in scenes.items()
    }


def worth_table() -> str:
    """What the inputs are worth."""
    rows = [[name, *(f"{change:+.1f} %" for change in changes)] for name, changes in input_worth().items()]
    return pages.table(["input, low and high", "squirt at low", "squirt at high"], rows)


def end_mass_table() -> str:
    """The mass that a lumped cue needs to squirt as much."""
    rows = []
    for speed in (0.8, 2.0, 7.0):
        struck = scene(speed, pool.OFFSET, STEPS[2])
        masses = (float(np.asarray(cf.end_mass(struck, drive))) for drive in ("squirt", "stick"))
        rows.append([f"{speed:g}", *(f"{1e3 * mass:.2f}" for mass in masses)])
    return pages.table(["speed, m/s", "of the squirt, g", "of a tip that sticks, g"], rows)


def result() -> str:
    """What comes out, beside what was measured."""
    whole, last = [squirt(U) for U in SPEEDS], [squirt(pool.SPEED, b) for b in (0.32, 0.453)]
    moduli = [squirt(E=E) for E in (40e6, 100e6, 200e6, 400e6)]
    robot = [squirt(U) for U in ROBOT]
    hollow = ", ".join(f"{hollow_ratio(bore):.2f} for {1e3 * bore:g} mm" for bore in pool.BORES)
    return (
        "## 5 Computed and measured\n\n"
        f"The shaft is a usual maple one: {1e3 * maple().segments[0].tip_diameter:.2f} mm at the tip, a ferrule, a pro "
        f"taper. The tip is {1e3 * pool.LEATHER.height:g} mm high with a dome of {1e3 * pool.LEATHER.dome_radius:g} mm "
        f"and E = {pool.LEATHER.E / 1e6:g} MPa; mu = {pool.FRICTION:g}, and the tip's e = {pool.TIP_RESTITUTION:.2f} "
        f"so that the cue bounces as if it had {pool.RESTITUTION:g}. Squirt at b/R {pool.OFFSET:g}, degrees:\n\n"
        f"{speed_table()}\n"
        f"The robot measured 2.30 degrees on one day and 2.34 to 2.54 over {ROBOT[0]:.1f} to {ROBOT[1]:.1f} m/s on "
        f"another, without a trend; the whole stroke gives {robot[0]:.2f} to {robot[1]:.2f}. That squirt does not "
        "depend on speed is no property of one part. A bare tip's falls as the contact gets shorter. A leather tip "
        "that slips ring by ring gives more squirt in fast strokes, waves along the cue more still; the thrust, which "
        "grows with the speed, takes it away again. "
        f"All together change by {spread(whole):.0f} % from {SPEEDS[0]:g} to {SPEEDS[-1]:g} m/s.\n\n"
        "![squirt against speed and against the offset](article.svg)\n\n"
        "*Figure 2.* Squirt of the bare tip and of the leather with one effect after the other. Left: over the speed, "
        "at b/R 0.375. Right: over the offset, at 2 m/s.\n\n"
        f"{offset_table()}\n"
        "The two series contradict each other: that of 2007, with the same cue, read at b/R 0.375 lies a fifth to a "
        f"quarter below the robot. The whole stroke is off by {100 * series_miss(squirt_at):.0f} % (root mean square) "
        f"in that series, the bare tip by {100 * series_miss(lambda b: bare(pool.SPEED, b)):.0f} %. From b/R 0.320 to "
        f"0.453 squirt grows by {last[1] / last[0]:.2f}, where 1.75 was measured: no model here does. A zero of the "
        "angle or of the offset that was wrong would explain it; nothing but the fit shows that it was.\n\n"
        f"A low-deflection shaft had 0.72 of the maple shaft's squirt; its bore, which its measured stiffness puts at "
        f"7.4 to 10.2 mm, gives {hollow}. Clips of 11 g along the shaft raise squirt near the tip and lower it 7 in "
        f"behind it, where the bending wave that the mass throws back comes too early; the ratios are off by "
        f"{mass_miss():.2f} (root mean square), the most close to the tip (figure 3).\n\n"
        "![added masses, and leathers](article_masses.svg)\n\n"
        "*Figure 3.* Left: squirt with a clip of 11 g on the shaft over that without it. Right: squirt over the "
        "leather's modulus.\n\n"
        f"Leather of 40 to 400 MPa changes squirt by {spread(moduli):.0f} %, more than players say. What the inputs "
        f"are worth, at b/R {pool.OFFSET:g} and {pool.SPEED:g} m/s:\n\n{worth_table()}\n"
        "A program that knows a cue by one number needs the end mass with which its lumped cue squirts as much "
        "(without dome and coupling). It is not the 12 g of the guess, and not quite the mass that a tip "
        f"feels which sticks to what moves it:\n\n{end_mass_table()}"
    )


def squirt_at(offset: float) -> float:
    """Squirt of the whole stroke, deg."""
    return squirt(pool.SPEED, offset)


UNKNOWN = """\
## 6 What is not known

How leather gives back work along its surface. Along the normal it gives back half; if it did so along the surface
too, squirt would be a sixth above what the robot measured, so it must lose far less there, but nobody has measured
it. A ball dropped at a slant on a clamped tip, its spin filmed before and after, would tell.

The table of the tip leaves out that a force along the normal shifts the surface sideways on a tip struck off its axis
(0.2 to 0.5 % of squirt at b/R 0.375 and 0.453, 3.7 % at 0.187). Leather is linear here: at 15 % of strain a
rubber-like (neo-Hookean) block is 19 % stiffer along the normal and not along the surface, which is worth some -3 %
of squirt.

The wood of the measured shafts is assumed, as are their tapers and bores; only their tips' diameters are published.
Squirt of one known shaft at five offsets, left and right, to 3 %, would decide most of what is open here.
"""
DATA = """\
## 7 Data and program

Everything is in the repository of cuefem: the drawings in meshes/, the measured values with their sources in
studies/measured/data/, this text with its numbers in studies/article/article.py. Measured squirt and added masses: D.
G. Alciatore, Billiards Digest, September and November 2007 and February 2008, and billiards.colostate.edu, TP A.30,
A.31 and B.1. The lumped cue: H.-C. Kim, *Motions of a billiard ball after a cue stroke*. Friction of a patch: K. L.
Johnson, *Contact Mechanics* (1985), chapter 7. Thrust on a beam: F. Engesser (1889); S. P. Timoshenko and J. M. Gere,
*Theory of Elastic Stability* (1961), chapter 2.
"""


def text() -> str:
    """The paper."""
    low, high = min(squirt(U) for U in SPEEDS), max(squirt(U) for U in SPEEDS)
    found = (
        f"On a maple shaft at b/R {pool.OFFSET:g} squirt is then {low:.2f} to {high:.2f} degrees from {SPEEDS[0]:g} to "
        f"{SPEEDS[-1]:g} m/s; a robot measured 2.30 and 2.43, and found it as flat.\n"
    )
    parts = ["# Squirt of a billiard cue from its geometry\n", ABSTRACT + found, QUESTION, MODEL, verification()]
    return "\n".join([*parts, stroke(), result(), UNKNOWN, DATA])


def draw(panels: Any) -> None:
    """Squirt over the speed, and over the offset."""
    left, right = panels
    colours = {"bare": "0.55", STEPS[0]: "C0", STEPS[1]: "C1", STEPS[2]: "C2"}
    for name, colour in colours.items():
        of_speed = [bare(U) if name == "bare" else squirt(U, pool.OFFSET, name) for U in SPEEDS]
        of_offset = [bare(pool.SPEED, b) if name == "bare" else squirt(pool.SPEED, b, name) for b in OFFSETS]
        width = 2.4 if name == STEPS[2] else 1.3
        left.plot(SPEEDS, of_speed, color=colour, lw=width, marker="o", ms=3, label=name)
        right.plot(OFFSETS, of_offset, color=colour, lw=width, label=name)
    left.fill_between(ROBOT, 2.34, 2.54, color="k", alpha=0.15, lw=0, label="robot, 2008")
    left.axhline(2.30, color="k", ls=":", lw=1, label="robot, another day")
    left.set(xlabel="speed of the stroke, m/s", ylabel="squirt at b/R 0.375, degrees", ylim=(1.4, 3.0))
    right.errorbar([0.187], [0.84], [[0.29], [0.29]], color="k", fmt="s", ms=4, label="2007")
    right.plot([0.32, 0.453], [1.43, 2.5], "ks", ms=4)
    right.plot([0.375, 0.375], [2.30, 2.43], "kD", ms=4, mfc="white", label="2008")
    right.set(xlabel="offset b/R", ylabel="squirt at 2 m/s, degrees")
    left.legend(fontsize=8, ncols=2, loc="lower left")
    right.legend(fontsize=8, loc="upper left")


def draw_stroke(panels: Any) -> None:
    """The forces of a stroke, and the bent shaft with the share of the mass behind."""
    left, right = panels
    found = outcome()
    time = np.linspace(0, found.duration, 200)
    forces = found.history(time)
    left.plot(1e3 * time, forces["force_n"], label="along the normal")
    left.plot(1e3 * time, forces["force_t"], label="along the surface")
    left.set(xlabel="time, ms", ylabel="force on the ball, N")
    left.legend(fontsize=8)
    times = found.duration * np.array([0.25, 0.5, 0.75, 1.0])
    moved, along = cf.motion(scene(pool.SPEED, pool.OFFSET, STEPS[2]), times), np.linspace(0, 0.6, 200)
    for at, shape in zip(times, moved.deflection(along)[0], strict=True):
        right.plot(100 * along, 1e3 * shape, label=f"{1e3 * at:.2f} ms")
    right.set(xlabel="from the ferrule's end, cm", ylabel="deflection, mm")
    right.legend(fontsize=8)


def draw_masses(panels: Any) -> None:
    """Squirt with 11 g along the shaft, and over the leather's modulus."""
    left, right = panels
    measured = pool.added_masses(11e-3)
    places = np.linspace(2, 10, 17)
    left.plot(places, [with_mass(float(x)) for x in places], color="C2", label="whole stroke")
    left.plot(list(measured), list(measured.values()), "kD", ms=4, mfc="white", label="measured")
    left.set(xlabel="11 g at, inches from the tip", ylabel="squirt over that without it")
    left.legend(fontsize=8)
    moduli = np.geomspace(40e6, 400e6, 9)
    right.semilogx(moduli / 1e6, [squirt(E=float(E)) for E in moduli], color="C2")
    right.set(xlabel="E of the leather, MPa", ylabel="squirt at b/R 0.375, degrees", ylim=(1.4, 3.0))
    right.set_xticks([40, 100, 200, 400], ["40", "100", "200", "400"])
    right.minorticks_off()


FIGURES = {
    "article_stroke.svg": pages.Figure(draw_stroke, (1, 2), (9.6, 3.6)),
    "article.svg": pages.Figure(draw, (1, 2), (9.6, 4.0)),
    "article_masses.svg": pages.Figure(draw_masses, (1, 2), (9.6, 3.6)),
}
STUDY = pages.Study(__file__, text, FIGURES)


def save_pdf(path: Path) -> None:
    """The committed page as PDF; ImportError without WeasyPrint."""
    from weasyprint import HTML  # a library with libraries of the system below it: not every machine has it

    html = MarkdownIt("commonmark").enable("table").render(STUDY.committed)
    whole = (
        f'<!DOCTYPE html><html lang="en"><head><title>Squirt</title><style>{STYLE}</style></head><body>{html}</body>'
    )
    HTML(string=whole, base_url=str(path.parent)).write_pdf(path)


if __name__ == "__main__":
    STUDY.write()
    try:
        save_pdf(STUDY.path.with_suffix(".pdf"))
    except ImportError:
        print("article.pdf is left out: it takes WeasyPrint (pip install weasyprint)")
