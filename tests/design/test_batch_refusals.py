"""What a batch does not take (bad input)."""

from __future__ import annotations

import numpy as np
import pytest

from cuefem import Resolution
from cuefem.design.batch import CueBatch, batch_stick
from cuefem.endmass.undamped import StickLimit
from tests.helpers.cues import kim, pool, scene

AT = Resolution(1, 8, 3)


def test_cues_of_two_topologies() -> None:
    with pytest.raises(ValueError, match=r"takes cues of one topology; got \[1, 4\] segments"):
        CueBatch.of([kim(), pool()])


def test_scenes_that_are_not_one_a_cue() -> None:
    with pytest.raises(ValueError, match=r"takes one contact, or 3, one a cue; got 2"):
        batch_stick(CueBatch.of([kim()] * 3), [scene(kim(), 1e-3)] * 2, at=AT)


def test_contact_times_that_are_not_one_a_cue() -> None:
    batch = CueBatch.of([kim()] * 3)
    limit = StickLimit.law(0.21, 0.4, 0.75, np.full(4, 1e-3), 0.54)
    with pytest.raises(ValueError, match=r"takes one contact, or 3, one a cue; got 4"):
        batch_stick(batch, limit, at=AT)
