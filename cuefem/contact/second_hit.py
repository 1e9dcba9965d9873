"""What comes after the first contact: cue and ball fly apart, and may touch again (the effect SecondHit)."""

from __future__ import annotations

from functools import partial
from typing import NamedTuple

import numpy as np

from cuefem.contact.flow import Flow, Guards, integral_of_product, march
from cuefem.contact.linear import APART, Contact, Course, Phase, run
from cuefem.contact.linear_shear import ShearContact
from cuefem.contact.ringing_tip import RINGING
from cuefem.contact.stepped import SteppedContact
from cuefem.scene import Outcome

# Tip and ball touch where they would overlap by this part of a stroke's length, speed times contact time: a dead tip
# leaves the ball with no velocity but its rounding.
OVERLAP = 1e-10


class Hit(NamedTuple):
    """One contact of tip and ball: its start and end, s, and the impulse (t, n) on the ball in it, N s."""

    start: float
    end: float
    impulse: tuple[float, float]


def hits(outcome: Outcome) -> tuple[Hit, ...]:
    """The contacts of a strike, the first one first; more than one only where the scene lists SecondHit."""
    parts: list[list[Phase]] = [[]]
    for phase in outcome.phases:
        if phase[:2] == APART:
            parts.append([])
        else:
            parts[-1].append(phase)
    found = []
    for part in parts:
        p_t, p_n = np.sum([phase.impulse for phase in part], axis=0)
        found.append(Hit(part[0].start, part[-1].end, (float(p_t), float(p_n))))
    return tuple(found)


def follow(contact: Contact, window: float) -> None:
    """Follow cue and ball for ``window``, s, after their separation, and through every contact that begins in it.

    ValueError for a dead tip, or one that is nearly so: it would come back with the whole force of its peak at once,
    and chatter without end.
    """
    if contact.laws.restitution <= RINGING:
        raise ValueError(f"SecondHit takes a Tip.restitution in ({RINGING:g}, 1]; got {contact.laws.restitution}")
    until, near = contact.time + window, OVERLAP * contact.laws.speed * contact.laws.time
    while _fly(contact, until, near):
        run(contact, "unload")


def _fly(contact: Contact, until: float, near: float) -> bool:
    """Let ball and tip fly to their next touch, or not at all: whether they touch by ``until``, s."""
    start = contact.time
    fly = contact.fly if isinstance(contact, SteppedContact) else partial(_fly_exactly, contact)
    found = fly(until, near)
    contact.longest += contact.time - start
    return found


def _fly_exactly(contact: Contact, until: float, near: float) -> bool:
    if isinstance(contact, ShearContact):
        contact.let_go()
    flow = _free_flow(contact)
    gap = flow.rows.shape[0] - 1
    weights = np.zeros((1, gap + 1))
    weights[0, gap] = 1.0
    start = contact.time
    arrival = march(flow, np.append(contact.z, 0.0), Guards(weights, np.array([near])), start=start, limit=until)
    if arrival is None or arrival.time > until:
        return False
    rows = range(contact.outputs, contact.outputs + len(contact.dampers))
    losses = [sum(integral_of_product(piece, row, row) for piece in arrival.pieces) for row in rows]
    contact.damping_loss += sum(losses[: contact.lossy])
    contact.radiated += sum(losses[contact.lossy :])
    contact.courses.append(Course(start, contact.free, flow.rate, contact.z))
    contact.time, contact.z = arrival.time, arrival.state[:-1]
    contact.z[contact.spring] = 0.0
    contact.pieces += arrival.pieces
    contact.phases.append(Phase(*APART, start, contact.time, (0.0, 0.0)))
    return True


def _free_flow(contact: Contact) -> Flow:
    """The motion without a contact; beside the state the gap between ball and tip, its last output, m."""
    c_n, size = contact.c_n, len(contact.z)
    rate = 2 * max(contact.fastest, 1 / contact.laws.time)
    scale = rate / float(np.linalg.norm(c_n))  # of the gap in the state, so that it changes as fast as the rest
    A = np.zeros((size + 1, size + 1))
    A[:size, :size], A[size, :size] = contact.free, scale * c_n
    rows = np.zeros((contact.outputs + len(contact.dampers) + 1, size + 1))
    rows[0, :size], rows[1, :size], rows[-1, size] = contact.c_t, c_n, 1 / scale
    rows[contact.outputs : -1, :size] = contact.dampers
    return Flow(A, rows, rate)
