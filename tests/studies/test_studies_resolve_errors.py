"""A sample of the committed table of resolve_errors.py derived again, and what it must show (regression)."""

import re
import sys
from pathlib import Path

import matplotlib as mpl
import pytest

from cuefem.validation import disagreements

mpl.use("Agg")
sys.path.append(str(Path(__file__).parents[2] / "studies"))
import common
import resolve_errors

COMMITTED = (Path(__file__).parents[2] / "studies" / "resolve_errors.md").read_text(encoding="utf-8")
STRIKES, MASSES = COMMITTED.split("## Stick end mass")
QUICK, SLOWER = (4,), (9, 11, 13, 17)


def agree(table: str, climb: resolve_errors.Climb) -> bool:
    """Whether the committed row of a scene is what is derived now: error sizes differ by a digit between machines."""
    committed = next(line for line in table.splitlines() if line.startswith(f"| {climb.number} |"))
    derived = common.table(resolve_errors.HEAD, [resolve_errors.row(climb)]).splitlines()[-1]
    return disagreements(committed, derived) == []


@pytest.mark.parametrize("number", [*QUICK, *(pytest.param(each, marks=pytest.mark.heavy) for each in SLOWER)])
def test_rows_of_strikes(number: int) -> None:
    assert agree(STRIKES, resolve_errors.strikes(number))


@pytest.mark.heavy
@pytest.mark.parametrize("number", [9])
def test_rows_of_end_masses(number: int) -> None:
    assert agree(MASSES, resolve_errors.end_masses(number))


@pytest.mark.parametrize("part", [STRIKES, MASSES], ids=["strikes", "end masses"])
def test_the_estimates_hold(part: str) -> None:
    """True over estimated error is above 1 in at most 5 % of rungs and above 3 in none, in each family."""
    above = re.findall(r"above 1 in ([\d.]+) %, above 3 in (\d+)", part)
    assert len(above) == len(resolve_errors.FAMILIES)
    assert all(float(percent) <= 5 and three == "0" for percent, three in above)


def test_all_scenes_are_there() -> None:
    drawn = [int(scenes) for _, scenes in resolve_errors.family.FAMILIES]
    found = re.findall(r"^- (\d+) of (\d+) scenes", STRIKES, flags=re.MULTILINE)
    assert [(int(a), int(b)) for a, b in found] == [(scenes, scenes) for scenes in drawn]


@pytest.mark.parametrize("asked", ["1e-02", "1e-03", "3e-04"])
def test_the_accuracies_asked_for_are_met(asked: str) -> None:
    """In 98 % of the scenes of all families, strikes and end masses together."""
    answered = re.findall(rf"- {asked} asked for: .* in (\d+) scenes, .*; met in (\d+)", COMMITTED)
    assert len(answered) == 2 * len(resolve_errors.FAMILIES)
    assert sum(int(met) for _, met in answered) >= 0.98 * sum(int(scenes) for scenes, _ in answered)
