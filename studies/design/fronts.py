"""What stiffness costs: the least squirt of a shaft at a static tip stiffness, for bored woods and carbon tubes.

Designs are drawn at random: fronts of four woods, bored as in `studies.design.low_squirt`, and the carbon tube of
meshes/ scaled, with other walls and moduli. Squirt: pool's default stroke at b/R 0.3. Strength: the stress of a stroke
at break speed in the bored front, F/A + F (r b/R + C tan(psi) sqrt(aT))/W. F is the peak force, r b/R its arm on the
tip's dome; the rest is the largest bending moment of a long beam whose free end has a half-sine force F tan(psi),
M(x, t) = sqrt(2a/pi) int F(t - s) sin(x^2/(4 a s))/sqrt(s) ds; its Laplace transform is F exp(-qx) sin(qx)/q.
`fronts.py FILE` places a cue.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from functools import cache
from typing import Any, NamedTuple

import numpy as np

import cuefem as cf
from cuefem.designs import evaluate
from studies import pages, strokes
from studies.design import low_squirt
from studies.pages import table
from studies.strokes import cue, drawn_stroke, full_model, own_stroke, pool_scene
from tests.oracle.small_steps import solve_small_steps

COUNT, SEED, PAIRS = 120, 1, 24  # designs of each material; drawn tips
BREAK = 9.0  # m/s of the cue: a ball of 24 mph (10.7 m/s), Onoda, Billiards Digest, May/June 1989
OFFSET, DOME = 0.3, 9.5e-3
BREAK_OFFSET = 0.1  # b/R of a break that misses the centre by 3 mm
# Strength along the grain at 12 %, MPa, in compression and in bending: [FPL] tables 5-3 and 5-5; of pultruded carbon
# tubes in bending: a vendor's data sheet (goodwinds.com), taken in compression too.
STRENGTH = {
    "hard maple": (54.0, 109.0),
    "ash": (51.1, 103.0),
    "yellow birch": (56.3, 114.0),
    "purpleheart": (71.2, 132.0),
    "carbon tube": (1370.0, 1370.0),
}
WOODS = tuple(STRENGTH)[:4]
BINS = ((230, 310), (310, 390), (390, 600), (600, 900), (900, 1300), (1300, 2500))  # N/m


class Design(NamedTuple):
    """A drawn design: its wall, m, stiffness, N/m, squirt, degrees, and the part of its strength at break speed."""

    material: str
    shaft: cf.Cue
    wall: float
    stiffness: float
    squirt: float
    load: float


def bored(draw: np.random.Generator, wood: str) -> tuple[cf.Cue, float]:
    """A bored front of a wood, and its wall."""
    tip = draw.uniform(11e-3, 13.5e-3)
    wall = draw.uniform(0.8e-3, 4e-3)
    taper = max(tip, draw.uniform(11e-3, 14.3e-3))
    shaft = low_squirt.shaft(tip - 2 * wall, draw.uniform(0.05, 0.25), 13e-3, tip, taper)
    maple = next(s.material for s in shaft.segments if s.material.rho == 705.6)
    pieces = (replace(s, material=cf.material(wood)) if s.material == maple else s for s in shaft.segments)
    return replace(shaft, segments=tuple(pieces)), wall


def tube(draw: np.random.Generator) -> tuple[cf.Cue, float]:
    """The carbon tube of meshes/ scaled, with another wall and modulus."""
    scale, wall, modulus = draw.uniform(0.87, 1.05), draw.uniform(0.5e-3, 2e-3), draw.uniform(60e9, 130e9)
    pieces = []
    for piece in cue("carbon").segments:
        ends = {"tip_diameter": scale * piece.tip_diameter, "butt_diameter": scale * piece.butt_diameter}
        if piece.tip_bore:
            ends |= {"tip_bore": ends["tip_diameter"] - 2 * wall, "butt_bore": ends["butt_diameter"] - 2 * wall}
            ends["material"] = replace(piece.material, E=modulus)
        pieces.append(replace(piece, **ends))
    return replace(cue("carbon"), segments=tuple(pieces)), wall


@cache
def moment_coefficient() -> float:
    """C: the largest bending moment over F sqrt(aT) under a half-sine force at the free end."""
    step = 1.6 / 1600
    time = (np.arange(1600) + 0.5) * step
    force = np.where(time < 1, np.sin(np.pi * time), 0.0)
    largest = 0.0
    for x in np.linspace(0.5, 2.5, 41):
        moment = np.convolve(force, np.sin(x**2 / (4 * time)) / np.sqrt(time))[:1600] * step
        largest = max(largest, float(np.abs(moment).max()))
    return math.sqrt(2 / math.pi) * largest


@cache
def break_force() -> tuple[float, float]:
    """Peak force, N, and contact time, s, of a stroke at break speed on solid maple."""
    outcome = cf.strike(full_model(cue("pool_maple"), OFFSET, BREAK))
    times = np.linspace(0.0, float(outcome.duration), 400)
    return float(outcome.history(times)["force_n"].max()), float(outcome.duration)


def load(shaft: cf.Cue, squirt: float, strength: tuple[float, float]) -> float:
    """Share of the strength of the first long piece in a break; squirt at `OFFSET`, rad."""
    force, time = break_force()
    piece = next(s for s in shaft.segments if s.length > 0.05)
    outer, inner = piece.tip_diameter, piece.tip_bore
    area, modulus = math.pi / 4 * (outer**2 - inner**2), math.pi / 32 * (outer**4 - inner**4) / outer
    section = piece.section(0.0)
    length = math.sqrt(math.sqrt(float(section.EI / section.rhoA)) * time)
    arm = BREAK_OFFSET * (DOME + moment_coefficient() * math.tan(squirt) / OFFSET * length)
    compression, bending = strength
    return 1e-6 * force * (1 / area / compression + arm / modulus / bending)


def solid_load() -> float:
    """Share of the strength that a break uses of the solid maple shaft."""
    shaft = cue("pool_maple")
    return load(shaft, float(cf.strike(full_model(shaft, OFFSET)).squirt), STRENGTH["hard maple"])


def designs_of(material: str, drawn: Sequence[tuple[cf.Cue, float]]) -> list[Design]:
    """Stiffness, squirt and load of shafts."""
    stiffness = evaluate([cf.Scene(shaft) for shaft, _ in drawn], ["tip_stiffness"]).values[:, 0]
    squirts = cf.batch_strike([full_model(shaft, OFFSET) for shaft, _ in drawn]).squirt
    return [
        Design(material, shaft, wall, float(k), math.degrees(psi), load(shaft, float(psi), STRENGTH[material]))
        for (shaft, wall), k, psi in zip(drawn, stiffness, squirts, strict=True)
    ]


@cache
def designs() -> dict[str, list[Design]]:
    """Drawn designs by material."""
    found = {}
    for wood in WOODS:
        draw = np.random.default_rng(SEED)
        found[wood] = designs_of(wood, [bored(draw, wood) for _ in range(COUNT)])
    draw = np.random.default_rng(SEED)
    return found | {"carbon tube": designs_of("carbon tube", [tube(draw) for _ in range(COUNT)])}


def best(material: str, low: float, high: float, *, holds: bool = True) -> Design | None:
    """The least squirt between two stiffnesses; holds: of those whose stress is below their strength."""
    fitting = [d for d in designs()[material] if low <= d.stiffness < high and (d.load <= 1 or not holds)]
    return min(fitting, key=lambda d: d.squirt) if fitting else None


def cell(design: Design | None) -> str:
    """Squirt and wall of a design."""
    return pages.NONE if design is None else f"{design.squirt:.2f}° ({1e3 * design.wall:.1f} mm)"


def front_table() -> str:
    """Least squirt by stiffness."""
    rows = []
    for low, high in BINS:
        cells = [cell(best("hard maple", low, high, holds=False))]
        cells += [cell(best(name, low, high)) for name in designs()]
        rows.append([f"{low} to {high}", *cells])
    return table(["stiffness, N/m", "hard maple, any strength", *(f"{name}, holds" for name in designs())], rows)


def strength_table() -> str:
    """Smallest wall that holds, by material."""
    rows = []
    for name, group in designs().items():
        broken = [d.wall for d in group if d.load > 1]
        kept = [d.wall for d in group if d.load <= 1]
        thinnest = f"{1e3 * min(kept):.1f}" if kept else pages.NONE
        thickest = f"{1e3 * max(broken):.1f}" if broken else pages.NONE
        rows.append([name, *(f"{x:.0f}" for x in STRENGTH[name]), f"{len(kept)} of {len(group)}", thinnest, thickest])
    return table(
        [
            "material",
            "compression, MPa",
            "bending, MPa",
            "designs that hold",
            "thinnest that holds, mm",
            "thickest that fails, mm",
        ],
        rows,
    )


@cache
def ratios() -> list[float]:
    """Squirt of the best carbon tube of 900 to 1300 N/m over the best bored maple of 310 to 390, by drawn tip."""
    stiff, wooden = best("carbon tube", 900, 1300), best("hard maple", 310, 390)
    assert stiff
    assert wooden
    draw = np.random.default_rng(SEED)
    found = []
    for _ in range(PAIRS):
        stroke = drawn_stroke(draw, cue("pool_maple"))
        tubes, wood = (replace(stroke, cue=full_model(d.shaft).cue) for d in (stiff, wooden))
        found.append(float(cf.strike(tubes).squirt / cf.strike(wood).squirt))
    return found


def cantilever(shaft: cf.Cue) -> float:
    """Static tip stiffness by the unit load: 1/k = int x^2/EI + 1/kGA dx, N/m."""
    compliance = 0.0
    for first, piece in zip(shaft.nodes, shaft.segments, strict=False):
        nodes, weights = np.polynomial.legendre.leggauss(40)
        s = piece.length * (nodes + 1) / 2
        section = piece.section(s)
        compliance += float(piece.length / 2 * weights @ ((first + s) ** 2 / section.EI + 1 / section.kGA))
    return 1 / compliance


@cache
def check() -> tuple[float, float, float]:
    """Largest difference of stiffness from the unit load, %; ln of squirt, carbon over maple, coupled and oracle."""
    chosen = [best("carbon tube", 900, 1300), best("hard maple", 310, 390)]
    error = max(abs(cantilever(d.shaft) / d.stiffness - 1) for group in designs().values() for d in group[:20])
    coupled, stepped = [], []
    for design in chosen:
        assert design
        pieces = tuple(replace(s, kappa=0.9, core=None) for s in design.shaft.segments)
        scene = pool_scene(replace(design.shaft, segments=pieces), 1.2e-3, OFFSET, (strokes.DOME, strokes.SHEAR))
        coupled.append(float(cf.strike(scene).squirt))
        stepped.append(solve_small_steps(scene, 150, 1000).squirt)
    return 100 * error, math.log(coupled[0] / coupled[1]), math.log(stepped[0] / stepped[1])


def text() -> str:
    stiff, wooden, any_wall = (
        best("carbon tube", 900, 1300),
        best("hard maple", 310, 390),
        best("hard maple", 310, 390, holds=False),
    )
    assert stiff
    assert wooden
    assert any_wall
    low, middle, high = np.percentile(ratios(), [2.5, 50, 97.5])
    solid = low_squirt.measures(cue("pool_maple"))
    force, _ = break_force()
    error, coupled, stepped = check()
    return pages.page(
        "What stiffness costs",
        "What is the least squirt of a shaft at a stiffness, and what ends it?",
        f"Bored maple of 310 to 390 N/m goes down to {any_wall.squirt:.2f}° at b/R {OFFSET:g} "
        f"(solid: {solid[2]:.2f}° at {solid[0]:.0f} N/m), "
        f"to {wooden.squirt:.2f}° if it survives a break. A carbon tube of 900 to 1300 N/m has "
        f"{stiff.squirt:.2f}°: over drawn tips {middle:.2f} of "
        f"the squirt of the bored maple that holds (95 % {low:.2f} to {high:.2f}, n {PAIRS}), at "
        f"{stiff.stiffness / wooden.stiffness:.1f} times its stiffness. Carbon buys stiffness first, then strength.",
        "## Fronts",
        f"Least squirt in the default stroke at b/R {OFFSET:g} (wall of the front) among {COUNT} drawn designs of "
        f"each material; stiffness at the "
        "tip with the joint clamped. A front of drawn designs lies above the true one; more draws lower it.",
        front_table(),
        "![squirt against stiffness of drawn designs](fronts.svg)",
        "## Strength",
        f"A break of {BREAK:g} m/s (a ball of 24 mph: Onoda, Billiards Digest, 1989) at b/R {BREAK_OFFSET:g} has a "
        f"peak force of "
        f"{force:.0f} N on solid maple with a medium tip. A front holds if compression and bending use up less "
        f"than its strengths:",
        "```text\nF/(A σ_c) + F (r b/R + C tan ψ √(aT))/(W σ_b) < 1,   a = √(EI/ρA)\n```",
        f"r = {1e3 * DOME:g} mm is the dome, tan ψ the transverse over the axial force (squirt), C = "
        f"{moment_coefficient():.3f} the largest bending moment of a long beam under a half-sine force at its free "
        f"end, over "
        f"the force and √(aT). Solid maple of 12.75 mm uses {100 * solid_load():.0f} %. Strengths: of wood along "
        f"the grain at 12 % "
        "(Wood Handbook, tables 5-3 and 5-5, short tests of minutes; in milliseconds wood is stronger), of "
        "pultruded carbon tubes in "
        "bending (a vendor's data sheet, goodwinds.com; no source for thin walls in compression). Splitting of a "
        "bored end and "
        "crushing by the ferrule have no source and are left out.",
        "The criterion is a judgement, and the numbers of what holds depend on it. A first one, a break at b/R 0.3 "
        "with all stress against the strength in compression, is stricter than practice: by it no maple of this "
        "stiffness holds, nor does the solid shaft.",
        strength_table(),
        "## Brands",
        "No maker publishes stiffness, walls or moduli, so that a brand has a squirt but no place on the axis of "
        "stiffness. Measured squirt "
        "([squirt](../measured/squirt.md)) in proportion to b/R: Predator Z 1.19°, Players maple 1.84 to 1.94°, "
        "Stinger 2.70° at b/R 0.3. The first lies below every "
        "bored maple that holds here, and within the front of carbon tubes; a filled bore, which this bound leaves "
        "out, may "
        "be why.",
        "## Check",
        f"Stiffness by the unit load, ∫x²/EI + 1/κGA dx, differs by at most {error:.2g} % (100 designs). With a "
        f"spring tip, ln of squirt of the carbon tube over the "
        f"maple is {coupled:+.4f} by `cf.strike` and {stepped:+.4f} by the independent oracle (scikit-fem's beam, "
        "150 modes, small steps).",
        "## Measurement",
        "Clamp the joint, hang 1 kg at the ferrule and read the deflection (9.8 N over 350 N/m: 28 mm; over 1,000 "
        "N/m: 10 mm), and measure squirt of "
        "the same shaft: five shafts of each kind place the brands. Crush a bored front on a press: its strength "
        "over the block's decides where the front of wood ends.",
    )


def draw(axes: Any) -> None:
    """Squirt against stiffness."""
    for index, (name, group) in enumerate(designs().items()):
        for holds, marker in ((True, "o"), (False, "x")):
            chosen = [d for d in group if (d.load <= 1) == holds]
            label = f"{name}, {'holds' if holds else 'breaks'} at {BREAK:g} m/s"
            if chosen and (index in (0, 4) or holds):
                axes.plot(
                    [d.stiffness for d in chosen], [d.squirt for d in chosen], f"C{index}{marker}", ms=3, label=label
                )
    solid = low_squirt.measures(cue("pool_maple"))
    axes.plot(solid[0], solid[2], "ks", label="solid maple")
    axes.set(xlabel="static tip stiffness, N/m", ylabel=f"squirt at b/R {OFFSET:g}, degrees", xscale="log")
    axes.set_xticks([300, 400, 600, 1000, 2000], ["300", "400", "600", "1000", "2000"])
    axes.set_xticks([], minor=True)
    axes.legend(fontsize=7)


def answer(path: str) -> str:
    """Stiffness and squirt of a cue, and the least squirt of both materials at its stiffness."""
    struck, loaded = own_stroke(path), cf.load(path)
    drawn = loaded.cue if isinstance(loaded, cf.Scene) else loaded  # with its leather, as the designs
    stiffness = float(evaluate([cf.Scene(drawn)], ["tip_stiffness"]).values[0, 0])
    squirt = math.degrees(cf.strike(strokes.at_offset(struck, OFFSET)).squirt)
    near = [best(name, 0.85 * stiffness, 1.15 * stiffness) for name in ("hard maple", "carbon tube")]
    return (
        f"{stiffness:.0f} N/m, squirt {squirt:.2f}° at b/R {OFFSET:g}; least at this stiffness ± 15 %: bored maple "
        f"{cell(near[0])}, carbon tube {cell(near[1])}"
    )


EXAMPLE = """\
import cuefem as cf
from cuefem.designs import evaluate

for name in ("pool_maple", "pool_hollow", "carbon"):
    shaft = cf.load_cue(f"meshes/{name}.toml")
    stiffness = evaluate([cf.Scene(shaft)], ["tip_stiffness"]).values[0, 0]
    squirt = cf.strike(cf.usual_scene(shaft)).squirt
    print(f"{name}: {stiffness:.0f} N/m, {squirt:.4f} rad")
"""
STUDY = pages.Study(__file__, text, {"fronts.svg": pages.Figure(draw, size=(7.6, 4.8))}, example=EXAMPLE)

if __name__ == "__main__":
    pages.run(STUDY, answer)
