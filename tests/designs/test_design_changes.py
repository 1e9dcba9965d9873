"""Design changes: rows equal strikes of changed cues, verdicts, saving of a row (properties)."""

import math
from pathlib import Path

import numpy as np
import pytest

import cuefem as cf
from cuefem.analysis.design_changes import MIN_STIFFNESS_LOSS, MIN_WALL, DesignChanges, changes_of, design_changes
from cuefem.cue.materials import material
from cuefem.parameters.parameter import with_parameters
from cuefem.results.uncertainty import RATIO_FLOOR, SHAFT_ERROR
from tests.helpers.command_line import as_json, call
from tests.helpers.invalid_input import assert_rejects

ROOT = Path(__file__).parents[2]
REFERENCE = ("kim", "pool_hollow", "carbon")


def scene_of(name: str) -> cf.Scene:
    """The default stroke of a reference cue; of Kim's with a spring tip, which is solved faster."""
    cue = cf.load(ROOT / "meshes" / f"{name}.toml")
    spring = cf.Scene(cue, tip=cf.Tip(contact_time=1e-3), stroke=cf.Stroke(2.0, 0.3))
    return spring if name == "kim" else cf.usual_scene(cue)


@pytest.fixture(
    scope="module", params=[pytest.param(n, marks=pytest.mark.heavy if n in REFERENCE[1:] else ()) for n in REFERENCE]
)
def computed(request: pytest.FixtureRequest) -> tuple[cf.Scene, DesignChanges]:
    scene = scene_of(request.param)
    return scene, design_changes(scene)


def test_design_changes_rows_equal_strikes_of_changed_cues(computed: tuple[cf.Scene, DesignChanges]) -> None:
    scene, record = computed
    own = cf.strike(scene)
    frequency = cf.modes(scene.cue, effects=scene.cue_effects).frequencies[0]
    assert record.unmodified["squirt"] == pytest.approx(own.squirt, rel=1e-9)
    assert record.changes
    for row in record.changes:
        changed = with_parameters(scene, row.values)
        assert row.squirt_change == pytest.approx(cf.strike(changed).squirt / own.squirt - 1, abs=1e-8)
        assert row.shaft_mass_change == pytest.approx(changed.cue.shaft_mass - scene.cue.shaft_mass, abs=1e-12)
        new_frequency = cf.modes(changed.cue, effects=changed.cue_effects).frequencies[0]
        assert row.frequency_change == pytest.approx(new_frequency - frequency, abs=1e-6 * frequency)


def test_design_changes_are_sorted_with_verdicts(computed: tuple[cf.Scene, DesignChanges]) -> None:
    rows = computed[1].changes
    changes = [row.squirt_change for row in rows]
    assert changes == sorted(changes)
    for row in rows:
        worthwhile = row.squirt_change < -row.squirt_change_error
        assert ("worthwhile" in row.verdict) == worthwhile
        assert ("costs stiffness" in row.verdict) == (worthwhile and row.tip_stiffness_change < -MIN_STIFFNESS_LOSS)
        assert (row.verdict == "within uncertainty") == (abs(row.squirt_change) <= row.squirt_change_error)
        assert row.squirt_change_error >= math.hypot(RATIO_FLOOR, SHAFT_ERROR * math.log1p(row.squirt_change)) / 1.15


@pytest.mark.heavy
def test_design_change_error_equals_comparison_of_same_shaft() -> None:
    scene = scene_of("pool_maple")
    (row,) = (row for row in design_changes(scene).changes if row.change == "ABS ferrule")
    pair = {"before": scene, "after": with_parameters(scene, row.values)}
    error = cf.compare(pair, same_shaft=True).differences["after"]["squirt"]["error"]
    assert row.squirt_change_error == pytest.approx(error, rel=0.01)


def test_design_changes_walls_are_thick_enough(computed: tuple[cf.Scene, DesignChanges]) -> None:
    scene, record = computed
    for row in record.changes:
        bored = [
            s
            for s in with_parameters(scene, row.values).cue.segments
            if s.core is None and max(s.tip_bore, s.butt_bore)
        ]
        walls = [min(s.tip_diameter - s.tip_bore, s.butt_diameter - s.butt_bore) / 2 for s in bored]
        assert min(walls, default=np.inf) >= MIN_WALL


def test_design_changes_of_tube_exclude_tapers_and_woods() -> None:
    labels = [change.label for change in changes_of(scene_of("carbon"))]
    assert not any("taper" in each or "shaft" in each or "thinner" in each for each in labels)
    (tube,) = (change for change in changes_of(scene_of("pool_maple")) if "carbon" in change.label)
    changed = with_parameters(scene_of("pool_maple"), tube.values)
    assert {s.core for s in changed.cue.segments[1:]} == {material("foam")}


def test_improve_take_saves_row_and_replaces_no_file(tmp_path: Path, computed: tuple[cf.Scene, DesignChanges]) -> None:
    path, target = tmp_path / "scene.toml", tmp_path / "better.toml"
    cf.save(computed[0], path)
    rows = as_json("improve", path)["changes"]
    assert [row["squirt"] for row in rows] == pytest.approx([row.squirt for row in computed[1].changes], rel=1e-12)
    code, out, err = call("improve", path, "--take", "2", "-o", target)
    assert (code, err) == (0, "")
    assert f"cuefem compare {path} {target}" in out
    assert cf.strike(cf.load(target)).squirt == pytest.approx(rows[1]["squirt"], rel=1e-9)
    assert_rejects("--force", "improve", path, "--take", "2", "-o", target)
    assert_rejects("--take: requires -o FILE.toml", "improve", path, "--take", "1")
    assert_rejects("must be a row of the table, 1 to ", "improve", path, "--take", "99", "-o", tmp_path / "x.toml")
