"""What the closed forms refuse: calls, each with a part of the one line that names the condition and the numbers."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest

from studies.paper import closed_forms as squirt
from tests.helpers.refusals import refuses


def stroke(**changes: object) -> Callable[[], object]:
    """The closed form of Kim's cue at b/R 0.5, with some numbers changed."""
    return lambda: squirt.closed_form(**({"offset": 0.5, "mass": 0.54, "end_mass": 0.003} | changes))  # type: ignore[arg-type]


CALLS: list[tuple[Callable[[], object], str]] = [
    (stroke(friction=0.5), " for slip to end at offset 0.5; got 0.5"),
    (stroke(friction=0.55), "p_s <= p_c = 0.437"),
    (stroke(friction=0.55), " M U with friction 0.55 at offset 0.5"),
    (stroke(end_mass=10.0, mass=0.1, offset=0.4, friction=0.19), "friction must be >= -mu_c = 0."),
    (stroke(end_mass=10.0, mass=0.1, offset=0.4, friction=0.19), " or slip rev"),
    (stroke(offset=np.array([[0.1, 0.2], [0.95, 0.3]])), " at index (1, 0)"),
    (stroke(offset=1.0), "offset must be in (-1, 1); got 1.0"),
    (stroke(offset=np.nan), "offset must be in (-1, 1); got nan"),
    (stroke(restitution=1.5), "restitution must be in [0, 1]; got 1.5"),
    (stroke(friction=-0.1), "friction must be in [0, inf]; got -0.1"),
    (stroke(mass=0.0), "mass must be in (0, inf) kg; got 0.0"),
    (stroke(end_mass=np.array([1.0, -1.0])), "end_mass must be in (0, inf) kg; got -1.0 at index 1"),
    (lambda: squirt.first_order_coefficients(0.0, cue_mass_ratio=2.0), "pole"),
    (
        lambda: squirt.natural_pivot_length([0.1, 0.0], 0.01, radius=0.03),
        "no pivot is defined; got 0 at index 1",
    ),
    (
        lambda: squirt.miscue_offset(np.inf, cue_mass_ratio=2.0, end_mass_ratio=0.1),
        "inf, with which no stroke is a miscue",
    ),
    (lambda: squirt.full_cone_length(0.1, tip_radius=0.01, base_radius=0.01), "the base's"),
]


@pytest.mark.parametrize(("ask", "message"), CALLS, ids=[message for _, message in CALLS])
def test_calls(ask: Callable[[], object], message: str) -> None:
    refuses(ask, message)
