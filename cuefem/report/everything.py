"""The record of the whole report."""

from __future__ import annotations

from cuefem.contact.outcome import grip_of
from cuefem.contact.strike import strike_modes
from cuefem.effects.leather_law import TooDeep
from cuefem.report.end_mass import end_mass_record
from cuefem.report.modes import modes_record
from cuefem.report.record import Record
from cuefem.report.squirt import squirt_record
from cuefem.scene import Scene
from cuefem.tip_modes import Solved


def report_record(scene: Scene, *, count: int = 6) -> Record:
    """Modes, end masses, squirt and pivot length, and the grip of the scene's own stroke, from one solved scene.

    Where the stroke presses a leather tip further than its law is known, modes and the reason, "no_contact".
    """
    solved = Solved(scene)
    found: Record = {"modes": modes_record(scene, count=count, near=None)} if scene.cue.segments else {}
    try:
        scene.contact_time  # noqa: B018
    except TooDeep as error:
        return found | {"no_contact": str(error)}
    found |= {"end_masses": end_mass_record(scene, solved=solved), "squirt": squirt_record(scene, solved=solved)}
    outcome = strike_modes(scene, solved.tip)
    return found | {"regime": outcome.regime, "grip": grip_of(outcome)}
