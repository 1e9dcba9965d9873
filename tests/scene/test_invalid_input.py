"""Other kinds than functions of a scene take, and scenes without a game: their messages are stored (bad input)."""

import inspect
from collections.abc import Callable

import pytest

import cuefem as cf
from cuefem.scene.default_scene import default_tip
from tests.helpers.invalid_input import assert_refused, messages_of, raised

WOOD = cf.Segment(0.7, 0.0118, 0.021, cf.material("hard maple"))
LEATHER = cf.Segment(1e-3, 0.0118, 0.0118, cf.material("leather"))
CUE = cf.Cue((WOOD,), body_mass=0.43)
PUBLIC = {name: getattr(cf, name) for name in cf.__all__ if inspect.isfunction(getattr(cf, name))}
OF_SCENE = [name for name, call in PUBLIC.items() if [*inspect.signature(call).parameters][:1] == ["scene"]]
OTHERS = {"identify_tip": (1e-3, 0.7), "motion": ([0.0],), "save_motion": ("folder",), "with_parameters": ({},)}
OTHERS |= {"plays_like": (CUE,)}
CALLS: dict[str, Callable[[], object]] = {
    "game of croquet": lambda: cf.usual_scene(CUE, "croquet"),
    "tip for golf": lambda: default_tip(CUE, "golf"),
    "usual scene of a lumped cue": lambda: cf.usual_scene(cf.LumpedCue(0.5, 0.01)),
    "leather lower than its dome": lambda: cf.usual_scene(cf.Cue((LEATHER, WOOD))),
    "material of no name": lambda: cf.material(None),
    "study of a cue": lambda: cf.study(CUE),
    "place of a cue": lambda: cf.place(CUE, (0, 0), (0, 1, 0)),
}


@pytest.mark.filterwarnings("ignore::cuefem.PlausibilityWarning")
def test_scene_invalid_input_raises(request: pytest.FixtureRequest) -> None:
    assert_refused("scene", messages_of(CALLS), request)


def test_function_of_a_scene_rejects_a_cue() -> None:
    """`cuefem.load` often gives a cue, not a scene."""
    for name in OF_SCENE:
        kind = "SideStrike" if name == "side_strike" else "Scene"
        message = raised(lambda name=name: PUBLIC[name](CUE, *OTHERS.get(name, ())))
        assert f"scene must be a {kind}; got a Cue" in message, name
