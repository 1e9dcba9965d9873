"""Invalid studies: calls and files, one for each `raise`; their messages are stored in tests/golden (bad input)."""

from dataclasses import replace
from pathlib import Path

import pytest

import cuefem as cf
from cuefem.designs import Levels, Normal, Response, Sample, Span, Study, Vary
from cuefem.designs.optimum import Limit, Problem
from cuefem.designs.scatter import Scatter
from tests.helpers.cues import low_deflection, scene
from tests.helpers.invalid_input import assert_calls_refused, assert_refused, rejected, stored_rows
from tests.helpers.sweeps import OPTIMUM, SCATTER, STRIKES, STUDY, write_study

AT = cf.Resolution(1, 4, 2)
MAPLE = cf.Scene(cf.load(Path(__file__).parents[2] / "meshes" / "pool_maple.toml"))
LUMPED = cf.Scene(cf.LumpedCue(0.5, 0.01))
E = Vary(("cue.segments[*].material.E",), Normal(1.0, 0.22, logarithmic=True), "E", factor=True)
RHO = Vary(("cue.segments[*].material.rho",), Normal(1.0, 0.1, logarithmic=True), "rho", factor=True)
TIME = Vary(("tip.contact_time",), Span(0.8e-3, 1.5e-3), "time")
WOOD = Vary(("cue.segments[2].material",), Levels(("hard maple", "ash")), "wood")
BORE = Vary(("cue.segments[1].tip_bore", "cue.segments[1].butt_bore"), Span(0.002, 0.010), "bore")
PROBLEM = Problem(scene(low_deflection(), 1e-3), (BORE,), Response("squirt_slope"), (), cf.Resolution(1, 6, 8))
STIFF = replace(PROBLEM, limits=(Limit(Response("tip_stiffness"), low=1e3),))
MISCUE = replace(STIFF, objective=Response("squirt", 0.8))


def scattered(
    correlations: object = (),
    *,
    groups: object = (),
    vary: object = (E, RHO, TIME, WOOD),
    count: object = 16,
    response: str = "shaft_mass",
):
    return Scatter(Study(MAPLE, vary, (Response.of(response),), at=AT), dict(correlations), dict(groups), count, 1)


def varying(path: str, *values: object, response: str = "mass", base: cf.Scene = MAPLE, **more: object) -> Study:
    return Study(base, (Vary((path,), Levels(values), **more),), (Response.of(response),), at=AT)


PAIR = {("E", "rho"): 0.5}
CONTRADICTING = {("E", "rho"): 0.9, ("rho", "time"): 0.9, ("E", "time"): -0.9}


@pytest.mark.parametrize("table", ["designs", "study_runs"])
def test_study_invalid_call_raises(table: str, request: pytest.FixtureRequest) -> None:
    assert_calls_refused(table, globals() | {"Sample": Sample}, request)


STUDIES = {"study": STUDY, "strikes": STRIKES, "scatter": SCATTER, "optimum": OPTIMUM}


def test_study_invalid_file_raises(tmp_path: Path, request: pytest.FixtureRequest) -> None:
    """Each row: a study, the text replaced in it, its replacement."""
    messages = {}
    for row in stored_rows("study_files"):
        name, change = row.replace("\\n", "\n").split(" | ")
        old, new = change.split(" -> ")
        assert old in STUDIES[name]
        study = write_study(tmp_path, STUDIES[name].replace(old, new, 1))
        messages[row] = rejected(tmp_path, "study", study)
    assert_refused("study_files", messages, request)


def test_study_invalid_options_change_no_file(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, request: pytest.FixtureRequest
) -> None:
    """Errors before the run: a store that is none, options, a drawing, a scene and a stub instead of a study."""
    monkeypatch.chdir(tmp_path)
    for name, study in (("best", OPTIMUM), ("beside_text", STUDY), ("study", STUDY)):
        write_study(tmp_path, study, name=f"{name}.toml")
    Path("cue.csv").write_text("x [mm],diameter [mm]\n0,12\n700,21\n")
    Path("notes.toml").write_text('game = "pool"\n')
    Path("beside_text.sqlite").write_bytes(b"design,end_mass\n" * 100)
    messages = {row: rejected(tmp_path, *row.split()) for row in stored_rows("study_options")}
    assert_refused("study_options", messages, request)
