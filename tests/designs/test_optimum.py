"""Optimization: the committed study, active limits, listed values, differential evolution (verification)."""

from dataclasses import replace
from functools import cache
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

import cuefem as cf
from cuefem.analysis.comparison import compare_cues
from cuefem.cue.materials import material
from cuefem.designs import Levels, Response, Span, Vary, evaluate
from cuefem.designs.optimum import NOT_DISTINCT, Limit, Optimum, OptimumResult, Problem, Round
from cuefem.designs.search import optimum
from cuefem.designs.study_file import load_study
from cuefem.designs.trade_off import TradeOffResult, _Front
from cuefem.results.uncertainty import RATIO_FLOOR
from studies.pages import STUDIES
from tests.helpers.command_line import as_json
from tests.helpers.cues import kim, low_deflection
from tests.helpers.invalid_input import assert_rejects
from tests.helpers.sweeps import OPTIMUM, write_study

STUDY = STUDIES / "design" / "optimum.toml"
OPTIMAL = {
    "bore": 7e-3,
    "bore depth": 0.07981007,
    "ferrule length": 5e-3,
    "tip diameter": 11e-3,
    "end of the taper": 14.3e-3,
}
SCENE = cf.Scene(low_deflection(), tip=cf.Tip(contact_time=1e-3))
SQUIRT, WALL, STIFFNESS = Response("squirt_slope"), Response("wall"), Response("tip_stiffness")


def vary(name: str, low: float, high: float, *fields: str, compensating_path: tuple[str, ...] = ()) -> Vary:
    return Vary(
        tuple(f"cue.segments{field}" for field in fields), Span(low, high), name, compensating_path=compensating_path
    )


BORE = vary("bore", 0.002, 0.010, *(f"[{i}].{end}_bore" for i in (1, 2) for end in ("tip", "butt")))
DEPTH = vary("bore depth", 0.03, 0.25, "[2].length", compensating_path=("cue.segments[3].length",))
TIP = vary("tip", 0.011, 0.0135, *(f"[{i}].{e}_diameter" for i in (0, 1) for e in ("tip", "butt")), "[2].tip_diameter")
TAPER = vary("taper end", 0.0127, 0.016, "[3].butt_diameter", "[4].tip_diameter")
LIMITS = (
    Limit(STIFFNESS, low=430.0),
    Limit(WALL, low=0.0015),
    Limit(Response("tip_diameter"), low=0.0118),
    Limit(Response("shaft_mass"), 0.085, 0.11),
    Limit(Response("balance_point"), high=0.48),
    Limit(Response("frequency", 1), low=95.0),
)
PROBLEM = Problem(SCENE, (BORE, DEPTH, TIP, TAPER), SQUIRT, LIMITS, cf.Resolution(1, 6, 8))


def test_change_is_the_root_mean_square_of_changes_over_their_ranges() -> None:
    """From the base: its own bore, 1 for a factor, 0 for a shift; another material counts as one range."""
    stiffer = Vary(("cue.segments[3].material.E",), Span(0.6, 1.6), "stiffer", factor=True)
    heavier = Vary(("cue.body_mass",), Span(-0.02, 0.08), "heavier", shift=True)
    wood = Vary(("cue.segments[3].material",), Levels(("hard maple", "ash")), "wood")
    problem = replace(PROBLEM, vary=(BORE, stiffer, heavier, wood), limits=(Limit(Response("squirt", 0.3), high=0.03),))
    shares = np.array([problem.shares(problem.start)[0] + 0.1, 0.4 + 0.2, 0.2 + 0.4])
    for name, square in ((problem.base_value(wood), 0.21), ("ash", 1.21)):
        assert replace(problem, choice={3: name}).change(shares) == pytest.approx(np.sqrt(square / 4), rel=1e-12)


def test_pieces_of_a_trade_off_are_relative_to_its_ends(monkeypatch: pytest.MonkeyPatch) -> None:
    """Two responses, the second of which no design changes: its other end is the best for the first one."""
    front = _Front(PROBLEM, {WALL: True, STIFFNESS: True}, 1, lambda _: None)
    designs = [SimpleNamespace(responses={"wall": wall, "tip_stiffness": 400.0}) for wall in (1.0, 2.0, 5.0)]
    assert front.pieces(designs).tolist() == [[0.25, 0.0], [0.75, 0.0]]
    monkeypatch.setattr(_Front, "best_for", lambda self, k, *_: designs[k])
    assert front.other_end(designs[2]) is designs[0]


@cache
def best() -> Optimum:
    return optimum(PROBLEM)


@pytest.mark.heavy
def test_committed_study_equals_optimum_of_exact_gradients(tmp_path: Path) -> None:
    """The optimum of exact gradients; the saved scene has the required stiffness."""
    goal = tmp_path / "best.toml"
    record = as_json("study", STUDY, "-o", goal)
    assert (record["kind"], record["objective"], record["stop_reason"]) == ("optimum", {"minimize": "squirt_slope"}, "")
    # a vertex: five limits are active and determine the five parameters
    assert record["value"] == pytest.approx(0.04242492565, rel=1e-6)
    assert record["values"] == pytest.approx(OPTIMAL, rel=1e-6)
    assert record["is_set_by_constraints"]
    assert record["active"][:2] == [
        {"name": "tip_stiffness", "sense": ">=", "bound": 386.7},
        {"name": "wall", "sense": ">=", "bound": 0.002},
    ]
    assert record["responses"] == pytest.approx(
        {"squirt_slope": record["value"], "tip_stiffness": 386.7, "wall": 0.002}
    )
    written_best = cf.load(goal)
    assert evaluate([cf.Scene(written_best.cue)], [STIFFNESS]).values[0, 0] == pytest.approx(386.7, rel=1e-6)
    assert written_best.cue.segments[0].tip_diameter == pytest.approx(record["values"]["tip diameter"], rel=1e-8)
    assert_rejects("--force", "study", STUDY, "-o", goal)


@pytest.mark.heavy
def test_optimum_of_strike_converges_to_same_design() -> None:
    """Squirt of a strike at b/R 0.3, for which differential evolution takes thousands of strikes."""
    problem, rounds = replace(load_study(STUDY), objective=Response("squirt", 0.3)), list[Round]()
    result = optimum(problem, progress=rounds.append)
    assert (result.stop_reason, rounds[-1].evaluations < 200) == ("", True)
    assert result.responses["squirt(0.3)"] == pytest.approx(0.011620, abs=2e-6)
    assert result.values == pytest.approx(OPTIMAL, rel=1e-4)


@pytest.mark.heavy
def test_active_limits_constrain_the_optimum() -> None:
    """Removing a limit improves the objective if and only if the limit is active."""
    point = np.array([best().values[v.name] for v in PROBLEM.vary])
    assert PROBLEM.margins(PROBLEM.evaluate(point[None]).values).min() == pytest.approx(0.0, abs=1e-6)
    assert (best().scene, best().stop_reason) == (PROBLEM.scene(point), "")
    assert best().active
    for limit in LIMITS:
        rest = tuple(other for other in LIMITS if other != limit)
        freed = optimum(replace(PROBLEM, limits=rest), start=point).responses["squirt_slope"]
        named = any(constraint.name == limit.response.name for constraint in best().active)
        gained = freed / best().responses["squirt_slope"]
        assert (gained < 1 - 1e-5) == named or (named and gained == pytest.approx(1, abs=1e-6)), limit


@pytest.mark.heavy
def test_optimum_of_left_hand_offset_is_that_of_right_hand() -> None:
    """Objective and maximum compare the size of squirt; the result has its sign."""
    right, left = Response("squirt", 0.3), Response("squirt", -0.3)
    bores = replace(PROBLEM, vary=(BORE,), limits=(), at=cf.Resolution(1, 6, 6))
    results = [optimum(replace(bores, objective=each)) for each in (right, left)]
    assert [result.values["bore"] for result in results] == pytest.approx([0.01, 0.01], rel=1e-9)
    assert results[1].responses[left.name] == pytest.approx(-results[0].responses[right.name], rel=1e-9)
    assert optimum(replace(bores, objective=left, maximize=True)).values["bore"] == pytest.approx(0.002, rel=1e-9)


@pytest.mark.heavy
def test_invalid_start_uses_evolution_then_slsqp() -> None:
    """A bore wider than the tip: SLSQP cannot start there; the optimum equals that of a valid start."""
    wide = replace(BORE, range=Span(0.002, 0.014))
    problem = Problem(SCENE, (wide, TIP), SQUIRT, (Limit(WALL, low=0.0015),), cf.Resolution(1, 6, 8))
    good, bad = (optimum(problem, start=np.array([x, 0.0125]), rounds=15) for x in (0.005, 0.0139))
    assert bad.evaluations > 100 > good.evaluations
    assert (bad.stop_reason, bad.values) == ("", pytest.approx(good.values, rel=1e-4))


NAMES = OPTIMUM + '[[vary]]\npath = "cue.segments[0].material"\nvalues = ["hard maple", "ash", "purpleheart"]\n'


@pytest.mark.heavy
def test_listed_values_are_searched_one_by_one(tmp_path: Path) -> None:
    problem = load_study(write_study(tmp_path, NAMES.replace("300 N/m", "700 N/m")))
    result = optimum(problem, rounds=8)
    each = {str(choice.values["cue.segments[0].material"]): choice for choice in result.choices}
    assert [*each] == ["hard maple", "ash", "purpleheart"]
    assert each["ash"].reason.startswith("no design within tip_stiffness >= 700 was found")
    for name in ("hard maple", "purpleheart"):
        base = replace(problem.base, cue=replace(problem.base.cue, segments=(of(problem.base.cue, name),)))
        alone = optimum(replace(problem, base=base, vary=problem.vary[:2]))
        assert alone.responses["squirt_slope"] == pytest.approx(each[name].objective, rel=1e-6)
    assert result.responses["squirt_slope"] == min(each[name].objective for name in ("hard maple", "purpleheart"))
    assert result.scene.cue.segments[0].material == material(result.values["cue.segments[0].material"])


@pytest.mark.heavy
def test_best_design_stands_beside_the_unmodified_one() -> None:
    """Its responses are those of the base alone; changes are as those of `compare`."""
    base, tip = cf.Scene(kim()), Vary("tip diameter", Span(0.011, 0.0125))
    limits = (Limit(STIFFNESS, low=100.0), Limit(Response("ball_speed", 0.3), low=0.0))
    result = cf.study(Problem(base, (tip,), Response("end_mass"), limits, PROBLEM.at))
    assert isinstance(result, OptimumResult)
    best, start = result.optimum, result.optimum.start
    assert start is not None
    alone = evaluate([base], result.study.responses, at=PROBLEM.at).values[0]
    assert [*start.responses.values()] == alone.tolist()
    assert start.values == {"tip diameter": base.cue.segments[0].tip_diameter}
    pair = {"start": start.scene, "best": best.scene}
    compared = compare_cues(pair, same_shaft=True, names=("tip_stiffness",)).differences["best"]
    change = result.changes["tip_stiffness"]
    assert change["difference"] == best.responses["tip_stiffness"] / start.responses["tip_stiffness"] - 1
    assert change == pytest.approx(compared["tip_stiffness"], rel=1e-2)
    assert result.changes["ball_speed(0.3)"]["error"] < RATIO_FLOOR < result.changes["end_mass"]["error"]  # of squirt


def test_designs_that_are_not_distinct_are_marked() -> None:
    """The least end mass within 0.5 % of the base's bore: a change far below its uncertainty."""
    bore = PROBLEM.base.cue.segments[1].tip_bore
    tight = replace(BORE, range=Span(bore, 1.005 * bore))
    result = cf.study(replace(PROBLEM, vary=(tight,), objective=Response("end_mass"), limits=()))
    assert isinstance(result, OptimumResult)
    assert result.values()["objective"] == {"minimize": "end_mass"}
    assert not result.changes["end_mass"]["distinct"]
    assert "% *" in str(result)
    assert NOT_DISTINCT in " ".join(str(result).split())


@pytest.mark.parametrize("offset", [0.0, 5e-4, 0.3])
def test_least_squirt_over_offsets_through_0_is_found(offset: float) -> None:
    """From the centre and from beside it: the size of squirt has a kink at 0, where SLSQP does not converge."""
    base = replace(SCENE, stroke=cf.Stroke(offset=offset))
    across = Vary("stroke.offset", Span(-0.2, 0.4))
    found = optimum(Problem(base, (across,), Response("squirt"), (), cf.Resolution(1, 6, 6)))
    assert (found.stop_reason, found.evaluations < 100) == ("", True)
    assert abs(found.values["stroke.offset"]) < 1e-4


def of(cue: cf.Cue, name: str) -> cf.Segment:
    return replace(cue.segments[0], material=material(name))


@pytest.mark.heavy
def test_trade_off_is_never_worse_than_a_grid_and_evenly_spread(tmp_path: Path) -> None:
    """Of 9 x 9 designs none is better in both responses than a design of the curve."""
    text = OPTIMUM.partition("[[limit]]")[0] + OPTIMUM[OPTIMUM.index("\n[[vary]]") :]
    text = text.replace('"squirt_slope"', '"squirt_slope"\nagainst = "tip_stiffness"\ncount = 5')
    found = cf.study(write_study(tmp_path, text))
    assert isinstance(found, TradeOffResult)
    slope, stiffness = found.responses["squirt_slope"], found.responses["tip_stiffness"]
    assert slope[0] == found.optimum.responses["squirt_slope"]
    pieces = np.hypot(*(np.diff(each) / np.ptp(each) for each in (slope, stiffness)))
    assert (len(pieces), pieces.max() < 2.5 * pieces.min()) == (4, True)
    grid = tuple(replace(vary, range=replace(vary.range, count=9)) for vary in found.study.vary)
    others = cf.study(replace(found.study, vary=grid)).responses
    for low, least in zip(stiffness, slope, strict=True):
        assert least <= others["squirt_slope"][others["tip_stiffness"] >= low * (1 - 1e-6)].min() * (1 + 1e-6)


@pytest.mark.heavy
def test_target_is_reached_by_the_smallest_change(tmp_path: Path) -> None:
    """The change is along the gradient of the response, and no design of a grid beyond the target is nearer."""
    target = OPTIMUM.replace('minimize = "squirt_slope"', 'response = "shaft_mass"\ntarget = "95 g"')
    problem = load_study(write_study(tmp_path, target))
    assert isinstance(problem, Problem)
    best = cf.study(problem).optimum
    assert best.start is not None
    assert best.responses["shaft_mass"] == pytest.approx(0.095, rel=1e-6)
    shares = np.array([[i, k] for i in np.linspace(0, 1, 11) for k in np.linspace(0, 1, 11)])
    values = problem.evaluate(problem.points(shares)).values
    start = best.start.responses["shaft_mass"]
    is_beyond = (values[:, 0] - 0.095) * (start - 0.095) <= 0
    assert best.score <= problem.change(shares[is_beyond]).min()
    nearest = problem.change(problem.shares(np.array([*best.values.values()])))
    assert best.score == pytest.approx(float(nearest), rel=1e-9)
