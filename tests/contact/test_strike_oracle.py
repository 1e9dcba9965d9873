"""The coupled strike against an independent oracle: scipy's solve_ivp on handbook: Inverse mass, The strike.

The oracle shares nothing with cuefem.contact.linear: its state holds modal displacements and the tip's compression, not
forces, in SI and unscaled, and it steps with DOP853 at tight tolerance, its phases ended by solve_ivp's events.
"""

from dataclasses import dataclass
from math import asin, atan2, cos, inf, isinf, sin
from typing import NamedTuple

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from cuefem import Ball, LumpedCue, Outcome, Resolution, Scene, Stroke, Tip, impulse
from cuefem.beam.tip import TipModes, lumped_tip_modes
from cuefem.contact.strike import strike_modes
from cuefem.tip_modes import tip_modes_of
from tests.helpers.strike_scenes import KIM_AT, hand_made, hollow_cue, kim_scene, pool_cue, weighted_cue


class Told(NamedTuple):
    """What the oracle says: squirt, ball velocity and impulse (t, n), cue speed, (grip, press, end) of each phase."""

    squirt: float
    velocity: np.ndarray
    cue_speed: float
    phases: list[tuple[str, str, float]]


@dataclass
class Oracle:
    """State y: q, q', the ball's normal and surface speed, the tip's compression, the tangential impulse."""

    scene: Scene
    tip: TipModes

    def __post_init__(self):
        phi = asin(abs(self.scene.stroke.offset))
        self.t = self.tip.amplitude @ [sin(phi), cos(phi)]
        self.n = self.tip.amplitude @ [cos(phi), -sin(phi)]
        self.phi, self.count = phi, len(self.tip.omega)
        ball = self.scene.ball
        self.M, self.surface = ball.mass, ball.mass * ball.inertia / (1 + ball.inertia)
        self.k, self.e, self.mu = self.scene.stiffness, self.scene.tip.restitution, self.scene.tip.friction
        self.peak = self.deepest = 0.0  # force and compression at the last peak

    def relative(self, y):
        speeds = y[self.count : 2 * self.count]
        return y[2 * self.count + 1] - self.t @ speeds, y[2 * self.count] - self.n @ speeds

    def forces(self, y, grip, press):
        """(F_t, F_n) on the ball, from the accelerations they would have to give."""
        spring = self.tip.omega**2 * y[: self.count]
        free = np.array([self.t @ spring, self.n @ spring])  # of ball less tip, without a force
        tt = 1 / self.surface + self.t @ self.t
        nn, tn = 1 / self.M + self.n @ self.n, self.t @ self.n
        if press == "rigid":
            if grip == "stick":
                F_t, F_n = np.linalg.solve([[tt, tn], [tn, nn]], -free)
            else:
                side = self.mu if grip == "slip" else -self.mu
                F_n = -free[1] / (nn + side * tn)
                F_t = side * F_n
            return F_t, F_n
        compression = y[2 * self.count + 2]
        F_n = self.k * compression
        if press == "unload":
            F_n = self.peak - self.k / self.e**2 * (self.deepest - compression)
        if grip == "stick":
            return -(free[0] + tn * F_n) / tt, F_n
        return (self.mu if grip == "slip" else -self.mu) * F_n, F_n

    def change(self, y, grip, press):
        F_t, F_n = self.forces(y, grip, press)
        q, speeds = y[: self.count], y[self.count : 2 * self.count]
        pushed = -(self.tip.omega**2) * q - self.t * F_t - self.n * F_n
        closing = 0.0 if press == "rigid" else -self.relative(y)[1]
        return np.concatenate([speeds, pushed, [F_n / self.M, F_t / self.surface, closing, F_t]])

    def ends(self, grip, press):
        """Events by name; each falls through zero where the phase ends."""
        found = {}
        if press == "load":
            found["compressed"] = lambda _, y: -self.relative(y)[1]
        else:
            found["apart"] = lambda _, y: self.forces(y, grip, press)[1]
            if press == "rigid":
                found["reloaded"] = lambda _, y: self.peak - self.forces(y, grip, press)[1]
            else:
                found["reloaded"] = lambda _, y: self.deepest - y[2 * self.count + 2]
        if grip != "stick":
            side = 1 if grip == "slip" else -1
            found["gripped"] = lambda _, y: -side * self.relative(y)[0]
        elif not isinf(self.mu):
            found["slip"] = lambda _, y: self.mu * self.forces(y, grip, press)[1] - self.forces(y, grip, press)[0]
            found["slip back"] = lambda _, y: self.mu * self.forces(y, grip, press)[1] + self.forces(y, grip, press)[0]
        for event in found.values():
            event.terminal, event.direction = True, -1
        return found

    def next(self, name, y, grip, press):
        if name == "compressed":
            self.peak, self.deepest = self.k * y[2 * self.count + 2], y[2 * self.count + 2]
            return (grip, "unload") if self.e > 0 else self.rigid(y, grip)
        if name == "reloaded":
            return grip, "load"
        if name == "gripped":
            F_t, F_n = self.forces(y, "stick", press)
            if abs(F_t) <= self.mu * F_n:
                return "stick", press
            return ("slip" if F_t > 0 else "slip back"), press
        return name, press

    def rigid(self, y, grip):
        """The force of a dead tip drops at its peak, to what holds ball and tip together: with another grip perhaps."""
        F_t, F_n = self.forces(y, grip, "rigid")
        if grip == "stick" and abs(F_t) > self.mu * F_n:
            grip = "slip" if F_t > 0 else "slip back"
        return (grip, "rigid") if self.forces(y, grip, "rigid")[1] > 0 else None

    def tell(self) -> Told:
        U, time, phases = self.scene.stroke.speed, 0.0, []
        y = np.concatenate([np.zeros(self.count), U * self.tip.approach, np.zeros(4)])
        state = ("slip", "load")
        if isinf(self.mu):
            blow = -self.relative(y)[0] / (1 / self.surface + self.t @ self.t)
            y[self.count : 2 * self.count] -= self.t * blow
            y[2 * self.count + 1] += blow / self.surface
            y[-1] += blow
            state = ("stick", "load")
        ringing = np.sqrt(self.k * (1 / self.M + self.n @ self.n)) / (self.e or 1.0)  # of the tip while it unloads
        step = 0.25 / max(self.tip.omega.max(), ringing)
        while state is not None:
            grip, press = state
            events = self.ends(grip, press)
            run = solve_ivp(
                lambda _, y, g=grip, p=press: self.change(y, g, p),
                (time, time + 20 * self.scene.contact_time),
                y,
                method="DOP853",
                rtol=1e-12,
                atol=1e-14,
                max_step=step,
                events=list(events.values()),
            )
            name = next(name for name, hits in zip(events, run.t_events, strict=True) if len(hits))
            time, y = run.t[-1], run.y[:, -1]
            phases.append((grip, press, time))
            state = None if name == "apart" else self.next(name, y, grip, press)
        p = np.array([y[-1], y[2 * self.count] * self.M])
        along = sin(self.phi) * p[0] + cos(self.phi) * p[1]
        across = cos(self.phi) * p[0] - sin(self.phi) * p[1]
        inertia = self.tip.approach @ self.tip.approach
        return Told(atan2(-across, along), p / self.M, U - along / inertia, phases)


def met(told: Told, outcome: Outcome, scene: Scene) -> None:
    speed = np.hypot(*told.velocity)
    assert abs(outcome.squirt - told.squirt) < 1e-8
    assert np.abs(outcome.ball_velocity - told.velocity).max() < 1e-8 * speed
    assert abs(outcome.cue_speed - told.cue_speed) < 1e-8 * scene.stroke.speed
    phases = [phase for phase in outcome.phases if phase.end > phase.start]
    assert [(phase.grip, phase.press) for phase in phases] == [(grip, press) for grip, press, _ in told.phases]
    for phase, (*_, end) in zip(phases, told.phases, strict=True):
        assert abs(phase.end - end) < 1e-8 * scene.contact_time, phase


FEW = Resolution(4, 10, 8)
# (offset, restitution, friction, contact time, cue, resolution); why it is here
SCENES = {
    "the paper's stroke": (0.3, 0.75, 0.7, 1e-3, "kim", KIM_AT),
    "a large offset": (0.5, 0.75, 0.7, 1e-3, "kim", KIM_AT),
    "a miscue": (0.9, 0.75, 0.7, 1e-3, "kim", KIM_AT),
    "little friction": (0.3, 0.75, 0.05, 1e-3, "kim", KIM_AT),
    "no friction": (0.4, 0.5, 0.0, 1e-3, "kim", FEW),
    "endless friction": (0.5, 0.5, inf, 1e-3, "kim", FEW),
    "late stick": (0.3, 1.0, 0.3, 1e-3, "kim", KIM_AT),
    "a lossless tip, long contact": (0.3, 1.0, 0.7, 3e-3, "pool", FEW),
    "reload cycles of a dead tip": (0.999, 0.01, 0.7, 1e-3, "kim", FEW),
    "reload cycles in a jam": (0.9, 0.02, 0.3, 1e-3, "kim", KIM_AT),
    "rigid, stuck and slipping": (0.3, 0.0, 0.7, 1e-3, "kim", KIM_AT),
    "rigid, slipping": (0.5, 0.0, 0.3, 1e-3, "kim", KIM_AT),
    "rigid, held for ever": (0.5, 0.0, inf, 1e-3, "kim", FEW),
    "a soft tip's shaft": (0.35, 0.73, 0.6, 1.1e-3, "pool", KIM_AT),
    "a hollow shaft": (0.45, 0.8, 0.6, 0.8e-3, "hollow", KIM_AT),
    "a weighted butt": (0.2, 0.6, 0.5, 2e-3, "weighted", FEW),
    "rigid, a small offset and a long contact": (0.02, 0.0, 0.1, 8e-3, "pool", FEW),
}
# Cues of a few loud modes, made by hand: (offset, restitution, friction, contact time, omega, amplitude, axial mass,
# rigid amplitude). They press, slip and stick in every order.
LOUD = {
    "sticks again while unloading": (0.1, 0.3, 0.1, 1e-2, [13000.0], [4.1], 0.05, 4.0),
    "slips back while loading": (0.3, 0.9, 0.3, 1e-2, [4900.0, 31000.0], [1.3, 9.3], 0.05, 0.5),
    "every grip while unloading": (0.3, 1.0, 0.1, 1e-2, [620.0, 13000.0], [1.1, 10.0], 0.05, 4.0),
    "three loads": (0.5, 0.3, 0.05, 3e-3, [870.0, 2600.0], [11.0, 12.0], 0.54, 0.5),
    "reversal, and loaded again": (0.5, 1.0, 0.1, 1e-3, [880.0, 3300.0], [3.7, 15.0], 0.05, 4.0),
    "dead tip, loaded again": (0.5, 0.0, 0.05, 3e-3, [1300.0, 6500.0, 19000.0], [11.0, 9.1, 11.0], 0.54, 4.0),
    "dead tip, slips back": (0.5, 0.0, 0.7, 1e-2, [1500.0, 2100.0, 12000.0], [7.5, 6.6, 1.1], 0.05, 0.5),
}
CUES = {"kim": kim_scene().cue, "pool": pool_cue(), "hollow": hollow_cue(), "weighted": weighted_cue()}


@pytest.mark.parametrize("name", SCENES)
def test_the_oracle_tells_the_same_course(name):
    offset, e, mu, time, cue, at = SCENES[name]
    scene = Scene(CUES[cue], Ball(), Tip(e, mu, contact_time=time), Stroke(1.5, offset))
    tip = tip_modes_of(scene, at)
    told, outcome = Oracle(scene, tip).tell(), strike_modes(scene, tip)
    met(told, outcome, scene)


@pytest.mark.heavy
@pytest.mark.parametrize("name", LOUD)
def test_the_oracle_tells_the_same_course_of_a_loud_cue(name):
    offset, e, mu, time, omega, across, mass, rigid = LOUD[name]
    tip = hand_made(omega, across, mass=mass, rigid=rigid)
    scene = Scene(LumpedCue(mass, 0.01), Ball(), Tip(e, mu, contact_time=time), Stroke(1.5, offset))
    told, outcome = Oracle(scene, tip).tell(), strike_modes(scene, tip)
    assert len(told.phases) >= 4
    met(told, outcome, scene)


def test_the_oracle_and_the_impulse_solver_agree_on_a_lumped_cue():
    """The oracle itself, against exact numbers: a lumped cue whose slip ends in compression."""
    scene = Scene(LumpedCue(0.54, 0.003), tip=Tip(0.75, 0.7, contact_time=1e-3), stroke=Stroke(1.5, 0.3))
    told, exact = Oracle(scene, lumped_tip_modes(scene.cue)).tell(), impulse(scene)
    assert abs(told.squirt - exact.squirt) < 1e-10
    assert np.abs(told.velocity - exact.ball_velocity).max() < 1e-10
    assert abs(told.cue_speed - exact.cue_speed) < 1e-10
