"""Invalid strokes: each call with a part of the message, which states field, bound, unit and value (bad input)."""

from collections.abc import Callable
from dataclasses import replace
from math import inf, nan
from typing import Any

import pytest

import cuefem as cf
from cuefem.beam.tip_modes import lumped_tip_modes
from cuefem.contact.contact_model import model_of
from cuefem.contact.step_records import solve_contact
from cuefem.scene.solved_scene import default_mode_count
from tests.helpers.invalid_input import assert_raises
from tests.helpers.leather_scenes import leather_scene
from tests.helpers.strike_scenes import kim_scene


def identify_call(contact_time: float, rebound: float) -> Callable[[], object]:
    return lambda: cf.identify_tip(leather_scene(0.0, cf.AxialWaves()), contact_time, rebound)


BALL, NORTH = cf.Ball(0.17, 0.0286), (0.0, 1.0, 0.0)
R = BALL.radius
GOOD = (0.3 * R, R)
PLANAR = cf.Scene(cf.LumpedCue(0.54, 0.004), BALL, cf.Tip(0.75, 0.7), cf.Stroke(2.0, 0.3))
RAISED = replace(PLANAR, effects=(cf.Elevation(0.1),))
LUMPED = cf.Scene(cf.LumpedCue(0.54, 0.006, 3.0), stroke=cf.Stroke(offset=0.3))
DEAD = "Tip.restitution must be in [0.05, 1] for a contact computed in time; got "


def place_call(point: Any = GOOD, direction: Any = NORTH, ball: cf.Ball = BALL) -> Callable[[], object]:
    return lambda: cf.place(cf.impulse(PLANAR), point, direction, ball=ball)


def strike_call(scene: cf.Scene, at: cf.Resolution | None = None, **changes: Any) -> Callable[[], object]:
    return lambda: cf.strike(replace(scene, **changes), at)


def heavy(call: Callable[[], object], message: str) -> Any:
    return pytest.param(call, message, marks=pytest.mark.heavy)


CALLS: list[Any] = [
    (lambda: cf.LumpedCue(0.25, 0.25, 4.0), "LumpedCue.coupling must be in (-4.0, 4.0) 1/kg; got 4.0"),
    (lambda: cf.strike(3), "TypeError: strike scene must be a Scene; got 3"),
    (lambda: cf.impulse(3), "TypeError: impulse scene must be a sequence of Scene; got 3"),
    *((call, "must be a Cue of segments: ") for call in (lambda: LUMPED.shaft, lambda: default_mode_count(LUMPED))),
    (lambda: cf.Scene("cue"), "TypeError: Scene.cue must be a Cue or LumpedCue; got 'cue'"),
    (lambda: cf.Scene(cf.LumpedCue(0.5, 0.003), tip=0.7), "TypeError: Scene.tip must be a Tip"),
    (lambda: cf.impulse(replace(LUMPED, effects=(cf.TipShear(0.75),))), "impulse scene must have no effects on a Lump"),
    # strikes
    (strike_call(leather_scene(e=0.05)), "Tip.restitution must be in [0.1, 1] for a contact"),
    (strike_call(leather_scene(speed=60.0)), "mm); raise height or E of the leather, or lower the speed"),
    (strike_call(kim_scene(restitution=0.049), effects=(cf.Elevation(0.1),)), f"{DEAD}0.049"),
    (strike_call(kim_scene(friction=inf), effects=(cf.SecondHit(),)), "Tip.friction must be finite beside SecondHit"),
    (lambda: cf.Resolution(4, 8, 0), "Resolution.modes"),
    (lambda: cf.Resolution(1, 1, 1, 19), "Resolution.steps must be a whole number in [20, 1000000]; got 19"),
    (strike_call(kim_scene(), cf.Resolution(2, 3, 500)), "use more elements"),
    (lambda: cf.strike(kim_scene(), cf.Resolution(2, 8, 4)).history(-1e-9), "History takes times in [0, "),
    # many strikes
    (lambda: cf.impulse([kim_scene(), 3]), "TypeError: impulse scene must be a Scene"),
    (lambda: cf.batch_strike(kim_scene()), "TypeError: batch_strike scenes must be a sequence of Scene; got one"),
    (lambda: cf.batch_strike([kim_scene(), 3]), "TypeError: batch_strike scenes must be a Scene"),
    (lambda: cf.batch_strike([]), "batch_strike scenes must be one scene or more; got none"),
    (lambda: cf.batch_strike([kim_scene(), kim_scene(restitution=0.0)]), "scene 1: " + DEAD),
    # a measured impact
    (lambda: cf.identify_tip(leather_scene(), 0.0, 0.73), "identify_tip contact_time must be in [1e-6, 10] s; got 0"),
    (lambda: cf.identify_tip(leather_scene(), 1e-3, 1.1), "identify_tip rebound must be in [0.1, 1]; got 1.1"),
    (lambda: cf.identify_tip(kim_scene(), 1e-3, 0.73), "Scene.effects must hold a LeatherTip; got none"),
    heavy(lambda: cf.identify_tip(leather_scene(), 9e-3, 0.73), "no leather has a contact time of 0.009 s"),
    heavy(identify_call(0.5e-3, 0.73), "no leather has a contact time of 0.0005 s"),
    heavy(identify_call(1.1e-3, 0.999), "no leather has a contact time of 0.0011 s and a rebound of 0.999"),
    # the table's frame
    (place_call((R, 1.5 * R)), "R = 0.0286 m; got (0.0286, 0.0429"),
    (place_call((nan, R)), "point[0] must be in (-inf, inf) m; got nan"),
    (place_call(direction=(0, inf, 0)), "direction[1] must be in (-inf, inf); got inf"),
    (place_call(direction=(0, 0, 0)), "direction must have a non-zero length; got (0, 0, 0)"),
    (place_call(direction=(0, 1)), "direction must have 3 components"),
    (place_call((1.0, 2.0, 3.0)), "point must have 2 components"),
    (place_call((0.0, 0.0)), "point must be on the side of the ball that the direction meets, less than 90 degrees"),
    (place_call((0.31 * R, R)), "0.31 or -0.31; got one at 0.3"),
    (
        lambda: cf.place(cf.strike(RAISED), GOOD, NORTH),
        "place takes planar outcomes; after Elevation use outcome.history.velocity and .spin",
    ),
]


@pytest.mark.parametrize(("call", "message"), CALLS)
def test_contact_invalid_input_raises(call: Callable[[], object], message: str) -> None:
    assert_raises(call, message)


def test_strike_without_separation_raises_with_its_state(monkeypatch) -> None:
    monkeypatch.setattr("cuefem.contact.contact_model.MAX_CONTACT_TIMES", 0.3)
    message = (
        r"does not leave the cue: after .* s \(head-on contact time .* s\) the tip is indented by .* m, in stick; check"
    )
    with pytest.raises(RuntimeError, match=message):
        cf.strike(cf.Scene(cf.LumpedCue(0.54, 0.003), stroke=cf.Stroke(offset=0.3)))


@pytest.mark.filterwarnings("ignore::cuefem.PlausibilityWarning")
def test_strike_of_too_many_steps_raises(monkeypatch) -> None:
    monkeypatch.setattr("cuefem.contact.step_records.MAX_RECORDED_STEPS", 3000)
    once = cf.Scene(cf.LumpedCue(0.54, 0.003), stroke=cf.Stroke(offset=0.3))
    assert cf.strike(replace(once, effects=(cf.SecondHit(2e-3),))) == cf.strike(once)
    with pytest.raises(RuntimeError, match=r"the strike takes more than 3000 steps of 5e-06 s, for"):
        cf.strike(replace(once, effects=(cf.SecondHit(1.0),)))


def test_strike_with_nan_force_raises_in_its_step() -> None:
    scene = cf.Scene(cf.LumpedCue(0.54, 0.003), stroke=cf.Stroke(offset=0.3), effects=(cf.Elevation(0.2),))
    model = model_of(scene, lumped_tip_modes(scene.cue))
    model.ports.kinematics[2, 2] = nan  # out of the plane of the stroke
    with pytest.raises(RuntimeError, match=r"the forces of the contact have no solution after .* s and 1 steps"):
        solve_contact(model)
