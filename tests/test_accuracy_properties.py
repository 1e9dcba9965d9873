"""What holds of `resolve` for every scene: limits, mirrors, refusals, the same answer twice (properties)."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings

from cuefem import LumpedCue, Scene, Stroke, resolve, resolve_end_mass, strike
from cuefem.accuracy import MOST, ladder
from tests.helpers.accuracy_scenes import endless_friction, scene
from tests.helpers.strike_scenes import lumped_scenes, numbers, sound

KIM = scene("kim", 1e-3, 0.3)


@given(lumped_scenes())
def test_a_lumped_cue_is_exact(lumped: Scene) -> None:
    found, same = resolve(lumped, 1e-3), strike(lumped)
    np.testing.assert_array_equal(numbers(found), numbers(same))
    assert found.error == 1e-12


@pytest.mark.parametrize("rtol", [0.0, 1.0, -1e-3, float("nan"), float("inf")])
def test_an_accuracy_lies_between_zero_and_one(rtol: float) -> None:
    with pytest.raises(ValueError, match=r"resolve rtol must be in \(0, 1\)"):
        resolve(KIM, rtol)
    with pytest.raises(ValueError, match=r"resolve_end_mass rtol must be in \(0, 1\)"):
        resolve_end_mass(KIM, "stick", rtol)


def test_an_unknown_end_mass_is_refused() -> None:
    with pytest.raises(ValueError, match="drive must be one of"):
        resolve_end_mass(KIM, "pull", 1e-3)  # type: ignore[arg-type]


def test_a_lumped_cue_answers_its_own_end_mass() -> None:
    assert resolve_end_mass(replace(KIM, cue=LumpedCue(0.5, 0.006)), "force", 1e-3) == (0.006, 1e-12)


def test_the_same_twice_and_mirrored() -> None:
    first, again = resolve(KIM, 1e-2), resolve(KIM, 1e-2)
    np.testing.assert_array_equal(numbers(first), numbers(again))
    assert first.error == again.error
    mirrored = resolve(replace(KIM, stroke=Stroke(offset=-0.3)), 1e-2)
    assert mirrored.squirt == -first.squirt
    assert mirrored.spin == -first.spin
    assert mirrored.error == first.error


@settings(max_examples=5)
@given(...)
def test_speed_scales_out(faster: bool) -> None:
    stroke = Stroke(3.7 if faster else 0.2, 0.3)
    found, one = resolve(replace(KIM, stroke=stroke), 1e-2), resolve(KIM, 1e-2)
    assert found.squirt == pytest.approx(one.squirt, rel=1e-9)
    assert found.error == pytest.approx(one.error, rel=1e-3)


def test_head_on_there_is_no_squirt_to_be_wrong() -> None:
    found = resolve(scene("pool_maple", 1e-3, 0.0), 1e-3)
    sound(found)
    assert found.squirt == 0
    assert found.spin == 0
    assert found.error is not None
    assert found.error <= 1e-3


def test_better_is_never_cheaper() -> None:
    found = [resolve(KIM, rtol) for rtol in (0.5, 1e-2, 1e-3, 3e-4)]
    assert [outcome.unknowns for outcome in found] == sorted(outcome.unknowns for outcome in found)
    errors = [outcome.error for outcome in found]
    assert all(error is not None and error <= rtol for error, rtol in zip(errors, (0.5, 1e-2, 1e-3, 3e-4), strict=True))


def test_endless_friction_resolves() -> None:
    sound(resolve(endless_friction(), 1e-2))


@pytest.mark.parametrize(("restitution", "rtol"), [(0.0, 0.3), (1e-3, 1e-2)])
def test_a_dead_or_nearly_dead_tip_resolves(restitution: float, rtol: float) -> None:
    found = resolve(replace(KIM, tip=replace(KIM.tip, restitution=restitution)), rtol)
    sound(found)
    assert found.error is not None
    assert 0 < found.error <= rtol


@pytest.mark.heavy
def test_a_ladder_climbs_to_the_most_modes() -> None:
    counts = []
    for rung in ladder(scene("kim", 1e-4, 0.3)):
        counts.append(rung.at.modes)
        if len(counts) == 8:
            break
    ratios = np.array(counts[1:]) / np.array(counts[:-1])
    assert np.all((ratios > 1.2) & (ratios < 1.4))
    assert counts[0] < MOST / 3
