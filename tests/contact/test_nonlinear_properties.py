"""What holds for every nonlinear effect: energy, mirror, scale, order of the list, what is not listed, refusals."""

from dataclasses import replace

import numpy as np
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from cuefem import (
    PowerLawTip,
    RollingContact,
    SecondHit,
    Stroke,
    StructuralDamping,
    TipDome,
    TipShear,
    end_mass,
    strike,
)
from cuefem.beam.tip import TipModes
from cuefem.contact.strike import strike_modes
from tests.helpers.strike_scenes import (
    FRICTION,
    OFFSET,
    RESTITUTION,
    SIGN,
    hand_made,
    imbalance,
    kim_scene,
    numbers,
    sound,
)

FEW = settings(max_examples=12)


def bent(damping: float = 0.0) -> TipModes:
    """A shaft of a few modes by hand whose end section turns with them, each damped or none."""
    tip = hand_made([500.0, 3000.0, 9000.0], [5.0, 8.0, 7.0], rigid=9.0)
    tip = replace(tip, rotation=np.array([0, -50.0, -60.0, -80.0, -120.0]))
    return replace(tip, damping=np.diag(damping * tip.omega)) if damping else tip


EFFECTS = st.sets(
    st.sampled_from([PowerLawTip(1.5), RollingContact(), SecondHit(2e-3), TipDome(0.009), TipShear(0.75)]), min_size=1
).map(lambda chosen: tuple(sorted(chosen, key=repr)))


@FEW
@given(EFFECTS, RESTITUTION, FRICTION, OFFSET, SIGN, st.sampled_from([0.0, 0.02]))
def test_energy_closes_and_the_other_side_mirrors(effects, e, friction, offset, side, damping):
    assume(e >= 0.1 or SecondHit(2e-3) not in effects)
    scene = replace(kim_scene(offset, restitution=e, friction=friction), effects=effects)
    outcome = strike_modes(scene, bent(damping))
    sound(outcome)
    assert imbalance(outcome) < 1e-10
    assert ("damping loss" in outcome.energy) == (damping > 0)
    other = strike_modes(replace(scene, stroke=Stroke(offset=-offset)), bent(damping))
    odd = [0, 1, 4, 6]  # squirt, V_t, spin, impulse along t
    mirrored = numbers(other)
    mirrored[odd] *= -1
    assert np.array_equal(numbers(outcome), mirrored)


@FEW
@given(st.floats(1.0, 3.0), st.floats(0.2, 8.0), st.floats(0.2, 8.0), OFFSET)
def test_a_power_law_knows_no_speed_of_its_own(exponent, speed, reference, offset):
    """The law that lasts T at one speed is the law that lasts T (U/U0)^((1-n)/(1+n)) at another."""
    scene = replace(kim_scene(offset), stroke=Stroke(speed, offset))
    time = 1e-3 * (speed / reference) ** ((1 - exponent) / (1 + exponent))
    other = replace(scene.tip, contact_time=time)
    first = strike_modes(replace(scene, effects=(PowerLawTip(exponent, reference),)), bent())
    second = strike_modes(replace(scene, tip=other, effects=(PowerLawTip(exponent, speed),)), bent())
    assert np.allclose(numbers(first), numbers(second), rtol=1e-9, atol=1e-9 * speed**2)


def test_they_go_with_the_effects_on_the_cue():
    scene = replace(
        kim_scene(0.4),
        effects=(StructuralDamping(0.02), PowerLawTip(1.5), RollingContact(), TipDome(0.009), SecondHit()),
    )
    outcome = strike(scene)
    sound(outcome)
    assert outcome.energy["damping loss"] > 0
    assert 0.002 < end_mass(scene) < 0.05
