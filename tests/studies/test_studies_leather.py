"""The committed page of the leather's elasticity is what its program gives (regression)."""

from __future__ import annotations

import pytest

from cuefem.validation import disagreements
from studies import leather_elasticity
from studies.common import STUDIES

COMMITTED = (STUDIES / "leather_elasticity.md").read_text(encoding="utf-8")


@pytest.mark.heavy
def test_page() -> None:
    assert disagreements(COMMITTED, leather_elasticity.text()) == []


def test_the_table_is_within_half_a_per_cent() -> None:
    """Of the compliance of whole patches and of the head-on law, in 95 of 100 random tips."""
    rows = [[cell.strip() for cell in line.split("|")[1:-1]] for line in COMMITTED.splitlines()]
    found = {(row[0], row[1]): float(row[4]) for row in rows if len(row) == 6 and row[2].isdigit()}
    assert len(found) == 8
    assert all(value < 0.5 for (what, _), value in found.items() if what != "patches that the rim cuts")
