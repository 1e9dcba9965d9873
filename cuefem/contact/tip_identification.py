"""From a measured head-on blow to the tip: the leather's E from the contact time, the restitution from the rebound."""

from __future__ import annotations

import math
from dataclasses import replace

from cuefem.contact.strike import strike
from cuefem.quantity.fields import CONTACT_TIME, Quantity, scalar
from cuefem.scene import Outcome, Scene

CLOSE = 1e-9  # of the contact time
# The search starts from an E above that of any leather, so that the ball is not pressed in too deep; its second guess
# follows from this slope of ln T over ln E, which is about right.
STIFF, FIRST_SLOPE = 1e9, -0.4
REBOUND_LEAST = 0.1  # a tip of leather takes no less
REBOUND = Quantity("", "[0.1, 1]")


def leather_modulus(scene: Scene, contact_time: float) -> float:
    """Young's modulus of the leather with which a head-on blow takes a given time.

    Parameters
    ----------
    scene
        A scene with a `LeatherTip`, of which E does not matter. The blow has the scene's cue, ball, speed,
        restitution and other effects (`AxialWaves` make it longer), but no offset.
    contact_time
        How long ball and tip touch, s, in [1e-5, 1] s.

    Returns
    -------
    float
        E, Pa.

    Raises
    ------
    ValueError
        If the scene has no `LeatherTip`, the contact time is out of bounds, or the leather would have to be so soft
        that the ball is pressed further into it than its law is known.

    Examples
    --------
    >>> import cuefem as cf
    >>> wood = cf.Material(E=12.6e9, G=0.84e9, rho=700.0)
    >>> cue = cf.Cue((cf.Segment(0.7, 0.01275, 0.021, wood),), body_mass=0.43)
    >>> tip = cf.LeatherTip(height=6e-3, dome_radius=9.5e-3, E=100e6)
    >>> scene = cf.Scene(cue, cf.Ball(0.17, 0.028575), cf.Tip(0.73), cf.Stroke(2.0), (tip,))
    >>> E = cf.leather_modulus(scene, 1.1e-3)
    >>> round(E / 1e6)  # MPa
    151
    """
    from scipy.optimize import root_scalar

    name = "leather_modulus contact_time"
    contact_time = scalar(name, CONTACT_TIME.check(name, contact_time))

    def too_long(logarithm: float) -> float:
        return math.log(head_on(with_modulus(scene, math.exp(logarithm))).duration / contact_time)

    first = math.log(STIFF)
    guess = first - too_long(first) / FIRST_SLOPE
    solution = root_scalar(too_long, x0=first, x1=guess, method="secant", xtol=CLOSE)
    if not solution.converged:
        raise RuntimeError(f"no E of the leather was found for a contact of {contact_time:g} s: {solution.flag}")
    return math.exp(solution.root)


def with_modulus(scene: Scene, E: float) -> Scene:
    """The scene with another E of its leather, Pa."""
    leather = scene.leather
    return replace(scene, effects=tuple(replace(leather, E=E) if each is leather else each for each in scene.effects))


def rebound(scene: Scene) -> float:
    """How fast ball and cue part after a head-on blow, over the stroke's speed: the restitution of the whole cue.

    Parameters
    ----------
    scene
        Of which the offset does not matter. With `AxialWaves` the cue gives back a part of what it takes as waves, so
        that it parts from the ball faster than its tip alone would.

    Returns
    -------
    float
        (ball's speed - cue's speed)/stroke's speed.

    Examples
    --------
    >>> import cuefem as cf
    >>> wood = cf.Material(E=12.6e9, G=0.84e9, rho=700.0)
    >>> cue = cf.Cue((cf.Segment(0.7, 0.01275, 0.021, wood),), body_mass=0.43)
    >>> scene = cf.Scene(cue, tip=cf.Tip(0.73, contact_time=1e-3), effects=(cf.AxialWaves(),))
    >>> cf.rebound(scene) > 0.73
    True
    """
    return rebound_of(head_on(scene), scene)


def head_on(scene: Scene) -> Outcome:
    """The scene's blow without offset."""
    return strike(replace(scene, stroke=replace(scene.stroke, offset=0.0)))


def rebound_of(outcome: Outcome, scene: Scene) -> float:
    """How fast ball and cue part after a head-on blow, over the stroke's speed."""
    return float((outcome.ball_speed - outcome.cue_speed) / scene.stroke.speed)


def tip_restitution(scene: Scene, measured: float) -> float:
    """The tip's own restitution with which the whole cue has a measured one head on.

    Parameters
    ----------
    scene
        Of which the tip's restitution and the offset do not matter.
    measured
        Of the whole cue, in [0.1, 1]: what `rebound` of the scene with the answer is.

    Returns
    -------
    float
        For `Tip.restitution`.

    Raises
    ------
    ValueError
        If no tip of a restitution in [0.1, 1] makes this cue rebound so.

    Examples
    --------
    >>> import cuefem as cf
    >>> wood = cf.Material(E=12.6e9, G=0.84e9, rho=700.0)
    >>> cue = cf.Cue((cf.Segment(0.7, 0.01275, 0.021, wood),), body_mass=0.43)
    >>> round(cf.tip_restitution(cf.usual_scene(cue), 0.73), 2)
    0.66
    """
    from scipy.optimize import brentq

    measured = scalar("tip_restitution measured", REBOUND.check("tip_restitution measured", measured))

    def too_fast(e: float) -> float:
        return rebound(replace(scene, tip=replace(scene.tip, restitution=e))) - measured

    least, most = too_fast(REBOUND_LEAST), too_fast(1.0)
    if least > 0 or most < 0:
        raise ValueError(
            f"tip_restitution measured must be in [{least + measured:.3g}, {most + measured:.3g}], what this cue's "
            f"head-on blow can have with a tip of {REBOUND_LEAST:g} to 1; got {measured:g}"
        )
    return float(brentq(too_fast, REBOUND_LEAST, 1.0, xtol=CLOSE))
