"""The shafts and strokes that may have been measured, for measured.py: unknowns, their ranges, draws. Not a study."""

from __future__ import annotations

import sys
from collections.abc import Mapping
from dataclasses import replace
from functools import cache
from importlib import import_module
from pathlib import Path
from typing import NamedTuple

import numpy as np
from scipy.stats import qmc

from cuefem import Cue, Scene, Segment, TipDome, TipShear
from cuefem.materials import MATERIALS, material

HERE = Path(__file__).parent
if str(HERE) not in sys.path:
    sys.path.append(str(HERE))  # studies are files, not a package
common, pool = import_module("common"), import_module("pool")

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
    "bore's diameter, m": Range(5e-3, 6e-3, 7.5e-3),
    "T, s": Range(1.0e-3, 1.1e-3, 1.2e-3),
    "e": Range(0.71, 0.73, 0.75),
    "mu": Range(0.6, 0.7, 0.8),
    "dome, m": Range(8.95e-3, 9.5e-3, 10.6e-3),
    "shear ratio": Range(0.67, 0.75, 0.82),  # Mindlin's at nu 0.5 to 0.3
}
USUAL = {name: r.usual for name, r in UNKNOWN.items()}
BREAK_SCALE = 13.5 / 12.75


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


@cache
def plain(shaft: str) -> Cue:
    """A shaft by its name; "break": pool_maple a size wider, its tip phenolic."""
    if shaft != "break":
        return common.cue(shaft)
    found = common.cue("pool_maple")
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
    hard = row.shaft == "break"
    effects = [e for e in (TipDome(values["dome, m"]), TipShear(values["shear ratio"])) if _has(model, type(e))]
    T = values["T, s"] - (0.2e-3 if hard else 0.0)
    found = pool.scene(shaft_of(row.shaft, values), T, row.offset, effects=effects)
    e = values["e"] + (0.12 if hard else 0.0)
    return replace(found, tip=replace(found.tip, restitution=e, friction=values["mu"]))


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
