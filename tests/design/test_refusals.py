"""What design studies refuse: calls, and files of studies, each with a part of the one line that says why."""

from __future__ import annotations

import sys
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from cuefem import CueBatch, LumpedCue, Resolution, Scene, StickLimit, batch_stick, load, study
from cuefem.design import Levels, Normal, Response, Span, Study, Vary
from cuefem.design.optimum import Limit, Problem, optimum
from cuefem.design.scatter import Scatter
from tests.helpers.cues import kim, low_deflection, pool, scene
from tests.helpers.refusals import command_refuses, refuses, untouched
from tests.helpers.sweeps import OPTIMUM, SCATTER, SCENE, STRUCK, STUDY, written

AT = Resolution(1, 8, 3)
THREE = CueBatch.of([kim()] * 3)

MAPLE = Scene(load(Path(__file__).parents[2] / "meshes" / "pool_maple.toml"))
E = Vary(("cue.segments[*].material.E",), Normal(1.0, 0.22, logarithmic=True), "E", factor=True)
RHO = Vary(("cue.segments[*].material.rho",), Normal(1.0, 0.1, logarithmic=True), "rho", factor=True)
TIME = Vary(("tip.contact_time",), Span(0.8e-3, 1.5e-3), "time")
WOOD = Vary(("cue.segments[2].material",), Levels(("hard maple", "ash")), "wood")
REAR_BORE = Vary(("cue.segments[2].tip_bore",), Span(0.0, 0.0256), "bore")
VARIED = Study(MAPLE, (E, RHO, TIME, WOOD), (Response("shaft_mass"),), at=Resolution(1, 4, 2))

BORE = Vary(("cue.segments[1].tip_bore", "cue.segments[1].butt_bore"), Span(0.002, 0.010), "bore")
PROBLEM = Problem(scene(low_deflection(), 1e-3), (BORE,), Response("squirt_slope"), (), Resolution(1, 6, 8))
STIFF = replace(PROBLEM, limits=(Limit(Response("tip_stiffness"), low=1e3),))


def scattered(*, correlations: object = (), groups: object = (), **changes: object) -> Scatter:
    count, seed = changes.pop("count", 16), changes.pop("seed", 1)
    return Scatter(replace(VARIED, **changes), dict(correlations), dict(groups), count, seed)  # type: ignore


def correlated(first: str, second: str, by: float) -> Callable[[], Scatter]:
    return lambda: scattered(correlations={(first, second): by})


def grouped(groups: dict[str, tuple[str, ...]]) -> Callable[[], Scatter]:
    return lambda: scattered(correlations={("E", "rho"): 0.5}, groups=groups)


CONTRADICTING = {("E", "rho"): 0.9, ("rho", "time"): 0.9, ("E", "time"): -0.9}
CALLS: list[tuple[Callable[[], object], str]] = [
    (lambda: CueBatch.of([kim(), pool()]), "takes cues of one topology; got [1, 4] segments"),
    (lambda: batch_stick(THREE, [scene(kim(), 1e-3)] * 2, at=AT), "takes one contact, or 3, one a cue; got 2"),
    (
        lambda: batch_stick(THREE, StickLimit.law(0.21, 0.4, 0.75, np.full(4, 1e-3), 0.54), at=AT),
        "takes one contact, or 3, one a cue; got 4",
    ),
    (correlated("E", "density", 0.3), "nothing is called 'density'; there are E, rho, time, wood"),
    (correlated("E", "rho", 1.0), "the correlation of E and rho must be in (-1, 1); got 1.0"),
    (correlated("E", "rho", float("nan")), "must be in (-1, 1); got nan"),
    (correlated("E", "E", 0.5), "between two numbers, said once; got E and E"),
    (correlated("E", "wood", 0.5), "between numbers; got 'wood', which is a list of values"),
    (lambda: scattered(correlations={("E", "rho"): 0.5, ("rho", "E"): 0.5}), "said once; got rho and E"),
    (lambda: scattered(correlations=CONTRADICTING), "contradict one another"),
    (lambda: scattered(groups={"all": ("E", "G")}), "group 'all' is of what varies: nothing is called 'G'"),
    (lambda: scattered(groups={"a": ("E", "rho"), "b": ("rho",)}), "in one group; got 'rho' in two"),
    (grouped({"a": ("E",)}), "group 'a' must hold all that is correlated with it; it lacks rho"),
    (grouped({"a": ("E", "time")}), "it lacks rho"),
    (lambda: scattered(groups={"time": ("E", "rho")}), "causes must have different names; got time, time, wood"),
    (lambda: scattered(count=100), "count must be a power of two; got 100: take 64 or 128"),
    (lambda: scattered(count=1), "count must be a whole number >= 2; got 1"),
    (lambda: scattered(count=64.0), "TypeError: count must be a whole number"),
    (lambda: scattered(seed=-1), "seed must be a whole number >= 0; got -1"),
    (lambda: study(scattered(vary=(TIME,))), "shaft_mass does not scatter: nothing that varies changes"),
    (
        lambda: study(scattered(vary=(REAR_BORE,))),
        "of 48 designs have no answer: narrow the ranges; first: Segment.tip_bore",
    ),
    (lambda: Limit(Response("mass")), "limit on mass must have low <= high, one finite; got -inf and inf"),
    (lambda: Limit(Response("mass"), 2.0, 1.0), "must have low <= high, one finite; got 2.0 and 1.0"),
    (lambda: replace(PROBLEM, vary=()), "a study varies something and asks something"),
    (lambda: replace(PROBLEM, vary=(E,)), "E must have low and high, or values, among which an optimum is sought"),
    (lambda: replace(PROBLEM, base=Scene(kim())), "where cue.segments has 1 items"),
    (
        lambda: replace(PROBLEM, base=Scene(LumpedCue(0.5, 0.01)), vary=(TIME,), objective=Response("wall")),
        "wall needs a cue of segments; got a lumped cue",
    ),
    (lambda: optimum(STIFF, rounds=8), "no design within tip_stiffness >= 1000 was found: "),
    (lambda: study(PROBLEM, workers=2), "an optimum takes no store, workers or dask"),
    (lambda: study(VARIED, workers=2, dask="tcp://localhost:1"), "give one"),
]


@pytest.mark.parametrize(("ask", "message"), CALLS, ids=[message for _, message in CALLS])
def test_calls(ask: Callable[[], object], message: str) -> None:
    refuses(ask, message)


# The study, what is replaced in it, by what, and a part of the line that says so.
RANGE, BETWEEN, LEAST = 'low = "0 mm"\nhigh = "13 mm"', 'low = "1 mm"\nhigh = "9 mm"', 'low = "300 N/m"'
FILES = [
    (STUDY, 'tip.contact_time"', 'tip.contact_tim"', "did you mean contact_time"),
    (STUDY, "segments[0].material", "segments[3].material", "a segment of the cue's file, 0 to 0"),
    (STUDY, 'path = "tip.contact_time"', 'path = "tip"', "must name one number or a material"),
    (STUDY, '["0.8 ms", "1.2 ms"]', "[]", "vary[1].values: must be a list of one value at least"),
    (STUDY, 'low = "0 mm"', 'low = "15 mm"', "vary[0]: low must be below high; got low = '15 mm', high ="),
    (STUDY, 'low = "0 mm"', 'low = "1 m"', "an empty range"),
    (STUDY, "count = 16", "count = 0", "vary[0]: count must be a whole number >= 1; got 0"),
    (STUDY, "count = 16", "count = 1.5", "count must be a whole number >= 1; got 1.5"),
    (STUDY, "count = 16", "", "vary[0].count: must be given"),
    (STUDY, '"1.2 ms"]', '"1.2 mm"]', "vary[1].values[1]: must be a time with"),
    (STUDY, 'high = "15 mm"', 'high = "15 g"', "vary[0].high: must be a length with"),
    (STUDY, 'high = "15 mm"', "high = 15", "vary[0].high: needs a unit"),
    (STUDY, '"cue.segments[0].butt_bore"', '"ball.mass"', "fields of one unit; got 'kg' and 'm'"),
    (STUDY, '"ash"]', '"ahs"]', "vary[2].values[1]: no material is called 'ahs'; nearest: ash"),
    (STUDY, '"ash"]', "5]", "must be the name of a material"),
    (STUDY, 'values = ["hard maple", "ash"]', 'low = "ash"', "vary[2]: must have values, names"),
    (STUDY, "count = 16", 'count = 16\nvalues = ["1 mm"]', "or middle and sd; got values, and low and high"),
    (STUDY, 'values = ["0.8 ms", "1.2 ms"]', "", "or middle and sd; got none of them"),
    (STUDY, "count = 16", 'count = 16\nspacing = "log"', "must be linear or logarithmic; got 'log'"),
    (STUDY, "count = 16", 'count = 16\nspacing = "logarithmic"', "low must be above 0"),
    (STUDY, "count = 16", "cuont = 16", "did you mean 'count'?"),
    (STUDY, "[resolution]", "[resolutoin]", "did you mean 'resolution'?"),
    (STUDY, '"tip_stiffness"', '"tip_stifness"', "did you mean tip_stiffness"),
    (STUDY, 'responses = ["end_mass", "tip_stiffness", "frequency(1)"]', "", "responses: must be a list"),
    (STUDY, '"tip_stiffness"', '"end_mass"', "different names; got 'end_mass' twice"),
    (STUDY, 'scene = "scene.toml"', "", "scene: must be the path of a scene or a cue"),
    (STUDY, '"scene.toml"', '"other.toml"', "other.toml: cannot be read: No such file"),
    (STUDY, "modes = 6", "", "resolution.modes: must be given"),
    (STUDY, '"ash"]', '"ash"]\nfactor = true', "factor must multiply a number"),
    (STUDY, '"tip.contact_time"', '"tip.stiffness"\nfactor = true', "factor must multiply a number"),
    (STUDY, "count = 16", 'count = 16\nfactor = "yes"', "vary[0].factor: must be true or false"),
    (STUDY, '"ash"]', '"ash"]\nshift = true', "shift must move a number"),
    (STUDY, '"0 mm"\nhigh = "15 mm"', "1\nhigh = 2\nfactor = true\nshift = true", "give one"),
    (STUDY, '"0 mm"\nhigh', "0\nshift = true\nhigh", "low: needs a unit"),
    (STUDY, "count = 16", 'count = 16\ntaken_from = "cue.lenght"', "taken_from: must name a field"),
    (STUDY, "count = 16", 'count = 16\ntaken_from = "ball.mass"', "must name numbers of the unit"),
    (STUDY, "count = 16", "count = 16\ntaken_from = 5", "must be a field, or a list of them"),
    (STUDY, 'low = "0 mm"\nhigh = "15 mm"\ncount = 16', 'middle = "9 mm"', "give [sample]"),
    (STRUCK, '"sobol"', '"sobel"', "sample: method must be one of grid, sobol, halton"),
    (STRUCK, "seed = 5", "", "sample.seed: must be given, a whole number; got nothing"),
    (STRUCK, "seed = 5", "seed = -5", "sample: seed must be a whole number >= 0; got -5"),
    (STRUCK, "count = 150", "count = 0", "sample: count must be a whole number >= 1; got 0"),
    (STRUCK, "seed = 5", "sed = 5", "did you mean 'seed'?"),
    (STRUCK, RANGE, 'middle = "9 mm"', "vary[0].sd: must be given: a normal range has middle and sd"),
    (STRUCK, RANGE, 'middle = "9 mm"\nsd = "-1 mm"', "vary[0].sd: must be more than 0 "),
    (STRUCK, RANGE, 'middle = "0 mm"\nsd = 0.1\nspacing = "logarithmic"', "middle must be above 0"),
    (
        STRUCK,
        RANGE,
        'middle = "9 mm"\nsd = "1 mm"\nspacing = "logarithmic"',
        "vary[0].sd: must be a bare number, more than 0",
    ),
    (SCATTER, '[["E", "density", 0.4]]', "0.4", "must be a list of [name, name, number]; got 0.4"),
    (SCATTER, '["E", "density", 0.4]', '["E", 0.4]', "correlations[0]: must be [name, name, number]; got"),
    (SCATTER, "0.4]]", '"high"]]', "correlations[0]: must be [name, name, number]; got"),
    (SCATTER, "0.4]]", "1.4]]", "the correlation of E and density must be in (-1, 1); got 1.4"),
    (SCATTER, '["E", "density", 0.4]', '["E", "rho", 0.4]', "called 'rho'; there are E, density, time"),
    (SCATTER, "0.4]]", '0.4], ["E", "density", 0.3]]', "must be said once; got E and density twice"),
    (SCATTER, 'wood = ["E", "density"]', 'wood = "E"', "tolerances.groups.wood: must be a list of names; got 'E'"),
    (SCATTER, '{ wood = ["E", "density"] }', "5", "tolerances.groups: must be a table of lists of names; got 5"),
    (SCATTER, 'wood = ["E", "density"]', 'wood = ["E"]', "all that is correlated with it; it lacks density"),
    (SCATTER, "[tolerances]", "[tolerance]", "did you mean 'tolerances'?"),
    (SCATTER, "[tolerances]", '[objective]\nminimize = "mass"\n[tolerances]', "a study is of one kind"),
    (SCATTER, "count = 64", "count = 100", "count must be a power of two; got 100: take 64 or 128"),
    (SCATTER, "correlations =", "corelations =", "did you mean 'correlations'?"),
    (SCATTER, 'middle = "12 GPa"', 'middle = "3 GPa"', "designs have no answer: narrow the ranges; first: "),
    (
        OPTIMUM,
        '[objective]\nminimize = "squirt_slope"',
        "objective = 5",
        "objective: must be a table such as minimize = ",
    ),
    (OPTIMUM, 'minimize = "squirt_slope"', 'minimise = "squirt_slope"', "objective: must be a table such as minimize"),
    (OPTIMUM, '"squirt_slope"', '"squirt_slop"', "did you mean squirt_slope"),
    (OPTIMUM, '"tip_stiffness"', '"stiffness"', "limit[0].response: must be one of"),
    (OPTIMUM, LEAST, "", "limit on tip_stiffness must have low <= high, one finite; got -inf and inf"),
    (OPTIMUM, LEAST, 'low = "300 N/m"\nhigh = "200 N/m"', "must have low <= high, one finite; got 300.0 and 200.0"),
    (OPTIMUM, LEAST, "low = 300", "limit[0].low: needs a unit"),
    (OPTIMUM, LEAST, 'lo = "300 N/m"', "did you mean 'low'?"),
    (OPTIMUM, BETWEEN, 'middle = "5 mm"\nsd = "1 mm"', "bore must have low and high, or values, among which"),
    (OPTIMUM, '"cue.segments[0].tip_bore"', '"cue.segments[0].material"', "which have no low and high"),
    (OPTIMUM, "[resolution]", "[sample]", "sample: must be left out beside [objective]"),
    (OPTIMUM, OPTIMUM[OPTIMUM.index("[[vary]]") :], "", "vary: must be [[vary]] tables, one at least; got nothing"),
]


@pytest.mark.parametrize(("good", "old", "new", "message"), FILES, ids=[message for *_, message in FILES])
def test_files(tmp_path: Path, good: str, old: str, new: str, message: str) -> None:
    assert old in good
    command_refuses(message, "study", written(tmp_path, good.replace(old, new, 1)))
    left = {"study.sqlite"} if "no answer" in message else set()  # which are kept
    assert {path.name for path in tmp_path.iterdir()} == {"scene.toml", "study.toml"} | left


@pytest.mark.parametrize(
    ("name", "text", "what"),
    [
        ("cue.toml", '[[segments]]\nlength = "700 mm"\n', "a drawing of a shaft"),
        ("cue.csv", "x [mm],diameter [mm]\n0,12\n700,21\n", "a drawing of a shaft"),
        ("scene.toml", SCENE, "a scene"),
    ],
)
def test_a_drawing_or_a_scene_in_the_place_of_a_study(tmp_path: Path, name: str, text: str, what: str) -> None:
    (tmp_path / name).write_text(text)
    wanted = f'{name}: must be a study, with scene = "{name}" and [[vary]] tables, as studies/sweeps/bore.toml is; got '
    untouched(tmp_path, wanted + what, "study", tmp_path / name)


def no_database(folder: Path) -> None:
    (folder / "study.sqlite").write_bytes(b"design,end_mass\n" * 100)


# What happened to the folder of a study, the options of the next sweep, and a part of the line that says what is wrong.
FOLDERS: list[tuple[Callable[[Path], object], list[str], str]] = [
    (no_database, [], "cannot be read or written as a database: file is not a database"),
    (written, ["--store", "none/out.sqlite"], "unable to open database file"),
    (written, ["-o", "out.xlsx"], "must end in .html or .csv or .json or .toml; got '.xlsx'"),
    (written, ["-o", "out.sqlite"], "--store names the file that keeps designs"),
    (written, ["-o", "nowhere/out.csv"], "No such file or directory"),
    (written, ["--dask", "tcp://localhost:1"], "pip install '.[distributed]' in the clone"),
    (written, ["--workers", "2", "--dask", "tcp://localhost:1"], "give one"),
]


@pytest.mark.parametrize(("prepare", "options", "message"), FOLDERS, ids=[message for *_, message in FOLDERS])
def test_folders_stay_as_they_were(
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    prepare: Callable[[Path], object],
    options: list[str],
    message: str,
) -> None:
    """Refused before the run, with every file of the folder untouched; a library is taken to be missing."""
    monkeypatch.setitem(sys.modules, "distributed", None)
    file = written(tmp_path)
    prepare(tmp_path)
    monkeypatch.chdir(tmp_path)
    untouched(tmp_path, message, "study", file, *options)
