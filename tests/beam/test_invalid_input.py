"""Invalid input of `modes`: calls, whose messages are stored in tests/golden/refused_beam.txt (bad input)."""

import pytest

from tests.helpers.cues import kim, rod
from tests.helpers.invalid_input import assert_calls_refused


def test_modes_invalid_input_raises(request: pytest.FixtureRequest) -> None:
    assert_calls_refused("beam", {"kim": kim, "rod": rod}, request)
