"""What `end_mass` refuses: calls, each with a part of the one line that says why."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from cuefem import Ball, end_mass
from tests.helpers.cues import kim, scene
from tests.helpers.refusals import refuses

SCENE = scene(kim(), 1e-3)
TWO_BALLS = replace(SCENE, ball=Ball(mass=np.array([0.17, 0.21])))
CALLS: list[tuple[Callable[[], object], str]] = [
    (
        lambda: end_mass(SCENE, "push"),  # type: ignore[arg-type]
        "end_mass drive must be one of stick, offset, velocity, force, squirt; got 'push'",
    ),
    (lambda: end_mass(TWO_BALLS), "Ball.mass must be one number; got an array of shape"),
]


@pytest.mark.parametrize(("ask", "message"), CALLS, ids=[message for _, message in CALLS])
def test_calls(ask: Callable[[], object], message: str) -> None:
    refuses(ask, message)
