"""What holds for every effect: energy closes, the list's order is irrelevant, what is not listed is never entered."""

from collections.abc import Iterator
from dataclasses import replace
from math import inf

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

import cuefem.effects.axial
import cuefem.effects.loss
from cuefem import (
    AxialWaves,
    Elevation,
    GeometricStiffness,
    Joint,
    LumpedCue,
    PointMass,
    PowerLawTip,
    Resolution,
    RollingContact,
    Scene,
    SecondHit,
    StructuralDamping,
    Support,
    TipDome,
    TipShear,
    strike,
)
from cuefem.effects import CueEffect, Effect, TipEffect
from tests.helpers.strike_scenes import FRICTION, KIM, OFFSET, RESTITUTION, SIGN, imbalance, kim_scene, numbers, sound

AT = Resolution(2, 14, 10)
EXAMPLES = (
    PointMass(0.1, 0.011, 2e-7),
    PointMass(0.1, 0.003),
    PointMass(0.3, 0.1),
    Support(0.25, 8e3, 2.0, 3.0),
    Support(0.7, inf, inf),
    Joint(0.4, 2e-3, 1e-7),
    Joint(0.1, 1e-3),
    StructuralDamping(0.012),
    AxialWaves(),
    TipDome(0.0095),
    TipShear(0.75),
)
LINEAR = {PointMass, Support, Joint, StructuralDamping, AxialWaves, TipDome, TipShear}


def logarithmic(low: float, high: float) -> st.SearchStrategy[float]:
    return st.one_of(st.just(0.0), st.floats(np.log10(low), np.log10(high)).map(lambda x: float(10**x)))


PLACE = st.floats(0.0, KIM.length)
EFFECTS = [
    st.builds(PointMass, PLACE, logarithmic(1e-5, 1.0), logarithmic(1e-9, 1e-3)),
    st.builds(Support, PLACE, logarithmic(1.0, 1e7), logarithmic(0.01, 1e3), logarithmic(0.1, 100.0)),
    st.just(Support(KIM.length, inf, inf)),
    st.builds(Joint, st.floats(0.01, 0.69), logarithmic(1e-6, 1e2), logarithmic(1e-11, 1e-3)),
    st.builds(StructuralDamping, logarithmic(1e-4, 0.9)),
    st.just(AxialWaves()),
    st.builds(TipDome, logarithmic(1e-4, 0.03)),
    st.builds(TipShear, st.floats(0.05, 50.0)),
]


@st.composite
def scenes(draw: st.DrawFn, effects: st.SearchStrategy[tuple[Effect, ...]]) -> Scene:
    tip = {"restitution": draw(RESTITUTION), "friction": draw(FRICTION)}
    scene = kim_scene(draw(SIGN) * draw(OFFSET), **tip)
    return replace(scene, effects=draw(effects))


@settings(max_examples=80, deadline=None)
@given(scenes(st.one_of(EFFECTS).map(lambda effect: (effect,))))
@example(replace(kim_scene(0.3, restitution=0.0), effects=(Support(0.25, dashpot=5.0),)))
@example(replace(kim_scene(0.3, restitution=0.0), effects=(AxialWaves(),)))
@example(replace(kim_scene(0.0), effects=(TipDome(0.01),)))
@example(replace(kim_scene(0.3), effects=(Support(0.0, inf),)))
def test_energy_closes_with_every_effect_alone(scene):
    sound(strike(scene, AT))


@pytest.mark.heavy
@settings(max_examples=40, deadline=None)
@given(scenes(st.tuples(*EFFECTS)))
def test_energy_closes_with_all_effects_together(scene):
    sound(strike(scene, AT))


def test_what_a_dashpot_and_damping_take_is_a_loss_by_name():
    bare = strike(kim_scene(), AT)
    assert "damping loss" not in bare.energy
    for effect in (Support(0.1, dashpot=3.0), StructuralDamping(0.05)):
        damped = strike(replace(kim_scene(), effects=(effect,)), AT)
        assert 1e-7 < damped.energy["damping loss"] / damped.energy["initial"] < 1e-2
        assert damped.energy["cue vibration"] < bare.energy["cue vibration"]


# Lists that hold every kind of effect between them.
LISTS = {
    "linear": (kim_scene(), EXAMPLES),
    "at the tip": (
        kim_scene(0.4, restitution=0.3),
        (PowerLawTip(1.5), RollingContact(), SecondHit(), TipDome(0.009), StructuralDamping(0.02)),
    ),
    "raised": (kim_scene(0.4), (Elevation(0.2), PowerLawTip(1.5), TipDome(0.009), StructuralDamping(0.02))),
}


@pytest.mark.parametrize("name", LISTS)
@settings(max_examples=10, deadline=None)
@given(data=st.data())
def test_the_order_of_the_list_does_not_change_a_bit(name, data):
    scene, listed = LISTS[name]
    shuffled = data.draw(st.permutations(listed))
    one, other = (strike(replace(scene, effects=tuple(effects)), AT) for effects in (listed, shuffled))
    sound(one)
    assert one.energy["damping loss"] > 0
    assert np.array_equal(numbers(one), numbers(other))
    assert one.phases == other.phases


def own_code(kind: type) -> Iterator[str]:
    """Names of the methods and properties that a class defines itself."""
    for name, value in vars(kind).items():
        if isinstance(value, property) or (callable(value) and not name.startswith("__")):
            yield name


def leaves(kind: type) -> Iterator[type]:
    for child in kind.__subclasses__():
        yield from leaves(child)
    if not kind.__subclasses__():
        yield kind


def entered(*args: object, **kwargs: object) -> None:
    raise AssertionError("code of an effect that is not listed was entered")


def forbid(monkeypatch: pytest.MonkeyPatch, *, listed: set[type]) -> None:
    """Make all code of the effects that are not listed raise."""
    for kind in set(leaves(Effect)) - listed:
        for name in own_code(kind):
            monkeypatch.setattr(kind, name, property(entered))
    if AxialWaves not in listed:
        monkeypatch.setattr(cuefem.effects.axial, "rod_modes", entered)
    if StructuralDamping not in listed:
        monkeypatch.setattr(cuefem.effects.loss, "damped", entered)


def test_a_bare_scene_enters_no_effect(monkeypatch):
    before = strike(kim_scene(), AT)
    forbid(monkeypatch, listed=set())
    for kind in (Effect, CueEffect, TipEffect):
        for name in own_code(kind):
            monkeypatch.setattr(kind, name, property(entered))
    after = strike(replace(kim_scene(), effects=()), AT)
    assert np.array_equal(numbers(before), numbers(after))
    assert (before.phases, before.unknowns) == (after.phases, after.unknowns)


@pytest.mark.parametrize("effect", EXAMPLES, ids=lambda effect: f"{type(effect).__name__}")
def test_an_effect_alone_enters_no_other(effect, monkeypatch):
    scene = replace(kim_scene(), effects=(effect,))
    before = strike(scene, AT)
    forbid(monkeypatch, listed={type(effect)})
    assert np.array_equal(numbers(before), numbers(strike(scene, AT)))
    assert imbalance(before) < 1e-9


@pytest.mark.parametrize("effect", EXAMPLES, ids=lambda effect: f"{type(effect).__name__}")
def test_a_forbidden_effect_is_noticed(effect, monkeypatch):
    forbid(monkeypatch, listed=set())
    with pytest.raises((AssertionError, TypeError)):
        strike(replace(kim_scene(), effects=(effect,)), AT)


def test_the_examples_cover_every_linear_effect():
    assert {type(effect) for effect in EXAMPLES} == LINEAR
    assert {kind for kind in leaves(CueEffect) if not kind.at_tip} <= LINEAR | {GeometricStiffness}


def test_mirrored_strokes_mirror():
    effects = (TipDome(0.0095), TipShear(0.75), AxialWaves(), StructuralDamping(0.1), Joint(0.1, 1e-3))
    left, right = (strike(replace(kim_scene(b), effects=effects), AT) for b in (-0.4, 0.4))
    assert left.squirt == -right.squirt
    assert left.cue_speed == right.cue_speed


def test_tip_shear_goes_with_a_lumped_cue():
    scene = replace(kim_scene(), cue=LumpedCue(0.54, 0.005), effects=(TipShear(0.75),))
    assert 0 < strike(scene).squirt < strike(replace(scene, effects=())).squirt
    sound(strike(scene))
