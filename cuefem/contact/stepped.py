"""The nonlinear contact, stepped in time by scipy; its equations stand in `cuefem.contact.nonlinear`."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from functools import partial
from typing import Any, ClassVar, NamedTuple

import numpy as np
from scipy.integrate import solve_ivp

from cuefem.contact.history import SteppedHistory, Stretch
from cuefem.contact.linear import APART, ROUNDING, SIDE, Contact, Grip, Phase, Press
from cuefem.contact.ringing_tip import RINGING
from cuefem.cue import Array
from cuefem.effects.law import NormalLaw, TipLaw
from cuefem.effects.terms import ContactTerms

# A phase that starts past an end by this part of its size is over at once.
PAST = 1e-10
# Tolerances of a step, relative and beside the size that a state has in a strike; the longest step in contact times,
# since an event that comes and goes within a step is not seen.
RELATIVE, ABSOLUTE, LONGEST_STEP = 1e-11, 1e-13, 0.01
# A nearly dead tip may ring too fast to be stepped through: it is given up after so many rates of change.
MOST_RATES = 8_000


class Hold(NamedTuple):
    """How the contact holds in a phase: its grip and press, and the compression at the last peak, m."""

    grip: Grip
    press: Press
    deepest: float


class Turning(NamedTuple):
    """What a turning contact turns on: the ball's radius and the tip's dome."""

    ball_radius: float
    terms: ContactTerms

    @property
    def reach(self) -> float:
        """Distance of the two centres, m."""
        return self.ball_radius + self.terms.dome_radius


@dataclass
class SteppedContact(Contact):
    """A contact with a nonlinear tip law, a turning normal, or both; see `cuefem.contact.nonlinear`.

    clock: about the contact's time, s. deepest: the compression at the last peak, m. rates: how many
    rates of change were asked for.
    """

    law: NormalLaw = field(default_factory=lambda: TipLaw(1.0, 1.0, 1.0))
    turning: Turning | None = None
    clock: float = 1.0
    deepest: float = 0.0
    rates: int = 0

    extra_states: ClassVar[int] = 5

    def __post_init__(self) -> None:
        super().__post_init__()
        mass, nu = self.laws.ball_mass, self.laws.inertia
        self.spin = self.spring  # the ball's turning stands where the tip's force does in the base model
        self.depth, self.angle, *losses = range(self.spin + 1, self.spin + 6)
        self.rubbed, self.damped, self.gone = self.losses = losses
        self.c_t[self.ball_t], self.c_t[self.spin] = mass**-0.5, (nu * mass) ** -0.5
        self.longest *= self.clock / self.laws.time
        self.stretches: list[Stretch] = []
        energy = float(self.z @ self.z)
        self.sizes = np.full(len(self.z), math.sqrt(energy))  # what every state grows to
        self.sizes[self.depth], self.sizes[self.angle], self.sizes[losses] = self.laws.speed * self.clock, 1.0, energy

    def directions(self, z: Array) -> tuple[Array, Array, Array]:
        """(c_t, c_n, c_n') where the contact has turned to: the rows that read v_t, v_n and (V_D - V_C) . t."""
        if self.turning is None:
            return self.c_t, self.c_n, np.zeros(0)
        turned, dome = float(z[self.angle]), self.turning.terms
        phi = self.laws.phi + turned
        s, c = math.sin(phi), math.cos(phi)
        lever = np.subtract(dome.lever(phi), dome.lever(self.laws.phi))
        u, w = (self.tip.amplitude + np.outer(self.tip.rotation, lever)).T
        c_t, c_n, ball = self.c_t.copy(), self.c_n.copy(), [self.ball_t, self.ball_n]
        c_t[self.velocities], c_n[self.velocities] = -(s * u + c * w), s * w - c * u
        root = self.laws.ball_mass**-0.5
        c_t[ball] = root * math.cos(turned), root * math.sin(turned)
        c_n[ball] = -root * math.sin(turned), root * math.cos(turned)
        passing = -c_t
        passing[self.spin] = 0.0
        passing[self.velocities] += dome.dome_radius * self.tip.rotation
        return c_t, c_n, passing

    def _forces(
        self, z: Array, hold: Hold, *, directions: tuple[Array, Array, Array], free: Array
    ) -> tuple[float, float]:
        c_t, c_n, _ = directions
        free_t, free_n = self._falling(z, directions=directions, free=free)
        tt, tn, nn = float(c_t @ c_t), float(c_t @ c_n), float(c_n @ c_n)
        if hold.press == "rigid" and hold.grip == "stick":
            whole = tt * nn - tn**2
            return (tn * free_n - nn * free_t) / whole, (tn * free_t - tt * free_n) / whole
        side = 0.0 if hold.grip == "stick" else SIDE[hold.grip] * self.laws.friction
        F_n = -free_n / (nn + side * tn) if hold.press == "rigid" else self._pressing(float(z[self.depth]), hold)
        return (-(free_t + tn * F_n) / tt if hold.grip == "stick" else side * F_n), F_n

    def _falling(self, z: Array, *, directions: tuple[Array, Array, Array], free: Array) -> tuple[float, float]:
        """Rates of v_t and v_n without forces at the contact, m/s2."""
        c_t, c_n, passing = directions
        free_t, free_n = float(c_t @ free), float(c_n @ free)
        if self.turning is None:
            return free_t, free_n
        rate = float(passing @ z) / self.turning.reach
        return free_t + rate * float(c_n @ z), free_n + rate**2 * self.turning.reach

    def _pressing(self, compression: float, hold: Hold) -> float:
        if hold.press == "load":
            return self.law.load(compression)
        return self.law.unload(compression, hold.deepest)

    def reading(self, z: Array, hold: Hold | None) -> tuple[float, float, float, float]:
        """(v_t, v_n, F_t, F_n) of a state; hold: None where ball and tip are apart."""
        directions = self.directions(z)
        v_t, v_n = float(directions[0] @ z), float(directions[1] @ z)
        if hold is None:
            return v_t, v_n, 0.0, 0.0
        return v_t, v_n, *self._forces(z, hold, directions=directions, free=self.free @ z)

    def sliding(self, z: Array, hold: Hold) -> float:
        """Velocity at which tip and ball slip, m/s."""
        return float(self.directions(z)[0] @ z)

    def force(self, grip: Grip, press: Press) -> Array:
        """(F_t, F_n) now, N, if the contact gripped and pressed in this way."""
        return np.array(self.reading(self.z, Hold(grip, press, self.deepest))[2:])

    def change(self, z: Array, hold: Hold | None) -> Array:
        """Rate of change of the state, 1/s; hold: None where ball and tip are apart."""
        directions, rate = self.directions(z), self.free @ z
        c_t, c_n, passing = directions
        if hold is not None:
            F_t, F_n = self._forces(z, hold, directions=directions, free=rate)
            rate = rate + c_t * F_t + c_n * F_n
            rate[self.rubbed] = -F_t * (c_t @ z)
        rate[self.depth] = -(c_n @ z)
        if self.turning is not None:
            rate[self.angle] = (passing @ z) / self.turning.reach
        if len(self.dampers):
            powers = (self.dampers @ z) ** 2
            rate[self.damped], rate[self.gone] = powers[: self.lossy].sum(), powers[self.lossy :].sum()
        return rate

    def go(self, grip: Grip, press: Press) -> tuple[str, Grip, Press] | None:
        """Follow one phase to its end; what ended it, and what comes next (None: the ball has left)."""
        hold = Hold(grip, press, self.deepest)
        ends = self._ends(hold)
        over = next((name for name, end in ends.items() if end(self.z) < -PAST), None)
        if over is not None:
            self.phases.append(Phase(grip, press, self.time, self.time, (0.0, 0.0)))
            return self._next(over, grip, press)
        event, *way = self._way(hold, ends, until=self.longest)
        if event is None:
            raise self.endless(grip, press)
        self._follow(hold, *way)
        return self._next(event, grip, press)

    def fly(self, until: float, near: float) -> bool:
        """Let ball and tip fly, to their next touch or not at all: whether they touch by ``until``, s.

        They touch where they would overlap by ``near``, m.
        """
        rest, depth = self.law.rest(self.deepest), self.laws.speed * self.clock
        ends = {"touch": lambda z: (rest - float(z[self.depth]) + near) / depth}
        event, *way = self._way(None, ends, until=until)
        if event is None:
            return False
        self._follow(None, *way)
        return True

    def _ends(self, hold: Hold) -> dict[str, Callable[[Array], float]]:
        """What ends a phase, by name: functions of the state, of the order of 1, that fall through zero there."""
        mu, deepest, slack = self.laws.friction, hold.deepest, ROUNDING
        speed, force, depth = self.laws.speed, self.scale, self.laws.speed * self.clock

        def read(i: int, scale: float) -> Callable[[Array], float]:
            return lambda z: self.reading(z, hold)[i] / scale

        def within(side: float) -> Callable[[Array], float]:
            def margin(z: Array) -> float:
                _, _, F_t, F_n = self.reading(z, hold)
                return (mu * F_n - side * F_t) / force + slack

            return margin

        ends: dict[str, Callable[[Array], float]] = {}
        if hold.press == "load":
            ends["compressed"] = read(1, -speed)
        elif hold.press == "rigid":
            ends |= {"apart": read(3, force), "reloaded": lambda z: (self.peak - self.reading(z, hold)[3]) / force}
        else:
            ends["apart"] = lambda z: (float(z[self.depth]) - self.law.rest(deepest)) / depth
            ends["reloaded"] = lambda z: (deepest - float(z[self.depth])) / depth
        if hold.grip != "stick":
            ends["gripped"] = lambda z: -SIDE[hold.grip] * self.sliding(z, hold) / speed
        elif math.isfinite(mu):
            ends |= {"slipped": within(1.0), "slipped back": within(-1.0)}
        return ends

    def _way(
        self, hold: Hold | None, ends: dict[str, Callable[[Array], float]], *, until: float
    ) -> tuple[str | None, float, Array, Any]:
        """The first end that falls through zero (None by ``until``, s), its time and state, and the solution to it."""
        self.z = self.z.copy()
        self.z[self.losses] = 0.0
        solved = self._solved(hold, (self.time, until), list(ends.values()), self.z)
        name = next((name for name, times in zip(ends, solved.t_events, strict=True) if len(times)), None)
        # the interpolant that found the end is of a lower order than the steps: take the last one anew, up to the end
        last = self._solved(hold, tuple(solved.t[-2:] * self.clock), [], solved.y[:, -2])
        return name, float(solved.t[-1]) * self.clock, last.y[:, -1], solved.sol

    def _follow(self, hold: Hold | None, end: float, z: Array, solution: Any) -> None:
        """Go a way: book what it lost, take the rounding out of the direction that it held."""
        before, start = self.impulse, self.time
        self.time, self.z = end, z
        self.friction_loss += float(z[self.rubbed])
        self.damping_loss += float(z[self.damped])
        self.radiated += float(z[self.gone])
        self._settle(hold)
        self.stretches.append(Stretch(start, end, self.clock, solution, partial(self.reading, hold=hold)))
        after = self.impulse
        grip, press = APART if hold is None else hold[:2]
        self.phases.append(Phase(grip, press, start, end, (after[0] - before[0], after[1] - before[1])))

    def _settle(self, hold: Hold | None) -> None:
        """Take the rounding out of the direction that a phase held."""
        if hold is not None and hold.grip == "stick":
            c_t, _ = self.facing()
            self.z = self.z - c_t * (c_t @ self.z / (c_t @ c_t))

    def _solved(
        self, hold: Hold | None, span: tuple[float, ...], ends: Sequence[Callable[[Array], float]], z: Array
    ) -> Any:
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
            events=[_event(end) for end in ends],
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

    def _unload(self, grip: Grip) -> tuple[str, Grip, Press] | None:
        self.deepest = float(self.z[self.depth])
        if 0 < self.law.restitution <= RINGING and self._presses_on(grip):
            raise self._ringing()
        return super()._unload(grip)

    def _presses_on(self, grip: Grip) -> bool:
        """Whether a nearly dead tip is pressed on past its peak, and rings (`cuefem.contact.ringing_tip`)."""
        peak = float(self.force(grip, "load")[1])
        return self._pressed_together(grip) and float(self.force(grip, "rigid")[1]) > peak / 2

    def _ringing(self) -> RuntimeError:
        return RuntimeError(
            f"a tip of restitution {self.law.restitution:g} rings too fast to be stepped through with PowerLawTip, "
            f"RollingContact or Elevation (given up after {self.time:.6g} s and {len(self.phases)} phases); "
            f"give it a Tip.restitution above {RINGING:g}"
        )

    def _press(self, old: Press, new: Press) -> None:
        """The compression is the state: nothing to keep."""

    def facing(self) -> tuple[Array, Array]:
        """(c_t, c_n) where the contact has turned to."""
        return self.directions(self.z)[:2]

    @property
    def twist(self) -> float:
        """The impulse on the ball that turned it, N s: of the tangential force, wherever its direction was."""
        return float(self.z[self.spin]) * math.sqrt(self.laws.inertia * self.laws.ball_mass)

    @property
    def tip_loss(self) -> float:
        """Energy that the tip did not give back, J."""
        return self.law.loss(self.deepest)

    def history(self, mirror: float) -> SteppedHistory:  # type: ignore[override]
        """Forces and velocities so far; mirror: -1 for a stroke on the other side."""
        return SteppedHistory(tuple(self.stretches), mirror)


def _event(end: Callable[[Array], float]) -> Any:
    def event(_: float, z: Array) -> float:
        return end(z)

    event.terminal, event.direction = True, -1  # type: ignore[attr-defined]
    return event
