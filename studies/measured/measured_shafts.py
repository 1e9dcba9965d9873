"""The shafts and strokes that may have been measured, for measured.py: unknowns, their ranges, draws. Not a study."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from functools import cache
from typing import NamedTuple

import numpy as np
from scipy.optimize import brentq
from scipy.stats import qmc

from cuefem import Cue, CueBatch, Scene, Segment, TipDome, TipShear, leather_modulus
from cuefem.materials import MATERIALS, material
from studies import strokes
from studies.measured import pool

MODELS = pool.MODELS
DRAWS = 48


class Range(NamedTuple):
    """Low, textbook and high value of an unknown."""

    low: float
    usual: float
    high: float


def _wood(name: str) -> Range:
    low, high = MATERIALS["hard maple"].ranges[name]
    return Range(low, getattr(material("hard maple"), name), high)


UNKNOWN: dict[str, Range] = {
    "maple's E, Pa": _wood("E"),
    "maple's G, Pa": _wood("G"),
    "maple's density, kg/m3": _wood("rho"),
    "leather's moduli, factor": Range(0.45, 1.0, 2.1),  # cuefem/materials.py: 45 to 210 MPa
    "leather's length, m": Range(3e-3, 6e-3, 8e-3),
    "ferrule's length, factor": Range(0.5, 1.0, 1.2),
    "diameter gained to 13 in, m": Range(0.0, 0.5e-3, 1.0e-3),
    "bore's diameter, m": Range(*pool.BORES),  # what the measured stiffness asks for: `asked_bore`
    "T, s": Range(1.0e-3, 1.1e-3, 1.2e-3),
    "e": Range(0.71, 0.73, 0.75),
    "mu": Range(0.6, 0.7, 0.8),
    "dome, m": Range(8.95e-3, 9.5e-3, 10.6e-3),
    "shear ratio": Range(0.67, 0.75, 0.82),  # Mindlin's at nu 0.5 to 0.3
}
USUAL = {name: r.usual for name, r in UNKNOWN.items()}
BREAK_SCALE = 13.5 / 12.75
LEATHERS = Range(45e6, pool.LEATHER.E, 210e6)  # Pa, LeatherTip's: cuefem/materials.py, and the headline study's
PHENOLIC_NU = 0.35
END = 8 * pool.INCH  # m, of which the stiffness was measured


class Measurement(NamedTuple):
    """A measured squirt, deg, the shaft that stands for the cue, and what its tip is (a time in the place of T)."""

    cue: str
    shaft: str
    offset: float
    squirt: float


@cache
def measurements() -> tuple[Measurement, ...]:
    """What was measured."""
    shafts = {"Players": "pool_maple", "Predator": "pool_hollow", "Stinger": "break"}
    rows = pool.read("measured_squirt")
    return tuple(
        Measurement(r["cue"], shafts[r["cue"].split()[0]], float(r["b_over_R"]), float(r["squirt_deg"])) for r in rows
    )


def series() -> tuple[Measurement, ...]:
    """The series of 2007 with one cue, least offset first."""
    return measurements()[2::-1]


def series_at(offset: float) -> float:
    """Squirt between the points of that series, deg."""
    return float(np.interp(offset, [row.offset for row in series()], [row.squirt for row in series()]))


def robot() -> Measurement:
    """What the robot measured in 2008, mean over its speeds."""
    return measurements()[3]


def baseline() -> Measurement:
    """What the robot measured in 2008 before masses were added."""
    return measurements()[4]


def far() -> tuple[Measurement, Measurement]:
    """The regular and the low-deflection shaft at b/R 0.453."""
    return measurements()[0], measurements()[5]


@cache
def plain(shaft: str) -> Cue:
    """A shaft by its name, the hollow one with its usual bore; "break": pool_maple a size wider, its tip phenolic."""
    if shaft != "break":
        return strokes.cue(shaft) if shaft == "pool_maple" else pool.hollow(USUAL["bore's diameter, m"])
    found = strokes.cue("pool_maple")
    wide = [_wider(s, BREAK_SCALE) for s in found.segments]
    return replace(found, segments=(replace(wide[0], material=material("phenolic")), *wide[1:]))


def _wider(segment: Segment, factor: float) -> Segment:
    names = ("tip_diameter", "butt_diameter", "tip_bore", "butt_bore")
    return replace(segment, **{name: factor * getattr(segment, name) for name in names})


def _changed(segment: Segment, values: Mapping[str, float], bored: bool) -> Segment:
    maple = replace(
        material("hard maple"),
        E=values["maple's E, Pa"],
        G=values["maple's G, Pa"],
        rho=values["maple's density, kg/m3"],
    )
    if segment.material == material("hard maple"):
        segment = replace(segment, material=maple)
    if segment.core == material("hard maple"):
        segment = replace(segment, core=maple)
    if bored and segment.tip_bore:
        bore = values["bore's diameter, m"]
        segment = replace(segment, tip_bore=bore, butt_bore=bore)
    return segment


def shaft_of(shaft: str, values: Mapping[str, float]) -> Cue:
    """The shaft with its unknowns at ``values``; its length stays."""
    found = plain(shaft)
    tip, ferrule, *wood = (_changed(s, values, shaft == "pool_hollow") for s in found.segments)
    if tip.material == material("leather"):
        f = values["leather's moduli, factor"]
        soft = replace(tip.material, E=f * tip.material.E, G=f * tip.material.G)
        tip = replace(tip, material=soft, length=values["leather's length, m"])
    ferrule = replace(ferrule, length=values["ferrule's length, factor"] * ferrule.length)
    more = values["diameter gained to 13 in, m"] - USUAL["diameter gained to 13 in, m"]
    wood[-3:-1] = [
        replace(wood[-3], butt_diameter=wood[-3].butt_diameter + more),
        replace(wood[-2], tip_diameter=wood[-2].tip_diameter + more),
    ]
    spare = found.length - tip.length - ferrule.length - sum(s.length for s in wood)
    wood[0] = replace(wood[0], length=wood[0].length + spare)
    return replace(found, segments=(tip, ferrule, *wood))


def struck(row: Measurement, model: str, values: Mapping[str, float]) -> Scene:
    """The scene of a measurement in a model; the break cue's hard tip stays 0.2 ms shorter and gives 0.85 back."""
    if model == pool.MODERN:
        return leather(row, values)
    hard = row.shaft == "break"
    effects = [e for e in (TipDome(values["dome, m"]), TipShear(values["shear ratio"])) if _has(model, type(e))]
    T = values["T, s"] - (0.2e-3 if hard else 0.0)
    found = pool.scene(shaft_of(row.shaft, values), T, row.offset, effects=effects)
    e = values["e"] + (0.12 if hard else 0.0)
    return replace(found, tip=replace(found.tip, restitution=e, friction=values["mu"]))


def leather(row: Measurement, values: Mapping[str, float]) -> Scene:
    """The scene of the whole stroke; nu is that of the shear ratio, and E takes the place of the contact time."""
    hard, cue, ratio = row.shaft == "break", shaft_of(row.shaft, values), values["shear ratio"]
    factor = UNKNOWN["leather's moduli, factor"]
    tip = replace(
        pool.LEATHER,
        height=cue.segments[0].length,
        dome_radius=values["dome, m"],
        E=float(np.interp(values["leather's moduli, factor"], factor, LEATHERS)),
        nu=min((2 - 2 * ratio) / (2 - ratio), 0.45),
    )
    if hard:
        tip = replace(tip, E=tip.E * phenolic() / pool.LEATHER.E, nu=PHENOLIC_NU, rho=material("phenolic").rho)
    found = pool.leather_scene(cue, row.offset, leather=tip)
    e = values["e"] + (0.12 if hard else 0.0) + pool.TIP_RESTITUTION - pool.RESTITUTION
    return replace(found, tip=replace(found.tip, restitution=e, friction=values["mu"]))


@cache
def phenolic() -> float:
    """E with which the break cue's tip touches the ball for 0.9 ms, Pa: it stands for the tip and for the waves."""
    tip = replace(pool.LEATHER, nu=PHENOLIC_NU, rho=material("phenolic").rho)
    found = pool.leather_scene(plain("break"), leather=tip)
    return leather_modulus(
        replace(found, tip=replace(found.tip, restitution=found.tip.restitution + 0.12)), USUAL["T, s"] - 2e-4
    )


def end_of(cue: Cue, length: float) -> Cue:
    """The first part of a cue, length m."""
    kept: list[Segment] = []
    left = length
    for segment in cue.segments:
        part = min(left / segment.length, 1.0)
        diameter = segment.tip_diameter + part * (segment.butt_diameter - segment.tip_diameter)
        bore = segment.tip_bore + part * (segment.butt_bore - segment.tip_bore)
        if part > 1e-9:
            kept.append(replace(segment, length=part * segment.length, butt_diameter=diameter, butt_bore=bore))
        left -= part * segment.length
    return replace(cue, segments=tuple(kept))


def stiffness(cue: Cue) -> float:
    """Static stiffness across the tip, N/m, the other end clamped."""
    return float(CueBatch.of([cue]).tip_stiffness[0])


def bored(bore: float, E: float, depth: float) -> Cue:
    """The hollow shaft with another bore, E of its wood, and depth of the bore behind the ferrule, m."""
    found = pool.hollow(bore)
    tip, ferrule, front, solid, *rest = found.segments
    width = solid.tip_diameter + (depth - front.length) / solid.length * (solid.butt_diameter - solid.tip_diameter)
    deeper = (
        replace(front, length=depth, butt_diameter=width),
        replace(solid, length=solid.length + front.length - depth, tip_diameter=width),
    )
    wood = (replace(s, material=replace(s.material, E=E)) for s in (*deeper, *rest))
    return replace(found, segments=(tip, ferrule, *wood))


def asked_bore(E: float, depth: float) -> float:
    """The bore, m, with which the last 8 in are as stiff as was measured."""
    wanted = measured_stiffness()["8 in"]
    return float(brentq(lambda bore: stiffness(end_of(bored(bore, E, depth), END)) - wanted, 1e-3, 11.5e-3))


def measured_stiffness() -> dict[str, float]:
    """Measured static stiffness, N/m, of the whole shaft and of its last 8 in."""
    return {row["length"]: float(row["stiffness_N_per_m"]) for row in pool.read("static_stiffness")}


def _has(model: str, kind: type) -> bool:
    return any(isinstance(effect, kind) for effect in MODELS[model])


@cache
def draws() -> tuple[dict[str, float], ...]:
    """Points of the Halton sequence within the ranges, half of each draw below the usual value."""
    points = qmc.Halton(len(UNKNOWN), scramble=False).random(DRAWS + 20)[20:]
    found = []
    for point in points:
        spread = zip(UNKNOWN.items(), point, strict=True)
        found.append({name: float(np.interp(p, (0.0, 0.5, 1.0), r)) for (name, r), p in spread})
    return tuple(found)
