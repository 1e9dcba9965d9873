"""Invalid input of `modes`: each call with a part of its error message (bad input)."""

from __future__ import annotations

from collections.abc import Callable

import pytest

from cuefem import LumpedCue, Resolution, modes
from tests.helpers.cues import kim
from tests.helpers.invalid_input import assert_raises

CALLS: list[tuple[Callable[[], object], str]] = [
    (lambda: modes(kim(), 0), "modes count must be a whole number >= 1; got 0"),
    (lambda: modes(kim(), near=-1.0), "modes near must be in [0, inf) Hz; got -1.0"),
    (lambda: modes(kim(), near="250"), "TypeError: modes near must be a number"),
    (lambda: modes(kim(), 9, at=Resolution(1, 1, 1)), "modes count must be at most 3 on this mesh; got 9"),
    (lambda: modes(LumpedCue(0.5, 0.01)), "TypeError: modes cue must be a Cue; got a LumpedCue"),
    (lambda: modes(kim(), 2).shape(0.8), "Modes.shape takes positions in [0, 0.7] m"),
]


@pytest.mark.parametrize(("call", "message"), CALLS, ids=[message for _, message in CALLS])
def test_modes_invalid_input_raises(call: Callable[[], object], message: str) -> None:
    assert_raises(call, message)
