"""A finite-element cue as two numbers, and the impulse solver that takes them."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from cuefem.beam.tip import TipModes
from cuefem.contact.flow import zero
from cuefem.contact.impulse_space import impact
from cuefem.cue import LumpedCue
from cuefem.endmass.drives import _gripping, end_mass, stick_at_offset, sticking_squirt
from cuefem.quantity import check_kind, scalar
from cuefem.scene import Outcome, Resolution, Scene
from cuefem.tip_modes import Solved


def lump(scene: Scene, at: Resolution | None = None) -> LumpedCue:
    """The lumped cue that squirts as the coupled strike does at the scene's own offset, while its tip sticks.

    Its end mass is "offset" of the cue alone; what effects at the tip (`TipDome`, `TipShear`) add or take goes into the
    coupling, about proportional to sin(phi). ValueError where no lumped cue squirts so.
    """
    return scene.lumped or lump_modes(scene, Solved(scene, at).tip_stuck)


def lump_modes(scene: Scene, tip: TipModes) -> LumpedCue:
    """The same of a cue that is given by its tip modes."""
    if scene.lumped is not None:
        return scene.lumped
    cue = LumpedCue(scene.axial_mass, stick_at_offset(tip, scene.bare))
    if not scene.at_tip or scalar("Stroke.offset", scene.stroke.offset) == 0:
        return cue
    return replace(cue, coupling=_coupling(cue, scene, sticking_squirt(tip, scene)))


def _coupling(cue: LumpedCue, scene: Scene, squirt: float) -> float:
    """The coupling with which a lumped cue's squirt, where its tip never slips, is ``squirt`` rad."""
    most, side = (1 - 1e-9) / math.sqrt(cue.mass * cue.end_mass), np.sign(scene.stroke.offset)

    def excess(part: float) -> float:
        coupled = replace(cue, coupling=part * most)
        return float(side * impact(replace(_gripping(scene), cue=coupled, effects=())).squirt) - squirt

    if not excess(-1.0) < 0 < excess(1.0):
        raise ValueError(f"lump: no coupling of a lumped cue has the squirt {squirt:.6g} rad of a tip that sticks")
    return most * zero(excess, -1.0, 1.0)


def impulse(scene: Scene) -> Outcome:
    """Outcome of a stroke from the general impulse solver ([Stronge]'s construction), exact in every regime.

    Array fields of cue, ball, tip and stroke broadcast; a million strokes take about a second. A finite-element cue is
    lumped first, at every offset anew: its axial mass and its end mass "offset" (see `cuefem.end_mass`), ValueError
    where it has none. See `cuefem.contact.impulse_space.impact` for phases and energies.
    """
    check_kind("impulse scene", scene, Scene)
    if scene.effects and scene.lumped is not None:
        names = ", ".join(type(effect).__name__ for effect in scene.effects)
        raise ValueError(f"impulse takes a LumpedCue without effects, which need time (see strike); got {names}")
    if scene.lumped is None:
        scene = replace(scene, cue=LumpedCue(scene.axial_mass, end_mass(scene, "offset")), effects=())
    return impact(scene)
