"""Verification of the optimum: gradients against differences, limits held and named, no search finds better."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from cuefem import PointMass, Resolution, Scene, Stroke, Tip, resolve, strike
from cuefem.design import Response, Span, Vary
from cuefem.design.optimum import Limit, Optimum, Problem, front, optimum, search
from cuefem.endmass.drives import end_mass
from tests.helpers.cues import carbon_tube, low_deflection

AT = Resolution(2, 8, 12)
SCENE = Scene(low_deflection(), tip=Tip(contact_time=1e-3))
TIP_ENDS = [f"[{i}].{end}_diameter" for i in (0, 1) for end in ("tip", "butt")]


def vary(name: str, low: float, high: float, *fields: str, taken_from: tuple[str, ...] = ()) -> Vary:
    return Vary(tuple(f"cue.segments{field}" for field in fields), Span(low, high), name, taken_from=taken_from)


BORE = vary("bore", 0.002, 0.010, *(f"[{i}].{end}_bore" for i in (1, 2) for end in ("tip", "butt")))
DEPTH = vary("bore depth", 0.03, 0.25, "[2].length", taken_from=("cue.segments[3].length",))
FERRULE = vary("ferrule", 0.005, 0.03, "[1].length", taken_from=("cue.segments[2].length",))
TIP = vary("tip diameter", 0.011, 0.0135, *TIP_ENDS, "[2].tip_diameter")
TAPER = vary("taper end", 0.0127, 0.016, "[3].butt_diameter", "[4].tip_diameter")
VARIABLES = (BORE, DEPTH, FERRULE, TIP, TAPER)
SQUIRT, WALL = Response("squirt_slope"), Response("wall")
LIMITS = (
    Limit(Response("tip_stiffness"), low=430.0),
    Limit(WALL, low=0.0015),
    Limit(Response("tip_diameter"), low=0.0118),
    Limit(Response("shaft_mass"), 0.085, 0.11),
    Limit(Response("balance_point"), high=0.48),
    Limit(Response("frequency", 1), low=95.0),
)
PROBLEM = Problem(SCENE, VARIABLES, SQUIRT, LIMITS, AT)


@cache
def best() -> Optimum:
    return optimum(PROBLEM)


# What varies beside the dimensions: materials, of a shell and a core, and a shear coefficient.
MATTER = (
    Vary(("cue.segments[*].material.E",), Span(0.8, 1.2), "E", factor=True),
    Vary(("cue.segments[2].material.G",), Span(0.7e9, 1.1e9), "G"),
    Vary(("cue.segments[3].material.rho",), Span(-50.0, 50.0), "rho", shift=True),
    Vary(("cue.segments[2].core.E",), Span(0.02e9, 0.1e9), "core"),
    Vary(("cue.segments[3].tip_bore",), Span(0.7, 1.2), "rear bore", factor=True),
)
TUBE = replace(
    PROBLEM,
    base=replace(SCENE, cue=carbon_tube()),
    vary=MATTER,
    limits=(Limit(Response("end_mass"), high=1.0), *LIMITS),
)
ASKED = [(p, response) for p in (PROBLEM, TUBE) for response in p.study.responses]


@pytest.mark.parametrize(("problem", "response"), ASKED, ids=lambda one: getattr(one, "name", ""))
def test_gradients_against_differences(problem: Problem, response: Response) -> None:
    assert problem.exact
    point, width = problem.start, np.diff(problem.bounds, axis=0)[0]
    values, exact = problem.derived(response, point)
    column = problem.study.responses.index(response)
    assert problem.values(point[None])[0, column] == pytest.approx(values.min(), rel=1e-10)

    def parts(at: np.ndarray) -> np.ndarray:
        return problem.derived(response, at)[0]

    def central(h: float) -> np.ndarray:
        steps = h * np.diag(width)
        return np.transpose([(parts(point + step) - parts(point - step)) / (2 * h) for step in steps])

    measured = (4 * central(1e-3) - central(2e-3)) / 3
    assert measured == pytest.approx(exact * width, rel=1e-6, abs=1e-6 * np.abs(exact * width).max())


@pytest.mark.heavy
def test_the_optimum_is_within_its_limits_and_names_those_that_hold_it() -> None:
    found = best()
    assert found.value < PROBLEM.values(PROBLEM.start[None])[0, 0]
    point = np.array([found.numbers[v.name] for v in VARIABLES])
    assert PROBLEM.room(PROBLEM.values(point[None])).min() == pytest.approx(0.0, abs=1e-6)
    assert end_mass(found.scene, "stick", AT) < end_mass(SCENE, "stick", AT)
    assert found.scene == PROBLEM.scene(point)
    assert set(found.values) == {"squirt_slope", *(limit.response.name for limit in LIMITS)}
    assert found.active
    # without a limit named active there is a better design; without one that is not there is none
    for limit in LIMITS:
        rest = tuple(other for other in LIMITS if other != limit)
        freed = optimum(replace(PROBLEM, limits=rest), start=point).value / found.value
        named = any(text.startswith(limit.response.name) for text in found.active)
        assert (freed < 1 - 1e-5) == named or (named and freed == pytest.approx(1, abs=1e-6)), limit


@pytest.mark.heavy
def test_no_worse_than_a_search_in_a_hundredth_of_the_evaluations() -> None:
    problem = replace(PROBLEM, at=Resolution(1, 6, 8))
    points, squirt, within = search(problem, 10_000, seed=7)
    assert points.shape == (10_000, 5)
    assert within.sum() > 100
    found = optimum(problem)
    # 0.03758 for the search's 0.03927, by 21 evaluations
    assert found.value == pytest.approx(0.03758, rel=2e-4)
    assert found.value < 0.97 * squirt[within].min()
    assert found.evaluations <= 100


@pytest.mark.heavy
def test_without_exact_gradients_evolution_comes_near() -> None:
    """The same problem, declared inexact by an effect that changes nothing: a mass of next to nothing."""
    problem = Problem(SCENE, (BORE, TIP), SQUIRT, (Limit(WALL, low=0.0015),), Resolution(1, 6, 8))
    other = replace(problem, base=replace(SCENE, effects=(PointMass(0.1, 1e-12),)))
    assert (problem.exact, other.exact) == (True, False)
    exact, found = optimum(problem), optimum(other, iterations=12, seed=3)
    assert (exact.exact, found.exact) == (True, False)
    assert exact.value * (1 - 1e-6) <= found.value < 1.01 * exact.value
    assert min(found.values["wall"] / 0.0015, 1 + 1e-6) >= 1 - 1e-6
    assert optimum(other, iterations=2, seed=3) == optimum(other, iterations=2, seed=3)


def test_the_largest() -> None:
    """Stiffness as large as a limit on squirt allows: as much as the least squirt of so stiff a shaft has."""
    least = optimum(Problem(SCENE, (BORE, TIP, TAPER), SQUIRT, (Limit(Response("tip_stiffness"), low=430.0),), AT))
    bound = Limit(SQUIRT, high=least.value)
    stiffest = optimum(Problem(SCENE, (BORE, TIP, TAPER), Response("tip_stiffness"), (bound,), AT, largest=True))
    assert stiffest.value == pytest.approx(least.values["tip_stiffness"], rel=1e-4)


@pytest.mark.parametrize("offset", [0.01, 0.3])
def test_the_coupled_strike_agrees_that_it_is_better(offset: float) -> None:
    """What the batch's small-offset squirt promises, a strike in time gives: at b/R 0.01 the same number to 5e-3 (of
    AT's 12 modes), at 0.3 the same gain to 2 %, by the plain strike and by `resolve`."""
    found = best()
    before, after = (replace(SCENE, cue=cue, stroke=Stroke(offset=offset)) for cue in (SCENE.cue, found.scene.cue))
    phi = np.arcsin(offset)
    for struck in (strike, lambda scene: resolve(scene, 1e-3)):
        slopes = np.array([struck(scene).squirt / phi for scene in (before, after)])
        promised = np.array([PROBLEM.values(PROBLEM.start[None])[0, 0], found.value])
        if offset < 0.1:
            assert slopes == pytest.approx(promised, rel=5e-3)
        assert slopes[1] / slopes[0] == pytest.approx(promised[1] / promised[0], rel=0.02)


FRONTS = [("tip_stiffness", True), ("shaft_mass", True), ("shaft_mass", False)]


@pytest.mark.parametrize(("against", "largest"), FRONTS)
def test_a_front_is_a_front(against: str, largest: bool) -> None:
    pytest.importorskip("pymoo")
    problem = Problem(SCENE, (BORE, DEPTH, TIP), SQUIRT, (Limit(WALL, low=0.001),), Resolution(1, 6, 8))
    points, values = front(problem, Response(against), largest=largest, size=16, rounds=8)
    # what is lightest is nearly what squirts least: that front is short
    assert len(points) > (3 if largest else 1)
    assert np.all(np.diff(values[:, 0]) >= 0)
    assert np.all(np.diff(values[:, 1]) * (1 if largest else -1) >= 0), "more squirt buys more of what is wanted"
    again = problem.values(points, Response(against))
    assert values == pytest.approx(again[:, [0, 2]], rel=1e-12)
    assert problem.room(again).min() >= -1e-12


@pytest.mark.heavy
@pytest.mark.parametrize("against", ["tip_stiffness", "shaft_mass"])
def test_a_front_against_optima_along_it(against: str) -> None:
    """The best squirt for as much stiffness (mass) as a point of the front has, by gradients: none worse, and the
    front's within 5 % (measured 3.5 %: evolution comes near)."""
    pytest.importorskip("pymoo")
    problem = Problem(SCENE, VARIABLES, SQUIRT, (Limit(WALL, low=0.0015),), Resolution(1, 6, 8))
    points, values = front(problem, Response(against), size=40, rounds=100)
    for point, (squirt, value) in list(zip(points, values, strict=True))[:: len(points) // 6]:
        asked = replace(problem, limits=(*problem.limits, Limit(Response(against), low=value * (1 - 1e-9))))
        best = optimum(asked, start=point).value
        assert best <= squirt * (1 + 1e-6)
        assert squirt < 1.05 * best
