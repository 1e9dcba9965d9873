"""The contact of a nearly dead tip, which rings much faster than anything else moves (handbook: A nearly dead tip).

A tip of small restitution e unloads with the stiffness k/e^2. On that stiff spring ball and cue swing against each
other with the angular frequency w = sqrt(k B)/e, B the rate of v_n per unit of F_n. Past the peak the forces are

    F_n = N + a cos(wt),    F_t = T + (f or -h) a cos(wt),    f = mu side in slip, h = c_t.c_n/c_t.c_t in stick,

where N and T are the forces that hold v_n (in stick also v_t) at zero. The mean motion feels N and T alone, and the
ringing carries only e^2 of the tip's energy. Its amplitude a stays but for damping, and what limits it:

- F_n does not pass the old peak P: a <= P - N, for beyond it the tip is softer and takes the energy ("capped"; a = 0
  there is ordinary loading);
- stick holds in the whole of a swing only where mu (N -+ a) >= |T +- h a|. Where it does not, the contact slips for a
  part of each swing, by v_t of the size of e: the mean motion still sticks. While it slips v_n is off by h v_t, which
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
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from cuefem.beam.tip import TipModes
from cuefem.contact.flow import Flow, Guards
from cuefem.contact.history import F_N, F_T, V_T
from cuefem.contact.linear import ROUNDING, SIDE, Contact, Grip, Laws, Press
from cuefem.cue import Array

# A tip's ringing is averaged where its restitution is at most this and it rings so many times faster than the fastest
# mode. Against exact phases the impulse is then off by less than e (1e-4) in slip, and by less than 0.1 sqrt(e) (1e-3)
# where the contact sticks (tests/contact/test_ringing_tip_verification.py). Of 150 random cues of loud modes eight were
# followed in exact phases down to a restitution of 1e-4: there it was off by 6e-3 at worst.
RINGING, FASTER = 1e-4, 10.0
# Below this, restitution makes no difference but to rounding, which grows like 1/e.
LEAST = 1e-9
# After so many exact phases that did not settle, the ringing has come down to what friction bears.
UNSETTLED = 40
# While it swings beyond friction's bound: how far the mean motion leaps, in contact times; for how many exact phases
# the swing is followed then; by how much more it swings once it has met the bound, where that grows by itself.
LEAP, LOOK, GROWN = 1 / 256, 6, 1.1
# Of the amplitude where it leaves a bound: a little less than the bound, so that it does not meet it again by rounding.
BELOW = 1 - 1e-12
AVERAGED = ("ringing", "capped", "rubbed", "rubbed back", "swinging")
SLIPS: dict[str, Grip] = {"rubbed": "slip", "rubbed back": "slip back"}


class Swing(NamedTuple):
    """The fast swing in a grip: the direction it moves the state in, B, its frequency, rad/s, and its decay, 1/s."""

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


def ringing_contact(tip: TipModes, laws: Laws) -> Contact:
    """The contact of a tip of small restitution: averaged over its ringing where that is the fastest motion by far."""
    found = RingingContact(tip, replace(laws, restitution=max(laws.restitution, LEAST)))
    return found if found.rings else Contact(tip, laws)


@dataclass
class RingingContact(Contact):
    """A contact that is averaged over the tip's ringing past the peak; the spring's state is then its amplitude.

    dropped: energy that the averaging took out of the state, J. angle: of the swing as an averaged phase starts, rad.
    unsettled: exact phases since the last averaged one. kept: the amplitude during a leap, N.
    """

    dropped: float = 0.0
    angle: float = 0.0
    unsettled: int = 0
    kept: float = 0.0

    @property
    def rings(self) -> bool:
        """Whether the tip rings far faster than every mode."""
        return self._swing("stick").omega >= FASTER * self.fastest

    @property
    def lever(self) -> float:
        """The h of F_t = T - h (F_n - N) in stick."""
        return float(self.c_t @ self.c_n) / float(self.c_t @ self.c_t)

    @property
    def tip_loss(self) -> float:
        """Energy that the tip did not give back, that of its ringing included, J."""
        return super().tip_loss + self.dropped

    def _swing(self, grip: Grip) -> Swing:
        pull = self.c_n - self.lever * self.c_t if grip == "stick" else self._pull(grip)
        reader = pull if grip == "stick" else self.c_n
        give = float(self.c_n @ pull)
        if give <= 0:
            return Swing(pull, give, 0.0, 0.0)
        decay = -float(reader @ self.free @ pull) / (2 * give)
        return Swing(pull, give, self.root_stiffness("unload") * math.sqrt(give), decay)

    def flow(self, grip: Grip, press: Press) -> Flow:
        """The linear motion of one phase; of an averaged one with the amplitude and its relief as last outputs.

        Relief is the rate at which the bound on the amplitude rises above what damping leaves of it.
        """
        if press in AVERAGED and (grip, press) not in self.flows:
            self.flows[grip, press] = self._averaged(grip, press)
        return super().flow(grip, press)

    def _averaged(self, grip: Grip, press: Press) -> Flow:
        held, decay = super().flow(grip, "rigid"), self._swing(grip).decay
        if press == "swinging":
            decay = math.log(2) / (LEAP * self.laws.time)  # an hourglass
        unit = np.zeros(len(self.z))
        unit[self.spring] = 1.0
        A = held.A - decay * np.outer(unit, unit)
        normal, tangent = held.rows[F_N], held.rows[F_T]
        if press in ("ringing", "swinging"):
            amplitude = self.root_stiffness("load") * unit
        elif press == "capped":
            amplitude = -normal  # and the peak beside it
        else:
            side = SIDE[SLIPS[press]]
            amplitude = (self.laws.friction * normal - side * tangent) / self._share(side)
        rows = np.concatenate([held.rows, [amplitude, amplitude @ A + decay * amplitude]])
        drive = held.drive
        if drive is not None and decay:
            drive = drive._replace(
                rows=np.concatenate([drive.rows, [-decay * unit]]), pushes=np.concatenate([drive.pushes, [unit]])
            )
        return Flow(A, rows, max(held.rate, float(np.linalg.norm(A))), drive)

    def _share(self, side: float) -> float:
        """How much of friction's margin on one side a unit of the amplitude uses up."""
        return abs(self.laws.friction + side * self.lever)

    def _guards(self, grip: Grip, press: Press) -> tuple[list[str], Guards]:
        if press not in AVERAGED:
            names, guards = super()._guards(grip, press)
            return self._until_steady(names, guards, grip) if press == "unload" and grip != "stick" else (names, guards)
        swing, mu, slack = self._swing(grip), self.laws.friction, ROUNDING * self.scale
        size = len(self.flow(grip, press).rows)
        AMPLITUDE, RELIEF = size - 2, size - 1
        known = self.peak if press == "capped" else 0.0  # of the amplitude, beside its row
        if press == "swinging":
            weights = np.zeros((3, size))
            weights[0, AMPLITUDE] = 1.0
            weights[1:, F_N], weights[1:, F_T] = mu, (-1.0, 1.0)
            return ["leapt", "slipped", "slipped back"], Guards(weights, np.array([-self.kept / 2, slack, slack]))
        found: list[tuple[str, dict[int, float], float]] = [("apart", {F_N: 1.0, AMPLITUDE: -1.0}, -known)]
        if press == "capped":
            found.append(("reloaded", {AMPLITUDE: 1.0}, known))
        else:
            found.append(("capped", {F_N: -1.0, AMPLITUDE: -1.0}, self.peak))
        if press != "ringing":
            found.append(("relieved", {RELIEF: -1.0}, -swing.decay * known))
        if grip != "stick":
            reach = abs(float(self.c_t @ swing.pull)) / swing.omega  # of v_t in a swing, per unit of the amplitude
            found.append(("gripped", {V_T: -SIDE[grip], AMPLITUDE: -reach}, -reach * known))
        elif np.isfinite(mu):
            for name, way in SLIPS.items():
                if press == name:
                    found.append(("used up", {AMPLITUDE: 1.0}, slack))
                else:
                    share = self._share(SIDE[way])
                    found.append((name, {F_N: mu, F_T: -SIDE[way], AMPLITUDE: -share}, slack - share * known))
        weights = np.zeros((len(found), size))
        for row, (_, terms, _) in zip(weights, found, strict=True):
            row[list(terms)] = list(terms.values())
        return [name for name, _, _ in found], Guards(weights, np.array([constant for _, _, constant in found]))

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
        return abs(float(self.c_t @ swing.pull)) * amplitude / swing.omega

    def _parts(self, grip: Grip) -> Parts | None:
        """The state of an exact phase as its mean and its swing; None in a jam, which does not swing."""
        swing = self._swing(grip)
        if swing.give <= 0:
            return None
        w = float(self.c_n @ self.z) / swing.give
        mean = self.z - w * swing.pull
        rows = super().flow(grip, "rigid").rows
        N, T = float(rows[F_N] @ mean), float(rows[F_T] @ mean)
        beyond = self.root_stiffness("unload") * float(self.z[self.spring]) - N
        return Parts(mean, N, T, math.hypot(beyond, swing.omega * w), math.atan2(swing.omega * w, beyond))

    def _borne(self, parts: Parts) -> float:
        """The amplitude that stick bears, N."""
        if np.isinf(self.laws.friction):
            return math.inf
        margins = {SIDE[way]: self.laws.friction * parts.N - SIDE[way] * parts.T for way in SLIPS.values()}
        if min(margins.values()) < 0:
            return 0.0
        return min(margin / share if (share := self._share(side)) else math.inf for side, margin in margins.items())

    def _settle(self, event: str, grip: Grip) -> tuple[str, Grip, Press]:
        """An averaged phase where the exact one, unloading, can be averaged from here on; else that."""
        parts = self._parts(grip)
        exact: tuple[str, Grip, Press] = (event, grip, "unload")
        if parts is None or parts.amplitude >= parts.N:
            return exact
        amplitude = parts.amplitude
        press: Press = "ringing"
        if grip != "stick":
            if -SIDE[grip] * float(self.c_t @ parts.mean) <= self._reach(grip, amplitude):
                return exact
        elif amplitude > (borne := self._borne(parts)):
            self.unsettled += 1
            if self.unsettled <= UNSETTLED:
                return exact
            if self._grows(parts):
                self.unsettled, self.kept, press = UNSETTLED - LOOK, amplitude, "swinging"
            else:
                amplitude = borne
        self.dropped += (float(self.z @ self.z) - float(parts.mean @ parts.mean) + parts.mean[self.spring] ** 2) / 2
        self.z, self.angle = parts.mean, parts.angle
        if press == "ringing":
            self.unsettled, amplitude = 0, min(amplitude, max(self.peak - parts.N, 0.0))
        self._set(amplitude)
        return event, grip, press

    def _grows(self, parts: Parts) -> bool:
        """Whether slipping for a part of each swing makes it swing more, on the side where it slips."""
        return self._pumps(1.0 if parts.T > 0 else -1.0)

    def _pumps(self, side: float) -> bool:
        """Whether slipping to one side makes the contact swing more: at the least F_n, against the lever."""
        return -self.laws.friction < side * self.lever < 0

    def _set(self, amplitude: float) -> None:
        self.z = self.z.copy()
        self.z[self.spring] = amplitude / self.root_stiffness("load")

    def _swung(self, event: str, grip: Grip) -> tuple[str, Grip, Press]:
        """Back to the exact phase: put the swing into the state."""
        swing, amplitude = self._swing(grip), self.root_stiffness("load") * float(self.z[self.spring])
        mean = self.z.copy()
        mean[self.spring] = 0.0
        N = float(super().flow(grip, "rigid").rows[F_N] @ mean)
        self.z = mean + swing.pull * (amplitude / swing.omega * math.sin(self.angle))
        self.z[self.spring] = (N + amplitude * math.cos(self.angle)) / self.root_stiffness("unload")
        self.dropped -= (float(self.z @ self.z) - float(mean @ mean)) / 2
        return event, grip, "unload"

    def _leave(self, grip: Grip, press: Press) -> None:
        super()._leave(grip, press)
        if press not in AVERAGED:
            return
        if press == "swinging":
            self._set(min(self.kept, max(self.peak - float(self.flow(grip, press).rows[F_N] @ self.z), 0.0)))
            return
        if press == "ringing":
            self.angle = math.fmod(
                self.angle + self._swing(grip).omega * (self.time - self.courses[-1].start), math.tau
            )
            return
        if press == "capped":
            self.angle = 0.0
        else:
            self.angle = math.pi if self.laws.friction + SIDE[SLIPS[press]] * self.lever > 0 else 0.0
        known = self.peak if press == "capped" else 0.0
        self._set(BELOW * max(known + float(self.flow(grip, press).rows[-2] @ self.z), 0.0))

    def _next(self, event: str, grip: Grip, press: Press) -> tuple[str, Grip, Press] | None:
        if press in AVERAGED:
            return self._next_averaged(event, grip, press)
        if event == "steady":
            return self._settle(event, grip)
        step = super()._next(event, grip, press)
        return self._settle(*step[:2]) if step and step[1:] == ("stick", "unload") else step

    def _next_averaged(self, event: str, grip: Grip, press: Press) -> tuple[str, Grip, Press] | None:
        if event == "apart":
            return None
        if event == "gripped" or press == "swinging":
            return self._swung(event, grip)
        if event == "reloaded":
            self._set(self.peak)
            self.dropped -= (self.laws.restitution * self.peak) ** 2 / (2 * self.laws.stiffness)
            return event, grip, "load"
        if event == "relieved":
            return event, grip, "ringing"
        if event == "capped":
            return event, grip, "capped"
        if event in SLIPS and self._pumps(SIDE[SLIPS[event]]):
            grown = GROWN * self.root_stiffness("load") * float(self.z[self.spring])
            self._set(min(grown, max(self.peak - float(self.force("stick", "ringing")[1]), 0.0)))
            self.angle, self.unsettled = math.pi, 0
            return self._swung(event, grip)
        if event in SLIPS and self._share(SIDE[SLIPS[event]]):
            return event, grip, event  # type: ignore[return-value]
        side = SLIPS[press if event == "used up" else event]
        if not self._pressed_together(side):  # see `_slide`
            return None
        return event, side, "ringing"

    def _unload(self, grip: Grip) -> tuple[str, Grip, Press] | None:
        step = super()._unload(grip)
        return self._settle(*step[:2]) if step else None
