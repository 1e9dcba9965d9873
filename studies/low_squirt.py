"""What makes a shaft of little squirt: what buys how much squirt for how much stiffness?

The stick end mass and the small-offset squirt at T = 1 ms (`cuefem.batch`), the static tip stiffness with the joint
clamped. The first table changes one thing at a time on the hollow-front shaft of meshes/; the second compares the
shafts of meshes/ by the coupled strike at b/R = 0.3, bare; the figure is the Pareto front over bore, depth, ferrule,
tip diameter and taper (`cuefem.optimum.front`, NSGA-II of pymoo). About 30 s.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from functools import cache

import numpy as np

from cuefem import Cue, Resolution, strike
from cuefem.batch import CueBatch, batch_stick
from cuefem.optimum import Design, Limit, Variable, front
from studies.common import STUDIES, cue, figure, scene, table

AT = Resolution(2, 14, 40)
COARSE = Resolution(1, 6, 8)  # ranks designs; the front's points are computed again at AT
SHAFTS = {"pool_maple": "solid pro taper", "pool_hollow": "hollow front", "carbon": "carbon tube"}
OFFSET = 0.3


def _field(name: str, *segments: int) -> dict[tuple[int, str], float]:
    return {(i, f"{end}_{name}"): 1.0 for i in segments for end in ("tip", "butt")}


@cache
def variables() -> tuple[Variable, ...]:
    """Of pool_hollow: leather, bored ferrule, bored wood, then solid wood to the joint."""
    rows = cue("pool_hollow").segments
    tip, ferrule, front_wood, rear = rows[:4]
    width = {**_field("diameter", 0, 1), (2, "tip_diameter"): 1.0}
    joined = {(3, "butt_diameter"): 1.0, (4, "tip_diameter"): 1.0}
    return (
        Variable("bore", 0.001, 0.009, ferrule.tip_bore, _field("bore", 1, 2)),
        Variable("bore depth", 0.03, 0.25, front_wood.length, {(2, "length"): 1.0, (3, "length"): -1.0}),
        Variable("ferrule length", 0.005, 0.03, ferrule.length, {(1, "length"): 1.0, (2, "length"): -1.0}),
        Variable("tip diameter", 0.011, 0.0135, tip.tip_diameter, width),
        Variable("end of the taper", 0.0122, 0.016, rear.butt_diameter, joined),
    )


STEPS = {"bore": 1e-3, "bore depth": 0.0254, "ferrule length": 0.005, "tip diameter": 5e-4, "end of the taper": 1e-3}


def design() -> Design:
    return Design(scene(cue("pool_hollow")), variables(), (Limit("wall", low=0.001),), AT)


def measures(struck: Cue) -> tuple[float, float, float]:
    """(stick end mass, g; squirt b -> 0 over phi; tip stiffness, N/m)."""
    batch = CueBatch.of([struck])
    end_mass, slope = batch_stick(batch, scene(struck), at=AT)
    return 1e3 * float(end_mass[0]), float(slope[0]), float(batch.tip_stiffness[0])


def changes() -> Iterator[list[str | float]]:
    hollow = cue("pool_hollow")
    base = measures(hollow)

    def row(words: str, by: str, changed: Cue) -> list[str | float]:
        here = measures(changed)
        gained = (f"{100 * (new / old - 1):+.1f}" for new, old in zip(here[1:], base[1:], strict=True))
        return [words, by, *here, *gained]

    yield ["as it is", "", *base, "", ""]
    for k, variable in enumerate(variables()):
        point = design().start
        point[k] += STEPS[variable.name]
        yield row(variable.name, f"+{1e3 * STEPS[variable.name]:g} mm", design().cue(point))
    tip, ferrule, *rest = hollow.segments
    heavier = replace(ferrule, material=replace(ferrule.material, rho=1.5 * ferrule.material.rho))
    grams = 1e3 * (heavier.mass - ferrule.mass)
    yield row("ferrule mass", f"+{grams:.2f} g", replace(hollow, segments=(tip, heavier, *rest)))


def shafts() -> Iterator[list[str | float]]:
    solid = strike(scene(cue("pool_maple"), offset=OFFSET)).squirt
    for name, words in SHAFTS.items():
        squirt = strike(scene(cue(name), offset=OFFSET)).squirt
        yield [words, *measures(cue(name)), float(np.degrees(squirt)), squirt / solid]


def text() -> str:
    columns = ["end mass, g", "squirt/φ, b → 0", "tip stiffness, N/m"]
    first = table(["change", "by", *columns, "squirt, %", "stiffness, %"], changes())
    second = table(["shaft", *columns, "squirt at b/R 0.3, °", "to solid"], shafts())
    return f"# Shafts of little squirt\n\nT = 1 ms, bare.\n\n{first}\n{second}"


def draw() -> None:
    points, _ = front(replace(design(), at=COARSE), "tip_stiffness", size=32, rounds=14)
    squirt, stiffness = (design().quantity(name, points)[:, 0] for name in ("squirt", "tip_stiffness"))
    with figure(STUDIES / "low_squirt.svg") as axis:
        axis.plot(1e-3 * stiffness, squirt, "o-", ms=3, label="best of bore, depth, ferrule, tip, taper")
        for name, mark in zip(SHAFTS, "sD^", strict=True):
            _, slope, stiff = measures(cue(name))
            axis.plot(1e-3 * stiff, slope, mark, ms=8, label=SHAFTS[name])
        axis.set(xlabel="static tip stiffness, N/mm (joint clamped)", ylabel="squirt over φ, small offset")
        axis.legend(fontsize=8)


if __name__ == "__main__":
    (STUDIES / "low_squirt.md").write_text(text(), encoding="utf-8")
    draw()
