"""The record of the whole report."""

from __future__ import annotations

from cuefem.contact.strike import strike
from cuefem.report.end_mass import end_mass_record
from cuefem.report.modes import modes_record
from cuefem.report.record import Record
from cuefem.report.squirt import squirt_record
from cuefem.scene import Scene


def report_record(scene: Scene, *, count: int = 6) -> Record:
    """All of it: modes, end masses, squirt and pivot length; and how the scene's own stroke goes."""
    found: Record = {"modes": modes_record(scene, count=count, near=None)} if scene.cue.segments else {}
    found |= {"end_masses": end_mass_record(scene), "squirt": squirt_record(scene)}
    return found | {"regime": strike(scene).regime}
