"""A solved design: modes and strikes of a scene, from which all its results are computed."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from functools import cached_property
from typing import Any

import numpy as np

from cuefem.beam.assembly import assemble
from cuefem.beam.modes import modes
from cuefem.beam.tip_modes import TipModes
from cuefem.contact.strike import steps_of, strike, strike_modes
from cuefem.cue import Array
from cuefem.effects.cue_effects import Support
from cuefem.endmass.definitions import DEFINITIONS, Drive, coupled_slope, small_offset_slope, squirt_equivalent
from cuefem.results.closed_forms import pivot_length
from cuefem.results.verdict import reject_miscue
from cuefem.scene import Outcome, Scene, check_scene
from cuefem.scene.default_scene import GAMES
from cuefem.scene.solved_scene import SolvedScene

MIN_SOLVED_MODES = 5  # bending modes that are solved for, at least
DEFAULT_OFFSET = GAMES["pool"].offset  # b/R
OFFSETS = (0.1, 0.2, 0.3, 0.4, 0.5)  # b/R of the table of squirt


def at_offset(scene: Scene, offset: Any) -> Scene:
    """The same stroke at another offset, or at an array of them."""
    return replace(scene, stroke=replace(scene.stroke, offset=offset))


def off_centre(scene: Scene) -> Scene:
    """The scene; a head-on stroke, which has no squirt, with the default offset instead."""
    return scene if scene.stroke.offset else at_offset(scene, DEFAULT_OFFSET)


def coupled_curve(
    scene: Scene, offsets: Sequence[float], tip_modes: TipModes, squirt_factor: float = 1.0
) -> dict[str, Any]:
    """Squirt, natural pivot length, and regime of the coupled strike against the offset: every curve of a page.

    tip_modes: those of the cue. squirt_factor: of a calibration.
    """
    struck = [strike_modes(at_offset(scene, offset), tip_modes) for offset in offsets]
    squirt = squirt_factor * np.array([outcome.squirt for outcome in struck])
    return {
        "squirt": squirt,
        "pivot_length": pivot_length(scene, squirt, np.array(offsets)),
        "regime": [outcome.regime for outcome in struck],
    }


def time_history(outcome: Outcome, name: str, times: Array) -> dict[str, Array]:
    """The "force" or the "velocity" between tip and ball at times of a strike, s, by its direction."""
    assert outcome.history is not None
    history = outcome.history(times)
    return {"along the normal": history[f"{name}_n"], "along the tangent": history[f"{name}_t"]}


class SolvedDesign:
    """A scene whose modes and strikes are computed once and shared by all that is asked of it: see `solve`.

    Every question about a scene takes it in place of the scene.

    Parameters
    ----------
    solved : SolvedScene
        The scene and its modes.
    outcome : Outcome, optional
        Of its own strike, if already computed.
    squirt_factor : float, default 1.0
        Of a calibration: calibrated over computed squirt. Squirt and all results that follow from it carry it, an
        `Outcome` does not.

    Attributes
    ----------
    scene : Scene
        The scene.
    tip_stiffness : float
        Static transverse stiffness at the tip, the joint end clamped, N/m.
    squirt_slope : float
        Squirt over phi in the limit of small offsets, sin(phi) the offset b/R.

    Examples
    --------
    See `solve`.
    """

    def __init__(self, solved: SolvedScene, outcome: Outcome | None = None, squirt_factor: float = 1.0) -> None:
        self.solved, self.scene, self.squirt_factor = solved, solved.scene, squirt_factor
        self._outcomes: dict[float | None, Outcome] = {} if outcome is None else {None: outcome}
        self._frequencies = np.array([])

    @classmethod
    def of(cls, scene: Scene | SolvedDesign, rtol: float | None = None) -> SolvedDesign:
        """A scene to solve; a solved one as it is, so that analyses share its modes and its strike.

        rtol: relative error target of the strike; by default that of a default strike.
        """
        if isinstance(scene, SolvedDesign):
            return scene
        check_scene("scene", scene)
        return cls(SolvedScene(scene), None if rtol is None else strike(scene, rtol=rtol))

    @property
    def tip_stiffness(self) -> float:
        """Static tip stiffness, N/m: transverse force at the tip over its deflection, the joint end clamped."""
        cue, effects = self.scene.shaft, self.scene.cue_effects
        clamped = (*effects, Support(cue.length, np.inf, np.inf))
        return assemble(cue, MIN_SOLVED_MODES, clamped).static_stiffness(0.0)

    def frequency(self, mode: int) -> float:
        """Natural frequency of a bending mode, Hz; 1 is the lowest."""
        if mode > len(self._frequencies):
            at, count = self.solved.at, max(mode, MIN_SOLVED_MODES)
            self._frequencies = modes(self.scene.shaft, count, effects=self.scene.cue_effects, at=at).frequencies
        return float(self._frequencies[mode - 1])

    def calibrated(self, squirt_factor: float) -> SolvedDesign:
        """The same solved scene with another squirt factor."""
        return SolvedDesign(self.solved, self._outcomes.get(None), squirt_factor)

    @cached_property
    def squirt_slope(self) -> float:
        """Squirt over phi of a sticking tip in the limit of small offsets, without geometric stiffness, as end mass."""
        return self.squirt_factor * small_offset_slope(self.solved.stick_tip, self.scene)

    @cached_property
    def coupled_slope(self) -> float:
        """Squirt over phi of the coupled strike in the limit of small offsets."""
        return self.squirt_factor * coupled_slope(self.solved.tip, self.scene)

    def end_mass(self, name: Drive, offset: float | None = None) -> float:
        """End mass by a definition, kg, at an offset b/R or at the scene's own."""
        if name == "squirt" and self.squirt_factor != 1.0:
            return squirt_equivalent(self.solved.tip, self._at(offset), self.squirt_factor)
        return float(DEFINITIONS[name].of_design(self.solved, self._at(offset)))

    def strike(self, offset: float | None = None) -> Outcome:
        """The coupled strike at an offset b/R, or at the scene's own."""
        if offset not in self._outcomes:
            scene, steps = self._at(offset), steps_of(self.solved.at)
            self._outcomes[offset] = strike_modes(scene, self.solved.tip, steps=steps)
        return self._outcomes[offset]

    def squirt(self, offset: float | None = None) -> float:
        """Squirt of the coupled strike at an offset b/R, or at the scene's own, rad; `NoVerdict` for a miscue."""
        outcome = self.strike(offset)
        reject_miscue(self._at(offset), outcome)
        return self.squirt_factor * float(outcome.squirt)

    def _at(self, offset: float | None) -> Scene:
        return self.scene if offset is None else at_offset(self.scene, offset)


Solvable = Scene | SolvedDesign  # what a question about a scene takes


def solve(scene: Scene, *, rtol: float | None = None) -> SolvedDesign:
    """Share the modes and the strike of a scene among the questions that are asked about it.

    Parameters
    ----------
    scene : Scene
        A stroke.
    rtol : float, optional
        The largest relative error of the scene's own strike, in (0, 1), as for `strike`; by default that of its default
        resolution.

    Returns
    -------
    SolvedDesign
        Every question takes it in place of the scene. Its methods ``strike(offset)``, ``squirt(offset)``,
        ``end_mass(drive)`` and ``frequency(mode)`` give single numbers.

    Examples
    --------
    >>> import cuefem as cf
    >>> solved = cf.solve(cf.load_scene("plain maple"))
    >>> cf.verdict(solved).squirt == solved.squirt() == cf.strike(solved.scene).squirt
    True
    >>> round(1e3 * solved.end_mass("stick"), 1), round(solved.frequency(1))  # g, Hz
    (7.3, 92)
    """
    check_scene("scene", scene)
    return SolvedDesign.of(scene, rtol)
