"""Tolerance analysis: exact indices and moments, correlations of the samples, factors (verification)."""

import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from scipy.special import ndtr, ndtri
from scipy.stats import qmc, spearmanr

import cuefem as cf
from cuefem.designs import Normal, Response, Span, Study, Vary, evaluate
from cuefem.designs.scatter import Scatter, ScatterResult, missing_responses
from cuefem.designs.sobol_indices import bootstrap_sobol_indices
from tests.helpers.sweeps import SCATTER, resolution, vary, write_study

MAPLE = cf.load(Path(__file__).parents[2] / "meshes" / "pool_maple.toml")
BASE = cf.Scene(MAPLE, tip=cf.Tip(contact_time=1e-3))
COARSE = cf.Resolution(1, 8, 10)
VARY = (
    Vary(("cue.segments[*].material.E",), Normal(1.0, 0.22, logarithmic=True), "E", factor=True),
    Vary(("cue.segments[*].material.rho",), Normal(1.0, 0.1, logarithmic=True), "rho", factor=True),
    Vary(("cue.segments[*].material.G",), Normal(1.0, 0.15), "G", factor=True),
    Vary(("tip.contact_time",), Span(0.8e-3, 1.5e-3), "time"),
)
STUDY = Study(BASE, VARY, (Response.of("shaft_mass"), Response.of("tip_stiffness")), at=cf.Resolution(1, 4, 2))


def designs(scatter: Scatter) -> np.ndarray:
    return np.array([*scatter.all_designs.designs()])


def test_sobol_indices_ishigami_equal_closed_form() -> None:
    """sin x + 7 sin^2 y + z^4 sin(x)/10 on (-pi, pi)^3: indices in closed form (Saltelli et al. 2008, p. 197)."""
    a, b, pi4 = 7.0, 0.1, math.pi**4
    parts = np.array([(1 + b * pi4 / 5) ** 2 / 2, a**2 / 8, 0.0])
    crossed = b**2 * pi4**2 * (1 / 18 - 1 / 50)
    variance = parts.sum() + crossed
    first, total = parts / variance, (parts + crossed * np.array([1, 0, 1])) / variance

    def ishigami(points: np.ndarray) -> np.ndarray:
        x, y, z = (2 * ndtr(points).T - 1) * math.pi
        return np.sin(x) + a * np.sin(y) ** 2 + b * z**4 * np.sin(x)

    errors = []
    for count in (256, 2048):
        A, B = np.split(ndtri(qmc.Sobol(6, rng=3).random(count) + 2.0**-31), 2, axis=1)
        mixed = [np.where(np.arange(3) == i, B, A) for i in range(3)]
        result = bootstrap_sobol_indices(np.array([ishigami(points) for points in (A, B, *mixed)])[:, None], seed=3)
        errors.append(max(abs(result[0][:, 0] - first).max(), abs(result[1][:, 0] - total).max()))
        for estimate, (low, high), exact in zip(result[:2], result[2:], (first, total), strict=True):
            assert np.all((low <= estimate) & (estimate <= high))
            assert np.all((low[:, 0] - 3e-3 <= exact) & (exact <= high[:, 0] + 3e-3))
    assert errors[-1] < min(0.02, errors[0])


DENSITIES = (
    Vary(("cue.segments[1].material.rho",), Normal(1500.0, 100.0), "ferrule"),
    Vary(("cue.segments[2].material.rho",), Normal(705.0, 20.0), "front"),
    Vary(("cue.segments[3].material.rho",), Normal(705.0, 40.0), "middle"),
    Vary(("cue.segments[4].material.rho",), Normal(705.0, 5.0), "rear"),
)


@pytest.mark.heavy
def test_sobol_indices_of_correlated_sum_equal_closed_form() -> None:
    """The mass of a shaft is a sum of densities times volumes, with exact indices of parameters and groups."""
    r = {("front", "middle"): 0.8, ("middle", "rear"): -0.5}
    study = Study(BASE, DENSITIES, (Response.of("shaft_mass"),), at=COARSE)
    scatter = Scatter(study, r, {"wood": ("front", "middle", "rear")}, 128, 1)
    assert scatter.factors == ("ferrule", "wood")
    result = cf.study(scatter)
    computed = result.sobol_indices
    per_rho = np.array([segment.mass / segment.material.rho for segment in MAPLE.segments[1:]])
    ferrule = MAPLE.segments[1]
    hole = math.pi / 4 * ferrule.length * ferrule.tip_bore**2
    per_rho[0] = (ferrule.mass - hole * ferrule.core.rho) / ferrule.material.rho
    # a normal number cut at 4 sd: its variance loses 8 pdf(4)/(1 - 2 tail)
    cut = 1 - 8 * math.exp(-8) / math.sqrt(2 * math.pi)
    terms = per_rho * [vary.range.sd for vary in DENSITIES] * math.sqrt(cut)
    parts = np.array([terms[0] ** 2, terms[1:] @ scatter.correlation_matrix[1:, 1:] @ terms[1:]])
    assert computed.first[:, 0] == pytest.approx(parts / parts.sum(), abs=0.03)
    assert computed.total[:, 0] == pytest.approx(parts / parts.sum(), abs=0.03)
    assert result.spread["shaft_mass"]["sd"] == pytest.approx(math.sqrt(parts.sum()), rel=0.03)
    ungrouped = cf.study(Scatter(study, count=128, seed=1)).sobol_indices
    assert ungrouped.factors == ("ferrule", "front", "middle", "rear")
    assert ungrouped.first[:, 0] == pytest.approx(terms**2 / (terms**2).sum(), abs=0.03)


@pytest.mark.heavy
def test_scatter_spread_equals_monte_carlo() -> None:
    """Correlated draws by NumPy of a shaft's wood and contact time."""
    vary = (replace(VARY[0], range=Normal(1.0, 0.2, logarithmic=True)), VARY[1], VARY[3])
    study = Study(BASE, vary, (Response.of("end_mass"), Response.of("squirt_slope")), at=COARSE)
    computed = cf.study(Scatter(study, {("E", "rho"): 0.6}, count=256, seed=1)).spread
    random, count = np.random.default_rng(9), 512
    logs = random.multivariate_normal([0, 0], [[0.04, 0.012], [0.012, 0.01]], count)
    values = zip(*np.exp(logs).T.tolist(), random.uniform(0.8e-3, 1.5e-3, count).tolist(), strict=True)
    plain = evaluate([study.scene(each) for each in values], study.responses, at=COARSE).values
    error = plain.std(axis=0) / math.sqrt(count)
    mean, sd = (np.array([computed[name][key] for name in ("end_mass", "squirt_slope")]) for key in ("mean", "sd"))
    assert np.all(abs(mean - plain.mean(axis=0)) < 4 * error)
    assert np.all(abs(sd / plain.std(axis=0) - 1) < 4 / math.sqrt(2 * count))


@pytest.mark.parametrize(("one", "other", "third"), [(0.5, -0.3, 0.5), (-0.55, 0.55, 0.1)])
def test_scatter_samples_have_stated_correlations(one: float, other: float, third: float) -> None:
    """Correlation of logarithms and normal numbers; rank correlation 6/pi asin(r/2) of a uniform one."""
    pairs = {("E", "rho"): one, ("rho", "G"): other, ("E", "time"): third}
    for values in np.split(designs(Scatter(STUDY, pairs, count=1024, seed=1)), 3):  # two samples, and one of both
        E, rho, G, time = np.log(values[:, 0]), np.log(values[:, 1]), values[:, 2], values[:, 3]
        assert np.corrcoef(E, rho)[0, 1] == pytest.approx(one, abs=0.03)
        assert np.corrcoef(rho, G)[0, 1] == pytest.approx(other, abs=0.03)
        assert np.corrcoef(E, G)[0, 1] == pytest.approx(0, abs=0.03)
        assert spearmanr(E, time).statistic == pytest.approx(6 / math.pi * math.asin(third / 2), abs=0.03)
        assert [E.std(), rho.std(), G.std()] == pytest.approx([0.22, 0.1, 0.15], rel=0.02)


@pytest.mark.heavy
def test_designs_without_a_response_leave_the_others_answered(tmp_path: Path) -> None:
    """The share of miscues is an answer; only responses that every design has have indices, a constant one has none."""
    text = 'scene = "scene.toml"\nresponses = ["squirt", "end_mass", "mass"]\n' + resolution(8, 4)
    text += "[tolerances]\ncount = 64\nseed = 1\n" + vary('"stroke.offset"', "median = 0.5", "sd = 0.08")
    text += vary('"cue.segments[0].material.E"', 'name = "E"', 'median = "12 GPa"', 'sd = "2 GPa"')
    found = cf.study(write_study(tmp_path, text))
    assert isinstance(found, ScatterResult)
    (miscues,) = found.missing
    lacks = np.isnan(found.responses["squirt"][:128])
    assert miscues.column == 0
    assert miscues.share == lacks.mean() > 0.1
    assert miscues.interval[0] < miscues.share < miscues.interval[1]
    assert miscues.indices.total[:, 0] == pytest.approx([1, 0], abs=0.1)
    squirt, end_mass, mass = found.sobol_indices.total.T
    assert np.isnan([squirt, mass]).all()
    assert end_mass == pytest.approx([0, 1], abs=0.1)
    assert found.spread["squirt"]["mean"] == found.responses["squirt"][:128][~lacks].mean()


@pytest.mark.parametrize("number", [9, 10])
def test_ten_designs_without_a_response_have_indices(number: int) -> None:
    """That ten designs lack it, or ten have it: the Sobol indices of fewer say nothing."""
    scatter = Scatter(STUDY, count=32, seed=1)
    for number_of, other in ((np.nan, 0.0), (0.0, np.nan)):
        values = np.full((32 * (2 + len(scatter.factors)), 1), other)
        values[:number] = number_of
        (missing,) = missing_responses(scatter, values)
        assert np.isnan(missing.indices.total).all() == (number < 10)


def test_invalid_designs_are_gaps(tmp_path: Path) -> None:
    """A modulus drawn below 0 fails its designs alone; the reason is metric as data."""
    found = cf.study(write_study(tmp_path, SCATTER.replace('median = "12 GPa"', 'median = "3 GPa"')))
    assert isinstance(found, ScatterResult)
    assert [each.share for each in found.missing] == [np.isnan(found.responses["end_mass"][:32]).mean()] * 2
    assert 0 < found.missing[0].share < 0.5
    assert {*found.spread} == {"end_mass", "tip_stiffness"}
