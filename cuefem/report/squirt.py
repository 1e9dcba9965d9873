"""Squirt and pivot length against the offset: records and tables."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Any

import numpy as np
from rich.console import Group
from rich.table import Table

from cuefem.beam.tip import TipModes
from cuefem.contact.strike import strike_modes
from cuefem.cue import LumpedCue
from cuefem.endmass.lumped import impulse
from cuefem.report.record import Record
from cuefem.report.strike import (
    _a31,
    _at,
    _coupled,
    _coupling_slope,
    _left_out,
    _pivot_length,
    bare_scene,
    two_part_cues,
)
from cuefem.report.table import NONE, table_of, with_caption
from cuefem.report.words import assumptions, degrees, grams, millimetres, significant
from cuefem.scene import Outcome, Scene
from cuefem.tip_modes import tip_modes_of

OFFSETS = (0.1, 0.2, 0.3, 0.4, 0.5)

PAPER_CUE_END_MASS = 0.012  # kg, [Kim]'s m_c of a real cue; the tip feels a quarter of it


def _curve(
    scene: Scene,
    offsets: Sequence[float],
    cues: Sequence[LumpedCue | None],
    squirt: Callable[[Scene, LumpedCue], Any] = lambda scene, cue: impulse(bare_scene(scene, cue)).squirt,
) -> Record:
    """Squirt and natural pivot length of a lumped cue an offset, nan where there is none."""
    found: Record = {"squirt": np.full(len(offsets), np.nan), "pivot_length": np.full(len(offsets), np.nan)}
    for i, (offset, cue) in enumerate(zip(offsets, cues, strict=True)):
        if cue is not None:
            struck = _at(scene, offset)
            found["squirt"][i] = squirt(struck, cue)
            found["pivot_length"][i] = _pivot_length(struck, found["squirt"][i])
    return found


def two_part_curve(scene: Scene, offsets: Sequence[float], tip: TipModes) -> Record:
    """The impulse solver's squirt and natural pivot length against the offset, each with its own `two_part_cues`."""
    return _curve(scene, offsets, two_part_cues(scene, offsets, tip))


def squirt_record(scene: Scene, offsets: Sequence[float] = OFFSETS, *, tip: TipModes | None = None) -> Record:
    """Squirt and natural pivot length against the offset: coupled in time, lumped (where effects at the tip couple the
    cue's motions), two parts of this cue, [Kim]'s 12 g, [A.31]; nan where there is no lumped cue. "end_mass": that of
    the tip that sticks at each offset, without effects at the tip.

    tip: the cue's tip modes, where they are known.
    """
    tip = tip_modes_of(scene) if tip is None else tip
    cues, slope = two_part_cues(scene, offsets, tip), _coupling_slope(scene, tip)
    struck = _struck(scene, offsets, tip)
    coupled = np.array([outcome.squirt for outcome in struck])
    pivots = _pivot_length(_at(scene, np.array(offsets)), coupled)
    found: Record = {"coupled, this cue": {"squirt": coupled, "pivot_length": pivots}}
    if slope:
        lumped = [_coupled(cue, slope * abs(b)) for cue, b in zip(cues, offsets, strict=True)]
        found["lumped, this cue"] = _curve(scene, offsets, lumped)
    papers = LumpedCue.two_part(scene.axial_mass, PAPER_CUE_END_MASS)
    found["two-part, this cue"] = _curve(scene, offsets, cues)
    found["two-part, 12 g"] = _curve(scene, offsets, [papers] * len(offsets))
    found["A.31, this cue"] = _curve(scene, offsets, cues, _a31)
    found["coupled, this cue"]["regime"] = [outcome.regime for outcome in struck]
    return {
        "offsets": list(offsets),
        "end_mass": [None if cue is None else cue.end_mass for cue in cues],
        "coupling": slope,
        "models": found,
    }


def _struck(scene: Scene, offsets: Sequence[float], tip: TipModes) -> list[Outcome]:
    scenes = [replace(scene, stroke=replace(scene.stroke, offset=b)) for b in offsets]
    return [strike_modes(one, tip) for one in scenes]


def _by_offset(title: str, record: Record, *, key: str, written: Any) -> Table:
    models = record["models"]
    table = table_of(title, ["b/R", *models], text_columns=0)
    for i, offset in enumerate(record["offsets"]):
        cells = (written(model[key][i]) + _missed(model, i) for model in models.values())
        table.add_row(f"{offset:g}", *cells)
    return table


def _missed(model: Record, i: int) -> str:
    """A word beside the number of a stroke that miscues, where a model tells."""
    return ", miscue" if "miscue" in model.get("regime", ())[i : i + 1] else ""


def squirt_table(record: Record, scene: Record) -> Group:
    """Squirt against the offset."""
    known = [mass for mass in record["end_mass"] if mass is not None]
    felt = f"{significant(1e3 * known[0])} to {grams(known[-1])}" if known else NONE
    models = (
        f"coupled: in time; two-part: m_e {felt} (offset); 12 g: the paper's m_c, m_e 3 g; A.31: Alciatore's formula"
    )
    table = _by_offset("Squirt", record, key="squirt", written=degrees)
    return with_caption(table, assumptions(scene), models, *_left_out(scene, record, "b/R /kg"))


def pivot_table(record: Record) -> Group:
    """Natural pivot length against the offset."""
    caption = "from the tip to the bridge about which turning the cue undoes squirt"
    table = _by_offset("Natural pivot length", record, key="pivot_length", written=millimetres)
    return with_caption(table, caption)
