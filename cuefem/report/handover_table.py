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

import numpy as np

from cuefem.beam.tip import TipModes
from cuefem.contact.outcome import MISSED, grip_of
from cuefem.contact.strike import strike_modes
from cuefem.endmass.drives import DEFINITIONS
from cuefem.results.designs import OFFSETS, coupled_curve
from cuefem.results.quantities import NONE, RESULTS, degrees, grams, units_of, with_unit, written
from cuefem.results.records import Record, Sheet
from cuefem.scene import Scene
from cuefem.squirt import alciatore_a31, alciatore_a31_mass_ratio
from cuefem.tip_modes import Solved

FASTER = (0.5, 1.0, 2.0)  # times the stroke's speed: at which the end mass is given too
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
    worth = _worth(scene, solved.tip, masses[drive])
    by_offset = _by_offset(scene, solved.tip, worth)
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
        "squirt": worth,
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


def _end_masses(solved: Solved) -> tuple[dict[str, float | None], dict[str, str]]:
    masses: dict[str, float | None] = {}
    reasons: dict[str, str] = {}
    for drive in ("A.31", *DEFINITIONS):
        try:
            masses[drive] = _end_mass(solved, drive)
        except ValueError as error:
            masses[drive], reasons[drive] = None, str(error)
    return masses, reasons


def _end_mass(solved: Solved, drive: str) -> float:
    if drive == "A.31":
        return _a31_end_mass(solved.scene, solved.tip)
    return float(DEFINITIONS[drive].of_solved(solved))


def _a31_end_mass(scene: Scene, tip: TipModes) -> float:
    offset = scene.stroke.offset
    if offset == 0:
        raise ValueError("[A.31] has no squirt head on; got the offset 0 (--offset takes another)")
    outcome = strike_modes(scene, tip)
    if grip_of(outcome) in MISSED:
        raise ValueError(f"the stroke miscues at offset {offset}; got no end mass")
    return _mass_of(scene, float(offset), float(outcome.squirt))


def _worth(scene: Scene, tip: TipModes, end_mass: float | None) -> Record:
    """Squirt against the offset, rad: of the coupled strike, and of pooltool with the number handed over."""
    assert end_mass is not None
    curve = coupled_curve(scene, OFFSETS, tip)
    theirs = alciatore_a31(np.array(OFFSETS), mass_ratio=scene.ball.mass / end_mass, inertia=POOLTOOL_INERTIA)
    return {
        "offsets": list(OFFSETS),
        "coupled": curve["squirt"].tolist(),
        "regimes": curve["regime"],
        "grips": curve["grip"],
        "pooltool": theirs.tolist(),
    }


def _by_offset(scene: Scene, tip: TipModes, worth: Record) -> Record:
    """The end mass that [A.31] takes at each offset, kg, None in a miscue, at several speeds."""
    speeds = [factor * float(scene.stroke.speed) for factor in FASTER]
    own_curve = worth["coupled"], worth["grips"]
    masses = [_masses(scene, *own_curve) if factor == 1 else _masses_at(scene, tip, factor) for factor in FASTER]
    own = masses[FASTER.index(1.0)]
    apart = [
        abs(other / mass - 1)
        for row in masses
        for mass, other in zip(own, row, strict=True)
        if mass is not None and other is not None
    ]
    matters = max(apart, default=0.0) > SAME
    slow, fast = (f"{speed:g}" for speed in (speeds[0], speeds[-1]))
    words = (
        f"the end mass depends on the speed, by up to {100 * max(apart):.2g} % from {slow} to {fast} m/s, "
        "so that it is given at three speeds"
        if matters
        else "the speed drops out: end mass and squirt are the same at every speed, for the tip's law is linear"
    )
    return {
        "offsets": list(OFFSETS),
        "end_mass": own,
        "speed_matters": matters,
        "speeds": speeds,
        "end_mass_at_speeds": masses,
        "words": words,
    }


def _masses_at(scene: Scene, tip: TipModes, factor: float) -> list[float | None]:
    """As `_masses` at another speed."""
    curve = _curve_at(scene, tip, OFFSETS, factor * float(scene.stroke.speed))
    return _masses(scene, curve["squirt"].tolist(), curve["grip"])


def _curve_at(scene: Scene, tip: TipModes, offsets: Sequence[float], speed: float) -> Record:
    """The coupled strikes at a speed, m/s; a tip whose contact time changes with it is solved anew."""
    other = replace(scene, stroke=replace(scene.stroke, speed=speed))
    return coupled_curve(other, offsets, Solved(other).tip if scene.contact_terms.tip is not None else tip)


def _masses(
    scene: Scene, squirts: Sequence[float], grips: Sequence[str], offsets: Sequence[float] = OFFSETS
) -> list[float | None]:
    """The end masses of [A.31] for the squirt of the coupled strike at each offset; None in a miscue and head on."""
    return [
        None if grip in MISSED or squirt * offset <= 0 else _mass_of(scene, offset, squirt)
        for offset, squirt, grip in zip(offsets, squirts, grips, strict=True)
    ]


def table_record(scene: Scene, offsets: Sequence[float], speeds: Sequence[float]) -> Record:
    """The end mass of [A.31] and squirt of the coupled strike at every speed, m/s, and offset b/R: a row a stroke."""
    tip, rows = Solved(scene).tip, list[Record]()
    for speed in speeds:
        curve = _curve_at(scene, tip, offsets, speed)
        squirts, grips = curve["squirt"].tolist(), curve["grip"]
        both = zip(offsets, _masses(scene, squirts, grips, offsets), squirts, grips, strict=True)
        rows += [
            {"speed": speed, "offset": offset, "end_mass": mass, "squirt": squirt, "miscue": grip in MISSED}
            for offset, mass, squirt, grip in both
        ]
    return {
        "for": "table",
        "definition": TABLE_MEANING,
        "signs": TABLE_SIGNS,
        "ball_mass": scene.ball.mass,
        "rows": rows,
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
    rows = tuple(
        (
            f"{row['speed']:g} m/s",
            f"{row['offset']:.4g}",
            _exact(row["end_mass"]),
            "miscue" if row["miscue"] else degrees(row["squirt"]),
        )
        for row in record["rows"]
    )
    notes = (record["definition"], record["signs"])
    return Sheet("End mass and squirt", ("speed", "offset b/R", "end mass", "squirt"), rows, notes, texts=())


def _mass_of(scene: Scene, offset: float, squirt: float) -> float:
    return float(scene.ball.mass / alciatore_a31_mass_ratio(offset, squirt, inertia=POOLTOOL_INERTIA))


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
    by_offset, own = record["by_offset"], FASTER.index(1.0)
    matters = by_offset["speed_matters"]
    at = [f" at {speed:g} m/s" if matters else "" for speed in by_offset["speeds"]]
    shown = range(len(FASTER)) if matters else [own]
    rows = zip(by_offset["offsets"], zip(*by_offset["end_mass_at_speeds"], strict=True), _told(record), strict=True)
    return Sheet(
        "Equivalent end mass for [A.31]",
        ("offset b/R", *(f"end mass{at[i]}" for i in shown), f"squirt{at[own]}"),
        tuple((f"{offset:g}", *(_exact(masses[i]) for i in shown), squirt) for offset, masses, squirt in rows),
        (A31_WORDS, by_offset["words"]),
        texts=(),
    )


def _told(record: Record) -> list[str]:
    """The coupled squirt at each offset, or that the stroke miscues."""
    both = zip(record["squirt"]["coupled"], record["squirt"]["grips"], strict=True)
    return ["miscue" if grip in MISSED else degrees(squirt) for squirt, grip in both]


def _exact(mass: float | None) -> str:
    """An end mass to a milligram, since a simulator takes it as it is."""
    return NONE if mass is None else f"{RESULTS['mass'].scale * mass:.3f} g"
