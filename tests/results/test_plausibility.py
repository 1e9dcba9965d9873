"""Warnings for implausible values, and none for shipped cues (regression)."""

import html
import json
from dataclasses import replace
from pathlib import Path

import pytest

import cuefem as cf
from cuefem.files.defaults_report import held_assumptions
from cuefem.results.plausibility import plausibility_warnings
from tests.helpers.command_line import call
from tests.helpers.random_shafts import random_shaft

ROOT = Path(__file__).parents[2]
KINDS = ("meshes/*.toml", "meshes/*.stl", "studies/scenes/*.toml", "studies/measured/*/cue.toml")
FILES = sorted(path for kind in KINDS for path in ROOT.glob(kind))


def warnings_of(path: Path) -> list[str]:
    loaded = cf.load(path)
    if isinstance(loaded, cf.Cue) and not loaded.body_mass and path.suffix != ".toml":  # a profile has no other mass
        loaded = replace(loaded, body_mass=0.43)
    return plausibility_warnings(loaded if isinstance(loaded, cf.Scene) else cf.Scene(loaded))


@pytest.mark.parametrize("path", FILES, ids=lambda path: path.name)
def test_plausibility_of_shipped_cues_has_no_warning(path: Path) -> None:
    assert warnings_of(path) == []


BUTTS = {"chamfer": "1460,30\n1470,5\n", "bumper": "1440,30\n1440.1,12\n1470,12\n"}


@pytest.mark.parametrize("name", BUTTS)
def test_chamfer_or_bumper_at_the_butt_causes_no_warning(name: str, tmp_path: Path) -> None:
    (tmp_path / "cue.csv").write_text("x [mm],diameter [mm]\n0,12.75\n330,13.2\n736.6,21.5\n" + BUTTS[name])
    assert plausibility_warnings(cf.Scene(cf.load(tmp_path / "cue.csv"))) == []


WOOD, PLASTIC = cf.material("hard maple"), cf.material("melamine")
CONE = cf.Segment(0.7, 0.01275, 0.0215, WOOD)
SLIPPED = {
    "a ferrule of 25 in": (cf.Segment(0.635, 0.01275, 0.02, PLASTIC, 0.008, 0.008, core=WOOD), CONE),
    "a ferrule of 0.25 mm": (cf.Segment(2.5e-4, 0.01275, 0.01275, PLASTIC, 0.008, 0.008, core=WOOD), CONE),
    "a bore of 12.7 mm in 12.75 mm": (cf.Segment(0.127, 0.01275, 0.01275, WOOD, 0.0127, 0.0127), CONE),
    "a bore of 0.6 mm": (cf.Segment(0.127, 0.01275, 0.01275, WOOD, 6e-4, 6e-4), CONE),
}


@pytest.mark.parametrize("slip", SLIPPED)
def test_slipped_size_of_a_part_is_warned(slip: str) -> None:
    part = "bore" if "0.6" in slip else "wall" if "bore" in slip else "ferrule"
    warnings = plausibility_warnings(cf.Scene(cf.Cue(SLIPPED[slip], 0.43)))
    assert any(part in line.partition(";")[0] for line in warnings)


@pytest.mark.filterwarnings("ignore::cuefem.PlausibilityWarning")
def test_random_shafts_have_no_warning_of_their_parts() -> None:
    for seed in range(580_000, 580_100):
        lines = plausibility_warnings(cf.Scene(replace(random_shaft(seed).cue, body_mass=0.43)))
        assert [line for line in lines if "check its unit" in line or "diameter and bore" in line] == [], seed


REVERSED = "x [mm],diameter [mm]\n0,21\n500,13.2\n736.6,12.75\n"


@pytest.mark.heavy
def test_python_says_what_the_command_says(tmp_path: Path) -> None:
    """Warnings and assumptions at each door: load, print, record, page; a changed value is assumed no longer."""
    path = tmp_path / "shaft.csv"
    path.write_text(REVERSED)
    with pytest.warns(cf.PlausibilityWarning, match="shaft.csv: the tip end is thicker than the butt end"):
        scene, cue = cf.load_scene(path), cf.load_cue(path)
    answer = cf.verdict(scene)
    said = json.loads(call("strike", path, "--json")[1])
    record = answer.to_dict()
    assert answer.warnings == record["warnings"] == said["warnings"] != []
    assert record["assumptions"] == [line.partition(" (--")[0] for line in said["assumptions"]]
    page = html.unescape(answer.to_html())
    for line in [*answer.warnings, *record["assumptions"]]:
        assert " ".join(line.split()) in " ".join(str(answer).split())
        assert line.replace("\N{NO-BREAK SPACE}", " ") in page.replace("\N{NO-BREAK SPACE}", " ")
    faster = cf.verdict(cf.with_parameters(scene, {"speed": 3.0}))
    assert {*map(str, answer.assumptions)} - {*map(str, faster.assumptions)} == {"cue speed 2 m/s"}
    assert cf.verdict(cf.usual_scene(cue)).said() == answer.said()
    assert {each.of for each in cf.verdict(replace(scene, assumed=None)).assumptions} == {"cue"}


def test_usual_scene_lists_what_it_chose_alone() -> None:
    cue = cf.Cue((cf.Segment(0.7, 0.01275, 0.0215, WOOD),))
    listed = [*map(str, cf.cue_numbers(cf.usual_scene(cue)).assumptions)]
    assert [line.partition(" ")[0] for line in listed] == [
        *("usual", "default", "ball", "ball", "leather", "tip", "tip", "restitution", "friction", "cue", "offset")
    ]
    whole = replace(cue, body_mass=0.43)
    scene = cf.usual_scene(whole, tip=cf.LeatherTip(6e-3, 9.5e-3, 6e7))
    assert {each.of for each in held_assumptions(scene)} == {"cue", "impact", "stroke"}
    assert next(map(str, held_assumptions(cf.usual_scene(whole, "kim")))) == "default stroke of kim (--game)"
