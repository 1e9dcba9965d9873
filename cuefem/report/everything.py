"""The record of the whole report, and the table of all numbers that have none of their own."""

from __future__ import annotations

from rich.console import Group

from cuefem.contact.outcome import grip_of
from cuefem.contact.strike import strike_modes
from cuefem.effects.leather_law import TooDeep
from cuefem.report.end_mass import end_mass_record
from cuefem.report.modes import modes_record
from cuefem.report.record import Record
from cuefem.report.squirt import squirt_record
from cuefem.report.table import table_of, with_caption
from cuefem.report.words import assumptions
from cuefem.results.asking import listed
from cuefem.results.designs import OneDesign
from cuefem.results.quantities import RESULTS, written
from cuefem.scene import Scene
from cuefem.tip_modes import Solved


def report_record(scene: Scene, *, count: int = 6) -> Record:
    """Modes, end masses, squirt and pivot length, all listed results and the grip of the scene's own stroke.

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
    numbers = listed(OneDesign(solved, outcome))
    return found | {"numbers": numbers, "regime": outcome.regime, "grip": grip_of(outcome)}


def numbers_table(numbers: Record, scene: Record) -> Group:
    """Every listed result by its name."""
    table = table_of(f"The cue, and its stroke at offset b/R = {scene['stroke']['offset']:g}", ["", "value"])
    for row in number_rows(numbers):
        table.add_row(*row)
    return with_caption(table, assumptions(scene))


def number_rows(numbers: Record) -> list[tuple[str, str]]:
    """Each result's name in full, and its value with the unit."""
    return [(RESULTS[name].words, written(name, value)) for name, value in numbers.items()]
