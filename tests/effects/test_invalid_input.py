"""Invalid effects: calls and scene files, each with a part of the error message (bad input)."""

from collections.abc import Callable
from dataclasses import replace
from math import inf
from pathlib import Path
from typing import Any

import pytest

import cuefem as cf
from tests.helpers.cues import pool
from tests.helpers.invalid_input import assert_raises
from tests.helpers.strike_scenes import KIM, energy_residual, kim_scene


def with_effects(*effects: cf.Effect) -> Callable[[], cf.Scene]:
    return lambda: replace(kim_scene(), effects=effects)


def lumped(*effects: cf.Effect) -> Callable[[], cf.Scene]:
    return lambda: replace(kim_scene(), cue=cf.LumpedCue(0.54, 0.005), effects=effects)


CLAMP, SHEAR, LOSSY = cf.Support(0.7, inf, inf), cf.TipShear(0.75), cf.StructuralDamping(0.6)
LEATHER, FLAT = cf.LeatherTip(6e-3, 9.5e-3, 1.4e8), cf.LeatherTip(6e-3, inf, 1e8)
DOME, RAISED, WAVES, FAR = cf.TipDome(0.01), cf.Elevation(0.1), cf.AxialWaves(), cf.Joint(0.9)


def with_tip(tip: cf.Tip, *effects: cf.Effect, **fields: Any) -> Callable[[], cf.Scene]:
    return lambda: replace(kim_scene(), tip=tip, effects=effects, **fields)


CALLS: list[tuple[Callable[[], object], str]] = [  # one line for each `raise`
    (with_effects(SHEAR, RAISED), "TipShear; got Elevation, which does not"),
    (lambda: cf.strike(with_effects(LOSSY, LOSSY)()), "loss factors of all such effects must add up to less than 1"),
    (lambda: replace(LEATHER, dome_radius=6e-3).mass(0.013), "a 13 mm tip needs at least 6.5 mm"),
    (lambda: replace(LEATHER, height=2e-3).mass(0.01275), "must be higher than 2.457 mm, the depth"),
    (lambda: replace(FLAT, height=6e-4).mass(0.01275), "must be 0.638 to 38.2 mm high; got "),
    (lambda: replace(FLAT, layers=11 * (cf.TipLayer(1e-4, 1e9),)), "LeatherTip.layers must be at most 10; got 11"),
    (lambda: FLAT.mass(-1.0), "diameter must be in (0, 10] m; got -1.0"),
    (lambda: FLAT.compliance(0.012, 0.1, 7e-3), "patch must be in (0, 0.006] m; got 0.007"),
    (lambda: FLAT.compliance(0.012, 1.0, 1e-3), "offset must be in (-1, 1); got 1.0"),
    (lambda: FLAT.head_on(0.012, 0.0), "ball_radius must be in (0, inf) m; got 0.0"),
    (
        with_effects(SHEAR, cf.PointMass(position=0.71, mass=0.01)),
        "Scene.effects[1].position must be in [0, 0.7] m, on the cue",
    ),
    (with_effects(SHEAR, FAR), "Scene.effects[1].position must be in (0, 0.7) m, between the ends"),
    (lumped(SHEAR, cf.Joint(0.1)), "got Joint, which needs a finite-element Cue"),
    (lumped(SHEAR, WAVES), "Scene.effects[1] must be an effect that a LumpedCue can have"),
    (lambda: cf.AxialWaves(1.47), "AxialWaves must be given cue_length, butt_diameter and wave_speed together"),
    (with_effects(WAVES, SHEAR, WAVES), "Scene.effects[2] must be another effect, AxialWaves acts once; got Axial"),
    (with_effects(DOME, LEATHER), "must be an effect that goes with effects[0], TipDome; got LeatherTip"),
    (with_effects(LEATHER), "Tip.contact_time must be omitted with an effect that models the whole tip"),
    (with_tip(cf.Tip(stiffness=1e6), LEATHER), "Tip.stiffness must be omitted with an effect that models the whole"),
    (with_tip(cf.Tip(), WAVES, LEATHER, cue=pool()), "Scene.effects[1] must be the only leather: draw the cue"),
    (lambda: cf.modes(pool(), effects=(LEATHER,)), "LeatherTip must be the only leather: draw the cue without its"),
    (with_tip(cf.Tip(), replace(LEATHER, dome_radius=5e-3)), "dome radius 5 mm is too small: a 12 mm tip"),
    (lambda: cf.modes(KIM, 3, effects=(3,)), "TypeError: modes effects must be effects"),
    (lambda: replace(kim_scene(), effects=SHEAR), "TypeError: Scene.effects must be a sequence of effects"),
    (lambda: replace(LEATHER, rolling="no"), "TypeError: LeatherTip.rolling must be a bool; got 'no'"),
    (with_effects(SHEAR, "TipDome"), "TypeError: Scene.effects[1] must be an Effect; got 'TipDome'"),
]


@pytest.mark.parametrize(("call", "message"), CALLS, ids=[message for _, message in CALLS])
def test_effect_invalid_input_raises(call: Callable[[], object], message: str) -> None:
    assert_raises(call, message)


def test_clamped_tip_has_strike_but_no_end_mass() -> None:
    clamped = replace(kim_scene(0.3), effects=(cf.Support(0.0, inf),))
    assert energy_residual(cf.strike(clamped)) < 1e-9
    for drive in ("stick", "velocity", "force"):
        assert_raises(lambda drive=drive: cf.end_mass(clamped, drive), "the tip is clamped transversely")


def test_effect_input_at_bound_is_accepted() -> None:
    """Round-off error at the end of the cue is accepted; two clamps at one position are one."""
    assert cf.modes(KIM, 1, effects=(cf.Support(0.7 * (1 + 1e-12), inf, inf),)).rigid == 0
    once, twice = (cf.modes(KIM, 3, effects=(CLAMP,) * n).frequencies for n in (1, 2))
    assert once == pytest.approx(twice, rel=1e-12)


SCENE = """
game = "kim"
[[effects]]
type = "AxialWaves"
[[effects]]
{effect}
[cue]
body_mass = "0.42 kg"
[[cue.segments]]
length = "0.7 m"
tip_diameter = "12 mm"
butt_diameter = "21 mm"
material = {{ E = "12.6 GPa", G = "0.84 GPa", rho = "700 kg/m^3" }}
"""


FILES = [
    ('type = "Joint"\nposition = "0.71 m"', "effects[1].position: must be in (0, 0.7) m, between"),
    ('type = "PointMass"\nposition = "71 cm"\nmass = "5 g"', "effects[1].position: must be 0 to 700 mm, on"),
]


@pytest.mark.parametrize(("effect", "message"), FILES)
def test_effect_in_file_off_the_cue_raises(tmp_path: Path, effect: str, message: str) -> None:
    path = tmp_path / "scene.toml"
    path.write_text(SCENE.format(effect=effect), encoding="utf-8")
    assert_raises(lambda: cf.load(path), f"{path}: {message}")
