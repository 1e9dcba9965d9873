"""Samples have the correlations asked for, seeds say which sample it is (properties)."""

from __future__ import annotations

import json
import math
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.stats import spearmanr

from cuefem import Resolution, Scene, load
from cuefem.design import Normal, Response, Span, Study, Vary
from cuefem.design.scatter import Scatter, drivers, scores, spread
from cuefem.io.study_files import load_scatter
from tests.helpers.command_line import call
from tests.helpers.sweeps import SCATTER, written

BASE = Scene(load(Path(__file__).parents[2] / "meshes" / "pool_maple.toml"))
VARY = (
    Vary(("cue.segments[*].material.E",), Normal(1.0, 0.22, logarithmic=True), "E", factor=True),
    Vary(("cue.segments[*].material.rho",), Normal(1.0, 0.1, logarithmic=True), "rho", factor=True),
    Vary(("cue.segments[*].material.G",), Normal(1.0, 0.15), "G", factor=True),
    Vary(("tip.contact_time",), Span(0.8e-3, 1.5e-3), "time"),
)
STUDY = Study(BASE, VARY, (Response.of("shaft_mass"), Response.of("tip_stiffness")), at=Resolution(1, 4, 2))

R = st.floats(-0.55, 0.55)


@given(R, R, R)
@settings(max_examples=20)
def test_correlations_are_in_the_sample(one: float, other: float, third: float) -> None:
    """Of logarithms and of normal numbers the correlation, of a uniform one the rank correlation 6/pi asin(r/2)."""
    pairs = {("E", "rho"): one, ("rho", "G"): other, ("E", "time"): third}
    values = np.array(Scatter(STUDY, pairs).designs(scores(4, 2048, seed=1)))
    E, rho, G, time = np.log(values[:, 0]), np.log(values[:, 1]), values[:, 2], values[:, 3]
    assert np.corrcoef(E, rho)[0, 1] == pytest.approx(one, abs=0.02)
    assert np.corrcoef(rho, G)[0, 1] == pytest.approx(other, abs=0.02)
    assert np.corrcoef(E, G)[0, 1] == pytest.approx(0, abs=0.02)
    assert spearmanr(E, time).statistic == pytest.approx(6 / math.pi * math.asin(third / 2), abs=0.02)
    assert [E.std(), rho.std(), G.std(), time.std()] == pytest.approx([0.22, 0.1, 0.15, 0.7e-3 / 12**0.5], rel=0.01)


def test_correlated_numbers_are_one_cause() -> None:
    assert Scatter(STUDY).causes == ("E", "rho", "G", "time")
    assert Scatter(STUDY, {("G", "E"): 0.5}).causes == ("E + G", "rho", "time")
    assert Scatter(STUDY, {("G", "E"): 0.5, ("time", "G"): 0.1}).causes == ("E + G + time", "rho")
    assert Scatter(STUDY, {("G", "E"): 0.5}, {"wood": ("E", "rho", "G")}).causes == ("wood", "time")
    assert Scatter(STUDY, {}, {"else": ("time",)}).causes == ("E", "rho", "G", "else")


def test_a_mixed_sample_has_the_correlations_too() -> None:
    """A correlated group drawn anew goes together: otherwise its index would be of another wood."""
    scatter = Scatter(STUDY, {("E", "rho"): 0.9})
    both = np.stack(np.split(scores(8, 4096, seed=2), 2, axis=1))
    for mixed in scatter.mixed(both):
        E, rho, *_ = np.log(np.array(scatter.designs(mixed))[:, :2]).T
        assert np.corrcoef(E, rho)[0, 1] == pytest.approx(0.9, abs=0.01)


@pytest.mark.heavy
def test_seeds() -> None:
    """The same seed gives the same bits, intervals and all; another seed other designs and nearly the same answer."""
    scatter = Scatter(STUDY, {("E", "rho"): 0.4})
    first, again, other = (drivers(scatter, 256, seed=seed) for seed in (1, 1, 2))
    for name in ("first", "total", "first_interval", "total_interval"):
        assert np.array_equal(getattr(first, name), getattr(again, name))
    assert first.spread.values == again.spread.values
    assert first.spread.values != other.spread.values
    assert first.first == pytest.approx(other.first, abs=0.1)


@pytest.mark.heavy
def test_indices_are_shares() -> None:
    """Of the mass wood has all; contact time has no part in mass or stiffness; no total is below its first order."""
    found = drivers(Scatter(STUDY), 512, seed=1)
    assert found.causes[3] == "time"
    assert np.abs(found.total[3]).max() < 1e-12
    assert np.abs(found.first[3]).max() < 1e-12
    assert found.first[1, 0] == pytest.approx(1, abs=0.01)
    assert np.all(found.total > found.first - 0.03)
    assert found.first.sum(axis=0) == pytest.approx([1, 1], abs=0.05)
    assert len(found.spread.responses) == 1024


def test_a_single_cause_has_it_all() -> None:
    found = drivers(Scatter(STUDY, {}, {"all": ("E", "rho", "G", "time")}), 64, seed=1)
    assert found.first.shape == found.total.shape == (1, 2)
    assert found.first_interval.shape == (2, 1, 2)
    assert found.first == pytest.approx(np.ones((1, 2)), abs=0.15)


def test_designs_that_fail_are_told_apart() -> None:
    """A bore that may be wider than the shaft: the rest has a distribution, indices it has not (see the refusals)."""
    bore = Vary(("cue.segments[2].tip_bore",), Span(0.0, 0.0256), "bore")
    found = spread(Scatter(Study(BASE, (bore,), STUDY.responses, at=STUDY.at)), 64, seed=1)
    assert len(found.failures) == pytest.approx(32, abs=1)
    assert len(found.values) == len(found.responses) == 64 - len(found.failures)
    assert all("tip_bore must be in" in reason for reason in found.failures)
    assert max(value for (value,) in found.values) < 0.0128


def test_the_command_says_what_the_function_gives(tmp_path: Path) -> None:
    study = written(tmp_path, SCATTER)
    scatter, sample = load_scatter(study)
    assert (scatter.correlations, scatter.groups) == ({("E", "density"): 0.4}, {"wood": ("E", "density")})
    found = drivers(scatter, sample.count, seed=sample.seed)
    code, out, err = call("scatter", study, "--json")
    assert (code, err) == (0, "")
    told = json.loads(out)
    assert (told["count"], told["seed"], list(told["responses"])) == (64, 5, ["end_mass", "tip_stiffness"])
    stiffness = told["responses"]["tip_stiffness"]
    assert stiffness["unit"] == "N/m"
    assert stiffness["mean"] == found.spread.mean[1]
    assert stiffness["quantiles"]["0.5"] == found.spread.quantiles(0.5)[1]
    assert stiffness["causes"]["wood"]["first"] == found.first[0, 1]
    assert stiffness["causes"]["time"]["total_interval"] == [0, 0]
    code, out, err = call("scatter", study)
    assert (code, err) == (0, "")
    assert f"end mass, g {1e3 * found.spread.mean[0]:.3f}" in " ".join(out.split())
    assert "128 designs" in out
    assert "wood: E, density" in out
    assert "end mass: nine in ten lie from " in out
    assert "the strongest cause is wood (100 %)" in out  # time changes no stiffness
    code, out, err = call("scatter", study, "-o", tmp_path / "page.html")
    assert (code, err) == (0, "")
    assert out.splitlines()[-1] == f"wrote {tmp_path / 'page.html'}"
    page = (tmp_path / "page.html").read_text(encoding="utf-8")
    assert page.count('<path class="s') == 128
    assert "Best designs" not in page
