"""Named parameters of reference cues: set and read, alone and together, in any order (properties)."""

from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import cuefem as cf
from cuefem.cue.materials import LEATHERS, material
from cuefem.files.cue_names import CUES
from cuefem.files.reference_cues import named_scene
from cuefem.parameters.parts import outer_diameter
from cuefem.parameters.scene_changes import with_parameters
from cuefem.parameters.table import PARAMETERS
from tests.helpers.examples import examples

SCENES = {name: named_scene(name) for name in CUES}
FIRST = SCENES["plain maple"]


def numbers(scene: cf.Scene) -> dict[str, float]:
    """The values of all numerical parameters above 0."""
    values = {key: known.value(scene) for key, known in PARAMETERS.items() if not known.materials}
    return {key: value for key, value in values.items() if value and (key != "bore_width" or values["bore_depth"])}


def changed(key: str, value: float, part: float) -> float:
    """A value changed by a part of it, downwards where it is at its upper bound."""
    return value * (1 - abs(part) if PARAMETERS[key].below else 1 + part)


@pytest.mark.parametrize("name", SCENES)
@examples(2)
@given(permille=st.integers(-10, 10))
def test_parameter_set_reads_back(name: str, permille: int) -> None:
    scene = SCENES[name]
    for key, value in numbers(scene).items():
        target = changed(key, value, permille / 1000)
        result = with_parameters(scene, {PARAMETERS[key].name: target})
        assert PARAMETERS[key].value(result) == pytest.approx(target, rel=1e-9), key
        assert result.ball == scene.ball
        assert result.cue.length == pytest.approx(scene.cue.length, rel=1e-12), key


@examples(20)
@given(name=st.sampled_from(sorted(SCENES)), data=st.data())
def test_parameters_changed_in_any_order_agree(name: str, data: Any) -> None:
    scene = SCENES[name]
    keys = data.draw(st.lists(st.sampled_from(sorted(numbers(scene))), min_size=2, max_size=5, unique=True))
    changes = {key: changed(key, numbers(scene)[key], 0.01) for key in keys}
    assert with_parameters(scene, changes) == with_parameters(scene, dict(reversed(changes.items())))


@examples(30)
@given(x=st.floats(0.05, 0.7), more=st.floats(1e-8, 5e-4).flatmap(lambda size: st.sampled_from((size, -size))))
def test_taper_at_position_changes_diameters_linearly(x: float, more: float) -> None:
    name = f"taper at {1e3 * x!r} mm"
    diameter = outer_diameter(FIRST.cue, x)
    cue = with_parameters(FIRST, {name: diameter + more}).cue
    for at in np.linspace(0, cue.length, 15):
        hat = np.interp(at, [0, x, cue.length], [0, more, 0])
        assert outer_diameter(cue, at) == pytest.approx(outer_diameter(FIRST.cue, at) + hat, rel=1e-9)


@examples(10)
@given(gain=st.floats(1e-4, 0.012))
def test_taper_scales_the_gain_of_every_diameter(gain: float) -> None:
    new = with_parameters(FIRST, {"taper": gain}).cue
    first, ends = FIRST.cue.segments[0].tip_diameter, np.linspace(0, new.length, 9)
    gains = np.array([[outer_diameter(cue, at) - first for at in ends] for cue in (FIRST.cue, new)])
    np.testing.assert_allclose(gains[1], gains[0] * gain / gains[0, -1], rtol=1e-9, atol=1e-15)


def test_parameter_material_and_leather_names_set_values() -> None:
    result = with_parameters(FIRST, {"wood": "ash", "wood.E": 13e9, "leather": "soft", "ferrule material": "nylon"})
    assert {s.material.rho for s in result.cue.segments} >= {material("ash").rho, material("nylon").rho}
    assert all(s.material.E == 13e9 for s in result.cue.segments if s.material.rho == material("ash").rho)
    soft = LEATHERS["soft"]
    assert (result.leather_tip.E, result.leather_tip.nu, result.leather_tip.rho) == (soft.E, soft.nu, soft.rho)
    assert result.tip.restitution == soft.restitution
    assert with_parameters(FIRST, {"leather": "soft", "restitution": 0.7}).tip.restitution == 0.7
