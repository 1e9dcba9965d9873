"""Strikes against stored results of the former engine at 1e-9 (tests/data; verification).

Errors of squirt are relative to the larger of squirt and 0.01 b/R. Sums over the strikes of each kind are in
tests/golden/numbers.json to round-off (regression): `--update` writes them.
"""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Callable, Iterable, Sequence
from typing import Any

import numpy as np
import pytest

import cuefem as cf
from cuefem import Outcome
from tests.contact.test_independent_effects import KINDS as RANDOM_KINDS
from tests.contact.test_independent_effects import RandomScene
from tests.data.stored import strike_row, strikes
from tests.helpers.golden_numbers import assert_golden_numbers
from tests.helpers.strike_scenes import KIM, KIM_AT, KIM_TIP, energy_residual

KINDS = tuple(dict.fromkeys(row["kind"] for row in strikes()))
# Infinite friction begins with an impulse, whose wave fronts the steps do not resolve.
INFINITE_FRICTION = "endless"  # the key in the stored data
ROUND_OFF = 1e-11  # of the sums over stored strikes, which begin with tip modes
EVEN = cf.LumpedCue(0.54, 0.01)


def frictionless() -> Iterable[cf.Scene]:
    """Strokes on both sides and head-on, whose ball slips over the tip faster than 1 m/s; of the last one back, too."""
    tip = cf.Tip(0.75, 0.0, contact_time=1e-3)
    for cue, offset in ((EVEN, 0.5), (EVEN, -0.5), (EVEN, 0.0), (cf.LumpedCue(0.54, 0.13, 3.28), 0.12)):
        yield cf.Scene(cue, tip=tip, stroke=cf.Stroke(6.0, offset))


def bent_and_damped() -> Iterable[cf.Scene]:
    """Shafts that the stroke bends, with dashpots, or loss factors and raised."""
    grip, bridge, loss = cf.Support(0.6, 1e3, 5.0, 8.0), cf.Support(0.2, dashpot=3.0), cf.StructuralDamping(0.1)
    for effects in ((grip,), (grip, bridge, loss), (loss, cf.Elevation(0.3, 0.2)), (bridge, cf.Elevation(0.1, 0.0))):
        for offset in (0.3, -0.6):
            yield cf.Scene(KIM, tip=KIM_TIP, stroke=cf.Stroke(3.0, offset), effects=(cf.GeometricStiffness(), *effects))


def coupled() -> Iterable[cf.Scene]:
    """A lumped cue that moves sideways under an axial force: of both sides, head-on, and raised."""
    for offset in (0.3, -0.3, 0.0):
        for effects in ((), (cf.Elevation(0.2, 0.3),)):
            yield cf.Scene(cf.LumpedCue(0.54, 0.13, 2.0), stroke=cf.Stroke(2.0, offset), effects=effects)


def separated_by_impact() -> Iterable[cf.Scene]:
    """A cue whose coupling lets the impulse of infinite friction at the first touch separate it from the ball."""
    for offset in (0.9, -0.9, 0.95):
        tip = cf.Tip(0.75, math.inf, contact_time=1e-3)
        yield cf.Scene(cf.LumpedCue(0.02, 0.02, -45.0), tip=tip, stroke=cf.Stroke(2.0, offset))


# Scenes that the stored ones have not.
OTHER_KINDS: dict[str, Callable[[], Iterable[cf.Scene]]] = {
    name: lambda make=kind.make: map(make, map(RandomScene, range(4))) for name, kind in RANDOM_KINDS.items()
} | {kind.__name__: kind for kind in (frictionless, bent_and_damped, coupled, separated_by_impact)}


def squirt_error(outcome: Outcome, row: dict[str, Any]) -> float:
    squirt = row["answer"]["squirt"]
    return abs(outcome.squirt - squirt) / max(abs(squirt), 0.01 * abs(row["scene"]["stroke"][1]))


def sums(outcomes: Sequence[Outcome]) -> dict[str, float]:
    """Sums of the numbers of outcomes, energies over the initial one, with the number of phases of each kind."""
    total: Counter[str] = Counter()
    for outcome in outcomes:
        history, energy = outcome.history, dict(outcome.energy)
        initial = energy.pop("initial")
        total.update(
            {name: getattr(outcome, name) for name in ("squirt", "ball_speed", "spin", "cue_speed", "duration")}
        )
        total.update({f"energy, {name}": value / initial for name, value in energy.items()})
        total.update(dict(zip(("force_t", "force_n"), history.forces.sum(axis=0).tolist(), strict=True)))
        total.update(f"{phase.state}, {phase.normal_phase}" for phase in outcome.phases)
        total["steps"] += len(history.ends)
        total["slip velocity"] += float(np.abs(history.velocities[:, 0]).sum())
        for name in ("velocity", "spin") if history.velocity is not None else ():
            total.update({f"{name}, {axis}": value for axis, value in zip("xyz", getattr(history, name), strict=True)})
    return dict(total)


@pytest.mark.parametrize("kind", OTHER_KINDS)
def test_strike_other_kinds_equal_golden_sums(kind: str, request: pytest.FixtureRequest) -> None:
    assert_golden_numbers(kind, sums([cf.strike(scene, KIM_AT) for scene in OTHER_KINDS[kind]()]), request)


@pytest.mark.parametrize("kind", KINDS)
def test_strike_each_kind_equals_stored_and_golden_answers(kind: str, request: pytest.FixtureRequest) -> None:
    rows = [row for row in strikes() if row["kind"] == kind]
    outcomes = [strike_row(row) for row in rows]
    assert_golden_numbers(kind, sums(outcomes), request, ROUND_OFF)
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
