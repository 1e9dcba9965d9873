"""Invalid cues: calls, whose messages are stored in tests/golden/refused_cue.txt (bad input)."""

from dataclasses import replace
from math import nan

import pytest

import cuefem as cf
from tests.helpers.cues import MAPLE, kim
from tests.helpers.invalid_input import assert_calls_refused

NAMES = {"PIECE": cf.Segment(0.7, 0.012, 0.021, MAPLE), "MAPLE": MAPLE, "replace": replace, "kim": kim, "nan": nan}


def test_cue_invalid_input_raises(request: pytest.FixtureRequest) -> None:
    assert_calls_refused("cue", NAMES, request)
