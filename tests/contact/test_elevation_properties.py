"""What holds for every raised cue: energy, mirror, a ball that the table keeps up, refusals, files."""

from dataclasses import replace

import cuefem.contact.elevation
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from cuefem import (
    Elevation,
    LumpedCue,
    PowerLawTip,
    RollingContact,
    Scene,
    SecondHit,
    Stroke,
    StructuralDamping,
    Tip,
    TipDome,
    TipShear,
    load,
    save,
    strike,
)
from cuefem.contact.strike import strike_modes
from tests.helpers.strike_scenes import FRICTION, OFFSET, hand_made, imbalance, kim_scene, numbers, sound

VIBRATING = hand_made([500.0, 3000.0], [5.0, 8.0], rigid=9.0)
ANGLE = st.one_of(st.sampled_from([0.0, 1e-6, 0.03]), st.floats(0.001, 1.4))
TABLE = st.one_of(st.sampled_from([0.0, 0.2]), st.floats(0.01, 3.0))


@pytest.mark.heavy
@settings(max_examples=20)
@given(ANGLE, TABLE, OFFSET, st.floats(0.1, 1.0), FRICTION)
def test_energy_closes_and_the_other_side_mirrors(angle, table, offset, e, friction):
    scene = replace(kim_scene(offset, restitution=e, friction=friction), effects=(Elevation(angle, table),))
    outcome = strike_modes(scene, VIBRATING)
    assert np.all(np.isfinite(numbers(outcome)))
    assert imbalance(outcome) < 1e-10
    assert all(part >= -1e-10 * outcome.energy["initial"] for part in outcome.energy.values())
    assert outcome.phases[-1].end == outcome.duration
    assert outcome.history.velocity[2] > -1e-9
    other = strike_modes(replace(scene, stroke=Stroke(offset=-offset)), VIBRATING)
    mirrored = numbers(other)
    mirrored[[0, 1, 4, 6]] *= -1  # squirt, V_t, spin, impulse along t
    assert np.array_equal(numbers(outcome), mirrored)
    assert np.array_equal(outcome.history.velocity, other.history.velocity * [-1, 1, 1])
    assert np.array_equal(outcome.history.spin, other.history.spin * [1, -1, -1])


@pytest.mark.heavy
def test_order_of_the_list_does_not_matter():
    listed = (Elevation(0.2), PowerLawTip(1.5), TipDome(0.009), StructuralDamping(0.02))
    first, second = (strike(replace(kim_scene(0.4), effects=effects)) for effects in (listed, listed[::-1]))
    assert np.array_equal(numbers(first), numbers(second))
    sound(first)
    assert first.energy["damping loss"] > 0


def test_what_is_not_listed_is_not_entered(monkeypatch):
    calls = []
    monkeypatch.setattr(cuefem.contact.elevation, "raised_contact", lambda *args: calls.append(args))
    strike_modes(replace(kim_scene(0.3), effects=(RollingContact(),)), VIBRATING)
    assert calls == []


@pytest.mark.parametrize("other", [TipShear(0.75), RollingContact(), SecondHit()])
@pytest.mark.parametrize("after", [True, False])
def test_what_does_not_go_together_is_refused(other, after):
    raised = Elevation(0.1)
    effects, mine = ((other, raised), 1) if after else ((raised, other), 0)
    words = rf"Scene\.effects\[{mine}\] must be an effect that goes with effects\[{1 - mine}\], {type(other).__name__};"
    with pytest.raises(ValueError, match=f"{words} got Elevation, which does not"):
        replace(kim_scene(), effects=effects)


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: Elevation(1.6), r"Elevation.angle must be in \[0, 1.57\d*\) rad; got 1.6"),
        (lambda: Elevation(-0.1), r"Elevation.angle must be in \[0, 1.57\d*\) rad; got -0.1"),
        (lambda: Elevation(0.1, -1.0), r"Elevation.friction must be in \[0, inf\); got -1.0"),
        (lambda: replace(kim_scene(), effects=(Elevation(0.1), Elevation(0.2))), "Elevation acts once"),
        (
            lambda: strike_modes(replace(kim_scene(restitution=0.0), effects=(Elevation(0.1),)), VIBRATING),
            r"Elevation takes a Tip.restitution in \(0, 1\]; got 0.0",
        ),
    ],
)
def test_wrong_values_are_refused(make, message):
    with pytest.raises(ValueError, match=message):
        make()


def test_elevation_stands_in_files(tmp_path):
    scene = Scene(LumpedCue(0.54, 0.006), tip=Tip(0.7, 0.6, 1e-3), effects=(Elevation(0.1, 0.25),))
    save(scene, tmp_path / "raised.toml")
    assert load(tmp_path / "raised.toml") == scene
