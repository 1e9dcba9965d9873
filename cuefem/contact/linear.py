"""The contact with linear laws: every phase is one linear motion, followed exactly (`cuefem.contact.flow`).

The tip's force stands in the slot "spring", over the square root of its stiffness k (F_n' = -k v_n), so that half its
square is energy. Past the peak k/e^2 stands for k; for e = 0 the tip is rigid, and F_n keeps v_n at zero.
"""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Self, cast

import numpy as np

from cuefem.beam.tip import TipModes
from cuefem.contact import kernel
from cuefem.contact.flow import (
    ORDERS,
    REACH,
    Drive,
    Flow,
    Guard,
    Guards,
    Piece,
    Pushes,
    guards_of,
    integral_of_product,
    march,
    pushed,
)
from cuefem.contact.history import F_N, F_T, V_N, History
from cuefem.contact.kernel import contact as compiled
from cuefem.contact.patch import Patch, RigidPatch, SpringPatch, losses_of
from cuefem.contact.phases import ROUNDING, Step, Stretch, endless, next_phase
from cuefem.contact.ringing_tip import AVERAGED, LEAST, RINGING, Ringing
from cuefem.contact.state import APART, SIDE, Contact, Grip, Laws, Phase, Press
from cuefem.contact.stretches import Course, free_course
from cuefem.cue import Array

# A contact of more cells than this is given up: it would take seconds, and 300 MB of history. Only a tip that rings,
# 1/e times faster than the contact, needs so many, if a cue presses it on and its ringing cannot be averaged
# (`cuefem.contact.ringing_tip`).
MOST_CELLS = 500_000


class Exact:
    """A kind of contact: linear phases without stepping error, their ends found as roots.

    patch: how the tip gives way sideways. ringing: what a nearly dead tip's fast swing becomes past the peak; None
    where every swing is followed.
    """

    def __init__(self, contact: Contact, patch: Patch, ringing: Ringing | None = None) -> None:
        self.contact, self.patch, self.ringing = contact, patch, ringing
        self.longest, self.library = contact.patience, kernel.library()
        self.kernel = "python" if self.library is None else "c"
        self.haste = patch.haste if 0 < contact.laws.restitution <= RINGING else 1.0
        self.flows: dict[tuple[Grip, Press], Flow] = {}
        self.pieces: list[Piece] = []
        self.states: list[Array] = []  # as each phase that takes time starts

    @classmethod
    def of(cls, tip: TipModes, laws: Laws, compliance: float = 0.0) -> Self:
        """The contact of these tip modes, with a spring of ``compliance``, m/N, at the patch; swings are followed."""
        if compliance:
            return cls(Contact(tip, laws, ("spring", "shear")), SpringPatch(compliance, compliance**0.5))
        return cls(Contact(tip, laws, ("spring",)), RigidPatch())

    @classmethod
    def averaged(cls, tip: TipModes, laws: Laws) -> Self:
        """The contact of a nearly dead tip, averaged over its ringing where that is the fastest motion by far."""
        lively = replace(laws, restitution=max(laws.restitution, LEAST))
        found = cls.of(tip, lively)
        found.ringing = Ringing(found)
        return found if found.ringing.rings else cls.of(tip, laws)

    def flow(self, grip: Grip, press: Press) -> Flow:
        """The linear motion of one phase, with outputs v_t, v_n, F_n, F_t and then any others; made once a contact."""
        if (grip, press) not in self.flows:
            if press == "rigid":
                flow = self._rigid(grip)
            elif self.ringing is not None and press in AVERAGED:
                flow = self.ringing.averaged(grip, press)
            else:
                flow = self._springy(grip, press)
            self.flows[grip, press] = flow
        return self.flows[grip, press]

    def root_stiffness(self, press: Press) -> float:
        """Square root of the tip's stiffness in a phase: it scales the force in the state."""
        laws = self.contact.laws
        return math.sqrt(laws.stiffness) / (laws.restitution if press == "unload" else 1.0)

    def _springy(self, grip: Grip, press: Press) -> Flow:
        contact, root = self.contact, self.root_stiffness(press)
        normal, spring = np.zeros_like(contact.c_n), np.zeros_like(contact.c_n)
        normal[contact.slots["spring"]], spring[contact.slots["spring"]] = root, -root
        rate = contact.fastest + root * float(np.linalg.norm(contact.c_n))
        if grip == "stick":
            return self.patch.held(self, [(contact.c_n, normal), (spring, contact.c_n)], normal, rate)
        rate += root * contact.laws.friction * float(np.linalg.norm(contact.c_t))
        return self.patch.sliding(self, grip, [(self.pull(grip), normal), (spring, contact.c_n)], normal, rate)

    def pull(self, grip: Grip) -> Array:
        """The direction in which the tip's force pushes the state in a slip."""
        contact = self.contact
        return np.asarray(contact.c_n + SIDE[grip] * contact.laws.friction * contact.c_t)

    def _rigid(self, grip: Grip) -> Flow:
        """e = 0 past the peak: forces keep v_n (and in stick v_t) at zero; the tip's force is no longer a state."""
        if grip == "stick":
            return self.patch.rigidly_held(self)
        c_n, pull = self.contact.c_n, self.pull(grip)
        normal = -(c_n @ self.contact.free) / float(c_n @ pull)
        return self.patch.sliding(self, grip, [(pull, normal)], normal, 0.0)

    def slope(self, row: Array, pushes: Pushes) -> Array:
        """The row that reads the rate of change of what ``row`` reads."""
        return np.asarray(sum(((row @ push) * drive for push, drive in pushes), row @ self.contact.free))

    def motion(self, pushes: Pushes, forces: list[Array], *, rate: float = 0.0, held: Array | None = None) -> Flow:
        """The free motion with what pushes and holds it (`pushed`); rate: a bound on it, 1/s, or 0 for its norm.

        forces: the rows that read F_n and F_t, and more outputs of the patch.
        """
        contact = self.contact
        A, drives, directions = pushed(contact.free, pushes, held)
        drives = np.concatenate([drives, contact.dampers])
        directions = np.concatenate([directions, -contact.dampers])
        drive = Drive(contact.omega, contact.slots.swinging, drives, directions)
        rate = rate or max(float(np.linalg.norm(A())), contact.fastest, 1 / contact.laws.time)
        rows = np.array([contact.c_t, contact.c_n, *forces])
        return Flow(A, np.concatenate([rows, contact.dampers]), rate, drive)

    def force(self, grip: Grip, press: Press) -> Array:
        """(F_t, F_n) now, N, if the contact gripped and pressed in this way."""
        return self.flow(grip, press).rows[[F_T, F_N]] @ self.contact.z

    def facing(self) -> tuple[Array, Array]:
        """(c_t, c_n): the contact does not turn."""
        return self.contact.c_t, self.contact.c_n

    def first_grip(self, press: Press) -> Grip:
        """The patch's."""
        laws = self.contact.laws
        stiffness = laws.stiffness / (laws.restitution**2 if press == "unload" else 1.0)
        return self.patch.first_grip(self, press, stiffness)

    def grip_at_rest(self, press: Press) -> Grip:
        """The patch's."""
        return self.patch.grip_at_rest(self, press)

    def at_once(self, grip: Grip, press: Press, most: float) -> bool:
        """In the compiled kernel: a tip that gives something back, and whose swings are all followed."""
        contact = self.contact
        if self.library is None or self.ringing is not None or contact.laws.restitution == 0:
            return False
        if (type(self).flow, type(self).follow) != (Exact.flow, Exact.follow):  # a kind that moves in another way
            return False
        cells, slack = MOST_CELLS * self.haste, ROUNDING * contact.scale
        limits = compiled.Limits(len(ORDERS), most, cells, self.longest, REACH, slack)
        compliance, unit = self.patch.spring
        whole = compiled.contact(self.library, contact, grip, press, compliance=compliance, unit=unit, limits=limits)
        if whole is None:
            return False
        contact.phases += whole.phases
        self.states += list(whole.starts)
        if len(whole.lengths):  # one piece for them all: each of its cells has its own length
            self.pieces.append(Piece(whole.phases[0].start, whole.lengths, whole.cells))
        contact.time, contact.z, contact.peak = whole.time, whole.state, whole.peak
        contact.friction_loss += whole.rubbed
        contact.damping_loss += sum(whole.damped[: contact.lossy])
        contact.radiated += sum(whole.damped[contact.lossy :])
        return True

    def follow(self, grip: Grip, press: Press) -> str:
        """March through one phase, cell by cell."""
        contact = self.contact
        self.patch.begin(self, grip, press)
        names, guards = self.guards(grip, press)
        before, start, flow = contact.impulse, contact.time, self.flow(grip, press)
        self.states.append(contact.z)
        cells = sum(piece.coefficients.shape[2] for piece in self.pieces)
        limit = min(self.longest, start + (MOST_CELLS * self.haste - cells) * flow.step)
        arrival = march(flow, contact.z, guards, start=start, limit=limit)
        if arrival is None:
            raise endless(self, grip, press)
        if grip != "stick":
            rubbed = sum(integral_of_product(piece, F_T, self.patch.slide) for piece in arrival.pieces)
            contact.friction_loss -= rubbed
        self.arrive(arrival.time, arrival.state, arrival.pieces)
        self.patch.end(self, grip, press)
        if self.ringing is not None and press in AVERAGED:
            self.ringing.end(grip, press, start)
        contact.end_phase(grip, press, start, before)
        return names[arrival.guard]

    def arrive(self, time: float, state: Array, pieces: list[Piece]) -> None:
        """Move on to a time and a state, and add up what was damped on the known pieces up to there."""
        contact, first = self.contact, self.patch.outputs
        rows = range(first, first + len(contact.dampers))
        losses = [sum(integral_of_product(piece, row, row) for piece in pieces) for row in rows]
        contact.damping_loss += sum(losses[: contact.lossy])
        contact.radiated += sum(losses[contact.lossy :])
        contact.time, contact.z = time, state
        self.pieces += pieces

    def guards(self, grip: Grip, press: Press) -> tuple[list[str], Guards]:
        """What ends a phase, by name."""
        if self.ringing is not None:
            return self.ringing.guards(grip, press)
        return self.plain_guards(grip, press)

    def plain_guards(self, grip: Grip, press: Press) -> tuple[list[str], Guards]:
        """What ends a phase in which the tip does not ring."""
        contact = self.contact
        mu, slack = contact.laws.friction, ROUNDING * contact.scale
        found: list[Guard] = []
        if press == "load":
            found.append(("compressed", {V_N: -1.0}, 0.0))
        else:
            found += [("apart", {F_N: 1.0}, 0.0), ("reloaded", {F_N: -1.0}, contact.peak)]
        if grip != "stick":
            found.append(("gripped", {self.patch.slide: -SIDE[grip]}, 0.0))
        elif np.isfinite(mu):
            found += [("slipped", {F_N: mu, F_T: -1.0}, slack), ("slipped back", {F_N: mu, F_T: 1.0}, slack)]
        return guards_of(found, self.patch.outputs + len(contact.dampers))

    def next(self, event: str, grip: Grip, press: Press) -> Step | None:
        """What follows, in a contact that rings as the ringing says."""
        if self.ringing is not None:
            return self.ringing.next(event, grip, press)
        return next_phase(self, event, grip, press)

    def compressed(self, grip: Grip) -> None:
        """Nothing beside the tip's force, which is in the state."""

    def press_anew(self, old: Press, new: Press) -> None:
        """Keep the tip's force while its stiffness changes."""
        contact = self.contact
        if old == "rigid":
            contact.put(spring=contact.peak / self.root_stiffness(new))
        else:
            held = float(contact.z[contact.slots["spring"]])
            contact.put(spring=held * (self.root_stiffness(old) / self.root_stiffness(new)))

    def fly(self, until: float, near: float) -> bool:
        """The free motion, and beside it the gap between ball and tip."""
        contact = self.contact
        self.patch.let_go(contact)
        flow, start = self._free_flow(), contact.time
        gap = flow.rows.shape[0] - 1
        weights = np.zeros((1, gap + 1))
        weights[0, gap] = 1.0
        arrival = march(flow, np.append(contact.z, 0.0), Guards(weights, np.array([near])), start=start, limit=until)
        if arrival is None or arrival.time > until:
            return False
        self.states.append(contact.z)
        self.arrive(arrival.time, arrival.state[:-1], arrival.pieces)
        contact.z[contact.slots["spring"]] = 0.0
        contact.end_phase(*APART, start, contact.impulse)
        return True

    def _free_flow(self) -> Flow:
        """The motion without a contact; beside the state the gap between ball and tip, its last output, m."""
        contact, outputs = self.contact, self.patch.outputs
        c_n, size = contact.c_n, len(contact.z)
        rate = 2 * max(contact.fastest, 1 / contact.laws.time)
        scale = rate / float(np.linalg.norm(c_n))  # of the gap in the state, so that it changes as fast as the rest
        A = np.zeros((size + 1, size + 1))
        A[:size, :size], A[size, :size] = contact.free, scale * c_n
        rows = np.zeros((outputs + len(contact.dampers) + 1, size + 1))
        rows[0, :size], rows[1, :size], rows[-1, size] = contact.c_t, c_n, 1 / scale
        rows[outputs:-1, :size] = contact.dampers
        return Flow(A, rows, rate)

    def stretches(self) -> list[Stretch]:
        """The courses of the phases so far, and the free one from now on."""
        gone, now = [phase for phase in self.contact.phases if phase.grip != "blow"], free_course(self.contact)
        return [*(self._course(*each, now) for each in zip(gone, self.states, strict=True)), now]

    def _course(self, phase: Phase, state: Array, free: Course) -> Course:
        """A phase as a course from its first state; free: the course apart."""
        if phase[:2] == APART:
            return free._replace(start=phase.start, state=state)
        flow = self.flow(*cast("tuple[Grip, Press]", phase[:2]))
        return Course(phase.start, lambda: flow.A, flow.rate, state)

    def history(self, mirror: float) -> History:
        """Forces and velocities so far; mirror: -1 for a stroke on the other side."""
        return History(tuple(self.pieces), mirror)

    def tip_loss(self) -> float:
        """Energy that the tip did not give back, that of its ringing included, J."""
        laws = self.contact.laws
        lost = (1 - laws.restitution**2) * self.contact.peak**2 / (2 * laws.stiffness)
        return lost + (0.0 if self.ringing is None else self.ringing.dropped)

    def other_losses(self) -> dict[str, float]:
        """What the cue damped, and what the patch lost."""
        return losses_of(self.contact, self.patch)
