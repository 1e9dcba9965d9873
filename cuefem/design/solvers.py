"""Two ways to the numbers of many designs, with one answer: together as arrays, or one by one."""

from __future__ import annotations

from collections.abc import Hashable, Sequence
from functools import cached_property
from typing import Any

import numpy as np

from cuefem.beam.modes import Modes, solve
from cuefem.beam.system import assemble
from cuefem.beam.tip import TipModes
from cuefem.cue import Array
from cuefem.design.batch import BatchModes, CueBatch, batch_frequencies, batch_modes, stick_of
from cuefem.results.solved_design import Designs, Stick, static_tip_stiffness
from cuefem.scene import Resolution, Scene
from cuefem.tip_modes import tip_modes_from, tip_modes_of


class Together(Designs):
    """Bare cues of one topology, as arrays (`CueBatch`); at most some hundred, whose matrices lie in memory."""

    def __init__(self, scenes: Sequence[Scene], at: Resolution, frequencies: int) -> None:
        super().__init__(scenes)
        self.at, self._count = at, frequencies
        self.batch = CueBatch.of([scene.shaft for scene in scenes])

    @property
    def tip_stiffness(self) -> Array:
        """Static tip stiffness, N/m: see `CueBatch`."""
        return self.batch.tip_stiffness

    @cached_property
    def frequencies(self) -> Array:
        """The lowest bending frequencies, Hz, (designs, n)."""
        if "_modes" in vars(self):  # with vectors, for other responses
            return self._modes.frequencies
        return batch_frequencies(self.batch, self._count, at=self.at)

    @cached_property
    def _modes(self) -> BatchModes:
        return batch_modes(self.batch, max(self.at.modes, self._count), at=self.at)

    @cached_property
    def _kept(self) -> BatchModes:
        """The modes that a contact takes."""
        modes, n = self._modes, self.at.modes
        return BatchModes(modes.frequencies[:, :n], modes.tip[:, :n], modes.rigid)

    @cached_property
    def stick(self) -> Stick:
        """Stick end mass, kg, nan if a design has none, and small-offset squirt over phi."""
        return stick_of(self.batch, self._kept, self.scenes)

    def tip(self, i: int) -> TipModes:
        """Tip modes of a design, its two rigid motions across the cue as the one that moves the tip."""
        modes, scene = self._kept, self.scenes[i]
        omega = np.concatenate([[0.0, 0.0], 2 * np.pi * modes.frequencies[i]])
        amplitude, approach = np.zeros((len(omega), 2)), np.zeros(len(omega))
        amplitude[1:, 1] = np.concatenate([[np.sqrt(modes.rigid[i])], modes.tip[i]])
        amplitude[0, 0], approach[0] = scene.axial_mass**-0.5, scene.axial_mass**0.5
        return TipModes(omega, amplitude, approach, np.zeros(len(omega)))  # the rotation is for effects at the tip


class OneByOne(Designs):
    """Any scenes, with effects or lumped cues, by the calls for a single one."""

    def __init__(self, scenes: Sequence[Scene], at: Resolution, frequencies: int) -> None:
        super().__init__(scenes)
        self.at, self._count = at, frequencies
        self._tips: dict[Any, TipModes] = {}
        self._solved: dict[Any, Modes] = {}

    @property
    def tip_stiffness(self) -> Array:
        """Static tip stiffness, N/m: see `CueBatch`."""
        return np.array([static_tip_stiffness(scene, self.at) for scene in self.scenes])

    @cached_property
    def _modes(self) -> list[Modes]:
        return [self._solve(scene) for scene in self.scenes]

    def _solve(self, scene: Scene) -> Modes:
        """Modes of a scene's cue; those of equal cues with equal effects are solved once."""
        cue, effects = scene.shaft, scene.cue_effects
        key = key_of(scene, cue, effects)
        if key not in self._solved:
            system = assemble(cue, self.at, effects)
            count = max(self.at.modes + 2 - system.rigid.shape[1], self._count)
            self._solved[key] = solve(system, count)
        return self._solved[key]

    @property
    def frequencies(self) -> Array:
        """The lowest bending frequencies, Hz, (designs, n)."""
        return np.array([modes.frequencies[: self._count] for modes in self._modes])

    def tip(self, i: int) -> TipModes:
        """Tip modes of a design, with its effects; those of designs that have the same are one object."""
        scene = self.scenes[i]
        if not scene.cue.segments:
            return tip_modes_of(scene)
        alike = key_of(scene, scene.cue, scene.cue_effects, float(scene.axial_mass))
        if alike not in self._tips:
            self._tips[alike] = tip_modes_from(self._kept(i), scene)
        return self._tips[alike]

    def _kept(self, i: int) -> Modes:
        """The modes that a contact takes: with a support as many in all as without (`tip_modes_of`)."""
        modes = self._modes[i]
        return modes.those(np.arange(self.at.modes + 2 - modes.rigid))


def key_of(scene: Scene, *parts: Any) -> Hashable:
    """What a scene's modes are kept by: ``parts`` of it, or the scene itself if an effect among them has no hash."""
    try:
        hash(parts)
    except TypeError:
        return id(scene)
    return parts
