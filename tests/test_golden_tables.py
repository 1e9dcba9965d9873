"""Numbers that a user reads in tables against golden files: options, units, games, ranges, bounds (regression)."""

import re
from collections.abc import Callable
from dataclasses import MISSING, fields, replace
from functools import partial
from inspect import Parameter, Signature, signature
from pathlib import Path

import numpy as np
import pytest

import cuefem as cf
from cuefem.analysis.shop_changes import changes_of, dimensions_of
from cuefem.cli import listed_commands
from cuefem.cue.materials import material
from cuefem.designer.controls import KNOBS, parse, range_of
from cuefem.designs.evaluation import Response
from cuefem.effects.effect import effect_kinds
from cuefem.files.misplaced_diameters import misplaced_rows
from cuefem.files.parts_catalogue import CATALOGUE_SHAFTS, catalogue_shaft
from cuefem.measurements.measurement_types import MEASUREMENT_TYPES, PivotLength, Squirt
from cuefem.measurements.recording import spectral_peaks
from cuefem.measurements.shot import Shot
from cuefem.parameters.scene_changes import with_parameters
from cuefem.parameters.table import PARAMETERS
from cuefem.quantity.display_units import METRIC, US, displayed_in
from cuefem.quantity.fields import quantity_fields
from cuefem.quantity.units import UNITS, unit_of
from cuefem.results.computable_results import computable_results, listed_results
from cuefem.results.plausibility import plausibility_warnings
from cuefem.results.quantities import RESULTS
from cuefem.results.solved_design import SolvedDesign
from cuefem.scene.default_scene import GAMES
from cuefem.scene.solved_scene import SolvedScene
from tests.helpers import measured_cues
from tests.helpers.command_line import call
from tests.helpers.cues import any_size
from tests.helpers.invalid_input import assert_calls_refused
from tests.helpers.measured_cues import measured_cue
from tests.quantity.test_declared_fields import INSTANCES
from tests.test_golden_files import assert_golden

MAGNITUDES = (1234.56789, 1.23456789, 0.00123456789)  # SI
MAPLE, ABS = material("hard maple"), material("abs")
CUE = cf.Cue((cf.Segment(0.7, 0.012, 0.021, MAPLE),), 0.4)


def options(folder: Path) -> list[object]:
    """Options of every command, with their defaults and bounds, as its help has them."""
    helps = {name: " ".join(call(name, "--help")[1].split()) for name in listed_commands()}
    return [(name, *re.findall(r"--[\w-]+(?: [A-Z/]{3,}(?![a-z]))?|\[.*?\]", text)) for name, text in helps.items()]


def results(folder: Path) -> list[object]:
    """Every result at three magnitudes, in both units; how a study names and compares it, and what it needs."""
    rows: list[object] = []
    for system in ("metric", "us"):
        with displayed_in(system):
            rows += [(system, name, *map(result.format, MAGNITUDES)) for name, result in RESULTS.items()]
    drawn, lumped = cf.load("studies/scenes/kim.toml"), cf.Scene(cf.LumpedCue(0.54, 0.01))
    for scene in (drawn, lumped):
        rows += [(name, value) for name, value in listed_results(SolvedDesign(SolvedScene(scene))).items()]
    named = [
        Response.of(f"{name}(1)" if one.argument == "mode" else name) for name, one in computable_results().items()
    ]
    return rows + [(one.label, one.size(-1.0), one.result.has_model_error) for one in named]


def units(folder: Path) -> list[object]:
    """Every unit in SI units, and its dimension; the units displayed, their numbers per SI unit, and their decimals."""
    return [(name, *unit_of(name)) for name in UNITS] + [row for shown in (METRIC, US) for row in shown.items()]


def games(folder: Path) -> list[object]:
    """Ball, tip, butt and stroke of a bare shaft in each game, as files have them; the dome of a wide front."""
    path, rows = folder / "scene.toml", []
    for game in GAMES:
        for front in ("12.75", "20"):
            cf.save(cf.usual_scene(cf.Cue((cf.Segment(0.73, float(front) / 1e3, 0.0215, MAPLE),)), game), path)
            text = path.read_text(encoding="utf-8")
            rows += [game, text if front == "12.75" else text.partition("dome_radius")[2].partition("\n")[0]]
    return rows


def shafts(folder: Path) -> list[object]:
    """The drawing of each shaft of the catalogue, as files have it."""
    rows: list[object] = []
    for name in CATALOGUE_SHAFTS:
        cf.save(catalogue_shaft(name, cf.load), folder / "shaft.toml")
        rows += [name, (folder / "shaft.toml").read_text(encoding="utf-8")]
    return rows


def ranges(folder: Path) -> list[object]:
    """Ranges of sliders and of typed values in the designer, in both units."""
    rows: list[object] = []
    for system in ("metric", "us"):
        with displayed_in(system):
            rows += [(system, key, *range_of(key)) for key, knob in KNOBS.items() if knob.range]
    return rows


def bounds(folder: Path) -> list[object]:
    """Unit, bounds, range of real cues and named values of every field of a cue, stroke or effect."""
    marks = [(type(one).__name__, name, mark) for one in INSTANCES for name, mark, _ in quantity_fields(type(one))]
    return [(kind, name, mark.bounds, mark.typical_range, mark.names) for kind, name, mark in marks]


def effects(folder: Path) -> list[object]:
    """Every effect as commands try it, whether it is at the tip; beside itself, and on a cue without a drawing."""
    rows: list[object] = []
    for kind in effect_kinds().values():
        required = [one.name for one in fields(kind) if one.default is MISSING]
        if kind.__module__.startswith("cuefem.") and (kind.trial_values or not required):
            effect = kind(**(kind.trial_values.values if kind.trial_values else {}))
            twice = raised(partial(cf.Scene, CUE, effects=(effect, effect)))
            rows += [effect, kind.at_tip, twice, raised(partial(cf.Scene, cf.LumpedCue(0.54, 0.01), effects=(effect,)))]
    return rows


def changes(folder: Path) -> list[object]:
    """Every change that `cuefem improve` tries on solid, bored and tubular shafts, in both units; ranges of sizes."""
    scenes = [cf.usual_scene(cf.load(f"meshes/{name}.toml")) for name in ("pool_maple", "pool_hollow", "carbon")]
    scenes.append(cf.with_parameters(scenes[0], {"ferrule length": 0.0099, "tip height": 0.0029}))
    rows: list[object] = []
    for system in ("metric", "us"):
        with displayed_in(system):
            rows += [change for scene in scenes for change in changes_of(scene)]
            sizes = [size for scene in scenes for size in dimensions_of(scene)]
            rows += [(size.change(size.size(1)).label, *size[1:]) for size in sizes]
    return rows


@any_size()
def warnings(folder: Path) -> list[object]:
    """Warnings of a scene in which nothing is plausible: the values that are expected."""
    tungsten = cf.Material(4e11, 1.6e11, 2000.0)
    cones = ((0.2, 0.004, 0.05), (0.5, 0.08, 0.09), (1.0, 0.02, 0.03))
    cue = cf.Cue(tuple(cf.Segment(*cone, tungsten) for cone in cones), 0.9)
    ball, tip = cf.Ball(mass=0.6, radius=0.06), cf.Tip(restitution=0.96, friction=1.25, contact_time=0.02)
    scenes = [cf.Scene(cue, ball, tip, cf.Stroke(50.0, 0.3), (cf.TipDome(0.2),)), cf.Scene(cf.LumpedCue(0.1, 0.01))]
    scenes.append(cf.Scene(cf.Cue((cf.Segment(0.7, 0.012, 0.021, MAPLE, 0.0, 0.003),), 0.4)))
    thin_walled = cf.Segment(0.7, 0.0127, 0.021, MAPLE, 6e-4, 0.0209)
    ferrules = [cf.Segment(length, 0.0127, 0.0127, ABS, 0.008, 0.008, core=MAPLE) for length in (2e-4, 0.1)]
    scenes += [cf.Scene(cf.Cue((ferrule, thin_walled), 0.4)) for ferrule in ferrules]
    return [warning for scene in scenes for warning in plausibility_warnings(scene)]


def raised(made: Callable[[], object]) -> str:
    """The error of a call, or ""."""
    try:
        made()
    except ValueError as error:
        return str(error)
    return ""


def measurements(folder: Path) -> list[object]:
    """The kinds of measurements, those that an estimate may ask for next, and what readings of a ball assume."""
    scene = cf.load("studies/scenes/kim.toml")
    rows: list[object] = []
    for name, kind in MEASUREMENT_TYPES.items():
        arguments = [each.replace(annotation=Parameter.empty) for each in signature(kind).parameters.values()]
        rows.append(f"{name}{Signature(arguments)}")
    rows += [row for kind in MEASUREMENT_TYPES.values() for row in kind.candidates(scene)]
    shot = Shot(cue_offset=0.0143, left=0.04, right=0.038, distance=1.2)
    shots = [each.squirt(measured_cues.SCENE) for each in (shot, replace(shot, elevation=0.05, speed=3.0))]
    parameters = measured_cue(*shots, *(row for row in rows if isinstance(row, Squirt | PivotLength))).parameters
    return rows + [(each.name, each.label, *map(each.value, (-1.0, 0.0, 1.0))) for each in parameters]


def spreads(folder: Path) -> list[object]:
    """Uncertainties of parameters: with a spring as the tip; of a solid shaft, a bored one and a tube with leather."""
    shafts = ["studies/scenes/kim.toml", *(f"meshes/{name}.toml" for name in ("pool_maple", "pool_hollow", "carbon"))]
    loaded = [cf.load(path) for path in shafts]
    scenes = [each if isinstance(each, cf.Scene) else cf.usual_scene(each) for each in loaded]
    ivory = with_parameters(scenes[1], {"ferrule material": "ivory"})
    scenes.append(replace(ivory, cue=replace(ivory.shaft, assumed_body_mass=ivory.shaft.body_mass)))
    return [(key, each.below, *map(each.spread_in, scenes)) for key, each in PARAMETERS.items()]


def slips(folder: Path) -> list[object]:
    """Rows of a shaft with a chamfer that are listed as misplaced, and why, after a factor of one diameter."""
    x, d = (0.0, 8e-3, 0.03, 0.2, 0.4, 0.6, 0.73), (0.01248, 0.01275, 0.0128, 0.0133, 0.015, 0.018, 0.0215)
    rows = list[object]()
    for row in range(len(d)):
        for factor in (1 / 25.4, 0.01, 0.1, 0.49, 0.51, 0.61, 0.64, 0.655, 0.68, 1.47, 1.52, 1.58, 1.62, 2.1, 10, 25.4):
            slipped = (*d[:row], factor * d[row], *d[row + 1 :])
            rows += [(row, factor, *misplaced_rows(x, slipped, in_inches=unit)) for unit in (False, True)]
    return rows


TABLES = options, results, units, games, shafts, ranges, bounds, effects, changes, warnings, measurements


@pytest.mark.parametrize("table", [*TABLES, spreads, slips])
def test_table_equals_golden_file(
    table: Callable[[Path], list[object]], tmp_path: Path, request: pytest.FixtureRequest
) -> None:
    text = "".join(f"{row}\n" for row in table(tmp_path))
    text = re.sub(r"\d+\.\d{9,}(?!\d|e)", lambda number: f"{float(number[0]):.8g}", text)
    assert_golden(f"table_{table.__name__}.txt", text, request, exact=True)


TIP, SCENE = cf.LeatherTip(6e-3, 1.0, 2e8), cf.Scene(CUE)
CALLS = {"np": np} | {each.__name__: each for each in (parse, replace, spectral_peaks, with_parameters)}


@any_size()
def test_size_beyond_its_limit_is_refused(request: pytest.FixtureRequest) -> None:
    """With the bound; files and texts of commands are in the tests of their rooms."""
    assert_calls_refused("limits", globals() | CALLS, request)
