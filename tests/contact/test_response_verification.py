"""The exact response of the modes to forces that are polynomials over a step, against exponentials of matrices."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.linalg import expm

from cuefem.contact.response import EVEN, NODES, OPENING, FreeMotion, Response
from cuefem.contact.state import Contact, Laws
from cuefem.cue import Array
from tests.helpers.strike_scenes import hand_made

LAWS = Laws(0.3, 0.17, 0.4, 1e6, 0.75, 0.7, 1e-3, 1.0)


def damped(kind: str) -> Contact:
    """Modes from 0 to 120 kHz, undamped, each damped, coupled by dashpots, or with a tail that radiates."""
    tip = hand_made([500.0, 3000.0, 9000.0, 120e3], [5.0, 8.0, 7.0, 9.0], rigid=9.0)
    count = len(tip.omega)
    rows = {"none": None, "each": np.diag(0.02 * tip.omega), "one critical": np.zeros((count, count))}
    rows["coupled"] = np.outer(tip.amplitude[:, 1], tip.amplitude[:, 1]) * 20.0
    if kind == "one critical":
        rows[kind][3, 3] = 2 * tip.omega[3]
    if kind == "tail":
        radiation = np.zeros((count, count))
        radiation[-2:, -2:] = 2e5 * np.array([[1.0, -0.6], [-0.6, 0.5]])
        return Contact(replace(tip, radiation=radiation), LAWS, ("spin",))
    return Contact(replace(tip, damping=rows[kind]), LAWS, ("spin",))


def by_exponential(contact: Contact, rows: Array, step: float, z: Array, powers: Array) -> Array:
    """The state after a step under forces powers @ (1, s, s^2, ...), s the part of the step, (m, count)."""
    count = powers.shape[1]
    size = len(z)
    A = np.zeros((size + count,) * 2)
    A[:size, :size], A[:size, size:] = step * contact.free, step * rows.T @ powers
    A[size + 1 :, size:-1] = np.diag(np.arange(1.0, count))  # (s^k)' = k s^(k - 1)
    return (expm(A) @ np.concatenate([z, np.eye(count)[0]]))[:size]


@pytest.mark.parametrize("kind", ["none", "each", "coupled", "one critical", "tail"])
@pytest.mark.parametrize("step", [1e-7, 3e-6, 5e-5])
def test_a_step_is_what_the_exponential_says(kind: str, step: float) -> None:
    contact, rng = damped(kind), np.random.default_rng(1)
    rows = rng.normal(size=(4, len(contact.z)))
    rows[:, contact.slots.vibration] = 0.0  # forces act on velocities
    free = FreeMotion.of(contact, rows)
    z, powers = rng.normal(size=len(contact.z)), 1e4 * rng.normal(size=(4, 6))
    xi = free.onto @ z
    rounding = 1e-8 if kind == "one critical" else 1e-11  # where two rates are one, half of the digits are lost
    assert free.state(xi) == pytest.approx(z, rel=0, abs=rounding)
    response = Response.of(free, step, EVEN)
    forces = powers @ EVEN.times ** np.arange(6)[:, None]
    told = by_exponential(contact, rows, step, z, powers)
    size = float(np.abs(told).max())
    assert np.abs(free.state(response.coordinates(xi, forces)) - told).max() < rounding * size
    assert np.abs(free.state(response.all_coordinates(xi, forces)[:, -1]) - told).max() < rounding * size
    part = 0.37
    cut = by_exponential(contact, rows, part * step, z, powers * part ** np.arange(6))
    assert np.abs(free.state(free.shift(xi, step, EVEN, forces, part)) - cut).max() < rounding * size
    # what is read at the nodes: two rows in turns, then the other two
    loads = np.concatenate([forces[:2].T.ravel(), forces[2], forces[3]])
    read = (response.own @ xi).real + response.answer @ loads
    states = free.vectors @ response.all_coordinates(xi, forces)
    assert pytest.approx((rows[:2] @ states).real, abs=1e-9 * size) == read[: 2 * NODES].reshape(NODES, 2).T
    assert read[2 * NODES :].reshape(2, NODES) == pytest.approx((rows[2:] @ states).real, abs=1e-9 * size)


def test_an_opening_step_takes_forces_that_grow_with_a_root_of_time() -> None:
    contact = damped("none")
    rows = contact.c_n[None, :]
    free, step = FreeMotion.of(contact, np.repeat(rows, 4, axis=0)), 2e-5
    forces = np.zeros((4, NODES))
    forces[0] = OPENING.times**1.5
    z = free.state(Response.of(free, step, OPENING).coordinates(np.zeros(len(free.rates), complex), forces))
    for i, omega in enumerate(contact.omega):
        at = contact.slots.swinging.start + i
        told = quad(lambda s, w=omega: s**1.5 * np.cos(w * step * (1 - s)), 0, 1, epsabs=0, epsrel=1e-12)[0]
        assert z[at] == pytest.approx(step * rows[0, at] * told, rel=1e-10)


@pytest.mark.parametrize("rule", [EVEN, OPENING])
def test_a_rule_integrates_and_extends_what_it_holds(rule) -> None:
    values = rule.times**2.5 if rule is OPENING else rule.times**3
    whole = 1 / 3.5 if rule is OPENING else 0.25
    assert rule.sums(1.0) @ values == pytest.approx(whole, rel=1e-13)
    assert rule.sums(0.3) @ values == pytest.approx(whole * 0.3 ** (1 / whole), rel=1e-12)
    assert rule.function(values)(0.3) == pytest.approx(0.3 ** (1 / whole - 1), rel=1e-12)
    if rule is EVEN:
        assert rule.slopes @ values == pytest.approx([1.0, 3.0, 3.0, 1.0], rel=1e-9)
