"""The contact of a nearly dead tip, which rings much faster than anything else moves (handbook: A nearly dead tip).

A tip of small restitution e unloads with the stiffness k/e^2. On that stiff spring ball and cue swing against each
other with the angular frequency w = sqrt(k B)/e, B the rate of v_n per unit of F_n. Past the peak the forces are

    F_n = N + a cos(wt),    F_t = T + (f or -h) a cos(wt),    f = mu side in slip, h = c_t.c_n/c_t.c_t in stick,

where N and T are the forces that hold v_n (in stick also v_t) at zero. The mean motion feels N and T alone, and the
ringing carries only e^2 of the tip's energy. Its amplitude a is constant except for damping and these limits:

- F_n does not pass the old peak P: a <= P - N, for beyond it the tip is softer and takes the energy ("capped"; a = 0
  there is ordinary loading);
- stick lasts for the whole of a swing only if mu (N -+ a) >= |T +- h a|. Otherwise the contact slips for a part of
  each swing, with a v_t of the order e: the mean motion still sticks. While it slips v_n is off by h v_t, which
  moves F_n by -k h times the slip. Where that opposes the swing, a falls to the bound within a few swings and follows
  it ("rubbed"): a contact at the end of stick then has no ringing left. Where it adds to the swing (side h < 0 and the
  bound is met at the least F_n), a grows instead, up to where the peak, or a longer slip, takes as much ("swinging");
- ball and cue part where N <= a.

So phases past the peak are linear again, without the fast swing in them. Where a swing decides about the grip (stick
sets in, or the tip swings beyond what friction bears), a few swings are followed exactly instead; while it goes on
swinging so, the mean motion leaps `LEAP` contact times ahead from one such look to the next.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from cuefem.contact.flow import Flow, Guard, Guards, guards_of
from cuefem.contact.history import F_N, F_T, V_T
from cuefem.contact.phases import ROUNDING, Step, next_phase, pressed_together
from cuefem.contact.state import SIDE, Grip, Press
from cuefem.cue import Array

if TYPE_CHECKING:
    from cuefem.contact.linear import Exact

# A tip's ringing is averaged where its restitution is at most this and it rings so many times faster than the fastest
# mode. Against exact phases the impulse is then off by less than e (1e-4) in slip, and by less than 0.1 sqrt(e) (1e-3)
# where the contact sticks (tests/contact/test_ringing_tip_verification.py). Of 150 random cues of loud modes eight were
# followed in exact phases down to a restitution of 1e-4: there it was off by 6e-3 at worst.
RINGING, FASTER = 1e-4, 10.0
# Below this, restitution changes nothing but the rounding, which grows like 1/e.
LEAST = 1e-8
# After so many exact phases that did not settle, the ringing counts as down to what friction bears.
UNSETTLED = 40
# While the tip swings beyond friction's bound: how far the mean motion leaps, in contact times; for how many exact
# phases the swing is then followed; and by how much more it swings once it has met the bound, if the swing grows by
# itself.
LEAP, LOOK, GROWN = 1 / 256, 6, 1.1
# The amplitude after it left a bound, relative to that: a little less, so that rounding does not bring it back.
BELOW = 1 - 1e-12
AVERAGED = ("ringing", "capped", "rubbed", "rubbed back", "swinging")
SLIPS: dict[str, Grip] = {"rubbed": "slip", "rubbed back": "slip back"}
RUBBED: dict[str, Press] = {"rubbed": "rubbed", "rubbed back": "rubbed back"}


class Swing(NamedTuple):
    """The fast swing in a grip: the direction in which the state moves, B, the frequency, rad/s, and the decay, 1/s."""

    pull: Array
    give: float
    omega: float
    decay: float


class Parts(NamedTuple):
    """A state as its mean, the mean forces N and T, N, and the swing's amplitude, N, and angle, rad."""

    mean: Array
    N: float
    T: float
    amplitude: float
    angle: float


class Ringing:
    """The averaged phases past the peak of the contact ``exact``; the slot "spring" then holds the amplitude.

    dropped: energy that the averaging took out of the state, J. angle: of the swing as an averaged phase starts, rad.
    unsettled: exact phases since the last averaged one. kept: the amplitude during a leap, N.
    """

    def __init__(self, exact: Exact) -> None:
        self.exact = exact
        self.dropped, self.angle, self.kept = 0.0, 0.0, 0.0
        self.unsettled = 0

    @property
    def rings(self) -> bool:
        """Whether the tip rings far faster than every mode."""
        return self._swing("stick").omega >= FASTER * self.exact.contact.fastest

    @property
    def lever(self) -> float:
        """The h of F_t = T - h (F_n - N) in stick."""
        contact = self.exact.contact
        return float(contact.c_t @ contact.c_n) / float(contact.c_t @ contact.c_t)

    @property
    def _friction(self) -> float:
        return self.exact.contact.laws.friction

    @property
    def _spring(self) -> float:
        """The value in the slot of the tip's force, or of the amplitude."""
        return float(self.exact.contact.z[self.exact.contact.slots["spring"]])

    def _swing(self, grip: Grip) -> Swing:
        contact = self.exact.contact
        pull = contact.c_n - self.lever * contact.c_t if grip == "stick" else self.exact.pull(grip)
        reader = pull if grip == "stick" else contact.c_n
        give = float(contact.c_n @ pull)
        if give <= 0:
            return Swing(pull, give, 0.0, 0.0)
        decay = -float(reader @ contact.free @ pull) / (2 * give)
        return Swing(pull, give, self.exact.root_stiffness("unload") * math.sqrt(give), decay)

    def averaged(self, grip: Grip, press: Press) -> Flow:
        """The linear motion of an averaged phase; its last outputs are the amplitude and its relief.

        Relief is the rate at which the bound on the amplitude rises above what damping leaves of it.
        """
        contact, held, decay = self.exact.contact, self.exact.flow(grip, "rigid"), self._swing(grip).decay
        if press == "swinging":
            decay = math.log(2) / (LEAP * contact.laws.time)  # an hourglass
        unit = np.zeros(len(contact.z))
        unit[contact.slots["spring"]] = 1.0
        A = held.A - decay * np.outer(unit, unit)
        normal, tangent = held.rows[F_N], held.rows[F_T]
        if press in ("ringing", "swinging"):
            amplitude = self.exact.root_stiffness("load") * unit
        elif press == "capped":
            amplitude = -normal  # and the peak beside it
        else:
            side = SIDE[SLIPS[press]]
            amplitude = (self._friction * normal - side * tangent) / self._share(side)
        rows = np.concatenate([held.rows, [amplitude, amplitude @ A + decay * amplitude]])
        drive = held.drive
        if drive is not None and decay:
            drive = drive._replace(
                rows=np.concatenate([drive.rows, [-decay * unit]]), pushes=np.concatenate([drive.pushes, [unit]])
            )
        return Flow(A, rows, max(held.rate, float(np.linalg.norm(A))), drive)

    def _share(self, side: float) -> float:
        """How much of friction's margin on one side each unit of amplitude uses up."""
        return abs(self._friction + side * self.lever)

    def guards(self, grip: Grip, press: Press) -> tuple[list[str], Guards]:
        """What ends a phase, by name."""
        contact = self.exact.contact
        if press not in AVERAGED:
            names, guards = self.exact.plain_guards(grip, press)
            return self._until_steady(names, guards, grip) if press == "unload" and grip != "stick" else (names, guards)
        swing, mu, slack = self._swing(grip), self._friction, ROUNDING * contact.scale
        size = len(self.exact.flow(grip, press).rows)
        AMPLITUDE, RELIEF = size - 2, size - 1
        known = contact.peak if press == "capped" else 0.0  # of the amplitude, beside its row
        if press == "swinging":
            weights = np.zeros((3, size))
            weights[0, AMPLITUDE] = 1.0
            weights[1:, F_N], weights[1:, F_T] = mu, (-1.0, 1.0)
            return ["leapt", "slipped", "slipped back"], Guards(weights, np.array([-self.kept / 2, slack, slack]))
        found: list[Guard] = [("apart", {F_N: 1.0, AMPLITUDE: -1.0}, -known)]
        if press == "capped":
            found.append(("reloaded", {AMPLITUDE: 1.0}, known))
        else:
            found.append(("capped", {F_N: -1.0, AMPLITUDE: -1.0}, contact.peak))
        if press != "ringing":
            found.append(("relieved", {RELIEF: -1.0}, -swing.decay * known))
        if grip != "stick":
            reach = abs(float(contact.c_t @ swing.pull)) / swing.omega  # of v_t in a swing, per unit of the amplitude
            found.append(("gripped", {V_T: -SIDE[grip], AMPLITUDE: -reach}, -reach * known))
        elif np.isfinite(mu):
            for name, way in SLIPS.items():
                if press == name:
                    found.append(("used up", {AMPLITUDE: 1.0}, slack))
                else:
                    share = self._share(SIDE[way])
                    found.append((name, {F_N: mu, F_T: -SIDE[way], AMPLITUDE: -share}, slack - share * known))
        return guards_of(found, size)

    def _until_steady(self, names: list[str], guards: Guards, grip: Grip) -> tuple[list[str], Guards]:
        """An exact slip ends where it is past the reach of its swing, and the ball does not part within that."""
        parts = self._parts(grip)
        if parts is None or parts.amplitude >= parts.N:
            return names, guards
        row = np.zeros((1, guards.weights.shape[1]))
        row[0, V_T] = SIDE[grip]
        reach = 3 * self._reach(grip, parts.amplitude)
        return [*names, "steady"], Guards(np.concatenate([guards.weights, row]), np.append(guards.constants, reach))

    def _reach(self, grip: Grip, amplitude: float) -> float:
        """How far v_t goes in a swing, m/s."""
        swing = self._swing(grip)
        return abs(float(self.exact.contact.c_t @ swing.pull)) * amplitude / swing.omega

    def _parts(self, grip: Grip) -> Parts | None:
        """The state of an exact phase as its mean and its swing; None in a jam, which does not swing."""
        swing = self._swing(grip)
        if swing.give <= 0:
            return None
        z = self.exact.contact.z
        w = float(self.exact.contact.c_n @ z) / swing.give
        mean = z - w * swing.pull
        rows = self.exact.flow(grip, "rigid").rows
        N, T = float(rows[F_N] @ mean), float(rows[F_T] @ mean)
        beyond = self.exact.root_stiffness("unload") * self._spring - N
        return Parts(mean, N, T, math.hypot(beyond, swing.omega * w), math.atan2(swing.omega * w, beyond))

    def _borne(self, parts: Parts) -> float:
        """The amplitude that stick bears, N."""
        if np.isinf(self._friction):
            return math.inf
        margins = {SIDE[way]: self._friction * parts.N - SIDE[way] * parts.T for way in SLIPS.values()}
        if min(margins.values()) < 0:
            return 0.0
        return min(margin / share if (share := self._share(side)) else math.inf for side, margin in margins.items())

    def _settle(self, event: str, grip: Grip) -> Step:
        """An averaged phase, if the exact, unloading one can be averaged from here on; otherwise the exact one."""
        parts = self._parts(grip)
        exact = Step(event, grip, "unload")
        if parts is None or parts.amplitude >= parts.N:
            return exact
        amplitude = parts.amplitude
        press: Press = "ringing"
        if grip != "stick":
            if -SIDE[grip] * float(self.exact.contact.c_t @ parts.mean) <= self._reach(grip, amplitude):
                return exact
        elif amplitude > (borne := self._borne(parts)):
            self.unsettled += 1
            if self.unsettled <= UNSETTLED:
                return exact
            if self._grows(parts):
                self.unsettled, self.kept, press = UNSETTLED - LOOK, amplitude, "swinging"
            else:
                amplitude = borne
        contact, mean = self.exact.contact, parts.mean
        force = mean[contact.slots["spring"]]
        self.dropped += (float(contact.z @ contact.z) - float(mean @ mean) + force**2) / 2
        contact.z, self.angle = mean, parts.angle
        if press == "ringing":
            self.unsettled, amplitude = 0, min(amplitude, max(contact.peak - parts.N, 0.0))
        self._set(amplitude)
        return Step(event, grip, press)

    def _grows(self, parts: Parts) -> bool:
        """Whether slipping for a part of each swing makes it swing more, on the side where it slips."""
        return self._pumps(1.0 if parts.T > 0 else -1.0)

    def _pumps(self, side: float) -> bool:
        """Whether slipping to one side makes the contact swing more: at the least F_n, against the lever."""
        return -self._friction < side * self.lever < 0

    def _set(self, amplitude: float) -> None:
        self.exact.contact.put(spring=amplitude / self.exact.root_stiffness("load"))

    def _swung(self, event: str, grip: Grip) -> Step:
        """Return to the exact phase: put the swing into the state."""
        contact = self.exact.contact
        swing, amplitude = self._swing(grip), self.exact.root_stiffness("load") * self._spring
        contact.put(spring=0.0)
        mean = contact.z
        N = float(self.exact.flow(grip, "rigid").rows[F_N] @ mean)
        contact.z = mean + swing.pull * (amplitude / swing.omega * math.sin(self.angle))
        contact.put(spring=(N + amplitude * math.cos(self.angle)) / self.exact.root_stiffness("unload"))
        self.dropped -= (float(contact.z @ contact.z) - float(mean @ mean)) / 2
        return Step(event, grip, "unload")

    def end(self, grip: Grip, press: Press, start: float) -> None:
        """Amplitude and angle of the swing at the end of an averaged phase that began at ``start`` s."""
        contact = self.exact.contact
        rows = self.exact.flow(grip, press).rows
        if press == "swinging":
            self._set(min(self.kept, max(contact.peak - float(rows[F_N] @ contact.z), 0.0)))
            return
        if press == "ringing":
            self.angle = math.fmod(self.angle + self._swing(grip).omega * (contact.time - start), math.tau)
            return
        if press == "capped":
            self.angle = 0.0
        else:
            self.angle = math.pi if self._friction + SIDE[SLIPS[press]] * self.lever > 0 else 0.0
        known = contact.peak if press == "capped" else 0.0
        self._set(BELOW * max(known + float(rows[-2] @ contact.z), 0.0))

    def next(self, event: str, grip: Grip, press: Press) -> Step | None:
        """The phase that follows, averaged if it can be."""
        if press in AVERAGED:
            return self._next_averaged(event, grip, press)
        if event == "steady":
            return self._settle(event, grip)
        step = next_phase(self.exact, event, grip, press)
        if step and event == "compressed":
            step = self._settle(*step[:2])
        return self._settle(*step[:2]) if step and step[1:] == ("stick", "unload") else step

    def _next_averaged(self, event: str, grip: Grip, press: Press) -> Step | None:
        contact = self.exact.contact
        if event == "apart":
            return None
        if event == "gripped" or press == "swinging":
            return self._swung(event, grip)
        if event == "reloaded":
            self._set(contact.peak)
            self.dropped -= (contact.laws.restitution * contact.peak) ** 2 / (2 * contact.laws.stiffness)
            return Step(event, grip, "load")
        if event == "relieved":
            return Step(event, grip, "ringing")
        if event == "capped":
            return Step(event, grip, "capped")
        if event in SLIPS and self._pumps(SIDE[SLIPS[event]]):
            grown = GROWN * self.exact.root_stiffness("load") * self._spring
            self._set(min(grown, max(contact.peak - float(self.exact.force("stick", "ringing")[1]), 0.0)))
            self.angle, self.unsettled = math.pi, 0
            return self._swung(event, grip)
        if event in SLIPS and self._share(SIDE[SLIPS[event]]):
            return Step(event, grip, RUBBED[event])
        side = SLIPS[press if event == "used up" else event]
        if not pressed_together(self.exact, side):  # see `next_phase`
            return None
        return Step(event, side, "ringing")
