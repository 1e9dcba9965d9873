"""How many shafts a second: the study that measures it (studies/accuracy/batch.py), on few shafts (benchmark).

Here only that every number is there and is of the right answers; no test asserts a time. The numbers are printed by

    python -m studies.accuracy.batch
"""

from __future__ import annotations

import numpy as np
import pytest

from cuefem import Resolution
from cuefem.design.batch import batch_frequencies, batch_stick
from studies.accuracy import batch
from studies.accuracy.batch import Size
from studies.strokes import cue, scene


def test_five_frequencies() -> None:
    shafts = batch.shafts(64)
    fine = batch_frequencies(shafts, 5, at=Resolution(2, 18, 5))
    np.testing.assert_allclose(batch_frequencies(shafts, 5, at=batch.FREQUENCIES_AT), fine, rtol=3e-6)


def test_stick_end_mass() -> None:
    """To 1e-3 of every mode below the shear cut-off."""
    shafts, struck = batch.shafts(12), scene(cue("kim"), 0.7e-3)
    fine, _ = batch_stick(shafts, struck, at=Resolution(5, 22, 70), ended=True)
    np.testing.assert_allclose(batch_stick(shafts, struck, at=batch.CHOSEN, ended=True)[0], fine, rtol=1e-3)


@pytest.mark.heavy
def test_every_number_is_told() -> None:
    told: list[str] = []
    found = batch.seconds(Size(shafts=8, rounds=1, swept=256, streamed=2**10), told.append)
    names = list(batch.works(Size(shafts=1)))
    assert [line.split(":")[0] for line in told[: len(names)]] == [name.split(":")[0] for name in names]
    assert all(f"| {name} | " in found for name in names)
    assert "in two" in told[-2]
    assert "MiB" in told[-1]
