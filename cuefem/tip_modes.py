"""The resolution meant where none is given, and a scene's tip modes at a resolution.

Where a Resolution is given, the modes asked for are summed plainly. Where none is, modes are kept by frequency and
ended by a tail (`cuefem.beam.tail`), without which no bound on their frequency holds every cue to half a percent.
"""

from __future__ import annotations

import math
from itertools import chain

import numpy as np

from cuefem.beam import assemble
from cuefem.beam.modes import Modes, solve
from cuefem.beam.tail import tail
from cuefem.beam.tip import TipModes, tip_modes
from cuefem.beam.waves import mesh_for, modes_below
from cuefem.cue import Cue
from cuefem.quantity import CONTACT_TIME
from cuefem.scene import Resolution, Scene

# Modes are kept up to this many periods in a contact, with a tail; a plain sum wants more, the carbon cue's is 1 % off
# even with a hundred.
PERIODS_KEPT, PLAIN_PERIODS = 30, 60
# But never fewer than LEAST, however long the contact. The end mass of a tip that sticks needs more: its velocity
# begins with a step, whose front comes back from the butt at 2 L/c with frequencies of 10 to 80 kHz, whatever the
# contact time. What these numbers hold: studies/default_accuracy.md.
LEAST, LEAST_STUCK = 40, 120
# Never more than this by default, which a contact of a fraction of a millisecond would ask for: the tail does the rest,
# and more would take over a second. MOST is the last rung of `resolve`.
MOST_KEPT, MOST = 160, 400


def default_resolution(scene: Scene, *, periods: float = PERIODS_KEPT, least: int = LEAST) -> Resolution:
    """The resolution meant where none is given: modes kept by frequency, up to ``periods`` / contact time, at least
    ``least``."""
    assert isinstance(scene.cue, Cue)
    if not CONTACT_TIME.holds(scene.contact_time):  # that of a stiffness: one that is given is bounded already
        got = f"{scene.tip.stiffness:.6g} N/m, {scene.contact_time:.3g} s"
        raise ValueError(f"Tip.stiffness must make a head-on contact time in {CONTACT_TIME.bounds}; got {got}")
    count = min(max(modes_below(scene.cue, 2 * np.pi * periods / scene.contact_time), least), MOST_KEPT)
    elements, order = mesh_for(scene.cue, count)
    return Resolution(elements, order, count)


def tip_modes_of(scene: Scene, at: Resolution | None = None, *, least: int = LEAST) -> TipModes:
    """Tip modes of the scene's finite-element cue, with its effects; with a tail where no resolution is given."""
    return tip_modes_from(modes_of(scene, at, least=least), scene)


def modes_of(scene: Scene, at: Resolution | None = None, *, least: int = LEAST) -> Modes:
    """Bending modes that a strike of the scene's finite-element cue takes; with a tail where no resolution is given."""
    if at is not None:
        return _kept(scene, at)
    return tail(_kept(scene, default_resolution(scene, least=least)), turning=turning(scene))


def _kept(scene: Scene, at: Resolution) -> Modes:
    assert isinstance(scene.cue, Cue)
    system = assemble(scene.cue, elements=at.elements, order=at.order, effects=scene.cue_effects)
    # a support makes flexible modes of rigid ones: with it as many modes in all, so that its limits are continuous
    return solve(system, at.modes + 2 - system.rigid.shape[1])


def turning(scene: Scene) -> bool:
    """Whether an effect takes the contact off the cue's axis, so that the tip's rotation moves it."""
    return any(scene.contact_terms.lever(math.pi / 6))


def tip_modes_from(found: Modes, scene: Scene) -> TipModes:
    """Tip modes of the scene's finite-element cue from its bending modes, with what its effects add to them."""
    assert isinstance(scene.cue, Cue)
    effects = scene.cue_effects
    tip = tip_modes(found, scene.axial_mass)
    along = tuple(chain.from_iterable(effect.vibrations(found, scene.cue, effects) for effect in effects))
    for family in along:
        tip = tip.beside(family.omega, family.along, family.radiation)
    for effect in effects:
        tip = effect.damp(tip, scene.cue, (found, *along))
    return tip.ascending() if along else tip
