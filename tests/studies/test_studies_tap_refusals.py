"""The committed table of what the tap test refuses: what it must show, and a sample of it derived again."""

from __future__ import annotations

import re

import pytest

from studies import tap_refusals, tap_sounds
from studies.common import STUDIES

COMMITTED = (STUDIES / "tap_refusals.md").read_text(encoding="utf-8")
KINDS = {
    cells[0]: [int(cell) for cell in cells[1:]]
    for line in COMMITTED.splitlines()
    if (cells := [cell.strip() for cell in line.split("|")[1:-1]]) and cells[0] in tap_sounds.KINDS
}


def test_no_other_sound_is_taken_for_a_tap() -> None:
    assert KINDS.keys() == tap_sounds.KINDS.keys()
    assert sum(recordings for recordings, _, _ in KINDS.values()) >= 200
    assert sum(taken for _, _, taken in KINDS.values()) == 0


def test_honest_taps_are_believed() -> None:
    refused = dict(re.findall(r"^\| (honest|hummed) \| (\d+) of", COMMITTED, flags=re.MULTILINE))
    assert int(refused["honest"]) <= 0.05 * tap_refusals.HONEST
    assert int(refused["hummed"]) <= 0.2 * tap_refusals.HUMMED


@pytest.mark.heavy
@pytest.mark.parametrize("kind", ["speech", "struck plate"])
def test_a_kind_of_sound_again(kind: str) -> None:
    found = [tap_refusals.others(kind, seed) for seed in range(tap_refusals.EACH)]
    unlikely, taken = (
        sum(chance <= tap_refusals.LEVEL for chance, _ in found),
        sum(tap_refusals.accepted(fit) for _, fit in found),
    )
    assert [tap_refusals.EACH, unlikely, taken] == KINDS[kind]
