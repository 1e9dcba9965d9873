"""Properties of the public calls as other programs make them: fixed signatures, clear refusals."""

import inspect
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import cuefem as cf
from tests.helpers.strike_scenes import imbalance, kim_scene

SIGNATURES = {
    "modes": ["cue", "count", "near", "effects", "at"],
    "end_mass": ["scene", "drive", "at"],
    "impulse": ["scene"],
    "strike": ["scene", "at"],
    "motion": ["scene", "times", "at"],
    "resolve": ["scene", "rtol"],
    "save": ["obj", "path"],
}


@pytest.mark.parametrize(("name", "wanted"), SIGNATURES.items())
def test_signatures_stay(name: str, wanted: list[str]) -> None:
    parameters = inspect.signature(getattr(cf, name)).parameters
    assert list(parameters)[: len(wanted)] == wanted
    assert all(parameters[p].kind is inspect.Parameter.POSITIONAL_OR_KEYWORD for p in wanted)


def test_modes_takes_a_scene_s_effects_and_leaves_those_at_the_tip() -> None:
    cue = kim_scene().cue
    bare = cf.modes(cue, 3).frequencies
    np.testing.assert_array_equal(cf.modes(cue, 3, None, (cf.TipShear(0.5), cf.TipDome(0.009))).frequencies, bare)
    heavier = cf.modes(cue, 3, effects=(cf.TipShear(0.5), cf.PointMass(0.1, 0.01))).frequencies
    assert np.all(heavier < bare)
    with pytest.raises(TypeError, match=r"modes effects must be effects.*got 3"):
        cf.modes(cue, 3, effects=(3,))


def test_a_clamped_tip_is_struck_but_has_no_end_mass() -> None:
    clamped = replace(kim_scene(0.3), effects=(cf.Support(0.0, np.inf),))
    assert imbalance(cf.strike(clamped)) < 1e-9
    for drive in ("stick", "velocity", "force"):
        with pytest.raises(ValueError, match=r"a clamp holds the tip across the cue"):
            cf.end_mass(clamped, drive)


@pytest.mark.parametrize("time", [1e-6, 5e-5, 0.5])
def test_any_contact_time_is_answered_by_default(time: float) -> None:
    assert imbalance(cf.strike(kim_scene(0.3, contact_time=time))) < 1e-9


def test_arrays_are_refused_where_one_number_is_meant() -> None:
    with pytest.raises(ValueError, match=r"Tip.contact_time must be one number; got an array of shape \(2,\)"):
        cf.Tip(contact_time=np.array([1e-3, 2e-3]))  # type: ignore[arg-type]
    with pytest.raises(ValueError, match=r"Material.E must be one number"):
        cf.Material(np.array([1e9, 2e9]), 1e8, 700.0)  # type: ignore[arg-type]


def test_other_things_than_scenes_are_refused() -> None:
    for call in (cf.strike, cf.impulse):
        with pytest.raises(TypeError, match=f"{call.__name__} scene must be a Scene; got 3"):
            call(3)  # type: ignore[arg-type]
    with pytest.raises(TypeError, match=r"Scene\.effects must be a sequence of effects"):
        replace(kim_scene(), effects=cf.TipShear(0.5))


def test_save_by_keyword(tmp_path: Path) -> None:
    cue = kim_scene().cue
    cf.save(obj=cue, path=tmp_path / "kim.toml")
    assert cf.load(tmp_path / "kim.toml") == cue


def test_an_outcome_prints_in_a_few_lines() -> None:
    assert len(repr(cf.strike(kim_scene(0.3)))) < 1000


def test_a_contact_time_is_computed_once() -> None:
    scene = cf.usual_scene(kim_scene().cue)
    assert scene.contact_time is scene.contact_time
    assert replace(scene, stroke=cf.Stroke(4.0)).contact_time < 0.9 * scene.contact_time
