"""Which phase of a contact follows which: the one state machine of grips and presses, for every kind of contact.

Tangentially the contact slips (F_t = side mu F_n) or sticks (F_t keeps v_t at zero, or a spring gives it); normally the
tip is loaded, or unloaded and reloaded below its peak, or, for e = 0, held rigidly (F_n keeps v_n at zero). How the
state moves within such a phase is the business of a `Kind`.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple, Protocol

import numpy as np

from cuefem.contact.history import AnyHistory
from cuefem.contact.state import SIDE, Contact, Grip, Press
from cuefem.cue import Array

# A contact that changes phase this often does not end.
MOST_PHASES = 5_000
# |F_t| may pass mu F_n by this part of the force scale: at mu = mu_c, and where F_n vanishes at separation, the two are
# equal but for rounding.
ROUNDING = 1e-12


class Step(NamedTuple):
    """What ended a phase, and the grip and press of the next."""

    event: str
    grip: Grip
    press: Press


class Stretch(Protocol):
    """A stretch of time whose motion is known: a phase, or the flight after it."""

    @property
    def start(self) -> float:
        """Where it starts, s."""

    def states(self, rows: Array, spans: Array) -> Iterator[Array]:
        """States ``spans`` s after its start, ascending, and below them the integrals, from zero on, of ``rows``."""


class Kind(Protocol):
    """A kind of contact: how the state moves within a phase, and apart."""

    contact: Contact
    longest: float  # when the contact is given up, s
    kernel: str  # what runs it: "c", or "python"
    haste: float  # the part of what it may take in phases before it is given up

    def first_grip(self, press: Press) -> Grip:
        """How a touch grips."""

    def grip_at_rest(self, press: Press) -> Grip:
        """How a contact goes on that has stopped sliding."""

    def at_once(self, grip: Grip, press: Press, most: float) -> bool:
        """Go through all phases from this one on, at most so many, if the kind can do that in one: whether it did."""

    def follow(self, grip: Grip, press: Press) -> str:
        """Move through one phase to its end; the name of what ended it. RuntimeError if nothing does."""

    def next(self, event: str, grip: Grip, press: Press) -> Step | None:
        """What follows that end: `next_phase`, but for events of the kind's own; None: the ball has left."""

    def force(self, grip: Grip, press: Press) -> Array:
        """(F_t, F_n) now, N, if the contact gripped and pressed in this way."""

    def facing(self) -> tuple[Array, Array]:
        """(c_t, c_n) now."""

    def compressed(self, grip: Grip) -> None:
        """Note what the tip is at its greatest compression."""

    def press_anew(self, old: Press, new: Press) -> None:
        """Keep the tip's force while its stiffness changes."""

    def fly(self, until: float, near: float) -> bool:
        """Let ball and tip fly to their next touch, or not at all: whether they touch by ``until``, s.

        They touch where they would overlap by ``near``, m.
        """

    def stretches(self) -> list[Stretch]:
        """The motion so far, and from now on without a contact."""

    def history(self, mirror: float) -> AnyHistory:
        """Forces and velocities so far; mirror: -1 for a stroke on the other side."""

    def tip_loss(self) -> float:
        """Energy that the tip did not give back, J."""

    def other_losses(self) -> dict[str, float]:
        """Energy that went into what effects added, J by name."""


def run(kind: Kind, press: Press = "load") -> None:
    """The whole contact, from touch to separation."""
    contact = kind.contact
    contact.parted = False  # of this touch: a second hit is another
    grip = kind.first_grip(press)
    left = MOST_PHASES * kind.haste - len(contact.phases)
    step = None if contact.parted or kind.at_once(grip, press, left) else Step("touch", grip, press)
    while step is not None:
        if len(contact.phases) > MOST_PHASES * kind.haste:
            raise endless(kind, step.grip, step.press)
        _, grip, press = step
        step = kind.next(kind.follow(grip, press), grip, press)


def next_phase(kind: Kind, event: str, grip: Grip, press: Press) -> Step | None:
    """What follows the end of a phase by its name; None: the ball has left."""
    if event == "apart":
        return None
    if event == "compressed":
        return _unload(kind, grip)
    if event == "reloaded":
        kind.press_anew(press, "load")
        return Step(event, grip, "load")
    slips: Grip = "slip" if event == "slipped" else "slip back"
    grip = kind.grip_at_rest(press) if event == "gripped" else slips
    # Slip against a rigid tip in a jam has no stable force. As slip sets in, the tip's force is below what would
    # keep v_n at zero (in the limit e -> 0 it runs on as in stick, F, and what it would have to be runs ahead), so
    # it falls, ever faster, to nothing: the ball leaves.
    return Step(event, grip, press) if press != "rigid" or pressed_together(kind, grip) else None


def _unload(kind: Kind, grip: Grip) -> Step | None:
    kind.compressed(grip)
    contact = kind.contact
    contact.peak = float(kind.force(grip, "load")[1])
    if contact.laws.restitution > 0:
        kind.press_anew("load", "unload")
        return Step("compressed", grip, "unload")
    # past the peak a tip of e = 0 pushes on only as far as the cue presses against the ball
    if not pressed_together(kind, grip) or float(kind.force(grip, "rigid")[1]) <= 0:
        return None
    return Step("compressed", grip, "rigid")


def pressed_together(kind: Kind, grip: Grip) -> bool:
    """Whether a growing tip force drives ball and tip apart, which a rigid tip needs."""
    if grip == "stick":
        return True
    c_t, c_n = kind.facing()
    return float(c_n @ (c_n + SIDE[grip] * kind.contact.laws.friction * c_t)) > 0


def held_or_sliding(kind: Kind, press: Press) -> Grip:
    """Stick where friction can hold the contact, else the way it starts to slip."""
    contact = kind.contact
    tangent, normal = kind.force("stick", press)
    friction = contact.laws.friction
    if np.isinf(friction) or abs(tangent) <= friction * normal + ROUNDING * contact.scale:
        return "stick"
    return "slip" if tangent > 0 else "slip back"


def endless(kind: Kind, grip: Grip, press: Press) -> RuntimeError:
    """The error of a contact that does not end, with its state."""
    contact = kind.contact
    v_t, v_n = (row @ contact.z for row in kind.facing())
    F_t, F_n = kind.force(grip, press)
    return RuntimeError(
        f"the ball does not leave the cue: after {contact.time:.6g} s and {len(contact.phases)} phases "
        f"(head-on contact time {contact.laws.time:.6g} s) the contact is in "
        f"{grip}, {press}, with v_t = {v_t:.3g} m/s, v_n = {v_n:.3g} m/s, F_n = {F_n:.3g} N, F_t = {F_t:.3g} N; "
        "check restitution, contact time and the masses, or keep fewer modes"
    )
