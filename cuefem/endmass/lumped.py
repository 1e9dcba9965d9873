"""The lumped cue of a finite-element cue, and the impulse solver for it."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from typing import overload

import numpy as np

from cuefem.beam.tip_modes import TipModes
from cuefem.contact.impulse_solver import ImpulseInputs, impact, impacts, impulse_inputs
from cuefem.cue import LumpedCue
from cuefem.endmass.definitions import (
    SEARCH_POINTS,
    end_mass,
    lumped_number,
    stick_at_offset,
    sticking_squirt,
    without_slip,
)
from cuefem.scene import Outcome, Outcomes, Resolution, Scene, as_scenes, check_scene
from cuefem.scene.solved_scene import SolvedScene


def lump(scene: Scene, at: Resolution | None = None) -> LumpedCue:
    """The lumped cue with the squirt of a coupled strike without slip, at the scene's own offset.

    Parameters
    ----------
    scene
        The cue, ball, tip and stroke. A `LumpedCue` is returned unchanged.
    at
        A `Resolution`; by default as in `cuefem.strike`.

    Returns
    -------
    LumpedCue
        Its mass is the cue's axial mass, its end mass "offset" of the cue without tip effects (see `cuefem.end_mass`).
        Effects at the tip (`TipDome`, `TipShear`) determine the coupling, roughly proportional to sin(phi).

    Raises
    ------
    ValueError
        If no lumped cue has that squirt.

    Examples
    --------
    >>> import cuefem as cf
    >>> wood = cf.Material(E=12.6e9, G=0.84e9, rho=700.0)
    >>> cue = cf.Cue((cf.Segment(0.7, 0.012, 0.021, wood),), body_mass=0.43)
    >>> scene = cf.Scene(cue, tip=cf.Tip(contact_time=1e-3), stroke=cf.Stroke(offset=0.3))
    >>> lumped = cf.lump(scene)
    >>> round(1e3 * lumped.end_mass, 1), lumped.coupling  # g, 1/kg
    (4.4, 0.0)
    """
    check_scene("lump scene", scene)
    return scene.lumped or lump_modes(scene, SolvedScene(scene, at).step_tip)


def lump_modes(scene: Scene, tip: TipModes) -> LumpedCue:
    """As `lump`, from the scene's tip modes."""
    if scene.lumped is not None:
        return scene.lumped
    cue = LumpedCue(scene.axial_mass, stick_at_offset(tip, scene.without_tip_effects))
    if not scene.at_tip or scene.stroke.offset == 0:
        return cue
    limit, squirt = (1 - 1e-9) / math.sqrt(cue.mass * cue.end_mass), sticking_squirt(tip, scene)
    couplings = limit * np.linspace(-1.0, 1.0, SEARCH_POINTS)
    coupling = lumped_number("coupling", couplings, squirt, scene=without_slip(scene), cue=cue)
    if coupling is None:
        raise ValueError(f"lump: no coupling of a lumped cue has the squirt {squirt:.6g} rad of a sticking tip")
    return replace(cue, coupling=coupling)


@overload
def impulse(scene: Scene) -> Outcome: ...
@overload
def impulse(scene: Sequence[Scene]) -> Outcomes: ...
def impulse(scene: Scene | Sequence[Scene]) -> Outcome | Outcomes:
    """Outcome of a stroke by the general impulse solver: without time and vibration, exact in every regime.

    Parameters
    ----------
    scene
        Cue, ball, tip and stroke; or a sequence of such scenes. A finite-element cue is first replaced by its axial
        mass and its end mass "offset" (see `cuefem.end_mass`).

    Returns
    -------
    Outcome or Outcomes
        Outcomes of a sequence of scenes. The ``phases`` of an Outcome are the events "slip ends", "greatest
        compression" and "separation" with the normal impulse until then; its energies "ball translation", "ball
        rotation", "cue", "tip loss" and "friction loss" add up to "initial".

    Raises
    ------
    ValueError
        If a lumped cue has effects (see `cuefem.strike`), or if a finite-element cue has no such end mass.

    Notes
    -----
    [Stronge]'s construction in impulse space, with his energetic coefficient of restitution (handbook: The impulse
    solver).

    Examples
    --------
    >>> import cuefem as cf
    >>> scene = cf.Scene(cf.LumpedCue.two_part(mass=0.54, cue_end_mass=0.012), stroke=cf.Stroke(offset=0.3))
    >>> outcome = cf.impulse(scene)
    >>> outcome.regime, round(outcome.squirt, 4)  # rad
    ('stick', 0.0127)
    """
    if isinstance(scene, Scene):
        return impact(_lumped_numbers(scene))
    inputs = [_lumped_numbers(item) for item in as_scenes("impulse scene", scene)]
    return impacts(ImpulseInputs(*np.transpose(inputs)))


def _lumped_numbers(scene: Scene) -> ImpulseInputs:
    if scene.effects and scene.lumped is not None:
        names = ", ".join(type(effect).__name__ for effect in scene.effects)
        raise ValueError(f"impulse scene must have no effects on a LumpedCue (use strike for them); got {names}")
    return impulse_inputs(scene, scene.lumped or LumpedCue(scene.axial_mass, end_mass(scene, "offset")))
