"""One shaft, one answer: the same squirt and verdict, or the same refusal, from every door."""

import json
import re
from pathlib import Path
from typing import Any

import pytest

import cuefem as cf
from cuefem.designer.computation import solved_strike, verdict
from cuefem.designer.controls import with_value
from cuefem.designer.state import read_design
from cuefem.designs.study_file import load_study
from cuefem.results.verdict import verdict_problem
from tests.helpers.command_line import call
from tests.helpers.random_shafts import RandomShaft, random_shaft
from tests.test_golden_files import assert_same_json

HEAVY, NIGHTLY = 2, 108
SIGNS = {"bore": -1, "bore wider": -1, "bore deeper": -1, "0.5 mm thinner": -1, "tip height": -1}  # of a change of mass
SEEDS = [
    *(pytest.param(seed, marks=pytest.mark.heavy) for seed in range(HEAVY)),
    *(pytest.param(seed, marks=pytest.mark.nightly) for seed in range(HEAVY, NIGHTLY)),
]


def record_of(*arguments: object) -> Any:
    """The record of a command with exit status 0, which may warn of implausible sizes."""
    status, out, _ = call(*arguments, "--json")
    assert status == 0
    return json.loads(out)


def of_study(shaft: RandomShaft, file: Path) -> cf.Scene:
    """The design of a study that varies dome and offset to those of the shaft."""
    study = file.with_name("study.toml")
    study.write_text(
        f'scene = "{file.name}"\ngame = "{shaft.game}"\nresponses = ["squirt"]\n'
        f'[[vary]]\npath = "dome"\nvalues = ["{shaft.dome_text}"]\n'
        f'[[vary]]\npath = "offset"\nvalues = [{shaft.offset!r}]\n',
        encoding="utf-8",
    )
    return load_study(study).scene((shaft.dome, shaft.offset))


def of_designer(shaft: RandomShaft, file: Path) -> cf.Scene:
    """The designer's scene after the user set dome and offset."""
    scene = read_design(file.name, file.read_bytes(), shaft.game).scene
    return with_value(with_value(scene, "dome", shaft.dome), "offset", shaft.offset)


def of_python(shaft: RandomShaft, file: Path) -> cf.Scene:
    """The scene by public functions."""
    drawing = cf.load(file)
    assert isinstance(drawing, cf.Cue)
    return cf.with_parameters(cf.usual_scene(drawing, shaft.game), {"dome": shaft.dome, "offset": shaft.offset})


@pytest.mark.parametrize("seed", SEEDS)
def test_every_door_has_the_same_squirt_and_verdict(seed: int, tmp_path: Path) -> None:
    shaft = random_shaft(seed)
    file, twin = tmp_path / "shaft.toml", tmp_path / "twin.toml"
    cf.save(shaft.cue, file)
    cf.save(shaft.cue, twin)
    status, _, refusal = call("strike", file, *shaft.options)
    if status:
        assert_doors_refuse(shaft, file, twin, refusal)
        return
    struck = record_of("strike", file, *shaft.options)
    squirt = struck["models"]["coupled"]["squirt"]
    scene = of_designer(shaft, file)
    assert of_study(shaft, file) == scene == of_python(shaft, file)
    own = solved_strike(scene)
    assert float(own.outcome.squirt) == pytest.approx(squirt, rel=1e-12)
    assert cf.strike(scene).squirt == pytest.approx(squirt, rel=1e-12)
    report = record_of("report", file, *shaft.options)
    compared = record_of("compare", file, twin, *shaft.options)
    in_python = cf.compare({"shaft": scene, "twin": cf.with_parameters(scene, {})}).values()
    assert_same_json({key: compared[key] for key in in_python}, in_python)
    problem = verdict_problem(scene, own.outcome)
    if problem:
        with pytest.raises(ValueError, match=re.escape(problem)):
            cf.verdict(scene)
        assert report["no_squirt"] == problem == compared["problems"]["shaft"]
        assert call("improve", file, *shaft.options)[::2] == (2, f"cuefem: {file}: {problem}\n")
        return
    for answer in (verdict(scene), cf.verdict(scene)):
        assert_same_json(report["verdict"], answer.values())
    assert report["verdict"]["squirt"] == pytest.approx(squirt, rel=1e-12)
    assert [*report["verdict"]["references"]] == ["plain maple", "low deflection", "carbon"]
    assert compared["cues"]["shaft"]["squirt"] == pytest.approx(squirt, rel=1e-12)
    assert compared["differences"]["twin"]["squirt"]["difference"] == 0
    improved = record_of("improve", file, *shaft.options)
    assert improved["unmodified"]["squirt"] == pytest.approx(squirt, rel=1e-12)
    for row in improved["changes"]:
        sign = next((sign for name, sign in SIGNS.items() if row["change"].startswith(name)), 0)
        assert sign * row["shaft_mass_change"] >= 0, row["change"]


def assert_doors_refuse(shaft: RandomShaft, file: Path, twin: Path, refusal: str) -> None:
    """Every door refuses the stroke for one reason; a comparison still has the numbers of the shafts."""
    reason = refusal.removeprefix(f"cuefem: {file}: ").partition(" (")[0].strip()
    for command in ("report", "improve"):
        assert call(command, file, *shaft.options)[::2] == (2, refusal)
    status, out, err = call("compare", file, twin, *shaft.options, "--json")
    assert err == refusal if status else reason in json.loads(out)["problems"]["shaft"]
    for door in (of_study, of_designer, of_python):
        with pytest.raises(ValueError, match=re.escape(reason)):
            solved_strike(door(shaft, file))
    for question in (cf.strike, cf.verdict, cf.design_changes):
        with pytest.raises(ValueError, match=re.escape(reason)):
            question(of_python(shaft, file))
