"""Other kinds than functions of a scene take, and scenes without a game: their messages are stored (bad input)."""

import inspect

import pytest

import cuefem as cf
from cuefem.scene.default_scene import default_tip
from tests.helpers.invalid_input import assert_calls_refused, raised

WOOD = cf.Segment(0.7, 0.0118, 0.021, cf.material("hard maple"))
LEATHER = cf.Segment(1e-3, 0.0118, 0.0118, cf.material("leather"))
CUE = cf.Cue((WOOD,), body_mass=0.43)
PUBLIC = {name: getattr(cf, name) for name in cf.__all__ if inspect.isfunction(getattr(cf, name))}
OF_SCENE = [name for name, call in PUBLIC.items() if [*inspect.signature(call).parameters][:1] == ["scene"]]
OTHERS = {"identify_tip": (1e-3, 0.7), "motion": ([0.0],), "save_motion": ("folder",), "with_parameters": ({},)}
OTHERS |= {"plays_like": (CUE,)}


@pytest.mark.filterwarnings("ignore::cuefem.PlausibilityWarning")
def test_scene_invalid_input_raises(request: pytest.FixtureRequest) -> None:
    assert_calls_refused("scene", globals() | {"default_tip": default_tip}, request)


def test_function_of_a_scene_rejects_a_cue() -> None:
    """`cuefem.load` often gives a cue, not a scene."""
    for name in OF_SCENE:
        kind = "SideStrike" if name == "side_strike" else "Scene"
        message = raised(lambda name=name: PUBLIC[name](CUE, *OTHERS.get(name, ())))
        assert f"scene must be a {kind}; got a Cue" in message, name
