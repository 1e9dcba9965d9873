"""What a stroke refuses: the error names field, bound, unit and value, and in arrays the first index."""

from math import inf, nan
from re import escape

import numpy as np
import pytest

from cuefem import Ball, Cue, LumpedCue, Material, Scene, Segment, Stroke, Tip, TipShear, impulse

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


@pytest.mark.parametrize(("field", "value"), CASES)
def test_a_wrong_number(field, value):
    with pytest.raises(ValueError, match="^" + escape(f"{field} must be in {BOUNDS[field]}; got {value}") + "$"):
        MAKERS[field](value)


@pytest.mark.parametrize(("field", "value"), CASES)
def test_the_first_wrong_number_of_an_array(field, value):
    fine = GOOD.get(field, 0.5)
    message = escape(f"{field} must be in {BOUNDS[field]}; got {value} at index ")
    with pytest.raises(ValueError, match=message + "2$"):
        MAKERS[field](np.array([fine, fine, value, value]))
    with pytest.raises(ValueError, match=message + r"\(1, 0\)$"):
        MAKERS[field](np.array([[fine, fine], [value, fine]]))


@pytest.mark.parametrize("field", MAKERS)
@pytest.mark.parametrize("value", ["0.5", None, True, [0.5, "x"], {}])
def test_no_number_at_all(field, value):
    with pytest.raises(TypeError, match=escape(f"{field} must be a number in {BOUNDS[field]}; got ")):
        MAKERS[field](value)


def test_a_coupling_that_is_no_mass():
    with pytest.raises(ValueError, match=r"LumpedCue.coupling must be in \(-4.0, 4.0\) 1/kg; got 4.0$"):
        LumpedCue(0.25, 0.25, 4.0)
    with pytest.raises(ValueError, match=r"LumpedCue.coupling must be in \(-2.0, 2.0\) 1/kg; got -2.5 at index 1$"):
        LumpedCue(np.array([0.25, 1.0]), 0.25, np.array([2.0, -2.5]))


def test_what_is_allowed():
    out = impulse(Scene(LumpedCue(1, 1), Ball(1, 1, 1), Tip(0, inf), Stroke(1, 0)))
    assert out.cue_speed == 0.5


def test_arrays_that_do_not_fit_together():
    scene = Scene(LumpedCue(0.54, np.full(3, 0.003)), Ball(), Tip(0.75, np.full((2, 1), 0.7)), Stroke(1.0, np.zeros(4)))
    message = (
        "array fields of a scene must broadcast together; got shapes LumpedCue.end_mass (3,), Tip.friction (2, 1), "
    )
    with pytest.raises(ValueError, match=escape(message + "Stroke.offset (4,)") + "$"):
        impulse(scene)
    with pytest.raises(ValueError, match=r"LumpedCue\.mass \(2,\), LumpedCue\.end_mass \(3,\)"):
        impulse(Scene(LumpedCue(np.ones(2), np.ones(3))))


def test_a_finite_element_cue_has_one_ball_and_one_restitution():
    maple = Material(12.6e9, 0.84e9, 700.0)
    cue = Cue((Segment(0.7, 0.0125, 0.021, maple),), body_mass=0.4)
    with pytest.raises(ValueError, match=r"must be one number; got an array of shape \(2,\)"):
        impulse(Scene(cue, Ball(mass=np.array([0.17, 0.21]))))
    with pytest.raises(ValueError, match=r"Tip\.restitution must be one number"):
        impulse(Scene(cue, tip=Tip(np.array([0.7, 0.8]))))


def test_a_scene_of_the_wrong_things():
    with pytest.raises(TypeError, match=r"Scene\.cue must be a Cue or LumpedCue; got 'cue'"):
        Scene("cue")
    with pytest.raises(TypeError, match=r"Scene\.tip must be a Tip"):
        Scene(LumpedCue(0.5, 0.003), tip=0.7)


def test_effects_on_a_lumped_cue_are_refused() -> None:
    scene = Scene(LumpedCue(0.54, 0.005), effects=(TipShear(0.75),))
    with pytest.raises(ValueError, match=r"impulse takes a LumpedCue without effects.*got TipShear"):
        impulse(scene)
