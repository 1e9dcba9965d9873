"""Invalid parameters of a scene: calls, whose messages are stored in tests/golden (bad input)."""

from collections.abc import Callable
from dataclasses import replace
from math import nan

import pytest

import cuefem as cf
from cuefem.designs import Response, Span, Study, Vary
from tests.helpers.invalid_input import assert_refused, messages_of

MAPLE, HOLLOW, CARBON = (
    cf.usual_scene(cf.load(f"meshes/{name}.toml")) for name in ("pool_maple", "pool_hollow", "carbon")
)
# Of each scene, the parameters and the values that it refuses.
WRONG: list[tuple[cf.Scene, str, float | str]] = [
    *((MAPLE, name, 1.0) for name in ("ferule length", "contact time", "taper at 5 m", "taper at 5 kg", "x y", "ball")),
    *((MAPLE, "bore depth", value) for value in (-1.0, nan)),
    (MAPLE, "taper diameter", nan),
    (MAPLE, "tip diameter", "12 mm"),
    (MAPLE, "bore width", 0.015),
    (MAPLE, "front wall", 1e-3),
    (HOLLOW, "empty depth", 1e-3),
    (CARBON, "front wall", 7e-3),
    (CARBON, "empty depth", 0.9),
    (CARBON, "insert depth", 0.9),
]


def filled(core: cf.Material | None) -> cf.Scene:
    """A tube with one filling, or none, along its whole length."""
    whole = [replace(segment, core=core) if segment.tip_bore else segment for segment in CARBON.shaft.segments]
    return replace(CARBON, cue=replace(CARBON.shaft, segments=tuple(whole)))


CALLS: dict[str, Callable[[], object]] = {
    f"{name} of {value}, {i}": lambda scene=scene, name=name, value=value: cf.with_parameters(scene, {name: value})
    for i, (scene, name, value) in enumerate(WRONG)
} | {
    "empty tube": lambda: cf.with_parameters(filled(None), {"empty depth": 0.1}),
    "tube of wood": lambda: cf.with_parameters(filled(cf.material("hard maple")), {"insert depth": 0.1}),
    "no bore": lambda: Study(MAPLE, (Vary(("bore width",), Span(0.004, 0.009, 2)),), (Response.of("squirt"),)),
}


def test_parameter_invalid_input_raises(request: pytest.FixtureRequest) -> None:
    assert_refused("parameters", messages_of(CALLS), request)
