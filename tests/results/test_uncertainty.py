"""Uncertain inputs of squirt (properties)."""

import math
from dataclasses import replace

import pytest

import cuefem as cf
from cuefem.analysis.comparison import compare_cues
from cuefem.parameters.scene_changes import with_parameters
from cuefem.parameters.table import PARAMETERS
from cuefem.results.uncertainty import (
    shaft_uncertainty,
    squirt_changes,
    squirt_of,
)
from cuefem.results.verdict import NoVerdict
from cuefem.scene.solved_scene import SolvedScene
from studies.strokes import cue


def test_squirt_changes_surface_restitution_is_one_sided() -> None:
    """Surface restitution 0.95 instead of 1 increases squirt by 4 %; two shafts with one tip share this error."""
    scene = cf.usual_scene(cue("pool_maple"))
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
def test_friction_is_an_input_of_late_slip_alone() -> None:
    """At 5 m/s and b/R 0.45 friction changes squirt by about 10 %, at 2 m/s and b/R 0.3 by less than 0.1 %."""
    scene = cf.usual_scene(cue("pool_maple"))
    shares = [
        cf.verdict(with_parameters(scene, {"speed": speed, "offset": offset}), {}).inputs["friction"]
        for speed, offset in ((2.0, 0.3), (5.0, 0.45))
    ]
    assert shares[0] < 1e-3
    assert 0.05 < shares[1] < 0.15


@pytest.mark.heavy
def test_squirt_changes_miscue_on_one_side_takes_the_other() -> None:
    """At b/R 0.57 a tip with less friction slips off: its squirt, which hardly depends on the cue, does not count."""
    scene = with_parameters(cf.usual_scene(cue("pool_maple")), {"offset": 0.57})
    own = float(cf.strike(scene).squirt)
    spread = PARAMETERS["friction"].spread_in(scene)
    assert isinstance(spread, float)
    slippery, rough = (with_parameters(scene, {"friction": 0.7 * math.exp(sign * spread)}) for sign in (-1, 1))
    assert cf.strike(slippery).regime == "miscue"
    changes = squirt_changes(SolvedScene(scene), own)
    assert changes.miscues == ("friction",)
    assert changes.of("squirt")["friction"] == pytest.approx(float(cf.strike(rough).squirt) / own - 1, rel=1e-6)
    with pytest.raises(NoVerdict, match=r"miscue at b/R 0\.57"):
        squirt_of(slippery)


@pytest.mark.heavy
def test_input_beyond_the_range_of_the_tip_is_named_by_report_and_comparison() -> None:
    """At 19 m/s softer leather is indented beyond its range: both say so of it, by one rule."""
    scene = with_parameters(cf.usual_scene(cue("pool_maple")), {"offset": 0.2, "speed": 19.0})
    verdict = cf.verdict(scene, {})
    assert "leather" in verdict.miscues
    other = with_parameters(scene, {"tip diameter": 12e-3})
    beside = compare_cues({"own": scene, "other": other}, names=("squirt",))
    assert beside.miscues["own"] == verdict.miscues
