"""The coupled strike: the vibrating shaft meets the ball in time (physics.md section 5)."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from cuefem.beam.tip import TipModes
from cuefem.contact.linear import Contact, Laws, run
from cuefem.contact.linear_shear import ShearContact
from cuefem.contact.outcome import _outcome
from cuefem.contact.ringing_tip import RINGING, ringing_contact
from cuefem.effects import Elevation, PowerLawTip, RollingContact, SecondHit, TipEffect, TipShear
from cuefem.quantity import check_kind, scalar
from cuefem.scene import Outcome, Resolution, Scene
from cuefem.tip_modes import tip_modes_of


def strike(scene: Scene, at: Resolution | None = None) -> Outcome:
    """Outcome of the coupled strike of any cue: its modes, the tip and the ball, in time.

    at: a Resolution gives the plain sum over the modes asked for; left out, modes are kept by frequency so that squirt
    is within 0.5 % (what was measured: studies/default_accuracy.md). A lumped cue needs none. Phases (slip or stick,
    loaded, unloaded or reloaded) are propagated exactly and their ends found as roots, so the modes kept are the only
    approximation. Fields of the scene are single numbers. Outcome.phases are `cuefem.contact.linear.Phase`;
    Outcome.history gives forces and velocities at any time. energy: "ball translation", "ball rotation", "cue" (rigid
    motion), "cue vibration", "tip loss", "friction loss". RuntimeError where the ball never leaves. Cost: cubic in the
    modes, a few milliseconds for 24.
    """
    check_kind("strike scene", scene, Scene)
    return strike_modes(scene, tip_modes_of(scene, at))


def strike_modes(scene: Scene, tip: TipModes) -> Outcome:
    """The coupled strike of a cue that is given by its tip modes."""
    contact = struck(scene, tip)
    return _outcome(contact, scene, math.copysign(1.0, scalar("Stroke.offset", scene.stroke.offset)))


def struck(scene: Scene, tip: TipModes) -> Contact:
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
    levers = [effect.lever(laws.phi) for effect in scene.effects if isinstance(effect, TipEffect)]
    if levers:
        whole = [math.fsum(parts) for parts in zip(*levers, strict=True)]  # in any order the same to the last bit
        tip = replace(tip, amplitude=tip.amplitude + np.outer(tip.rotation, whole))
    contact = contact_of(scene, tip, laws)
    run(contact)
    for effect in scene.effects:
        if isinstance(effect, SecondHit):
            from cuefem.contact.second_hit import follow

            follow(contact, effect.window)
    return contact


def contact_of(scene: Scene, tip: TipModes, laws: Laws) -> Contact:
    """The kind of contact that the scene's effects ask for."""
    if any(isinstance(effect, Elevation) for effect in scene.effects):
        from cuefem.contact.elevation import raised_contact

        return raised_contact(scene, tip, laws)
    if any(isinstance(effect, PowerLawTip | RollingContact) for effect in scene.effects):
        from cuefem.contact.nonlinear import stepped_contact

        return stepped_contact(scene, tip, laws)
    shears = [effect.ratio for effect in scene.effects if isinstance(effect, TipShear)]
    if not shears:
        return ringing_contact(tip, laws) if 0 < laws.restitution <= RINGING else Contact(tip, laws)
    return ShearContact(tip, laws, compliance=math.fsum(1 / ratio for ratio in shears) / laws.stiffness)
