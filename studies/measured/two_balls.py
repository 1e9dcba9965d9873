"""One cue, two balls: does squirt tell a shaft of waves from a lumped end mass?

A heavier ball is pushed aside less by the same end mass, but its contact lasts longer and more of a vibrating shaft
takes part. Over drawn strokes: the logarithm of squirt with a heavy over a light ball of the same size, of the coupled
strike and of the lumped cue with the same squirt on a ball of 170 g. `two_balls.py FILE` prints both of a cue;
`two_balls.py LIGHT HEAVY` reads two measured folders of one cue (`cuefem compare --template`), each with its ball in
measured.toml and its strokes in squirt.csv, and prints which of the two they agree with.
"""

from __future__ import annotations

import math
import sys
from collections.abc import Sequence
from dataclasses import replace
from functools import cache
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

import cuefem as cf
from cuefem.measurements.measured_folder import load_measured
from cuefem.measurements.measurement_types import Squirt
from studies import pages, strokes
from studies.pages import table
from studies.strokes import NAMES, cue, drawn_stroke, full_model, lumped_squirt, own_stroke, pool_scene, pool_stroke
from tests.oracle.small_steps import solve_small_steps

LIGHT, USUAL, HEAVY = 0.156, 0.170, 0.200  # kg
COUNT, SEED = 40, 1
SCATTER = 0.09  # of one stroke of the robot (squirt.md)
SURE = 1.645  # standard deviations: wrong in 5 % of cases on either side
TIME = 1.2e-3  # s, of the spring tip on a ball of 170 g


def on_ball(struck: cf.Scene, mass: float) -> cf.Scene:
    """The scene with a ball of another mass, kg; the tip stays."""
    return replace(struck, ball=replace(struck.ball, mass=mass))


class Ratio(NamedTuple):
    """Logarithm of squirt with the heavy over the light ball: of the coupled strike and of the lumped cue."""

    waves: float
    lumped: float

    @property
    def gap(self) -> float:
        """What distinguishes the two."""
        return self.waves - self.lumped


@cache
def ratio(struck: cf.Scene, light: float = LIGHT, heavy: float = HEAVY) -> Ratio:
    """Both logarithms of a stroke."""
    few, usual, many = (float(cf.strike(on_ball(struck, mass)).squirt) for mass in (light, USUAL, heavy))
    end_mass = equal_end_mass(on_ball(struck, USUAL), usual)
    less, more = (lumped_squirt(on_ball(struck, mass), end_mass) for mass in (light, heavy))
    return Ratio(math.log(many / few), math.log(more / less))


def equal_end_mass(struck: cf.Scene, squirt: float) -> float:
    """The end mass of the lumped cue with this squirt, rad, if its tip sticks, kg (Kim's law, by A.31 at e = 0)."""
    low, high = 1e-4, 0.1
    for _ in range(40):
        middle = math.sqrt(low * high)
        low, high = (middle, high) if lumped_squirt(struck, middle) < squirt else (low, middle)
    return low


def closed_form(end_mass: float, light: float = LIGHT, heavy: float = HEAVY, inertia: float = 0.4) -> float:
    """The logarithm of a lumped cue in [A.31] at small offsets: squirt ~ 1/(1 + 1/nu + M/m_e)."""
    few, many = (1 + 1 / inertia + mass / end_mass for mass in (light, heavy))
    return math.log(few / many)


@cache
def drawn() -> list[Ratio]:
    """Both logarithms of drawn strokes."""
    draw = np.random.default_rng(SEED)
    return [ratio(drawn_stroke(draw)) for _ in range(COUNT)]


@cache
def variants() -> dict[str, list[float]]:
    """ln of the coupled ratio of the maple shaft with one input changed."""
    maple = cue("pool_maple")
    heavier, lighter = (replace(maple, body_mass=mass) for mass in (0.38, 0.48))
    scenes = {
        "speed 1, 2, 4 m/s": [full_model(maple, 0.3, speed) for speed in (1.0, 2.0, 4.0)],
        "leather 80, 150, 300 MPa": [full_model(maple, 0.3, E=E) for E in (80e6, 150e6, 300e6)],
        "tip 4, 6, 8 mm high": [full_model(maple, 0.3, height=height) for height in (4e-3, 6e-3, 8e-3)],
        "dome 7, 9.5, 15 mm": [full_model(maple, 0.3, dome_radius=radius) for radius in (7e-3, 9.5e-3, 15e-3)],
        "b/R 0.1, 0.3, 0.45": [full_model(maple, offset) for offset in (0.1, 0.3, 0.45)],
        "butt 380, 480 g": [full_model(each, 0.3) for each in (heavier, lighter)],
        "maple, bored, carbon, whole cue": [full_model(cue(name), 0.3) for name in NAMES if name != "kim"],
    }
    return {name: [ratio(scene).waves for scene in group] for name, group in scenes.items()}


@cache
def check() -> tuple[float, float]:
    """ln of the ratio on maple with a spring tip of one stiffness: coupled strike, and oracle in small steps."""
    results = []
    for mass in (LIGHT, HEAVY):
        base = pool_scene(strokes.plain_maple(), TIME, 0.3, (strokes.DOME, strokes.SHEAR))
        heavier = on_ball(base, mass)
        time = TIME * math.sqrt(heavier.reduced_mass / base.reduced_mass)
        scene = replace(heavier, tip=replace(heavier.tip, contact_time=time))
        results.append((float(cf.strike(scene).squirt), solve_small_steps(scene, 150, 1000).squirt))
    (few, stepped_few), (many, stepped_many) = results
    return math.log(many / few), math.log(stepped_many / stepped_few)


def needed_strokes(gap: float, scatter: float = SCATTER) -> int:
    """Strokes with each ball until the midpoint of both is `SURE` away from either."""
    return math.ceil(2 * (2 * SURE * scatter / gap) ** 2)


def row(name: str, values: Sequence[float]) -> list[str]:
    """Median, 95 % and n of logarithms, as changes in %."""
    low, middle, high = (100 * math.expm1(x) for x in np.percentile(values, [2.5, 50, 97.5]))
    return [name, f"{middle:+.1f} %", f"{low:+.1f} to {high:+.1f} %", str(len(values))]


def text() -> str:
    found = drawn()
    gaps = [each.gap for each in found]
    gap, low = float(np.median(gaps)), float(np.percentile(gaps, 5))
    coupled, oracle = check()
    maple = ratio(full_model(cue("pool_maple"), 0.3))
    widest = max(100 * (max(values) - min(values)) for values in variants().values())
    masses = f"{1e3 * LIGHT:g} g to {1e3 * HEAVY:g} g"
    rows = [
        [name, ", ".join(f"{100 * math.expm1(x):+.1f} %" for x in values), f"{100 * (max(values) - min(values)):.1f} %"]
        for name, values in variants().items()
    ]
    return pages.page(
        "One cue, two balls",
        "Does squirt with two balls of different mass tell a vibrating shaft from a lumped end mass?",
        f"Yes. From a ball of {masses}, squirt falls by "
        f"{-100 * math.expm1(np.median([f.waves for f in found])):.0f} % "
        f"if the shaft vibrates and by {-100 * math.expm1(np.median([f.lumped for f in found])):.0f} % if it is an "
        f"end "
        f"mass (medians of {COUNT} drawn strokes); no input of the maple shaft that we changed moves the first "
        f"number by "
        f"more than {widest:.0f} %. {needed_strokes(gap)} strokes with each ball distinguish the two with 5 % of "
        f"errors if one stroke scatters by "
        f"{100 * SCATTER:.0f} %; {needed_strokes(low)} suffice for 95 % of the shafts.",
        "## Why",
        "An end mass m_e gives a ball of mass M the squirt ψ = (b/νR)/(1 + 1/ν + M/m_e) at small offsets ([A.31]). "
        f"For 8 g it changes by {100 * math.expm1(closed_form(8e-3)):+.1f} % from {masses}. A vibrating shaft has "
        f"no fixed m_e: "
        "a heavier ball stays on the tip for longer, T ~ √(reduced mass), and waves reach more of the shaft, m_e ~ "
        "√T. The moment of "
        "the force on the tip's dome adds squirt in proportion to the force, which grows with the ball's mass.",
        table(
            ["change of squirt", "median", "95 %", "n"],
            [
                row("vibrating shaft", [f.waves for f in found]),
                row("lumped end mass of equal squirt at 170 g", [f.lumped for f in found]),
                row("first over second", gaps),
            ],
        ),
        "Drawn strokes: shafts of 1 to 4 pieces, wood or carbon, solid or bored, 1 to 4 m/s, b/R 0.2 to 0.4, "
        "leather of 80 to 300 MPa, "
        "4 to 8 mm high, dome 8.95 to 10.6 mm.",
        "![both changes over drawn strokes](two_balls.svg)",
        "## Bound: what else moves the ratio, maple shaft, b/R 0.3",
        table(["input", "change of squirt", "range"], rows),
        f"The lumped cue of equal squirt changes by {100 * math.expm1(maple.lumped):+.1f} %. A spring tip of one "
        f"stiffness with dome and compliance: "
        f"ln ratio {coupled:+.4f} by `cf.strike`, {oracle:+.4f} by the independent oracle (scikit-fem's beam, "
        "150 modes, small steps).",
        "## Experiment",
        "1. Weigh two balls of one diameter: an ordinary cue ball (156 to 170 g) and a heavier one (about 200 g, "
        "sold for coin-operated tables; "
        "this mass has no source, so weigh it).\n"
        "2. `cuefem compare light --template` and `cuefem compare heavy --template` create two folders. Put the "
        "same cue.toml and measured.toml "
        "into both, with each ball's mass.\n"
        "3. Strike both balls in turn at one offset from left and right at one speed, and write squirt into "
        "squirt.csv.\n"
        "4. `python -m studies.measured.two_balls light heavy` prints the measured ratio beside both predictions.",
        "Balls in turn, with one tip, cancel chalk, cloth and the zero of the aim to first order. Different "
        "diameters or "
        "finishes do not cancel.",
    )


def draw(axes: Any) -> None:
    """Both logarithms of drawn strokes, as changes in %."""
    found = sorted(drawn(), key=lambda each: each.lumped)
    axes.plot([100 * math.expm1(f.waves) for f in found], "o", ms=4, label="vibrating shaft")
    axes.plot([100 * math.expm1(f.lumped) for f in found], "s", ms=4, label="lumped end mass of equal squirt at 170 g")
    axes.set(xlabel="drawn stroke", ylabel=f"change of squirt from {1e3 * LIGHT:g} g to {1e3 * HEAVY:g} g, %")
    axes.legend(fontsize=8)


def answer(path: str) -> str:
    """Both predictions of a cue's stroke."""
    both = ratio(own_stroke(path))
    return (
        f"squirt from a ball of {1e3 * LIGHT:g} g to {1e3 * HEAVY:g} g: {100 * math.expm1(both.waves):+.1f} % if "
        f"the shaft vibrates, "
        f"{100 * math.expm1(both.lumped):+.1f} % as an end mass; {needed_strokes(both.gap)} strokes with each ball"
    )


class Reading(NamedTuple):
    """Squirt of a folder by offset: value and standard deviation, rad; and its scene."""

    scene: cf.Scene
    squirts: dict[float, tuple[float, float]]


def read(folder: str) -> Reading:
    """Squirt in a measured folder; ValueError if it has none."""
    made, _ = load_measured(Path(folder))
    squirts = {m.offset: (m.measured_value, m.sd) for m in made.measurements if isinstance(m, Squirt)}
    if not squirts:
        raise ValueError(f"{folder} has no squirt; write its strokes into {folder}/squirt.csv")
    return Reading(pool_stroke(made.scene), squirts)


def result(light: str, heavy: str) -> str:
    """The measured ratio of two folders beside both predictions."""
    few, many = read(light), read(heavy)
    common = sorted(set(few.squirts) & set(many.squirts))
    masses = few.scene.ball.mass, many.scene.ball.mass
    if not common:
        raise ValueError(f"squirt.csv of {light} and {heavy} have no offset in common; strike both balls at one offset")
    if masses[1] < 1.05 * masses[0]:
        raise ValueError(
            f"ball.mass of {heavy} must be at least 5 % more than {1e3 * masses[0]:g} g; got {1e3 * masses[1]:g} g"
        )
    logs, weights, waves, lumped = [], [], [], []
    for offset in common:
        (a, da), (b, db) = few.squirts[offset], many.squirts[offset]
        both = ratio(strokes.at_offset(few.scene, offset), *masses)
        logs.append(math.log(b / a))
        weights.append(1 / ((da / a) ** 2 + (db / b) ** 2))
        waves.append(both.waves)
        lumped.append(both.lumped)
    measured, shaft, mass = (float(np.average(values, weights=weights)) for values in (logs, waves, lumped))
    error = 1 / math.sqrt(sum(weights))
    nearer = "a vibrating shaft" if abs(measured - shaft) < abs(measured - mass) else "an end mass"
    verdict = f"nearer to {nearer}" if abs(shaft - mass) > 2 * SURE * error else "not decided"
    return (
        f"ln of squirt, {1e3 * masses[1]:g} g over {1e3 * masses[0]:g} g: measured {measured:+.3f} ± {error:.3f}; "
        f"vibrating shaft {shaft:+.3f}, end mass {mass:+.3f}: {verdict}"
    )


EXAMPLE = """\
from dataclasses import replace
import cuefem as cf

scene = cf.load_scene("meshes/pool_maple.toml")
for grams in (156, 170, 187, 200):
    struck = replace(scene, ball=replace(scene.ball, mass=grams / 1000))
    lumped = replace(struck, cue=cf.LumpedCue(0.57, 0.008), effects=())
    print(f"{grams} g: {cf.strike(struck).squirt:.4f} rad, end mass of 8 g {cf.impulse(lumped).squirt:.4f} rad")
"""
STUDY = pages.Study(__file__, text, {"two_balls.svg": pages.Figure(draw)}, example=EXAMPLE)

if __name__ == "__main__":
    pages.run(STUDY, result if len(sys.argv) > 2 else answer)
