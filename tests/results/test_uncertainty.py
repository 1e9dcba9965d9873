"""Uncertain inputs, and model errors against published series (validation)."""

from dataclasses import replace
from pathlib import Path

import pytest

import cuefem as cf
from cuefem.parameters.parameter import with_parameters
from cuefem.results.uncertainty import (
    MASS_ERROR,
    MODEL_ERROR,
    SHAFT_ERROR,
    SPRING_ERROR,
    shaft_uncertainty,
    squirt_changes,
)
from cuefem.scene.solved_scene import SolvedScene
from studies.measured import uncertainty

MESHES = Path(__file__).parents[2] / "meshes"


def test_squirt_changes_surface_restitution_is_one_sided() -> None:
    """Surface restitution 0.95 instead of 1 increases squirt by 4 %; two shafts with one tip share this error."""
    scene = cf.usual_scene(cf.load(MESHES / "pool_maple.toml"))
    own = float(cf.strike(scene).squirt)
    lossy = with_parameters(scene, {"leather.surface_restitution": 0.95})
    inputs = {key: abs(change) for key, change in squirt_changes(SolvedScene(scene), own).of("squirt").items()}
    assert inputs["surface_restitution"] == pytest.approx(cf.strike(lossy).squirt / own - 1, rel=1e-6)
    assert 0.03 < inputs["surface_restitution"] < 0.05
    others = {key: share for key, share in inputs.items() if key != "surface_restitution"}
    assert shaft_uncertainty(inputs) == shaft_uncertainty(others)
    spring = replace(scene, effects=())
    assert "surface_restitution" not in squirt_changes(SolvedScene(spring), own).relative


@pytest.mark.heavy
def test_model_errors_agree_with_published_series() -> None:
    """The constants are the upper ends of the study's intervals."""
    errors = [uncertainty.model_error(model).high for model in ("full model", "bare tip")]
    constants = [MODEL_ERROR, SPRING_ERROR, SHAFT_ERROR, MASS_ERROR]
    assert [*errors, *uncertainty.ratio_errors()] == pytest.approx(constants, abs=5.1e-3)


@pytest.mark.heavy
def test_uncertainty_covers_published_rows() -> None:
    """At least 68 % of published squirts and of two shafts; the series of 3 g has fewer, as the page states."""
    within = {name: (inside, rows) for name, rows, inside, _ in uncertainty.coverage()}
    cues = [pair for name, pair in within.items() if " g on a shaft" not in name]
    inside, rows = map(sum, zip(*cues, strict=True))
    assert rows == 13
    assert inside / rows > 0.68
    assert within["11 g on a shaft"][0] / within["11 g on a shaft"][1] > 0.68
    assert f"| all | {sum(n for n, _ in within.values())} of 44 |" in uncertainty.STUDY.committed
