"""The impulse solver against decimal arithmetic, in every regime: energy, mirror (verification)."""

from collections import Counter
from collections.abc import Iterator
from dataclasses import replace
from math import inf, sqrt

import numpy as np
import pytest

from cuefem import Ball, LumpedCue, Outcome, Scene, Stroke, Tip, impulse
from cuefem.contact.impulse_solver import ImpulseInputs, impulse_inputs
from studies.paper import closed_forms as squirt
from tests.oracle.decimal_impulse import exact_impulse, regime_of

pytestmark = pytest.mark.filterwarnings("ignore::cuefem.PlausibilityWarning")
ENERGIES = ("initial", "ball translation", "ball rotation", "cue", "tip loss", "friction loss")
REGIMES = ("stick", "late stick", "miscue", "slip reversal", "jam")


def edges() -> Iterator[Scene]:
    """A strongly coupled cue, grazing offsets, and friction 0 or infinite."""
    yield Scene(LumpedCue(0.5, 0.2, -2.9), Ball(1.0, 0.03), Tip(0.5, inf), Stroke(1.0, 0.995))
    for cue, ends, side in ((2e-4, 1e-10, 1), (200.0, 0.1, -1)):
        for e, mu in ((0.0, 0.7), (1.0, 0.0), (1.0, inf)):
            lumped = LumpedCue(cue, ends, 0.95 * side / sqrt(cue * ends))
            for offset in (0.0, 1e-12, 0.5, 0.999999):
                yield Scene(lumped, Ball(0.2, 0.03), Tip(e, mu), Stroke(3.0, offset))


def draw(rng: np.random.Generator, kind: str) -> Scene:
    """A scene that is likely to have the requested regime."""
    M, nu = rng.uniform(0.1, 0.3), rng.uniform(0.2, 1)
    Q0, ends, b = 10 ** rng.uniform(-1, 2), 10 ** rng.uniform(-6, 1), rng.uniform(0.01, 0.99)
    mu, e = rng.uniform(0, 2), rng.choice([0.0, 1.0, rng.uniform(0, 1)])
    if kind == "late stick":
        ends, e = 10 ** rng.uniform(-1.5, 0.5), rng.uniform(0.1, 1)
        mu = squirt.compression_stick_friction(b, end_mass_ratio=ends, inertia=nu) * rng.uniform(0.8, 1)
    elif kind == "slip reversal":
        Q0, mu = 10 ** rng.uniform(-1, 0), rng.uniform(0, 0.08)
        ends = Q0 * 10 ** rng.uniform(0.5, 2)
    elif kind == "jam":
        ends, b, mu = 10 ** rng.uniform(-6, -2), rng.uniform(0.05, 0.55), rng.uniform(0.7, 2)
    elif kind == "stick" and rng.uniform() < 0.2:
        mu = inf
    coupling = rng.uniform(-0.9, 0.9) if rng.uniform() < 0.3 else 0.0
    cue = LumpedCue(Q0 * M, ends * M, coupling / np.sqrt(Q0 * ends) / M)
    return Scene(cue, Ball(M, 0.03, nu), Tip(e, mu), Stroke(rng.uniform(0.5, 4), b))


def numbers_of(outcome: Outcome) -> dict[str, object]:
    """Every number of an outcome, by name."""
    numbers = {event.name: event.impulse for event in outcome.phases} | outcome.energy
    fields = ("squirt", "ball_velocity", "ball_speed", "spin", "cue_speed", "impulse")
    return numbers | {name: getattr(outcome, name) for name in fields}


def columns(singles: list[Scene]) -> dict[str, np.ndarray]:
    """The numbers that the solver takes."""
    rows = [impulse_inputs(scene, scene.cue) for scene in singles]
    return dict(zip(ImpulseInputs._fields, np.transpose(rows), strict=True))


def assert_energy_balance(singles: list[Scene], out: Outcome) -> None:
    n = columns(singles)
    initial, *parts = (out.energy[name] for name in ENERGIES)
    assert set(out.energy) == set(ENERGIES)
    assert np.all(abs(sum(parts) - initial) < 1e-12 * initial)
    assert np.all(np.min(parts, axis=0) >= -1e-13 * initial)
    assert np.all(initial >= n["mass"] * n["speed"] ** 2 / 2 * (1 - 1e-15))
    turning = n["inertia"] * n["ball_mass"] * (n["radius"] * out.spin) ** 2 / 2
    np.testing.assert_allclose(out.energy["ball rotation"], turning, rtol=1e-13)
    np.testing.assert_allclose(out.energy["ball translation"], n["ball_mass"] * out.ball_speed**2 / 2, rtol=1e-13)


def assert_mirrored(singles: list[Scene], right: Outcome) -> None:
    left = impulse([replace(scene, stroke=replace(scene.stroke, offset=-scene.stroke.offset)) for scene in singles])
    signs = {"squirt": -1, "spin": -1, "ball_velocity": [-1, 1], "impulse": [-1, 1]}
    for name, value in numbers_of(right).items():
        assert np.array_equal(numbers_of(left)[name] * np.array(signs.get(name, 1)), value), name
    assert np.array_equal(right.regime, left.regime)
    assert np.array_equal(right.jam, left.jam)


@pytest.mark.parametrize("kind", REGIMES)
def test_impulse_every_regime_agrees_with_oracle(kind: str) -> None:
    rng = np.random.default_rng([8, REGIMES.index(kind)])
    singles = [draw(rng, kind) for _ in range(100)]
    n, out, solutions = columns(singles), impulse(singles), [exact_impulse(item) for item in singles]
    assert_energy_balance(singles, out)
    assert_mirrored(singles, out)
    counts = Counter([*map(regime_of, solutions), *(["jam"] * int(out.jam.sum()))])
    assert counts[kind] >= 30, counts
    assert out.regime.tolist() == [*map(regime_of, solutions)]
    p, mass = np.hypot(*out.impulse.T), n["ball_mass"]
    tangent, p_t, p_n, cue_speed, tip_loss, friction_loss = np.array([item[:6] for item in solutions], float).T
    atol = 1e-12
    assert np.all(abs(np.tan(out.squirt) - tangent) < atol * (1 + tangent**2))  # the decimal solution has the tangent
    assert np.all(abs(np.array([p_t, p_n]) - out.impulse.T) < atol * p)
    np.testing.assert_allclose(out.impulse, mass[:, None] * out.ball_velocity, rtol=1e-14)
    assert np.all(abs(out.spin * n["inertia"] * mass * n["radius"] - out.impulse[:, 0]) < 1e-14 * p)
    assert np.all(abs(cue_speed - out.cue_speed) < atol * n["speed"])
    for name, joules in (("tip loss", tip_loss), ("friction loss", friction_loss)):
        assert np.all(abs(joules - out.energy[name]) < atol * out.energy["initial"]), name


def test_impulse_edge_cases_conserve_energy_and_mirror() -> None:
    singles = [*edges()]
    out = impulse(singles)
    assert all(np.all(np.isfinite(value)) for name, value in numbers_of(out).items() if name != "slip ends")
    assert_energy_balance(singles, out)
    assert_mirrored(singles, out)
