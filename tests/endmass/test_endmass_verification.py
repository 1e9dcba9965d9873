"""End masses: rigid and infinite limits, quadrature in time, reference values (verification)."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
import pytest
from scipy.integrate import quad

from cuefem import Cue, LumpedCue, Resolution, Scene, end_mass, modes
from cuefem.beam.assembly import assemble
from cuefem.beam.modes import solve
from cuefem.beam.tip_modes import TipModes
from cuefem.endmass.definitions import force, velocity
from cuefem.scene.solved_scene import default_mode_count, tip_modes_from, tip_modes_of
from tests.helpers.cues import cone, kim, rod, scaled, scene


def few_modes(count: int = 6) -> TipModes:
    return tip_modes_of(scene(kim(), 1e-3), Resolution(2, 16, count))


# --- the rigid limit: mass / m_e = 1 + m xbar^2 / (int rhoA (x - xbar)^2 + int rhoI) ---


def rigid_ratio(cue: Cue) -> float:
    points, weights = np.polynomial.legendre.leggauss(12)
    centre, spun = cue.balance_point, 0.0
    for segment, start in zip(cue.segments, cue.nodes, strict=False):
        s = segment.length * (points + 1) / 2
        section = segment.section(s)
        spun += segment.length / 2 * weights @ (section.rhoA * (start + s - centre) ** 2 + section.rhoI)
    return 1 + cue.shaft_mass * centre**2 / spun


def ratio(cue: Cue, periods: float, drive: str) -> float:
    """mass / m_e for a pulse of ``periods`` periods of the lowest mode; a slow cue is stiffened, so that T is 1 s."""
    T = periods / modes(cue, 1).frequencies[0]
    if T > 1:
        cue, T = scaled(cue, E=T**2, G=T**2), 1.0
    return cue.shaft_mass / end_mass(scene(cue, T), drive, at=Resolution(1, 20, 8))


@pytest.mark.parametrize("drive", ["force", "velocity"])
@pytest.mark.parametrize(
    ("cue", "limit"),
    [(kim(), 5.494268), (rod(3e3), 4.0), (cone(3e3, 0.4), 6.8318457694)],
    ids=["kim", "rod", "cone 0.4"],
)
def test_end_mass_long_pulse_equals_rigid_cue(cue: Cue, limit: float, drive: str) -> None:
    computed = ratio(cue, 1e4, drive)
    np.testing.assert_allclose(computed, rigid_ratio(cue), rtol=1e-7)
    np.testing.assert_allclose(computed, limit, rtol=1e-6)


# --- a beam so long that no wave is reflected ---


@pytest.fixture(scope="module")
def long_rod() -> tuple[TipModes, Scene, float]:
    """Tip modes of a thin rod 60 wavelengths long, and the unit rhoA sqrt(T sqrt(EI/rhoA)) of Euler's beam."""
    cue, T = rod(3000.0, diameter=1e-3), 5e-4
    s = cue.section(0.0)
    pulse_scene = scene(cue, T)
    count = default_mode_count(pulse_scene, periods=45)
    tip = tip_modes_from(solve(assemble(cue, count), count), pulse_scene)
    return tip, pulse_scene, float(s.rhoA) * math.sqrt(T * math.sqrt(float(s.EI / s.rhoA)))


@pytest.mark.parametrize(("formula", "constant"), [(force, 0.79021), (velocity, 0.54814)])
def test_end_mass_long_rod_equals_semi_infinite_beam(
    long_rod: tuple[TipModes, Scene, float], formula: Callable[[TipModes, Scene], float], constant: float
) -> None:
    tip, pulse_scene, unit = long_rod
    np.testing.assert_allclose(formula(tip, pulse_scene) / unit, constant, rtol=0.01)


# --- the same definitions solved in time, mode by mode ---


@pytest.mark.parametrize("T", [0.8e-3, 2e-3])
def test_force_end_mass_equals_quadrature(T: float) -> None:
    tip = few_modes()
    omega, phi = tip.omega[1:], tip.amplitude[1:, 1]
    velocity_integral, _ = quad(
        lambda s: math.sin(math.pi * s / T) * (phi**2 @ np.cos(omega * (T - s))), 0, T, epsrel=1e-12, limit=400
    )
    np.testing.assert_allclose(force(tip, scene(kim(), T)), 2 * T / math.pi / velocity_integral, rtol=1e-11)


def test_force_end_mass_is_continuous_at_resonance() -> None:
    """A half-sine of half a period of an undamped mode: its integral is the limit of those beside it."""
    T = 2.0**-10  # of which the frequency is an exact quotient
    tip = few_modes()
    tip.omega[3] = np.pi / T
    at, beside = (force(tip, scene(kim(), T * factor)) for factor in (1.0, 1 + 1e-7))
    assert at == pytest.approx(beside, rel=1e-6)


# --- known values ---


@pytest.mark.parametrize("drive", ["stick", "velocity", "force", "squirt"])
def test_end_mass_lumped_cue_is_its_own(drive: str) -> None:
    lumped = Scene(LumpedCue(0.54, 0.0123))
    assert end_mass(lumped, drive) == end_mass(lumped, drive, rtol=1e-3) == 0.0123
