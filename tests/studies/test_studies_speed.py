"""The table that speed.py prints: every call in it, with a ratio to both bare calls. No time is judged."""

import sys
from pathlib import Path

import pytest

sys.path.append(str(Path(__file__).parents[2] / "studies"))
import speed

STUDIES = Path(__file__).parents[2] / "studies"


def rows(text):
    return [line.split(" | ") for line in text.splitlines() if line.startswith("| ") and "---" not in line]


@pytest.mark.heavy
def test_the_table_is_made_as_the_committed_one_was():
    made, kept = rows(speed.report(rounds=1, repeats=1)), rows((STUDIES / "speed_seconds.md").read_text("utf-8"))
    assert [row[0] for row in made] == [row[0] for row in kept]
    assert all(float(row[1].strip(" |")) > 0 for row in made if row[0].strip("| ") not in ("call", "whole process"))
