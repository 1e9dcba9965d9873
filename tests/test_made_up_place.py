"""A place that is made up here, by one entry of the table of places, is found by all that vary a scene (properties)."""

from __future__ import annotations

import json
import subprocess
import sys
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

import cuefem as cf
from cuefem.design.optimum import optimum
from cuefem.design.scatter import Scatter, spread
from cuefem.designer.design import Design, State, Step
from cuefem.designer.kept import step_of, text_of
from cuefem.designer.sliders import groups, sliders
from cuefem.io.study_files import load_optimum, load_scatter, load_study
from cuefem.measured.unknowns import Prior, unknowns_of
from cuefem.parts import Part
from cuefem.quantity.fields import LENGTH
from cuefem.vary import PLACES, Place, Range, knobs_of, paths, varied

WOOD, BRASS = cf.Material(12.6e9, 0.84e9, 700.0), cf.Material(97e9, 37e9, 8500.0)
CUE = cf.Cue(
    (
        cf.Segment(0.10, 0.0125, 0.0126, WOOD),
        cf.Segment(0.01, 0.0126, 0.0126, BRASS),
        cf.Segment(0.59, 0.0126, 0.021, WOOD),
    ),
    0.42,
)
ROOT = Path(__file__).parents[1]
STUDY = """scene = "cue.toml"
responses = ["shaft_mass", "tip_diameter"]

[[vary]]
path = "collar length"
"""


def _length(scene: Any) -> float | None:
    return scene.shaft.segments[1].length if len(scene.shaft.segments) > 2 else None


def _with_length(scene: Any, value: float) -> Any:
    front, collar, behind = scene.shaft.segments
    rest = replace(behind, length=behind.length - (value - collar.length))
    return replace(scene, cue=replace(scene.shaft, segments=(front, replace(collar, length=value), rest)))


COLLAR = Place(
    "collar length",
    "length of the collar",
    part=Part(_length, _with_length, LENGTH),
    group="Shaft",
    range=Range("mm", 1e3, 2, 40, 0.5, 0.5, 60),
    spread=0.1,
    option="LENGTH",
)


@pytest.fixture(autouse=True)
def scene(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> cf.Scene:
    monkeypatch.setitem(PLACES, COLLAR.key, COLLAR)
    cf.save(CUE, tmp_path / "cue.toml")
    return cf.usual_scene(CUE)


def study(folder: Path, more: str) -> Path:
    (folder / "study.toml").write_text(STUDY + more, encoding="utf-8")
    return folder / "study.toml"


def test_it_is_an_axis_of_a_sweep(tmp_path: Path) -> None:
    found = load_study(study(tmp_path, 'low = "5 mm"\nhigh = "25 mm"\ncount = 3\n'))
    assert (found.columns[0], found.units[0], found.size) == ("collar length", "m", 3)
    assert [found.scene((x,)).cue.segments[1].length for x in (0.005, 0.025)] == [0.005, 0.025]
    assert found.scene((0.025,)).cue.length == pytest.approx(CUE.length, rel=1e-15)


def test_it_is_a_variable_of_an_optimizer(tmp_path: Path) -> None:
    text = STUDY.replace('responses = ["shaft_mass", "tip_diameter"]', '[objective]\nminimize = "shaft_mass"')
    (tmp_path / "optimum.toml").write_text(text + 'low = "5 mm"\nhigh = "25 mm"\n')
    best = optimum(load_optimum(tmp_path / "optimum.toml"), iterations=10)
    assert best.numbers["collar length"] == pytest.approx(0.005, abs=1e-4)
    assert best.scene.cue.segments[1].length == best.numbers["collar length"]


def test_it_is_a_tolerance(tmp_path: Path) -> None:
    sample = '\n[sample]\nmethod = "sobol"\ncount = 64\nseed = 1\n'
    scatter, drawn = load_scatter(study(tmp_path, 'middle = "10 mm"\nsd = "0.5 mm"\n' + sample))
    assert isinstance(scatter, Scatter)
    per_metre = (BRASS.rho - WOOD.rho) * 0.25 * 3.141592653589793 * 0.0126**2
    assert spread(scatter, drawn.count, seed=1).sd[0] == pytest.approx(5e-4 * per_metre, rel=0.1)


def test_it_is_an_unknown_of_an_estimate(scene: cf.Scene) -> None:
    from cuefem.measured.kinds import Setup

    (unknown,) = (each for each in unknowns_of(scene, ()) if each.name == "collar length")
    assert (unknown.words, unknown.unit, unknown.usual, unknown.spread) == ("length of the collar", "m", 0.01, 0.1)
    assert unknown.setup(Setup(scene), 1.0).scene == varied(scene, {"collar length": unknown.value(1.0)})
    (asked,) = (u for u in unknowns_of(scene, (), [Prior("collar length", spread=0.3)]) if u.name == "collar length")
    assert asked.spread == 0.3


def test_it_is_a_slider_and_stands_in_links(scene: cf.Scene) -> None:
    (slider,) = (each for each in sliders(scene) if each.knob == "collar_length")
    assert (slider.label, slider.unit, slider.shown(knobs_of(scene))) == ("Length of the collar", "mm", 10)
    assert "collar_length" in groups()["Shaft"]
    design = Design.of("cue", scene)
    longer = replace(design, knobs=slider.turned(design.knobs, 20))
    assert longer.scene.cue.segments[1].length == 0.02
    assert step_of(text_of(State((Step(longer),)))).design == longer


COMMANDS = """import sys
from tests import test_made_up_place as made_up
from cuefem.vary import PLACES

PLACES[made_up.COLLAR.key] = made_up.COLLAR
from tests.helpers.command_line import call

file, plain = sys.argv[1:]
print(call("strike", "--help")[1])
print(call("strike", file, "--collar-length", "20 mm", "--json")[1])
print(call("strike", plain, "--collar-length", "20 mm")[2])
"""


def test_it_is_an_option_of_commands(tmp_path: Path) -> None:
    """In a process of its own: a command's options are those of the table when the command is loaded."""
    plain = cf.Cue((cf.Segment(0.7, 0.0125, 0.021, WOOD),), 0.42)
    cf.save(plain, tmp_path / "plain.toml")
    files = (tmp_path / "cue.toml", tmp_path / "plain.toml")
    done = subprocess.run(
        [sys.executable, "-c", COMMANDS, *map(str, files)], cwd=ROOT, capture_output=True, text=True, check=True
    )
    told, _, rest = done.stdout.partition("\n{\n")
    struck, _, refused = rest.rpartition("\n}\n")
    assert "--collar-length LENGTH" in told
    assert "Length of the collar." in told
    mass = varied(cf.usual_scene(CUE), {"collar length": 0.02}).cue.shaft_mass
    assert json.loads("{" + struck + "}")["scene"]["cue"]["shaft_mass"] == pytest.approx(mass, rel=1e-12)
    assert "--collar-length: must be left out: there is no length of the collar" in refused


def test_a_cue_without_it_has_none_of_these() -> None:
    plain = cf.usual_scene(cf.Cue((cf.Segment(0.7, 0.0125, 0.021, WOOD),), 0.42))
    assert "collar_length" not in knobs_of(plain)
    assert "collar length" not in [each.name for each in unknowns_of(plain, ())]
    with pytest.raises(ValueError, match=r"got 'collar length', which this scene does not have"):
        paths(plain, "collar length")
