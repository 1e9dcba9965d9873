"""A raised cue against exact solutions in the table's frame, and the rates at which it becomes a level one."""

from dataclasses import replace
from math import asin, cos, inf, sin

import numpy as np
import pytest

from cuefem import Elevation, LumpedCue, PowerLawTip, Resolution, Scene, Stroke, Tip, strike
from cuefem.contact.model import model_of
from cuefem.contact.step_records import solve_contact
from cuefem.contact.strike import strike_modes
from tests.helpers.orders import falls_with_the_step
from tests.helpers.strike_scenes import CLOSED, hand_made, imbalance

pytestmark = pytest.mark.kernel


class Blow:
    """A lumped cue and a ball on a table as rigid bodies in the table's frame (x right, y forward, z up).

    Velocities: the cue's along u, w, p (masses M_c, m_e, m_e), the ball's V, its spin; a force along a constraint's row
    keeps that velocity at zero. With no slip that begins or ends, the tip's impulse is (1 + e) times what stops it.
    """

    def __init__(self, scene: Scene, angle: float):
        self.scene = scene
        cue, ball, phi = scene.cue, scene.ball, asin(scene.stroke.offset)
        x, u, p = np.eye(3)[0], np.array([0, cos(angle), -sin(angle)]), np.array([0, sin(angle), cos(angle)])
        self.masses = np.array(
            [cue.mass, cue.end_mass, cue.end_mass, *3 * [ball.mass], *3 * [ball.inertia * ball.mass * ball.radius**2]]
        )
        self.n, self.t, self.p = cos(phi) * u - sin(phi) * x, sin(phi) * u + cos(phi) * x, p
        self.axes = np.array([u, x, p])

    def row(self, way: np.ndarray, arm: np.ndarray, *, tip: bool) -> np.ndarray:
        """Velocity along ``way`` of the ball's point at ``arm``, less the tip's."""
        return np.concatenate([-(self.axes @ way) if tip else np.zeros(3), way, np.cross(arm, way)])

    def after(self, held: list[np.ndarray]) -> np.ndarray:
        R = self.scene.ball.radius
        normal = self.row(self.n, -R * self.n, tip=True)
        start = np.zeros(9)
        start[0] = self.scene.stroke.speed
        rows = np.array(held)
        pull = rows.T / self.masses[:, None]

        def free(v):
            return v - pull @ np.linalg.solve(rows @ pull, rows @ v)

        start, push = free(start), free(normal / self.masses)
        return start - (1 + self.scene.tip.restitution) * (normal @ start) / (normal @ push) * push

    def tip_rows(self) -> list[np.ndarray]:
        arm = -self.scene.ball.radius * self.n
        return [self.row(way, arm, tip=True) for way in (self.t, self.p)]

    def table_rows(self, *, held: bool) -> list[np.ndarray]:
        x, y, z = np.eye(3)
        arm = -self.scene.ball.radius * z
        return [self.row(way, arm, tip=False) for way in ((z, x, y) if held else (z,))]


@pytest.mark.parametrize(("angle", "exponent"), [(0.05, 1.0), (0.4, 1.5), (1.1, 1.0)])
@pytest.mark.parametrize(
    ("offset", "friction", "table"),
    [(0.35, 0.0, 0.0), (0.35, inf, 0.0), (0.6, inf, 0.0), (0.0, inf, 1e9), (0.6, 0.0, 1e9), (0.0, 0.0, 1e9)],
)
def test_rigid_bodies_on_a_table(angle, offset, exponent, friction, table):
    scene = Scene(LumpedCue(0.54, 0.02), tip=Tip(0.7, friction, 1e-3), stroke=Stroke(1.4, offset))
    scene = replace(scene, effects=(Elevation(angle, table), PowerLawTip(exponent)))
    blow = Blow(scene, angle)
    told = blow.after([*(blow.tip_rows() if friction else []), *blow.table_rows(held=table > 0)])

    def error(steps: int) -> float:
        outcome = strike(scene, Resolution(1, 1, 1, steps))
        found = [*outcome.history.velocity, outcome.cue_speed, outcome.squirt, outcome.ball_speed]
        exact = [*told[3:6], told[0], np.arctan2(-told[3], told[4]), np.hypot(told[3], told[4])]
        spins = scene.ball.radius * (np.array([*outcome.history.spin, outcome.spin]) - [*told[6:9], told[8]])
        assert imbalance(outcome) < CLOSED
        return float(np.abs([*(np.array(found) - exact), *spins]).max())

    falls_with_the_step(error)


def test_table_friction_of_a_head_on_slide():
    """Head on, the ball's lowest point slides forward throughout: f = -mu N, N = F sin(a), F cos(a) - f drives it."""
    angle, mu, e = 0.3, 0.15, 0.8
    scene = Scene(LumpedCue(0.5, 0.01), tip=Tip(e, 0.0, 1e-3), stroke=Stroke(1.0))
    outcome = strike(replace(scene, effects=(Elevation(angle, mu),)), Resolution(1, 1, 1, 1600))
    assert outcome.regime == "miscue"  # the tip slides over the ball in the vertical plane alone
    M, along = scene.ball.mass, cos(angle) - mu * sin(angle)
    impulse = (1 + e) / (1 / 0.5 + cos(angle) * along / M)
    assert abs(outcome.ball_speed / (impulse * along / M) - 1) < 1e-5
    follow = mu * sin(angle) * impulse / (scene.ball.inertia * M * scene.ball.radius)
    assert abs(outcome.history.spin[0] / -follow - 1) < 1e-5  # forward roll turns about -x
    slide = impulse * along / M - follow * scene.ball.radius  # of the lowest point, at the end; in proportion before
    assert abs(outcome.energy["table loss"] / (mu * sin(angle) * impulse * slide / 2) - 1) < 1e-5


def test_energy_closes_of_balls_that_hop() -> None:
    """Of random strikes on two modes some let the ball leave the table; none drives it through."""
    rng, up = np.random.default_rng(12), []
    for _ in range(20):
        omega, across = sorted(10 ** rng.uniform(2.5, 4.0, 2)), list(rng.normal(size=2) * 10)
        tip = hand_made(omega, across, rigid=rng.uniform(0.5, 10))
        law = Tip(rng.uniform(0.5, 1), rng.choice([0.7, 2.0, inf]), contact_time=10 ** rng.uniform(-3.5, -2.5))
        stroke, raised = Stroke(1.0, rng.uniform(-0.9, 0.9)), Elevation(rng.uniform(0.3, 1.5), 0.1)
        outcome = strike_modes(Scene(LumpedCue(0.54, 0.01), tip=law, stroke=stroke, effects=(raised,)), tip)
        assert imbalance(outcome) < 1e-5
        up.append(outcome.history.velocity[2])
    assert min(up) > -1e-9
    assert sum(value > 1e-6 for value in up) > 3


def test_a_ball_that_was_lifted_falls_back_onto_the_table() -> None:
    """A loud cue lifts the ball by friction; the table pushes where it lies, and does not hold it in the air."""
    tip = hand_made([8000.0], [15.0], rigid=1.0)
    law, stroke = Tip(0.8, 3.0, contact_time=3e-3), Stroke(1.0, 0.8)
    scene = Scene(LumpedCue(0.54, 0.01), tip=law, stroke=stroke, effects=(Elevation(0.7, 0.2),))
    model = model_of(scene, tip)
    steps = solve_contact(model).steps
    rising = np.append(0.0, steps["ball"][:, :3] @ model.axes[2])
    height = np.cumsum(steps["length"] * (rising[1:] + rising[:-1]) / 2)
    assert height.max() > 2e-5
    assert np.abs(height[steps["F"][:, 3] > 0]).max() < 1e-6
