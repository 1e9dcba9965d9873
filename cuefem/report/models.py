"""The models beside the coupled strike: lumped cues that stand for a scene's cue, and Alciatore's formula [A.31]."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from cuefem.beam.tip import TipModes
from cuefem.cue import LumpedCue
from cuefem.endmass.definitions import stick_at_offset
from cuefem.endmass.lumped import lump_modes
from cuefem.quantity.fields import scalar
from cuefem.report.scene_words import tip_effect_notes
from cuefem.results.closed_forms import alciatore_a31
from cuefem.results.records import Record
from cuefem.results.solved_design import at_offset
from cuefem.scene import Scene

# What the numbers beside the coupled strike's rest on, in words that stand without the handbook.
PAPER = "H.-C. Kim's paper (arXiv:2104.11232)"
ALCIATORE = "Alciatore's formula, technical proof A.31 (billiards.colostate.edu)"


def offset_words(scene: Record) -> str:
    """Which end mass the two-part cue has: `end-mass` counts effects at the tip, which a two-part cue cannot have."""
    return "offset, without the effects at the tip" if scene["effects_at_tip"] else "offset"


def two_part_cues(scene: Scene, offsets: Sequence[float], tip: TipModes) -> list[LumpedCue | None]:
    """The lumped cue that the impulse solver takes at each offset, with the end mass of a tip that sticks there.

    Effects at the tip are left out. None at an offset where no end mass has that squirt. A lumped cue keeps its own
    end mass. tip: the cue's tip modes as an end mass takes them.
    """
    if scene.lumped is not None:
        return [replace(scene.lumped, coupling=0.0)] * len(offsets)
    try:
        masses = stick_at_offset(tip, at_offset(scene.bare, np.array(offsets)))
    except ValueError:
        if len(offsets) == 1:
            return [None]
        return [cue for offset in offsets for cue in two_part_cues(scene, [offset], tip)]
    return [LumpedCue(scene.axial_mass, felt) for felt in masses.tolist()]


def coupling_slope(scene: Scene, tip: TipModes) -> float:
    """The coupling per b/R that effects at the tip add to `two_part_cues`; zero if no lumped cue has such a coupling.

    It is found at the scene's own offset, or at 0.1 for a head-on stroke.
    """
    offset = scalar("Stroke.offset", scene.stroke.offset) or 0.1
    try:
        cue = lump_modes(at_offset(scene, offset), tip)
    except ValueError:  # an offset, or an effect, beyond any lumped cue's coupling
        return 0.0
    return scalar("LumpedCue.coupling", cue.coupling) / abs(offset)


def with_coupling(cue: LumpedCue | None, coupling: float) -> LumpedCue | None:
    """The cue with a coupling; None if no cue can have it."""
    try:
        return cue and replace(cue, coupling=coupling)
    except ValueError:
        return None


def bare_scene(scene: Scene, cue: LumpedCue) -> Scene:
    """The scene with a lumped cue in its cue's place, and without effects."""
    return replace(scene, cue=cue, effects=())


def a31_squirt(scene: Scene, cue: LumpedCue) -> Any:
    """The squirt of Alciatore's formula [A.31] for the end mass of a lumped cue, rad."""
    return alciatore_a31(scene.stroke.offset, mass_ratio=scene.ball.mass / cue.end_mass, inertia=scene.ball.inertia)


def model_notes(scene: Record, record: Record, unit: str) -> list[str]:
    """A caption line that says how the lumped models treat effects at the tip, if the scene has any."""
    lumped = (
        f"; lumped includes them as a coupling of {record['coupling']:.4g} {unit}, the tip's "
        "speed across the cue by a unit of impulse along it"
        if record["coupling"]
        else ""
    )
    return tip_effect_notes(scene, f"two-part and A.31 leave the effects at the tip out{lumped}")
