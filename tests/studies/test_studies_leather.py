"""The committed page of the leather's elasticity is what its program gives (regression)."""

from __future__ import annotations

import pytest

from cuefem.validation import disagreements
from studies import leather_elasticity
from studies.common import STUDIES

COMMITTED = (STUDIES / "leather_elasticity.md").read_text(encoding="utf-8")


@pytest.mark.heavy
def test_the_solid_again() -> None:
    assert disagreements(COMMITTED.split("\nThe table against")[0], leather_elasticity.solid_text()) == []


@pytest.mark.heavy
def test_the_table_at_the_first_tips_again() -> None:
    """Of the random tips of the page, the first two: none further off than the page's largest."""
    rows = [[cell.strip() for cell in line.split("|")[1:-1]] for line in COMMITTED.splitlines()]
    largest = {(row[0], row[1]): float(row[5]) for row in rows if len(row) == 6 and row[2].isdigit()}
    found = list(leather_elasticity.measured(leather_elasticity.errors(2)))
    assert len(found) == len(largest) == 8
    assert all(float(row[5]) <= largest[row[0], row[1]] + 0.01 for row in found)


def test_the_table_is_within_half_a_per_cent() -> None:
    """Of the compliance of whole patches and of the head-on law, in 95 of 100 random tips."""
    rows = [[cell.strip() for cell in line.split("|")[1:-1]] for line in COMMITTED.splitlines()]
    found = {(row[0], row[1]): float(row[4]) for row in rows if len(row) == 6 and row[2].isdigit()}
    assert len(found) == 8
    assert all(value < 0.5 for (what, _), value in found.items() if what != "patches that the rim cuts")
