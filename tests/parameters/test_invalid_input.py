"""Invalid parameters of a scene: calls, whose messages are stored in tests/golden (bad input)."""

from dataclasses import replace
from math import nan

import pytest

import cuefem as cf
from cuefem.designs import Response, Span, Study, Vary
from tests.helpers.invalid_input import assert_calls_refused

NAMES = {kind.__name__: kind for kind in (Response, Span, Study, Vary)} | {"nan": nan}
MAPLE, HOLLOW, CARBON = (
    cf.usual_scene(cf.load(f"meshes/{name}.toml")) for name in ("pool_maple", "pool_hollow", "carbon")
)


def changed(scene: cf.Scene, name: str, value: float | str) -> cf.Scene:
    return cf.with_parameters(scene, {name: value})


def filled(core: cf.Material | None) -> cf.Scene:
    """A tube with one filling, or none, along its whole length."""
    whole = [replace(segment, core=core) if segment.tip_bore else segment for segment in CARBON.shaft.segments]
    return replace(CARBON, cue=replace(CARBON.shaft, segments=tuple(whole)))


def test_parameter_invalid_input_raises(request: pytest.FixtureRequest) -> None:
    assert_calls_refused("parameters", globals() | NAMES, request)
