"""A strike from the side: record and tables."""

from __future__ import annotations

import math
from dataclasses import asdict, replace

import numpy as np
from rich.console import Group

from cuefem.report.record import Record, cue_record
from cuefem.report.table import table_of, with_caption
from cuefem.results.quantities import NONE, RESULTS, written
from cuefem.side.scene import SideStrike
from cuefem.side.strike import SideOutcome, side_strike

NAMES = ("rebound_speed", "apparent_restitution", "effective_mass", "impulse", "duration", "place_speed")
PLACES = 9


def side_scene_record(scene: SideStrike) -> Record:
    """The scene of a strike from the side: beam, striker, place, speed and effects."""
    given = {name: value for name, value in asdict(scene.striker).items() if value is not None}
    return {
        "cue": cue_record(scene.cue),
        "striker": given | {"wall_time": scene.striker.wall_time(scene.speed)},
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


def side_tables(record: Record, scene: Record) -> list[Group]:
    """One strike, and e_A and the effective mass along the beam."""
    one = table_of(f"Strike from the side, {written('position', scene['position'])} from the tip", ["", "value"])
    for name in (*NAMES, "rigid_mass", "error"):
        if record[name] is not None:
            one.add_row(RESULTS[name].words, written(name, record[name]))
    columns = ("position", "apparent_restitution", "effective_mass", "rigid_mass", "duration")
    headings = [f"{RESULTS[name].words}, {RESULTS[name].shown_unit}".rstrip(", ") for name in columns]
    along = table_of("The same strike along the beam", headings, text_columns=0)
    for row in record["along"]:
        along.add_row(*(RESULTS[name].number(row[name]) if math.isfinite(row[name]) else NONE for name in columns))
    striker = scene["striker"]
    return [
        with_caption(one, *_assumptions(scene)),
        with_caption(
            along,
            "effective mass: of a free body off which the striker would bounce in the same way, m (1 + e_A)/(e - e_A),",
            f"with the striker's own e {striker['restitution']:g}; negative where the beam throws it back faster than "
            "a wall would",
        ),
    ]


def _assumptions(scene: Record) -> list[str]:
    striker = scene["striker"]
    wall = RESULTS["contact_time"].written(striker["wall_time"])
    law = "Hertz's law" if "modulus" in striker else "a spring"
    return [
        f"striker {written('mass', striker['mass'])} at {scene['speed']:g} m/s, {law}, e {striker['restitution']:g}, "
        f"{wall} against a wall"
    ]
