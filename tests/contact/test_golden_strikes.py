"""Strikes of every law and effect: convergence, energy, and sums of their numbers in a golden file (properties).

The sums are in tests/golden/numbers.json to round-off (regression): `--update` writes them. Errors of squirt are
relative to the larger of squirt and 0.01 b/R.
"""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Callable, Iterable, Sequence
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

import cuefem as cf
from cuefem import Outcome
from cuefem.contact.strike import strike_modes
from cuefem.scene.solved_scene import tip_modes_of
from tests.contact.test_independent_effects import KINDS, RandomScene
from tests.helpers.golden_numbers import assert_golden_numbers
from tests.helpers.leather_scenes import LEATHER, POOL, SHAFT
from tests.helpers.strike_scenes import KIM, KIM_AT, KIM_TIP, energy_residual

DOME, THRUST, WAVES = cf.TipDome(0.0095), cf.GeometricStiffness(), cf.AxialWaves()
SHEAR, POWER, RAISED = cf.TipShear(0.75), cf.PowerLawTip(1.5), cf.Elevation(0.2, 0.3)
WHOLE_TIP: dict[str, Any] = {"contact_time": None}
# Effects, and fields of the tip that are not drawn.
LAWS: dict[str, tuple[tuple[cf.Effect, ...], dict[str, Any]]] = {
    "linear": ((), {}),
    "dome": ((DOME,), {}),
    "shear": ((SHEAR, DOME), {}),
    "power": ((POWER,), {}),
    "power shear": ((POWER, SHEAR, DOME), {}),
    "rolling": ((cf.RollingContact(), DOME), {}),
    "axial": ((WAVES, DOME), {}),
    "damping": ((cf.StructuralDamping(0.05),), {}),
    "thrust": ((THRUST, DOME), {}),
    "second hit": ((cf.SecondHit(4e-3),), {}),
    "low restitution": ((), {"restitution": 0.1}),
    "infinite friction": ((), {"friction": math.inf}),
    "infinite friction, shear": ((SHEAR, DOME), {"friction": math.inf}),
    "leather": ((LEATHER,), WHOLE_TIP),
    "leather loss": ((replace(LEATHER, surface_restitution=0.86),), WHOLE_TIP),
    "usual": ((LEATHER, WAVES, THRUST), WHOLE_TIP),
    "raised": ((RAISED, DOME), {}),
    "raised thrust": ((RAISED, DOME, THRUST), {}),
}
# Whose median error falls with the square of the step: stick, slip, partial slip, a default strike, a raised cue.
SMOOTH = ("linear", "rolling", "second hit", "leather", "usual", "raised")
MANY = 1600  # steps of the reference


def drawn(law: str) -> list[cf.Scene]:
    """Strokes on both sides, with slips, sticks and miscues."""
    effects, tip = LAWS[law]
    draws = map(RandomScene, range(10))
    return [cf.Scene(SHAFT, POOL, replace(draw.tip(), **tip), draw.stroke(), effects) for draw in draws]


def struck(law: str, steps: int | None = None) -> list[Outcome]:
    """The strikes of a law, in steps of a contact time; None: the default."""
    scenes = drawn(law)
    modes = tip_modes_of(scenes[0], KIM_AT)
    return [strike_modes(scene, modes, steps=steps) for scene in scenes]


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


# Scenes that the drawn ones have not.
OTHERS: dict[str, Callable[[], Iterable[cf.Scene]]] = {
    name: lambda make=kind.make: map(make, map(RandomScene, range(4))) for name, kind in KINDS.items()
} | {kind.__name__: kind for kind in (frictionless, bent_and_damped, coupled, separated_by_impact)}


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


@pytest.mark.parametrize("kind", OTHERS)
def test_strike_other_kinds_equal_golden_sums(kind: str, request: pytest.FixtureRequest) -> None:
    assert_golden_numbers(kind, sums([cf.strike(scene, KIM_AT) for scene in OTHERS[kind]()]), request)


@pytest.mark.parametrize("law", LAWS)
def test_strikes_of_each_law_converge_and_equal_golden_sums(law: str, request: pytest.FixtureRequest) -> None:
    outcomes, references = struck(law), struck(law, MANY)
    assert_golden_numbers(law, sums(outcomes), request)
    exact = np.array([outcome.squirt for outcome in references])
    sizes = np.maximum(np.abs(exact), [0.01 * abs(scene.stroke.offset) for scene in drawn(law)])

    def errors(strikes: Sequence[Outcome]) -> np.ndarray:
        return np.abs(np.array([outcome.squirt for outcome in strikes]) - exact) / sizes

    usual = errors(outcomes)
    assert np.median(usual) < 1e-4
    assert usual.max() < 2e-3
    assert max(map(energy_residual, outcomes)) < 1e-5
    if law in SMOOTH:
        # an event has another position in its step
        coarse, fine = (
            np.median([errors(struck(law, steps)), errors(struck(law, round(1.1 * steps)))]) for steps in (100, 400)
        )
        assert math.log(coarse / fine) / math.log(4) == pytest.approx(2.0, abs=0.4)
