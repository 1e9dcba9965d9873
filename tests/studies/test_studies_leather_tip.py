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


def test_modes_and_steps_have_converged() -> None:
    """The default is within a thousandth of 180 modes, where 45 are 3 off; the steps add nothing."""
    part = COMMITTED.split("## Convergence")[1].split("## Measured squirt")[0]
    rows = {line.split(" | ")[0].lstrip("| "): line.split(" | ")[1] for line in part.splitlines() if line[:2] == "| "}
    assert rows["45 modes"] == f"{study.with_modes(45):.4f}"
    coarse = study.with_tolerance(0.1)
    assert rows["steps to 0.1 of the impulse"] == f"{coarse:.4f}"
    assert coarse == pytest.approx(study.struck(study.MODERN, study.maple())[0], rel=2e-6)
    default, most = float(rows["default"]), float(rows["180 modes"])
    assert abs(most / default - 1) < 1e-3 < float(rows["45 modes"]) / default - 1


def test_where_it_fails() -> None:
    """Rows of the series of 2007 and of the break cue again; both are beside what was measured."""
    part = COMMITTED.split("## Measured squirt")[1].split("## What it depends on")[0]
    rows = [[cell.strip() for cell in line.split("|")[1:-1]] for line in part.splitlines() if line[:2] == "| "]
    found = {(cells[0].split()[0], cells[1]): cells for cells in rows[1:]}
    assert len(found) == 6  # the robot's two values stand at one offset
    small = found["Players", "0.187"]
    assert small[5] == f"{study.struck('LeatherTip', study.maple(), 0.187)[0]:.2f}"
    assert float(small[5]) > 1.13  # the largest value measured there
    hard = found["Stinger", "0.267"]
    assert hard[5] == f"{study.break_cue('LeatherTip'):.2f}"
    assert float(hard[5]) < 0.9 * float(hard[2])


def test_the_readmes_opening_says_what_the_page_found() -> None:
    opening = " ".join((STUDIES.parent / "README.md").read_text(encoding="utf-8").split("## ")[0].split())
    rows = [line.split("|")[2:5] for line in COMMITTED.splitlines() if line.startswith("| largest over smallest")]
    (bare_speed, _, speed), (bare_leather, _, leather) = ([cell.strip().split()[0] for cell in row] for row in rows)
    robot = next(line.split("|")[6].strip() for line in COMMITTED.splitlines() if line.startswith("| Players (robot"))
    assert f"({robot}°; measured 2.30 and 2.43°)" in opening
    assert f"by {speed} % from 0.8 to 7 m/s and by {leather} % from soft to hard leather" in opening
    assert f"changes by {bare_speed} and {bare_leather} %" in opening
