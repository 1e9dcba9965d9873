"""The end masses of a scene: record and table."""

from __future__ import annotations

from collections.abc import Callable

from rich.console import Group

from cuefem.beam.tip import TipModes
from cuefem.endmass.drives import DEFINITIONS, Spread, end_mass_spreads, formula_of
from cuefem.report.record import Record
from cuefem.report.table import NONE, table_of, with_caption
from cuefem.report.words import _tip_effects, assumptions, grams, significant
from cuefem.scene import Scene
from cuefem.squirt import cue_end_mass


def end_mass_record(scene: Scene, *, tip: TipModes | None = None) -> Record:
    """The end masses m_e, how far they spread over the modes kept, [Kim]'s m_c and eps = m_c/M of each.

    "offset" and "squirt" are those at the scene's own offset. A definition that has no answer here says why instead.
    tip: better tip modes than those that the spread is over, where they are known.
    """
    spread = end_mass_spreads(scene)
    return {
        "contact_time": scene.contact_time,
        "offset": scene.stroke.offset,
        "drives": {drive: _end_mass(scene, spread, drive, tip=tip) for drive in DEFINITIONS},
    }


def _end_mass(scene: Scene, spread: Callable[[str], Spread], drive: str, *, tip: TipModes | None = None) -> Record:
    try:
        felt, lowest, highest, _ = spread(drive)
        if tip is not None:
            felt = formula_of(drive)(tip, scene)
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
    columns = ["definition", "m_e", "spread over modes", "m_c", "eps"]
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
        "m_e: felt across the cue at the tip (offset: what lumped models take); spread: a quarter of the modes to all",
        "m_c = 4 m_e: cue end of the paper's two-part cue (nu_c 1/3); eps: m_c as a part of the ball's mass",
        *_tip_effects(scene, "stick, offset and squirt take effects at the tip for end mass; velocity, force do not"),
    )
