"""The end mass for other people's software: pooltool's CueSpecs, with what the number means and how well it works.

pooltool turns the ball by [A.31] with nu = 2/5, whatever the ball: alpha = -atan((5/2) a sqrt(1 - a^2)/(1 + m/end_mass
+ (5/2)(1 - a^2))), its own words in `pooltool.physics.resolve.stick_ball.squirt`; a is b/R of the contact, positive on
the ball's left, alpha positive to the left. [A.31] knows neither restitution nor the tip's dome: with the stick end
mass it gives 11 to 42 % less squirt than the coupled strike of the ready scenes. With an end mass made for it, the
drive "A.31", it is right at one offset. `table_record` has that end mass for every offset and speed.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from cuefem.beam.tip import TipModes
from cuefem.contact.outcome import MISSED, grip_of
from cuefem.contact.strike import strike_modes
from cuefem.endmass.drives import DEFINITIONS
from cuefem.results.designs import OFFSETS, coupled_curve
from cuefem.results.quantities import NONE, RESULTS, degrees, grams, units_of, with_unit, written
from cuefem.results.records import Entry, Record, Sheet, sheet
from cuefem.scene import Scene
from cuefem.squirt import alciatore_a31, alciatore_a31_mass_ratio
from cuefem.tip_modes import Solved

FASTER = (0.5, 1.0, 2.0)  # times the stroke's speed: at which the end mass is given too
OWN = FASTER.index(1.0)
SAME = 1e-6  # relative: end masses that are one
WHOLE_CUE = 1.4732  # m, 58 in: pool cues, and pooltool's own
SHORTEST_CUE = 1.2  # m: a drawing that is shorter is a shaft's
POOLTOOL_INERTIA = 0.4  # its 5/2
POOLTOOL = "0.6.0"  # the release whose CueSpecs these are; .ci/pooltool installs it
POOLTOOL_LINE = 'CueSpecs(**json.load(open("cue.json"))["CueSpecs"])'
NICKEL = 0.0106045  # m, the dome of pooltool's own cue

A31_MEANING = (
    "the end mass whose [A.31] squirt is that of the coupled strike, at this offset, speed and head-on contact time"
)
A31_WORDS = "put this number into pooltool: with its formula [A.31] it then gives the squirt computed here"
TABLE_MEANING = (
    "end_mass: the mass m_e with which tan(squirt) = (5/2) a sqrt(1 - a^2)/(1 + m/m_e + (5/2)(1 - a^2)), Alciatore's "
    "[A.31], gives the squirt of the coupled strike at that offset and speed; a is the offset b/R, m the ball's mass; "
    "none head on and in a miscue"
)
TABLE_SIGNS = "squirt turns the ball away from the side on which it is struck, and has the sign of the offset"
SIGNS = (
    "a is b/R of the contact, positive on the ball's left, and alpha positive to the left: "
    "alpha(a) = -squirt(offset = a); end_mass is m_e, felt at the tip, not the four times larger m_c of the cue's end"
)
UNITS = units_of("end_mass", "length", "radius", "squirt") | {"M": "kg", "m": "kg", "R": "m"}


def pooltool_record(name: str, scene: Scene, *, drive: str = "A.31", length: float | None = None) -> Record:
    """pooltool's CueSpecs of a scene's cue, SI, what their end mass means, and what squirt it gives beside ours.

    length: of the whole cue, m; by default that of the drawing if it is a whole cue's. drive: which end mass is handed
    over. ValueError if it does not exist, as "A.31" head on and in a miscue.
    """
    solved = Solved(scene)
    masses, reasons = _end_masses(solved)
    if drive in reasons:
        raise ValueError(f"end mass {drive!r} does not exist here: {reasons[drive]}")
    strokes = [_strokes(scene, solved.tip, OFFSETS, factor * float(scene.stroke.speed)) for factor in FASTER]
    theirs = alciatore_a31(np.array(OFFSETS), mass_ratio=scene.ball.mass / masses[drive], inertia=POOLTOOL_INERTIA)
    by_offset = _by_offset(strokes)
    return {
        "for": "pooltool",
        "version": POOLTOOL,
        "line": POOLTOOL_LINE,
        "CueSpecs": _cue_specs(name, scene, length) | {"end_mass": masses[drive]},
        "BallParams": {"m": scene.ball.mass, "R": scene.ball.radius},
        "end_mass": {
            "drive": drive,
            "meaning": A31_MEANING if drive == "A.31" else DEFINITIONS[drive].meaning,
            "contact_time": scene.contact_time,
            "offset": scene.stroke.offset,
            "speed": scene.stroke.speed,
            "others": {key: mass for key, mass in masses.items() if key != drive},
            "reasons": reasons,
        },
        "signs": SIGNS,
        "notes": [*_notes(scene, length), by_offset["words"]],
        "squirt": {
            "offsets": list(OFFSETS),
            "coupled": [stroke["squirt"] for stroke in strokes[OWN]],
            "regimes": [stroke["regime"] for stroke in strokes[OWN]],
            "grips": [stroke["grip"] for stroke in strokes[OWN]],
            "pooltool": theirs.tolist(),
        },
        "by_offset": by_offset,
        "units": UNITS,
    }


def _cue_specs(name: str, scene: Scene, length: float | None) -> Record:
    specs: Record = {"brand": name, "M": scene.axial_mass}
    if scene.cue.segments:
        first, last = scene.cue.segments[0], scene.cue.segments[-1]
        specs |= {"length": length or (scene.shaft.length if _is_whole(scene) else WHOLE_CUE)}
        specs |= {"shaft_radius_at_tip": first.tip_diameter / 2}
        specs |= {"shaft_radius_at_butt": last.butt_diameter / 2} if _is_whole(scene) else {}
    elif length:
        specs |= {"length": length}
    return specs | {"tip_radius": scene.dome_radius or NICKEL}


def _is_whole(scene: Scene) -> bool:
    """Whether the drawing is a whole cue's, from tip to bumper."""
    return not scene.shaft.body_mass or scene.shaft.length >= SHORTEST_CUE


def _notes(scene: Scene, length: float | None) -> list[str]:
    notes = ["pooltool takes [A.31], an instantaneous stroke without friction's limit: it knows no miscue"]
    if scene.lumped is not None:
        notes.append("a lumped cue has no length and no radii: pooltool's own stay")
    elif not _is_whole(scene):
        usual = "" if length else ", 58 in, for the file draws the shaft alone (--length gives another)"
        notes.append(f"length and M are the whole cue's{usual}; shaft_radius_at_butt stays pooltool's own")
    if not scene.dome_radius:
        notes.append("tip_radius: pooltool's own, a nickel's; the scene has no TipDome")
    table = scene.contact_terms.table
    if table is not None:
        told = f"the cue is raised by {np.degrees(table.angle):.3g}°"
        notes.append(f"{told}: its end mass includes the table's push, which pooltool's squirt does not know")
    if scene.ball.inertia != POOLTOOL_INERTIA:
        notes.append(f"pooltool's balls have the inertia factor 0.4; the scene's has {scene.ball.inertia:g}")
    return notes


def _end_masses(solved: Solved) -> tuple[dict[str, Any], dict[str, str]]:
    """The end mass by [A.31] and by every definition, kg, None where there is none; and the reasons why."""
    ways = {"A.31": _a31_end_mass} | {name: definition.of_solved for name, definition in DEFINITIONS.items()}
    masses: dict[str, Any] = {}
    reasons: dict[str, str] = {}
    for drive, way in ways.items():
        try:
            masses[drive] = float(way(solved))
        except ValueError as error:
            masses[drive], reasons[drive] = None, str(error)
    return masses, reasons


def _a31_end_mass(solved: Solved) -> float:
    offset = float(solved.scene.stroke.offset)
    if offset == 0:
        raise ValueError("[A.31] has no squirt head on; got the offset 0 (--offset takes another)")
    outcome = strike_modes(solved.scene, solved.tip)
    if grip_of(outcome) in MISSED:
        raise ValueError(f"the stroke miscues at offset {offset}; got no end mass")
    return _mass_of(solved.scene, offset, float(outcome.squirt))


def _mass_of(scene: Scene, offset: float, squirt: float) -> float:
    return float(scene.ball.mass / alciatore_a31_mass_ratio(offset, squirt, inertia=POOLTOOL_INERTIA))


def _strokes(scene: Scene, tip: TipModes, offsets: Sequence[float], speed: float) -> list[Record]:
    """The coupled strikes at a speed, m/s, with the end mass of [A.31] for each squirt: None in a miscue and head on.

    A tip whose contact time changes with the speed is solved anew.
    """
    if speed != scene.stroke.speed:
        scene = replace(scene, stroke=replace(scene.stroke, speed=speed))
        tip = Solved(scene).tip if scene.contact_terms.tip is not None else tip
    curve = coupled_curve(scene, offsets, tip)
    return [
        {
            "speed": speed,
            "offset": offset,
            "end_mass": None if grip in MISSED or squirt * offset <= 0 else _mass_of(scene, offset, squirt),
            "squirt": squirt,
            "regime": regime,
            "grip": grip,
        }
        for offset, squirt, regime, grip in zip(
            offsets, curve["squirt"].tolist(), curve["regime"], curve["grip"], strict=True
        )
    ]


def _by_offset(strokes: Sequence[Sequence[Record]]) -> Record:
    """The end mass that [A.31] takes at each offset, kg, None in a miscue, at several speeds."""
    speeds = [row[0]["speed"] for row in strokes]
    masses = [[stroke["end_mass"] for stroke in row] for row in strokes]
    pairs = (pair for row in masses for pair in zip(masses[OWN], row, strict=True) if None not in pair)
    apart = max((abs(other / mass - 1) for mass, other in pairs), default=0.0)
    words = (
        f"the end mass depends on the speed, by up to {100 * apart:.2g} % from {speeds[0]:g} to {speeds[-1]:g} m/s, "
        "so that it is given at three speeds"
        if apart > SAME
        else "the speed drops out: end mass and squirt are the same at every speed, for the tip's law is linear"
    )
    return {
        "offsets": list(OFFSETS),
        "end_mass": masses[OWN],
        "speed_matters": apart > SAME,
        "speeds": speeds,
        "end_mass_at_speeds": masses,
        "words": words,
    }


def table_record(scene: Scene, offsets: Sequence[float], speeds: Sequence[float]) -> Record:
    """The end mass of [A.31] and squirt of the coupled strike at every speed, m/s, and offset b/R: a row a stroke."""
    tip = Solved(scene).tip
    strokes = [stroke for speed in speeds for stroke in _strokes(scene, tip, offsets, speed)]
    names = ("speed", "offset", "end_mass", "squirt")
    return {
        "for": "table",
        "definition": TABLE_MEANING,
        "signs": TABLE_SIGNS,
        "ball_mass": scene.ball.mass,
        "rows": [{name: it[name] for name in names} | {"miscue": it["grip"] in MISSED} for it in strokes],
        "units": {"speed": "m/s", "offset": "", "ball_mass": "kg"} | units_of("end_mass", "squirt"),
    }


def table_csv(record: Record) -> str:
    """The rows of a `table_record` as CSV with units in its header, below lines with # that say what they mean."""
    units = {name: record["units"][name] for name in ("speed", "offset", "end_mass", "squirt")}
    first = [f"# {record['definition']}", f"# {record['signs']}", f"# ball: {record['ball_mass']!r} kg"]
    head = ",".join([*(f"{name} [{unit or '1'}]" for name, unit in units.items()), "miscue"])
    rows = (
        ",".join([*("" if row[name] is None else repr(row[name]) for name in units), str(int(row["miscue"]))])
        for row in record["rows"]
    )
    return "\n".join([*first, head, *rows, ""])


def table_sheet(record: Record) -> Sheet:
    """The rows of a `table_record`, for people."""
    columns: dict[str, Entry] = {
        "speed": "{speed:g} m/s",
        "offset b/R": "{offset:.4g}",
        "end mass": lambda row: _exact(row["end_mass"]),
        "squirt": lambda row: "miscue" if row["miscue"] else degrees(row["squirt"]),
    }
    return sheet("End mass and squirt", columns, record["rows"], record["definition"], record["signs"], texts=())


def handover_words(record: Record) -> str:
    """The number that is handed over, for people."""
    at = record["end_mass"]
    stroke = f"b/R {at['offset']:g}, {at['speed']:g} m/s, head-on contact {with_unit(at['contact_time'], 's', 3)}"
    specs = record["CueSpecs"]
    whole = f"the whole cue: {grams(specs['M'])}"
    if "length" in specs:
        whole += f", {written('position', specs['length'])} long"
        whole += "" if "shaft_radius_at_butt" in specs else " (the file draws the shaft alone: --length gives another)"
    return f"handed over: end mass {_exact(specs['end_mass'])} by {at['drive']}, at {stroke}; {whole}"


def handover_sheet(record: Record) -> Sheet:
    """The equivalent end mass against the offset, for people."""
    by_offset, squirt = record["by_offset"], record["squirt"]
    matters = by_offset["speed_matters"]
    at = [f" at {speed:g} m/s" if matters else "" for speed in by_offset["speeds"]]
    shown = range(len(FASTER)) if matters else [OWN]
    told = [
        "miscue" if grip in MISSED else degrees(angle)
        for angle, grip in zip(squirt["coupled"], squirt["grips"], strict=True)
    ]
    rows = zip(by_offset["offsets"], zip(*by_offset["end_mass_at_speeds"], strict=True), told, strict=True)
    return Sheet(
        "Equivalent end mass for [A.31]",
        ("offset b/R", *(f"end mass{at[i]}" for i in shown), f"squirt{at[OWN]}"),
        tuple((f"{offset:g}", *(_exact(masses[i]) for i in shown), squirt) for offset, masses, squirt in rows),
        (A31_WORDS, by_offset["words"]),
        texts=(),
    )


def _exact(mass: float | None) -> str:
    """An end mass to a milligram, since a simulator takes it as it is."""
    return NONE if mass is None else f"{RESULTS['mass'].scale * mass:.3f} g"
