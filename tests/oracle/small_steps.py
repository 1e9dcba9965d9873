"""An independent contact solver: small steps of equal length, without phases and events; no tests.

Cue, ball and table move in three dimensions in the table's frame (x right, y forward, z up). A step is half of the
free motion (exact), an impulse of the contact's forces, and the other half. The tip's normal force follows from
the positions; friction, at the tip and on the table, stops the sliding point at the end of the step, or is at its
bound against the sliding. Slip, stick, separation and repeated contact follow from that.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
import scipy.linalg as la
from numpy.typing import NDArray

import cuefem as cf
from tests.oracle.bending import Bending, bending

Array = NDArray[np.float64]
SWEEPS, FRICTION_TOLERANCE = 200, 1e-13  # iterations of the friction of a raised cue, and their tolerance


@dataclass(frozen=True)
class SmallStepsOutcome:
    """The outcome of small steps; fields as in `cuefem.Outcome`.

    touches: start of each contact of tip and ball, s. vibration, damping_loss: energy of the cue's vibrations, and
    energy dissipated by its dampers, over the initial energy.
    """

    squirt: float
    ball_speed: float
    spin: float
    cue_speed: float
    duration: float
    touches: tuple[float, ...]
    vibration: float
    damping_loss: float


def solve_small_steps(scene: cf.Scene, modes: int, steps: int) -> SmallStepsOutcome:
    """A strike with ``modes`` flexible modes of the free cue, in ``steps`` steps for a head-on contact time."""
    return Steps(scene, modes, steps).run()


class Steps:
    """The strike of one scene."""

    def __init__(self, scene: cf.Scene, modes: int, steps: int) -> None:
        self.scene = scene
        self.raised = self._effect(cf.Elevation)
        self.ball, self.tip, self.stroke = scene.ball, scene.tip, scene.stroke
        self.beam = self._bending_modes(modes)
        added = math.fsum(effect.mass for effect in scene.effects if isinstance(effect, cf.PointMass))
        self.mass = scene.cue.mass + added
        reduced_mass = 1 / (1 / self.ball.mass + 1 / self.mass)
        self.time = self.tip.contact_time
        self.stiffness = reduced_mass * (math.pi / 2 * (1 + self.tip.restitution) / self.time) ** 2
        self.exponent, self.scale = 1.0, self.stiffness  # force = scale * overlap^exponent
        law = self._effect(cf.PowerLawTip)
        if law is not None:
            self.exponent, q = law.exponent, law.exponent + 1
            loading = math.sqrt(math.pi) * math.gamma(1 + 1 / q) / math.gamma(0.5 + 1 / q)  # int ds/sqrt(1 - s^q)
            deepest = self.time * law.speed / (1 + self.tip.restitution) / loading
            self.scale = q / 2 * reduced_mass * law.speed**2 / deepest**q
        self.step = self.time / steps
        self.planes = 2 if self.raised else 1
        self.n_modes = len(self.beam.omega)
        self.body = 1 + self.planes * self.n_modes  # index of the ball's coordinates: x, y, z and R times its rotation
        self.size = self.body + 6
        self._frame()
        self._half_step()

    def _effect(self, kind: type[Any]) -> Any:
        return next((effect for effect in self.scene.effects if isinstance(effect, kind)), None)

    def _bending_modes(self, modes: int) -> Bending:
        cue = self.scene.cue
        if not isinstance(cue, cf.Cue):  # a mass along the axis and one across it
            assert cue.coupling == 0
            deflection = np.array([cue.end_mass**-0.5])
            return Bending(np.zeros(1), deflection, np.zeros(1), np.zeros((1, 1)))
        return bending(cue, self.scene.cue_effects, modes + 2)

    def _frame(self) -> None:
        """Output rows of the relative velocity, ball less tip, along each direction of the contact and of the table."""
        a = self.raised.angle if self.raised else 0.0
        s = self.stroke.offset
        c = math.sqrt(1 - s * s)
        right, up = np.eye(3)[0], np.eye(3)[2]
        axis, rise = np.array([0, math.cos(a), -math.sin(a)]), np.array([0, math.sin(a), math.cos(a)])
        n, t = c * axis - s * right, s * axis + c * right
        r = math.fsum(effect.radius for effect in self.scene.effects if isinstance(effect, cf.TipDome))
        beam, n_modes = self.beam, self.n_modes
        tip = np.zeros((3, self.size))  # velocity of the tip's contact point in the table's frame
        tip += np.outer(axis, np.eye(self.size)[0]) / math.sqrt(self.mass)
        for plane, direction in zip(range(self.planes), (right, rise), strict=False):
            modes = slice(1 + plane * n_modes, 1 + (plane + 1) * n_modes)
            tip[:, modes] += np.outer(direction, beam.deflection + r * (1 - c) * beam.rotation)
            if (
                plane == 0
            ):  # the contact lies r s left of the axis, so that a rotation of the end moves it along the axis
                tip[:, modes] += np.outer(axis, -r * s * beam.rotation)

        def row(direction: Array, arm: Array, *, relative: bool) -> Array:
            entries = np.zeros(self.size)
            entries[self.body : self.body + 3], entries[self.body + 3 :] = direction, np.cross(arm, direction)
            return entries - direction @ tip if relative else entries

        self.masses = np.ones(self.size)
        self.masses[self.body : self.body + 3] = self.ball.mass
        self.masses[self.body + 3 :] = self.ball.inertia * self.ball.mass
        self.row_n = row(n, -n, relative=True)
        rows = [row(t, -n, relative=True)]
        if self.raised:
            rows.append(row(np.cross(t, n), -n, relative=True))
            rows += [row(up, -up, relative=False), row(right, -up, relative=False)]
            rows.append(row(np.array([0.0, 1.0, 0.0]), -up, relative=False))
        self.rows = np.array(rows)

    def _half_step(self) -> None:
        """The free motion over half a step, and what an impulse at its middle does to the velocities at its end."""
        n, n_modes = self.size, self.n_modes
        A = np.zeros((2 * n, 2 * n))
        A[:n, n:] = np.eye(n)
        for plane in range(self.planes):
            modes = np.arange(1 + plane * n_modes, 1 + (plane + 1) * n_modes)
            A[n + modes, modes] = -(self.beam.omega**2)
            A[np.ix_(n + modes, n + modes)] = -self.beam.damping
        self.half = la.expm(A * self.step / 2)
        self.output_rows = np.concatenate([np.zeros_like(self.rows), self.rows], axis=1) @ self.half
        steps = np.concatenate([self.row_n[None], self.rows]) / self.masses  # of velocity: normal, then the rows
        self.impulses = np.concatenate([np.zeros_like(steps), steps], axis=1)
        self.gram = self.output_rows @ self.impulses.T

    def run(self) -> SmallStepsOutcome:
        """The strike from touch to the last separation."""
        n, h, e, k = self.size, self.step, self.tip.restitution, self.stiffness
        shear = self._effect(cf.TipShear)
        window = self._effect(cf.SecondHit)
        z = np.zeros(2 * n)
        z[n] = self.stroke.speed * math.sqrt(self.mass)
        initial_energy = z[n] ** 2 / 2
        max_depth = F_t = previous_shift = time = separation = overlap = damping_loss = 0.0
        first: float | None = None  # first separation, from which the window of a second hit counts
        touching, touches, tangent = False, list[float](), np.zeros(len(self.rows))
        while True:
            z = self.half @ z
            time += h / 2
            depth = -float(self.row_n @ z[:n])
            max_depth = max(max_depth, depth)
            previous_overlap = overlap
            overlap = depth if depth == max_depth else (depth - (1 - e**2) * max_depth) / e**2
            force = self.scale * math.copysign(abs(overlap) ** self.exponent, overlap)
            if force > 0 and not touching:
                touching = True
                touches.append(time)
            elif force <= 0 and touching:  # where the line through the last two passes zero
                separation = time - h * overlap / (overlap - previous_overlap)
                touching, first = False, separation if first is None else first
            if not touching and first is not None and (window is None or time > first + window.window):
                break
            impulse = h * max(force, 0.0)
            if shear is not None:
                shift = float(self.rows[0] @ z[:n])
                bound = self.tip.friction * impulse / h if impulse else 0.0
                F_t = min(max(F_t - shear.ratio * k * (shift - previous_shift), -bound), bound)
                previous_shift, tangent = shift, np.array([h * F_t])
            elif impulse:
                tangent = self._friction(self.output_rows @ z + self.gram[:, 0] * impulse, impulse, tangent)
            else:
                tangent = np.zeros(len(self.rows))
                if self.raised:
                    tangent = self._friction(self.output_rows @ z, 0.0, tangent)
            z = z + self.impulses[0] * impulse + tangent @ self.impulses[1:]
            damping_loss += self._damping_power(z)
            z = self.half @ z
            time += h / 2
            assert time < 300 * self.time, "the small steps do not end"
        return self._outcome(z, separation, touches, damping_loss, initial_energy)

    def _damping_power(self, z: Array) -> float:
        """Energy that dampers dissipate in a step, J."""
        v = z[self.size + 1 : self.size + 1 + self.n_modes]
        return float(v @ self.beam.damping @ v) * self.step

    def _friction(self, sliding: Array, normal_impulse: float, guess: Array) -> Array:
        """Impulses along the rows: the tip's friction, and of a raised cue the normal force and friction of the table.

        sliding: velocities at the end of the step without them.
        """
        mu = self.tip.friction
        G = self.gram[:, 1:]
        if not self.raised:
            stick_impulse = -sliding[0] / G[0, 0]
            bound = mu * normal_impulse if math.isfinite(mu) else math.inf
            return np.array([min(max(stick_impulse, -bound), bound)])
        P = guess.copy()
        scale = abs(normal_impulse) + 1e-30
        for _ in range(SWEEPS):
            previous = P.copy()
            P[:2] = in_disk(P[:2], sliding[:2] + G[:2] @ P, G[:2, :2], mu * normal_impulse if normal_impulse else 0.0)
            P[2] = max(0.0, P[2] - (sliding[2] + G[2] @ P) / G[2, 2])
            P[3:] = in_disk(P[3:], sliding[3:] + G[3:] @ P, G[3:, 3:], self.raised.friction * P[2])
            if np.abs(P - previous).max() < FRICTION_TOLERANCE * scale:
                break
        return P

    def _outcome(self, z: Array, end: float, touches: list[float], loss: float, initial: float) -> SmallStepsOutcome:
        n, body, n_modes = self.size, self.body, self.n_modes
        v = z[n:]
        V, rotation = v[body : body + 3], v[body + 3 :] / self.ball.radius
        vibration = 0.0
        for plane in range(self.planes):
            modes = slice(1 + plane * n_modes, 1 + (plane + 1) * n_modes)
            flexible = self.beam.omega > 0
            vibration += float(np.sum((self.beam.omega * z[:n][modes])[flexible] ** 2 + v[modes][flexible] ** 2)) / 2
        return SmallStepsOutcome(
            squirt=math.atan2(-V[0], V[1]),
            ball_speed=math.hypot(V[0], V[1]),
            spin=float(rotation[2]),
            cue_speed=float(v[0]) / math.sqrt(self.mass),
            duration=end,
            touches=tuple(touches),
            vibration=vibration / initial,
            damping_loss=loss / initial,
        )


def in_disk(P: Array, sliding: Array, G: Array, bound: float) -> Array:
    """The friction impulse, within its bound, that stops sliding in two directions or opposes it.

    P: the impulse that led to the sliding velocity.
    """
    stick_impulse = P - np.linalg.solve(G, sliding)
    if math.isinf(bound) or stick_impulse @ stick_impulse <= bound**2:
        return stick_impulse
    if bound == 0:
        return np.zeros(2)
    for _ in range(50):  # the fixed point of P -> projection of P - sliding/g
        trial = P - sliding / (G[0, 0] + G[1, 1])
        projected = trial * (bound / math.hypot(*trial))
        sliding = sliding + G @ (projected - P)
        converged = np.abs(projected - P).max() <= 1e-14 * bound
        P = projected
        if converged:
            break
    return P
