"""Uncertain inputs, and the model's own errors as the published series give them (properties, validation)."""

from dataclasses import replace
from pathlib import Path

import pytest

import cuefem as cf
from cuefem.results.uncertainty import of_inputs, of_shaft
from cuefem.tip_modes import Solved
from cuefem.parameters.parameter import varied

MESHES = Path(__file__).parents[2] / "meshes"


def test_leather_s_loss_along_its_surface_is_an_input_downwards() -> None:
    """0.95 for the 1 that stands there: 4 % more squirt. It is the tip's, which two shafts share."""
    scene = cf.usual_scene(cf.load(MESHES / "pool_maple.toml"))
    own = float(cf.strike(scene).squirt)
    lossy = varied(scene, {"leather.surface_restitution": 0.95})
    inputs = of_inputs(Solved(scene), own)
    assert inputs["surface_restitution"] == pytest.approx(cf.strike(lossy).squirt / own - 1, rel=1e-6)
    assert 0.03 < inputs["surface_restitution"] < 0.05
    assert of_shaft(inputs) == of_shaft({key: share for key, share in inputs.items() if key != "surface_restitution"})
    spring = replace(scene, effects=())
    assert "surface_restitution" not in of_inputs(Solved(spring), own)
