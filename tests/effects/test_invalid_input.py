"""Invalid effects: calls and scene files, whose messages are stored in tests/golden (bad input)."""

from collections.abc import Callable
from dataclasses import replace
from math import inf
from pathlib import Path
from typing import Any
from unittest import mock

import pytest

import cuefem as cf
from tests.helpers.cues import pool
from tests.helpers.invalid_input import assert_refused, messages_of, raised, stored_rows
from tests.helpers.strike_scenes import KIM, energy_residual, kim_scene


def with_effects(*effects: cf.Effect) -> Callable[[], cf.Scene]:
    return lambda: replace(kim_scene(), effects=effects)


def lumped(*effects: cf.Effect) -> Callable[[], cf.Scene]:
    return lambda: replace(kim_scene(), cue=cf.LumpedCue(0.54, 0.005), effects=effects)


CLAMPED = replace(kim_scene(0.3), effects=(cf.Support(0.0, inf),))
CLAMP, SHEAR, LOSSY = cf.Support(0.7, inf, inf), cf.TipShear(0.75), cf.StructuralDamping(0.6)
LEATHER, FLAT = cf.LeatherTip(6e-3, 9.5e-3, 1.4e8), cf.LeatherTip(6e-3, inf, 1e8)
DOME, RAISED, WAVES, FAR = cf.TipDome(0.01), cf.Elevation(0.1), cf.AxialWaves(), cf.Joint(0.9)


def with_tip(tip: cf.Tip, *effects: cf.Effect, **fields: Any) -> Callable[[], cf.Scene]:
    return lambda: replace(kim_scene(), tip=tip, effects=effects, **fields)


def clamped_end_mass(drive: str) -> Callable[[], object]:
    return lambda: cf.end_mass(CLAMPED, drive)


def two_windows() -> cf.Scene:
    """A user's effect that sets a window, beside a second hit."""
    with mock.patch.object(cf.TipDome, "add_to_contact", lambda _, terms: setattr(terms, "window", 4e-3)):
        return with_effects(cf.SecondHit(), cf.TipDome(9.876e-3))()


CALLS: dict[str, Callable[[], object]] = {  # one line for each `raise`
    "shear and elevation": with_effects(SHEAR, RAISED),
    "loss of 1.2": lambda: cf.strike(with_effects(LOSSY, LOSSY)()),
    "small dome": lambda: replace(LEATHER, dome_radius=6e-3).mass(0.013),
    "tip lower than its dome": lambda: replace(LEATHER, height=2e-3).mass(0.01275),
    "flat tip": lambda: replace(FLAT, height=6e-4).mass(0.01275),
    "11 layers": lambda: replace(FLAT, layers=11 * (cf.TipLayer(1e-4, 1e9),)),
    "mass of a tip of -1 m": lambda: FLAT.mass(-1.0),
    "wide patch": lambda: FLAT.compliance(0.012, 0.1, 7e-3),
    "patch at the edge": lambda: FLAT.compliance(0.012, 1.0, 1e-3),
    "ball of no radius": lambda: FLAT.head_on(0.012, 0.0),
    "mass off the cue": with_effects(SHEAR, cf.PointMass(position=0.71, mass=0.01)),
    "joint off the cue": with_effects(SHEAR, FAR),
    "joint of a lumped cue": lumped(SHEAR, cf.Joint(0.1)),
    "waves of a lumped cue": lumped(SHEAR, WAVES),
    "waves of a length alone": lambda: cf.AxialWaves(1.47),
    "waves twice": with_effects(WAVES, SHEAR, WAVES),
    "dome and leather": with_effects(DOME, LEATHER),
    "leather and contact time": with_effects(LEATHER),
    "leather and stiffness": with_tip(cf.Tip(stiffness=1e6), LEATHER),
    "leather on drawn leather": with_tip(cf.Tip(), WAVES, LEATHER, cue=pool()),
    "modes of leather on drawn leather": lambda: cf.modes(pool(), effects=(LEATHER,)),
    "dome below the radius": with_tip(cf.Tip(), replace(LEATHER, dome_radius=5e-3)),
    "modes with a number": lambda: cf.modes(KIM, 3, effects=(3,)),
    "one effect": lambda: replace(kim_scene(), effects=SHEAR),
    "rolling of a text": lambda: replace(LEATHER, rolling="no"),
    "two windows": two_windows,
    "effect of a text": with_effects(SHEAR, "TipDome"),
    **{f"end mass by {drive} of a clamped tip": clamped_end_mass(drive) for drive in ("stick", "velocity", "force")},
}


def test_effect_invalid_input_raises(request: pytest.FixtureRequest) -> None:
    assert_refused("effects", messages_of(CALLS), request)


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
