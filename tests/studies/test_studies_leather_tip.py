"""The committed page of the leather tip's study: a sample of it derived again, and what it claims (regression)."""

from __future__ import annotations

import pytest

from cuefem.validation import disagreements
from studies import leather_tip as study
from studies.common import STUDIES

COMMITTED = (STUDIES / "leather_tip.md").read_text(encoding="utf-8")
SPEED = COMMITTED.split("## Speed")[1].split("## Leather")[0]


def column(part: str, name: str) -> list[float]:
    """Numbers of a column, to the first that is none."""
    rows = [[cell.strip() for cell in line.split("|")[1:-1]] for line in part.splitlines() if line.startswith("| ")]
    return [float(row[rows[0].index(name)]) for row in rows[1:] if row[0][0].isdigit()]


def test_speed_hardly_matters_but_for_a_bare_tip() -> None:
    changes = {model: max(found) / min(found) for model in study.MODELS if (found := column(SPEED, model))}
    assert changes["LeatherTip"] < 1.05
    assert changes["patchwork"] < 1.05
    assert changes["bare"] > 1.2
    times = column(SPEED, "contact time, ms")
    assert times == sorted(times, reverse=True)


def test_a_row_again() -> None:
    squirt, time = study.struck("LeatherTip", study.maple(), speed=5.0)
    assert (f"{squirt:.2f}", f"{time:.2f}") == (
        f"{column(SPEED, 'LeatherTip')[4]:.2f}",
        f"{column(SPEED, 'contact time, ms')[4]:.2f}",
    )


@pytest.mark.heavy
def test_the_page_again() -> None:
    assert disagreements(COMMITTED, study.text()) == []


@pytest.mark.parametrize("name", ["squirt at b/R 0.375, deg", "contact time there, ms"])
def test_the_sketch_is_confirmed(name: str) -> None:
    """Within 2 % of what was predicted before the study was run."""
    assert study.FOUND[name]() == pytest.approx(study.PREDICTED[name], rel=0.02)
