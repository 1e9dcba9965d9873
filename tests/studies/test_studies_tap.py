"""The committed table of the tap study is what its program gives (regression)."""

from __future__ import annotations

import pytest

from studies import tap
from studies.common import NAMES, STUDIES
from tests.helpers.committed import drawn, not_committed

COMMITTED = (STUDIES / "tap.md").read_text(encoding="utf-8")


@pytest.mark.heavy
def test_tap_table(monkeypatch: pytest.MonkeyPatch) -> None:
    """The text and the rows of two of the five cues, the whole cue not among them: it alone takes as long."""
    monkeypatch.setattr(tap, "NAMES", drawn(NAMES[:-1], 2, seed=0))
    derived = tap.text()
    assert len(derived.splitlines()) == len(COMMITTED.splitlines()) - 3 * len(tap.NOISES)
    assert not_committed(COMMITTED, derived) == []


def test_modulus_within_a_per_cent_and_end_mass_within_a_thousandth_at_20_db() -> None:
    rows = [line.split("|")[1:-1] for line in COMMITTED.splitlines() if line.startswith("| ")][1:]
    assert [(row[0].strip(), float(row[1])) for row in rows] == [(n, snr) for n in NAMES for snr in tap.NOISES]
    for row in rows:
        assert float(row[3]) < 1.0
        assert float(row[7]) < 0.1
