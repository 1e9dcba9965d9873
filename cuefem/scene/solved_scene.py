"""From a scene to its tip modes, the one way for every cue; and the default resolution.

Tip modes determine the impact of a cue. A lumped cue has two of them, of zero frequency. With a Resolution, a
finite-element cue has the truncated sum over the requested modes. By default modes are retained by frequency and a
truncation correction replaces the others (`cuefem.beam.truncation`); without it no frequency bound would serve every
cue. The beam's solver is loaded when a finite-element cue is solved.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace
from functools import cached_property
from itertools import chain
from typing import TYPE_CHECKING

import numpy as np

from cuefem.beam.blas_threads import one_blas_thread
from cuefem.beam.mode_count import modes_below
from cuefem.beam.tip_modes import TipModes, embedded, free_tip_modes, lumped_tip_modes, tip_modes
from cuefem.cue import Cue
from cuefem.quantity.fields import CONTACT_TIME
from cuefem.scene import Resolution, Scene
from cuefem.solid.solid_resolution import Solid

if TYPE_CHECKING:
    from cuefem.beam.modes import Modes

# Modes are retained up to PERIODS periods in a contact with a truncation correction, and up to TRUNCATED_SUM_PERIODS
# without: the carbon cue's error is 1 % even at 100. Long contacts have at least MIN_MODES.
PERIODS, TRUNCATED_SUM_PERIODS, MIN_MODES = 30, 60, 40
# Restitution e down to which these modes and steps resolve the unloading, too, which is 1/e times as fast; below it
# the contact has more modes, and shorter steps while the tip unloads.
RESOLVED_RESTITUTION = 0.5
# The least restitution of a contact computed in time, which needs 1/e times as many steps.
MIN_RESTITUTION = 0.05
# The same for a strike with a leather tip, whose tangential compliance leaves no velocity step at the shaft's end: over
# 160 random cues the error of squirt, with 200 steps, is 8.5e-5 (95th percentile), 1.3e-4 (maximum).
LEATHER_PERIODS, MIN_LEATHER_MODES = 8, 12
# The end mass of a pulse that begins without a step, on a mesh for PULSE_MESH of its modes: over 60 random cues and
# whole scenes of 0.5 to 2 ms the error by force is 3.7e-4 (95th percentile), 4.5e-4 (maximum); on a mesh for all of
# them 1.9e-4, 5.1e-4; with the modes of a strike, 30 periods and 40, 6.2e-4, 1.3e-3.
PULSE_PERIODS, MIN_PULSE_MODES, PULSE_MESH = 60, 80, 0.75
# The end mass of a tip that sticks without compliance needs more: its velocity begins with a step, whose front returns
# from the butt after 2 L/c with frequencies of 10 to 80 kHz, at any contact time. The mesh resolves the first
# MESHED_MODES of them; the others only add compliance: the end mass is as accurate as on a mesh for 160 (50 shafts, 50
# whole cues).
# Accuracy with these numbers: studies/accuracy/accuracy.md.
MIN_STICK_MODES, MESHED_MODES = 160, 120
# Limit of the default number, which contacts of a fraction of a millisecond reach: the truncation correction replaces
# the others, and more would take over a second. MAX_MODES: the last level of a refinement.
MAX_DEFAULT_MODES, MAX_MODES = 160, 400


def strike_mode_count(scene: Scene) -> int:
    """Number of modes of a strike.

    A tip of restitution e unloads 1/e times as fast as it loads. The impulse that begins a contact of infinite friction
    sends out waves that twice the modes resolve.
    """
    part = min(1.0, max(scene.tip.restitution, MIN_RESTITUTION) / RESOLVED_RESTITUTION)
    if scene.contact_terms.tip is not None:
        return default_mode_count(scene, part=part, periods=LEATHER_PERIODS, min_modes=MIN_LEATHER_MODES)
    factor = 2 if math.isinf(scene.tip.friction) else 1
    return default_mode_count(scene, part=part, periods=factor * PERIODS, min_modes=factor * MIN_MODES)


def default_mode_count(scene: Scene, *, part: float = 1.0, periods: float = PERIODS, min_modes: int = MIN_MODES) -> int:
    """The number of modes up to the frequency ``periods`` / (part of the contact time), at least ``min_modes``."""
    # a contact time in the input is within bounds; one computed from a stiffness or a leather tip may not be
    if not CONTACT_TIME.contains(scene.contact_time):
        got = f"{scene.stiffness:.6g} N/m, {scene.contact_time:.3g} s"
        raise ValueError(f"Tip.stiffness must make a head-on contact time in {CONTACT_TIME.bounds}; got {got}")
    return mode_count_for(scene.shaft, part * scene.contact_time, periods=periods, min_modes=min_modes)


def mode_count_for(cue: Cue, time: float, *, periods: float = PERIODS, min_modes: int = MIN_MODES) -> int:
    """The number of modes up to the frequency ``periods`` / time, at least ``min_modes``."""
    return min(max(modes_below(cue, 2 * np.pi * periods / time), min_modes), MAX_DEFAULT_MODES)


@dataclass(frozen=True, eq=False)
class SolvedScene:
    """A scene and its modes; each eigenproblem is solved once, on first use.

    Nothing here depends on the stroke: one solved scene serves strikes at every speed and offset. at: the resolution of
    all modes; by default the modes of `strike_mode_count`, with a truncation correction. solved_modes: solved modes by
    resolution or number, number that the mesh resolves and loads, which scenes of one cue and effects share.
    """

    scene: Scene
    at: Resolution | Solid | None = None
    solved_modes: dict[tuple[Resolution | int, int | None, int], Modes] = field(default_factory=dict, repr=False)

    @property
    def modes(self) -> Modes:
        """Bending modes of a strike; ValueError for a lumped cue, which has none."""
        if isinstance(self.at, Solid):
            raise ValueError("at must be a Resolution, because mode shapes of a beam are required; got a Solid")
        if self.at is not None:
            return self._bending(self.at, with_correction=False)
        return self._default(strike_mode_count(self.scene))

    @cached_property
    def tip(self) -> TipModes:
        """Tip modes of a strike."""
        if self.scene.lumped is not None:
            return lumped_tip_modes(self.scene.lumped)
        if isinstance(self.at, Solid):
            from cuefem.solid.shaft import face_loaded_modes

            solid = face_loaded_modes(self.scene.shaft, self.at, mass_on_face(self.scene))
            return free_tip_modes(solid.omega, *solid.at_tip, self.scene.axial_mass)
        return tip_modes_from(self.modes, self.scene)

    @cached_property
    def pulse_tip(self) -> TipModes:
        """Tip modes for an end mass whose drive begins without a step: at least `MIN_PULSE_MODES` by default.

        The mesh resolves the share `PULSE_MESH` of them.
        """
        if self.at is not None or self.scene.lumped is not None:
            return self.tip
        count = default_mode_count(self.scene, periods=PULSE_PERIODS, min_modes=MIN_PULSE_MODES)
        bending = self._default(count, meshed=round(PULSE_MESH * count))
        return tip_modes_from(bending, self.scene, axial_force=False, axial_waves=False)

    @property
    def stick_tip(self) -> TipModes:
        """Tip modes for a tip that sticks: those of a strike if the tip is compliant, otherwise `step_tip`."""
        return self.step_tip if self.scene.contact_terms.tip is None else self.tip

    @cached_property
    def step_tip(self) -> TipModes:
        """Tip modes for an end mass whose drive begins with a velocity step: at least `MIN_STICK_MODES` by default.

        They are without geometric stiffness, as every end mass with such a drive.
        """
        if self.at is not None or self.scene.lumped is not None:
            return self.tip
        bending = self._default(default_mode_count(self.scene, min_modes=MIN_STICK_MODES))
        return tip_modes_from(bending, self.scene, axial_force=False)

    def _default(self, count: int, *, meshed: int = MESHED_MODES) -> Modes:
        return self._bending(count, with_correction=True, mesh_modes=min(count, meshed))

    def _bending(self, at: Resolution | int, *, with_correction: bool, mesh_modes: int | None = None) -> Modes:
        """Bending modes at a resolution, or a number of them; each solved once.

        with_correction: with a truncation correction; otherwise a truncated sum. mesh_modes: number of modes that the
        mesh resolves, by default all.
        """
        scene = self.scene
        loads = 0 if not with_correction else 2 if has_moment_arm(scene) else 1
        key = (at, mesh_modes, loads)
        if key not in self.solved_modes:
            from cuefem.beam import assembly, modes

            n_modes = at if isinstance(at, int) else at.modes
            beam = assembly.assemble(scene.shaft, mesh_modes or at, scene.cue_effects, n_modes)
            # a support makes rigid-body modes flexible; the total number of modes stays the same, so that results
            # are continuous as its stiffness vanishes
            n_modes += 2 - beam.rigid_basis.shape[1]
            self.solved_modes[key] = modes.solve(beam, n_modes, n_corrected=loads)
        return self.solved_modes[key]


@one_blas_thread
def tip_modes_of(scene: Scene, at: Resolution | Solid | None = None) -> TipModes:
    """Tip modes of a strike of any scene's cue, with its effects."""
    return SolvedScene(scene, at).tip


def corrected_tip_modes(scene: Scene, *counts: int) -> list[TipModes]:
    """Tip modes of a finite-element cue from each number of bending modes with a truncation correction.

    One eigenproblem, on the mesh for the largest number.
    """
    finest = SolvedScene(scene)._bending(max(counts), with_correction=True)
    extra = 2 - finest.rigid
    return [tip_modes_from(finest.lowest(count + extra), scene) for count in counts]


def has_moment_arm(scene: Scene) -> bool:
    """Whether an effect moves the contact off the cue's axis, so that the tip's rotation moves it."""
    return any(scene.contact_terms.moment_arm(math.pi / 6))


@one_blas_thread
def tip_modes_from(bending: Modes, scene: Scene, *, axial_force: bool = True, axial_waves: bool = True) -> TipModes:
    """Tip modes of the scene's finite-element cue from its bending modes and its effects.

    axial_force: whether the axial force of the impact acts on the bent cue (geometric stiffness). axial_waves: whether
    the cue vibrates along its axis. A prescribed drive across the axis needs neither.
    """
    cue, effects = scene.shaft, scene.cue_effects
    tip = tip_modes(bending, scene.axial_mass)
    if axial_force:
        stiffness = (effect.geometric_stiffness(bending, cue, effects) for effect in effects)
        matrices = [matrix for matrix in stiffness if matrix is not None]
        if matrices:  # the first of the tip modes is the axial rigid-body mode
            tip = replace(tip, geometric=embedded(sum(matrices[1:], matrices[0]), len(tip.omega), first=1))
    waves = effects if axial_waves else ()
    families = tuple(chain.from_iterable(effect.axial_modes(bending, cue, effects) for effect in waves))
    for family in families:
        tip = tip.with_axial_modes(family.omega, family.tip_displacement, family.radiation)
    for effect in effects:
        tip = effect.damp(tip, [(cue, bending), *((rod.cue, rod) for rod in families)])
    return tip.ascending() if families else tip


def mass_on_face(scene: Scene) -> float:
    """Mass that the scene's effects put on the tip's face, kg; ValueError for effects that a solid cannot have."""
    mass = 0.0
    for effect in scene.cue_effects:
        added = effect.mass_on_face(scene.shaft)
        if added is None:
            raise ValueError(
                "Scene.effects must be those that a Solid can have, at the tip or masses on its face; got "
                f"{type(effect).__name__}"
            )
        mass += added
    return mass
