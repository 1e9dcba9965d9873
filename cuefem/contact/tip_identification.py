"""Identification of a tip: the leather's E and the tip's restitution from a measured contact time and rebound."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np

from cuefem.beam.tip_modes import TipModes
from cuefem.contact.strike import strike, strike_modes
from cuefem.contact.tips import MIN_LEATHER_RESTITUTION
from cuefem.effects.force_law import IndentationOutOfRange
from cuefem.quantity.fields import CONTACT_TIME, Quantity
from cuefem.scene import Outcome, Scene, check_scene
from cuefem.scene.solved_scene import tip_modes_of

TOLERANCE = 1e-8  # of ln E and of the restitution
MIN_E, MAX_E = 1e6, 2e10  # Pa, range of the search: softer and stiffer than any tip
NO_SEPARATION = 10.0  # s, contact time where the indentation is out of range
REBOUND = Quantity("", f"[{MIN_LEATHER_RESTITUTION}, 1]")


class IdentifiedTip(NamedTuple):
    """Leather that explains a measured contact time and rebound.

    Attributes
    ----------
    E : float
        Young's modulus, Pa.
    restitution : float
        Coefficient of restitution of the tip.
    """

    E: float
    restitution: float


GUESS, GUESS_TIME = IdentifiedTip(230e6, 0.6), 1.135e-3  # s: medium leather, the start of the search
MANY_MODES = IdentifiedTip(1e9, 0.5)  # whose contact is shorter than any leather's


def identify_tip(scene: Scene, contact_time: float, rebound: float) -> IdentifiedTip:
    """The leather whose central impact has a given contact time and a given restitution of the whole cue.

    Parameters
    ----------
    scene
        A scene with a `LeatherTip`. Its E, the tip's restitution and the offset have no influence. With `AxialWaves`
        the impact lasts longer and rebounds faster.
    contact_time
        Measured contact time, s.
    rebound
        Restitution of the whole cue, (v_ball/v_cue)(1 + m/M) - 1, in [0.1, 1].

    Returns
    -------
    IdentifiedTip
        E, Pa, and the restitution of the tip alone, in [0.1, 1].

    Raises
    ------
    ValueError
        If the scene has no `LeatherTip`, or no leather has such a contact time and rebound on this cue.

    Notes
    -----
    Stiffer leather shortens the contact; a smaller restitution shortens it and lowers the rebound. Axial waves limit
    both: with leather of any stiffness the contact lasts at least as long as with the wood.

    Examples
    --------
    >>> import cuefem as cf
    >>> wood = cf.Material(E=12.6e9, G=0.84e9, rho=700.0)
    >>> cue = cf.Cue((cf.Segment(0.7, 0.01275, 0.021, wood),), body_mass=0.43)
    >>> E, restitution = cf.identify_tip(cf.usual_scene(cue), contact_time=1.2e-3, rebound=0.73)
    >>> round(E / 1e6), round(restitution, 2)  # MPa
    (174, 0.64)
    """
    from scipy.optimize import root

    check_scene("identify_tip scene", scene)
    contact_time = CONTACT_TIME.check("identify_tip contact_time", contact_time)
    rebound = REBOUND.check("identify_tip rebound", rebound)
    bounds = np.array([[math.log(MIN_E), MIN_LEATHER_RESTITUTION], [math.log(MAX_E), 1.0]])

    def central_impact(tip: TipModes, log_E: float, e: float) -> tuple[float, float]:
        """Contact time, s, and rebound; `NO_SEPARATION` and 0 if the indentation leaves the range of the law."""
        try:
            trial = with_tip(scene, IdentifiedTip(math.exp(log_E), e))
            outcome = strike_modes(_centre_ball(trial), tip)
        except IndentationOutOfRange:
            return NO_SEPARATION, 0.0
        return float(outcome.duration), rebound_of_outcome(outcome, trial)

    def residuals(guess: Any, tip: TipModes) -> Any:
        clipped = np.clip(guess, *bounds)  # the residuals grow beyond the bounds
        time, computed = central_impact(tip, *clipped)
        return [math.log(time / contact_time), computed - rebound] + np.array([-1.0, 1.0]) * (guess - clipped)

    # the number of modes depends on the leather: a second search has those of the first one's solution
    found = MANY_MODES
    start = [math.log(GUESS.E) - 3 * math.log(contact_time / GUESS_TIME), GUESS.restitution]
    for _ in range(2):
        tip = tip_modes_of(with_tip(scene, found))
        solution = root(residuals, np.clip(start, *bounds), args=(tip,), tol=TOLERANCE)
        is_within = MIN_E < math.exp(solution.x[0]) < MAX_E and MIN_LEATHER_RESTITUTION <= solution.x[1] <= 1
        if not (solution.success and is_within):
            break
        found, start = IdentifiedTip(math.exp(solution.x[0]), float(solution.x[1])), solution.x
    else:
        return found

    E, e = np.clip(solution.x, *bounds)
    time, computed = central_impact(tip, E, e)
    raise ValueError(
        f"identify_tip: no leather has a contact time of {contact_time:g} s and a rebound of {rebound:g} on this cue; "
        f"the nearest tried, E {math.exp(E) / 1e6:.4g} MPa and e {e:.3g}, has {time:.3g} s and {computed:.3g}"
    )


def with_tip(scene: Scene, tip: IdentifiedTip) -> Scene:
    """The scene with the identified E of its leather and restitution of its tip."""
    leather = scene.leather_tip
    effects = tuple(replace(leather, E=tip.E) if effect is leather else effect for effect in scene.effects)
    return replace(scene, tip=replace(scene.tip, restitution=tip.restitution), effects=effects)


def rebound(scene: Scene) -> float:
    """Restitution of the whole cue: separation speed of ball and cue after a central impact, over the stroke's speed.

    Parameters
    ----------
    scene
        The offset has no influence. With `AxialWaves` a part of the waves' energy returns to the ball, so that the
        rebound is larger than the tip's restitution.

    Returns
    -------
    float
        (ball's speed - cue's speed)/stroke's speed.

    Examples
    --------
    >>> import cuefem as cf
    >>> wood = cf.Material(E=12.6e9, G=0.84e9, rho=700.0)
    >>> cue = cf.Cue((cf.Segment(0.7, 0.01275, 0.021, wood),), body_mass=0.43)
    >>> waves = cf.AxialWaves(cue_length=1.47, butt_diameter=0.03, wave_speed=4430.0)
    >>> cf.rebound(cf.Scene(cue, tip=cf.Tip(0.73, contact_time=1e-3), effects=(waves,))) > 0.73
    True
    """
    check_scene("rebound scene", scene)
    return rebound_of_outcome(strike(_centre_ball(scene)), scene)


def _centre_ball(scene: Scene) -> Scene:
    return replace(scene, stroke=replace(scene.stroke, offset=0.0))


def rebound_of_outcome(outcome: Outcome, scene: Scene) -> float:
    """Separation speed of ball and cue after a central impact, over the stroke's speed."""
    return float((outcome.ball_speed - outcome.cue_speed) / scene.stroke.speed)
