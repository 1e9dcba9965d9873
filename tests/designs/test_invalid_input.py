"""Invalid studies: calls and files, one for each `raise`, each with a part of its error message (bad input)."""

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import pytest

import cuefem as cf
from cuefem.designs import Levels, Normal, Response, Sample, Span, Study, Vary
from cuefem.designs.optimum import Limit, Problem, optimum
from cuefem.designs.scatter import Scatter
from cuefem.designs.sensitivity import sensitivity
from tests.helpers.cues import low_deflection, scene
from tests.helpers.invalid_input import assert_raises, assert_rejects, assert_unchanged
from tests.helpers.sweeps import OPTIMUM, SCATTER, SCENE, STRIKES, STUDY, write_study

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
    correlations: object = (), *, groups: object = (), vary: object = (E, RHO, TIME, WOOD), count: object = 16
):
    return Scatter(Study(MAPLE, vary, (Response("shaft_mass"),), at=AT), dict(correlations), dict(groups), count, 1)


def varying(path: str, *values: object, response: str = "mass", base: cf.Scene = MAPLE, **more: object) -> Study:
    return Study(base, (Vary((path,), Levels(values), **more),), (Response.of(response),), at=AT)


PAIR = {("E", "rho"): 0.5}
CONTRADICTING = {("E", "rho"): 0.9, ("rho", "time"): 0.9, ("E", "time"): -0.9}
CALLS: dict[str, Callable[[], object]] = {
    "low must be below high; got the empty range 2.0 to 2.0": lambda: Span(2.0, 2.0, 3),
    "low and high must be finite; got 2.0 and inf": lambda: Span(2.0, float("inf"), 3),
    "low must be above 0 where the spacing is logarithmic": lambda: Span(0.0, 1.0, 3, logarithmic=True),
    "values must hold at least one": lambda: Levels(()),
    "path must name a field": lambda: Vary((), Levels((1.0,))),
    "count must be a whole number in [1, 1073741824]; got 0": lambda: Sample(0, 1),
    "seed must be a whole number >= 0": lambda: Sample(4, -1),
    "cue.segments[0].material must be names": lambda: varying("cue.segments[0].material", 1.0),
    "ball.mass must be numbers in (0, inf) kg": lambda: varying("ball.mass", "ash"),
    "factor must multiply a number": lambda: varying("cue.segments[0].kappa", 1.1, factor=True),
    "a field must vary once; got ball.mass twice": lambda: Study(
        MAPLE, tuple(Vary(("ball.mass",), Levels((0.2,)), name) for name in "ab"), (Response("mass"),)
    ),
    "frequency(1) needs a cue": lambda: varying("ball.mass", 0.2, response="frequency(1)", base=LUMPED),
    "must be one of ": lambda: Response.of("squrit(0.3)"),
    "got 'squrit'": lambda: Response("squrit"),
    "must be squirt(b), b an offset b/R in (-1, 1); got 'squirt(2.0)'": lambda: Response("squirt", 2.0),
    "must be frequency(n), n a whole number >= 1; got 'frequency(1.5)'": lambda: Response("frequency", 1.5),
    "must be squirt(b), b an offset b/R in (-1, 1); got \"squirt('x')\"": lambda: Response("squirt", "x"),
    "must be mass, without brackets": lambda: Response.of("mass(3)"),
    "must be frequency(n), n a whole number": lambda: Response.of("frequency(inf)"),
    "must be ball_speed(b), b an": lambda: Response.of("ball_speed(fast)"),
    "must be squirt(b), b an offset b/R in (-1, 1); got": lambda: Response.of("squirt(1)"),
    "must be pivot_length(b), b an offset b/R in (-1, 1) without 0": lambda: Response.of("pivot_length(0)"),
    "a correlation must name parameters of the study, E": lambda: scattered({("E", "density"): 0.3}),
    "the correlation of E and rho must be in (-1, 1); got 1.0": lambda: scattered({("E", "rho"): 1.0}),
    "the correlation of E and rho must be in (-1, 1); got nan": lambda: scattered({("E", "rho"): float("nan")}),
    "a correlation must be of two numbers, listed once; got E and E": lambda: scattered({("E", "E"): 0.5}),
    "a correlation must be of two numbers, listed once; got rho": lambda: scattered(PAIR | {("rho", "E"): 0.5}),
    "a correlation must be between numbers; got 'wood'": lambda: scattered({("E", "wood"): 0.5}),
    "the correlations must have a positive definite matrix": lambda: scattered(CONTRADICTING),
    "a parameter must be in one group": lambda: scattered(groups={"a": ("E", "rho"), "b": ("rho",)}),
    "group 'a' must include all": lambda: scattered(PAIR, groups={"a": ("E", "time")}),
    "factors must have different names": lambda: scattered(groups={"time": ("E", "rho")}),
    "count must be a power of two; got 100: take 64 or 128": lambda: scattered(count=100),
    "count must be a whole number >= 2": lambda: scattered(count=1),
    "TypeError: count must be a whole number": lambda: scattered(count=64.0),
    "shaft_mass is constant": lambda: cf.study(scattered(vary=(TIME,))),
    "limit on squirt(-0.3) is on its size and must be >= 0; got -0.02": lambda: Limit(Response("squirt", -0.3), -0.02),
    "a group must be printable text": lambda: scattered(groups={"wood\x1b": ("E", "rho")}),
    "limit on mass must have low <= high, one finite; got 2.0": lambda: Limit(Response("mass"), 2.0, 1.0),
    "a study must have parameters and responses": lambda: replace(PROBLEM, vary=()),
    "E must have low and high, or values": lambda: replace(PROBLEM, vary=(E,)),
    "no design within tip_stiffness >= 1000 was found": lambda: optimum(STIFF, rounds=2),
    "no design that has squirt(0.8) was found; of the nearest: miscue at b/R 0.8": lambda: optimum(MISCUE, rounds=1),
    "an optimum takes no store or workers": lambda: cf.study(PROBLEM, workers=2),
    "rounds must be a whole number >= 1; got 0": lambda: cf.study(PROBLEM, rounds=0),
    "workers must be a whole number >= 1; got 0": lambda: cf.study(varying("ball.mass", 0.2), workers=0),
    "TypeError: workers must be a whole number": lambda: cf.study(varying("ball.mass", 0.2), workers="two"),
    "Scene.cue must be a Cue of segments": lambda: sensitivity(LUMPED),
    "sensitivity scene must have no effects": lambda: sensitivity(
        replace(MAPLE, effects=(cf.PointMass(position=0.1, mass=1e-3),))
    ),
}


@pytest.mark.parametrize("message", CALLS)
def test_study_invalid_call_raises(message: str) -> None:
    assert_raises(CALLS[message], message)


# The study, the text replaced in it, its replacement, and a part of the error message.
RANGE, BETWEEN, LEAST = 'low = "0 mm"\nhigh = "13 mm"', 'low = "1 mm"\nhigh = "9 mm"', 'low = "300 N/m"'
TIMES = '"tip.contact_time"\nvalues = ["0.8 ms", "1.2 ms"]'
FILES = [
    (STUDY, "segments[0].material", "segments[3].material", "a segment of the cue's file, 0 to 0"),
    (STUDY, '["0.8 ms", "1.2 ms"]', "[]", "vary[1].values: values must hold at least one"),
    (STUDY, 'low = "0 mm"', 'low = "15 mm"', "vary[0]: low must be below high; got"),
    (STUDY, "count = 8", "count = 0", "vary[0]: count must be a whole number in [1, 1048576]"),
    (STUDY, '"cue.segments[0].butt_bore"', '"ball.mass"', "path must name fields of one unit"),
    (STUDY, '"ash"]', '"ahs"]', "vary[2].values[1]: unknown material 'ahs'"),
    (STUDY, '"ash"]', "5]", "vary[2].values[1]: must be the name of a material"),
    (STUDY, 'values = ["hard maple", "ash"]', 'low = "ash"', "vary[2]: must have values, a list"),
    (STUDY, "count = 8", 'count = 8\nvalues = ["1 mm"]', "or median and sd; got values, and low and high"),
    (STUDY, 'values = ["0.8 ms", "1.2 ms"]', "", "or median and sd; got none of them"),
    (STUDY, "count = 8", 'count = 8\nspacing = "log"', "must be linear or logarithmic"),
    (STUDY, '"tip_stiffness"', '"end_mass"', "columns must have different names"),
    (STUDY, '"scene.toml"', '"other.toml"', "other.toml: cannot be read: No such file"),
    (STUDY, TIMES, '"tip.stiffness"\nfactor = true\nvalues = [1.1]', "factor must multiply a number"),
    (STUDY, '"ash"]', '"ash"]\nshift = true', "shift must move a number"),
    (STUDY, '"0 mm"\nhigh = "15 mm"', "1\nhigh = 2\nfactor = true\nshift = true", "factor and shift must not both be"),
    (STUDY, '"0 mm"\nhigh', "0\nshift = true\nhigh", "low: needs a unit"),
    (STUDY, "count = 8", 'count = 8\ncompensating_path = "cue.lenght"', "compensating_path: must name a field"),
    (STUDY, "count = 8", 'count = 8\ncompensating_path = "ball.mass"', "compensating_path must name numbers of the"),
    (STUDY, "count = 8", "count = 8\ncompensating_path = 5", "vary[0].compensating_path: must be text, or an array"),
    (STUDY, 'low = "0 mm"\nhigh = "15 mm"\ncount = 8', 'median = "9 mm"', "give [sample]"),
    (STRIKES, RANGE, 'median = "0 mm"\nsd = 0.1\nspacing = "logarithmic"', "median must be above 0"),
    (STRIKES, RANGE, 'median = "9 mm"\nsd = "1 mm"\nspacing = "logarithmic"', "vary[0].sd: must be a bare number"),
    (SCATTER, '[["E", "density", 0.4]]', "0.4", "tolerances.correlations: must be an array"),
    (SCATTER, "0.4]]", '"high"]]', "correlations[0]: must be [name, name, number]"),
    (SCATTER, "0.4]]", '0.4], ["E", "density", 0.3]]', "must be listed once; got E and density twice"),
    (SCATTER, 'wood = ["E", "density"]', 'wood = "E"', "tolerances.groups.wood: must be an array"),
    (SCATTER, '{ wood = ["E", "density"] }', "5", "tolerances.groups: must be a table"),
    (SCATTER, "[tolerances]", '[objective]\nminimize = "mass"\n[tolerances]', "a study has one kind"),
    (SCATTER, 'median = "12 GPa"', 'median = "3 GPa"', "designs failed: narrow the ranges"),
    (
        OPTIMUM,
        'minimize = "squirt_slope"',
        'minimise = "squirt_slope"',
        "objective.minimise: unknown key",
    ),
    (OPTIMUM, '"tip_stiffness"', '"stiffness"', "limit[0].response: must be one of"),
    (OPTIMUM, LEAST, "", "limit on tip_stiffness must have low <= high, one finite; got -inf and inf"),
    (OPTIMUM, BETWEEN, 'median = "5 mm"\nsd = "1 mm"', "bore must have low and high"),
    (OPTIMUM, '"cue.segments[0].tip_bore"', '"cue.segments[0].material"', "materials have no low and high"),
    (OPTIMUM, OPTIMUM[OPTIMUM.index("[[vary]]") :], "", "vary: must be given, an array of tables"),
]


@pytest.mark.parametrize(("good", "old", "new", "message"), FILES, ids=[message for *_, message in FILES])
def test_study_invalid_file_raises(tmp_path: Path, good: str, old: str, new: str, message: str) -> None:
    assert old in good
    assert_rejects(message, "study", write_study(tmp_path, good.replace(old, new, 1)))
    stored = {"study.sqlite"} if "designs failed" in message else set()
    assert {path.name for path in tmp_path.iterdir()} == {"scene.toml", "study.toml"} | stored


@pytest.mark.parametrize(
    ("name", "text", "what"),
    [("cue.csv", "x [mm],diameter [mm]\n0,12\n700,21\n", "a drawing of a shaft"), ("scene.toml", SCENE, "a scene")],
)
def test_study_of_drawing_or_scene_raises(tmp_path: Path, name: str, text: str, what: str) -> None:
    (tmp_path / name).write_text(text)
    expected = f'{name}: must be a study, with scene = "{name}" and [[vary]] tables, such as studies/sweeps/bore.toml'
    assert_unchanged(tmp_path, f"{expected}; got {what}", "study", tmp_path / name)


# The content of the store, the options of the next study, and a part of the error message.
FOLDERS: list[tuple[bytes, list[str], str]] = [
    (b"design,end_mass\n" * 100, [], "cannot be read or written as a database: file is not a database"),
    (b"", ["--store", "none/out.sqlite"], "unable to open database file"),
    (b"", ["--store", "a.sqlite", "--store", "none.sqlite"], "none.sqlite: cannot be read: No such file"),
    (b"", ["--store", "a.sqlite", "--store", "scene.toml"], "scene.toml: cannot be read or written as a database"),
    *(
        (b"", ["--part", text], f"must be K/N with 1 <= K <= N, such as 3/10; got '{text}'")
        for text in ("0/3", "4/3", "3")
    ),
    (b"", ["--part", "1/3", "-o", "out.csv"], "--output needs all designs, and --part computes some of them"),
    (b"", ["-o", "out.xlsx"], "must end in .html or .csv or .parquet or .json or .toml; got '.xlsx'"),
    (b"", ["-o", "out.sqlite"], "--store names the file of stored designs"),
    (b"", ["-o", "nowhere/out.csv"], "No such file or directory"),
]


@pytest.mark.parametrize(("store", "options", "message"), FOLDERS, ids=[message for *_, message in FOLDERS])
def test_study_invalid_options_change_no_file(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, store: bytes, options: list[str], message: str
) -> None:
    """Errors before the run."""
    file = write_study(tmp_path)
    if store:
        (tmp_path / "study.sqlite").write_bytes(store)
    monkeypatch.chdir(tmp_path)
    assert_unchanged(tmp_path, message, "study", file, *options)
