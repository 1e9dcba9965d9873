"""Invalid input of `modes`: calls, whose messages are stored in tests/golden (bad input)."""

from __future__ import annotations

from collections.abc import Callable

import pytest

from cuefem import LumpedCue, Material, Resolution, Scene, end_mass, modes
from tests.helpers.cues import kim, rod
from tests.helpers.invalid_input import assert_refused, messages_of

CALLS: dict[str, Callable[[], object]] = {
    "no modes": lambda: modes(kim(), 0),
    "negative frequency": lambda: modes(kim(), near=-1.0),
    "frequency of a text": lambda: modes(kim(), near="250"),
    "9 modes of 3": lambda: modes(kim(), 9, at=Resolution(1, 1, 1)),
    "end mass of a cue as heavy as numbers": lambda: end_mass(Scene(rod(100.0, material=Material(1e10, 1e9, 1e308)))),
    "modes of a lumped cue": lambda: modes(LumpedCue(0.5, 0.01)),
    "shape off the cue": lambda: modes(kim(), 2).shape(0.8),
}


def test_modes_invalid_input_raises(request: pytest.FixtureRequest) -> None:
    assert_refused("beam", messages_of(CALLS), request)
