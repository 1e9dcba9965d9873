"""Results in the limit of small offsets, and numbers beside a strike that cannot be computed."""

from __future__ import annotations

import pytest

import cuefem as cf
from cuefem.results.quantities import RESULTS
from cuefem.results.solved_design import SolvedDesign
from studies.strokes import cue


@pytest.mark.parametrize("name", ["pool_maple", "pool_hollow"])
def test_pivot_length_tends_to_its_limit_of_small_offsets(name: str) -> None:
    """At the scene's speed: geometric stiffness makes it 5 % longer than that of the end mass."""
    design = SolvedDesign.of(cf.usual_scene(cue(name)))
    value = RESULTS["pivot_length"].of
    assert value is not None
    assert value(design, None) == pytest.approx(value(design, 1e-3), rel=1e-4)


def test_pivot_length_of_spring_tip_tends_to_its_limit_with_geometric_stiffness() -> None:
    """Without the thrust on the bent shaft the limit were 4 % off; 0.2 % is what modes leave of a tip that sticks."""
    usual = cf.usual_scene(cue("pool_maple"))
    effects = (cf.TipDome(0.0095), cf.GeometricStiffness())
    design = SolvedDesign.of(cf.Scene(usual.cue, usual.ball, cf.Tip(contact_time=1e-3), cf.Stroke(5.0, 0.3), effects))
    assert design.coupled_slope == pytest.approx(design.squirt(1e-3) / 1e-3, rel=2e-3)


def test_report_without_solution_of_a_side_number_lacks_that_number(monkeypatch: pytest.MonkeyPatch) -> None:
    def unsolved(*_: object) -> None:
        raise RuntimeError("the forces of the contact have no solution")

    scene = cf.usual_scene(cue("pool_maple"))
    with_all = cf.strike_models(scene).models
    monkeypatch.setattr("cuefem.endmass.definitions.strike_modes", unsolved)
    models = cf.strike_models(scene).models
    assert list(models) == ["coupled"] != list(with_all)
    assert models["coupled"]["squirt"] == with_all["coupled"]["squirt"]
