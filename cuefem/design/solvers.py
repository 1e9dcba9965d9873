"""Two ways to the numbers of many designs, with one answer: together as arrays, or one by one."""

from __future__ import annotations

from collections.abc import Hashable, Sequence
from dataclasses import replace
from functools import cached_property
from typing import Any, Protocol

import numpy as np

from cuefem.beam.modes import Modes, solve
from cuefem.beam.system import assemble
from cuefem.beam.tip import TipModes
from cuefem.contact.strike import strike_modes
from cuefem.cue import Array
from cuefem.design.batch import BatchModes, CueBatch, Stick, batch_frequencies, batch_modes, stick_of
from cuefem.effects import Support
from cuefem.endmass.drives import DEFINITIONS, Definition, flexible, small_offset_slope, stick
from cuefem.endmass.undamped import StickLimit
from cuefem.scene import Outcome, Resolution, Scene
from cuefem.tip_modes import tip_modes_from, tip_modes_of


class Solver(Protocol):
    """What responses ask of a number of designs: arrays (designs, ...) in SI. Computed when asked."""

    scenes: Sequence[Scene]

    @property
    def mass(self) -> Array:
        """Mass of the cue, kg."""

    @property
    def shaft_mass(self) -> Array:
        """Mass of the segments, kg."""

    @property
    def balance_point(self) -> Array:
        """Centre of the segments' mass, m from the tip."""

    @property
    def tip_stiffness(self) -> Array:
        """Static tip stiffness, N/m: see `CueBatch`."""

    @property
    def frequencies(self) -> Array:
        """The lowest bending frequencies, Hz, (designs, n)."""

    @property
    def stick(self) -> Stick:
        """Stick end mass, kg, nan if a design has none, and small-offset squirt over phi."""

    def stick_at(self, offset: float) -> Array:
        """End mass of a tip that sticks at an offset b/R, kg, (designs,)."""

    def end_mass(self, i: int, definition: Definition, offset: float | None) -> float:
        """End mass of a design by a definition, kg, at an offset b/R or at its scene's own."""

    def strike(self, i: int, offset: float | None) -> Outcome:
        """The coupled strike of a design at an offset b/R, or at its scene's own."""


class _Strikes:
    """Coupled strikes of designs by their tip modes, each made once."""

    scenes: Sequence[Scene]

    def __init__(self) -> None:
        self._outcomes: dict[tuple[int, float | None], Outcome] = {}

    def tip(self, i: int) -> TipModes:
        """Tip modes of a design."""
        raise AssertionError(f"{type(self).__name__} has no tip modes of its own")

    def stick_at(self, offset: float) -> Array:
        """End mass of a tip that sticks at an offset b/R, kg, (designs,)."""
        return np.array([self.end_mass(i, DEFINITIONS["offset"], offset) for i in range(len(self.scenes))])

    def end_mass(self, i: int, definition: Definition, offset: float | None) -> float:
        """End mass of a design by a definition, kg, at an offset b/R or at its scene's own."""
        return float(definition.of(self.tip(i), self._scene(i, offset)))

    def _scene(self, i: int, offset: float | None) -> Scene:
        scene = self.scenes[i]
        return scene if offset is None else replace(scene, stroke=replace(scene.stroke, offset=offset))

    def strike(self, i: int, offset: float | None) -> Outcome:
        """The coupled strike of a design at an offset b/R, or at its scene's own; each is made once."""
        if (i, offset) not in self._outcomes:
            self._outcomes[i, offset] = strike_modes(self._scene(i, offset), self.tip(i), recorded=False)
        return self._outcomes[i, offset]


class Together(_Strikes):
    """Bare cues of one topology, as arrays (`CueBatch`); at most some hundred, whose matrices lie in memory."""

    def __init__(self, scenes: Sequence[Scene], at: Resolution, frequencies: int) -> None:
        super().__init__()
        self.scenes, self.at, self._count = scenes, at, frequencies
        self.batch = CueBatch.of([scene.shaft for scene in scenes])

    @property
    def mass(self) -> Array:
        """Mass of the cue, kg."""
        return self.batch.mass

    @property
    def shaft_mass(self) -> Array:
        """Mass of the segments, kg."""
        return self.batch.shaft_mass

    @property
    def balance_point(self) -> Array:
        """Centre of the segments' mass, m from the tip."""
        return self.batch.balance_point

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
        found, n = self._modes, self.at.modes
        return BatchModes(found.frequencies[:, :n], found.tip[:, :n], found.rigid)

    @cached_property
    def stick(self) -> Stick:
        """Stick end mass, kg, nan if a design has none, and small-offset squirt over phi."""
        return stick_of(self.batch, self._kept, self.scenes)

    def tip(self, i: int) -> TipModes:
        """Tip modes of a design, its two rigid motions across the cue as the one that moves the tip."""
        found, scene = self._kept, self.scenes[i]
        omega = np.concatenate([[0.0, 0.0], 2 * np.pi * found.frequencies[i]])
        amplitude, approach = np.zeros((len(omega), 2)), np.zeros(len(omega))
        amplitude[1:, 1] = np.concatenate([[np.sqrt(found.rigid[i])], found.tip[i]])
        amplitude[0, 0], approach[0] = scene.axial_mass**-0.5, scene.axial_mass**0.5
        return TipModes(omega, amplitude, approach, np.zeros(len(omega)))  # the rotation is for effects at the tip


class OneByOne(_Strikes):
    """Any scenes, with effects or lumped cues, by the calls for a single one."""

    def __init__(self, scenes: Sequence[Scene], at: Resolution, frequencies: int) -> None:
        super().__init__()
        self.scenes, self.at, self._count = scenes, at, frequencies
        self._tips: dict[Any, TipModes] = {}
        self._solved: dict[Any, Modes] = {}

    def _of_cues(self, name: str) -> Array:
        return np.array([getattr(scene.cue, name) for scene in self.scenes], dtype=float)

    @property
    def mass(self) -> Array:
        """Mass of the cue, kg."""
        return self._of_cues("mass")

    @property
    def shaft_mass(self) -> Array:
        """Mass of the segments, kg."""
        return self._of_cues("shaft_mass")

    @property
    def balance_point(self) -> Array:
        """Centre of the segments' mass, m from the tip."""
        return self._of_cues("balance_point")

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
            system = assemble(cue, elements=self.at.elements, order=self.at.order, effects=effects)
            count = max(self.at.modes + 2 - system.rigid.shape[1], self._count)
            self._solved[key] = solve(system, count)
        return self._solved[key]

    @property
    def frequencies(self) -> Array:
        """The lowest bending frequencies, Hz, (designs, n)."""
        return np.array([found.frequencies[: self._count] for found in self._modes])

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
        found = self._modes[i]
        count = self.at.modes + 2 - found.rigid
        return replace(found, frequencies=found.frequencies[:count], vectors=found.vectors[:, :count])

    @cached_property
    def stick(self) -> Stick:
        """Stick end mass, kg, nan if a design has none, and small-offset squirt over phi."""
        both = np.array([self._stick(i) for i in range(len(self.scenes))])
        return Stick(both[:, 0], both[:, 1])

    def _stick(self, i: int) -> tuple[Any, float]:
        scene, tip, limit = self.scenes[i], self.tip(i), StickLimit.of(self.scenes[i])
        if scene.lumped is not None:
            return scene.lumped.end_mass, small_offset_slope(tip, scene)
        if scene.effects:
            slope = small_offset_slope(tip, scene)
            none = np.isnan(limit.end_masses(limit.impulse(slope)))
            return np.nan if none else stick(tip, scene), slope
        J = limit.transverse_impulse(*flexible(tip))
        return limit.end_masses(J), float(limit.slope(J))


def key_of(scene: Scene, *parts: Any) -> Hashable:
    """What a scene's modes are kept by: ``parts`` of it, or the scene itself if an effect among them has no hash."""
    try:
        hash(parts)
    except TypeError:
        return id(scene)
    return parts


def static_tip_stiffness(scene: Scene, at: Resolution) -> float:
    """Static tip stiffness, N/m, of a cue with its effects, its butt end clamped: one linear solve of the beam.

    Good to 1e-8; without effects `CueBatch.tip_stiffness` is exact.
    """
    clamp = Support(scene.shaft.length, np.inf, np.inf)
    system = assemble(scene.shaft, elements=at.elements, order=at.order, effects=(*scene.cue_effects, clamp))
    free = system.free
    assert free is not None
    force = free.T @ np.eye(system.mesh.unknowns, 1)[:, 0]
    K = free.T @ system.K @ free
    K = K if isinstance(K, np.ndarray) else K.toarray()
    bent = np.linalg.solve(K, force)
    # the work of the force less the strain energy, twice: the rounding of K enters it squared
    return float(1 / (2 * force @ bent - np.sum(system.strains((free @ bent)[:, None]) ** 2)))
