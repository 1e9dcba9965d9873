"""What design studies refuse: calls, and files of studies, each with a part of the one line that says why."""

from __future__ import annotations

import sys
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from cuefem import CueBatch, LumpedCue, Resolution, Scene, StickLimit, batch_stick, load
from cuefem.design import Levels, Normal, Response, Span, Study, Vary
from cuefem.design.optimum import Limit, Problem, front, optimum
from cuefem.design.scatter import Scatter, drivers, spread
from tests.helpers.command_line import call
from tests.helpers.cues import kim, low_deflection, pool, scene
from tests.helpers.refusals import command_refuses, refuses, untouched
from tests.helpers.sweeps import OPTIMUM, SCATTER, SCENE, STRUCK, STUDY, changed, written

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
    return Scatter(replace(VARIED, **changes), dict(correlations), dict(groups))  # type: ignore[call-overload]


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
    *[
        (lambda ask=ask, count=count, seed=seed: ask(scattered(), count, seed=seed), message)
        for ask in (spread, drivers)
        for count, seed, message in (
            (100, 1, "count must be a power of two; got 100: take 64 or 128"),
            (1, 1, "count must be a whole number >= 2; got 1"),
            (64.0, 1, "TypeError: count must be a whole number"),
            (64, -1, "seed must be a whole number >= 0; got -1"),
        )
    ],
    (lambda: drivers(scattered(vary=(TIME,)), 16, seed=1), "shaft_mass does not scatter: nothing that varies changes"),
    (
        lambda: drivers(scattered(vary=(REAR_BORE,)), 16, seed=1),
        "of 48 designs have no answer: narrow the ranges; first: Segment.tip_bore",
    ),
    (
        lambda: spread(scattered(vary=(replace(REAR_BORE, range=Span(0.013, 0.0256)),)), 16, seed=1),
        "no design has an answer: Segment.tip_bore",
    ),
    (lambda: Limit(Response("mass")), "limit on mass must have low <= high, one finite; got -inf and inf"),
    (lambda: Limit(Response("mass"), 2.0, 1.0), "must have low <= high, one finite; got 2.0 and 1.0"),
    (lambda: replace(PROBLEM, vary=()), "a study varies something and asks something"),
    (lambda: replace(PROBLEM, vary=(WOOD,)), "wood must have low and high, between which an optimum is sought"),
    (lambda: replace(PROBLEM, base=Scene(kim())), "where cue.segments has 1 items"),
    (
        lambda: replace(PROBLEM, base=Scene(LumpedCue(0.5, 0.01)), vary=(TIME,), objective=Response("wall")),
        "wall needs a cue of segments; got a lumped cue",
    ),
    (lambda: optimum(STIFF, iterations=8), "no design within tip_stiffness >= 1000 was found: "),
    (lambda: front(PROBLEM, Response("squirt_slope")), "front against must be another response than the objective"),
]


@pytest.mark.parametrize(("ask", "message"), CALLS, ids=[message for _, message in CALLS])
def test_calls(ask: Callable[[], object], message: str) -> None:
    refuses(ask, message)


# Command, the study that it takes, what is replaced in it, by what, and a part of the line that says so.
SWEEP, SAMPLED, SCATTER_FILE, OPTIMIZE = (
    ("sweep", STUDY),
    ("sweep", STRUCK),
    ("scatter", SCATTER),
    ("optimize", OPTIMUM),
)
RANGE, BETWEEN, LEAST = 'low = "0 mm"\nhigh = "13 mm"', 'low = "1 mm"\nhigh = "9 mm"', 'low = "300 N/m"'
FILES = [
    (SWEEP, 'tip.contact_time"', 'tip.contact_tim"', "did you mean contact_time"),
    (SWEEP, "segments[0].material", "segments[3].material", "a segment of the cue's file, 0 to 0"),
    (SWEEP, 'path = "tip.contact_time"', 'path = "tip"', "must name one number or a material"),
    (SWEEP, '["0.8 ms", "1.2 ms"]', "[]", "vary[1].values: must be a list of one value at least"),
    (SWEEP, 'low = "0 mm"', 'low = "15 mm"', "vary[0]: low must be below high; got low = '15 mm', high ="),
    (SWEEP, 'low = "0 mm"', 'low = "1 m"', "an empty range"),
    (SWEEP, "count = 16", "count = 0", "vary[0]: count must be a whole number >= 1; got 0"),
    (SWEEP, "count = 16", "count = 1.5", "count must be a whole number >= 1; got 1.5"),
    (SWEEP, "count = 16", "", "vary[0].count: must be given"),
    (SWEEP, '"1.2 ms"]', '"1.2 mm"]', "vary[1].values[1]: must be a time with"),
    (SWEEP, 'high = "15 mm"', 'high = "15 g"', "vary[0].high: must be a length with"),
    (SWEEP, 'high = "15 mm"', "high = 15", "vary[0].high: needs a unit"),
    (SWEEP, '"cue.segments[0].butt_bore"', '"ball.mass"', "fields of one unit; got 'kg' and 'm'"),
    (SWEEP, '"ash"]', '"ahs"]', "vary[2].values[1]: no material is called 'ahs'; nearest: ash"),
    (SWEEP, '"ash"]', "5]", "must be the name of a material"),
    (SWEEP, 'values = ["hard maple", "ash"]', 'low = "ash"', "vary[2]: must have values, names"),
    (SWEEP, "count = 16", 'count = 16\nvalues = ["1 mm"]', "or middle and sd; got values, and low and high"),
    (SWEEP, 'values = ["0.8 ms", "1.2 ms"]', "", "or middle and sd; got none of them"),
    (SWEEP, "count = 16", 'count = 16\nspacing = "log"', "must be linear or logarithmic; got 'log'"),
    (SWEEP, "count = 16", 'count = 16\nspacing = "logarithmic"', "low must be above 0"),
    (SWEEP, "count = 16", "cuont = 16", "did you mean 'count'?"),
    (SWEEP, "[resolution]", "[resolutoin]", "did you mean 'resolution'?"),
    (SWEEP, '"tip_stiffness"', '"tip_stifness"', "did you mean tip_stiffness"),
    (SWEEP, 'responses = ["end_mass", "tip_stiffness", "frequency(1)"]', "", "responses: must be a list"),
    (SWEEP, '"tip_stiffness"', '"end_mass"', "different names; got 'end_mass' twice"),
    (SWEEP, 'scene = "scene.toml"', "", "scene: must be the path of a scene or a cue"),
    (SWEEP, '"scene.toml"', '"other.toml"', "other.toml: cannot be read: No such file"),
    (SWEEP, "modes = 6", "", "resolution.modes: must be given"),
    (SWEEP, '"ash"]', '"ash"]\nfactor = true', "factor must multiply a number"),
    (SWEEP, '"tip.contact_time"', '"tip.stiffness"\nfactor = true', "factor must multiply a number"),
    (SWEEP, "count = 16", 'count = 16\nfactor = "yes"', "vary[0].factor: must be true or false"),
    (SWEEP, '"ash"]', '"ash"]\nshift = true', "shift must move a number"),
    (SWEEP, '"0 mm"\nhigh = "15 mm"', "1\nhigh = 2\nfactor = true\nshift = true", "give one"),
    (SWEEP, '"0 mm"\nhigh', "0\nshift = true\nhigh", "low: needs a unit"),
    (SWEEP, "count = 16", 'count = 16\ntaken_from = "cue.lenght"', "taken_from: must name a field"),
    (SWEEP, "count = 16", 'count = 16\ntaken_from = "ball.mass"', "must name numbers of the unit"),
    (SWEEP, "count = 16", "count = 16\ntaken_from = 5", "must be a field, or a list of them"),
    (SWEEP, 'low = "0 mm"\nhigh = "15 mm"\ncount = 16', 'middle = "9 mm"', "give [sample]"),
    (SAMPLED, '"sobol"', '"sobel"', "sample: method must be one of grid, sobol, halton"),
    (SAMPLED, "seed = 5", "", "sample.seed: must be given, a whole number; got nothing"),
    (SAMPLED, "seed = 5", "seed = -5", "sample: seed must be a whole number >= 0; got -5"),
    (SAMPLED, "count = 150", "count = 0", "sample: count must be a whole number >= 1; got 0"),
    (SAMPLED, "seed = 5", "sed = 5", "did you mean 'seed'?"),
    (SAMPLED, RANGE, 'middle = "9 mm"', "vary[0].sd: must be given: a normal range has middle and sd"),
    (SAMPLED, RANGE, 'middle = "9 mm"\nsd = "-1 mm"', "vary[0].sd: must be more than 0 "),
    (SAMPLED, RANGE, 'middle = "0 mm"\nsd = 0.1\nspacing = "logarithmic"', "middle must be above 0"),
    (
        SAMPLED,
        RANGE,
        'middle = "9 mm"\nsd = "1 mm"\nspacing = "logarithmic"',
        "vary[0].sd: must be a bare number, more than 0",
    ),
    (SCATTER_FILE, '[["E", "density", 0.4]]', "0.4", "must be a list of [name, name, number]; got 0.4"),
    (SCATTER_FILE, '["E", "density", 0.4]', '["E", 0.4]', "correlations[0]: must be [name, name, number]; got"),
    (SCATTER_FILE, "0.4]]", '"high"]]', "correlations[0]: must be [name, name, number]; got"),
    (SCATTER_FILE, "0.4]]", "1.4]]", "the correlation of E and density must be in (-1, 1); got 1.4"),
    (SCATTER_FILE, '["E", "density", 0.4]', '["E", "rho", 0.4]', "called 'rho'; there are E, density, time"),
    (SCATTER_FILE, "0.4]]", '0.4], ["E", "density", 0.3]]', "must be said once; got E and density twice"),
    (SCATTER_FILE, '["E", "density"]\n\n', '"E"\n\n', "groups.wood: must be a list of names; got 'E'"),
    (SCATTER_FILE, "[groups]\nwood", "groups", "groups: must be a table of lists of names; got ["),
    (SCATTER_FILE, 'wood = ["E", "density"]', 'wood = ["E"]', "all that is correlated with it; it lacks density"),
    (SCATTER_FILE, '[sample]\nmethod = "sobol"\ncount = 64\nseed = 5', "", "[sample]"),
    (SCATTER_FILE, '"sobol"', '"halton"', 'sample: must be given, its method "sobol"; got halton'),
    (SCATTER_FILE, "count = 64", "count = 100", "count must be a power of two; got 100: take 64 or 128"),
    (SCATTER_FILE, "correlations =", "corelations =", "did you mean 'correlations'?"),
    (SCATTER_FILE, 'middle = "12 GPa"', 'middle = "3 GPa"', "designs have no answer: narrow the ranges; first: "),
    (OPTIMIZE, '[objective]\nminimize = "squirt_slope"', "", "objective: must be a table such as minimize = "),
    (OPTIMIZE, 'minimize = "squirt_slope"', 'minimise = "squirt_slope"', "objective: must be a table such as minimize"),
    (OPTIMIZE, '"squirt_slope"', '"squirt_slop"', "did you mean squirt_slope"),
    (OPTIMIZE, '"tip_stiffness"', '"stiffness"', "limit[0].response: must be one of"),
    (OPTIMIZE, LEAST, "", "limit on tip_stiffness must have low <= high, one finite; got -inf and inf"),
    (OPTIMIZE, LEAST, 'low = "300 N/m"\nhigh = "200 N/m"', "must have low <= high, one finite; got 300.0 and 200.0"),
    (OPTIMIZE, LEAST, "low = 300", "limit[0].low: needs a unit"),
    (OPTIMIZE, LEAST, 'lo = "300 N/m"', "did you mean 'low'?"),
    (OPTIMIZE, BETWEEN, 'values = ["1 mm", "2 mm"]', "bore must have low and high, between which an optimum"),
    (OPTIMIZE, BETWEEN, 'middle = "5 mm"\nsd = "1 mm"', "bore must have low and high, between which an optimum"),
    (OPTIMIZE, '"cue.segments[0].tip_bore"', '"cue.segments[0].material"', "which have no low and high"),
    (OPTIMIZE, "[resolution]", "[sample]", "sample: must be one of the keys scene, game"),
    (OPTIMIZE, OPTIMUM[OPTIMUM.index("[[vary]]") :], "", "vary: must be [[vary]] tables, one at least; got nothing"),
    (OPTIMIZE, LEAST, 'low = "3000 N/m"', "no design within tip_stiffness >= 3000 was found: "),
]


@pytest.mark.parametrize(("good", "old", "new", "message"), FILES, ids=[message for *_, message in FILES])
def test_files(tmp_path: Path, good: tuple[str, str], old: str, new: str, message: str) -> None:
    command, text = good
    assert old in text
    study = written(tmp_path, text.replace(old, new, 1))
    command_refuses(message, command, study)
    assert sorted(path.name for path in tmp_path.iterdir()) == ["scene.toml", "study.toml"]


@pytest.mark.parametrize("command", ["sweep", "scatter", "optimize"])
@pytest.mark.parametrize(
    ("name", "text", "what"),
    [
        ("cue.toml", '[[segments]]\nlength = "700 mm"\n', "a drawing of a shaft"),
        ("cue.csv", "x [mm],diameter [mm]\n0,12\n700,21\n", "a drawing of a shaft"),
        ("scene.toml", SCENE, "a scene"),
    ],
)
def test_a_drawing_or_a_scene_in_the_place_of_a_study(
    tmp_path: Path, command: str, name: str, text: str, what: str
) -> None:
    (tmp_path / name).write_text(text)
    wanted = f'{name}: must be a study, with scene = "{name}" and [[vary]] tables, as studies/sweeps/bore.toml is; got '
    untouched(tmp_path, wanted + what, command, tmp_path / name)


def test_a_front_without_its_library(monkeypatch: pytest.MonkeyPatch) -> None:
    for name in [name for name in sys.modules if name.partition(".")[0] == "pymoo"]:
        monkeypatch.delitem(sys.modules, name)
    monkeypatch.setitem(sys.modules, "pymoo", None)
    with pytest.raises(ModuleNotFoundError, match=r"^front needs pymoo: pip install '.\[optimize\]' in the clone$"):
        front(PROBLEM, Response("tip_stiffness"))


def altered(*statements: str) -> Callable[[Path], object]:
    """Change the store of a study that has run."""

    def change(folder: Path) -> None:
        call("sweep", folder / "study.toml")
        for statement in statements:
            changed(folder / "study.sqlite", statement)

    return change


def torn(folder: Path) -> None:
    call("sweep", folder / "study.toml")
    (folder / "study.sqlite").write_bytes((folder / "study.sqlite").read_bytes()[:5000])


def no_database(folder: Path) -> None:
    (folder / "study.sqlite").write_bytes(b"design,end_mass\n" * 100)


def linked(folder: Path) -> None:
    call("sweep", folder / "study.toml")
    (folder / "out.sqlite").hardlink_to(folder / "study.sqlite")


# What happened to the folder of a study, the options of the next sweep, and a part of the line that says what is wrong.
FOLDERS: list[tuple[Callable[[Path], object], list[str], str]] = [
    (altered("PRAGMA user_version = 99"), [], "must be of schema 3 or older; got 99"),
    (altered("PRAGMA application_id = 7"), [], "must be a database of `cuefem sweep`"),
    (altered("PRAGMA user_version = 2"), [], "an older cuefem, which can be read (`cuefem.frames.of_sweep`) but not"),
    (altered("UPDATE studies SET about = 'x'"), [], "is damaged: what it says of a study is not as it was written"),
    (no_database, [], "file is not a database"),
    (torn, [], "cannot be read or written as a database"),
    (linked, [], "study.sqlite: must have one name; got a file with hard links: make a copy of it instead"),
    (linked, ["--store", "out.sqlite"], "out.sqlite: must have one name; got a file with hard links"),
    (written, ["--store", "none/out.sqlite"], "unable to open database file"),
    (written, ["--export", "out.xlsx"], "must end in .csv or .parquet"),
    (written, ["--export", "out.sqlite"], "must end in .csv or .parquet"),
    (written, ["--export", "nowhere/out.csv"], "No such file or directory"),
    (written, ["--export", "out.parquet"], "pip install '.[parquet]' in the clone"),
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
    """Refused before the run, with every file of the folder untouched; two libraries are taken to be missing."""
    for library in ("pyarrow", "distributed"):
        monkeypatch.setitem(sys.modules, library, None)
    study = written(tmp_path)
    prepare(tmp_path)
    monkeypatch.chdir(tmp_path)
    untouched(tmp_path, message, "sweep", study, *options)
