"""The outcome of a contact that is over: energies, regime, jam."""

from __future__ import annotations

import math
from itertools import takewhile

import numpy as np

from cuefem.contact.phases import Kind
from cuefem.contact.state import APART, Contact, Phase
from cuefem.quantity import scalar
from cuefem.scene import Outcome, Scene

SLIDES, LETS_GO = 0.25, 0.5  # of the push, while the tip slides: from there on squirt grows fast; no valid shot
MISSED = ("miscue", "lets go")


def grip_of(outcome: Outcome) -> str:
    """How the tip gripped the ball: the regime of the strike, or "slides" or "lets go" if it held only at first.

    Soft leather takes up its load along the ball slowly, so that it grips at every offset and lets go only later.
    "slides": through more than a quarter of the push; "lets go": through more than half of it, which is a miscue.
    """
    if outcome.regime not in ("stick", "late stick") or outcome.history is None:  # of the impulse solver
        return str(outcome.regime)
    pushed = [(phase.grip, abs(phase.impulse[1])) for phase in outcome.phases]
    slid = sum(impulse for grip, impulse in pushed if grip in ("slip", "slip back"))
    share = slid / (sum(impulse for _, impulse in pushed) or 1.0)
    return "lets go" if share > LETS_GO else "slides" if share > SLIDES else str(outcome.regime)


def outcome_of(kind: Kind, scene: Scene, side: float) -> Outcome:
    """The outcome of a contact that is over; side: -1 for a stroke at a negative offset."""
    contact, laws, tip = kind.contact, kind.contact.laws, kind.contact.tip
    M, nu = laws.ball_mass, laws.inertia
    p_t, p_n, twist, along = contact.impulses
    s, c = math.sin(laws.phi), math.cos(laws.phi)
    impulse = np.array([side * p_t, p_n])
    inertia = float(tip.approach @ tip.approach)  # of a cue that moves as one along its axis
    return Outcome(
        squirt=side * math.atan2(s * p_n - c * p_t, s * p_t + c * p_n) + 0.0,
        ball_velocity=impulse / M,
        ball_speed=math.hypot(p_t, p_n) / M,
        spin=float(side * twist / (nu * M * scalar("Ball.radius", scene.ball.radius))),
        cue_speed=float(laws.speed - along / inertia),
        impulse=impulse,
        duration=float(contact.time),
        regime=regime(contact),
        jam=jams(contact),
        phases=tuple(contact.phases),
        energy=_energy(kind, inertia, p_t, p_n, twist),
        unknowns=len(contact.z),
        history=kind.history(side),
        kernel=kind.kernel,
    )


def _energy(kind: Kind, inertia: float, p_t: float, p_n: float, twist: float) -> dict[str, float]:
    """J by name; inertia, kg, of the cue along its axis; the ball's impulse, and the part that turned it, N s."""
    contact = kind.contact
    laws, z, slots = contact.laws, contact.z, contact.slots
    rigid, swings, speeds = z[slots.rigid], z[slots.vibration], z[slots.swinging]
    account = {
        "initial": inertia * laws.speed**2 / 2,
        "ball translation": (p_t**2 + p_n**2) / (2 * laws.ball_mass),
        "ball rotation": twist**2 / (2 * laws.inertia * laws.ball_mass),
        "cue": float(rigid @ rigid) / 2,
        "cue vibration": float(swings @ swings + speeds @ speeds) / 2 + contact.radiated,
        "tip loss": kind.tip_loss(),
        "friction loss": contact.friction_loss,
        **kind.other_losses(),
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
