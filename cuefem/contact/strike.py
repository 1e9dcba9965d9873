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
from cuefem.quantity import check_kind, scalar
from cuefem.scene import Outcome, Resolution, Scene
from cuefem.tip_modes import tip_modes_of


def strike(scene: Scene, at: Resolution | None = None) -> Outcome:
    """Outcome of the coupled strike of any cue: its modes, the tip and the ball, in time.

    at: a Resolution gives the plain sum over the modes asked for; left out, modes are kept by frequency so that squirt
    is within 0.5 % (what was measured: studies/default_accuracy.md). A lumped cue needs none. Phases (slip or stick,
    loaded, unloaded or reloaded) are propagated exactly and their ends found as roots, so the modes kept are the only
    approximation. Fields of the scene are single numbers. Outcome.phases are `cuefem.contact.state.Phase`;
    Outcome.history gives forces and velocities at any time. energy: "ball translation", "ball rotation", "cue" (rigid
    motion), "cue vibration", "tip loss", "friction loss". RuntimeError where the ball never leaves. Cost: cubic in the
    modes, a few milliseconds for 24.
    """
    check_kind("strike scene", scene, Scene)
    return strike_modes(scene, tip_modes_of(scene, at))


def strike_modes(scene: Scene, tip: TipModes) -> Outcome:
    """The coupled strike of a cue that is given by its tip modes."""
    return outcome_of(struck(scene, tip), scene, math.copysign(1.0, scalar("Stroke.offset", scene.stroke.offset)))


def struck(scene: Scene, tip: TipModes) -> Kind:
    """The contact of a strike when it is over, solved for the side b >= 0: its phases, courses and last state."""
    offset = scalar("Stroke.offset", scene.stroke.offset)
    laws = Laws(
        phi=math.asin(abs(offset)),
        ball_mass=scalar("Ball.mass", scene.ball.mass),
        inertia=scalar("Ball.inertia", scene.ball.inertia),
        stiffness=scene.stiffness,
        restitution=scalar("Tip.restitution", scene.tip.restitution),
        friction=scalar("Tip.friction", scene.tip.friction),
        time=scene.contact_time,
        speed=scalar("Stroke.speed", scene.stroke.speed),
    )
    tip = tip if offset else tip.uncoupled
    terms = scene.contact_terms
    lever = terms.lever(laws.phi)
    if any(lever):
        tip = replace(tip, amplitude=tip.amplitude + np.outer(tip.rotation, lever))
    kind = contact_of(scene, tip, laws)
    run(kind)
    if terms.window is not None:
        from cuefem.contact.second_hit import follow

        follow(kind, terms.window)
    return kind
