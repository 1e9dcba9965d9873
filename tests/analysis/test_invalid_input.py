"""Invalid input of questions: calls, whose messages are stored in tests/golden (bad input)."""

from dataclasses import replace
from pathlib import Path

import pytest

import cuefem as cf
from tests.helpers.invalid_input import assert_calls_refused

SCENE = cf.Scene(cf.LumpedCue(0.54, 0.01), cf.Ball(0.17, 0.028575), cf.Tip(0.75, 0.6, 1e-3), cf.Stroke(offset=0.3))
SMOOTH = replace(SCENE, tip=cf.Tip(0.75, 0.0, 1e-3))
KIM = Path(__file__).parents[2] / "studies" / "scenes" / "kim.toml"


def test_question_invalid_input_raises(request: pytest.FixtureRequest) -> None:
    assert_calls_refused("analysis", globals(), request)
