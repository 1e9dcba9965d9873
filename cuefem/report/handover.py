"""The end mass for other people's software: pooltool's CueSpecs, with what the number means and how well it works.

pooltool turns the ball by [A.31] with nu = 2/5, whatever the ball: alpha = -atan((5/2) a sqrt(1 - a^2)/(1 + m/end_mass
+ (5/2)(1 - a^2))), its own words in `pooltool.physics.resolve.stick_ball.squirt`; a is b/R of the contact, positive on
the ball's left, alpha positive to the left. [A.31] knows neither restitution nor the tip's dome: with the stick end
mass it gives 11 to 42 % less squirt than the coupled strike of the ready scenes. With an end mass made for it, the
drive "A.31", it is right at one offset.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from cuefem.beam.tip import TipModes
from cuefem.contact.strike import strike_modes
from cuefem.endmass.drives import DEFINITIONS, formula_of
from cuefem.report.quantities import units_of
from cuefem.report.record import Record
from cuefem.scene import Scene
from cuefem.squirt import alciatore_a31, alciatore_a31_mass_ratio
from cuefem.tip_modes import Solved

OFFSETS = (0.1, 0.2, 0.3, 0.4, 0.5)
POOLTOOL_INERTIA = 0.4  # its 5/2
NICKEL = 0.0106045  # m, the dome of pooltool's own cue

A31_MEANING = (
    "the end mass whose [A.31] squirt is that of the coupled strike, at this offset, speed and head-on contact time"
)
SIGNS = (
    "a is b/R of the contact, positive on the ball's left, and alpha positive to the left: "
    "alpha(a) = -squirt(offset = a); end_mass is m_e, felt at the tip, not the four times larger m_c of the cue's end"
)
UNITS = units_of("end_mass", "length", "radius", "squirt") | {"M": "kg", "m": "kg", "R": "m"}


def pooltool_record(name: str, scene: Scene, *, drive: str = "A.31") -> Record:
    """pooltool's CueSpecs of a scene's cue, SI, what their end mass means, and what squirt it gives beside ours.

    drive: which end mass is handed over. ValueError if it does not exist, as "A.31" head on and in a miscue.
    """
    solved = Solved(scene)
    masses, reasons = _end_masses(solved)
    if drive in reasons:
        raise ValueError(f"end mass {drive!r} does not exist here: {reasons[drive]}")
    return {
        "for": "pooltool",
        "CueSpecs": _cue_specs(name, scene) | {"end_mass": masses[drive]},
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
        "notes": _notes(scene),
        "squirt": _worth(scene, solved.tip, masses[drive]),
        "units": UNITS,
    }


def _cue_specs(name: str, scene: Scene) -> Record:
    specs: Record = {"brand": name, "M": scene.axial_mass}
    if scene.cue.segments:
        first, last = scene.cue.segments[0], scene.cue.segments[-1]
        specs |= {"length": scene.shaft.length}
        specs |= {"shaft_radius_at_tip": first.tip_diameter / 2, "shaft_radius_at_butt": last.butt_diameter / 2}
    return specs | {"tip_radius": scene.dome_radius or NICKEL}


def _notes(scene: Scene) -> list[str]:
    notes = ["pooltool takes [A.31], an instantaneous stroke without friction's limit: it knows no miscue"]
    if scene.lumped is not None:
        notes.append("a lumped cue has no length and no radii: pooltool's own stay")
    elif scene.shaft.body_mass:
        notes.append("length and shaft_radius_at_butt are those of the file's segments; M is the whole cue's")
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
    return float(formula_of(drive)(solved.tip_stuck, solved.scene))


def _a31_end_mass(scene: Scene, tip: TipModes) -> float:
    offset = scene.stroke.offset
    if offset == 0:
        raise ValueError("[A.31] has no squirt head on; got the offset 0 (--offset takes another)")
    outcome = strike_modes(scene, tip)
    if outcome.regime == "miscue":
        raise ValueError(f"the stroke miscues at offset {offset}; got no end mass")
    return float(scene.ball.mass / alciatore_a31_mass_ratio(offset, outcome.squirt, inertia=POOLTOOL_INERTIA))


def _worth(scene: Scene, tip: TipModes, end_mass: float | None) -> Record:
    """Squirt against the offset, rad: of the coupled strike, and of pooltool with the number handed over."""
    assert end_mass is not None
    struck = [strike_modes(replace(scene, stroke=replace(scene.stroke, offset=b)), tip) for b in OFFSETS]
    theirs = alciatore_a31(np.array(OFFSETS), mass_ratio=scene.ball.mass / end_mass, inertia=POOLTOOL_INERTIA)
    return {
        "offsets": list(OFFSETS),
        "coupled": [outcome.squirt for outcome in struck],
        "regimes": [outcome.regime for outcome in struck],
        "pooltool": theirs.tolist(),
    }
