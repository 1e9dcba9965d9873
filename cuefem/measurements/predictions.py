"""Computed values of measurements: natural frequencies, stiffness, squirt, contact time; each beam solved once."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from functools import cached_property, lru_cache
from typing import Any, NamedTuple

import numpy as np

from cuefem.beam.assembly import assemble
from cuefem.beam.modes import modes
from cuefem.beam.tip_modes import TipModes
from cuefem.contact.strike import strike_modes
from cuefem.cue import Array, Cue
from cuefem.effects.cue_effects import PointMass, Support
from cuefem.effects.effect import Effect
from cuefem.results.quantities import tip_height
from cuefem.scene import Scene, Stroke
from cuefem.scene.solved_scene import SolvedScene

N_FREQUENCIES = 8  # natural frequencies that are solved together
STATIC_MODES = 8  # modes that the mesh of a static load resolves: error 1e-8


class _Strike(NamedTuple):
    """What is kept of a strike: squirt, rad, contact time, s, and ball speed, m/s."""

    squirt: float
    duration: float
    ball_speed: float


@dataclass(frozen=True, eq=False)
class Predictions:
    """Computed values of the measurements on a scene's cue."""

    scene: Scene
    # tip modes and results, not the solved beams: 32 of these, of a shaft with and without masses, have 35 MB
    _tips: dict[tuple[Effect, ...], TipModes] = field(default_factory=dict, init=False, repr=False)
    _strikes: dict[Scene, _Strike] = field(default_factory=dict, init=False, repr=False)

    @property
    def suspended_effects(self) -> tuple[Effect, ...]:
        """The effects on a freely suspended or weighed cue."""
        return tuple(effect for effect in self.scene.cue_effects if effect.part_of_cue)

    @cached_property
    def frequencies(self) -> Array:
        """Natural frequencies of the freely suspended cue, Hz."""
        return modes(self.scene.shaft, N_FREQUENCIES, effects=self.suspended_effects).frequencies

    def stiffness(self, free_length: float) -> float:
        """Static stiffness, N/m: force over deflection at the ferrule's end, clamped ``free_length`` m behind it."""
        cue = _without_leather(self.scene.shaft)
        if not free_length <= cue.length * (1 + 1e-9):
            raise ValueError(
                f"stiffness free_length must be in (0, {cue.length:.4g}] m, that of the wood; got {free_length}"
            )
        system = assemble(cue, STATIC_MODES, (Support(min(free_length, cue.length), np.inf, np.inf),))
        return system.static_stiffness(0.0)

    def squirt(self, offset: float, speed: float | None = None, added_mass: tuple[float, float] | None = None) -> float:
        """Squirt of the coupled strike, rad; added_mass: mass, kg, and its position, m from the end of the tip."""
        return self._strike(offset, speed, added_mass).squirt

    def ball_speed(self, offset: float, speed: float | None = None) -> float:
        """Speed of the ball after the coupled strike, m/s."""
        return self._strike(offset, speed, None).ball_speed

    def duration(self, speed: float | None = None) -> float:
        """Contact time of a central impact, s."""
        return self._strike(0.0, speed, None).duration

    def _strike(self, offset: float, speed: float | None, added_mass: tuple[float, float] | None) -> _Strike:
        scene = self._with_added_mass(added_mass)
        default = float(scene.stroke.speed)
        scene = replace(scene, stroke=Stroke(default if speed is None else speed, offset))
        if scene not in self._strikes:
            if scene.effects not in self._tips:
                self._tips[scene.effects] = SolvedScene(scene).tip
            outcome = strike_modes(scene, self._tips[scene.effects])
            self._strikes[scene] = _Strike(float(outcome.squirt), float(outcome.duration), float(outcome.ball_speed))
        return self._strikes[scene]

    def drawing_position(self, position: float, name: str) -> float:
        """Position in the drawing of a point ``position`` m from the end of the tip, m; ValueError off the shaft."""
        height, length = tip_height(self.scene), self.scene.shaft.length
        if not 0 <= position - height <= length:
            bound = f"[{height:.4g}, {height + length:.4g}] m, on the shaft"
            raise ValueError(f"{name} must be in {bound}; got {position}")
        return position - height

    def _with_added_mass(self, added_mass: tuple[float, float] | None) -> Scene:
        scene = self.scene
        if added_mass is not None:
            mass, position = added_mass
            at = self.drawing_position(position, "added_mass position")
            scene = replace(scene, effects=(*scene.effects, PointMass(position=at, mass=mass)))
        return scene


# the drawing, and two setups for each of a dozen parameters: the next derivatives are about another point
@lru_cache(maxsize=32)
def predictions_of(scene: Scene) -> Predictions:
    """The computed values of a scene's cue, the same object for the same scene."""
    return Predictions(scene)


def _without_leather(cue: Cue) -> Cue:
    """The cue from the ferrule's end on."""
    height = cue.leather_height
    segments: Any = tuple(s for s, x in zip(cue.segments, cue.nodes, strict=False) if x >= height * (1 - 1e-9))
    return replace(cue, segments=segments) if height else cue
