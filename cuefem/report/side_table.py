"""A strike from the side: record and sheets."""

from __future__ import annotations

import math
from dataclasses import asdict, replace

import numpy as np

from cuefem.measured.side.side_scene import SideStrike
from cuefem.measured.side.side_strike import SideOutcome, side_strike
from cuefem.report.record import cue_record
from cuefem.results.quantities import NONE, RESULTS, with_heading, written
from cuefem.results.records import Entry, Record, Sheet, sheet, value_rows, values_sheet

NAMES = ("rebound_speed", "apparent_restitution", "effective_mass", "impulse", "duration", "place_speed")
PLACES = 9


def side_scene_record(scene: SideStrike) -> Record:
    """The scene of a strike from the side: beam, striker, place, speed and effects."""
    striker = {name: value for name, value in asdict(scene.striker).items() if value is not None}
    return {
        "cue": cue_record(scene.cue),
        "striker": striker | {"wall_time": scene.striker.wall_time(scene.speed)},
        "position": scene.position,
        "speed": scene.speed,
        "effects": [{"type": type(effect).__name__, **asdict(effect)} for effect in scene.effects],
    }


def side_record(scene: SideStrike, outcome: SideOutcome | None = None, *, places: int = PLACES) -> Record:
    """The strike, what a rigid beam would be felt as, and the same strike at ``places`` along the beam.

    outcome: of the strike, if it is known already.
    """
    outcome = outcome or side_strike(scene)
    strikes = [replace(scene, position=float(x)) for x in np.linspace(0, scene.cue.length, places)]
    return {
        **_numbers(scene, outcome),
        "energy": outcome.energy,
        "unknowns": outcome.unknowns,
        "error": outcome.error,
        "along": [{"position": each.position, **_numbers(each, side_strike(each))} for each in strikes],
    }


def _numbers(scene: SideStrike, outcome: SideOutcome) -> Record:
    return {name: getattr(outcome, name) for name in NAMES} | {"rigid_mass": scene.rigid_mass}


def side_sheets(record: Record, scene: Record) -> list[Sheet]:
    """One strike, and e_A and the effective mass along the beam."""
    columns = ("position", "apparent_restitution", "effective_mass", "rigid_mass", "duration")
    return [
        values_sheet(
            f"Strike from the side, {written('position', scene['position'])} from the tip",
            value_rows(record, (*NAMES, "rigid_mass", "error")),
            *_assumptions(scene),
        ),
        sheet(
            "The same strike along the beam",
            {with_heading(RESULTS[name].words, RESULTS[name].unit): _number(name) for name in columns},
            record["along"],
            "effective mass: of a free body off which the striker would bounce in the same way, m (1 + e_A)/(e - e_A),",
            f"with the striker's own e {scene['striker']['restitution']:g}; negative where the beam throws it back "
            "faster than a wall would",
            texts=(),
        ),
    ]


def _number(name: str) -> Entry:
    return lambda row: RESULTS[name].number(row[name]) if math.isfinite(row[name]) else NONE


def _assumptions(scene: Record) -> list[str]:
    striker = scene["striker"]
    wall = written("contact_time", striker["wall_time"])
    law = "Hertz's law" if "modulus" in striker else "a spring"
    return [
        f"striker {written('mass', striker['mass'])} at {scene['speed']:g} m/s, {law}, e {striker['restitution']:g}, "
        f"{wall} against a wall"
    ]
