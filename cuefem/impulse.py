"""The impulse solver for any cue: a finite-element cue is lumped first by its end mass of the offset."""

from __future__ import annotations

from dataclasses import replace

from cuefem.cue import Cue, LumpedCue
from cuefem.endmass import end_mass
from cuefem.impact import impact
from cuefem.quantity import check_kind
from cuefem.scene import Outcome, Scene


def impulse(scene: Scene) -> Outcome:
    """Outcome of a stroke from the general impulse solver ([Stronge]'s construction), exact in every regime.

    Array fields of cue, ball, tip and stroke broadcast; a million strokes take about a second. A finite-element cue is
    lumped first, at every offset anew: its axial mass and its end mass "offset" (see `cuefem.end_mass`), ValueError
    where it has none. See `cuefem.impact.impact` for phases and energies.
    """
    check_kind("impulse scene", scene, Scene)
    if scene.effects and isinstance(scene.cue, LumpedCue):
        names = ", ".join(type(effect).__name__ for effect in scene.effects)
        raise ValueError(f"impulse takes a LumpedCue without effects, which need time (see strike); got {names}")
    if isinstance(scene.cue, Cue):
        scene = replace(scene, cue=LumpedCue(scene.axial_mass, end_mass(scene, "offset")), effects=())
    return impact(scene)
