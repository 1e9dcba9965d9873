"""Strikes as the report takes them: at a resolution that an accuracy asks for, with the modes ended by a tail."""

from __future__ import annotations

from cuefem.accuracy import ladder
from cuefem.beam.modes import modes
from cuefem.beam.tail import tail
from cuefem.beam.tip import TipModes
from cuefem.contact.strike import strike, strike_modes
from cuefem.scene import Outcome, Resolution, Scene
from cuefem.tip_modes import tip_modes_from, turning


def resolution_for(scene: Scene, rtol: float) -> Resolution | None:
    """The least resolution at which a strike's estimated error is within ``rtol``; None of a lumped cue."""
    if scene.lumped is not None:
        return None
    for rung in ladder(scene):
        found = rung.at
        if rung.outcome.error is not None and rung.outcome.error <= rtol:
            break
    return found


def ended_tip_modes(scene: Scene, at: Resolution) -> TipModes:
    """Tip modes at a resolution, ended by a tail as those of `cuefem.accuracy` are."""
    found = modes(scene.shaft, at.modes, effects=scene.cue_effects, at=at)
    return tip_modes_from(tail(found, turning=turning(scene)), scene)


def struck(scene: Scene, at: Resolution | None) -> Outcome:
    """A scene's strike at a resolution, with a tail; of a lumped cue at none."""
    return strike(scene) if at is None else strike_modes(scene, ended_tip_modes(scene, at))
