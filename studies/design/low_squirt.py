"""What lowers the squirt of a shaft, and how much stiffness does that cost?

The stick end mass and the small-offset squirt at T = 1 ms (`cuefem.batch_stick`), the static tip stiffness with the
joint clamped. The first table changes one thing at a time on the hollow-front shaft of meshes/; the second compares the
shafts of meshes/ by the coupled strike at b/R = 0.3, bare and with dome and shear of the tip. The third has the shaft
of least squirt among those as stiff as the solid one (optimum.toml), found by gradients and by a quasi-random search,
and then struck. The figure has Pareto fronts of squirt against stiffness and mass (`front`, NSGA-II of pymoo, within 5
%) over bore, depth, ferrule, tip diameter and taper, and over the walls of the carbon tube. Last LeatherTip on these
shafts. About 60 s.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from functools import cache
from typing import Any

import numpy as np

from cuefem import Cue, CueBatch, Resolution, Scene, Stroke, Tip, TipDome, TipShear, batch_stick, resolve, strike
from cuefem.design import Response, Span, Vary
from cuefem.design.optimum import Limit, Problem, front, optimum, search
from cuefem.io.study_files import load_optimum
from studies import pages
from studies.measured import pool
from studies.pages import STUDIES, predictions, table
from studies.strokes import CAROM, cue, scene

AT = Resolution(2, 14, 40)
COARSE = Resolution(1, 6, 8)  # ranks designs; the front's points are computed again at AT
SHAFTS = {"pool_maple": "solid pro taper", "pool_hollow": "hollow front", "carbon": "carbon tube"}
OFFSET, SMALL = 0.3, 0.01
OPTIMUM = "least squirt, by exact gradients"
SEARCHED = 10_000
TIP = (TipDome(9.5e-3), TipShear(0.75))
WALLS = (0.001, 0.002, 0.003)
SQUIRT, STIFFNESS, MASS, WALL = map(Response, ("squirt_slope", "tip_stiffness", "shaft_mass", "wall"))
# What LeatherTip alone should say, from leather_tip.md of then, written down before it was run here. Not to be changed.
PREDICTED = {"hollow front to solid at b/R 0.3": "0.78", "carbon tube to solid": "0.80", "optimum to solid": "0.60"}


@cache
def carbon() -> Problem:
    """The carbon tube: its wall at the tip end, at the joint, and how wide it is in front."""

    def vary(name: str, low: float, high: float, *fields: str) -> Vary:
        return Vary(tuple(f"cue.segments{field}" for field in fields), Span(low, high), name)

    ends = [f"[{i}].{end}_diameter" for i in (0, 1, 2) for end in ("tip", "butt")]
    moved = (
        vary("bore in front", 0.006, 0.0122, "[2].tip_bore", "[2].butt_bore", "[3].tip_bore"),
        vary("bore at the joint", 0.013, 0.019, "[3].butt_bore", "[4].tip_bore", "[4].butt_bore"),
        vary("diameter in front", 0.011, 0.0135, *ends, "[3].tip_diameter"),
    )
    return Problem(scene(cue("carbon")), moved, SQUIRT, (Limit(WALL, low=0.0006),), COARSE)


STEPS = {"bore": 1e-3, "bore depth": 0.0254, "ferrule length": 0.005, "tip diameter": 5e-4, "end of the taper": 1e-3}


@cache
def wanted() -> Problem:
    """As stiff as the solid shaft, walls of 2 mm, at the coarse resolution: what `cuefem optimize` is shown on."""
    return load_optimum(STUDIES / "design" / "optimum.toml")


def design() -> Problem:
    return replace(wanted(), limits=(Limit(WALL, low=0.001),), at=AT)


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
    for k, (name, step) in enumerate(STEPS.items()):
        point = design().start
        point[k] += step
        yield row(name, f"+{1e3 * step:g} mm", design().scene(point).cue)
    tip, ferrule, *rest = hollow.segments
    heavier = replace(ferrule, material=replace(ferrule.material, rho=1.5 * ferrule.material.rho))
    grams = 1e3 * (heavier.mass - ferrule.mass)
    yield row("ferrule mass", f"+{grams:.2f} g", replace(hollow, segments=(tip, heavier, *rest)))


def shafts() -> Iterator[list[str | float]]:
    def squirts(name: str) -> tuple[float, float]:
        struck = scene(cue(name), offset=OFFSET)
        return strike(struck).squirt, strike(replace(struck, effects=TIP)).squirt

    solid = squirts("pool_maple")
    for name, words in SHAFTS.items():
        both = squirts(name)
        told = ((float(np.degrees(one)), one / of) for one, of in zip(both, solid, strict=True))
        yield [words, *measures(cue(name)), *(number for pair in told for number in pair)]


def optima() -> list[list[str | float]]:
    return [searched(), by_gradients()]


def searched() -> list[str | float]:
    asked = wanted()
    points, squirt, within = search(asked, SEARCHED, seed=7)
    best = int(np.where(within, squirt, np.inf).argmin())
    return ["best of a quasi-random search", str(SEARCHED), *_checked(asked.scene(points[best]).cue, squirt[best]), ""]


def by_gradients() -> list[str | float]:
    found = optimum(wanted())
    held = ", ".join(found.active)
    return ["by exact gradients", str(found.evaluations), *_checked(found.scene.cue, found.value), held]


def _checked(made: Cue, squirt: float) -> list[float]:
    """Squirt as it was sought, of the batch at `AT`, and of the coupled strike at a small and an ordinary offset."""
    _, slope, stiffness = measures(made)
    small = scene(made, offset=SMALL)
    phi = np.arcsin(SMALL)
    coupled = [strike(small).squirt / phi, resolve(small, 1e-3).squirt / phi]
    far = float(np.degrees(strike(scene(made, offset=OFFSET)).squirt))
    return [stiffness, float(squirt), slope, *map(float, coupled), far]


def text() -> str:
    columns = ["end mass, g", "squirt/φ, b → 0", "tip stiffness, N/m"]
    first = table(["change", "by", *columns, "squirt, %", "stiffness, %"], changes())
    struck = ["squirt at b/R 0.3, °", "to solid", "with dome and shear, °", "to solid"]
    second = table(["shaft", *columns, *struck], shafts())
    sought = ["evaluations", "tip stiffness, N/m", "squirt/φ sought", "batch, fine", "strike, b/R 0.01", "resolve"]
    third = table(["least squirt", *sought, "squirt at b/R 0.3, °", "held by (SI)"], optima())
    limits = ", ".join(f"{limit.response.name} >= {limit.low:g}" for limit in wanted().limits)
    return (
        f"# Shafts of little squirt\n\nT = 1 ms, bare. {CAROM}\n\n{first}\n{second}\n"
        "Least squirt of bore, depth, ferrule, tip "
        f"and taper with {limits} (SI); squirt is over φ at small offsets.\n\n{third}"
    )


@cache
def leather_squirt(shaft: Cue) -> tuple[float, float, float]:
    """Squirt at OFFSET, deg: bare, with dome and shear (1 ms), and the whole stroke at 2 m/s."""
    struck = scene(shaft, offset=OFFSET)
    modern = Scene(
        pool.without_leather(shaft),
        tip=Tip(pool.TIP_RESTITUTION, pool.FRICTION),
        stroke=Stroke(pool.SPEED, OFFSET),
        effects=(pool.LEATHER, *pool.WHOLE),
    )
    return tuple(float(np.degrees(strike(s).squirt)) for s in (struck, replace(struck, effects=TIP), modern))  # type: ignore[return-value]


def leather_shafts() -> dict[str, Cue]:
    """The shafts, the hollow one with the bore that its stiffness asks for, and the optimum."""
    bored = {f"hollow front, bore {1e3 * bore:g} mm": pool.hollow(bore) for bore in pool.BORES}
    return {**{words: cue(name) for name, words in SHAFTS.items()}, **bored, OPTIMUM: optimum(wanted()).scene.cue}


def leather_rows() -> Iterator[list[str]]:
    shafts = leather_shafts()
    solid = leather_squirt(shafts["solid pro taper"])
    for words, shaft in shafts.items():
        both = zip(leather_squirt(shaft), solid, strict=True)
        yield [words, *(cell for squirt, of in both for cell in (f"{squirt:.2f}", f"{squirt / of:.2f}"))]


def leather_found() -> dict[str, str]:
    """What was found, by the names of PREDICTED."""
    over = {row[0]: row[-1] for row in leather_rows()}
    return dict(zip(PREDICTED, (over["hollow front"], over["carbon tube"], over[OPTIMUM]), strict=True))


def leather_text() -> str:
    """The end of the page: LeatherTip."""
    models = ("bare", "dome and shear", pool.MODERN)
    columns = ["shaft", *(column for model in models for column in (f"{model}, °", "to solid"))]
    return (
        "## LeatherTip beside the patchwork\n\nSquirt at b/R 0.3. What a hollow or light end gains is smaller with any "
        "real tip than bare: the couple of the dome is the same on every shaft, and it is a larger part of a small "
        f"squirt.\n\n{table(columns, leather_rows())}\n" + predictions(PREDICTED, leather_found())
    )


def draw(axes: Any) -> None:
    stiff, heavy = axes
    for wall, colour in zip(WALLS, ("#99bbdd", "#4477aa", "#223355"), strict=True):
        asked = replace(design(), limits=(Limit(WALL, low=wall),), at=COARSE)
        _front(stiff, asked, STIFFNESS, 1e-3, f"maple, wall ≥ {1e3 * wall:g} mm", colour)
        _front(heavy, asked, MASS, 1e3, f"maple, wall ≥ {1e3 * wall:g} mm", colour)
    _front(stiff, carbon(), STIFFNESS, 1e-3, "carbon tube, wall ≥ 0.6 mm", "#cc6644")
    _front(heavy, carbon(), MASS, 1e3, "carbon tube, wall ≥ 0.6 mm", "#cc6644")
    for axis, quantity, scale in ((stiff, "tip_stiffness", 1e-3), (heavy, "shaft_mass", 1e3)):
        for name, mark in zip(SHAFTS, "sD^", strict=True):
            here = scale * float(getattr(CueBatch.of([cue(name)]), quantity)[0]), measures(cue(name))[1]
            axis.plot(*here, mark, ms=9, color="#cc6644" if name == "carbon" else "#4477aa", mec="black")
            axis.annotate(SHAFTS[name], here, xytext=(-8, -12), textcoords="offset points", fontsize=9, ha="right")
        axis.set(ylabel="squirt over φ, small offset", ylim=(0.02, 0.1))
    stiff.set(xlabel="static tip stiffness, N/mm (joint clamped)", title="how stiff can little squirt be?")
    stiff.set(xscale="log", xlim=(0.2, 2.1))
    stiff.set_xticks(ticks := (0.2, 0.3, 0.4, 0.6, 0.8, 1, 1.5, 2), [f"{tick:g}" for tick in ticks], minor=False)
    stiff.set_xticks((), minor=True)
    heavy.set(xlabel="mass of the shaft, g", title="what does little squirt leave of the mass?", xlim=(70, 142))
    heavy.legend(fontsize=8, title="best for given limits (tip 11 to 13.5 mm)", title_fontsize=8, loc="lower right")


def _front(axis: Any, asked: Problem, against: Response, scale: float, label: str, colour: str) -> None:
    points, _ = front(asked, against, size=40, rounds=100)
    fine = replace(asked, at=AT, limits=()).values(points, against)
    axis.plot(scale * fine[:, 1], fine[:, 0], "o-", ms=3, color=colour, label=label)


STUDY = pages.Study(
    __file__,
    lambda: pages.paragraphs(text(), leather_text()),
    {"low_squirt.svg": pages.Figure(draw, (1, 2), (10.4, 5.0))},
    # All but LeatherTip and the quasi-random search, which tests/design/test_optimum_verification.py makes too.
    again={"bare": pages.Again(text, until=pages.LEATHER, left_out=1, instead={"optima": lambda: [by_gradients()]})},
    predicted=PREDICTED,
)


if __name__ == "__main__":
    STUDY.write()
