"""What scatter refuses, in one line that says what is wrong (bad input)."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from cuefem import Resolution, Scene, load
from cuefem.design import Levels, Normal, Response, Span, Study, Vary
from cuefem.design.scatter import Scatter, drivers, spread
from tests.helpers.command_line import call
from tests.helpers.sweeps import SCATTER, written

BASE = Scene(load(Path(__file__).parents[2] / "meshes" / "pool_maple.toml"))
VARY = (
    Vary(("cue.segments[*].material.E",), Normal(1.0, 0.22, logarithmic=True), "E", factor=True),
    Vary(("cue.segments[*].material.rho",), Normal(1.0, 0.1, logarithmic=True), "rho", factor=True),
    Vary(("tip.contact_time",), Span(0.8e-3, 1.5e-3), "time"),
    Vary(("cue.segments[2].material",), Levels(("hard maple", "ash")), "wood"),
)
STUDY = Study(BASE, VARY, (Response.of("shaft_mass"),), at=Resolution(1, 4, 2))


@pytest.mark.parametrize(
    ("correlations", "groups", "words"),
    [
        (
            {("E", "density"): 0.3},
            {},
            "a correlation is .*: nothing is called 'density'; there are E, rho, time, wood",
        ),
        ({}, {"all": ("E", "G")}, "group 'all' is of what varies: nothing is called 'G'"),
        ({("E", "rho"): 1.0}, {}, r"the correlation of E and rho must be in \(-1, 1\); got 1.0"),
        ({("E", "rho"): float("nan")}, {}, r"must be in \(-1, 1\); got nan"),
        ({("E", "E"): 0.5}, {}, "between two numbers, said once; got E and E"),
        ({("E", "rho"): 0.5, ("rho", "E"): 0.5}, {}, "said once; got rho and E"),
        ({("E", "wood"): 0.5}, {}, "between numbers; got 'wood', which is a list of values"),
        ({("E", "rho"): 0.9, ("rho", "time"): 0.9, ("E", "time"): -0.9}, {}, "contradict one another"),
        ({}, {"a": ("E", "rho"), "b": ("rho",)}, "in one group; got 'rho' in two"),
        ({("E", "rho"): 0.5}, {"a": ("E",)}, "group 'a' must hold all that is correlated with it; it lacks rho"),
        ({("E", "rho"): 0.5}, {"a": ("E", "time")}, "group 'a' must hold all .*; it lacks rho"),
        ({}, {"time": ("E", "rho")}, "causes must have different names; got time, time, wood"),
    ],
)
def test_what_does_not_go_together(correlations: Any, groups: Any, words: str) -> None:
    with pytest.raises(ValueError, match=words):
        Scatter(STUDY, correlations, groups)


@pytest.mark.parametrize("ask", [spread, drivers])
def test_samples(ask: Any) -> None:
    with pytest.raises(ValueError, match="count must be a power of two; got 100: take 64 or 128"):
        ask(Scatter(STUDY), 100, seed=1)
    with pytest.raises(ValueError, match="count must be a whole number >= 2; got 1"):
        ask(Scatter(STUDY), 1, seed=1)
    with pytest.raises(TypeError, match="count must be a whole number"):
        ask(Scatter(STUDY), 64.0, seed=1)
    with pytest.raises(ValueError, match="seed must be a whole number >= 0; got -1"):
        ask(Scatter(STUDY), 64, seed=-1)


def test_a_response_that_does_not_scatter() -> None:
    with pytest.raises(ValueError, match="shaft_mass does not scatter: nothing that varies changes it"):
        drivers(Scatter(replace(STUDY, vary=VARY[2:3])), 16, seed=1)


def test_designs_without_an_answer() -> None:
    bore = Vary(("cue.segments[2].tip_bore",), Span(0.0, 0.0256), "bore")
    with pytest.raises(ValueError, match=r"of 48 designs have no answer: narrow the ranges; first: Segment\.tip_bore"):
        drivers(Scatter(replace(STUDY, vary=(bore,))), 16, seed=1)
    wide = replace(bore, range=Span(0.013, 0.0256))
    with pytest.raises(ValueError, match=r"no design has an answer: Segment\.tip_bore"):
        spread(Scatter(replace(STUDY, vary=(wide,))), 16, seed=1)


CHANGES = {
    "a number alone": (
        '[["E", "density", 0.4]]',
        "0.4",
        "must be a list of [name, name, number]; got 0.4",
    ),
    "half a pair": ('["E", "density", 0.4]', '["E", 0.4]', "correlations[0]: must be [name, name, number]; got"),
    "a text": ("0.4]]", '"high"]]', "correlations[0]: must be [name, name, number]; got"),
    "too much": ("0.4]]", "1.4]]", "the correlation of E and density must be in (-1, 1); got 1.4"),
    "no such name": (
        '["E", "density", 0.4]',
        '["E", "rho", 0.4]',
        "called 'rho'; there are E, density, time",
    ),
    "twice": ("0.4]]", '0.4], ["E", "density", 0.3]]', "correlations[1]: must be said once; got E and density twice"),
    "a group of nothing": ('["E", "density"]\n\n', '"E"\n\n', "groups.wood: must be a list of names; got 'E'"),
    "no table of groups": (
        "[groups]\nwood",
        "groups",
        "groups: must be a table of lists of names; got [",
    ),
    "half a group": (
        'wood = ["E", "density"]',
        'wood = ["E"]',
        "all that is correlated with it; it lacks density",
    ),
    "no sample": ('[sample]\nmethod = "sobol"\ncount = 64\nseed = 5', "", "[sample]"),
    "another method": ('"sobol"', '"halton"', 'sample: must be given, its method "sobol"; got halton'),
    "no power of two": ("count = 64", "count = 100", "count must be a power of two; got 100: take 64 or 128"),
    "a misspelt key": ("correlations =", "corelations =", "did you mean 'correlations'?"),
    "too wide": ('middle = "12 GPa"', 'middle = "3 GPa"', "designs have no answer: narrow the ranges; first: "),
}


@pytest.mark.parametrize(("old", "new", "words"), CHANGES.values(), ids=CHANGES.keys())
def test_a_file_that_is_none(tmp_path: Path, old: str, new: str, words: str) -> None:
    assert old in SCATTER
    code, out, err = call("scatter", written(tmp_path, SCATTER.replace(old, new, 1)))
    assert (code, out) == (2, "")
    assert len(err.splitlines()) == 1
    assert err.startswith(f"cuefem: {tmp_path / 'study.toml'}: ")
    assert words in err


def test_a_sweep_does_not_pass_correlations_over(tmp_path: Path) -> None:
    code, _, err = call("sweep", written(tmp_path, SCATTER))
    assert code == 2
    assert "unknown key" in err or "correlations" in err
