"""Which bending mode of which piece of the cue could be the 250 Hz that [Kim] states?

What: natural frequencies of the 70 cm shaft (free; clamped at its butt; pinned at the joint), of its first
12 cm (free; clamped) and of a whole cue, for maple's range of E, and the E that puts the nearest modes at 250 Hz.
Equations: Timoshenko beam (cuefem.modes), G = E/15, kappa 0.9, so every frequency grows as sqrt(E). The whole cue is
an assumption: a butt of 0.7 m from 21 to 29 mm diameter that brings the mass to 540 g, of the shaft's E.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from cuefem import Cue, Material, Segment, Support, modes
from studies import pages
from studies.pages import table
from studies.paper import closed_forms as squirt

SHAFT = {"length": 0.7, "tip_radius": 6e-3, "butt_radius": 10.5e-3}  # m
MASS, CUE_MASS = 0.12, 0.54  # kg
DENSITY = MASS / (math.pi * 0.7 * (6e-3**2 + 6e-3 * 10.5e-3 + 10.5e-3**2) / 3)  # kg/m3
TONE = 250.0  # Hz
MAPLE = (10e9, 12.6e9, 16e9)  # Pa


@dataclass(frozen=True)
class Piece:
    """A piece of the cue as a function of E, and its supports."""

    name: str
    cue: Callable[[float], Cue]
    effects: tuple[Support, ...] = ()


def front(E: float, length: float = 0.7) -> Cue:
    """The first ``length`` m of Kim's shaft; E in Pa."""
    return Cue((_cone(E, length, 6e-3, float(squirt.base_radius(length, **SHAFT)), DENSITY),))


def whole(E: float) -> Cue:
    """The shaft and an assumed butt."""
    volume = math.pi * 0.7 * (10.5e-3**2 + 10.5e-3 * 14.5e-3 + 14.5e-3**2) / 3
    butt = _cone(E, 0.7, 10.5e-3, 14.5e-3, (CUE_MASS - MASS) / volume)
    return Cue((*front(E).segments, butt))


def _cone(E: float, length: float, tip: float, butt: float, density: float) -> Segment:
    return Segment(length, 2 * tip, 2 * butt, Material(E, E / 15, density), kappa=0.9)


def pieces() -> list[Piece]:
    """The pieces that could have sounded."""

    def end(E: float) -> Cue:
        return front(E, 0.12)

    return [
        Piece("shaft, free", front),
        Piece("shaft, clamped at the butt", front, (Support(0.7, math.inf, math.inf),)),
        Piece("shaft, pinned at the joint", front, (Support(0.7, math.inf),)),
        Piece("12 cm cue end, free", end),
        Piece("12 cm cue end, clamped", end, (Support(0.12, math.inf, math.inf),)),
        Piece("whole cue, free", whole),
    ]


def nearest(piece: Piece, count: int) -> list[tuple[int, tuple[float, ...], float]]:
    """The ``count`` modes nearest to 250 Hz at the middle E: (number, Hz for each E of MAPLE, Pa that 250 Hz wants)."""
    found = np.array([modes(piece.cue(E), 8, effects=piece.effects).frequencies for E in MAPLE])
    chosen = np.sort(np.argsort(np.abs(np.log(found[1] / TONE)))[:count])
    return [(int(i) + 1, tuple(map(float, found[:, i])), float(MAPLE[1] * (TONE / found[1, i]) ** 2)) for i in chosen]


def text() -> str:
    """The two modes of each piece nearest to the tone."""
    rows = []
    for piece in pieces():
        for number, hertz, needed in nearest(piece, 2):
            within = "yes" if MAPLE[0] <= needed <= MAPLE[-1] else "no"
            rows.append([piece.name, f"{number}", *(f"{f:.0f}" for f in hertz), f"{needed / 1e9:.2g}", within])
    return pages.page(
        "The 250 Hz of [Kim]",
        "Which bending mode could be the 250 Hz from which Kim estimates a cue end of 12 g?",
        "None of the free or clamped shaft for maple's 10 to 16 GPa; the second mode of the shaft pinned at its joint, "
        "at 10.6 GPa.",
        table(
            ["piece", "mode", *(f"{E / 1e9:g} GPa, Hz" for E in MAPLE), "E for 250 Hz, GPa", "within 10 to 16 GPa"],
            rows,
        ),
    )


EXAMPLE = """\
import cuefem as cf

shaft = cf.load_cue("meshes/kim.toml")
joint = cf.Support(position=0.7, stiffness=1e9)
for name, effects in (("free", ()), ("pinned at the joint", (joint,))):
    frequencies = cf.modes(shaft, 3, effects=effects).frequencies
    print(name, ", ".join(f"{frequency:.0f}" for frequency in frequencies), "Hz")
"""
STUDY = pages.Study(__file__, text, example=EXAMPLE)


if __name__ == "__main__":
    STUDY.write()
