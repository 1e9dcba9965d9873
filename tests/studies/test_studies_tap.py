"""The committed table of the tap study is what its program gives (regression)."""

from __future__ import annotations

import pytest

from cuefem.validation import disagreements
from studies import tap
from studies.common import NAMES, STUDIES

COMMITTED = (STUDIES / "tap.md").read_text(encoding="utf-8")


@pytest.mark.heavy
def test_tap_table() -> None:
    assert disagreements(COMMITTED, tap.text()) == []


def test_modulus_within_a_per_cent_and_end_mass_within_a_thousandth_at_20_db() -> None:
    rows = [line.split("|")[1:-1] for line in COMMITTED.splitlines() if line.startswith("| ")][1:]
    assert [(row[0].strip(), float(row[1])) for row in rows] == [(n, snr) for n in NAMES for snr in tap.NOISES]
    for row in rows:
        assert float(row[3]) < 1.0
        assert float(row[7]) < 0.1
