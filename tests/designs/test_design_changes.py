"""Design changes: rows equal strikes of changed cues, verdicts, saving of a row (properties)."""

import math
import tomllib
from dataclasses import replace
from pathlib import Path

import pytest

import cuefem as cf
from cuefem.analysis.design_changes import (
    ChangedDesign,
    DesignChanges,
    _verdict,
    design_changes,
)
from cuefem.cue.materials import material
from cuefem.parameters.scene_changes import with_parameters
from tests.helpers.command_line import call
from tests.helpers.invalid_input import assert_rejects
from tests.test_golden_files import assert_golden, drawing_text, page_text

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
    for row in record.changes[::3]:
        changed = with_parameters(scene, row.values)
        assert row.squirt_change == pytest.approx(cf.strike(changed).squirt / own.squirt - 1, abs=1e-8)
        assert row.shaft_mass_change == pytest.approx(changed.cue.shaft_mass - scene.cue.shaft_mass, abs=1e-12)
        new_frequency = cf.modes(changed.cue, effects=changed.cue_effects).frequencies[0]
        assert row.frequency_change == pytest.approx(new_frequency - frequency, abs=1e-6 * frequency)


def test_table_of_changes_equals_golden_file(request: pytest.FixtureRequest) -> None:
    """Made-up changes with each verdict, small and large."""
    sizes = (
        (-0.2, -0.051),
        (-0.1, 0.0949),
        (-0.021, -0.049),
        (-0.019, 0.0),
        (0.0, -0.095),
        (0.011, 0.0),
        (0.123, 0.0004),
    )
    rows = [
        ChangedDesign(
            f"change {i}", {}, 0.01, 300.0, 0.1, 90.0, *size, 1e-3 * i, -0.04 * i, 0.01, _verdict(*size, 0.01)
        )
        for i, size in enumerate(sizes)
    ]
    base = {"squirt": 0.02, "tip_stiffness": 300.0, "shaft_mass": 0.1, "frequency": 90.0}
    made = DesignChanges(scene_of("kim"), 0.3, "slip", base, rows, ("friction",))
    page = made.to_html()
    assert_golden("design_changes.txt", f"{made!r}\n{made}\n{page_text(page)}{drawing_text(page)}", request)


@pytest.mark.heavy
def test_tube_with_less_mass_in_front_has_less_squirt() -> None:
    """Thinner by 0.2 mm and without filling less, thicker and with an insert more; mass by the volume of each."""
    scene = with_parameters(scene_of("carbon"), {"front wall": 1.2e-3})
    record = design_changes(scene)
    rows = {row.change.split(",")[0]: row for row in record.changes}
    thinner, thicker = rows["wall thinner"], rows["wall thicker"]
    assert thinner.squirt_change < 0 < thicker.squirt_change
    empty, insert = rows["no filling in the first 150 mm of the tube"], rows["maple insert"]
    assert empty.squirt_change < 0 < insert.squirt_change
    front = scene.cue.segments[1]
    ring = math.pi * 1e-3 * (12.4e-3 - 2 * 1.1e-3)  # between walls of 1 and 1.2 mm, over 0.2 mm
    assert thinner.shaft_mass_change == pytest.approx(
        -0.2 * ring * 0.144 * (front.material.rho - material("foam").rho), rel=0.02
    )
    assert "unmeasured tube and tip" in " ".join(record.table().notes)


def test_front_of_a_tube_ends_at_a_solid_part() -> None:
    scene = scene_of("carbon")
    tip, front, *behind = scene.cue.segments
    hollow = replace(front, length=0.1)
    solid = replace(front, length=front.length - 0.1, tip_bore=0.0, butt_bore=0.0, core=None)
    scene = replace(scene, cue=replace(scene.cue, segments=(tip, hollow, solid, *behind)))
    filled = with_parameters(scene, {"insert depth": 0.1})
    assert [segment.core for segment in filled.cue.segments[1:4]] == [material("hard maple"), None, behind[0].core]
    with pytest.raises(ValueError, match="the tube is 100 mm long; got 120 mm"):
        with_parameters(scene, {"insert depth": 0.12})


@pytest.mark.heavy
def test_improve_take_saves_row_with_order_and_accuracy(tmp_path: Path) -> None:
    path, target, scene = tmp_path / "scene.toml", tmp_path / "better.toml", scene_of("kim")
    cf.save(scene, path)
    kept = {"accuracy": {"rtol": 0.01}, "order": {"customer": "B. Player"}}
    path.write_text(path.read_text() + '\n[accuracy]\nrtol = 0.01\n[order]\ncustomer = "B. Player"\n')
    code, out, err = call("improve", path, "--take", "2", "-o", target)
    assert (code, err) == (0, "")
    assert f"cuefem compare {path} {target}" in out
    assert cf.strike(cf.load(target)).squirt == pytest.approx(design_changes(scene).changes[1].squirt, rel=1e-9)
    saved = tomllib.loads(target.read_text())
    assert {name: saved[name] for name in kept} == kept
    assert_rejects("must be a row of the table, 1 to ", "improve", path, "--take", "99", "-o", tmp_path / "x.toml")
