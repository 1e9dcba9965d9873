"""What the studies of measured squirt share: pool ball, textbook effects, cues with a wooden tip, data. Not a study."""

from __future__ import annotations

import csv
from collections.abc import Sequence
from dataclasses import replace
from functools import cache
from importlib import import_module
from pathlib import Path
from typing import Any

import numpy as np

from cuefem import Ball, Cue, Scene, Stroke, Tip, TipDome, TipShear
from cuefem.beam.tip import TipModes
from cuefem.contact.strike import strike_modes
from cuefem.materials import material
from cuefem.tip_modes import tip_modes_of

common = import_module("common")

DATA = Path(__file__).parent / "data"
BALL = Ball(mass=0.170, radius=0.028575)
RESTITUTION, FRICTION, TIME, OFFSET = 0.73, 0.7, 1.1e-3, 0.375
DOME, SHEAR = TipDome(9.5e-3), TipShear(0.75)
MODELS = {"bare": (), "dome": (DOME,), "shear": (SHEAR,), "dome + shear": (DOME, SHEAR)}
INCH = 0.0254


def read(name: str) -> list[dict[str, str]]:
    """Rows of a file of data/, lines of its source passed over."""
    lines = (DATA / f"{name}.csv").read_text(encoding="utf-8").splitlines()
    return list(csv.DictReader(line for line in lines if not line.startswith("#")))


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
