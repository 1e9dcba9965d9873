"""Numbers that a user reads in tables against golden files: options, units, games, ranges, errors (regression)."""

import re
from collections.abc import Callable
from dataclasses import MISSING, fields
from pathlib import Path
from typing import Any

import pytest

import cuefem as cf
from cuefem.cli import listed_commands
from cuefem.cue.materials import material
from cuefem.designer.controls import KNOBS, range_of
from cuefem.designs.evaluation import Response
from cuefem.effects.effect import effect_kinds
from cuefem.measurements.measurement_types import MEASUREMENT_TYPES
from cuefem.quantity.display_units import displayed_in
from cuefem.quantity.units import UNITS, unit_of
from cuefem.results.computable_results import computable_results, listed_results
from cuefem.results.quantities import RESULTS
from cuefem.results.solved_design import SolvedDesign
from cuefem.scene.default_scene import GAMES
from cuefem.scene.solved_scene import SolvedScene
from tests.helpers.command_line import call
from tests.test_golden_files import assert_golden

MAGNITUDES = (1234.56789, 1.23456789, 0.00123456789)  # SI
MAPLE = material("hard maple")
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
    return rows + [(one.label, one.size(-1.0)) for one in named]


def units(folder: Path) -> list[object]:
    """Every unit in SI units, and its dimension."""
    return [(name, *unit_of(name)) for name in UNITS]


def games(folder: Path) -> list[object]:
    """Ball, tip, butt and stroke of a bare shaft in each game, as files have them; the dome of a wide front."""
    path, rows = folder / "scene.toml", []
    for game in GAMES:
        for front in ("12.75", "20"):
            cf.save(cf.usual_scene(cf.Cue((cf.Segment(0.73, float(front) / 1e3, 0.0215, MAPLE),)), game), path)
            text = path.read_text(encoding="utf-8")
            rows += [game, text if front == "12.75" else text.partition("dome_radius")[2].partition("\n")[0]]
    return rows


def ranges(folder: Path) -> list[object]:
    """Ranges of sliders and of typed values in the designer, in both units."""
    rows: list[object] = []
    for system in ("metric", "us"):
        with displayed_in(system):
            rows += [(system, key, *range_of(key)) for key, knob in KNOBS.items() if knob.range]
    return rows


def effects(folder: Path) -> list[object]:
    """Every effect as commands try it, whether it is at the tip; beside itself, and on a cue without a drawing."""
    rows: list[object] = []
    for kind in effect_kinds().values():
        required = [one.name for one in fields(kind) if one.default is MISSING]
        if kind.__module__.startswith("cuefem.") and (kind.trial_values or not required):
            effect = kind(**(kind.trial_values.values if kind.trial_values else {}))
            rows += [effect, kind.at_tip, refusal(CUE, effect, effect), refusal(cf.LumpedCue(0.54, 0.01), effect)]
    return rows


def refusal(cue: Any, *effects: Any) -> str:
    """The error of a scene, or ""."""
    try:
        cf.Scene(cue, effects=effects)
    except ValueError as error:
        return str(error)
    return ""


def measurements(folder: Path) -> list[object]:
    """The measurements that an estimate may ask for next, with the errors of simple instruments."""
    scene = cf.load("studies/scenes/kim.toml")
    return [row for kind in MEASUREMENT_TYPES.values() for row in kind.candidates(scene)]


@pytest.mark.parametrize("table", [options, results, units, games, ranges, effects, measurements])
def test_table_equals_golden_file(
    table: Callable[[Path], list[object]], tmp_path: Path, request: pytest.FixtureRequest
) -> None:
    rows = [row if isinstance(row, str) else str(row) for row in table(tmp_path)]
    assert_golden(f"table_{table.__name__}.txt", "\n".join(rows) + "\n", request)
