"""The contact between a vibrating cue and the ball: its linear phases, and which follows which.

The state is z = (omega q of the vibrating modes, velocities of all modes, ball's normal and tangential surface
velocity, tip force), scaled so that |z|^2/2 is the energy outside friction's and the tip's losses:

    velocities in sqrt(kg) m/s, the ball's with sqrt(M) and sqrt(M nu/(1 + nu)), the tip's force over sqrt(stiffness).

With the contact's velocities v_t = c_t . z and v_n = c_n . z (ball less tip), a force (F_t, F_n) on the ball adds
c_t F_t + c_n F_n to z'. Tangentially the contact slips (F_t = side mu F_n) or sticks (F_t keeps v_t at zero); normally
the tip is loaded (F_n' = -k v_n), or unloaded and reloaded below its peak (k/e^2 for k), or, for e = 0, held rigidly
(F_n keeps v_n at zero). Each pair of the two is one linear phase.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import ClassVar, Literal, NamedTuple

import numpy as np

from cuefem.beam.tip import TipModes
from cuefem.contact.flow import Arrival, Drive, Flow, Guards, Piece, Pushes, integral_of_product, march, pushed
from cuefem.contact.history import F_N, F_T, V_N, V_T, History
from cuefem.cue import Array

Grip = Literal["slip", "stick", "slip back"]
# The last five: past the peak of a nearly dead tip, averaged over its ringing (`cuefem.contact.ringing_tip`).
Press = Literal["load", "unload", "rigid", "ringing", "capped", "rubbed", "rubbed back", "swinging"]
SIDE = {"slip": 1.0, "slip back": -1.0, "stick": 0.0}
# Grip and press of a phase in which ball and tip are apart, before they touch again (the effect SecondHit).
APART = ("apart", "free")

# A contact that lasts this many head-on contact times (and a period and a half of the slowest vibration, on which a
# rigid tip may ride), or changes phase this often, does not end.
LONGEST, MOST_PHASES = 200, 5_000
# A contact of more cells than this is given up: seconds of work, and 300 MB of history. It takes a tip that rings, 1/e
# times faster than the contact, under a cue that presses it on, and whose ringing cannot be averaged
# (`cuefem.contact.ringing_tip`).
MOST_CELLS = 500_000
# |F_t| may pass mu F_n by this part of the force scale: at mu = mu_c, and where F_n vanishes at separation, the two are
# equal but for rounding.
ROUNDING = 1e-12
# With more dampers than this the response to them costs more than the exponential of a matrix.
FEW = 4


class Phase(NamedTuple):
    """One phase: how it grips and presses; its start and end, s; the impulse (t, n) given in it, N s."""

    grip: str
    press: str
    start: float
    end: float
    impulse: tuple[float, float]


class Course(NamedTuple):
    """From a start, s, on the state z moves by z' = A z, with |A| <= rate, 1/s, to the next course's start."""

    start: float
    A: Array
    rate: float
    state: Array


@dataclass(frozen=True)
class Laws:
    """The constants of a contact in SI; phi: the angle of the contact, rad; time: the head-on contact time, s."""

    phi: float
    ball_mass: float
    inertia: float
    stiffness: float
    restitution: float
    friction: float
    time: float
    speed: float


@dataclass
class Contact:
    """The contact as it goes: tip modes and laws; the state and what has been lost so far."""

    # What a kind of contact may change: states beyond the base model's, the output that is the sliding velocity, and
    # the number of outputs before those of the dampers.
    extra_states: ClassVar[int] = 0
    slide: ClassVar[int] = V_T
    outputs: ClassVar[int] = 4

    tip: TipModes
    laws: Laws
    time: float = 0.0
    friction_loss: float = 0.0
    damping_loss: float = 0.0
    parted: bool = False
    radiated: float = 0.0
    peak: float = 0.0
    phases: list[Phase] = field(default_factory=list)
    pieces: list[Piece] = field(default_factory=list)
    courses: list[Course] = field(default_factory=list)

    def __post_init__(self) -> None:
        tip, laws = self.tip, self.laws
        s, c = math.sin(laws.phi), math.cos(laws.phi)
        modal = tip.amplitude @ np.array([[s, c], [c, -s]])  # (u, w) to (t, n)
        vibrating = tip.omega > 0
        self.quiet = int(np.sum(~vibrating))  # rigid modes come first
        omega = self.omega = tip.omega[vibrating]
        n, modes = len(omega), len(tip.omega)
        size = n + modes + 3 + self.extra_states
        self.velocities = slice(n, n + modes)
        self.ball_n, self.ball_t, self.spring = n + modes, n + modes + 1, n + modes + 2
        self.c_t, self.c_n = np.zeros(size), np.zeros(size)
        self.c_t[self.velocities], self.c_n[self.velocities] = -modal[:, 0], -modal[:, 1]
        self.c_n[self.ball_n] = laws.ball_mass**-0.5
        self.c_t[self.ball_t] = (laws.ball_mass * laws.inertia / (1 + laws.inertia)) ** -0.5
        self.free = np.zeros((size, size))  # the motion without forces at the contact
        self.swinging = slice(n + self.quiet, n + modes)
        turning = np.arange(n + self.quiet, n + modes)
        self.free[np.arange(n), turning], self.free[turning, np.arange(n)] = omega, -omega
        self.fastest = float(omega.max(initial=0.0))
        self.longest = LONGEST * laws.time
        if n:  # a dead tip may stay on a slow mode, slower still with the ball on it, by no more than this
            still = np.delete(self.c_n, turning)
            self.longest += 10 / float(omega.min()) * float(np.linalg.norm(self.c_n) / np.linalg.norm(still))
        self.dampers = np.zeros((0, size))  # rows whose squares add up to the damped power
        if tip.damping is not None:
            self._damp(tip.damping)
        self.lossy = len(self.dampers)  # those after them radiate
        if tip.radiation is not None:
            self._damp(tip.radiation)
        self.z = np.zeros(size)
        self.z[self.velocities] = laws.speed * tip.approach
        self.scale = laws.speed * math.sqrt(laws.stiffness / float(self.c_n @ self.c_n))  # of the force
        self.flows: dict[tuple[Grip, Press], Flow] = {}

    def _damp(self, damping: Array) -> None:
        modes = np.flatnonzero(damping.any(axis=1))  # a tail's radiation is that of a few
        strengths, directions = np.linalg.eigh(damping[np.ix_(modes, modes)])
        acting = strengths > 1e-14 * strengths.max(initial=0.0)
        rows = np.zeros((int(acting.sum()), len(self.free)))
        rows[:, self.velocities.start + modes] = (directions[:, acting] * np.sqrt(strengths[acting])).T
        self.dampers = np.concatenate([self.dampers, rows])
        self.free[self.velocities, self.velocities] -= damping
        self.fastest += float(strengths.max(initial=0.0))

    def flow(self, grip: Grip, press: Press) -> Flow:
        """The linear motion of one phase, with outputs v_t, v_n, F_n, F_t and then any others; made once a contact."""
        if (grip, press) not in self.flows:
            self.flows[grip, press] = self._rigid(grip) if press == "rigid" else self._springy(grip, press)
        return self.flows[grip, press]

    def root_stiffness(self, press: Press) -> float:
        """Square root of the tip's stiffness in a phase: it scales the force in the state."""
        return math.sqrt(self.laws.stiffness) / (self.laws.restitution if press == "unload" else 1.0)

    def _springy(self, grip: Grip, press: Press) -> Flow:
        root = self.root_stiffness(press)
        normal, spring = np.zeros_like(self.c_n), np.zeros_like(self.c_n)
        normal[self.spring], spring[self.spring] = root, -root
        rate = self.fastest + root * float(np.linalg.norm(self.c_n))
        if grip == "stick":
            return self._held([(self.c_n, normal), (spring, self.c_n)], normal, rate)
        rate += root * self.laws.friction * float(np.linalg.norm(self.c_t))
        return self._sliding(grip, [(self._pull(grip), normal), (spring, self.c_n)], normal, rate)

    def _pull(self, grip: Grip) -> Array:
        """The direction in which the tip's force pushes the state in a slip."""
        return np.asarray(self.c_n + SIDE[grip] * self.laws.friction * self.c_t)

    def _rigid(self, grip: Grip) -> Flow:
        """e = 0 past the peak: forces keep v_n (and in stick v_t) at zero; the tip's force is no state any more."""
        if grip == "stick":
            return self._rigidly_held()
        pull = self._pull(grip)
        normal = -(self.c_n @ self.free) / float(self.c_n @ pull)
        return self._sliding(grip, [(pull, normal)], normal)

    def _sliding(self, grip: Grip, pushes: Pushes, normal: Array, rate: float = 0.0) -> Flow:
        """A slipping phase: both forces are known combinations of the state."""
        return self._flow(pushes, [self.c_t, self.c_n, normal, SIDE[grip] * self.laws.friction * normal], rate)

    def _held(self, pushes: Pushes, normal: Array, rate: float) -> Flow:
        """A sticking phase: the tangential force keeps v_t at zero."""
        square = float(self.c_t @ self.c_t)
        tangent = self._slope(self.c_t, pushes) / -square
        return self._flow(pushes, [self.c_t, self.c_n, normal, tangent], rate, self.c_t[:, None] / math.sqrt(square))

    def _rigidly_held(self) -> Flow:
        contact = np.array([self.c_t, self.c_n])
        tangent, normal = -np.linalg.solve(contact @ contact.T, contact @ self.free)
        return self._flow([], [self.c_t, self.c_n, normal, tangent], held=np.linalg.qr(contact.T)[0])

    def _slope(self, row: Array, pushes: Pushes) -> Array:
        """The row that reads the rate of change of what ``row`` reads."""
        return np.asarray(sum(((row @ push) * drive for push, drive in pushes), row @ self.free))

    def _flow(self, pushes: Pushes, rows: list[Array], rate: float = 0.0, held: Array | None = None) -> Flow:
        """The free motion with what pushes and holds it (`pushed`); rate: a bound on it, 1/s, or 0 for its norm."""
        A, drives, directions = pushed(self.free, pushes, held)
        drive = None
        if len(self.dampers) <= FEW:
            directions, drives = np.concatenate([directions, -self.dampers]), np.concatenate([drives, self.dampers])
            drive = Drive(self.omega, self.swinging, drives, directions)
        rate = rate or max(float(np.linalg.norm(A)), self.fastest, 1 / self.laws.time)
        return Flow(A, np.concatenate([np.array(rows), self.dampers]), rate, drive)

    def force(self, grip: Grip, press: Press) -> Array:
        """(F_t, F_n) now, N, if the contact gripped and pressed in this way."""
        rows = self.flow(grip, press).rows
        return rows[[F_T, F_N]] @ self.z

    def facing(self) -> tuple[Array, Array]:
        """(c_t, c_n) now."""
        return self.c_t, self.c_n

    def give(self, p_t: float) -> None:
        """A tangential blow on the ball, N s: what endless friction does at the first touch."""
        c_t, _ = self.facing()
        before = float(c_t @ self.z)
        self.z = self.z + c_t * p_t
        self.friction_loss -= p_t * (before + float(c_t @ self.z)) / 2
        self.phases.append(Phase("blow", "load", self.time, self.time, (p_t, 0.0)))

    @property
    def patience(self) -> float:
        """The part of `MOST_PHASES` and `MOST_CELLS` after which the contact is given up."""
        return 1.0

    @property
    def impulse(self) -> tuple[float, float]:
        """Impulse (t, n) on the ball so far, N s."""
        ball_t, ball_n = self.ball_t, self.ball_n
        return float(self.z[ball_t] / self.c_t[ball_t]), float(self.z[ball_n] / self.c_n[ball_n])

    @property
    def twist(self) -> float:
        """The part of the impulse that turned the ball, N s."""
        return self.impulse[0]

    @property
    def along(self) -> float:
        """The part of the impulse along the cue, N s."""
        p_t, p_n = self.impulse
        return math.sin(self.laws.phi) * p_t + math.cos(self.laws.phi) * p_n

    @property
    def tip_loss(self) -> float:
        """Energy that the tip did not give back, J."""
        return (1 - self.laws.restitution**2) * self.peak**2 / (2 * self.laws.stiffness)

    def history(self, mirror: float) -> History:
        """Forces and velocities so far; mirror: -1 for a stroke on the other side."""
        return History(tuple(self.pieces), mirror)

    def go(self, grip: Grip, press: Press) -> tuple[str, Grip, Press] | None:
        """Follow one phase to its end; what ended it, and what comes next (None: the ball has left)."""
        self._enter(grip, press)
        names, guards = self._guards(grip, press)
        before = self.impulse
        flow = self.flow(grip, press)
        self.courses.append(Course(self.time, flow.A, flow.rate, self.z))
        limit = min(self.longest, self.time + (MOST_CELLS * self.patience - self.cells) * flow.step)
        arrival = march(flow, self.z, guards, start=self.time, limit=limit)
        if arrival is None:
            raise self.endless(grip, press)
        self._take(arrival, grip, press, before)
        return self._next(names[arrival.guard], grip, press)

    @property
    def cells(self) -> int:
        """How many cells of a flow the contact has taken so far."""
        return sum(piece.coefficients.shape[2] for piece in self.pieces)

    def _enter(self, grip: Grip, press: Press) -> None:
        """What the start of a phase changes in the state: nothing in the base model."""

    def _guards(self, grip: Grip, press: Press) -> tuple[list[str], Guards]:
        mu, slack = self.laws.friction, ROUNDING * self.scale
        found: list[tuple[str, dict[int, float], float]] = []
        if press == "load":
            found.append(("compressed", {V_N: -1.0}, 0.0))
        else:
            found += [("apart", {F_N: 1.0}, 0.0), ("reloaded", {F_N: -1.0}, self.peak)]
        if grip != "stick":
            found.append(("gripped", {self.slide: -SIDE[grip]}, 0.0))
        elif np.isfinite(mu):
            found += [("slipped", {F_N: mu, F_T: -1.0}, slack), ("slipped back", {F_N: mu, F_T: 1.0}, slack)]
        weights = np.zeros((len(found), self.outputs + len(self.dampers)))
        for row, (_, terms, _) in zip(weights, found, strict=True):
            row[list(terms)] = list(terms.values())
        return [name for name, _, _ in found], Guards(weights, np.array([constant for _, _, constant in found]))

    def _take(self, arrival: Arrival, grip: Grip, press: Press, before: tuple[float, float]) -> None:
        if grip != "stick":
            self.friction_loss -= sum(integral_of_product(piece, F_T, self.slide) for piece in arrival.pieces)
        rows = range(self.outputs, self.outputs + len(self.dampers))
        losses = [sum(integral_of_product(piece, row, row) for piece in arrival.pieces) for row in rows]
        self.damping_loss += sum(losses[: self.lossy])
        self.radiated += sum(losses[self.lossy :])
        start, self.time, self.z = self.time, arrival.time, arrival.state
        self._leave(grip, press)
        self.pieces += arrival.pieces
        after = self.impulse
        given = (after[0] - before[0], after[1] - before[1])
        self.phases.append(Phase(grip, press, start, self.time, given))

    def _leave(self, grip: Grip, press: Press) -> None:
        """What the end of a phase changes in the state: rounding along the direction that stick has held."""
        if grip == "stick":
            self.z = self.z - self.c_t * (self.c_t @ self.z / (self.c_t @ self.c_t))

    def _next(self, event: str, grip: Grip, press: Press) -> tuple[str, Grip, Press] | None:
        if event == "apart":
            return None
        if event == "compressed":
            return self._unload(grip)
        if event == "reloaded":
            self._press(press, "load")
            return event, grip, "load"
        if event == "gripped":
            return self._slide(event, self.grip_at_rest(press), press)
        return self._slide(event, "slip" if event == "slipped" else "slip back", press)

    def _slide(self, event: str, grip: Grip, press: Press) -> tuple[str, Grip, Press] | None:
        # Slip against a rigid tip in a jam has no stable force. As slip sets in, the tip's force is below what would
        # keep v_n at zero (in the limit e -> 0 it runs on as in stick, F, and what it would have to be runs ahead), so
        # it falls, ever faster, to nothing: the ball leaves.
        return (event, grip, press) if press != "rigid" or self._pressed_together(grip) else None

    def _pressed_together(self, grip: Grip) -> bool:
        """Whether a growing tip force drives ball and tip apart, which a rigid tip needs."""
        if grip == "stick":
            return True
        c_t, c_n = self.facing()
        return float(c_n @ (c_n + SIDE[grip] * self.laws.friction * c_t)) > 0

    def _unload(self, grip: Grip) -> tuple[str, Grip, Press] | None:
        self.peak = float(self.force(grip, "load")[1])
        if self.laws.restitution > 0:
            self._press("load", "unload")
            return "compressed", grip, "unload"
        # past the peak a tip of e = 0 pushes on only as far as the cue presses against the ball
        if not self._pressed_together(grip) or float(self.force(grip, "rigid")[1]) <= 0:
            return None
        return "compressed", grip, "rigid"

    def _press(self, old: Press, new: Press) -> None:
        """Keep the tip's force while its stiffness changes."""
        self.z = self.z.copy()
        if old == "rigid":
            self.z[self.spring] = self.peak / self.root_stiffness(new)
        else:
            self.z[self.spring] *= self.root_stiffness(old) / self.root_stiffness(new)

    def first_grip(self, press: Press = "load") -> Grip:
        """How a touch grips: the tip slips unless it does not move aside or friction is endless."""
        c_t, c_n = self.facing()
        sliding, closing = float(c_t @ self.z), float(c_n @ self.z)
        if sliding == 0:
            return "stick"
        if np.isinf(self.laws.friction):
            blow, turn = -sliding / float(c_t @ c_t), float(c_n @ c_t)
            if closing + turn * blow > 0:  # the limit of great friction: the blow alone throws the two apart
                blow = math.copysign(min(abs(blow), (1 + self.laws.restitution) * abs(closing / turn)), blow)
                self.parted = True
            self.give(blow)
            return "stick"
        return "slip" if sliding < 0 else "slip back"

    def grip_at_rest(self, press: Press) -> Grip:
        """Stick where friction can hold the contact, else the way it starts to slip."""
        tangent, normal = self.force("stick", press)
        if np.isinf(self.laws.friction) or abs(tangent) <= self.laws.friction * normal + ROUNDING * self.scale:
            return "stick"
        return "slip" if tangent > 0 else "slip back"

    def other_losses(self) -> dict[str, float]:
        """Energy that went into what effects added, J by name."""
        return {"damping loss": self.damping_loss} if self.lossy else {}

    def endless(self, grip: Grip, press: Press) -> RuntimeError:
        """The error of a contact that does not end, with its state."""
        v_t, v_n = (row @ self.z for row in self.facing())
        F_t, F_n = self.force(grip, press)
        return RuntimeError(
            f"the ball does not leave the cue: after {self.time:.6g} s and {len(self.phases)} phases "
            f"(head-on contact time {self.laws.time:.6g} s) the contact is in "
            f"{grip}, {press}, with v_t = {v_t:.3g} m/s, v_n = {v_n:.3g} m/s, F_n = {F_n:.3g} N, F_t = {F_t:.3g} N; "
            "check restitution, contact time and the masses, or keep fewer modes"
        )


def run(contact: Contact, press: Press = "load") -> None:
    """The whole contact, from touch to separation."""
    contact.parted = False  # of this touch: a second hit is another
    grip = contact.first_grip(press)
    step: tuple[str, Grip, Press] | None = None if contact.parted else ("touch", grip, press)
    while step is not None:
        if len(contact.phases) > MOST_PHASES * contact.patience:
            raise contact.endless(grip, press)
        _, grip, press = step
        step = contact.go(grip, press)
