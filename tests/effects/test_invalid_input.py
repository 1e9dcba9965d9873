"""Invalid effects: calls and scene files, whose messages are stored in tests/golden (bad input)."""

from dataclasses import replace
from math import inf
from pathlib import Path
from typing import Any
from unittest import mock

import pytest

import cuefem as cf
from tests.helpers.cues import pool
from tests.helpers.invalid_input import assert_calls_refused, assert_refused, raised, stored_rows
from tests.helpers.strike_scenes import KIM, energy_residual, kim_scene

CLAMPED = replace(kim_scene(0.3), effects=(cf.Support(0.0, inf),))
CLAMP, SHEAR, LOSSY = cf.Support(0.7, inf, inf), cf.TipShear(0.75), cf.StructuralDamping(0.6)
LEATHER, FLAT = cf.LeatherTip(6e-3, 9.5e-3, 1.4e8), cf.LeatherTip(6e-3, inf, 1e8)
THIN = cf.Cue((cf.Segment(0.7, 0.005, 0.006, cf.Material(12.6e9, 0.84e9, 700.0)),), body_mass=0.5)
DOME, RAISED, WAVES, FAR = cf.TipDome(0.01), cf.Elevation(0.1), cf.AxialWaves(), cf.Joint(0.9)


def with_effects(*effects: cf.Effect, **fields: Any) -> cf.Scene:
    return replace(kim_scene(), effects=effects, **fields)


def lumped(*effects: cf.Effect) -> cf.Scene:
    return with_effects(*effects, cue=cf.LumpedCue(0.54, 0.005))


def with_tip(tip: cf.Tip, *effects: cf.Effect, **fields: Any) -> cf.Scene:
    return with_effects(*effects, tip=tip, **fields)


def two_windows() -> cf.Scene:
    """A user's effect that sets a window, beside a second hit."""
    with mock.patch.object(cf.TipDome, "add_to_contact", lambda _, terms: setattr(terms, "window", 4e-3)):
        return with_effects(cf.SecondHit(), cf.TipDome(9.876e-3))


def test_effect_invalid_input_raises(request: pytest.FixtureRequest) -> None:
    assert_calls_refused("effects", globals() | {"pool": pool}, request)


def test_clamped_tip_has_strike() -> None:
    assert energy_residual(cf.strike(CLAMPED)) < 1e-9


def test_effect_input_at_bound_is_accepted() -> None:
    """Round-off error at the end of the cue is accepted; two clamps at one position are one."""
    assert cf.modes(KIM, 1, effects=(cf.Support(0.7 * (1 + 1e-12), inf, inf),)).rigid == 0
    once, twice = (cf.modes(KIM, 3, effects=(CLAMP,) * n).frequencies for n in (1, 2))
    assert once == pytest.approx(twice, rel=1e-12)


SCENE = """
game = "kim"
effects = [{{ type = "AxialWaves" }}, {{ {effect} }}]
[cue]
body_mass = "0.42 kg"
[[cue.segments]]
length = "0.7 m"
tip_diameter = "12 mm"
butt_diameter = "21 mm"
material = {{ E = "12.6 GPa", G = "0.84 GPa", rho = "700 kg/m^3" }}
"""


def test_effect_in_file_invalid_raises(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, request: pytest.FixtureRequest
) -> None:
    """Before any computation; one effect a line of tests/golden/refused_effect_files.txt."""
    monkeypatch.chdir(tmp_path)
    messages = {}
    for effect in stored_rows("effect_files"):
        Path("scene.toml").write_text(SCENE.format(effect=effect), encoding="utf-8")
        messages[effect] = raised(lambda: cf.load("scene.toml"))
    assert_refused("effect_files", messages, request)
