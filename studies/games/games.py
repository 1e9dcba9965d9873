"""How well does a strike table reproduce the coupled strike, and where does pooltool's own strike differ from it?

The tables are those of `cuefem strike FILE --format table` for two cues of meshes/ with pool's default tip. pooltool
0.6.0 strikes by two formulas, repeated here and compared with the program by tests/analysis/test_strike_table.py: a
point impact without loss, v/V = 2/(1 + m/M + (5/2) a^2) and spin R w/V = (5/2) a v/V [Alciatore A.30], turned by the
squirt of [A.31] with the end mass of its cue.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from functools import cache
from typing import Any

import numpy as np

import cuefem as cf
from cuefem.analysis.strike_grid import FIELDS, Strikes, within_tolerance
from cuefem.analysis.strike_table import StrikeTable
from cuefem.results.closed_forms import alciatore_a31
from studies.pages import Figure, Study, page, table
from studies.strokes import at_offset, cue, full_model

NAMES = {"pool_maple": "plain maple", "pool_hollow": "low deflection, bored"}
STROKES = ((0.1, 2.0), (0.3, 0.5), (0.3, 2.0), (0.3, 7.0), (0.5, 0.5), (0.5, 2.0), (0.5, 7.0))  # b/R, m/s
DEFAULT_END_MASS = 0.170097 / 30  # kg, of pooltool's cue
RANDOM = 2000  # strokes
SEED = 1  # other strokes than those that the table is refined by


@cache
def strike_table(name: str) -> StrikeTable:
    """The table of a cue."""
    return cf.strike_table(full_model(cue(name)))


@cache
def errors(name: str) -> np.ndarray:
    """Relative errors of a table at random strokes below the miscue limit, (strokes, fields)."""
    own = strike_table(name)
    return Strikes(own.scene, own.speed).random_errors(own.grid(), RANDOM, SEED)


def pooltool_strike(scene: cf.Scene, end_mass: float = DEFAULT_END_MASS) -> tuple[float, float, float]:
    """Squirt, rad, ball speed over cue speed, and spin R w/V of pooltool's own strike at the scene's offset."""
    a, ball = float(scene.stroke.offset), scene.ball
    ratio = 2 / (1 + ball.mass / scene.axial_mass + 2.5 * a**2)
    return float(alciatore_a31(a, mass_ratio=ball.mass / end_mass, inertia=0.4)), ratio, 2.5 * a * ratio


def coupled_strike(scene: cf.Scene) -> tuple[float, float, float]:
    """The same of the coupled strike."""
    outcome, speed = cf.strike(scene), float(scene.stroke.speed)
    return outcome.squirt, outcome.ball_speed / speed, outcome.spin * scene.ball.radius / speed


@cache
def ratios(offset: float, speed: float) -> tuple[float, float, float, float]:
    """Squirt, rad, of plain maple, and pooltool's squirt, ball speed and spin over those of the coupled strike."""
    scene = full_model(cue("pool_maple"), offset, speed)
    own, theirs = coupled_strike(scene), pooltool_strike(scene)
    squirt, ball_speed, spin = (theirs[k] / own[k] for k in range(3))
    return own[0], squirt, ball_speed, spin


def largest(field: int, sign: int = 1) -> str:
    """The largest difference of a ratio from 1 in one direction, %."""
    return f"{100 * (max(sign * ratios(*stroke)[field] for stroke in STROKES) - sign):.0f} %"


def error_rows() -> Iterator[list[Any]]:
    """A row for each cue."""
    for name, label in NAMES.items():
        own, error = strike_table(name), errors(name)
        cells = [f"{len(own.share)} × {len(own.speed)}", f"{100 * within_tolerance(error):.1f}"]
        for k in range(len(FIELDS)):
            median, most = 100 * np.quantile(error[:, k], [0.5, 0.99])
            cells.append(f"{median:.2f}, {most:.2f}, {100 * error[:, k].max():.2f}")
        yield [label, *cells]


@cache
def text() -> str:
    """The page."""
    rows = []
    for offset, speed in STROKES:
        squirt, *others = ratios(offset, speed)
        angles = (f"{math.degrees(angle):.2f}" for angle in (squirt, squirt * others[0]))
        rows.append([f"{offset:g}", f"{speed:g}", *angles, *(f"{100 * (ratio - 1):+.0f}" for ratio in others)])
    worst = max(float(errors(name).max()) for name in NAMES)
    fewest = min(within_tolerance(errors(name)) for name in NAMES)
    return page(
        "A strike table for games",
        "How well does a strike table reproduce the coupled strike, and where does pooltool's own strike differ?",
        f"A table is within 1 % for {100 * fewest:.1f} % of {RANDOM} random strokes below the miscue limit (largest "
        f"error {100 * worst:.1f} %). pooltool's point impact without loss has up to {largest(2)} more ball speed, "
        f"{largest(3)} more spin and {largest(1, -1)} less squirt, and no miscue.",
        f"Error of interpolation, % of squirt, ball speed and spin (median, 99 %, largest) of {RANDOM} random strokes, "
        "0.2 to 10 m/s, drawn evenly in the share of the miscue limit and in the logarithm of the cue speed:",
        table(["cue", "shares × speeds", "within 1 %, %", "squirt", "ball speed", "spin"], error_rows()),
        "The largest errors are beside a kink of squirt inside partial slip, which moves with the speed. The table has "
        "finer cells there.",
        "Plain maple shaft, pool's default tip: squirt of the coupled strike, of pooltool's own strike with its "
        f"default end mass of {1e3 * DEFAULT_END_MASS:.2f} g, and by how much its squirt, speed and spin are larger:",
        table(["b/R", "m/s", "squirt, °", "pooltool, °", "squirt, %", "ball speed, %", "spin, %"], rows),
        "![Squirt and ball speed of the coupled strike and of pooltool](games.svg)",
        "pooltool_model.py is a stick-ball collision for pooltool that reads the table; strike_table.mjs (a module) "
        "and strike_table.js (a script) read it in JavaScript. pooltool's `a` is positive to the left, cuefem's offset "
        "to the right: angles and spin change their signs. A stroke above the miscue limit leaves as at the limit, and "
        "`miscue` is set; a softer or harder one than the table's reads its nearest row, and `clamped` is set. The "
        "file's block `pooltool` has `CueSpecs` and `BallParams`: with its end mass pooltool's own strike has the "
        "squirt of the file's example.",
        "pooltool_model.py needs pooltool 0.6.0. pip chooses 0.3.3, since 0.6.0 pins a build of panda3d that PyPI has "
        "not; install it without its pins, then what it imports: `pip install --no-deps pooltool-billiards==0.6.0`, "
        "then `pip install scipy attrs 'rich<15' numba numpy-quaternion panda3d panda3d-gltf panda3d-simplepbr pillow "
        "cattrs msgpack msgpack-numpy pyyaml h5py h11 click`.",
    )


def draw(axes: Any) -> None:
    """Squirt and ball speed of plain maple against b/R."""
    own = strike_table("pool_maple")
    for speed, colour in ((0.5, "C0"), (2.0, "C1"), (7.0, "C2")):
        offsets = np.linspace(0.01, own.grid().limit_at(speed), 60)
        read = [own.at(speed, float(offset)) for offset in offsets]
        axes[0].plot(offsets, np.degrees([stroke.squirt for stroke in read]), colour, label=f"{speed:g} m/s")
        axes[1].plot(offsets, [stroke.ball_speed / speed for stroke in read], colour, label=f"{speed:g} m/s")
    offsets = np.linspace(0.01, 0.7, 60)
    theirs = np.array([pooltool_strike(at_offset(own.scene, float(offset))) for offset in offsets])
    axes[0].plot(offsets, np.degrees(theirs[:, 0]), "k--", label="pooltool")
    axes[1].plot(offsets, theirs[:, 1], "k--", label="pooltool")
    axes[0].set(xlabel="tip offset b/R", ylabel="squirt, °")
    axes[1].set(xlabel="tip offset b/R", ylabel="ball speed over cue speed")
    axes[0].legend()


EXAMPLE = """\
import cuefem as cf

table = cf.strike_table(cf.load_scene("plain maple"), (1.0, 4.0))
read = table.at(speed=2.0, offset=0.5)
print(f"{read.squirt:.3f} rad, {read.ball_speed:.2f} m/s, {read.spin:.0f} rad/s")
print(f"{100 * table.error['within']:.0f} % of strokes within 1 %")
"""
STUDY = Study(__file__, text, {"games.svg": Figure(draw, (1, 2), (8.4, 3.8))}, example=EXAMPLE)

if __name__ == "__main__":
    STUDY.write()
