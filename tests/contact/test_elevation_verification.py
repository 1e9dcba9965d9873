"""A raised cue against a closed form, and balls that hop; against small steps: test_independent_effects.py."""

from dataclasses import replace
from math import cos, inf, sin

import numpy as np
import pytest

from cuefem import Elevation, LumpedCue, Resolution, Scene, Stroke, Tip, strike
from cuefem.contact.model import model_of
from cuefem.contact.step_records import solve_contact
from cuefem.contact.strike import strike_modes
from tests.helpers.strike_scenes import hand_made, imbalance

pytestmark = pytest.mark.kernel


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
