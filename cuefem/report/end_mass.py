"""The end masses of a scene: record and table."""

from __future__ import annotations

from collections.abc import Callable

from rich.console import Group

from cuefem.endmass.drives import DEFINITIONS, Spread, spreads_of
from cuefem.report.record import Record
from cuefem.report.table import table_of, with_caption
from cuefem.report.words import assumptions, listed, tip_effect_notes
from cuefem.results.quantities import NONE, grams, significant
from cuefem.scene import Scene
from cuefem.squirt import cue_end_mass
from cuefem.tip_modes import Solved


def end_mass_record(scene: Scene, *, solved: Solved | None = None) -> Record:
    """The end masses m_e, their range while fewer modes are kept, and [Kim]'s m_c and eps = m_c/M of each.

    A definition `at_offset` is taken at the scene's own offset; one that has no answer says why instead. solved: the
    scene's modes, if they are known already.
    """
    spread = spreads_of(solved or Solved(scene))
    return {
        "contact_time": scene.contact_time,
        "offset": scene.stroke.offset,
        "drives": {drive: _end_mass(scene, spread, drive) for drive in DEFINITIONS},
    }


def _end_mass(scene: Scene, spread: Callable[[str], Spread], drive: str) -> Record:
    try:
        felt, lowest, highest, _ = spread(drive)
    except ValueError as error:
        names = ("end_mass", "lowest", "highest", "cue_end_mass", "eps")
        return {**dict.fromkeys(names), "reason": str(error)}
    if not felt > 0:
        raise ValueError(
            f"the end mass comes out as {1e3 * felt:.4g} g ({drive}), which no cue has: its tip is far too weak for a "
            f"contact of {1e3 * float(scene.contact_time):.4g} ms; check sizes, E and the contact time"
        )
    whole = float(cue_end_mass(felt))
    return {
        "end_mass": felt,
        "lowest": lowest,
        "highest": highest,
        "cue_end_mass": whole,
        "eps": whole / scene.ball.mass,
    }


def end_mass_table(record: Record, scene: Record) -> Group:
    """The end masses by definition."""
    columns = ["definition", "m_e", "spread", "m_c", "eps"]
    table = table_of("Effective end mass", columns)
    refused = []
    for drive, values in record["drives"].items():
        name = f"{drive}, at b/R {record['offset']:g}" if DEFINITIONS[drive].at_offset else drive
        if values["end_mass"] is None:
            table.add_row(name, *[NONE] * 4)
            refused.append(f"{drive}: {values['reason']}")
            continue
        spread = f"{significant(1e3 * values['lowest'])}–{grams(values['highest'])}"
        row = (grams(values["end_mass"]), spread, grams(values["cue_end_mass"]), f"{values['eps']:.4f}")
        table.add_row(name, *row)
    return with_caption(
        table,
        assumptions(scene),
        *refused,
        "m_e: effective end mass, the inertia felt by the ball across the cue at its tip (lumped models take offset)",
        "spread: range while keeping 25 to 100 % of the modes",
        "m_c = 4 m_e: cue end of the paper's two-part cue (nu_c 1/3); eps: m_c as a part of the ball's mass",
        *tip_effect_notes(scene, _counted()),
    )


def _counted() -> str:
    """Which definitions count effects at the tip as end mass."""
    counting, others = ([one.name for one in DEFINITIONS.values() if one.counts_tip is c] for c in (True, False))
    return (
        f"{listed(counting)} count effects at the tip as end mass; {listed(others)} do not, nor does the offset end "
        "mass of the two-part cues in `strike` and `report`"
    )
