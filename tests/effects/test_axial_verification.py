"""Verification of the waves along a cue: against closed forms, a chain of masses stepped in time, and many modes."""

import math
from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np
import pytest

from cuefem import (
    AxialWaves,
    Ball,
    Cue,
    Outcome,
    Scene,
    Segment,
    Stroke,
    Tip,
    load,
    strike,
)
from cuefem.beam.modes import Modes, solve
from cuefem.beam.system import assemble
from cuefem.beam.tail import tail
from cuefem.beam.waves import mesh_for
from cuefem.contact.strike import strike_modes
from cuefem.effects.axial import rod_modes
from cuefem.materials import MATERIALS
from cuefem.tip_modes import tip_modes_from
from tests.helpers.orders import assert_order

MESHES = Path(__file__).parents[2] / "meshes"
LEATHER, MAPLE = MATERIALS["leather"].material, MATERIALS["hard maple"].material
TIP = Tip(0.73, 0.7, contact_time=1.1e-3)


@cache
def drawn(name: str) -> Cue:
    """A reference cue."""
    cue = load(MESHES / f"{name}.toml")
    assert isinstance(cue, Cue)
    return cue


def head_on(cue: Cue) -> Scene:
    return Scene(cue, Ball(), TIP, Stroke(1.0, 0.0), (AxialWaves(),))


def seen(outcome: Outcome, cue: Cue) -> tuple[float, float]:
    """Contact time, s, and the restitution that the ball's speed shows, of a cue that is rigid along its axis."""
    return outcome.duration, outcome.ball_speed * (1 + Ball().mass / cue.mass) - 1


# --- the leather is part of the tip's spring ------------------------------------------------------------------------


@pytest.mark.parametrize("E", [45e6, 210e6])
def test_on_stiff_wood_a_head_on_blow_gives_the_scenes_contact_time_and_restitution(E):
    """What the wood adds vanishes like one over its stiffness, whatever the leather's own; its mass is felt."""
    leather = Segment(0.006, 0.01275, 0.01275, replace(LEATHER, E=E, G=0.36 * E))
    steps, longer, more = 4.0 ** -np.arange(1, 6), [], []
    for x in steps:
        wood = replace(MAPLE, E=MAPLE.E / x, G=MAPLE.G / x)
        cue = Cue((leather, Segment(0.73, 0.0128, 0.0215, wood)), 0.467)
        T, e = seen(strike(head_on(cue)), cue)
        longer.append(T - TIP.contact_time)
        more.append(e - TIP.restitution)
    assert_order(1.0, steps, longer, within=0.15)
    assert_order(1.0, steps, more, within=0.3)
    assert longer[-1] < 2e-3 * TIP.contact_time
    assert more[-1] < 2e-3


def stepped(cue: Cue, pieces: int = 200) -> tuple[float, float]:
    """Contact time, s, and the restitution seen: a chain of masses and springs behind the tip's spring, in small
    steps."""
    x = np.linspace(cue.leather, cue.length, pieces + 1)
    inside = cue.section((x[:-1] + x[1:]) / 2)
    h = x[1] - x[0]
    springs, lumps = inside.EA / h, inside.rhoA * h
    m = np.r_[0.0, lumps / 2] + np.r_[lumps / 2, 0.0]
    m[0] += sum(s.mass for s, end in zip(cue.segments, cue.nodes[1:], strict=True) if end <= cue.leather * 1.000001)
    m[-1] += cue.body_mass
    k, e = head_on(cue).stiffness, TIP.restitution
    v, squeeze = np.ones(pieces + 1), np.zeros(pieces)
    ball = pressed = most = time = 0.0
    dt = 0.2 * h / math.sqrt(MAPLE.E / MAPLE.rho)
    while True:
        most = max(most, pressed)
        force = max(k * most - k / e**2 * (most - pressed), 0.0)
        if time > 0 and force == 0:
            return time, ball * (1 + Ball().mass / cue.mass) - 1
        held = np.r_[0.0, springs * squeeze] - np.r_[springs * squeeze, 0.0]
        held[0] -= force
        v += dt * held / m
        ball += dt * force / Ball().mass
        squeeze += dt * (v[:-1] - v[1:])
        pressed += dt * (v[0] - ball)
        time += dt


@pytest.mark.parametrize(("name", "T", "e"), [("kim", 1.251e-3, 0.7795), ("pool_maple", 1.269e-3, 0.7808)])
def test_what_the_wood_adds_is_what_a_chain_of_masses_says(name, T, e):
    """The remainder, of 1.1 ms and 0.73: about 0.16 ms and 0.05."""
    cue = drawn(name)
    found = seen(strike(head_on(cue)), cue)
    assert found == pytest.approx(stepped(cue), rel=2e-3)
    assert found == pytest.approx((T, e), rel=5e-4)


# --- the tail of the rod's modes ------------------------------------------------------------------------------------


@pytest.mark.parametrize("below", [1e3, 2e5])
def test_with_its_tail_the_rod_gives_way_as_much_as_all_of_its_modes(below):
    """A free uniform rod on springs of s per mass under a steady force at its end: the sum of along^2/(omega^2 + s),
    for the s = 10 (c/L)^2 with which the tail is made, is coth(L sqrt(s)/c) / sqrt(s EA rhoA), rigid motion and all."""
    cue = Cue((Segment(0.7, 0.012, 0.012, MAPLE),))
    system, section = assemble(cue, elements=8, order=12), cue.section(0.0)
    s = 10 * section.EA / section.rhoA / cue.length**2
    exact = 1 / np.tanh(math.sqrt(10)) / np.sqrt(s * section.EA * section.rhoA) - 1 / (cue.mass * s)
    found = rod_modes(system, cue, (), below=below, tailed=True)
    assert len(found.omega) == 2 + np.sum(found.omega[:-2] <= below)
    assert np.sum(found.along**2 / (found.omega**2 + s)) == pytest.approx(exact, rel=1e-11)
    plain = rod_modes(system, cue, (), below=below)
    assert plain.radiation is None
    assert np.sum(plain.along**2 / (plain.omega**2 + s)) < 0.95 * exact


def struck(name: str, T: float, offset: float) -> Scene:
    """A reference cue with waves along it."""
    return Scene(drawn(name), tip=Tip(contact_time=T), stroke=Stroke(1.0, offset), effects=(AxialWaves(),))


@cache
def many(name: str) -> Modes:
    """250 modes of a reference cue."""
    elements, order = mesh_for(drawn(name), 250)
    return solve(assemble(drawn(name), elements=elements, order=order), 250)


def at_modes(waves: Scene, name: str, count: int, *, tailed: bool) -> np.ndarray:
    """Squirt, ball speed and contact time."""
    whole = many(name)
    kept = replace(whole, frequencies=whole.frequencies[:count], vectors=whole.vectors[:, :count])
    outcome = strike_modes(waves, tip_modes_from(tail(kept) if tailed else kept, waves))
    return np.array([outcome.squirt, outcome.ball_speed, outcome.duration])


@pytest.mark.heavy
@pytest.mark.parametrize("T", [0.5e-3, 0.7e-3, 1e-3, 1.4e-3, 2e-3, 3e-3])
@pytest.mark.parametrize("name", ["kim", "pool_maple", "pool_hollow"])
def test_the_default_holds_half_a_percent_of_squirt(name, T):
    waves = struck(name, T, 0.3)
    exact = at_modes(waves, name, 250, tailed=True)
    assert strike(waves).squirt == pytest.approx(exact[0], rel=5e-3)
