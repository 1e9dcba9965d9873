"""A contact step by step, in plain NumPy; the laws of its forces are in planar.py, rings.py and raised.py.

Cue and ball are coordinates xi that turn by themselves and are driven by loads on ports, whose velocities are read:

    xi' = rates xi + drives' load,    y = Re(readings xi),    v = C(angle) y,    load = C(angle)' F.

Over a step the forces F are polynomials through Radau's nodes, and the answer of xi to them is exact: moments of exp
with Legendre polynomials. A law ties the forces at the nodes to the velocities v, their integrals x and the
compression: g = 0, by Newton's method, whose derivatives are complex steps. A phase ends where one of its guards falls
through zero.

Nothing here is shared with the kernel but the scene's `ContactModel` and the modes of its cue.
"""

from __future__ import annotations

import copy
import math
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.polynomial import Legendre, legendre
from scipy.linalg import block_diag
from scipy.optimize import brentq
from scipy.special import ive

from cuefem.contact.laws import ContactModel

Q = 12
_roots = legendre.legroots(np.eye(Q + 1)[Q - 1] - np.eye(Q + 1)[Q])
NODES = np.append(np.sort((1 + _roots.real) / 2)[:-1], 1.0)
WITH_START = np.append(0.0, NODES)
FORCE_WAVES = np.linalg.inv(legendre.legvander(2 * NODES - 1, Q - 1))  # values at the nodes -> Legendre coefficients
WAVES = np.linalg.inv(legendre.legvander(2 * WITH_START - 1, Q))
GAUSS, WEIGHTS = (part / 2 for part in legendre.leggauss(Q + 2))
GAUSS = GAUSS + 0.5
TINY = 1e-30  # of a complex step
SHORTEST, MOST_STEPS = 60, 100_000


def at(parts: Any, values: Any, waves: Any = WAVES) -> Any:
    """Values (..., start and nodes) at one part of the step or many."""
    onto = legendre.legvander(2 * np.ravel(parts) - 1, len(waves) - 1) @ waves
    return np.asarray(values) @ onto.reshape(*np.shape(parts), -1).T


def forces_at(parts: Any, forces: Any) -> Any:
    """Forces (..., nodes) likewise."""
    return at(parts, forces, FORCE_WAVES)


# From values to their integrals from the start.
SUMS = np.array([at(place * GAUSS, np.eye(Q + 1)) @ WEIGHTS * place for place in WITH_START])


def waves_over(part: float, forces: Any) -> Any:
    """Legendre coefficients of forces over the first part of the step."""
    onto = (2 * np.arange(Q)[:, None] + 1) * WEIGHTS * legendre.legvander(2 * GAUSS - 1, Q - 1).T
    return forces_at(part * GAUSS, forces) @ onto.T


def moments(y: Any) -> Any:
    """Integrals over [0, 1] of exp(2 y (1 - s)) P_t(2 s - 1): modified spherical Bessel functions, (terms, modes)."""
    z = -np.where(y == 0, 1e-30, y)
    m = np.sqrt(np.pi / (2 * z)) * ive(np.arange(Q)[:, None] + 0.5, z) * np.exp(abs(z.real) - z)
    return np.where(y == 0, np.eye(Q)[0][:, None], m)


def integral(step: Step, part: float, *factors: Any) -> Any:
    """Of a product over the first part of a step."""
    return step.length * part * np.prod([at(part * GAUSS, factor) for factor in factors], axis=0) @ WEIGHTS


def first_fall(values: Any, past: float) -> float:
    """The part of the step where the polynomial first falls through zero and below -past; 2 if nowhere."""
    size = float(abs(values).max()) + 1e-300
    curve = Legendre(legendre.legtrim(WAVES @ (values / size), 1e-16), [0, 1])
    turns = curve.deriv().roots()
    turns = turns.real[abs(turns.imag) < 1e-8 + 1e-8 * abs(turns)]
    looks = np.unique([0.0, *turns[(turns > 0) & (turns < 1)], 1.0])  # between them it rises or falls
    low = np.flatnonzero(curve(looks) < -max(1e-13, past / size))
    if not len(low):
        return 2.0
    if low[0] == 0 or curve(looks[low[0] - 1]) <= 1e-14:
        return float(looks[max(low[0] - 1, 0)])
    return float(brentq(curve, looks[low[0] - 1], looks[low[0]], xtol=1e-16, rtol=1e-15))


@dataclass
class Step:
    """Forces, velocities, their integrals (..., forces, nodes + 1), compression, pose, loads, what dampers read.

    pose: the angle, and the slopes of a bent cue (..., nodes + 1, slopes).
    """

    length: float
    F: Any
    v: Any
    x: Any
    depth: Any
    pose: Any
    loads: Any
    damped: Any


class Contact:
    """A contact under way; subclasses are its laws: `first_grip`, `begin`, `residual`, `guards`, `taken`, `next`."""

    def __init__(self, model: ContactModel) -> None:
        p, self.model, self.terms = model.propagator, model, {"exponent": 1.0} | model.terms
        self.ports, self.speeds, self.forces = len(p.rows), len(model.ball), len(model.facing)
        ball = np.eye(self.speeds)
        aside = ((0, 0), (0, self.speeds))
        slopes, dampers = np.pad(p.slopes @ p.velocities, aside), np.pad(p.dampers @ p.velocities, aside)
        rows = np.concatenate([block_diag(p.rows @ p.velocities, ball), slopes])
        self.rates = np.append(p.rates, np.zeros(self.speeds))
        self.readings = np.concatenate([rows, dampers])
        of_slopes = np.pad((p.onto @ p.slopes.T).T, aside)
        self.drives = np.concatenate([block_diag((p.onto @ p.rows.T).T, ball * model.ball_gives), of_slopes])
        self.weights, self.slopes = model.arrays.get("slope_weights", np.zeros(0)), np.zeros(len(p.slopes))
        self.wide = len(rows)
        self.xi = np.append(p.onto @ p.approach * model.speed, model.ball).astype(complex)
        self.e, self.mu, self.speed, self.clock = model.restitution, model.friction, model.speed, model.time
        self.impulse, self.size = model.speed * model.ball_mass, model.speed * model.ball_mass / model.time
        self.turns = bool(self.terms.get("turns"))
        smooth = self.terms["exponent"] == 1 and not self.terms.get("curve")
        self.poses = int(self.turns) + len(self.slopes)  # what C depends on
        self.linear = smooth and not self.poses and self.forces == 2
        self.tolerance = self.terms["tolerance"] / (3 if self.terms.get("rings") else 10)
        self.time = self.depth = self.angle = self.shear = self.deepest = self.height = 0.0
        self.peak, self.parted, self.last = 0.0, False, None
        self.grip, self.press, self.table, self.start = "stick", "load", "held", 0.0
        self.losses = dict.fromkeys(("friction", "shear", "table", "damping", "radiated"), 0.0)
        self.phases: list[tuple[str, str, float, float]] = []
        self.steps, self.level, self.responses = 0, 0, {}

    # What moves

    def response(self, length: float) -> Any:
        """From xi and from loads at the nodes to all readings at the start and the nodes."""
        if length not in self.responses:
            answer = np.zeros((len(self.readings), Q + 1, len(self.drives), Q))
            for i, place in enumerate(NODES, 1):
                of_waves = moments(self.rates * length * place / 2)
                moved = length * place * of_waves.T @ waves_over(place, np.eye(Q)).T
                answer[:, i] = np.einsum("ak,bk,kj->abj", self.readings, self.drives, moved, optimize=True).real
            self.responses[length] = self.readings[:, None] * np.exp(np.outer(WITH_START * length, self.rates)), answer
        return self.responses[length]

    def facing(self, angle: Any, slopes: Any) -> Any:
        """The matrix C at angles, (..., forces, ports): the tip of a bent cue goes back at slopes times their rates."""
        C = self.straight(angle)
        return np.concatenate([C, -C[..., :1] * (self.weights * slopes)[..., None, :]], -1)

    def straight(self, angle: Any) -> Any:
        """C of a straight cue: on a dome the contact moves as it rolls, and levers move it."""
        if not self.turns:
            return np.broadcast_to(self.model.facing, (*angle.shape, *self.model.facing.shape))
        t = self.terms
        s, c, sa, ca = np.sin(t["phi"] + angle), np.cos(t["phi"] + angle), np.sin(angle), np.cos(angle)
        nothing = 0 * angle
        of_ball = np.stack([np.stack([ca, sa, 1 + nothing], -1), np.stack([-sa, ca, nothing], -1)], -2)
        ports = [np.stack([-s, -c], -1), np.stack([-c, s], -1)]
        if self.ports > 2:
            du, dw = self.on_dome(nothing) - self.on_dome(angle)
            if t.get("levers"):
                moved = np.polynomial.chebyshev.chebval(angle / t["lever_reach"], self.model.arrays["lever_terms"].T)
                du, dw = du + moved[0], dw + moved[1]
            along = ca * t["lever_t"] + sa * t["lever_n"] + s * du + c * dw
            normal = ca * t["lever_n"] - sa * t["lever_t"] + c * du - s * dw
            ports = [np.append(row, -turn[..., None], -1) for row, turn in zip(ports, (along, normal), strict=True)]
        return np.concatenate([np.stack(ports, -2), of_ball], -1)

    def on_dome(self, angle: Any) -> Any:
        """The contact's place on a dome, towards (-u, -w), as it has rolled through an angle; up to the rim."""
        to, rim = self.terms["phi"] + angle, self.terms["rim"]
        to = np.where(abs(np.real(to)) < rim, to, np.copysign(min(rim, 9.0), np.real(to)))
        return self.terms["dome"] * np.array([np.sin(to), np.cos(to)])

    def velocities(self) -> Any:
        return self.facing(np.array(self.angle), self.slopes) @ (self.readings @ self.xi).real[: self.wide]

    def inverse_mass(self) -> Any:
        """The contact's velocities per impulse, where it faces now."""
        C = self.facing(np.array(self.angle), self.slopes)
        return C @ (self.readings[: self.wide] @ self.drives.T).real @ C.T

    def push(self, impulses: Any) -> float:
        """Impulses at once; the energy that they take."""
        before = self.velocities()
        self.xi = self.xi + self.drives.T @ (self.facing(np.array(self.angle), self.slopes).T @ impulses)
        return -float(impulses @ (before + self.velocities())) / 2

    def stop(self, names: list[int]) -> float:
        """Take away what is left of velocities that a hold keeps at zero; the energy that this takes."""
        impulses = np.zeros(self.forces)
        if names:
            impulses[names] = -np.linalg.solve(self.inverse_mass()[np.ix_(names, names)], self.velocities()[names])
        return self.push(impulses)

    # A step

    def moved(self, length: float, unknown: Any) -> tuple[Step, Any]:
        """What moves under forces at the nodes and through angles there, one row each; by what the angles are off."""
        F, nothing = unknown[..., : self.forces, :], np.zeros((*unknown.shape[:-2], Q + 1), unknown.dtype)
        angle, slopes = nothing + self.angle, nothing[..., None] + self.slopes
        if self.turns:
            angle[..., 1:] = unknown[..., self.forces, :]
        slopes[..., 1:, :] = np.moveaxis(unknown[..., self.forces + self.turns :, :], -2, -1)
        C, (own, answer) = self.facing(angle, slopes), self.response(length)
        fixed = C[(0,) * (C.ndim - 2)]
        loads = np.einsum("...ifp,...fi->...pi", C[..., 1:, :, :], F) if self.poses else fixed.T @ F
        y = (own @ self.xi).real + np.tensordot(loads, answer, ([-2, -1], [2, 3]))
        on = y[..., : self.wide, :]
        v = np.einsum("...ifp,...pi->...fi", C, on) if self.poses else fixed @ on
        x, bent = length * v @ SUMS.T, y[..., self.ports + self.speeds : self.wide, :]
        pose = (angle, slopes)
        step = Step(
            length, forces_at(WITH_START, F), v, x, self.depth - x[..., 1, :], pose, loads, y[..., self.wide :, :]
        )
        missed = np.moveaxis(slopes - self.slopes, -1, -2) - length * bent @ SUMS.T
        if self.turns:
            rolls_on = self.terms["dome"] * (abs(self.terms["phi"] + angle.real) < self.terms["rim"])
            rate = v[..., 0, :] - y[..., self.ports + 2, :] - (rolls_on * y[..., 2, :] if self.ports > 2 else 0.0)
            off = angle - self.angle + length * (rate / (self.terms["radius"] + rolls_on)) @ SUMS.T
            missed = np.concatenate([off[..., None, :], missed], -2)
        return step, missed[..., 1:] if self.poses else None

    def solve(self, length: float) -> Step | None:
        """A step in the hold that there is, by Newton's method; None where it does not settle."""
        unknown = np.zeros((self.forces + self.poses, Q))
        unknown[self.forces :] = [[self.angle]] * self.turns + [[slope] for slope in self.slopes] or 0.0
        if self.last and not self.linear:
            part, old, forces = self.last
            places = np.minimum(part + NODES * length / old, 1.0 if part < 1 else 1.2)
            unknown[: self.forces] = forces_at(places, forces)
        count, before = unknown.size, math.inf
        scale = np.repeat([self.size] * self.forces + [1.0] * self.poses, Q)
        for _ in range(30):
            tried = unknown + 1j * TINY * (scale[:, None] * np.eye(count)).reshape(count, *unknown.shape)
            step, missed = self.moved(length, tried)
            g = step.F[..., 1:] if self.press == "free" else self.residual(step)
            g = (g if missed is None else np.concatenate([g, missed], -2)).reshape(count, count)
            slopes = g.imag.T / TINY
            by = abs(slopes).max(axis=1) + 1e-300
            try:
                change = -np.linalg.solve(slopes / by[:, None], g[0].real / by)
            except np.linalg.LinAlgError:
                return None
            off = float(abs(change).max())
            if not off < 1e9:
                return None
            unknown = unknown + (scale * change).reshape(unknown.shape)
            rounding = off > 0.3 * before and (off < 1e-9 or off * length < 1e-13 * self.clock)
            if rounding or off < (1e-10 if self.terms.get("rings") else 1e-14):
                step = self.moved(length, unknown)[0]
                if self.depth == 0 and self.time == 0:
                    step.F[:, 0] = 0.0
                return step
            before = off
        return None

    def forces_held(self, node: int = 0, **hold: str) -> Any:
        """The forces that a hold would ask for now."""
        before = {name: getattr(self, name) for name in hold}
        vars(self).update(hold)
        step = self.solve(self.clock / 2**13)
        vars(self).update(before)
        return None if step is None else step.F[:, node]

    def error(self, step: Step) -> float:
        """The last terms of a step's loads and velocities, in units of what is allowed."""
        along = self.model.across if self.forces == 2 else 1.0
        ports = np.full(self.ports + self.speeds, along)
        ports[[0, self.ports + 1]] = 1.0
        forces = np.append(along, np.ones(self.forces - 1))
        of_load = abs(step.loads[: len(ports)] @ FORCE_WAVES[-2:].T).max(axis=1) / ports * step.length / self.impulse
        of_speed = abs(step.v @ WAVES[-2:].T).max(axis=1) / forces / (10 * self.speed)
        of_start = 0.0  # the force through the nodes misses the law where that has a bend between the start and a node
        if self.press in ("load", "unload") and self.time > 0:
            of_start = abs(step.F[1, 0] - self.normal(self.virtual(self.depth))) * step.length / self.impulse
        return float(max(of_load.max(), of_speed.max(), of_start)) / self.tolerance

    def longest_step(self) -> Step:
        """The longest step of the clock over powers of two that holds the tolerance."""
        while self.level < SHORTEST:
            step = self.solve(self.clock / 2**self.level)
            error = math.inf if step is None else self.error(step)
            if step is not None and (error <= 1 or (self.terms.get("rings") and self.level >= 11)):
                self.level -= error < 1e-4 and self.level > 0
                return step
            self.level += 1
        raise RuntimeError(f"stuck at {self.time} s in {self.grip}, {self.press}, {self.table}")

    def take(self, step: Step, part: float) -> None:
        """Go to a part of a step."""
        for i, read in enumerate(step.damped):
            name = "damping" if i < self.model.propagator.lossy else "radiated"
            self.losses[name] += float(integral(step, part, read, read))
        self.taken(step, part)
        span = part * step.length
        driven = moments(self.rates * span / 2).T * (self.drives.T @ waves_over(part, step.loads))
        self.xi = np.exp(self.rates * span) * self.xi + span * driven.sum(axis=1)
        angle, slopes = step.pose
        self.angle, self.slopes = float(at(part, angle)), np.asarray(at(part, slopes.T))
        self.time, self.steps = self.time + span, self.steps + 1
        self.last = part, step.length, step.F[:, 1:]

    # Phases

    def follow(self, until: float) -> str:
        """March through a phase to the event that ends it."""
        self.start = self.time
        self.begin()
        while self.time < until and self.steps < MOST_STEPS:
            step, first, event, apart = self.longest_step(), 1.0, "", 2.0
            for name, values, past in self.guards(step):
                fall = first_fall(values, past)
                if fall < first or (fall == first and not event):
                    first, event = fall, name
                apart = fall if name == "apart" else apart
            # where all forces vanish the other ends mean nothing
            near = (1e-11 if self.linear else 1e-7 if self.forces == 2 else 1e-5) * self.deepest
            if event and apart <= 1 and self.press == "unload" and at(first, step.depth) - self.rest < near:
                first, event = apart, "apart"
            if first > 0:
                self.take(step, first)
            if event:
                self.end_phase()
                return event
        if self.press != "free":
            raise RuntimeError(f"the ball does not leave the cue: {self.time} s, {self.phases[-9:]}")
        return "late"

    def end_phase(self) -> None:
        if self.time > self.start:
            self.phases.append((self.grip, self.press, self.start, self.time))

    def touch(self, press: str, until: float) -> None:
        self.press, goes_on = press, self.first_grip(press)
        while goes_on:
            goes_on = self.next(self.follow(until))

    def fly(self, until: float) -> bool:
        """Whether ball and tip, apart, touch again by a time; else all is as it was when they parted."""
        shared = ("model", "responses")
        before = copy.deepcopy({name: value for name, value in vars(self).items() if name not in shared})
        self.grip, self.press, self.last, self.level = "apart", "free", None, 2
        if self.follow(until) == "touched" and self.time <= until:
            self.depth, self.last = self.rest, None
            return True
        vars(self).update(before)
        return False

    def run(self) -> Contact:
        """From the first touch to parting, and what comes after it within the window."""
        smooth = self.terms["exponent"] == 1 and not self.terms.get("curve")
        first = self.level = 2 if smooth else 30 if self.terms.get("compliance") else 12
        longest = self.model.longest
        self.touch("load", longest)
        until, start = self.time + (self.model.window or 0.0), 0.0
        while self.time < until and self.fly(until):
            longest, start, self.level = longest + self.time - start, self.time, first
            self.touch("unload", longest)
        self.press = "free"
        self.begin()  # what the patch still holds is lost
        return self

    @property
    def ball(self) -> Any:
        """Its velocities, m/s."""
        return self.xi[-self.speeds :].real

    @property
    def impulse_on_ball(self) -> tuple[float, float]:
        """(t, n), N s, of a ball at rest."""
        return tuple(self.model.ball_mass * self.ball[:2])

    @property
    def twist(self) -> float:
        """The ball's spin about the vertical times its radius, m/s."""
        return float(self.ball[2])

    # The force along the normal, over the compression

    @property
    def rest(self) -> float:
        """The compression at which a tip on its way back has no force."""
        return (1 - self.e**2) * self.deepest

    @property
    def give(self) -> float:
        return 1.0 if self.press == "load" else self.e**2

    def virtual(self, depth: Any) -> Any:
        return depth if self.press == "load" else (depth - self.rest) / self.e**2

    def normal(self, depth: Any) -> Any:
        """The force at a virtual compression: F = K d^n, or leather's series in the root of d."""
        if not self.terms.get("curve"):
            side = np.where(np.real(depth) < 0, -1.0, 1.0)
            n = self.terms["exponent"]
            return self.terms["stiffness"] * (depth if n == 1 else side * (side * depth + 1e-300) ** n)
        root = np.sqrt(np.where(np.real(depth) > 0, depth, 0.0))
        return root**3 * np.polynomial.polynomial.polyval(root, self.model.arrays["force_terms"])


def slope(curve: Any, depth: Any) -> Any:
    """The derivative of a law, by a complex step."""
    return np.imag(curve(depth + 1j * TINY)) / TINY
