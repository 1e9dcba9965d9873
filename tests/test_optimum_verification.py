"""Verification of the optimum: gradients against differences, limits held and named, no search finds better."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from cues import kim, low_deflection

from cuefem import LumpedCue, PointMass, Resolution, Scene, Tip
from cuefem.endmass import end_mass
from cuefem.gradient import gradient
from cuefem.optimum import Design, Limit, Variable, front, least_squirt, search

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
    found = least_squirt(DESIGN)
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
    assert found.squirt <= squirt[within].min() * (1 + 1e-6)
    assert found.evaluations <= 100


def test_a_front_is_a_front() -> None:
    pytest.importorskip("pymoo")
    design = Design(SCENE, (BORE, DEPTH), (Limit("wall", low=0.001),), AT)
    points, values = front(design, "tip_stiffness", size=16, rounds=8)
    assert len(points) > 3
    assert np.all(np.diff(values[:, 0]) >= 0)
    assert np.all(np.diff(values[:, 1]) >= 0), "more squirt buys more stiffness"
    assert values[:, :1] == pytest.approx(design.quantity("squirt", points), rel=1e-12)


def test_bad_input() -> None:
    with pytest.raises(ValueError, match="'bore' must have low < high"):
        replace(BORE, low=0.02)
    with pytest.raises(ValueError, match=r"fields among length, .*; got 'rho'"):
        Variable("density", 1.0, 2.0, 1.0, {(0, "rho"): 1.0})
    with pytest.raises(ValueError, match=r"Limit\.quantity must be one of .*; got 'colour'"):
        Limit("colour", low=1.0)
    with pytest.raises(ValueError, match="one finite"):
        Limit("mass")
    with pytest.raises(ValueError, match="segments 0 to 0; got 1"):
        Design(Scene(kim()), (BORE,))
    with pytest.raises(ValueError, match="at least one Variable"):
        Design(SCENE, ())
    with pytest.raises(ValueError, match="without effects"):
        Design(replace(SCENE, effects=(PointMass(0.1, 1e-3),)), (BORE,))
    with pytest.raises(TypeError, match=r"Design\.scene\.cue"):
        Design(Scene(LumpedCue(0.5, 0.01)), (BORE,))
    with pytest.raises(ValueError, match="no design within tip_stiffness >= 1000"):
        least_squirt(replace(DESIGN, limits=(Limit("tip_stiffness", low=1e3),)), iterations=8)
    with pytest.raises(ValueError, match="front against"):
        front(DESIGN, "squirt")
