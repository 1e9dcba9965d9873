"""Invalid strokes: calls, whose messages are stored in tests/golden/refused_contact.txt (bad input)."""

from dataclasses import replace
from math import inf, nan
from typing import Any

import pytest

import cuefem as cf
from cuefem.beam.tip_modes import lumped_tip_modes
from cuefem.contact.contact_model import model_of
from cuefem.contact.step_records import solve_contact
from cuefem.scene.solved_scene import default_mode_count
from studies.strokes import cue
from tests.helpers.invalid_input import assert_calls_refused
from tests.helpers.leather_scenes import leather_scene
from tests.helpers.strike_scenes import KIM, kim_scene

BALL, NORTH = cf.Ball(0.17, 0.0286), (0.0, 1.0, 0.0)
R = BALL.radius
GOOD = (0.3 * R, R)
PLANAR = cf.Scene(cf.LumpedCue(0.54, 0.004), BALL, cf.Tip(0.75, 0.7), cf.Stroke(2.0, 0.3))
RAISED = replace(PLANAR, effects=(cf.Elevation(0.1),))
HAMMER = cf.Striker(0.005, 0.8, contact_time=1e-3)
LUMPED = cf.Scene(cf.LumpedCue(0.54, 0.006, 3.0), stroke=cf.Stroke(offset=0.3))
BOUNCING = cf.Scene(cue("carbon"), tip=cf.Tip(0.85, inf, contact_time=1e-3), stroke=cf.Stroke(2.0, 0.82))
OFF_CENTRE = cf.Scene(cf.LumpedCue(0.54, 0.003), stroke=cf.Stroke(offset=0.3))


NAMES = {one.__name__: one for one in (default_mode_count, leather_scene, kim_scene)} | {"KIM": KIM, "inf": inf}


def placed(point: Any = GOOD, direction: Any = NORTH) -> cf.BallMotion:
    return cf.place(cf.impulse(PLANAR), point, direction, ball=BALL)


def struck(scene: cf.Scene, at: cf.Resolution | None = None, **changes: Any) -> cf.Outcome:
    return cf.strike(replace(scene, **changes), at)


def limited(limit: str, value: float, *effects: cf.Effect, scene: cf.Scene = OFF_CENTRE) -> cf.Outcome:
    """A strike with another limit of the package."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(f"cuefem.contact.{limit}", value)
        return cf.strike(replace(scene, effects=effects))


def strike_with_nan() -> object:
    scene = replace(OFF_CENTRE, effects=(cf.Elevation(0.2),))
    model = model_of(scene, lumped_tip_modes(scene.cue))
    model.ports.kinematics[2, 2] = nan  # out of the plane of the stroke
    return solve_contact(model)


@pytest.mark.filterwarnings("ignore::cuefem.PlausibilityWarning")
def test_contact_invalid_input_raises(request: pytest.FixtureRequest) -> None:
    assert_calls_refused("contact", globals() | NAMES, request)


@pytest.mark.filterwarnings("ignore::cuefem.PlausibilityWarning")
def test_strike_of_many_steps_is_accepted_below_its_limit(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("cuefem.contact.step_records.MAX_RECORDED_STEPS", 3000)
    assert cf.strike(replace(OFF_CENTRE, effects=(cf.SecondHit(2e-3),))) == cf.strike(OFF_CENTRE)
