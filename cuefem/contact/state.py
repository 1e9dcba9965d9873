"""The state of a contact: the tip modes and the ball, what has been lost, and the phases gone through.

The state is z = (omega q of the vibrating modes, velocities of all modes, ball's normal and tangential velocity, and
slots of the kind of contact), scaled so that |z|^2/2 is the energy outside friction's and the tip's losses: velocities
in sqrt(kg) m/s, the ball's with sqrt(M); where the ball's turning has no slot of its own, the tangential one is that of
the ball's surface, with sqrt(M nu/(1 + nu)).

With the contact's velocities v_t = c_t . z and v_n = c_n . z (ball less tip), a force (F_t, F_n) on the ball adds
c_t F_t + c_n F_n to z'.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any, Literal, NamedTuple

import numpy as np

from cuefem.beam.tip import TipModes
from cuefem.cue import Array

Grip = Literal["slip", "stick", "slip back"]
# The last five: past the peak of a nearly dead tip, averaged over its ringing (`cuefem.contact.ringing_tip`).
Press = Literal["load", "unload", "rigid", "ringing", "capped", "rubbed", "rubbed back", "swinging"]
SIDE = {"slip": 1.0, "slip back": -1.0, "stick": 0.0}
# Grip and press of a phase in which ball and tip are apart, before they touch again (the effect SecondHit).
APART = ("apart", "free")
# A contact that lasts this many head-on contact times (and a period and a half of the slowest vibration, on which a
# rigid tip may ride) does not end.
LONGEST = 200


class Phase(NamedTuple):
    """One phase of a contact.

    Attributes
    ----------
    grip : str
        "slip", "stick" or "slip back"; "blow" for the blow of endless friction, "apart" between two hits.
    press : str
        How the tip is pressed: "load", "unload", "rigid" (a dead tip past its peak), "free" between two hits, and the
        phases of a nearly dead tip that rings (`cuefem.contact.ringing_tip`).
    start, end : float
        Times from first touch, s.
    impulse : tuple of float
        Impulse (t, n) on the ball in this phase, N s.
    """

    grip: str
    press: str
    start: float
    end: float
    impulse: tuple[float, float]


@dataclass(frozen=True)
class Laws:
    """The constants of a contact in SI; phi: the angle of the contact, rad; time: the head-on contact time, s.

    incoming: the ball's own speed towards the cue at first touch, m/s; only a strike from the side has one.
    """

    phi: float
    ball_mass: float
    inertia: float
    stiffness: float
    restitution: float
    friction: float
    time: float
    speed: float
    incoming: float = 0.0


class Slots:
    """Where the parts of a state stand: omega q of the vibrating modes, all modes' velocities, and one name a slot."""

    def __init__(self, rigid: int, vibrating: int, names: tuple[str, ...]) -> None:
        start = rigid + 2 * vibrating
        self.vibration = slice(0, vibrating)
        self.velocities = slice(vibrating, start)
        self.rigid = slice(vibrating, vibrating + rigid)
        self.swinging = slice(vibrating + rigid, start)
        self.places = {name: start + i for i, name in enumerate(names)}
        self.size = start + len(names)

    def __getitem__(self, name: str) -> int:
        return self.places[name]

    def __contains__(self, name: str) -> bool:
        return name in self.places

    def of(self, *names: str) -> list[int]:
        """The places of several slots."""
        return [self.places[name] for name in names]


class Resistance(NamedTuple):
    """Of the modes against their motion: rows (dampers, size) whose squares add up to its power, the first ``lossy`` of
    which damp while the others radiate; strength: the sum of the greatest of both, 1/s.
    """

    rows: Array
    lossy: int
    strength: float

    @classmethod
    def of(cls, tip: TipModes, slots: Slots) -> Resistance:
        """Of tip modes, in states with these slots."""
        rows, counts, strength = [np.zeros((0, slots.size))], [0, 0], 0.0
        for i, damping in enumerate((tip.damping, tip.radiation)):
            if damping is not None:
                modes, ways, strongest = _split(damping)
                wide = np.zeros((len(ways), slots.size))
                wide[:, slots.velocities.start + modes] = ways
                rows.append(wide)
                counts[i], strength = len(ways), strength + strongest
        return cls(np.concatenate(rows), counts[0], strength)


def _split(damping: Array) -> tuple[Any, Array, float]:
    """(the modes that a damping acts on, rows over them whose squares add up to its power, its greatest strength)."""
    modes = np.flatnonzero(damping.any(axis=1))  # a tail's radiation is that of a few
    strengths, directions = np.linalg.eigh(damping[np.ix_(modes, modes)])
    acting = strengths > 1e-14 * strengths.max(initial=0.0)
    rows = (directions[:, acting] * np.sqrt(strengths[acting])).T
    return modes, rows, float(strengths.max(initial=0.0))


@dataclass
class Contact:
    """Tip modes and laws of a contact; its state, what it has lost, J, and its phases so far.

    names: the slots of its kind, behind ball_n and ball_t. peak: the tip's force at the last greatest compression, N.
    parted: whether the blow of endless friction alone threw ball and tip apart. resistance: of the modes, where it is
    known from another contact of theirs.
    """

    tip: TipModes
    laws: Laws
    names: tuple[str, ...]
    time: float = 0.0
    friction_loss: float = 0.0
    damping_loss: float = 0.0
    radiated: float = 0.0
    peak: float = 0.0
    parted: bool = False
    phases: list[Phase] = field(default_factory=list)
    resistance: Resistance | None = None

    def __post_init__(self) -> None:
        tip, laws = self.tip, self.laws
        s, c = math.sin(laws.phi), math.cos(laws.phi)
        modal = tip.amplitude @ np.array([[s, c], [c, -s]])  # (u, w) to (t, n)
        omega = self.omega = tip.omega[tip.omega > 0]
        self.quiet = len(tip.omega) - len(omega)  # rigid modes come first
        slots = self.slots = Slots(self.quiet, len(omega), ("ball_n", "ball_t", *self.names))
        size, mass, nu = slots.size, laws.ball_mass, laws.inertia
        self.c_t, self.c_n = np.zeros(size), np.zeros(size)
        self.c_t[slots.velocities], self.c_n[slots.velocities] = -modal[:, 0], -modal[:, 1]
        self.c_n[slots["ball_n"]] = mass**-0.5
        if "spin" in slots:
            self.c_t[slots["ball_t"]], self.c_t[slots["spin"]] = mass**-0.5, (nu * mass) ** -0.5
        else:
            self.c_t[slots["ball_t"]] = (mass * nu / (1 + nu)) ** -0.5
        self.resistance = self.resistance or Resistance.of(tip, slots)
        self.dampers, self.lossy, strength = self.resistance
        self.fastest = float(omega.max(initial=0.0)) + strength
        self.z = np.zeros(size)
        self.z[slots.velocities] = laws.speed * tip.approach
        self.z[slots["ball_n"]] = -laws.incoming * math.sqrt(mass)
        self.along_before = 0.0

    @cached_property
    def free(self) -> Array:
        """The motion without forces at the contact, (size, size)."""
        n, slots, size = len(self.omega), self.slots, self.slots.size
        found = np.zeros((size, size))
        turning = np.arange(slots.swinging.start, slots.swinging.stop)
        found[np.arange(n), turning], found[turning, np.arange(n)] = self.omega, -self.omega
        for damping in (self.tip.damping, self.tip.radiation):
            if damping is not None:
                found[slots.velocities, slots.velocities] -= damping
        return found

    @cached_property
    def readings(self) -> tuple[Array, Array]:
        """Rows that read the impulse on the ball (t, n), the part that turns it, and that along the cue; over divisors.

        A division keeps the digits of small impulses that a product with its inverse would round away.
        """
        rows, laws, slots = np.zeros((4, len(self.z))), self.laws, self.slots
        t, n = slots.of("ball_t", "ball_n")
        per_t, per_n = float(self.c_t[t]), float(self.c_n[n])
        rows[0, t] = rows[1, n] = 1.0
        if "spin" in slots:  # of the tangential force, wherever its direction was
            rows[2, slots["spin"]] = math.sqrt(laws.inertia * laws.ball_mass)
        else:
            rows[2, t] = 1.0
        rows[3, t], rows[3, n] = math.sin(laws.phi) / per_t, math.cos(laws.phi) / per_n
        return rows, np.array([per_t, per_n, 1.0 if "spin" in slots else per_t, 1.0])

    @property
    def impulse(self) -> tuple[float, float]:
        """Impulse (t, n) on the ball so far, N s; of one that came in, its momentum."""
        rows, per = self.readings
        p_t, p_n = (rows[:2] @ self.z / per[:2]).tolist()
        return p_t, p_n

    @property
    def impulses(self) -> tuple[float, float, float, float]:
        """Impulse (t, n) on the ball so far, the part that turned it, and the part along the cue, N s."""
        rows, per = self.readings
        p_t, p_n, twist, along = (rows @ self.z / per).tolist()
        return p_t, p_n, twist, self.along_before + along

    @property
    def scale(self) -> float:
        """Scale of the contact's force, N."""
        return self.laws.speed * math.sqrt(self.laws.stiffness / float(self.c_n @ self.c_n))

    @property
    def patience(self) -> float:
        """How long the contact may last at most, s.

        A dead tip may stay on a slow mode, slower still with the ball on it, by no more than the second term.
        """
        longest = LONGEST * self.laws.time
        if len(self.omega):
            before, after = self.c_n[: self.slots.swinging.start], self.c_n[self.slots.swinging.stop :]
            still = float(before @ before + after @ after)
            longest += 10 / float(self.omega.min()) * math.sqrt(float(self.c_n @ self.c_n) / still)
        return longest

    def put(self, **slots: float) -> None:
        """Set slots of the state by name; the array is a new one, since courses keep the old."""
        self.z = self.z.copy()
        for name, value in slots.items():
            self.z[self.slots[name]] = value

    def end_phase(self, grip: str, press: str, start: float, before: tuple[float, float]) -> None:
        """Write down a phase that has ended now; before: the impulse on the ball at its start, N s."""
        after = self.impulse
        self.phases.append(
            Phase(grip, press, float(start), float(self.time), (after[0] - before[0], after[1] - before[1]))
        )
