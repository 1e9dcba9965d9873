"""Invalid strokes: calls, whose messages are stored in tests/golden/refused_contact.txt (bad input)."""

from collections.abc import Callable
from dataclasses import replace
from math import inf, nan
from pathlib import Path
from typing import Any

import pytest

import cuefem as cf
from cuefem.beam.tip_modes import lumped_tip_modes
from cuefem.contact.contact_model import model_of
from cuefem.contact.step_records import solve_contact
from cuefem.scene.solved_scene import default_mode_count
from tests.helpers.invalid_input import assert_refused, messages_of
from tests.helpers.leather_scenes import leather_scene
from tests.helpers.strike_scenes import KIM, kim_scene

BALL, NORTH = cf.Ball(0.17, 0.0286), (0.0, 1.0, 0.0)
R = BALL.radius
GOOD = (0.3 * R, R)
PLANAR = cf.Scene(cf.LumpedCue(0.54, 0.004), BALL, cf.Tip(0.75, 0.7), cf.Stroke(2.0, 0.3))
RAISED = replace(PLANAR, effects=(cf.Elevation(0.1),))
HAMMER = cf.Striker(0.005, 0.8, contact_time=1e-3)
LUMPED = cf.Scene(cf.LumpedCue(0.54, 0.006, 3.0), stroke=cf.Stroke(offset=0.3))
CARBON = cf.load(Path(__file__).parents[2] / "meshes" / "carbon.toml")
BOUNCING = cf.Scene(CARBON, tip=cf.Tip(0.85, inf, contact_time=1e-3), stroke=cf.Stroke(2.0, 0.82))
OFF_CENTRE = cf.Scene(cf.LumpedCue(0.54, 0.003), stroke=cf.Stroke(offset=0.3))


def place_call(point: Any = GOOD, direction: Any = NORTH, ball: cf.Ball = BALL) -> Callable[[], object]:
    return lambda: cf.place(cf.impulse(PLANAR), point, direction, ball=ball)


def strike_call(scene: cf.Scene, at: cf.Resolution | None = None, **changes: Any) -> Callable[[], object]:
    return lambda: cf.strike(replace(scene, **changes), at)


def limited(limit: str, value: float, call: Callable[[], object]) -> Callable[[], object]:
    """The call with another limit of the package."""

    def limited_call() -> object:
        with pytest.MonkeyPatch.context() as patch:
            patch.setattr(f"cuefem.contact.{limit}", value)
            return call()

    return limited_call


def strike_with_nan() -> object:
    scene = replace(OFF_CENTRE, effects=(cf.Elevation(0.2),))
    model = model_of(scene, lumped_tip_modes(scene.cue))
    model.ports.kinematics[2, 2] = nan  # out of the plane of the stroke
    return solve_contact(model)


def wait_for_second_hit() -> object:
    return cf.strike(replace(OFF_CENTRE, effects=(cf.SecondHit(1.0),)))


CALLS: dict[str, Callable[[], object]] = {
    "coupling of two masses": lambda: cf.LumpedCue(0.25, 0.25, 4.0),
    "strike of a number": lambda: cf.strike(3),
    "impulse of a number": lambda: cf.impulse(3),
    "shaft of a lumped cue": lambda: LUMPED.shaft,
    "modes of a lumped cue": lambda: default_mode_count(LUMPED),
    "scene of a text": lambda: cf.Scene("cue"),
    "tip of a number": lambda: cf.Scene(cf.LumpedCue(0.5, 0.003), tip=0.7),
    "impulse with an effect": lambda: cf.impulse(replace(LUMPED, effects=(cf.TipShear(0.75),))),
    "head-on contact of a stiff tip": lambda: default_mode_count(cf.Scene(KIM, tip=cf.Tip(stiffness=1e16))),
    # strikes
    "restitution of leather": strike_call(leather_scene(e=0.05)),
    "leather struck too fast": strike_call(leather_scene(speed=60.0)),
    "restitution of a raised cue": strike_call(kim_scene(restitution=0.049), effects=(cf.Elevation(0.1),)),
    "second hit without slip": strike_call(kim_scene(friction=inf), effects=(cf.SecondHit(),)),
    "no modes": lambda: cf.Resolution(4, 8, 0),
    "few steps": lambda: cf.Resolution(1, 1, 1, 19),
    "more modes than elements give": strike_call(kim_scene(), cf.Resolution(2, 3, 500)),
    "history before contact": lambda: cf.strike(kim_scene(), cf.Resolution(2, 8, 4)).history(-1e-9),
    "bounces without an end": limited(
        "step_records.BOUNCE_RESIDUAL", 0.0, strike_call(BOUNCING, effects=(cf.TipDome(0.0095),))
    ),
    "no separation": limited("contact_model.MAX_CONTACT_TIMES", 0.3, strike_call(OFF_CENTRE)),
    "too many steps": limited("step_records.MAX_RECORDED_STEPS", 3000, wait_for_second_hit),
    "force without a number": strike_with_nan,
    # many strikes
    "impulse of a scene and a number": lambda: cf.impulse([kim_scene(), 3]),
    "batch of one scene": lambda: cf.batch_strike(kim_scene()),
    "batch of a scene and a number": lambda: cf.batch_strike([kim_scene(), 3]),
    "batch of none": lambda: cf.batch_strike([]),
    "batch with a dead tip": lambda: cf.batch_strike([kim_scene(), kim_scene(restitution=0.0)]),
    # a measured impact
    "contact time of 0": lambda: cf.identify_tip(leather_scene(), 0.0, 0.73),
    "rebound above 1": lambda: cf.identify_tip(leather_scene(), 1e-3, 1.1),
    "tip without leather": lambda: cf.identify_tip(kim_scene(), 1e-3, 0.73),
    # a strike from the side
    "striker without a law": lambda: cf.Striker(0.02, 0.8),
    "striker of modulus alone": lambda: cf.Striker(0.02, 0.8, modulus=1e9),
    "striker of no mass": lambda: cf.Striker(nan, 0.8, stiffness=1e5),
    "side strike off the cue": lambda: cf.SideStrike(KIM, HAMMER, 0.71),
    "side strike of a lumped cue": lambda: cf.SideStrike(LUMPED.cue, HAMMER),
    "side strike with one effect": lambda: cf.SideStrike(KIM, HAMMER, effects=cf.PointMass(position=0.1, mass=1e-3)),
    "side strike with a dome": lambda: cf.SideStrike(KIM, HAMMER, effects=(cf.TipDome(0.01),)),
    "side strike of a cue": lambda: cf.side_strike(KIM),
    "side strike of a stiff striker": lambda: cf.side_strike(cf.SideStrike(KIM, cf.Striker(0.02, 1.0, stiffness=1e15))),
    "strike of a side strike": lambda: cf.strike(cf.SideStrike(KIM, HAMMER)),
    # the table's frame
    "point above the ball": place_call((R, 1.5 * R)),
    "point that is no number": place_call((nan, R)),
    "infinite direction": place_call(direction=(0, inf, 0)),
    "direction of no length": place_call(direction=(0, 0, 0)),
    "direction of 2 components": place_call(direction=(0, 1)),
    "point of 3 components": place_call((1.0, 2.0, 3.0)),
    "point behind the ball": place_call((0.0, 0.0)),
    "point of another offset": place_call((0.31 * R, R)),
    "place of a raised cue": lambda: cf.place(cf.strike(RAISED), GOOD, NORTH),
}
WAVES = leather_scene(0.0, cf.AxialWaves())
IMPACTS: dict[str, Callable[[], object]] = {
    "long contact": lambda: cf.identify_tip(leather_scene(), 9e-3, 0.73),
    "short contact": lambda: cf.identify_tip(WAVES, 0.5e-3, 0.73),
    "high rebound": lambda: cf.identify_tip(WAVES, 1.1e-3, 0.999),
}


@pytest.mark.filterwarnings("ignore::cuefem.PlausibilityWarning")
def test_contact_invalid_input_raises(request: pytest.FixtureRequest) -> None:
    assert_refused("contact", messages_of(CALLS), request)


@pytest.mark.heavy
def test_measured_impact_of_no_leather_raises(request: pytest.FixtureRequest) -> None:
    assert_refused("impacts", messages_of(IMPACTS), request, exact=False)


@pytest.mark.filterwarnings("ignore::cuefem.PlausibilityWarning")
def test_strike_of_many_steps_is_accepted_below_its_limit(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("cuefem.contact.step_records.MAX_RECORDED_STEPS", 3000)
    assert cf.strike(replace(OFF_CENTRE, effects=(cf.SecondHit(2e-3),))) == cf.strike(OFF_CENTRE)
