"""Warnings for implausible values, and none for shipped cues (regression)."""

import html
import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import cuefem as cf
from cuefem.cue.materials import MATERIALS
from cuefem.files.defaults_report import held_assumptions
from cuefem.results.plausibility import plausibility_warnings
from tests.helpers.command_line import call
from tests.helpers.random_shafts import random_shaft

ROOT = Path(__file__).parents[2]
KINDS = ("meshes/*.toml", "meshes/*.stl", "studies/scenes/*.toml", "studies/measured/*/cue.toml")
FILES = sorted(path for kind in KINDS for path in ROOT.glob(kind))


@pytest.mark.parametrize("path", FILES, ids=lambda path: path.name)
def test_plausibility_of_shipped_cues_has_no_warning(path: Path) -> None:
    loaded = cf.load(path)
    if isinstance(loaded, cf.Cue) and not loaded.body_mass and path.suffix != ".toml":  # a profile has no other mass
        loaded = replace(loaded, body_mass=0.43)
    assert plausibility_warnings(loaded if isinstance(loaded, cf.Scene) else cf.Scene(loaded)) == []


WOOD, PLASTIC, FIBRE = cf.material("hard maple"), cf.material("melamine"), cf.Material(1e11, 5e9, 1500.0)
CONE = cf.Segment(0.7, 0.01275, 0.0215, WOOD)


def piece(length: float, diameter: float = 0.01275, made: cf.Material = WOOD, bore: float = 0.0) -> cf.Segment:
    return cf.Segment(length, diameter, diameter, made, bore, bore)


def weighed(density: float) -> cf.Segment:
    return piece(0.7, made=replace(WOOD, rho=density))


def ferruled(length: float) -> tuple[cf.Segment, ...]:
    return replace(piece(length, made=PLASTIC, bore=0.008), core=WOOD), CONE


LIMITS = {  # of what is warned, where, and a drawing with such a value
    "ferrule length": (5e-4, ferruled),
    "a ferrule on its tenon": (0.06, ferruled),
    "wall of": (2e-4, lambda x: (replace(piece(0.1), tip_bore=0.01275 - 2 * x), CONE)),
    "wall of segments[0]": (2e-4, lambda x: (replace(piece(0.1), butt_bore=0.01275 - 2 * x), CONE)),
    "bore of": (1e-3, lambda x: (piece(0.1, bore=x), CONE)),
    "drawn mass": (0.02, lambda x: (piece(0.5, made=replace(WOOD, rho=x / (np.pi / 4 * 0.01275**2 * 0.5))),)),
    "diameter jumps": (1.5, lambda x: (CONE, piece(0.3, 0.0215 * x))),
    # a bumper behind the butt with this share of the volume is no jump
    "jumps from": (0.01, lambda x: (CONE, piece(0.7, 0.03), piece(2.41 * x, 0.03 / 1.6))),
    "mass is too large": (1.1 * MATERIALS["hard maple"].ranges["rho"][1], lambda x: (weighed(x),)),
    "mass is too small": (0.9 * MATERIALS["hard maple"].ranges["rho"][0], lambda x: (weighed(x),)),
    "solid rod": (0.3, lambda x: (piece(x, made=FIBRE), CONE)),
    "as stiff as carbon": (3e10, lambda x: (piece(0.4, made=replace(FIBRE, E=x)), CONE)),
    "carbon shafts are tubes": (2500.0, lambda x: (piece(0.4, made=replace(FIBRE, rho=x)), CONE)),
}


@pytest.mark.filterwarnings("ignore::cuefem.PlausibilityWarning")
@pytest.mark.parametrize("words", LIMITS)
def test_value_beyond_its_limit_alone_is_warned_of(words: str) -> None:
    limit, drawn = LIMITS[words]
    cues = (cf.Cue(drawn(limit * factor), 0.43, shaft_mass_measured=True) for factor in (0.995, 1.005))
    below, above = (any(words in line for line in plausibility_warnings(cf.Scene(cue))) for cue in cues)
    assert below != above


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
