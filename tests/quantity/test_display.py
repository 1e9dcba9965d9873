"""Representations of objects: short and full (regression)."""

from __future__ import annotations

import numpy as np
import pytest

import cuefem as cf
from cuefem.quantity.display import full_repr
from studies.strokes import cue

CUE = cue("pool_hollow")
SCENE = cf.Scene(CUE, stroke=cf.Stroke(1.0, 0.3), effects=(cf.TipDome(0.0095),))
LUMPED = [cf.Scene(cf.LumpedCue(0.5, 0.006), stroke=cf.Stroke(1.0, b)) for b in np.linspace(0, 0.4, 50)]
OBJECTS = {
    "cue": (lambda: CUE, "Cue(6 segments, 0.7366 m, "),
    "scene": (lambda: SCENE, "Scene(cue=Cue(6 segments, 0.7366 m, "),
    "outcome": (lambda: cf.strike(SCENE), "Outcome(squirt=0.0"),
    "array": (lambda: cf.impulse(LUMPED), "Outcomes(n=50, squirt=array(50,), ball_speed=array(50,), "),
    "modes": (lambda: cf.modes(CUE, 40), "Modes(["),
    "motion": (lambda: cf.motion(SCENE, np.linspace(0, 1e-3, 30)), "Motion(30 times to 0.001 s, "),
}


@pytest.mark.parametrize("name", OBJECTS)
def test_repr_is_one_short_line(name: str) -> None:
    make, begins = OBJECTS[name]
    text = repr(make())
    assert text.startswith(begins)
    assert len(text) < 400
    assert "\n" not in text


def test_full_repr_evaluates_to_equal_object() -> None:
    """Studies are compared by their full representation."""
    names = {name: getattr(cf, name) for name in dir(cf)} | {"inf": float("inf")}
    assert eval(full_repr(SCENE), names) == SCENE
