"""What batches are worth, against single cues by hundreds of modes: the study's table, and its promises
(regression)."""

from __future__ import annotations

import numpy as np
import pytest

from cuefem.validation import disagreements
from studies import batch
from studies.common import STUDIES


@pytest.mark.heavy
def test_the_committed_table() -> None:
    assert disagreements((STUDIES / "batch.md").read_text(encoding="utf-8"), batch.text()) == []


@pytest.mark.heavy
def test_five_frequencies_to_3e_6_solid_and_hollow() -> None:
    assert np.all(batch.frequency_errors() < 3e-6)


@pytest.mark.heavy
@pytest.mark.parametrize("contact_time", batch.TIMES)
def test_stick_end_mass_to_1e_3_on_eight_shafts(contact_time: float) -> None:
    assert np.all(abs(batch.errors(tuple(batch.SHAFTS), contact_time, batch.CHOSEN, True)) < 1e-3)
