"""Verification of the optimum: gradients against differences, limits held and named, no search finds better."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from cuefem import Resolution, Scene, Stroke, Tip, resolve, strike
from cuefem.design.gradient import gradient
from cuefem.design.optimum import Design, Limit, Optimum, Variable, front, least_squirt, search
from cuefem.endmass.drives import end_mass
from tests.helpers.cues import low_deflection

AT = Resolution(2, 8, 12)
SCENE = Scene(low_deflection(), tip=Tip(contact_time=1e-3))
BORE = Variable("bore", 0.002, 0.010, 0.008, {(i, f"{end}_bore"): 1.0 for i in (1, 2) for end in ("tip", "butt")})
DEPTH = Variable("bore depth", 0.03, 0.25, 0.12, {(2, "length"): 1.0, (3, "length"): -1.0})
FERRULE = Variable("ferrule", 0.005, 0.03, 0.012, {(1, "length"): 1.0, (2, "length"): -1.0})
WIDTHS = {(0, "tip_diameter"): 1.0, (0, "butt_diameter"): 1.0, (1, "tip_diameter"): 1.0, (1, "butt_diameter"): 1.0}
TIP = Variable("tip diameter", 0.011, 0.0135, 0.0125, {**WIDTHS, (2, "tip_diameter"): 1.0})
TAPER = Variable("taper end", 0.0127, 0.016, 0.0132, {(3, "butt_diameter"): 1.0, (4, "tip_diameter"): 1.0})
VARIABLES = (BORE, DEPTH, FERRULE, TIP, TAPER)
LIMITS = (
    Limit("tip_stiffness", low=430.0),
    Limit("wall", low=0.0015),
    Limit("tip_diameter", low=0.0118),
    Limit("mass", 0.085, 0.11),
    Limit("balance_point", high=0.48),
    Limit("first_frequency", low=95.0),
)
DESIGN = Design(SCENE, VARIABLES, LIMITS, AT)


@cache
def best() -> Optimum:
    return least_squirt(DESIGN)


@pytest.mark.parametrize("name", ["squirt", *(limit.quantity for limit in LIMITS)])
def test_gradients_against_differences(name: str) -> None:
    point, width = DESIGN.start, np.diff(DESIGN.bounds, axis=0)[0]
    if name == "squirt":
        found = gradient(replace(SCENE, cue=DESIGN.cue(point)), "stick", AT)
        assert found.squirt_to is not None
        exact = DESIGN.along(found.squirt_to)[None]
    else:
        exact = DESIGN.slopes(name, point)

    def central(h: float) -> np.ndarray:
        steps = h * np.diag(width)
        return (DESIGN.quantity(name, point + steps) - DESIGN.quantity(name, point - steps)).T / (2 * h)

    measured = (4 * central(1e-3) - central(2e-3)) / 3
    assert measured == pytest.approx(exact * width, rel=1e-6, abs=1e-6 * np.abs(exact * width).max())


def test_the_optimum_is_within_its_limits_and_names_those_that_hold_it() -> None:
    found = best()
    assert found.squirt < DESIGN.quantity("squirt", DESIGN.start[None])[0, 0]
    point = np.array([found.numbers[v.name] for v in VARIABLES])
    assert DESIGN.room(point[None]).min() == pytest.approx(0.0, abs=1e-6)
    assert end_mass(replace(SCENE, cue=found.cue), "stick", AT) < end_mass(SCENE, "stick", AT)
    assert set(found.values) == {"squirt", *(limit.quantity for limit in LIMITS)}
    assert found.active
    # without a limit named active there is a better design; without one that is not there is none
    for limit in LIMITS:
        rest = tuple(other for other in LIMITS if other != limit)
        freed = least_squirt(replace(DESIGN, limits=rest), start=point).squirt / found.squirt
        named = any(text.startswith(limit.quantity) for text in found.active)
        assert (freed < 1 - 1e-5) == named or (named and freed == pytest.approx(1, abs=1e-6)), limit


@pytest.mark.heavy
def test_no_worse_than_a_search_in_a_hundredth_of_the_evaluations() -> None:
    design = replace(DESIGN, at=Resolution(1, 6, 8))
    points, squirt, within = search(design, 10_000, seed=7)
    assert points.shape == (10_000, 5)
    assert within.sum() > 100
    found = least_squirt(design)
    # 0.03758 for the search's 0.03927, by 21 evaluations
    assert found.squirt < 0.97 * squirt[within].min()
    assert found.evaluations <= 100


@pytest.mark.parametrize("offset", [0.01, 0.3])
def test_the_coupled_strike_agrees_that_it_is_better(offset: float) -> None:
    """What the batch's small-offset squirt promises, a strike in time gives: at b/R 0.01 the same number to 5e-3 (of
    AT's 12 modes), at 0.3 the same gain to 2 %, by the plain strike and by `resolve`."""
    found = best()
    before, after = (replace(SCENE, cue=cue, stroke=Stroke(offset=offset)) for cue in (SCENE.cue, found.cue))
    phi = np.arcsin(offset)
    for struck in (strike, lambda scene: resolve(scene, 1e-3)):
        slopes = np.array([struck(scene).squirt / phi for scene in (before, after)])
        promised = np.array([DESIGN.quantity("squirt", DESIGN.start[None])[0, 0], found.squirt])
        if offset < 0.1:
            assert slopes == pytest.approx(promised, rel=5e-3)
        assert slopes[1] / slopes[0] == pytest.approx(promised[1] / promised[0], rel=0.02)


FRONTS = [("tip_stiffness", True), ("mass", True), ("mass", False)]


@pytest.mark.parametrize(("against", "largest"), FRONTS)
def test_a_front_is_a_front(against: str, largest: bool) -> None:
    pytest.importorskip("pymoo")
    design = Design(SCENE, (BORE, DEPTH, TIP), (Limit("wall", low=0.001),), Resolution(1, 6, 8))
    points, values = front(design, against, largest=largest, size=16, rounds=8)
    # what is lightest is nearly what squirts least: that front is short
    assert len(points) > (3 if largest else 1)
    assert np.all(np.diff(values[:, 0]) >= 0)
    assert np.all(np.diff(values[:, 1]) * (1 if largest else -1) >= 0), "more squirt buys more of what is wanted"
    assert values[:, :1] == pytest.approx(design.quantity("squirt", points), rel=1e-12)
    assert values[:, 1:] == pytest.approx(design.quantity(against, points), rel=1e-12)
    assert design.room(points).min() >= -1e-12


@pytest.mark.heavy
@pytest.mark.parametrize("against", ["tip_stiffness", "mass"])
def test_a_front_against_optima_along_it(against: str) -> None:
    """The best squirt for as much stiffness (mass) as a point of the front has, by gradients: none worse, and the
    front's within 5 % (measured 3.5 %: evolution comes near)."""
    pytest.importorskip("pymoo")
    design = Design(SCENE, VARIABLES, (Limit("wall", low=0.0015),), Resolution(1, 6, 8))
    points, values = front(design, against, size=40, rounds=100)
    for point, (squirt, value) in list(zip(points, values, strict=True))[:: len(points) // 6]:
        asked = replace(design, limits=(*design.limits, Limit(against, low=value * (1 - 1e-9))))
        best = least_squirt(asked, start=point).squirt
        assert best <= squirt * (1 + 1e-6)
        assert squirt < 1.05 * best
