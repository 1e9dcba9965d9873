"""Public functions name the kind that they take: `cuefem.load` often gives a cue, not a scene (bad input)."""

import inspect

import pytest

import cuefem as cf
from tests.helpers.invalid_input import assert_raises

CUE = cf.Cue((cf.Segment(0.7, 0.01275, 0.021, cf.Material(E=12.6e9, G=0.84e9, rho=700.0)),), body_mass=0.43)
FUNCTIONS = {name: getattr(cf, name) for name in cf.__all__ if inspect.isfunction(getattr(cf, name))}
OF_SCENE = sorted(
    name for name, called in FUNCTIONS.items() if [*inspect.signature(called).parameters][:1] == ["scene"]
)
OTHERS = {
    "identify_tip": (1e-3, 0.7),
    "motion": ([0.0],),
    "pooltool_export": ("a cue",),
    "save_motion": ("folder",),
    "with_parameters": ({},),
}


@pytest.mark.parametrize("name", OF_SCENE)
def test_function_of_a_scene_rejects_a_cue_in_one_line(name: str) -> None:
    kind, arguments = "SideStrike" if name == "side_strike" else "Scene", (CUE, *OTHERS.get(name, ()))
    assert_raises(lambda: FUNCTIONS[name](*arguments), f"TypeError: scene must be a {kind}; got a Cue")


def test_functions_of_a_scene_are_found() -> None:
    assert {"strike", "report", "verdict", "reduction", "squirt_curve", "end_masses"} <= {*OF_SCENE}


def test_other_functions_reject_other_kinds() -> None:
    assert_raises(lambda: cf.material(None), "TypeError: material name must be a str")
    assert_raises(lambda: cf.study(CUE), "TypeError: study what must be a Study or Scatter or Problem")
    assert_raises(lambda: cf.place(CUE, (0, 0), (0, 1, 0)), "TypeError: place outcome must be an Outcome")
