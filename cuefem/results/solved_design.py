"""Solved designs: what the numbers of a scene are computed from, for one as for many, and all that can be asked."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import replace
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np

from cuefem.beam.modes import modes
from cuefem.beam.system import assemble
from cuefem.beam.tip import TipModes
from cuefem.contact.outcome import grip_of
from cuefem.contact.strike import strike_modes
from cuefem.cue import Array
from cuefem.effects import Support
from cuefem.endmass.definitions import DEFINITIONS, Definition, small_offset_slope, stick
from cuefem.endmass.impulse_response import ImpulseResponse
from cuefem.endmass.sticking_contact import StickLimit, stick_reason
from cuefem.results.closed_forms import pivot_length
from cuefem.results.quantities import RESULTS, Result
from cuefem.scene import Outcome, Resolution, Scene
from cuefem.scene.default_scene import GAMES
from cuefem.tip_modes import Solved

TONES = 5  # bending modes that are told of one scene
USUAL_OFFSET = GAMES["pool"].offset  # b/R
OFFSETS = (0.1, 0.2, 0.3, 0.4, 0.5)  # b/R of the table of squirt


def at_offset(scene: Scene, offset: Any) -> Scene:
    """The same stroke at another offset, or at an array of them."""
    return replace(scene, stroke=replace(scene.stroke, offset=offset))


def off_centre(scene: Scene) -> Scene:
    """The scene itself; one that is struck head on, which has no squirt, with the usual offset instead."""
    return scene if scene.stroke.offset else at_offset(scene, USUAL_OFFSET)


def strikes_at(scene: Scene, offsets: Iterable[float], tip: TipModes) -> Iterator[Outcome]:
    """The coupled strike at one offset after the other, each computed when it is asked for; tip: the cue's modes.

    This is the one place where squirt against the offset comes from.
    """
    return (strike_modes(at_offset(scene, offset), tip) for offset in offsets)


def coupled_curve(scene: Scene, offsets: Sequence[float], tip: TipModes) -> dict[str, Any]:
    """Squirt, natural pivot length, regime and grip of the coupled strike against the offset: every curve of a page."""
    struck = list(strikes_at(scene, offsets, tip))
    squirt = np.array([outcome.squirt for outcome in struck])
    return {
        "squirt": squirt,
        "pivot_length": pivot_length(at_offset(scene, np.array(offsets)), squirt),
        "regime": [outcome.regime for outcome in struck],
        "grip": [grip_of(outcome) for outcome in struck],
    }


def course(outcome: Outcome, name: str, times: Array) -> dict[str, Array]:
    """The "force" or the "velocity" between tip and ball at times of a strike, s, by its direction."""
    assert outcome.history is not None
    history = outcome.history(times)
    return {"along the normal": history[f"{name}_n"], "along the tangent": history[f"{name}_t"]}


class Stick(NamedTuple):
    """Stick end masses, kg, and small-offset squirts over phi, of cues: two arrays (cues,), and `reasons`.

    A cue whose squirt no end mass has (a light shaft alone, at a long contact time, runs ahead of the ball and has a
    negative one) has an end mass of nan and a reason. Its squirt is a number.
    """

    end_mass: Array
    squirt: Array

    @property
    def reasons(self) -> tuple[str | None, ...]:
        """Why a cue has no end mass; None if it has one."""
        return tuple(
            stick_reason(slope) if np.isnan(mass) else None
            for mass, slope in zip(self.end_mass.tolist(), self.squirt.tolist(), strict=True)
        )


class Designs:
    """Scenes that are solved: arrays (designs, ...) in SI, each computed when it is first asked for.

    Here every design is computed by itself, by its tip modes, which a kind of designs makes in its own way.
    """

    def __init__(self, scenes: Sequence[Scene]) -> None:
        self.scenes = scenes
        self._outcomes: dict[tuple[int, float | None], Outcome] = {}

    def tip(self, i: int) -> TipModes:
        """Tip modes of a design that a strike takes."""
        raise AssertionError(f"{type(self).__name__} has no tip modes of its own")

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
        """Static tip stiffness, N/m: see `static_tip_stiffness`."""
        raise AssertionError(f"{type(self).__name__} has no stiffness of its own")

    @property
    def frequencies(self) -> Array:
        """The lowest bending frequencies, Hz, (designs, n)."""
        raise AssertionError(f"{type(self).__name__} has no frequencies of its own")

    @cached_property
    def stick(self) -> Stick:
        """Stick end mass, kg, nan if a design has none, and small-offset squirt over phi."""
        both = np.array([self._stick(i) for i in range(len(self.scenes))])
        return Stick(both[:, 0], both[:, 1])

    def _stick(self, i: int) -> tuple[Any, float]:
        scene, tip = self.scenes[i], self.tip(i)
        limit = StickLimit.of(scene)
        if scene.lumped is not None:
            return scene.lumped.end_mass, small_offset_slope(tip, scene)
        if scene.effects:
            slope = small_offset_slope(tip, scene)
            none = np.isnan(limit.end_masses(limit.impulse(slope)))
            return np.nan if none else stick(tip, scene), slope
        J = limit.transverse_impulse(ImpulseResponse.of(tip).held(limit.c, limit.T), limit.T)
        return limit.end_masses(J), float(limit.slope(J))

    def stick_at(self, offset: float) -> Array:
        """End mass of a tip that sticks at an offset b/R, kg, (designs,)."""
        return np.array([self.end_mass(i, DEFINITIONS["offset"], offset) for i in range(len(self.scenes))])

    def end_mass(self, i: int, definition: Definition, offset: float | None) -> float:
        """End mass of a design by a definition, kg, at an offset b/R or at its scene's own."""
        return float(definition.of(self.tip(i), self._scene(i, offset)))

    def _scene(self, i: int, offset: float | None) -> Scene:
        return self.scenes[i] if offset is None else at_offset(self.scenes[i], offset)

    def strike(self, i: int, offset: float | None) -> Outcome:
        """The coupled strike of a design at an offset b/R, or at its scene's own; each is made once."""
        if (i, offset) not in self._outcomes:
            self._outcomes[i, offset] = strike_modes(self._scene(i, offset), self.tip(i))
        return self._outcomes[i, offset]


class OneDesign(Designs):
    """One scene at the accuracy of single questions, from what is solved of it already.

    outcome: of its own strike, if it is known.
    """

    def __init__(self, solved: Solved, outcome: Outcome | None = None) -> None:
        super().__init__([solved.scene])
        self.solved = solved
        if outcome is not None:
            self._outcomes[0, None] = outcome

    def tip(self, i: int) -> TipModes:
        """Tip modes that a strike takes."""
        return self.solved.tip

    @property
    def tip_stiffness(self) -> Array:
        """Static tip stiffness, N/m, on the mesh of the lowest tones."""
        scene = self.scenes[0]
        return np.array([static_tip_stiffness(scene, TONES)])

    @cached_property
    def frequencies(self) -> Array:
        """The lowest bending frequencies, Hz, (1, TONES)."""
        scene = self.scenes[0]
        return modes(scene.shaft, TONES, effects=scene.cue_effects).frequencies[None]

    def end_mass(self, i: int, definition: Definition, offset: float | None) -> float:
        """End mass by a definition, kg, from the tip modes that the definition takes."""
        return float(definition.of(definition.tip_of(self.solved), self._scene(0, offset)))


def static_tip_stiffness(scene: Scene, at: Resolution | int) -> float:
    """Static tip stiffness, N/m, of a cue with its effects, its butt end clamped: one linear solve of the beam.

    at: a resolution, or how many modes the mesh must hold. Without effects `CueBatch.tip_stiffness` is exact.
    """
    system = assemble(scene.shaft, at, (*scene.cue_effects, Support(scene.shaft.length, np.inf, np.inf)))
    return system.static_stiffness(0.0)


def asked() -> dict[str, Result]:
    """All results that can be asked of a design, by name: also "end_mass_NAME" for every definition of the end mass."""
    own = {name: result for name, result in RESULTS.items() if result.of is not None}
    return own | {f"end_mass_{name}": _defined(definition) for name, definition in DEFINITIONS.items()}


def _defined(definition: Definition) -> Result:
    def values(designs: Designs, offset: float | None) -> Array:
        return np.array([designs.end_mass(i, definition, offset) for i in range(len(designs.scenes))])

    return Result(
        f"end mass, {definition.label}",
        "kg",
        about=definition.meaning,
        of=values,
        argument="offset" if definition.at_offset else "",
        strikes=True,
        better="lower",
        listed=False,
    )


def listed(designs: Designs) -> dict[str, float | None]:
    """Every listed result of one design, None where it has none: what a report and the designer show by its name."""
    cue = designs.scenes[0].cue
    return {
        name: _value(result, designs)
        for name, result in RESULTS.items()
        if result.of is not None and result.listed and (cue.segments or not result.segments)
    }


def _value(result: Result, designs: Designs) -> float | None:
    assert result.of is not None
    try:
        value = float(result.of(designs, None)[0])
    except (ValueError, RuntimeError):  # such as the stiffness of a cue whose effects hold its tip
        return None
    return value if math.isfinite(value) else None
