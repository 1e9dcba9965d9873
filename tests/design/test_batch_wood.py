"""What batches of wooden shafts are worth at any contact time: shafts of the study derived again, and what the handbook
says of it (regression)."""

from __future__ import annotations

import re

import pytest

from cuefem.validation import disagreements
from studies import batch_wood
from studies.common import STUDIES

COMMITTED = (STUDIES / "batch_wood.md").read_text(encoding="utf-8")


def test_the_families_are_large_and_their_contact_times_dense() -> None:
    assert batch_wood.SHAFTS >= 200
    assert len(batch_wood.TIMES) > 100
    assert (batch_wood.TIMES[0], batch_wood.TIMES[-1]) == (0.5e-3, 3e-3)


@pytest.mark.heavy
def test_some_shafts_alone() -> None:
    """Their table stands in the study as it is derived here; the families' was made by the same functions."""
    committed = COMMITTED[COMMITTED.index("| shaft |") :]
    assert disagreements(committed, batch_wood.single()) == []


def test_the_handbook_says_what_was_measured() -> None:
    """The handbook's median, 95 % and largest of the recommended resolution, in per cent, are the worst family's."""
    rows = [line.split(" | ") for line in COMMITTED.splitlines() if line.startswith("| `Resolution(1, 30, 18)`")]
    worst = [max(float(row[k].rstrip(" |")) for row in rows) for k in (3, 4, 5)]
    said = (STUDIES.parent / "cuefem" / "handbook" / "working.md").read_text(encoding="utf-8")
    found = re.search(r"within ([\d.]+) % in the median,\s+([\d.]+) % in 95 of 100, ([\d.]+) % at worst", said)
    assert found is not None
    assert [float(part) for part in found.groups()] == [pytest.approx(value / 10, abs=0.051) for value in worst]
