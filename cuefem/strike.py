"""The coupled strike: the vibrating shaft meets the ball in time (physics.md section 5)."""

from __future__ import annotations

import math
from dataclasses import replace
from itertools import takewhile

import numpy as np

from cuefem.contact import APART, Contact, Laws, Phase, run
from cuefem.cue import LumpedCue
from cuefem.effects import Elevation, PowerLawTip, RollingContact, SecondHit, TipEffect, TipShear
from cuefem.modes import TipModes, lumped_tip_modes
from cuefem.quantity import check_kind, scalar
from cuefem.resolution import tip_modes_of
from cuefem.ringing_tip import RINGING, ringing_contact
from cuefem.scene import Outcome, Resolution, Scene
from cuefem.shear import ShearContact


def strike(scene: Scene, at: Resolution | None = None) -> Outcome:
    """Outcome of the coupled strike of any cue: its modes, the tip and the ball, in time.

    at: a Resolution gives the plain sum over the modes asked for; left out, modes are kept by frequency so that squirt
    is within 0.5 % (what was measured: studies/default_accuracy.md). A lumped cue needs none. Phases (slip or stick,
    loaded, unloaded or reloaded) are propagated exactly and their ends found as roots, so the modes kept are the only
    approximation. Fields of the scene are single numbers. Outcome.phases are `cuefem.contact.Phase`; Outcome.history
    gives forces and velocities at any time. energy: "ball translation", "ball rotation", "cue" (rigid motion), "cue
    vibration", "tip loss", "friction loss". RuntimeError where the ball never leaves. Cost: cubic in the modes, a few
    milliseconds for 24.
    """
    check_kind("strike scene", scene, Scene)
    if isinstance(scene.cue, LumpedCue):
        for name in ("mass", "end_mass", "coupling"):
            scalar(f"LumpedCue.{name}", getattr(scene.cue, name))
        cue = scene.cue if scalar("Stroke.offset", scene.stroke.offset) else replace(scene.cue, coupling=0.0)
        return strike_modes(scene, lumped_tip_modes(cue))
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
    levers = [effect.lever(laws.phi) for effect in scene.effects if isinstance(effect, TipEffect)]
    if levers:
        whole = [math.fsum(parts) for parts in zip(*levers, strict=True)]  # in any order the same to the last bit
        tip = replace(tip, amplitude=tip.amplitude + np.outer(tip.rotation, whole))
    contact = contact_of(scene, tip, laws)
    run(contact)
    for effect in scene.effects:
        if isinstance(effect, SecondHit):
            from cuefem.second_hit import follow

            follow(contact, effect.window)
    return contact


def contact_of(scene: Scene, tip: TipModes, laws: Laws) -> Contact:
    """The kind of contact that the scene's effects ask for."""
    if any(isinstance(effect, Elevation) for effect in scene.effects):
        from cuefem.elevation import raised_contact

        return raised_contact(scene, tip, laws)
    if any(isinstance(effect, PowerLawTip | RollingContact) for effect in scene.effects):
        from cuefem.nonlinear import stepped_contact  # the ODE solver is loaded where it is asked for

        return stepped_contact(scene, tip, laws)
    shears = [effect.ratio for effect in scene.effects if isinstance(effect, TipShear)]
    if not shears:
        return ringing_contact(tip, laws) if 0 < laws.restitution <= RINGING else Contact(tip, laws)
    return ShearContact(tip, laws, compliance=math.fsum(1 / ratio for ratio in shears) / laws.stiffness)


def _outcome(contact: Contact, scene: Scene, side: float) -> Outcome:
    laws, tip = contact.laws, contact.tip
    M, nu = laws.ball_mass, laws.inertia
    p_t, p_n = contact.impulse
    s, c = math.sin(laws.phi), math.cos(laws.phi)
    impulse = np.array([side * p_t, p_n])
    inertia = float(tip.approach @ tip.approach)  # of a cue that moves as one along its axis
    return Outcome(
        squirt=side * math.atan2(s * p_n - c * p_t, s * p_t + c * p_n) + 0.0,
        ball_velocity=impulse / M,
        ball_speed=math.hypot(p_t, p_n) / M,
        spin=float(side * contact.twist / (nu * M * scalar("Ball.radius", scene.ball.radius))),
        cue_speed=float(laws.speed - contact.along / inertia),
        impulse=impulse,
        duration=float(contact.time),
        regime=regime(contact),
        jam=jams(contact),
        phases=tuple(phase._replace(start=float(phase.start), end=float(phase.end)) for phase in contact.phases),
        energy=_energy(contact, inertia),
        unknowns=len(contact.z),
        history=contact.history(side),
    )


def _energy(contact: Contact, inertia: float) -> dict[str, float]:
    laws, z = contact.laws, contact.z
    p_t, p_n = contact.impulse
    rigid = z[contact.velocities][: contact.quiet]
    vibrating = np.concatenate([z[: contact.velocities.start], z[contact.velocities][contact.quiet :]])
    account = {
        "initial": inertia * laws.speed**2 / 2,
        "ball translation": (p_t**2 + p_n**2) / (2 * laws.ball_mass),
        "ball rotation": contact.twist**2 / (2 * laws.inertia * laws.ball_mass),
        "cue": float(rigid @ rigid) / 2,
        "cue vibration": float(vibrating @ vibrating) / 2 + contact.radiated,
        "tip loss": contact.tip_loss,
        "friction loss": contact.friction_loss,
        **contact.other_losses(),
    }
    return {name: float(joules) for name, joules in account.items()}


def first_contact(contact: Contact) -> list[Phase]:
    """The phases up to the first separation."""
    return list(takewhile(lambda phase: phase[:2] != APART, contact.phases))


def regime(contact: Contact) -> str:
    """How the first slip ended, in the words of the impulse solver (see Outcome)."""
    if contact.parted:  # thrown apart by the first blow, which stopped the slip at last or did not
        return "late stick" if abs(contact.c_t @ contact.z) <= 1e-12 * contact.laws.speed else "miscue"
    phases = first_contact(contact)
    grips = [phase.grip for phase in phases]
    first = next((i for i, grip in enumerate(grips) if grip != "slip"), None)
    if first is None:
        return "miscue"
    if grips[first] == "slip back":
        return "slip reversal"
    return "stick" if all(phase.press == "load" for phase in phases[: first + 1]) else "late stick"


def jams(contact: Contact) -> bool:
    """Whether the first slip drove the contact's normal velocity further in."""
    if contact.phases[0].grip != "slip":
        return False
    return float(contact.c_n @ (contact.c_n + contact.laws.friction * contact.c_t)) < 0
