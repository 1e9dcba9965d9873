"""Invalid input of questions: each call with a part of its error message (bad input)."""

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import pytest

import cuefem as cf
from tests.helpers.invalid_input import assert_raises

SCENE = cf.Scene(cf.LumpedCue(0.54, 0.01), cf.Ball(0.17, 0.028575), cf.Tip(0.75, 0.6, 1e-3), cf.Stroke(offset=0.3))
SMOOTH = replace(SCENE, tip=cf.Tip(0.75, 0.0, 1e-3))
KIM = Path(__file__).parents[2] / "studies" / "scenes" / "kim.toml"
CALLS: dict[str, Callable[[], object]] = {
    "2 to 5 cues; got 1": lambda: cf.compare({"alone": SCENE}),
    "max_modes must be a whole number >= 1": lambda: cf.convergence_study(SCENE, max_modes=0),
    "effect_sensitivity rtol must be in (0, 1); got 0.0": lambda: cf.effect_sensitivity(SCENE, 0.0),
    "effect_sensitivity rtol must be in (0, 1); got nan": lambda: cf.effect_sensitivity(SCENE, float("nan")),
    "reduction near must be in (0, inf) Hz; got 0.0": lambda: cf.reduction(cf.load(KIM), near=0.0),
    "reduction cue_ends['a'] must be in (0, 0.54] kg; got -0.01": lambda: cf.reduction(SCENE, cue_ends={"a": -0.01}),
    "reduction cue_ends['a'] must be in (0, 0.54] kg; got 0.6": lambda: cf.reduction(SCENE, cue_ends={"a": 0.6}),
    "Stroke.offset must be in (-1, 1); got 1.0": lambda: cf.reduction(SCENE, offsets=(0.1, 1.0)),
    "reduction offsets must be at least one b/R between -1 and 1; got none": lambda: cf.reduction(SCENE, offsets=()),
    "squirt_curve offsets must be at least one b/R between -1 and 1; got none": lambda: cf.squirt_curve(SCENE, ()),
    "speeds must ascend, the lowest before the highest; got 4 and 1 m/s": lambda: cf.strike_table(SCENE, (4.0, 1.0)),
    "Stroke.speed must be in (0, inf) m/s": lambda: cf.strike_table(SCENE, (0.0, 1.0)),
    "tip must hold the ball off its centre; got a friction of 0": lambda: cf.strike_table(SMOOTH, (1.0, 4.0)),
    "no squirt is reported. Raise friction from 0": lambda: cf.verdict(SMOOTH),
    "must end in .html or .json": lambda: cf.squirt_curve(SCENE, (0.3,)).save("x.pdf"),
}


@pytest.mark.parametrize("message", CALLS)
def test_question_invalid_input_raises(message: str) -> None:
    assert_raises(CALLS[message], message)
