"""Ranges, samples, studies and their evaluation (properties)."""

import math
from dataclasses import replace
from statistics import NormalDist
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import cuefem as cf
from cuefem.designs import Levels, Normal, Response, Sample, Span, Study, Vary, evaluate
from cuefem.endmass.definitions import DEFINITIONS
from cuefem.quantity.display_units import displayed_in
from cuefem.results.computable_results import computable_results
from studies.paper.closed_forms import natural_pivot_length
from tests.helpers.cues import MAPLE, kim, low_deflection, pool

AT = cf.Resolution(1, 14, 7)
BASE = cf.Scene(low_deflection(), tip=cf.Tip(contact_time=1.2e-3), stroke=cf.Stroke(2.0, 0.3))
NAMES = (
    *("end_mass", "squirt_slope", "pivot_length", "mass", "shaft_mass", "balance_point", "tip_stiffness", "wall"),
    *("frequency(1)", "frequency(3)", "squirt", "squirt(-0.2)", "ball_speed(0.2)", "vibration_energy", "tip_diameter"),
    *("pivot_length(0.4)", "end_mass_stick", "end_mass_offset(0.4)", "end_mass_velocity", "end_mass_force"),
    *("end_mass_offset", "end_mass_squirt", "end_mass_squirt(-0.4)"),
)
ALL = tuple(map(Response.of, NAMES))


def study(*vary: Vary, responses: tuple[str, ...] = ("end_mass",), **more: object) -> Study:
    return Study(BASE, vary, tuple(map(Response.of, responses)), at=AT, **more)


@given(low=st.floats(1e-6, 1e3), ratio=st.floats(1.01, 100), count=st.integers(2, 50), log=st.booleans())
def test_span_levels_are_evenly_spaced(low: float, ratio: float, count: int, log: bool) -> None:
    span = Span(low, low * ratio, count, log)
    levels = np.array(span.levels)
    assert levels[0] == low
    assert levels[-1] == low * ratio
    steps = np.diff(np.log(levels) if log else levels)
    np.testing.assert_allclose(steps, steps[0], rtol=1e-8)
    assert [span.share(level) for level in levels] == pytest.approx(np.linspace(0, 1, count), abs=1e-9)
    middle = low * np.sqrt(ratio) if log else low * (1 + ratio) / 2
    assert Span(low, low * ratio, 1, log).levels == pytest.approx([middle], rel=1e-9)


def test_sample_is_uniform_and_depends_on_seed() -> None:
    points, others = (np.array([*Sample(300, seed).points(3)]) for seed in (7, 8))
    assert points.shape == (300, 3)
    assert np.all((points >= 0) & (points < 1))
    np.testing.assert_allclose(points.mean(axis=0), 0.5, atol=0.01)
    assert not np.array_equal(points, others)


def singly(scene: cf.Scene, at: cf.Resolution | None) -> dict[str, float]:
    """Every response by single calls, except limits of small offsets."""
    domes = [effect.radius for effect in scene.effects if isinstance(effect, cf.TipDome)]
    squirts = {b: cf.strike(at_offset(scene, b), at).squirt for b in (-0.2, 0.4)}
    flexible = cf.modes(scene.cue, 5, effects=scene.cue_effects, at=at).frequencies
    added = [effect for effect in scene.effects if isinstance(effect, cf.PointMass)]
    masses = [scene.shaft.shaft_mass, *(effect.mass for effect in added)]
    centres = [scene.shaft.balance_point, *(effect.position for effect in added)]
    pivot = natural_pivot_length(0.4, squirts[0.4], radius=scene.ball.radius, dome_radius=sum(domes))
    return {
        "end_mass": cf.end_mass(scene, at=at),
        "mass": scene.cue.mass,
        "shaft_mass": scene.cue.shaft_mass,
        "balance_point": np.average(centres, weights=masses),
        "frequency(1)": flexible[0],
        "frequency(3)": flexible[2],
        "squirt": cf.strike(scene, at).squirt,
        "squirt(-0.2)": squirts[-0.2],
        "ball_speed(0.2)": cf.strike(at_offset(scene, 0.2), at).ball_speed,
        "vibration_energy": cf.strike(scene, at).energy["cue vibration"],
        "pivot_length(0.4)": float(pivot),
        **{f"end_mass_{drive}": cf.end_mass(scene, drive, at) for drive in DEFINITIONS},
        "end_mass_offset(0.4)": cf.end_mass(at_offset(scene, 0.4), "offset", at),
        "end_mass_squirt(-0.4)": cf.end_mass(at_offset(scene, -0.4), "squirt", at),
    }


def at_offset(scene: cf.Scene, offset: float) -> cf.Scene:
    return replace(scene, stroke=replace(scene.stroke, offset=offset))


EFFECTS = {
    "none": (None, ()),
    "clay": (AT, (cf.PointMass(position=0.05, mass=0.011),)),
    "bridge": (replace(AT, steps=200), (cf.Support(0.2, 5000.0),)),
    "tip": (AT, (cf.TipDome(0.0095), cf.TipShear(0.75))),
}


@pytest.mark.parametrize(
    ("at", "effects"),
    [pytest.param(*pair, id=name, marks=pytest.mark.heavy if name == "none" else ()) for name, pair in EFFECTS.items()],
)
def test_responses_equal_single_calls(at: cf.Resolution | None, effects: tuple[Any, ...]) -> None:
    """A cue, and the same at another offset, which shares its modes."""
    scenes = [replace(BASE, cue=pool(), effects=effects)]
    scenes.append(at_offset(scenes[0], 0.25))
    result = evaluate(scenes, ALL, at=at)
    assert result.reasons == (None,) * 2
    for scene, values in zip(scenes, result.values, strict=True):
        by_name = dict(zip(NAMES, values, strict=True))
        for name, single in singly(scene, at).items():
            np.testing.assert_allclose(by_name[name], single, rtol=1e-10, err_msg=name)
        assert by_name["tip_stiffness"] > 0
        if at is not None:  # otherwise an end mass has more modes than a strike
            small = replace(at_offset(scene, 1e-4), tip=replace(scene.tip, friction=math.inf))
            slope = cf.strike(small, at).squirt / 1e-4
            assert by_name["squirt_slope"] == pytest.approx(slope, rel=1e-4)


@pytest.mark.filterwarnings("ignore::cuefem.PlausibilityWarning")
def test_evaluate_failed_design_does_not_affect_others() -> None:
    """One design cannot be solved; one is so light that no end mass has its squirt."""
    feather = replace(kim().segments[0], material=replace(MAPLE, rho=1e-310))
    light = cf.Cue((cf.Segment(0.33, 0.00317, 0.0174, cf.Material(9e9, 0.64e9, 660.0)),))
    long = replace(BASE, tip=cf.Tip(contact_time=2e-3))
    scenes = [BASE, replace(BASE, cue=replace(kim(), segments=(feather,))), replace(long, cue=light), long]
    names = ("end_mass", "squirt_slope", "mass")
    with np.errstate(all="ignore"):
        result = evaluate(scenes, names, at=AT)
    np.testing.assert_array_equal(result.values[[0, 3]], evaluate([scenes[0], scenes[3]], names, at=AT).values)
    assert [reason is None for reason in result.reasons] == [True, False, False, True]
    assert np.isnan(result.values[1, 0])
    assert np.isnan(result.values[2]).tolist() == [True, False, False]
    assert result.values[2, 1] < 0
    assert f"times the contact's angle; got {result.values[2, 1]:.4g}" in result.reasons[2]


WEIGHTED = replace(BASE, effects=(cf.PointMass(position=0.3, mass=1e-3),))
OVERFLOWS = Study(
    WEIGHTED, (Vary(("effects[0].mass",), Levels((1e308, 1e-3)), "mass"),), (Response.of("end_mass"),), at=AT
)


@pytest.mark.parametrize("workers", [None, 1])
def test_study_overflow_fails_one_design(workers: int | None) -> None:
    """Under any NumPy setting of the caller, also in a worker process."""
    with np.errstate(all="ignore"):
        result = cf.study(OVERFLOWS, workers=workers)
    assert [*result.failures] == [0]
    assert "overflow" in result.failures[0]
    assert np.isfinite(result.responses["end_mass"]).tolist() == [False, True]


def test_odd_results_change_sign_with_offset() -> None:
    """`Result.odd` is true for those computable results that are odd in the offset, by their values."""
    at_b = {name: each for name, each in computable_results().items() if each.argument == "offset"}
    names = [f"{name}({b})" for name in at_b for b in (0.3, -0.3)]
    right, left = evaluate([BASE], names, at=AT).values.reshape(-1, 2).T
    signs = dict(zip(at_b, left / right, strict=True))
    assert signs == pytest.approx({name: -1.0 if each.odd else 1.0 for name, each in at_b.items()}, rel=1e-9)


BORES = Vary(
    tuple(f"cue.segments[{i}].{end}_bore" for i in (1, 2) for end in ("tip", "butt")),
    Levels((4e-3, 6e-3, 8e-3)),
    "bore",
)


def test_best_design_of_left_hand_offset_is_that_of_right_hand() -> None:
    """The widest bore has the least squirt, in results, statistics and optima, by response or by the scene's stroke."""
    right, left = (Response("squirt", b) for b in (0.3, -0.3))
    stiffness = Response("tip_stiffness")
    result = cf.study(replace(study(BORES), responses=(right, left, stiffness)))
    assert result.best[left.name].values == result.best[right.name].values == {"bore": 8e-3}
    statistics = result.statistics
    assert statistics is not None
    assert statistics.best(0) == statistics.best(1) == 2
    assert statistics.trends == [["falls"] * 3]
    sides = [cf.study(replace(study(BORES), responses=(each, stiffness))).statistics for each in (right, left)]
    assert sides[0].front == sides[1].front == [2, 1, 0]
    mirrored = cf.study(replace(study(BORES, responses=("squirt",)), base=at_offset(BASE, -0.3)))
    assert mirrored.best["squirt"].values == {"bore": 8e-3}


def test_best_designs_are_of_the_designs_that_have_the_response() -> None:
    """Without friction a stroke miscues, at b/R 0.9 with any: it has no squirt, for a reason that is given once."""
    friction = Vary(("tip.friction",), Levels((0.0, 0.6, 0.7)), "friction")
    of_squirt = ("squirt(0.3)", "pivot_length(0.3)", "end_mass_squirt(0.3)")
    result = cf.study(study(friction, responses=(*of_squirt, "ball_speed(0.3)", "squirt(0.9)")))
    assert str(result).count("miscue at") == 2
    record = result.to_dict()
    assert (record["failed"], [*record["lacking"].values()]) == (0, [1, 1, 1, 0, 3])
    whole = cf.study(study(replace(friction, range=Levels((0.6, 0.7))), responses=of_squirt))
    for name in of_squirt:
        assert result.best[name].values == whole.best[name].values
        assert (result.best[name].failure or "").startswith("miscue at b/R 0.9")
    for name, of_whole in whole.to_dict()["summary"]["sensitivities"].items():
        assert record["summary"]["sensitivities"][name] == of_whole
    speeds = result.responses["ball_speed(0.3)"]
    assert result.best["ball_speed(0.3)"].responses["ball_speed(0.3)"] == speeds.max()


DEPTH = Vary(("cue.segments[2].length",), Span(0.05, 0.25), "bore depth", compensating_path=("cue.segments[3].length",))


def test_study_compensated_lengths_in_any_order_agree() -> None:
    """A longer ferrule shortens the bored segment, a longer bored segment the solid one."""
    ferrule = Vary(("cue.segments[1].length",), Span(-0.005, 0.01), "ferrule", False, True, ("cue.segments[2].length",))
    for order in (1, -1):
        values = (0.004, 0.1)[::order]
        changed = study(*(ferrule, DEPTH)[::order]).scene(values).cue
        lengths = [segment.length for segment in changed.segments[1:4]]
        assert lengths == pytest.approx([0.016, 0.096, 0.2], rel=1e-14)


def test_quantiles_of_a_list_are_its_values_in_equal_shares() -> None:
    assert [Levels((1.0, 2.0, 4.0)).quantile(u) for u in (0, 0.33, 0.34, 0.66, 0.67, 1)] == [1, 1, 2, 2, 4, 4]


@given(st.floats(-5, 5), st.floats(0.01, 3), st.floats(0, 1))
def test_normal_range_is_truncated_normal(middle: float, sd: float, u: float) -> None:
    distribution = Normal(middle, sd)
    low, high = distribution.ends
    assert (low, high) == (middle - 4 * sd, middle + 4 * sd)
    assert low <= distribution.quantile(u) <= high
    assert distribution.quantile(0.5) == pytest.approx(middle, abs=1e-12)
    # the truncation at 4 sd removes 6e-5
    assert NormalDist(middle, sd).cdf(distribution.quantile(u)) == pytest.approx(u, abs=6.4e-5)
    logarithmic = Normal(np.exp(middle), sd, logarithmic=True)
    assert np.log(logarithmic.quantile(u)) == pytest.approx(distribution.quantile(u), rel=1e-9, abs=1e-9)


def test_evaluate_lumped_cue_has_responses_without_segments() -> None:
    lumped = cf.Scene(cf.LumpedCue(0.5, 0.005))
    result = evaluate([lumped, lumped], ["mass", "frequency(1)"])
    assert result.values[:, 0].tolist() == [0.5, 0.5]
    assert result.reasons == ("frequency(1) needs a cue of segments; got a lumped cue",) * 2


def test_reasons_are_metric_as_data_and_displayed_in_the_readers_units() -> None:
    """A run in inches stores millimetres: of a bore as wide as the shaft."""
    wide = Vary("bore width", Span(0.005, 0.020, count=3))
    with displayed_in("us"):
        found = cf.study(Study(cf.Scene(low_deflection()), (wide,), (Response("shaft_mass"),)))
        assert " in wide" in found.gaps()[0]
    assert " mm wide" in found.gaps()[0]
    assert all(" mm wide" in reason for reason in found.failures.values())
