"""The nonlinear effects against exact solutions, other solvers and the rates at which they vanish."""

from dataclasses import replace
from math import asin, cos, sin

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import cuefem as cf
from cuefem.beam.tip import lumped_tip_modes
from cuefem.contact.strike import strike_modes
from tests.helpers.orders import falls_with_the_step
from tests.helpers.strike_scenes import KIM

# ---------------------------------------------------------------------------------------------------------- PowerLawTip


@pytest.mark.parametrize("exponent", [1.0, 1.5, 2.0, 3.7])
@pytest.mark.parametrize(("speed", "e"), [(0.2, 0.4), (1.0, 0.1), (7.0, 1.0)])
def test_head_on_contact_time_falls_with_speed(exponent, speed, e):
    scene = cf.Scene(
        cf.LumpedCue(0.5, 0.005),
        tip=cf.Tip(e, contact_time=1.3e-3),
        stroke=cf.Stroke(speed),
        effects=(cf.PowerLawTip(exponent, speed=2.0),),
    )
    time = 1.3e-3 * (speed / 2.0) ** ((1 - exponent) / (1 + exponent))
    Q0 = 0.5 / 0.210

    def error(steps: int) -> float:
        outcome = cf.strike(scene, cf.Resolution(1, 1, 1, steps))
        leaves = outcome.ball_speed / (speed * (1 + e) * Q0 / (1 + Q0))
        return max(abs(outcome.duration / time - 1), abs(leaves - 1))

    falls_with_the_step(error)


# ------------------------------------------------------------------------------------------------------- RollingContact


class Plane:
    """A tip point (a mass along the cue, another across it) slides on a ball, in Cartesian coordinates (u, w).

    Positions of point and ball's centre give the normal and the compression; `true` measures them, else the normal
    turns at its rate without the compression, as RollingContact has it. Newton's equations with F_t = mu F_n.
    """

    def __init__(self, scene: cf.Scene, *, true: bool, dome: float = 0.0):
        self.scene, self.true, self.reach = scene, true, scene.ball.radius + dome
        self.masses = np.array([scene.cue.mass, scene.cue.end_mass])
        self.phi = asin(scene.stroke.offset)
        self.peak = None

    def normal(self, y):
        phi = y[8]
        if self.true:
            line = y[2:4] - y[0:2]
            phi = np.arctan2(-line[1], line[0])
        return phi, np.array([cos(phi), -sin(phi)]), np.array([sin(phi), cos(phi)])

    def depth(self, y):
        return self.reach - np.hypot(*(y[2:4] - y[0:2])) if self.true else y[9]

    def change(self, _, y):
        _, n, t = self.normal(y)
        k, e, mu = self.scene.stiffness, self.scene.tip.restitution, self.scene.tip.friction
        F = k * self.depth(y) if self.peak is None else k / e**2 * (self.depth(y) - (1 - e**2) * self.peak)
        push = F * n + mu * F * t
        apart = y[6:8] - y[4:6]
        turning = -(apart @ t) / self.reach
        return np.concatenate(
            [y[4:6], y[6:8], -push / self.masses, push / self.scene.ball.mass, [turning, -(apart @ n)]]
        )

    def squirt(self):
        R, T = self.reach, self.scene.contact_time
        start = [0, 0, R * cos(self.phi), -R * sin(self.phi), self.scene.stroke.speed, 0, 0, 0, self.phi, 0]
        state = np.array(start)

        def deepest(_, y):
            return -(y[6:8] - y[4:6]) @ self.normal(y)[1]

        def gone(_, y):
            return self.depth(y) - (1 - self.scene.tip.restitution**2) * self.peak

        for event in (deepest, gone):
            event.terminal, event.direction = True, -1
            found = solve_ivp(
                self.change, [0, 20 * T], state, "DOP853", events=event, rtol=1e-12, atol=1e-14, max_step=T / 30
            )
            state = found.y[:, -1]
            self.peak = self.depth(state) if self.peak is None else self.peak
        return np.arctan2(state[7], state[6])  # the cue's line is w = 0; the struck side is w > 0


@pytest.mark.parametrize(
    ("offset", "friction", "dome"), [(0.4, 0.0, 0.0), (0.3, 0.05, 0.0), (0.6, 0.1, 0.0), (0.4, 0.05, 0.012)]
)
def test_turning_contact_in_cartesian_coordinates(offset, friction, dome):
    """A dome lengthens the line of centres; the end section of a lumped cue does not turn."""
    cue = cf.LumpedCue(0.54, 0.02)
    scene = cf.Scene(cue, cf.Ball(), cf.Tip(0.8, friction, 2e-3), cf.Stroke(1.5, offset))
    domed = replace(scene, cue=KIM, effects=(cf.RollingContact(), *[cf.TipDome(dome)] * (dome > 0)))
    outcome = strike_modes(domed, lumped_tip_modes(cue))
    assert {phase.grip for phase in outcome.phases} == {"slip"}
    exact = -Plane(scene, true=False, dome=dome).squirt()
    falls_with_the_step(lambda steps: abs(strike_modes(domed, lumped_tip_modes(cue), steps=steps).squirt - exact))
    assert abs(outcome.squirt - cf.strike(scene).squirt) > 1e-3  # it is no small thing here
