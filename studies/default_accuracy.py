"""How far off is the default of a strike and of an end mass?

What: the stick end mass that the default gives against many modes, at 200 contact times drawn from 0.5 to 3 ms, for
the cues of meshes/ and 40 random ones (woods, carbon tubes, tips of leather or brass, ferrules, bores, 1 to 4 pieces,
some to the butt); and squirt likewise, at fewer contact times and offsets, with and without AxialWaves. All draws are
seeded.
Equations: handbook: Effective end mass, with a tail; the modes of a cue are solved once for all contact times.
Writes default_accuracy.md beside itself; takes about 3 min.
"""

from __future__ import annotations

import sys
from dataclasses import replace
from functools import cache
from importlib import import_module
from itertools import pairwise
from pathlib import Path
from typing import NamedTuple

import numpy as np

from cuefem import AxialWaves, Cue, Material, Segment, strike
from cuefem.beam.modes import Modes, modes
from cuefem.beam.tail import tail
from cuefem.beam.tip import TipModes
from cuefem.beam.waves import modes_below
from cuefem.contact.strike import strike_modes
from cuefem.endmass.drives import flexible, ringing
from cuefem.endmass.undamped import StickLimit
from cuefem.tip_modes import LEAST_STUCK, tip_modes_from

HERE = Path(__file__).parent
if str(HERE) not in sys.path:
    sys.path.append(str(HERE))  # studies are files, not a package
common = import_module("common")

TIMES, SHORTEST, LONGEST = 200, 0.5e-3, 3e-3  # s
RANDOM, SEED = 40, 11
HIGHEST, MOST = 150e3, 260  # Hz and number of the modes that the end mass is held against
STRUCK = 120  # modes that squirt is held against
BRASS, FOAM = Material(1e11, 3.7e10, 8500.0), Material(7e7, 2.5e7, 60.0)


def random_cue(draw: np.random.Generator) -> Cue:
    """A cue drawn at random."""
    u = draw.uniform
    wood = _material(u(9e9, 18e9), u(10, 20), u(450, 1000))
    tube = draw.random() < 0.25
    body = _material(u(40e9, 130e9), u(8, 25), u(1450, 1650)) if tube else wood
    leather = _material(u(5e7, 4e8), u(2.5, 4), u(900, 1100))
    plastic = _material(u(2e9, 10e9), u(2.6, 2.9), u(1000, 1450))
    front, back, length, power, wall = u(0.010, 0.0135), u(0.019, 0.024), u(0.65, 0.8), u(1, 2.5), u(0.001, 0.002)
    head: list[Segment] = []
    kind = draw.choice(["none", "leather", "leather and ferrule", "brass", "ferrule"])
    if "leather" in kind:
        head.append(Segment(u(0.003, 0.012), front, front, leather))
    if kind == "brass":
        head.append(Segment(u(0.002, 0.02), front, front, BRASS))
    if "ferrule" in kind:
        bore = front * u(0.4, 0.7)
        head.append(Segment(u(0.005, 0.03), front, front, plastic, bore, bore, core=wood))
    ends = np.r_[0, np.sort(u(0.1, 0.9, draw.integers(0, 4))), 1]
    depth = u(0.3, 0.65) * front if draw.random() < 0.3 else 0.0  # of a bore, as wide, in the first piece
    shaft = []
    for i, (first, last) in enumerate(pairwise(ends)):
        a, b = (front + (back - front) * x**power for x in (first, last))
        bores = (a - 2 * wall, b - 2 * wall, FOAM) if tube else (depth, depth, None) if i == 0 else (0.0, 0.0, None)
        shaft.append(Segment(length * (last - first), a, b, body, *bores))
    if draw.random() < 0.2:
        return Cue(
            (*head, *shaft, Segment(0.02, back, back, BRASS), Segment(u(0.6, 0.75), back, u(0.028, 0.032), wood))
        )
    return Cue((*head, *shaft), u(0.3, 0.5))


def _material(E: float, ratio: float, rho: float) -> Material:
    return Material(E, E / ratio, rho)


@cache
def cues() -> dict[str, Cue]:
    """The cues of meshes/, and the random ones by number."""
    draw = np.random.default_rng(SEED)
    return {**{name: common.cue(name) for name in common.NAMES}, **{str(i): random_cue(draw) for i in range(RANDOM)}}


def metal(cue: Cue) -> bool:
    """Whether the tip is of brass."""
    return cue.segments[0].material == BRASS


def kept(found: Modes, count: int) -> Modes:
    """The lowest of the modes, ended by a tail."""
    return tail(replace(found, frequencies=found.frequencies[:count], vectors=found.vectors[:, :count]))


def stick_impulses(tip: TipModes, limit: StickLimit, times: np.ndarray) -> np.ndarray:
    """J of a tip that sticks, kg, at all contact times: `damped.stick_impulse` from one diagonalisation."""
    omega, phi, rigid = flexible(tip)
    moving = (tip.amplitude[:, 1] != 0) & (tip.omega > 0)
    n, row = len(omega), np.concatenate([np.zeros(len(omega)), phi, [np.sqrt(rigid)]])
    A = np.zeros((2 * n + 1, 2 * n + 1))
    A[:n, n : 2 * n], A[n : 2 * n, :n] = np.diag(omega), -np.diag(omega)
    A[n : 2 * n, n : 2 * n] = -tip.resistance[np.ix_(moving, moving)]
    total = row @ row + limit.c
    pull = -(row @ A) / total
    rates, vectors = np.linalg.eig(A + np.outer(row, pull))
    rates = np.where(abs(rates) < 1e-12 * abs(rates).max(), 1e-3, rates)  # the tip and ball as they rest
    start, weights = np.linalg.solve(vectors, row) / total, pull @ vectors
    e, found = limit.e, []
    for T in times:
        peak = T / (1 + e)
        a, grown = np.pi / 2 / peak, np.exp(rates * peak)
        height = limit.K * a / (1 + e)
        y = start * (height * a * (grown - rates / a) / (rates**2 + a**2) - grown)
        a, rest, grown = a / e, T - peak, np.exp(rates * (T - peak))
        y = grown * y + start * height * (a - rates * np.cos(a * rest) + rates * grown) / (rates**2 + a**2)
        assert rest > 0
        found.append(float((limit.K - 1) / total + (weights @ ((y + start * (1 - limit.K)) / rates)).real))
    return np.array(found)


class Stuck(NamedTuple):
    """Relative errors of the stick end mass at all contact times, and the estimate that goes with the number."""

    errors: np.ndarray
    estimate: float


@cache
def stuck(name: str) -> Stuck:
    """The default's fewest modes against many."""
    cue, index = cues()[name], list(cues()).index(name)
    times = np.random.default_rng([SEED, index]).uniform(SHORTEST, LONGEST, TIMES)
    scene = common.scene(cue)
    limit = StickLimit.of(scene)
    found = modes(cue, min(modes_below(cue, 2 * np.pi * HIGHEST), MOST))
    masses = []
    for count in (LEAST_STUCK, len(found.frequencies)):
        tip = tip_modes_from(kept(found, count), scene)
        masses.append(1 / ((limit.K - 1) / stick_impulses(tip, limit, times) - limit.c))
    few = tip_modes_from(kept(found, LEAST_STUCK), scene)
    return Stuck(np.abs(masses[0] / masses[1] - 1), max(ringing(few, replace(limit, T=T)) for T in times[:5]))


@cache
def struck(name: str, count: int, waves: bool) -> np.ndarray:
    """Relative errors of squirt by default, against more modes, at contact times and offsets drawn at random."""
    cue, index = cues()[name], list(cues()).index(name)
    draw = np.random.default_rng([SEED, index, 1])
    found = modes(cue, STRUCK)
    errors = []
    for _ in range(count):
        scene = common.scene(cue, draw.uniform(SHORTEST, LONGEST), draw.uniform(0.05, 0.5))
        scene = replace(scene, effects=(AxialWaves(),) if waves else ())
        exact = strike_modes(scene, tip_modes_from(kept(found, STRUCK), scene)).squirt
        errors.append(abs(strike(scene).squirt / exact - 1))
    return np.array(errors)


def rows() -> list[list[object]]:
    """Cue, quantity, contact times, median, 95 %, largest, per cent; the estimate."""
    groups = [
        *((name, [name]) for name in common.NAMES),
        ("random, no brass", [n for n in list(cues())[5:] if not metal(cues()[n])]),
        ("random, brass tip", [n for n in list(cues())[5:] if metal(cues()[n])]),
    ]
    made = []
    for label, names in groups:
        found = [stuck(name) for name in names]
        told = max(one.estimate for one in found)
        made.append(_row(label, names, "stick end mass", np.concatenate([one.errors for one in found]), told))
    for waves in (False, True):
        for label, names in groups:
            errors = np.concatenate([struck(name, 6 if name in common.NAMES else 1, waves) for name in names])
            made.append(_row(label, names, "squirt, AxialWaves" if waves else "squirt", errors, None))
    return made


def _row(label: str, names: list[str], what: str, errors: np.ndarray, told: float | None) -> list[object]:
    per_cent = (f"{100 * x:.2f}" for x in (np.median(errors), np.quantile(errors, 0.95), errors.max()))
    estimate = "" if told is None else f"{100 * told:.2f}"
    return [what, label, str(len(names)), str(len(errors)), *per_cent, estimate]


def report() -> str:
    """The table."""
    columns = ["what", "cue", "cues", "contact times", "median, %", "95 %, %", "largest, %", "largest estimate, %"]
    return (
        "# How far off is the default?\n\n"
        "Contact times are drawn from 0.5 to 3 ms, offsets of squirt from 0.05 to 0.5. A brass tip rings on the wood at"
        " 100 to 250 kHz,\nabove the modes kept: its stick end mass is off by more than half a percent, and the spread"
        " of `cuefem end-mass` shows it.\nThe modes of the reference end at 150 kHz, where brass still rings: the true"
        " error is larger, but within the estimate.\n\n" + common.table(columns, rows())
    )


if __name__ == "__main__":
    (HERE / "default_accuracy.md").write_text(report(), encoding="utf-8")
