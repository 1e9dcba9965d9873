"""Strikes, end masses and frequencies against stored results of the former engine at 1e-9 (tests/data; verification).

Errors of squirt are relative to the larger of squirt and 0.01 b/R.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import cuefem as cf
from cuefem import Outcome
from cuefem.contact.outcome import end_of_first_slip
from cuefem.contact.strike import strike_modes
from tests.data.stored import DATA, cue_of, cues, scene_of, stored_law, strikes, tip_of
from tests.helpers.strike_scenes import energy_residual

KINDS = tuple(dict.fromkeys(row["kind"] for row in strikes()))
# Infinite friction begins with an impulse, whose wave fronts the steps do not resolve.
INFINITE_FRICTION = "endless"  # the key in the stored data


def strike_row(row: dict[str, Any], **resolution: int) -> Outcome:
    with stored_law(row):
        return strike_modes(scene_of(row), tip_of(row), **resolution)


def squirt_error(outcome: Outcome, row: dict[str, Any]) -> float:
    squirt = row["answer"]["squirt"]
    return abs(outcome.squirt - squirt) / max(abs(squirt), 0.01 * abs(row["scene"]["stroke"][1]))


@pytest.mark.parametrize("kind", KINDS)
def test_strike_each_kind_equals_stored_answers(kind: str) -> None:
    rows = [row for row in strikes() if row["kind"] == kind]
    outcomes = [strike_row(row) for row in rows]
    errors = np.array([squirt_error(outcome, row) for outcome, row in zip(outcomes, rows, strict=True)])
    assert np.median(errors) < 1e-4
    assert np.quantile(errors, 0.95) < 1e-3
    assert errors.max() < 2e-3
    assert max(map(energy_residual, outcomes)) < (2e-4 if kind == INFINITE_FRICTION else 2e-5)
    for name, tolerance in (("ball_speed", 5e-4), ("cue_speed", 5e-4), ("spin", 5e-4), ("duration", 1e-3)):
        pairs = [(getattr(outcome, name), row["answer"][name]) for outcome, row in zip(outcomes, rows, strict=True)]
        assert max(abs(value / stored - 1) for value, stored in pairs) < tolerance, name
    for outcome, row in zip(outcomes, rows, strict=True):
        initial = row["answer"]["energy"]["initial"]
        for name, joules in row["answer"]["energy"].items():
            assert abs(outcome.energy[name] - joules) < 2e-4 * initial, name
        np.testing.assert_allclose(
            outcome.ball_velocity, row["answer"]["ball_velocity"], atol=5e-4 * outcome.ball_speed
        )
    ends = [end_of_first_slip(outcome.phases) for outcome in outcomes]
    assert np.mean([end == row["answer"]["regime"] for end, row in zip(ends, rows, strict=True)]) > 0.9


@pytest.mark.heavy
@pytest.mark.parametrize("damped", [False, True])
def test_end_mass_equals_stored_answers(damped: bool) -> None:
    """The truncation error of the default modes is at most 0.6 % (handbook: Accuracy)."""
    errors = []
    for row in cues()[::2]:
        effects = (cf.StructuralDamping(),) if damped else ()
        tip = cf.Tip(contact_time=row["contact_time"], friction=np.inf)
        scene = cf.Scene(cue_of(row), tip=tip, stroke=cf.Stroke(2.0, 0.3), effects=effects)
        for drive, mass in row["end_mass"]["damped" if damped else "free"].items():
            errors.append(abs(cf.end_mass(scene, drive) / mass - 1))
    assert np.median(errors) < 1e-3
    assert max(errors) < 6e-3


def test_frequencies_equal_stored_answers() -> None:
    rows = [row for row in cues() if "frequencies" in row]
    assert len(rows) == 30
    for row in rows[::3]:
        np.testing.assert_allclose(cf.modes(cue_of(row), 12).frequencies[:12], row["frequencies"], rtol=1e-6)


def test_every_stored_file_says_who_made_it_how_and_to_which_tolerance() -> None:
    table = [line.split("|")[1:-1] for line in (DATA / "README.md").read_text().splitlines() if line.startswith("| `")]
    stored = {path.name for path in DATA.iterdir() if path.suffix not in ("", ".py", ".md")}
    assert {row[0].strip(" `") for row in table} == stored
    assert all(len(row) == 4 and all(cell.strip() for cell in row) for row in table)
