"""Verification of scatter: exact indices and moments, and a plain Monte Carlo, rebuilt without the module."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from scipy.special import ndtr

from cuefem import Cue, Resolution, Scene, Tip, load
from cuefem.design import Levels, Normal, Response, Span, Study, Vary, evaluate
from cuefem.design.scatter import Scatter, drivers, indices, scores, spread

MAPLE = load(Path(__file__).parents[2] / "meshes" / "pool_maple.toml")
assert isinstance(MAPLE, Cue)
BASE = Scene(MAPLE, tip=Tip(contact_time=1e-3))
COARSE = Resolution(1, 8, 10)


def test_ishigami() -> None:
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
    for count in (256, 1024, 4096):
        A, B = np.split(scores(6, count, seed=3), 2, axis=1)
        mixed = [np.where(np.arange(3) == i, B, A) for i in range(3)]
        found = indices(np.array([ishigami(points) for points in (A, B, *mixed)])[:, None], seed=3)
        errors.append(max(abs(found[0][:, 0] - first).max(), abs(found[1][:, 0] - total).max()))
        for estimate, (low, high), exact in zip(found[:2], found[2:], (first, total), strict=True):
            assert np.all((low <= estimate) & (estimate <= high))
            assert np.all((low[:, 0] - 1e-3 <= exact) & (exact <= high[:, 0] + 1e-3))
    assert errors[-1] < 0.012
    assert errors[-1] < errors[0]


DENSITIES = (
    Vary(("cue.segments[1].material.rho",), Normal(1500.0, 100.0), "ferrule"),
    Vary(("cue.segments[2].material.rho",), Normal(705.0, 20.0), "front"),
    Vary(("cue.segments[3].material.rho",), Normal(705.0, 40.0), "middle"),
    Vary(("cue.segments[4].material.rho",), Normal(705.0, 5.0), "rear"),
)


def test_a_sum_of_correlated_numbers() -> None:
    """The mass of a shaft is a sum of densities times volumes: indices of independent ones, and of groups, exact."""
    r = {("front", "middle"): 0.8, ("middle", "rear"): -0.5}
    study = Study(BASE, DENSITIES, (Response.of("shaft_mass"),), at=COARSE)
    scatter = Scatter(study, r, {"wood": ("front", "middle", "rear")})
    assert scatter.causes == ("ferrule", "wood")
    found = drivers(scatter, 512, seed=1)
    per_rho = np.array([segment.mass / segment.material.rho for segment in MAPLE.segments[1:]])
    ferrule = MAPLE.segments[1]
    assert ferrule.core is not None
    hole = math.pi / 4 * ferrule.length * ferrule.tip_bore**2
    per_rho[0] = (ferrule.mass - hole * ferrule.core.rho) / ferrule.material.rho
    # a normal number cut at 4 sd: its variance loses 8 pdf(4)/(1 - 2 tail)
    cut = 1 - 8 * math.exp(-8) / math.sqrt(2 * math.pi)
    terms = per_rho * [vary.range.sd for vary in DENSITIES] * math.sqrt(cut)
    parts = np.array([terms[0] ** 2, terms[1:] @ scatter.matrix[1:, 1:] @ terms[1:]])
    assert found.first[:, 0] == pytest.approx(parts / parts.sum(), abs=0.01)
    assert found.total[:, 0] == pytest.approx(parts / parts.sum(), abs=0.01)
    assert found.spread.sd[0] == pytest.approx(math.sqrt(parts.sum()), rel=0.01)
    drawn = [
        vary.range.middle - segment.material.rho for vary, segment in zip(DENSITIES, MAPLE.segments[1:], strict=True)
    ]
    assert found.spread.mean[0] == pytest.approx(MAPLE.shaft_mass + per_rho @ drawn, rel=1e-4)
    apart = drivers(Scatter(study), 512, seed=1)
    assert apart.causes == ("ferrule", "front", "middle", "rear")
    assert apart.first[:, 0] == pytest.approx(terms**2 / (terms**2).sum(), abs=0.01)


@pytest.mark.heavy
def test_quantiles_of_a_monotone_response() -> None:
    """Of one lognormal number the response's quantiles are the responses of its quantiles."""
    vary = Vary(("cue.segments[*].material.E",), Normal(1.0, 0.22, logarithmic=True), "E", factor=True)
    study = Study(BASE, (vary,), (Response.of("end_mass"), Response.of("tip_stiffness")), at=COARSE)
    found = spread(Scatter(study), 1024, seed=5)
    shares = np.array([0.05, 0.5, 0.95])
    there = [study.scene((vary.range.quantile(u),)) for u in shares]
    want = evaluate(there, study.responses, at=COARSE).values
    assert found.quantiles(shares) == pytest.approx(want, rel=2e-3)
    assert found.failures == ()


@pytest.mark.heavy
def test_plain_monte_carlo() -> None:
    """Independent draws of NumPy, correlated by NumPy, of a shaft's wood, bore and contact time."""
    vary = (
        Vary(("cue.segments[*].material.E",), Normal(1.0, 0.2, logarithmic=True), "E", factor=True),
        Vary(("cue.segments[*].material.rho",), Normal(1.0, 0.1, logarithmic=True), "rho", factor=True),
        Vary(("tip.contact_time",), Span(0.8e-3, 1.5e-3), "time"),
    )
    study = Study(BASE, vary, (Response.of("end_mass"), Response.of("squirt_slope")), at=COARSE)
    found = spread(Scatter(study, {("E", "rho"): 0.6}), 2048, seed=1)
    random, count = np.random.default_rng(9), 2048
    logs = random.multivariate_normal([0, 0], [[0.04, 0.012], [0.012, 0.01]], count)
    designs = zip(*np.exp(logs).T.tolist(), random.uniform(0.8e-3, 1.5e-3, count).tolist(), strict=True)
    plain = evaluate([study.scene(values) for values in designs], study.responses, at=COARSE).values
    error = plain.std(axis=0) / math.sqrt(count)
    assert np.all(abs(found.mean - plain.mean(axis=0)) < 4 * error)
    assert np.all(abs(found.sd / plain.std(axis=0) - 1) < 4 / math.sqrt(2 * count))


@pytest.mark.heavy
def test_indices_by_their_definition() -> None:
    """The variance of means: of the end mass over a grid of contact times, wood drawn anew for each."""
    wood = Vary(("cue.segments[*].material.rho",), Normal(1.0, 0.1, logarithmic=True), "rho", factor=True)
    time = Vary(("tip.contact_time",), Levels((0.8e-3, 1.0e-3, 1.3e-3, 1.5e-3)), "time")
    study = Study(BASE, (wood, time), (Response.of("end_mass"),), at=COARSE)
    found = drivers(Scatter(study), 1024, seed=2)
    shares = (np.arange(64) + 0.5) / 64
    grid = [study.scene((wood.range.quantile(u), t)) for t in time.range.ends for u in shares]
    table = evaluate(grid, study.responses, at=COARSE).values.reshape(4, 64)
    by_time, by_wood = table.mean(axis=1).var() / table.var(), table.mean(axis=0).var() / table.var()
    assert found.first[:, 0] == pytest.approx([by_wood, by_time], abs=0.02)
    assert found.total[:, 0] == pytest.approx([1 - by_time, 1 - by_wood], abs=0.02)


@pytest.mark.heavy
def test_workers_give_the_same_bits() -> None:
    from cuefem.design import processes

    study = replace(Study(BASE, DENSITIES, (Response.of("end_mass"),)), at=COARSE)
    alone, shared = (spread(Scatter(study), 512, seed=4, pool=pool) for pool in (None, processes(2)))
    assert np.array_equal(alone.responses, shared.responses)
    assert alone.values == shared.values
