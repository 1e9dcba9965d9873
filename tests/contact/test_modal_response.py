"""Propagation of the modes over a step and their losses against exponentials of the whole system (verification)."""

from __future__ import annotations

import gc
import weakref
from dataclasses import replace

import numpy as np
import pytest
import scipy.linalg as la

import cuefem as cf
from cuefem.beam.tip_modes import TipModes
from cuefem.contact.modal_response import level_propagator
from cuefem.contact.strike import strike_modes
from tests.helpers.strike_scenes import custom_tip_modes

# A rigid axial and a rigid transverse mode, and modes of 1e-6 to 30 radians in a step of 1e-5 s.
OMEGA = [0.1, 300.0, 2e4, 1e5, 3e5, 3e6]
H = 1e-5


def damped_modes(*, loss: float, radiation: float) -> TipModes:
    tip = custom_tip_modes(OMEGA, [5.0, 6.0, -7.0, 8.0, -3.0, 2.0])
    rows = np.array([[0, 0, 0, 0, 0, 0, 1.0, -0.4], [0, 0, 0, 0, 0, 0, 0.3, 0.8]])
    return replace(
        tip, loss=loss * (tip.omega > 0) * np.linspace(0.5, 1.0, len(tip.omega)), radiation=radiation * rows.T @ rows
    )


def whole_system(tip: TipModes) -> np.ndarray:
    """Of the velocities v, a = omega q, constant modal loads and the integral of v."""
    n = len(tip.omega)
    zero, one, rates = np.zeros((n, n)), np.eye(n), np.diag(tip.omega)
    return np.block([[-tip.damping, -rates, one, zero], [rates, zero, zero, zero], [zero] * 4, [one, zero, zero, zero]])


@pytest.mark.parametrize("loss", [0.0, 0.01, 0.99])
@pytest.mark.parametrize("radiation", [0.0, 1e5])
def test_step_of_modes_equals_exponential_of_whole_system(loss: float, radiation: float) -> None:
    tip = damped_modes(loss=loss, radiation=radiation)
    propagator, n, rng = level_propagator(tip, turns=False), len(tip.omega), np.random.default_rng(1)
    state, load = rng.normal(size=(2, n)), rng.normal(size=2)
    exact = la.expm(whole_system(tip) * H) @ np.concatenate([*state, load @ propagator.ports * 1e5, np.zeros(n)])
    tables = propagator.tables(H)
    end = tables.ends @ state.ravel() + tables.end_per_load @ load * 1e5
    mean = tables.means @ state.ravel() + tables.mean_per_load @ load * 1e5
    np.testing.assert_allclose(end, propagator.ports @ exact[:n], rtol=1e-11)
    np.testing.assert_allclose(mean * H, propagator.ports @ exact[3 * n :], rtol=1e-11)


def test_cues_struck_earlier_leave_no_tables_behind() -> None:
    """Without the garbage collector: an estimate strikes hundreds of cues, whose tables have 1 MB each."""
    scene = cf.Scene(cf.LumpedCue(0.54, 0.01), tip=cf.Tip(contact_time=1e-3), stroke=cf.Stroke(offset=0.3))
    gc.disable()
    try:
        tips = [custom_tip_modes(OMEGA, [5.0 + i, 6.0, -7.0, 8.0, -3.0, 2.0]) for i in range(20)]
        propagators = [weakref.ref(level_propagator(tip, turns=False)) for tip in tips if strike_modes(scene, tip)]
        assert propagators[0]() is propagators[3]() is None
    finally:
        gc.enable()


def test_impact_is_the_limit_of_short_steps_under_the_same_impulse() -> None:
    tip = replace(damped_modes(loss=0.5, radiation=1e5), dashpots=np.linspace(-1.0, 2.0, len(OMEGA) + 2)[None])
    propagator, h = level_propagator(tip, turns=False), 1e-9
    impact, short = propagator.tables(0.0), propagator.tables(h)
    assert (impact.h, impact.load_time, impact.dashpots.any()) == (0.0, 1.0, False)
    radiating, per_impulse = short.radiating.copy(), 1 / h
    radiating[:, 2 * len(propagator.radiating) :] *= per_impulse
    limits = [(getattr(impact, name), getattr(short, name)) for name in ("own", "ends", "means")]
    for name in ("end_per_load", "mean_per_load", "response"):
        limits.append((getattr(impact, name), getattr(short, name) * per_impulse))
    for limit, table in [*limits, (impact.radiating, radiating)]:
        np.testing.assert_allclose(table, limit, atol=0.01 * np.abs(limit).max() + 1e-4)


@pytest.mark.parametrize("bent", [(), (cf.GeometricStiffness(),)], ids=["straight", "bent"])
def test_strike_energy_closes_with_every_damper(bent: tuple[cf.Effect, ...]) -> None:
    """handbook: The contact; the law's force at mid-step leaves 1e-10."""
    shaft = cf.Segment(0.7, 0.0125, 0.021, cf.Material(12.6e9, 0.84e9, 700.0))
    dashpots = cf.Support(0.2, 1e3, 0.0, 30.0), cf.Support(0.5, dashpot=5.0)
    effects = (cf.StructuralDamping(0.02), *dashpots, cf.AxialWaves(), *bent)
    scene = cf.Scene(
        cf.Cue((shaft,), body_mass=0.42), tip=cf.Tip(contact_time=1e-3), stroke=cf.Stroke(2.0, 0.3), effects=effects
    )
    energy = dict(cf.strike(scene).energy)
    assert energy["damping loss"] > 1e-3 * energy["initial"]
    assert sum(energy.values()) == pytest.approx(2 * energy["initial"], rel=1e-9)
