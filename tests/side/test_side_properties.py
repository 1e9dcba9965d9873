"""Properties of the strike from the side: turned beams, scales, order of effects, limits (properties)."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from cuefem import (
    Cue,
    Joint,
    PointMass,
    Resolution,
    SideStrike,
    Striker,
    StructuralDamping,
    Support,
    side_motion,
    side_strike,
)
from cuefem.measured.side.side_accuracy import side_ladder
from tests.helpers.cues import FAMILY, kim, pool, scaled

AT = Resolution(2, 12, 12)
STRIKERS = st.builds(
    lambda mass, e, time: Striker(mass, e, contact_time=time),
    st.floats(1e-3, 0.3),
    st.one_of(st.just(1.0), st.floats(0.1, 1.0)),
    st.floats(0.3e-3, 3e-3),
)
PLACES = st.floats(0.0, 0.7)


def turned(cue: Cue) -> Cue:
    """The beam from its other end."""
    swapped = (
        replace(
            s,
            tip_diameter=s.butt_diameter,
            butt_diameter=s.tip_diameter,
            tip_bore=s.butt_bore,
            butt_bore=s.tip_bore,
        )
        for s in reversed(cue.segments)
    )
    return replace(cue, segments=tuple(swapped))


@settings(max_examples=15)
@given(STRIKERS, PLACES)
def test_a_beam_may_be_drawn_from_either_end(striker: Striker, x: float) -> None:
    cue = kim()
    one = side_strike(SideStrike(cue, striker, x), AT)
    other = side_strike(SideStrike(turned(cue), striker, max(cue.length - x, 0.0)), AT)
    assert abs(one.apparent_restitution - other.apparent_restitution) < 1e-9


@settings(max_examples=15)
@given(STRIKERS, PLACES, st.floats(0.1, 20.0))
def test_a_linear_contact_does_not_know_its_speed(striker: Striker, x: float, speed: float) -> None:
    one, other = (side_strike(SideStrike(kim(), striker, x, v), AT) for v in (1.0, speed))
    assert abs(one.apparent_restitution - other.apparent_restitution) < 1e-10
    assert abs(one.duration / other.duration - 1) < 1e-9
    assert abs(one.effective_mass / other.effective_mass - 1) < 1e-6


def test_hertz_knows_its_speed_by_its_stiffness_alone() -> None:
    """K v^(1/2) is what counts: twice the speed is E* times the root of two."""
    soft = Striker(0.005, 0.8, modulus=1e8, radius=0.02)
    stiff = replace(soft, modulus=1e8 * math.sqrt(2))
    fast, slow = side_strike(SideStrike(kim(), soft, 0.1, 2.0), AT), side_strike(SideStrike(kim(), stiff, 0.1, 1.0), AT)
    # E* sqrt(v): the same depth over time, so the same dimensionless contact
    assert abs(fast.duration / slow.duration - 1) < 1e-8
    assert abs(fast.apparent_restitution - slow.apparent_restitution) < 1e-8


@settings(max_examples=15)
@given(STRIKERS, PLACES, st.floats(0.2, 5.0))
def test_all_masses_and_stiffnesses_scale(striker: Striker, x: float, factor: float) -> None:
    """Everything heavier and stiffer by one factor moves alike."""
    one = side_strike(SideStrike(kim(), striker, x), AT)
    cue = scaled(kim(), E=factor, G=factor, rho=factor)
    other = side_strike(SideStrike(cue, replace(striker, mass=factor * striker.mass), x), AT)
    assert abs(one.apparent_restitution - other.apparent_restitution) < 1e-8
    assert abs(other.impulse / one.impulse / factor - 1) < 1e-8


@settings(max_examples=15)
@given(STRIKERS, PLACES)
def test_the_account_of_energies_and_the_effective_mass(striker: Striker, x: float) -> None:
    outcome = side_strike(SideStrike(kim(), striker, x, 1.3, (StructuralDamping(0.02),)), AT)
    energy = outcome.energy
    assert abs(sum(j for name, j in energy.items() if name != "initial") / energy["initial"] - 1) < 1e-10
    e_A, e = outcome.apparent_restitution, striker.restitution
    m_e = outcome.effective_mass
    assert abs(e_A - (e - striker.mass / m_e) / (1 + striker.mass / m_e)) < 1e-9
    assert -1 < e_A < 1


def test_the_order_and_the_splitting_of_effects_do_not_matter() -> None:
    lump, hand, joint = PointMass(0.1, 4e-3), Support(0.5, 1e4, dashpot=2.0), Joint(0.3, 1e-3)
    scene = SideStrike(pool(), Striker(0.01, 0.7, contact_time=1e-3), 0.05)
    halves = (Support(0.5, 5e3, dashpot=1.0),) * 2
    ways = [(lump, hand, joint), (joint, lump, hand), (joint, PointMass(0.1, 1e-3), PointMass(0.1, 3e-3), *halves)]
    found = [side_strike(replace(scene, effects=effects)).apparent_restitution for effects in ways]
    assert found[0] == found[1]
    assert abs(found[0] - found[2]) < 1e-11
    assert abs(found[0] - side_strike(scene).apparent_restitution) > 1e-3


@pytest.mark.parametrize(
    "effect",
    [PointMass(0.02, 1e-12), Support(0.02, 1e-7), Joint(0.02, 1e-10), StructuralDamping(1e-12)],
    ids=lambda effect: type(effect).__name__,
)
def test_an_effect_that_vanishes_is_none(effect: object) -> None:
    scene = SideStrike(kim(), Striker(0.01, 0.7, contact_time=1e-3), 0.05, effects=(PointMass(0.02, 0.0),))
    at = Resolution(2, 16, 14)
    bare, with_it = (side_strike(replace(scene, effects=(*scene.effects, *more)), at) for more in ((), (effect,)))  # type: ignore[arg-type]
    assert abs(bare.apparent_restitution - with_it.apparent_restitution) < 1e-8


def test_the_motion_begins_and_goes_on_as_it_must() -> None:
    """At rest at first touch; at the end of the contact striker and place move with the speeds of the outcome."""
    scene = SideStrike(pool(), Striker(0.01, 0.7, contact_time=1e-3), 0.1, 2.0)
    outcome, step = side_strike(scene), 1e-7
    moved = side_motion(scene, [0.0, outcome.duration, outcome.duration + step])
    w, theta = moved.deflection([0.0, 0.1, 0.5])
    assert not w[0].any()
    assert not theta[0].any()
    assert abs(np.diff(moved.striker[1:])[0] / step + outcome.rebound_speed) < 1e-6
    assert abs(np.diff(w[1:, 1])[0] / step - outcome.place_speed) < 1e-2 * abs(outcome.place_speed)
    depth = (1 - scene.striker.restitution**2) * float(moved.striker.max())  # what it keeps of its compression
    assert 0 <= moved.striker[1] - w[1, 1] <= depth


@pytest.mark.heavy
@pytest.mark.parametrize("name", sorted(FAMILY))
def test_the_default_is_within_1e_4_of_e_A_wherever_it_strikes(name: str) -> None:
    """Masses, contact times and places drawn at random, against the last rung of the ladder below 320 unknowns."""
    rng = np.random.default_rng(7)
    cue = FAMILY[name]
    for _ in range(4):
        mass, time = np.exp(rng.uniform(np.log([1e-3, 0.3e-3]), np.log([0.2, 3e-3])))
        x = float(rng.choice([0.0, rng.uniform(0, 0.15), rng.uniform(0, cue.length)]))
        scene = SideStrike(cue, Striker(float(mass), float(rng.uniform(0.3, 1)), contact_time=float(time)), x)
        best = next(each for each in side_ladder(scene) if each.unknowns > 320)
        assert abs(side_strike(scene).apparent_restitution - best.apparent_restitution) < 1e-4
