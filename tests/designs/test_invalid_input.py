"""Invalid studies: calls and files, one for each `raise`; their messages are stored in tests/golden (bad input)."""

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import pytest

import cuefem as cf
from cuefem.designs import Levels, Normal, Response, Sample, Span, Study, Vary
from cuefem.designs.optimum import Limit, Problem
from cuefem.designs.scatter import Scatter
from cuefem.designs.search import optimum
from tests.helpers.cues import low_deflection, scene
from tests.helpers.invalid_input import assert_refused, messages_of, rejected, stored_rows
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
CALLS: dict[str, Callable[[], object]] = {
    "empty range": lambda: Span(2.0, 2.0, 3),
    "infinite range": lambda: Span(2.0, float("inf"), 3),
    "logarithm of 0": lambda: Span(0.0, 1.0, 3, logarithmic=True),
    "no values": lambda: Levels(()),
    "no path": lambda: Vary((), Levels((1.0,))),
    "no samples": lambda: Sample(0, 1),
    "negative seed": lambda: Sample(4, -1),
    "number for a material": lambda: varying("cue.segments[0].material", 1.0),
    "name for a mass": lambda: varying("ball.mass", "ash"),
    "factor of a constant": lambda: varying("cue.segments[0].kappa", 1.1, factor=True),
    "name of a formula": lambda: varying("ball.mass", 0.2, name="=cmd|' /C calc'!A0"),
    "name of two lines": lambda: varying("ball.mass", 0.2, name="bore\nwidth"),
    "field varied twice": lambda: Study(
        MAPLE, tuple(Vary(("ball.mass",), Levels((0.2,)), name) for name in "ab"), (Response("mass"),)
    ),
    "frequency of a lumped cue": lambda: varying("ball.mass", 0.2, response="frequency(1)", base=LUMPED),
    "misspelt response": lambda: Response.of("squrit(0.3)"),
    "misspelt name": lambda: Response("squrit"),
    "squirt at 2": lambda: Response("squirt", 2.0),
    "frequency 1.5": lambda: Response("frequency", 1.5),
    "squirt at a text": lambda: Response("squirt", "x"),
    "mass with brackets": lambda: Response.of("mass(3)"),
    "infinite frequency": lambda: Response.of("frequency(inf)"),
    "ball speed at a text": lambda: Response.of("ball_speed(fast)"),
    "squirt at the edge": lambda: Response.of("squirt(1)"),
    "pivot length at 0": lambda: Response.of("pivot_length(0)"),
    "correlation of an unknown name": lambda: scattered({("E", "density"): 0.3}),
    "correlation of 1": lambda: scattered({("E", "rho"): 1.0}),
    "correlation without a number": lambda: scattered({("E", "rho"): float("nan")}),
    "correlation with itself": lambda: scattered({("E", "E"): 0.5}),
    "correlation twice": lambda: scattered(PAIR | {("rho", "E"): 0.5}),
    "correlation of names": lambda: scattered({("E", "wood"): 0.5}),
    "contradicting correlations": lambda: scattered(CONTRADICTING),
    "two groups": lambda: scattered(groups={"a": ("E", "rho"), "b": ("rho",)}),
    "group without its correlate": lambda: scattered(PAIR, groups={"a": ("E", "time")}),
    "group of a parameter's name": lambda: scattered(groups={"time": ("E", "rho")}),
    "count of 100": lambda: scattered(count=100),
    "count of 1": lambda: scattered(count=1),
    "count with a fraction": lambda: scattered(count=64.0),
    "limit below 0 on a size": lambda: Limit(Response("squirt", -0.3), -0.02),
    "unprintable group": lambda: scattered(groups={"wood\x1b": ("E", "rho")}),
    "limits crossed": lambda: Limit(Response("mass"), 2.0, 1.0),
    "no parameters": lambda: replace(PROBLEM, vary=()),
    "optimum of a distribution": lambda: replace(PROBLEM, vary=(E,)),
    "target below 0 of a size": lambda: replace(PROBLEM, objective=Response("squirt", 0.3), target=-0.02),
    "target that is maximized": lambda: replace(PROBLEM, target=0.05, maximize=True),
    "optimum with workers": lambda: cf.study(PROBLEM, workers=2),
    "no rounds": lambda: cf.study(PROBLEM, rounds=0),
    "no workers": lambda: cf.study(varying("ball.mass", 0.2), workers=0),
    "workers of a text": lambda: cf.study(varying("ball.mass", 0.2), workers="two"),
}
RUNS: dict[str, Callable[[], object]] = {
    "scatter of miscues": lambda: cf.study(scattered(vary=(TIME,), count=2, response="squirt(0.9)")),
    "unreachable limit": lambda: optimum(STIFF, rounds=1),
    "unreachable target": lambda: optimum(replace(PROBLEM, target=0.01), rounds=1),
    "miscue at every design": lambda: optimum(MISCUE, rounds=1),
}


def test_study_invalid_call_raises(request: pytest.FixtureRequest) -> None:
    assert_refused("designs", messages_of(CALLS), request)


def test_study_without_answer_raises(request: pytest.FixtureRequest) -> None:
    assert_refused("study_runs", messages_of(RUNS), request)


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
    """Errors before the run: a store that is none, options, a drawing and a scene instead of a study."""
    monkeypatch.chdir(tmp_path)
    for name, study in (("best", OPTIMUM), ("beside_text", STUDY), ("study", STUDY)):
        write_study(tmp_path, study, name=f"{name}.toml")
    Path("cue.csv").write_text("x [mm],diameter [mm]\n0,12\n700,21\n")
    Path("beside_text.sqlite").write_bytes(b"design,end_mass\n" * 100)
    messages = {row: rejected(tmp_path, *row.split()) for row in stored_rows("study_options")}
    assert_refused("study_options", messages, request)
