"""What the studies of measured squirt share: pool ball, textbook effects, LeatherTip, other tips, data. Not a study."""

from __future__ import annotations

import csv
from collections.abc import Sequence
from dataclasses import replace
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np

from cuefem import (
    AxialWaves,
    Ball,
    Cue,
    GeometricStiffness,
    LeatherTip,
    PointMass,
    Scene,
    Stroke,
    Tip,
    TipDome,
    TipShear,
    strike,
)
from cuefem.beam.tip import TipModes
from cuefem.games import GAMES
from cuefem.materials import material
from cuefem.tip_modes import tip_modes_of
from studies import strokes
from studies.strokes import strike_modes

DATA = Path(__file__).parent / "data"
BALL = Ball(mass=0.170, radius=0.028575)
RESTITUTION, FRICTION, TIME, OFFSET = 0.73, 0.7, 1.1e-3, 0.375
DOME, SHEAR = TipDome(9.5e-3), TipShear(0.75)
MODELS = {"bare": (), "dome": (DOME,), "shear": (SHEAR,), "dome + shear": (DOME, SHEAR)}
LEATHER, SPEED, MODERN = LeatherTip(height=6e-3, dome_radius=9.5e-3, E=140e6), 2.0, "whole stroke"
# What acts in the whole stroke beside the tip, whose own restitution gives the cue's 0.73 head on with these waves.
WHOLE, TIP_RESTITUTION = (AxialWaves(), GeometricStiffness()), GAMES["pool"].tip_restitution
# Bores of the hollow shaft, m, that the measured static stiffness of such a shaft asks for: least, middle, most.
BORES = (7.4e-3, 8.5e-3, 10.2e-3)
INCH = 0.0254
BASELINE = 2.30  # deg, measured without an added mass


def read(name: str) -> list[dict[str, str]]:
    """Rows of a file of data/, lines of its source passed over."""
    lines = (DATA / f"{name}.csv").read_text(encoding="utf-8").splitlines()
    return list(csv.DictReader(line for line in lines if not line.startswith("#")))


@cache
def added_masses(mass: float) -> dict[float, float]:
    """Measured squirt over its baseline by inches, for the series of this added mass, kg."""
    rows = [r for r in read("added_mass_players_feb2008") if float(r["mass_g"]) == 1e3 * mass]
    return {float(r["distance_in"]): float(r["squirt_deg"]) / BASELINE for r in rows}


def added_mass(inches: float, mass: float = 11e-3) -> float:
    """Measured ratio between its points."""
    found = added_masses(mass)
    return float(np.interp(inches, list(found), list(found.values())))


def scene(cue: Cue, contact_time: float = TIME, offset: float = OFFSET, *, effects: Sequence[Any] = ()) -> Scene:
    """The cue before a pool ball (57.15 mm, 170 g), with the textbook's tip."""
    tip = Tip(restitution=RESTITUTION, friction=FRICTION, contact_time=contact_time)
    return Scene(cue, BALL, tip, Stroke(offset=offset), effects=tuple(effects))


def wooden_tip(cue: Cue) -> Cue:
    """The cue with maple in place of its leather: what gives in the tip is then in the tip's law alone."""
    first = replace(cue.segments[0], material=material("hard maple"))
    return replace(cue, segments=(first, *cue.segments[1:]))


@cache
def tip_modes(cue: Cue, contact_time: float, on_cue: tuple[Any, ...] = ()) -> TipModes:
    """Tip modes of a cue with the effects on it, made once for all offsets and tips."""
    return tip_modes_of(scene(cue, contact_time, effects=on_cue))


def squirt(struck: Scene) -> float:
    """Squirt of the coupled strike, degrees."""
    on_cue = struck.cue_effects
    modes = tip_modes(struck.cue, float(struck.contact_time), on_cue)
    return float(np.degrees(strike_modes(struck, modes).squirt))


def without_leather(cue: Cue) -> Cue:
    """The cue without its leather: LeatherTip is the whole tip."""
    return replace(cue, segments=cue.segments[1:])


def leather_scene(
    cue: Cue,
    offset: float = OFFSET,
    *,
    speed: float = SPEED,
    leather: LeatherTip = LEATHER,
    effects: Sequence[Any] = (),
    whole: Sequence[Any] = WHOLE,
) -> Scene:
    """A cue that is drawn with its leather, with LeatherTip in its place; masses are placed from the end of the tip."""
    moved = (replace(e, position=e.position - leather.height) if isinstance(e, PointMass) else e for e in effects)
    tip = Tip(restitution=TIP_RESTITUTION if whole else RESTITUTION, friction=FRICTION)
    return Scene(without_leather(cue), BALL, tip, Stroke(speed, offset), (leather, *whole, *moved))


@cache
def leather_strike(struck: Scene) -> tuple[float, float]:
    """Squirt, deg, and contact time, ms."""
    found = strike(struck)
    return float(np.degrees(found.squirt)), 1e3 * float(found.duration)


@cache
def hollow(bore: float) -> Cue:
    """The hollow shaft with a bore in front, m."""
    found = strokes.cue("pool_hollow")
    drilled = (replace(s, tip_bore=bore, butt_bore=bore) if s.tip_bore else s for s in found.segments)
    return replace(found, segments=tuple(drilled))
