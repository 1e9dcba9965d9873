"""What a stroke refuses: calls, each with a part of the one line that names field, bound, unit and value."""

from collections.abc import Callable
from math import inf, nan
from typing import Any

import numpy as np
import pytest

from cuefem import (
    Ball,
    Cue,
    LumpedCue,
    Material,
    Scene,
    Segment,
    Stroke,
    Tip,
    TipShear,
    impulse,
    leather_modulus,
    strike,
)
from tests.helpers.leather_scenes import leather_scene
from tests.helpers.refusals import refuses

TWO: Any = np.array([1.0, 2.0])
MAKERS = {
    "LumpedCue.mass": lambda x: LumpedCue(x, 0.003),
    "LumpedCue.end_mass": lambda x: LumpedCue(0.54, x),
    "LumpedCue.coupling": lambda x: LumpedCue(0.54, 0.003, x),
    "Ball.mass": lambda x: Ball(mass=x),
    "Ball.radius": lambda x: Ball(radius=x),
    "Ball.inertia": lambda x: Ball(inertia=x),
    "Tip.restitution": lambda x: Tip(restitution=x),
    "Tip.friction": lambda x: Tip(friction=x),
    "Stroke.speed": lambda x: Stroke(speed=x),
    "Stroke.offset": lambda x: Stroke(offset=x),
}
BOUNDS = {
    "LumpedCue.mass": "(0, inf) kg",
    "LumpedCue.end_mass": "(0, inf) kg",
    "LumpedCue.coupling": "(-inf, inf) 1/kg",
    "Ball.mass": "(0, inf) kg",
    "Ball.radius": "(0, inf) m",
    "Ball.inertia": "(0, 1]",
    "Tip.restitution": "[0, 1]",
    "Tip.friction": "[0, inf]",
    "Stroke.speed": "(0, inf) m/s",
    "Stroke.offset": "(-1, 1)",
}
WRONG = {
    "LumpedCue.mass": [nan, inf, 0.0, -0.5],
    "LumpedCue.end_mass": [nan, inf, 0.0, -1e-3],
    "LumpedCue.coupling": [nan, inf, -inf],
    "Ball.mass": [nan, inf, 0.0, -0.2],
    "Ball.radius": [nan, inf, 0.0, -0.03],
    "Ball.inertia": [nan, inf, 0.0, 1.1],
    "Tip.restitution": [nan, inf, -0.1, 1.0000001],
    "Tip.friction": [nan, -inf, -1e-9],
    "Stroke.speed": [nan, inf, 0.0, -1.0],
    "Stroke.offset": [nan, inf, 1.0, -1.0, 1.5],
}
CASES = [(field, value) for field, values in WRONG.items() for value in values]
GOOD = {"LumpedCue.coupling": 0.0, "Stroke.offset": 0.2}
SHAFT = Cue((Segment(0.7, 0.0125, 0.021, Material(12.6e9, 0.84e9, 700.0)),), body_mass=0.4)
THREE_SHAPES = Scene(
    LumpedCue(0.54, np.full(3, 0.003)), Ball(), Tip(0.75, np.full((2, 1), 0.7)), Stroke(1.0, np.zeros(4))
)
CALLS: list[tuple[Callable[[], object], str]] = [
    *[
        (lambda f=field, v=value: MAKERS[f](v), f"TypeError: {field} must be a number in {BOUNDS[field]}; got ")
        for field in MAKERS
        for value in ("0.5", None, True, [0.5, "x"], {})
    ],
    (lambda: LumpedCue(0.25, 0.25, 4.0), "LumpedCue.coupling must be in (-4.0, 4.0) 1/kg; got 4.0"),
    (
        lambda: LumpedCue(np.array([0.25, 1.0]), 0.25, np.array([2.0, -2.5])),
        "LumpedCue.coupling must be in (-2.0, 2.0) 1/kg; got -2.5 at index 1",
    ),
    (
        lambda: impulse(THREE_SHAPES),
        "array fields of a scene must broadcast together; got shapes LumpedCue.end_mass (3,), Tip.friction (2, 1), "
        "Stroke.offset (4,)",
    ),
    (
        lambda: impulse(Scene(LumpedCue(np.ones(2), np.ones(3)))),
        "got shapes LumpedCue.mass (2,), LumpedCue.end_mass (3,)",
    ),
    (
        lambda: impulse(Scene(SHAFT, Ball(mass=np.array([0.17, 0.21])))),
        "must be one number; got an array of shape (2,)",
    ),
    (lambda: impulse(Scene(SHAFT, tip=Tip(np.array([0.7, 0.8])))), "Tip.restitution must be one number"),
    (lambda: Scene("cue"), "TypeError: Scene.cue must be a Cue or LumpedCue; got 'cue'"),
    (lambda: Scene(LumpedCue(0.5, 0.003), tip=0.7), "TypeError: Scene.tip must be a Tip"),
    (
        lambda: impulse(Scene(LumpedCue(0.54, 0.005), effects=(TipShear(0.75),))),
        "impulse takes a LumpedCue without effects",
    ),
    (lambda: strike(leather_scene(speed=TWO)), "Stroke.speed must be one number; got an array of shape (2,)"),
    (lambda: strike(leather_scene(e=TWO / 4)), "Tip.restitution must be one number; got an array of shape (2,)"),
    (lambda: leather_modulus(leather_scene(), TWO), "leather_modulus contact_time must be one number; got an array"),
    (lambda: strike(leather_scene(e=0.05)), "LeatherTip; got 0.05: leather that gives back less rings on"),
    (lambda: strike(leather_scene(speed=60.0)), "mm): give LeatherTip a larger height or E, or Stroke a lower speed"),
]


@pytest.mark.parametrize(("ask", "message"), CALLS)
def test_calls(ask: Callable[[], object], message: str) -> None:
    refuses(ask, message)


@pytest.mark.parametrize(("field", "value"), CASES)
def test_numbers_out_of_bounds(field: str, value: float) -> None:
    """The whole line; of an array the first index."""
    fine, message = GOOD.get(field, 0.5), f"{field} must be in {BOUNDS[field]}; got {value}"
    for given, where in (
        (value, ""),
        (np.array([fine, fine, value, value]), " at index 2"),
        (np.array([[fine, fine], [value, fine]]), " at index (1, 0)"),
    ):
        with pytest.raises(ValueError, match=r".*") as refused:
            MAKERS[field](given)
        assert str(refused.value) == message + where


def test_what_is_just_allowed() -> None:
    assert impulse(Scene(LumpedCue(1, 1), Ball(1, 1, 1), Tip(0, inf), Stroke(1, 0))).cue_speed == 0.5
