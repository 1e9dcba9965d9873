"""The pendulum test: handbook example, free masses, side strike, noise, contradictions (verification)."""

import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import cuefem as cf
from cuefem.measurements.measured_folder import load_measured
from cuefem.measurements.measurement_types import EndMass, Setup
from cuefem.measurements.pendulum import GRAVITY, Pendulum
from tests.helpers.measured_cues import SCENE, measured_folder

TEXT = """[[pendulum]]
ball_mass = "8 g"
thread_length = "1 m"
release = ["200 mm"]
rebound = ["-34 mm"]
clamped_rebound = ["162 mm"]
contact_time = "1 ms"
position = "10 mm"
"""
TWICE = TEXT.replace('"-34 mm"', '"-34 mm", "-35 mm"').replace('"162 mm"', '"162 mm", "161 mm"')
BY_HERTZ = TWICE.replace('contact_time = "1 ms"', 'force = "50 N"\nindentation = "0.5 mm"')


def measured(text: str, directory: Path) -> EndMass:
    (result,) = load_measured(measured_folder(directory, text))[0].measurements
    assert isinstance(result, EndMass)
    return result


def swing(speed: float) -> float:
    """Displacement of a pendulum of 1 m for a speed, m/s."""
    return math.copysign(math.sin(2 * math.asin(abs(speed) / (2 * math.sqrt(GRAVITY)))), speed)


def of_speeds(m: float, back: float, clamped: float, U: float = 0.6, **more: float) -> Pendulum:
    swings = {"release": (swing(U),), "rebound": (swing(back),), "clamped_rebound": (swing(clamped),)}
    return Pendulum(ball_mass=m, thread_length=1.0, position=0.02, contact_time=1e-3, **swings, **more)


def test_pendulum_handbook_readings_give_its_numbers(tmp_path: Path) -> None:
    """6.80 ± 0.12 g for 1 ms; 6.78 ± 0.11 g of two rebounds, for 1.01 ms by force and depth."""
    one = measured(TEXT, tmp_path / "one")
    assert (round(1e3 * one.value, 2), round(1e3 * one.error, 2)) == (6.80, 0.12)
    two = measured(BY_HERTZ, tmp_path / "two")
    assert (round(1e3 * two.value, 2), round(1e3 * two.error, 2)) == (6.78, 0.11)
    assert two.contact_time == pytest.approx(1.01e-3, rel=5e-3)
    assert two.contact_time_error == pytest.approx(0.1 * two.contact_time)


@pytest.mark.parametrize("m", [3e-3, 0.8 * 7.3e-3, 7e-3, 20e-3])
def test_pendulum_on_free_mass_is_exact(m: float) -> None:
    """Momentum and restitution: a ball of mass m against a free mass M; at m = e M it stops."""
    M, e, U = 7.3e-3, 0.8, 0.6
    result = of_speeds(m, U * (e * M - m) / (m + M), e * U).end_mass
    assert result.value == pytest.approx(M, rel=1e-12)
    assert result.restitution == pytest.approx(e, rel=1e-12)


def test_pendulum_on_shaft_equals_side_strike() -> None:
    ball = cf.Striker(8e-3, 0.8, contact_time=1e-3)
    outcome = cf.side_strike(cf.SideStrike(SCENE.shaft, ball, 0.02))
    result = of_speeds(8e-3, 0.6 * outcome.apparent_restitution, 0.6 * 0.8).end_mass
    assert result.value == pytest.approx(outcome.effective_mass, rel=1e-9)
    assert result.compute(Setup(SCENE)) == pytest.approx(outcome.effective_mass, rel=1e-9)


def test_pendulum_error_covers_noise_of_readings() -> None:
    """300 tests with noise in every reading and in the ball's mass: 68 % within the stated error."""
    generator, M, e, m, U = np.random.default_rng(4), 7e-3, 0.8, 6e-3, 0.6
    back, inside = U * (e * M - m) / (m + M), []
    for _ in range(300):
        off = generator.normal(scale=1e-3, size=(4, 3))
        speeds = zip((U, back, U, e * U), off.tolist(), strict=True)
        release, rebound, clamped_release, clamped_rebound = (
            tuple(swing(speed) + x for x in row) for speed, row in speeds
        )
        weighed = m + 5e-5 * generator.normal()
        clamped = {"clamped_release": clamped_release, "clamped_rebound": clamped_rebound}
        swings = {"release": release, "rebound": rebound, **clamped}
        result = replace(of_speeds(m, back, e * U), ball_mass=weighed, ball_mass_error=5e-5, **swings).end_mass
        inside.append(abs(result.value - M) < result.error)
    assert np.mean(inside) == pytest.approx(0.683, abs=0.08)
    wild = replace(of_speeds(m, back, e * U), rebound=(0.01, 0.02, 0.03)).end_mass
    assert wild.error > 3 * replace(of_speeds(m, back, e * U), rebound=(0.02, 0.02, 0.02)).end_mass.error
