"""A stroke on a bare tip as linear phases, the study's own: followed exactly, by an ODE solver, or by Newmark's steps.

The state is omega q of the modes that swing, q' of all modes, sqrt(M) times the ball's velocity along the normal, the
root of M nu/(1 + nu) times that of its surface along the tangent, and the tip's force over the root of its stiffness,
so that half the state's square is energy: z' = A z within a phase. Forces act on z by the rows that read v_t and v_n
(handbook: The strike).
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
import scipy.linalg as la
from numpy.polynomial.polynomial import polyval
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

from cuefem import Scene
from cuefem.beam.tip import TipModes

ROUNDING = 1e-12
TERMS, LOOKS = 24, 8  # of a cell's series, and places in a cell where its ends are looked for
SIDES = {"slip": 1.0, "slip back": -1.0}


class Guards(NamedTuple):
    """What ends a phase: names, and the rows and constants of what is then no longer positive."""

    names: tuple[str, ...]
    rows: np.ndarray
    constants: np.ndarray


# From A, guards, state and the head-on contact time, s, to what ended the phase and the state then.
Follow = Callable[[np.ndarray, Guards, np.ndarray, float], tuple[str, np.ndarray]]


class End(NamedTuple):
    """A stroke when it is over: squirt, rad, ball speed over the cue's, phases, and how many unknowns it had."""

    squirt: float
    speed: float
    phases: tuple[str, ...]
    unknowns: int


@dataclass(frozen=True)
class Stroke:
    """The matrices of a stroke with e > 0 and finite friction."""

    scene: Scene
    tip: TipModes

    def __post_init__(self) -> None:
        ball, phi = self.scene.ball, math.asin(float(self.scene.stroke.offset))
        s, c = math.sin(phi), math.cos(phi)
        omega, modes = self.tip.omega[self.tip.omega > 0], len(self.tip.omega)
        swinging, size = len(omega), len(omega) + modes + 3
        v_t, v_n, spring, free = np.zeros(size), np.zeros(size), np.zeros(size), np.zeros((size, size))
        v_t[swinging:-3], v_n[swinging:-3] = -self.tip.amplitude @ [s, c], -self.tip.amplitude @ [c, -s]
        masses = ball.mass, ball.mass * ball.inertia / (1 + ball.inertia)
        v_n[-3], v_t[-2], spring[-1] = masses[0] ** -0.5, masses[1] ** -0.5, 1.0
        turning = np.arange(swinging) + modes  # the rigid modes come first
        free[np.arange(swinging), turning], free[turning, np.arange(swinging)] = omega, -omega
        for name, value in {
            "phi": phi,
            "v_t": v_t,
            "v_n": v_n,
            "spring": spring,
            "free": free,
            "masses": masses,
        }.items():
            object.__setattr__(self, name, value)

    def root(self, press: str) -> float:
        """The root of the tip's stiffness, which the force in the state is over."""
        return math.sqrt(self.scene.stiffness) / (self.scene.tip.restitution if press == "unload" else 1.0)

    def motion(self, grip: str, press: str) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """A, and the rows of F_n and F_t."""
        root, v_t, v_n = self.root(press), self.v_t, self.v_n
        F_n = root * self.spring
        A = self.free + np.outer(v_n, F_n) - np.outer(root * self.spring, v_n)
        if grip == "stick":  # forces along v_t keep it at zero
            across = np.eye(len(A)) - np.outer(v_t, v_t) / (v_t @ v_t)
            return across @ A @ across, F_n, -(v_t @ A) / (v_t @ v_t)
        F_t = SIDES[grip] * self.scene.tip.friction * F_n
        return A + np.outer(v_t, F_t), F_n, F_t

    def guards(self, grip: str, press: str, peak: float, slack: float) -> Guards:
        """What ends a phase."""
        _, F_n, F_t = self.motion(grip, press)
        found = {"compressed": (-self.v_n, 0.0)}
        if press == "unload":
            found = {"apart": (F_n, 0.0), "reloaded": (-F_n, peak)}
        if grip == "stick":
            most = self.scene.tip.friction * F_n
            found |= {"slip": (most - F_t, slack), "slip back": (most + F_t, slack)}
        else:
            found["gripped"] = (-SIDES[grip] * self.v_t, 0.0)
        return Guards(tuple(found), *map(np.array, zip(*found.values(), strict=True)))

    def run(self, follow: Follow) -> End:
        """The stroke, from touch to separation."""
        scene, tip = self.scene, self.tip
        z = np.zeros(len(self.free))
        z[len(z) - 3 - len(tip.omega) : -3] = float(scene.stroke.speed) * tip.approach
        slack = ROUNDING * self.root("load") * float(np.linalg.norm(z))
        grip, press, peak, phases, event = "slip", "load", 0.0, [], "touch"
        while event != "apart":
            phases.append(f"{grip} {press}")
            A, guards = self.motion(grip, press)[0], self.guards(grip, press, peak, slack)
            event, z = follow(A, guards, z, scene.contact_time)
            if grip == "stick":  # what stepping left along the direction that stick holds
                z = z - self.v_t * (self.v_t @ z) / (self.v_t @ self.v_t)
            if event in SIDES:
                grip = event
            elif event == "gripped":
                _, F_n, F_t = self.motion("stick", press)
                held = abs(F_t @ z) <= scene.tip.friction * (F_n @ z) + slack
                grip = "stick" if held else "slip" if F_t @ z > 0 else "slip back"
            elif event != "apart":
                old, press = press, "unload" if event == "compressed" else "load"
                peak = self.root(old) * z[-1]
                z = np.append(z[:-1], peak / self.root(press))
        P_n, P_t = math.sqrt(self.masses[0]) * z[-3], math.sqrt(self.masses[1]) * z[-2]
        speed = math.hypot(P_t, P_n) / scene.ball.mass / float(scene.stroke.speed)
        return End(self.phi - math.atan2(P_t, P_n), speed, tuple(phases), len(z))


def exactly(finer: float = 1.0) -> Follow:
    """Cell by cell, by the exponential and its series, in cells so many times shorter than one over the norm of A."""

    def follow(A: np.ndarray, guards: Guards, z: np.ndarray, _: float) -> tuple[str, np.ndarray]:
        h = 1 / (finer * float(np.linalg.norm(A, 2)))
        advance, places = la.expm(A * h), np.linspace(0.0, 1.0, LOOKS + 1)
        while True:
            series = [z]
            for k in range(1, TERMS):
                series.append(A @ series[-1] * (h / k))
            terms = np.array([guards.rows @ term for term in series])
            terms[0] += guards.constants
            values = polyval(places, terms)
            fallen = (values[:, 1:] < 0) & ((values[:, :-1] > 0) | (values[:, 1:] < values[:, :-1]))
            ends = []
            for guard in np.flatnonzero(fallen.any(axis=1)):
                j = int(np.argmax(fallen[guard]))
                falls = values[guard, j] > 0
                ends.append((_root(terms[:, guard], places[j], places[j + 1]) if falls else places[j], guard))
            if ends:
                x, guard = min(ends)
                return guards.names[guard], polyval(x, np.array(series))
            z = advance @ z

    return follow


def _root(terms: np.ndarray, low: float, high: float) -> float:
    """Where a polynomial falls to zero."""
    return float(brentq(lambda x: polyval(x, terms), low, high, xtol=1e-16))


def by_solver(method: str, rtol: float) -> Follow:
    """By scipy's solve_ivp, ended by its events."""

    def follow(A: np.ndarray, guards: Guards, z: np.ndarray, time: float) -> tuple[str, np.ndarray]:
        def event(row: np.ndarray, constant: float) -> Callable[[float, np.ndarray], float]:
            def falls(_: float, z: np.ndarray) -> float:
                return float(row @ z + constant)

            falls.terminal, falls.direction = True, -1.0  # type: ignore[attr-defined]
            return falls

        found = solve_ivp(
            lambda _, z: A @ z,
            (0.0, 20 * time),
            z,
            method=method,
            rtol=rtol,
            atol=rtol * 1e-2,
            events=[event(*pair) for pair in zip(guards.rows, guards.constants, strict=True)],
            **({"jac": A} if method == "Radau" else {}),
        )
        guard = next(i for i, hits in enumerate(found.t_events) if len(hits))
        return guards.names[guard], found.y[:, -1]

    return follow


def by_newmark(steps: int) -> Follow:
    """By so many steps of Newmark's constant average acceleration a head-on contact time, the last one shortened.

    In first-order form that rule is the trapezoidal one: z' = A z, (1 - A h/2) z(t + h) = (1 + A h/2) z(t).
    """

    def trapezoid(A: np.ndarray, h: float) -> np.ndarray:
        one = np.eye(len(A))
        return np.linalg.solve(one - h / 2 * A, one + h / 2 * A)

    def follow(A: np.ndarray, guards: Guards, z: np.ndarray, time: float) -> tuple[str, np.ndarray]:
        h = time / steps
        advance, values = trapezoid(A, h), guards.rows @ z + guards.constants
        while True:
            following = advance @ z
            after = guards.rows @ following + guards.constants
            fallen = np.flatnonzero((after < 0) & ((values > 0) | (after < values)))
            if len(fallen):
                break
            z, values = following, after
        before = np.maximum(values[fallen], 0)
        fractions = before / (before - after[fallen])
        fraction = float(fractions.min())
        name = guards.names[int(fallen[np.argmin(fractions)])]
        return name, trapezoid(A, fraction * h) @ z

    return follow
