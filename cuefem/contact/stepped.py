"""The nonlinear contact, stepped in time by scipy; its equations stand in `cuefem.contact.nonlinear`."""

from __future__ import annotations

import ctypes
import math
from collections.abc import Callable, Sequence
from functools import partial
from typing import Any, Literal, NamedTuple, Self

import numpy as np
from scipy.integrate import solve_ivp

from cuefem.beam.tip import TipModes
from cuefem.contact.history import SteppedHistory
from cuefem.contact.kernel import library
from cuefem.contact.kernel.stepped import Numbers, Steps, steps_of
from cuefem.contact.patch import Patch, RigidPatch, SpringPatch, losses_of
from cuefem.contact.phases import ROUNDING, Step, Stretch, endless, next_phase, pressed_together
from cuefem.contact.ringing_tip import RINGING
from cuefem.contact.state import APART, SIDE, Contact, Grip, Laws, Press
from cuefem.contact.stretches import Solution, Stepping, free_course
from cuefem.cue import Array
from cuefem.effects.law import NormalLaw, TipLaw
from cuefem.effects.terms import ContactTerms

OnTable = Literal["none", "slides", "held", "lifted"]
# What ends a phase: a function of the state, of the order of 1, that falls through zero there; and all by name.
End = Callable[[Array], float]
Ends = dict[str, End]
# A phase that starts past an end by this part of its size is over at once.
PAST = 1e-10
# Tolerances of a step, relative and beside the size that a state has in a strike; the longest step in contact times,
# since an event that comes and goes within a step is not seen.
RELATIVE, ABSOLUTE, LONGEST_STEP = 1e-11, 1e-13, 0.01
# A nearly dead tip may ring too fast to be stepped through: it is given up after so many rates of change.
MOST_RATES = 8_000


class Hold(NamedTuple):
    """How the contact holds in a phase: its grip and press, the compression at the last peak, m, and the ball's table.

    table: how the table holds the ball of a raised cue.
    """

    grip: Grip
    press: Press
    deepest: float
    table: OnTable = "none"


class Directions(NamedTuple):
    """Rows that read v_t, v_n and (V_D - V_C) . t where the contact has turned to."""

    c_t: Array
    c_n: Array
    passing: Array


class Turning(NamedTuple):
    """What a turning contact turns on: the ball's radius and the tip's dome and levers."""

    ball_radius: float
    terms: ContactTerms

    @property
    def reach(self) -> float:
        """Distance of the two centres, m."""
        return self.ball_radius + self.terms.dome_radius


class Way(NamedTuple):
    """The way through a phase: what ended it, when, s, in which state, and the solver's interpolant."""

    event: str
    end: float
    z: Array
    solution: Solution


SLOTS = ("spin", "depth", "angle", "rubbed", "damped", "gone")


class Stepped:
    """A kind of contact: stepped in time, with any law of the tip and a turning normal; see `cuefem.contact.nonlinear`.

    Slots: "spin", the ball's turning; "depth", the tip's compression, m; "angle" that the contact has turned through;
    and, of each phase, the energy "rubbed" off by friction, "damped" in the cue and "gone" into its radiation, J.
    clock: about the contact's time, s. deepest: the compression at the last peak, m. rates: how many rates of change
    were asked for.
    """

    haste = 1.0
    steps: Steps | None
    lost_in: tuple[str, ...] = ("rubbed", "damped", "gone")

    def __init__(
        self, contact: Contact, patch: Patch, *, law: NormalLaw, clock: float, turning: Turning | None = None
    ) -> None:
        self.contact, self.patch, self.law, self.clock, self.turning = contact, patch, law, clock, turning
        self.deepest, self.rates = 0.0, 0
        self.longest = contact.patience * (clock / contact.laws.time)
        self.steppings: list[Stepping] = []
        energy, slots = float(contact.z @ contact.z), contact.slots
        self.sizes = np.full(len(contact.z), math.sqrt(energy))  # what every state grows to
        self.sizes[slots["depth"]], self.sizes[slots["angle"]] = contact.laws.speed * clock, 1.0
        self.losses = slots.of(*self.lost_in)
        self.sizes[self.losses] = energy
        if "shear" in slots:
            self.sizes[slots["shear"]] = contact.scale
        self.compile()

    def compile(self) -> None:
        """Let compiled code take the steps, where it can."""
        found, law = library(), self.law
        if found is None or not isinstance(law, TipLaw) or law.restitution <= RINGING:
            self.steps = None
        else:
            self.steps = self.compiled(found, law, Numbers(ROUNDING, RELATIVE, ABSOLUTE * self.sizes, LONGEST_STEP))
        self.kernel = "python" if self.steps is None else "c"

    def compiled(self, found: ctypes.CDLL, law: TipLaw, numbers: Numbers) -> Steps | None:
        """The compiled steps of a power law: on domes alone."""
        turning = self.turning
        levers = turning is not None and (turning.terms.levers or turning.terms.tip is not None)
        return None if type(self) is not Stepped or levers else steps_of(found, self, law, numbers)

    @classmethod
    def of(
        cls, tip: TipModes, laws: Laws, *, law: NormalLaw, clock: float, turning: Turning | None, compliance: float
    ) -> Self:
        """The contact of these tip modes, with a spring of ``compliance``, m/N, at the patch."""
        if compliance:
            contact = Contact(tip, laws, (*SLOTS, "shear"))
            return cls(contact, SpringPatch(compliance, 1.0), law=law, clock=clock, turning=turning)
        return cls(Contact(tip, laws, SLOTS), RigidPatch(), law=law, clock=clock, turning=turning)

    def directions(self, z: Array) -> Directions:
        """The rows where the contact has turned to."""
        contact, slots, tip = self.contact, self.contact.slots, self.contact.tip
        if self.turning is None:
            return Directions(contact.c_t, contact.c_n, np.zeros(0))
        turned, dome = float(z[slots["angle"]]), self.turning.terms
        phi = contact.laws.phi + turned
        s, c = math.sin(phi), math.cos(phi)
        lever = np.subtract(dome.lever(phi), dome.lever(contact.laws.phi))
        u, w = (tip.amplitude + np.outer(tip.rotation, lever)).T
        c_t, c_n, ball = contact.c_t.copy(), contact.c_n.copy(), slots.of("ball_t", "ball_n")
        c_t[slots.velocities], c_n[slots.velocities] = -(s * u + c * w), s * w - c * u
        root = contact.laws.ball_mass**-0.5
        c_t[ball] = root * math.cos(turned), root * math.sin(turned)
        c_n[ball] = -root * math.sin(turned), root * math.cos(turned)
        passing = -c_t
        passing[slots["spin"]] = 0.0
        passing[slots.velocities] += dome.dome_radius * tip.rotation
        return Directions(c_t, c_n, passing)

    def _forces(self, z: Array, hold: Hold, at: Directions, free: Array) -> tuple[float, float]:
        if hold.grip == "stick":
            return self.patch.held_forces(self, z, hold, at, free)
        side = SIDE[hold.grip] * self.contact.laws.friction
        if hold.press == "rigid":
            _, free_n = self.falling(z, at, free)
            F_n = -free_n / (float(at.c_n @ at.c_n) + side * float(at.c_t @ at.c_n))
        else:
            F_n = self.pressing(z, hold)
        return side * F_n, F_n

    def falling(self, z: Array, at: Directions, free: Array) -> tuple[float, float]:
        """Rates of v_t and v_n without forces at the contact, m/s2; free: the rate of the state then."""
        free_t, free_n = float(at.c_t @ free), float(at.c_n @ free)
        if self.turning is None:
            return free_t, free_n
        rate = float(at.passing @ z) / self.turning.reach
        return free_t + rate * float(at.c_n @ z), free_n + rate**2 * self.turning.reach

    def pressing(self, z: Array, hold: Hold) -> float:
        """The tip's force at the compression of a state, N."""
        depth = float(z[self.contact.slots["depth"]])
        return self.law.load(depth) if hold.press == "load" else self.law.unload(depth, hold.deepest)

    def stiffness(self, z: Array, hold: Hold) -> float:
        """The tip's stiffness at the compression of a state, N/m."""
        depth = float(z[self.contact.slots["depth"]])
        return self.law.slope(depth, None if hold.press == "load" else hold.deepest)

    def reading(self, z: Array, hold: Hold | None) -> tuple[float, float, float, float]:
        """(v_t, v_n, F_t, F_n) of a state; hold: None where ball and tip are apart."""
        at = self.directions(z)
        v_t, v_n = float(at.c_t @ z), float(at.c_n @ z)
        if hold is None:
            return v_t, v_n, 0.0, 0.0
        return v_t, v_n, *self._forces(z, hold, at, self.contact.free @ z)

    def hold(self, grip: Grip, press: Press) -> Hold:
        """The hold of a phase that starts now."""
        return Hold(grip, press, self.deepest)

    def force(self, grip: Grip, press: Press) -> Array:
        """(F_t, F_n) now, N, if the contact gripped and pressed in this way."""
        return np.array(self.reading(self.contact.z, self.hold(grip, press))[2:])

    def change(self, z: Array, hold: Hold | None) -> Array:
        """Rate of change of the state, 1/s; hold: None where ball and tip are apart."""
        at, rate, slots = self.directions(z), self.contact.free @ z, self.contact.slots
        if hold is not None:
            F_t, F_n = self._forces(z, hold, at, rate)
            rate = rate + at.c_t * F_t + at.c_n * F_n
            rate[slots["rubbed"]] = -F_t * (at.c_t @ z)
            if hold.grip == "stick":
                self.patch.wind(self, rate, z, at.c_t)
        rate[slots["depth"]] = -(at.c_n @ z)
        if self.turning is not None:
            rate[slots["angle"]] = (at.passing @ z) / self.turning.reach
        self._damped(rate, z)
        return rate

    def _damped(self, rate: Array, z: Array) -> None:
        contact = self.contact
        if len(contact.dampers):
            powers = (contact.dampers @ z) ** 2
            rate[contact.slots["damped"]] = powers[: contact.lossy].sum()
            rate[contact.slots["gone"]] = powers[contact.lossy :].sum()

    def first_grip(self, press: Press) -> Grip:
        """The patch's."""
        return self.patch.first_grip(self, press, self.stiffness(self.contact.z, self.hold("stick", press)))

    def grip_at_rest(self, press: Press) -> Grip:
        """The patch's."""
        return self.patch.grip_at_rest(self, press)

    def at_once(self, grip: Grip, press: Press, most: float) -> bool:
        """Phases are stepped one by one."""
        return False

    def follow(self, grip: Grip, press: Press) -> str:
        """Step through one phase, unless it is over at once."""
        contact, hold = self.contact, self.hold(grip, press)
        ends = self._ends(hold)
        over = self._at_once(ends)
        if over is not None:
            contact.end_phase(grip, press, contact.time, contact.impulse)
            return over
        way = self._way(hold, ends, until=self.longest)
        if way is None:
            raise endless(self, grip, press)
        self._take(hold, way)
        return way.event

    def _at_once(self, ends: Ends) -> str | None:
        """An end of which the state is past already."""
        return next((name for name, end in ends.items() if end(self.contact.z) < -PAST), None)

    def next(self, event: str, grip: Grip, press: Press) -> Step | None:
        """What follows."""
        return next_phase(self, event, grip, press)

    def fly(self, until: float, near: float) -> bool:
        """Step through the flight; they touch where they would overlap by ``near``, m."""
        contact, depth = self.contact, self.contact.slots["depth"]
        self.patch.let_go(contact)
        rest, size = self.law.rest(self.deepest), contact.laws.speed * self.clock
        touch: Ends = {"touch": lambda z: (rest - float(z[depth]) + near) / size}
        way = self._way(None, touch, until=until, near=near)
        if way is None:
            return False
        self._take(None, way)
        return True

    def _ends(self, hold: Hold) -> Ends:
        """What ends a phase, by name: functions of the state, of the order of 1, that fall through zero there."""
        contact, deepest, at = self.contact, hold.deepest, self.contact.slots["depth"]
        mu, speed, force, peak = contact.laws.friction, contact.laws.speed, contact.scale, contact.peak
        depth = speed * self.clock

        def read(i: int, scale: float) -> End:
            return lambda z: self.reading(z, hold)[i] / scale

        def within(side: float) -> End:
            def margin(z: Array) -> float:
                _, _, F_t, F_n = self.reading(z, hold)
                return (mu * F_n - side * F_t) / force + ROUNDING

            return margin

        ends: Ends = {}
        if hold.press == "load":
            ends["compressed"] = read(1, -speed)
        elif hold.press == "rigid":
            ends |= {"apart": read(3, force), "reloaded": lambda z: (peak - self.reading(z, hold)[3]) / force}
        else:
            ends["apart"] = lambda z: (float(z[at]) - self.law.rest(deepest)) / depth
            ends["reloaded"] = lambda z: (deepest - float(z[at])) / depth
        if hold.grip != "stick":
            ends["gripped"] = lambda z: -SIDE[hold.grip] * self.patch.slides(self, z, hold) / speed
        elif math.isfinite(mu):
            ends |= {"slipped": within(1.0), "slipped back": within(-1.0)}
        return ends

    def _way(self, hold: Hold | None, ends: Ends, *, until: float, near: float = 0.0) -> Way | None:
        """The way to the first end that falls through zero; None if none does by ``until``, s.

        near: by which ball and tip overlap where they touch, m.
        """
        contact = self.contact
        contact.z = contact.z.copy()
        contact.z[self.losses] = 0.0
        if self.steps is not None:
            found = self.steps.way(hold, self.deepest, near, contact.time, until, contact.z)
            if found is not None:
                return None if found.event < 0 else Way(list(ends)[found.event], *found[1:])
            self.kernel = "python"  # what stopped the kernel is for scipy to say
        solved = self._solved(hold, (contact.time, until), list(ends.values()), contact.z)
        name = next((name for name, times in zip(ends, solved.t_events, strict=True) if len(times)), None)
        if name is None:
            return None
        # the interpolant that found the end is of a lower order than the steps: take the last one anew, up to the end
        last = self._solved(hold, tuple(solved.t[-2:] * self.clock), [], solved.y[:, -2])
        return Way(name, float(solved.t[-1]) * self.clock, last.y[:, -1], solved.sol)

    def _take(self, hold: Hold | None, way: Way) -> None:
        """Advance to the end of a phase: add its losses, remove the rounding along the direction that it held."""
        contact, slots = self.contact, self.contact.slots
        before, start, stored = contact.impulse, contact.time, self.patch.stored(contact)
        contact.time, contact.z = way.end, way.z
        contact.friction_loss += float(way.z[slots["rubbed"]])
        contact.damping_loss += float(way.z[slots["damped"]])
        contact.radiated += float(way.z[slots["gone"]])
        if hold is not None:
            self._settle(hold)
        contact.friction_loss -= self.patch.stored(contact) - stored  # of the work against F_t, what the spring took
        self.steppings.append(Stepping(start, way.end, self.clock, way.solution, partial(self.reading, hold=hold)))
        grip, press = APART if hold is None else hold[:2]
        contact.end_phase(grip, press, start, before)

    def _settle(self, hold: Hold) -> None:
        self.patch.ended(self, hold)

    def _solved(self, hold: Hold | None, span: tuple[float, ...], ends: Sequence[End], z: Array) -> Any:
        def rate(_: float, z: Array) -> Array:
            self.rates += 1
            if self.rates > MOST_RATES and 0 < self.law.restitution <= RINGING:
                raise self._ringing()
            return self.clock * self.change(z, hold)

        solved = solve_ivp(
            rate,
            np.array(span) / self.clock,
            z,
            method="DOP853",
            events=[_Event(end) for end in ends],
            dense_output=bool(ends),
            rtol=RELATIVE,
            atol=ABSOLUTE * self.sizes,
            max_step=LONGEST_STEP,
        )
        if solved.status < 0:
            raise RuntimeError(
                f"the contact could not be stepped on from {float(solved.t[-1]) * self.clock:.6g} s "
                f"({solved.message.rstrip('.').lower()}); keep fewer modes, or a restitution further from 0"
            )
        return solved

    def compressed(self, grip: Grip) -> None:
        """Note the greatest compression; RuntimeError for a nearly dead tip that would ring."""
        self.deepest = float(self.contact.z[self.contact.slots["depth"]])
        if 0 < self.law.restitution <= RINGING and self._presses_on(grip):
            raise self._ringing()

    def _presses_on(self, grip: Grip) -> bool:
        """Whether a nearly dead tip is pressed on past its peak, and rings (`cuefem.contact.ringing_tip`)."""
        peak = float(self.force(grip, "load")[1])
        return pressed_together(self, grip) and float(self.force(grip, "rigid")[1]) > peak / 2

    def _ringing(self) -> RuntimeError:
        contact = self.contact
        return RuntimeError(
            f"a tip of restitution {self.law.restitution:g} rings too fast to be stepped through with PowerLawTip, "
            f"RollingContact or Elevation (given up after {contact.time:.6g} s and {len(contact.phases)} phases); "
            f"give it a Tip.restitution above {RINGING:g}"
        )

    def press_anew(self, old: Press, new: Press) -> None:
        """The compression is the state: nothing to keep."""

    def facing(self) -> tuple[Array, Array]:
        """(c_t, c_n) where the contact has turned to."""
        at = self.directions(self.contact.z)
        return at.c_t, at.c_n

    def tip_loss(self) -> float:
        """Energy that the tip did not give back, J."""
        return self.law.loss(self.deepest)

    def other_losses(self) -> dict[str, float]:
        """What the cue damped, and what the patch lost."""
        return losses_of(self.contact, self.patch)

    def stretches(self) -> list[Stretch]:
        """The phases so far, and the free motion from now on."""
        return [*self.steppings, free_course(self.contact)]

    def history(self, mirror: float) -> SteppedHistory:
        """Forces and velocities so far; mirror: -1 for a stroke on the other side."""
        return SteppedHistory(tuple(self.steppings), mirror)


class _Event:
    """An end in the form that scipy takes: it stops the stepping where it falls through zero."""

    terminal, direction = True, -1

    def __init__(self, end: End) -> None:
        self.end = end

    def __call__(self, _: float, z: Array) -> float:
        return self.end(z)
