"""What do grain that runs out and a shaft glued of wedges do to squirt?

What: the tone, end mass and squirt of the solid maple shaft of meshes/ in pool's usual stroke, for grain that leaves
the axis by a fixed angle in the plane of the rings' radius or of their tangent; and the scatter of squirt from shaft to
shaft, of one board and of 6, 8 and 10 wedges of boards drawn at random.
Equations: the compliance of an orthotropic body turned about one of its axes; of wedges that are bent as one,
EI = sum E_i I_i, which weighs boards by what of the section is theirs. Pieces end to end share the load, not the
strain, and take the harmonic average of E instead: it is the least, this the most that pieces can have between them.
Constants of sugar maple and how they scatter: Forest Products Laboratory, Wood Handbook (2010), tables 5-1, 5-2, 5-6.
Left out: turned grain couples bending to twist and pull to shear; here each is its own.
Takes a second.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import replace
from functools import cache
from typing import Any, NamedTuple

import numpy as np

import cuefem as cf
from cuefem.materials import material
from studies import pages
from studies.pages import table
from studies.strokes import cue

# Sugar maple over E along the grain: E across, G with the grain, Poisson's ratio of a pull along the grain.
PLANES = {"radial": (0.132, 0.111, 0.424), "tangential": (0.065, 0.063, 0.476)}
ANGLES = (0.0, 1.0, 2.0, 3.0, 5.0, 8.0)  # deg
BARE = cf.Tip(contact_time=1.1e-3)
SCATTER = 0.22  # of E from board to board, standard deviation over the mean
WEDGES = (1, 6, 8, 10)
PREDICTED = {
    "E at 5°, tangential, over straight grain": "0.90",
    "squirt at 5°, tangential": "-2 %",
    "scatter of squirt, one board": "5 %",
    "scatter of squirt, 8 wedges": "2 %",
}


class Turned(NamedTuple):
    """Young's modulus along an axis and the shear modulus with it, in a plane that holds the grain, over those of
    straight grain."""

    E: float
    G: float


def turned(angle: float, across: float, shear: float, nu: float) -> Turned:
    """Wood whose grain leaves the axis by ``angle``, rad; across, shear: E across and G over E along the grain."""
    c, s = math.cos(angle), math.sin(angle)
    pull = c**4 + s**4 / across + s * s * c * c * (1 / shear - 2 * nu)
    slide = 4 * s * s * c * c * (1 + 1 / across + 2 * nu) + (c * c - s * s) ** 2 / shear
    return Turned(1 / pull, 1 / (slide * shear))


class Struck(NamedTuple):
    """First tone, Hz, end mass of the offset, g, and squirt, deg."""

    tone: float
    end_mass: float
    squirt: float


@cache
def struck(E: float = 1.0, G: float = 1.0, *, bare: bool = False) -> Struck:
    """The maple shaft with its wood's moduli times these; bare: by a spring as tip, without a dome and effects."""
    maple, drawn = material("hard maple"), cue("pool_maple")
    wood = [s.material.E >= maple.E for s in drawn.segments]
    segments = tuple(
        replace(s, material=replace(s.material, E=s.material.E * E, G=s.material.G * G)) if maple_here else s
        for s, maple_here in zip(drawn.segments, wood, strict=True)
    )
    whole = replace(drawn, segments=segments)
    scene = cf.Scene(whole, tip=BARE, stroke=cf.Stroke(offset=0.3)) if bare else cf.usual_scene(whole, "pool")
    outcome = cf.strike(scene)
    tone = float(cf.modes(scene.shaft, 1).frequencies[0])
    return Struck(tone, 1e3 * float(cf.end_mass(scene, "offset")), math.degrees(outcome.squirt))


def grain_rows() -> Iterator[list[Any]]:
    straight = struck()
    for plane, constants in PLANES.items():
        for angle in ANGLES:
            wood = turned(math.radians(angle), *constants)
            here = struck(*wood)
            apart = 100 * (np.array(here) / straight - 1)
            yield [plane, f"{angle:g}", f"{wood.E:.3f}", f"{wood.G:.3f}", *(f"{each:+.2f}" for each in apart)]


def shares(count: int) -> tuple[float, float]:
    """Of wedges with independent E: the scatter of EI over that of one board, in the mean of all directions of bending,
    and that of its part that changes with the direction.

    A wedge from -pi/n to pi/n has I_i = I/n (1 + sin(2 pi/n)/(2 pi/n) cos 2t) about the axis at t to its middle.
    """
    lobe = math.sin(2 * math.pi / count) / (2 * math.pi / count) if count > 1 else 0.0
    return 1 / math.sqrt(count), abs(lobe) / math.sqrt(2 * count)


def slope(*, bare: bool = False) -> float:
    """The slope of the logarithm of squirt over that of E."""
    low, high = 0.95, 1.05
    return math.log(struck(high, bare=bare).squirt / struck(low, bare=bare).squirt) / math.log(high / low)


def wedge_rows() -> Iterator[list[Any]]:
    for count in WEDGES:
        mean, lobe = (100 * SCATTER * share for share in shares(count))
        name = "one board" if count == 1 else f"{count} wedges"
        yield [name, *(f"{value:.1f}" for value in (mean, lobe)), *(f"{abs(slope()) * v:.2f}" for v in (mean, lobe))]


def found() -> dict[str, str]:
    wood = turned(math.radians(5), *PLANES["tangential"])
    scatter = [100 * abs(slope()) * SCATTER * shares(count)[0] for count in (1, 8)]
    names = [*PREDICTED]
    return {
        names[0]: f"{wood.E:.3f}",
        names[1]: f"{100 * (struck(*wood).squirt / struck().squirt - 1):+.2f} %",
        names[2]: f"{scatter[0]:.1f} %",
        names[3]: f"{scatter[1]:.1f} %",
    }


def text() -> str:
    straight = struck()
    grain = ["plane", "grain off, deg", "E", "G", "first tone, %", "end mass, %", "squirt, %"]
    wedges = ["shaft", "EI scatters, %", "with the direction, %", "squirt scatters, %", "with the direction, %"]
    return pages.paragraphs(
        "# Wood as it is: grain that runs out, and shafts of wedges",
        f"The solid maple shaft of meshes/ in pool's usual stroke at b/R 0.3: first free tone {straight.tone:.1f} Hz, "
        f"end mass of the offset {straight.end_mass:.2f} g, squirt {straight.squirt:.3f}°. E and G are over those of "
        "straight grain, the rest is the change.",
        "## Grain that leaves the axis",
        table(grain, grain_rows()),
        "## Wedges",
        f"E scatters by {100 * SCATTER:g} % from board to board (standard deviation), and a change of E by one per "
        f"cent changes squirt by {slope():.3f} %: the domed tip's force along the cue turns the end of a softer shaft "
        f"more. By a spring without a dome it is {slope(bare=True):+.3f} %, as its end mass alone has it. Wedges of "
        "boards drawn at random share the bending in parallel. The second and the fourth column are the part that "
        "changes as the shaft is turned about its axis.",
        table(wedges, wedge_rows()),
        "Pieces glued end to end take the harmonic average of E, which is less than the mean by the square of the "
        f"scatter: {100 * SCATTER**2:.1f} % for many of them, {100 * abs(slope()) * SCATTER**2:.2f} % of squirt.",
        "## What was predicted and found",
        pages.BEFORE,
        table(["number", "predicted", "found"], [[name, said, found()[name]] for name, said in PREDICTED.items()]),
    )


def draw(axes: Any) -> None:
    angles = np.linspace(0, 8, 17)
    for plane, constants in PLANES.items():
        squirts = [struck(*turned(math.radians(float(a)), *constants)).squirt for a in angles]
        axes.plot(angles, 100 * (np.array(squirts) / struck().squirt - 1), label=f"in the {plane} plane of the rings")
    axes.set(xlabel="grain off the axis, degrees", ylabel="change of squirt, %", title="Grain that runs out, maple")
    axes.legend()


STUDY = pages.Study(__file__, text, {"grain.svg": pages.Figure(draw)}, heavy=False)


if __name__ == "__main__":
    STUDY.write()
