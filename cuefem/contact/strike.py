"""The coupled strike: the vibrating shaft meets the ball in time (handbook: The strike)."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from cuefem.beam.tip import TipModes
from cuefem.contact.kinds import contact_of
from cuefem.contact.outcome import outcome_of
from cuefem.contact.phases import Kind, run
from cuefem.contact.state import Laws
from cuefem.contact.turns import Turns
from cuefem.quantity import check_kind, scalar
from cuefem.scene import Outcome, Resolution, Scene
from cuefem.tip_modes import tip_modes_of


def strike(scene: Scene, at: Resolution | None = None) -> Outcome:
    """Strike a ball with a vibrating cue, and follow the contact in time.

    Parameters
    ----------
    scene : Scene
        What is there and which physics acts; every field is a single number.
    at : Resolution, optional
        How finely the cue is computed: the plain sum over the modes asked for. By default modes are kept by frequency
        and completed, so that squirt is within 0.5 % (what was measured: studies/default_accuracy.md). A lumped cue
        needs none.

    Returns
    -------
    Outcome
        Its ``phases`` are `cuefem.contact.state.Phase`; its ``history`` gives forces and velocities at any time. Its
        ``energy`` names "ball translation", "ball rotation", "cue" (rigid motion), "cue vibration", "tip loss" and
        "friction loss", and what effects add.

    Raises
    ------
    ValueError
        For a scene of arrays, or effects that no contact honours together.
    RuntimeError
        If the ball does not leave the cue.

    Notes
    -----
    The cue's modes, the tip and the ball are one system. While the contact slips or sticks, and the tip is loaded or
    unloaded, its motion is linear: each such phase is followed exactly, and its end found as a root, so that the modes
    kept are the only approximation (handbook: The strike). A stiffening tip, a turning normal or a raised cue is
    stepped in time, to about 1e-10. In the compiled kernel the cost goes with the modes, about a millisecond for a
    contact of 24; in Python, which takes several, with their cube.

    Examples
    --------
    >>> import math
    >>> import cuefem as cf
    >>> outcome = cf.strike(cf.Scene(cf.LumpedCue(0.54, 0.01), stroke=cf.Stroke(speed=2.0, offset=0.3)))
    >>> outcome.regime
    'stick'
    >>> round(math.degrees(outcome.squirt), 3)
    2.187
    """
    check_kind("strike scene", scene, Scene)
    return strike_modes(scene, tip_modes_of(scene, at))


def strike_modes(scene: Scene, tip: TipModes, turns: Turns | None = None) -> Outcome:
    """The coupled strike of a cue that is given by its tip modes, as `strike`.

    turns: of the same modes, if other strikes share them; they change no number.
    """
    side = math.copysign(1.0, scalar("Stroke.offset", scene.stroke.offset))
    return outcome_of(struck(scene, tip, turns), scene, side)


def struck(scene: Scene, tip: TipModes, turns: Turns | None = None) -> Kind:
    """The contact of a strike when it is over, solved for an offset >= 0; a negative one is its mirror image."""
    offset = scalar("Stroke.offset", scene.stroke.offset)
    laws = Laws(
        phi=math.asin(abs(offset)),
        ball_mass=scalar("Ball.mass", scene.ball.mass),
        inertia=scalar("Ball.inertia", scene.ball.inertia),
        restitution=scalar("Tip.restitution", scene.tip.restitution),
        stiffness=scene.stiffness,
        friction=scalar("Tip.friction", scene.tip.friction),
        time=scene.contact_time,
        speed=scalar("Stroke.speed", scene.stroke.speed),
    )
    straight = tip if offset else tip.uncoupled
    if turns is None or straight is not tip:
        turns = Turns(straight)
    tip = straight
    terms = scene.contact_terms
    lever = terms.lever(laws.phi)
    if any(lever):
        tip = replace(tip, amplitude=tip.amplitude + np.outer(tip.rotation, lever))
    kind = contact_of(scene, tip, laws, terms, turns)
    run(kind)
    if terms.window is not None:
        from cuefem.contact.second_hit import follow

        follow(kind, terms.window)
    return kind
