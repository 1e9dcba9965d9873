"""Invalid input of questions: calls, whose messages are stored in tests/golden (bad input)."""

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import pytest

import cuefem as cf
from tests.helpers.invalid_input import assert_refused, messages_of

SCENE = cf.Scene(cf.LumpedCue(0.54, 0.01), cf.Ball(0.17, 0.028575), cf.Tip(0.75, 0.6, 1e-3), cf.Stroke(offset=0.3))
SMOOTH = replace(SCENE, tip=cf.Tip(0.75, 0.0, 1e-3))
KIM = Path(__file__).parents[2] / "studies" / "scenes" / "kim.toml"
CALLS: dict[str, Callable[[], object]] = {
    "one cue": lambda: cf.compare({"alone": SCENE}),
    "a Cue to compare": lambda: cf.compare(cf.load("plain maple")),
    "a Cue among scenes": lambda: cf.compare({"mine": cf.load("plain maple"), "other": SCENE}),
    "glued joint": lambda: cf.natural_frequencies(SCENE, joint="glued"),
    "no modes": lambda: cf.convergence_study(SCENE, max_modes=0),
    "accuracy of 0": lambda: cf.effect_sensitivity(SCENE, 0.0),
    "accuracy without a number": lambda: cf.effect_sensitivity(SCENE, float("nan")),
    "tone of 0": lambda: cf.reduction(cf.load(KIM), near=0.0),
    "negative cue end": lambda: cf.reduction(SCENE, cue_ends={"a": -0.01}),
    "cue end above the mass": lambda: cf.reduction(SCENE, cue_ends={"a": 0.6}),
    "offset of 1": lambda: cf.reduction(SCENE, offsets=(0.1, 1.0)),
    "no offsets": lambda: cf.reduction(SCENE, offsets=()),
    "no offsets of a curve": lambda: cf.squirt_curve(SCENE, ()),
    "speeds descending": lambda: cf.strike_table(SCENE, (4.0, 1.0)),
    "speed of 0": lambda: cf.strike_table(SCENE, (0.0, 1.0)),
    "table of a smooth tip": lambda: cf.strike_table(SMOOTH, (1.0, 4.0)),
    "verdict of a smooth tip": lambda: cf.verdict(SMOOTH),
    "curve saved as PDF": lambda: cf.squirt_curve(SCENE, (0.3,)).save("x.pdf"),
}


def test_question_invalid_input_raises(request: pytest.FixtureRequest) -> None:
    assert_refused("analysis", messages_of(CALLS), request)
