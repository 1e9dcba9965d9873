"""Two effects of a kind are the one that they add up to, in any order, for everything that is asked of a scene.

Properties: the listing of the effects themselves is all that may differ.
"""

from __future__ import annotations

import json
from dataclasses import replace
from itertools import islice, permutations
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import cuefem as cf
from cuefem.design import evaluate
from cuefem.designer.answers import answers, completed, coupled_points
from cuefem.effects import Effect
from cuefem.endmass.drives import DEFINITIONS
from cuefem.endmass.lumped import lump
from cuefem.report.drawings import cue_drawing, front_drawing, strike_drawing
from cuefem.report.everything import report_record
from cuefem.report.simulator_export import pooltool_record
from cuefem.report.strike_table import strike_record
from cuefem.report.unusual import unusual
from tests.helpers.command_line import call
from tests.helpers.strike_scenes import pool_cue

AT = cf.Resolution(1, 24, 12)
RESPONSES = ["end_mass", "squirt_slope", "pivot_length", "pivot_length(0.4)", "squirt(-0.4)", "ball_speed", "mass"]
CLAY = cf.PointMass(0.1, 5e-3, 1e-7)
WHOLE = (cf.TipDome(9e-3), cf.TipShear(0.75), CLAY)
PARTS: dict[str, tuple[Effect, ...]] = {
    "dome 4 + 5 mm": (cf.TipDome(4e-3), cf.TipDome(5e-3), cf.TipShear(0.75), CLAY),
    "dome 5 + 4 mm": (cf.TipDome(5e-3), cf.TipDome(4e-3), cf.TipShear(0.75), CLAY),
    "dome 2 + 3 + 4 mm": (cf.TipDome(2e-3), cf.TipDome(3e-3), cf.TipDome(4e-3), cf.TipShear(0.75), CLAY),
    "dome with nothing first": (cf.TipDome(0.0), cf.TipDome(9e-3), cf.TipShear(0.75), CLAY),
    "shear in series": (cf.TipDome(9e-3), cf.TipShear(1.0), cf.TipShear(3.0), CLAY),
    "shear in series, three": (cf.TipShear(3.0), cf.TipShear(2.0), cf.TipShear(2.0), *WHOLE[::2]),
    "mass in two": (*WHOLE[:2], cf.PointMass(0.1, 2e-3, 4e-8), cf.PointMass(0.1, 3e-3, 6e-8)),
    "another order": WHOLE[::-1],
}


def scene(effects: tuple[Effect, ...], offset: float = 0.3) -> cf.Scene:
    tip = cf.Tip(0.73, 0.7, contact_time=4e-3)  # long: few modes
    return cf.Scene(pool_cue(), cf.Ball(0.17, 0.028575), tip, cf.Stroke(2.0, offset), effects)


def outcome_numbers(found: cf.Outcome) -> Any:
    names = ("squirt", "ball_velocity", "ball_speed", "spin", "cue_speed", "impulse", "duration", "regime", "energy")
    return {name: getattr(found, name) for name in names}


def moved(struck: cf.Scene) -> Any:
    found = cf.motion(struck, [0.0, 3e-4, 2e-3], AT)
    return {name: getattr(found, name) for name in ("along", "centre", "turned", "force")}


def designed(struck: cf.Scene) -> Any:
    found = completed(answers(struck))
    curve = [found.lumped.squirt, found.lumped.pivot_length, *islice(coupled_points(found), 2)]
    return [found.end_masses, found.strike, dict(found.numbers), curve]


def swept(struck: cf.Scene) -> Any:
    return evaluate([struck], RESPONSES, at=AT).values


def lumped(struck: cf.Scene) -> Any:
    found = lump(struck)
    return [found.mass, found.end_mass, found.coupling, outcome_numbers(cf.impulse(struck))]


def rolled(struck: cf.Scene) -> Any:
    effects = (*struck.effects, cf.RollingContact(), cf.PowerLawTip(1.5))
    return outcome_numbers(cf.strike(replace(struck, effects=effects), cf.Resolution(1, 24, 3)))


ASKED = {
    "dome radius": lambda s: s.dome_radius,
    "strike": lambda s: outcome_numbers(cf.strike(s, AT)),
    "end masses": lambda s: [cf.end_mass(s, drive, AT) for drive in DEFINITIONS],
    "lumped": lumped,
    "motion": moved,
    "sweep": swept,
    "strike record": strike_record,
    "report record": report_record,
    "simulator export": lambda s: pooltool_record("a cue", s),
    "designer": designed,
    "drawings": lambda s: [cue_drawing(s, across=1.0).pieces, front_drawing(s).pieces, strike_drawing(s, 0.03)],
    "unusual": unusual,
    "rolling contact": rolled,
}


def leaves(value: Any, path: str = "") -> dict[str, Any]:
    """Every number and text of an answer, by where it stands."""
    if hasattr(value, "_asdict"):
        value = value._asdict()
    if hasattr(value, "__dataclass_fields__"):
        value = {name: getattr(value, name) for name in value.__dataclass_fields__}
    if isinstance(value, np.ndarray):
        value = value.tolist()
    if isinstance(value, dict):
        return {k: leaf for name, inner in value.items() for k, leaf in leaves(inner, f"{path}/{name}").items()}
    if isinstance(value, list | tuple):
        return {k: leaf for i, inner in enumerate(value) for k, leaf in leaves(inner, f"{path}/{i}").items()}
    return {path: value}


def assert_alike(found: Any, expected: Any) -> None:
    found, expected = leaves(found), leaves(expected)
    assert found.keys() == expected.keys()
    for path, value in expected.items():
        if isinstance(value, float):
            assert found[path] == pytest.approx(value, rel=2e-8, abs=1e-12, nan_ok=True), path
        else:
            assert found[path] == value, path


@pytest.fixture(scope="module")
def whole() -> dict[str, Any]:
    return {name: ask(scene(WHOLE)) for name, ask in ASKED.items()}


@pytest.mark.heavy
@pytest.mark.parametrize("asked", ASKED)
@pytest.mark.parametrize("split", ["dome 4 + 5 mm", "dome 5 + 4 mm"])
def test_two_domes_are_one_of_the_sum_of_their_radii(split: str, asked: str, whole: dict[str, Any]) -> None:
    assert_alike(ASKED[asked](scene(PARTS[split])), whole[asked])


@pytest.mark.parametrize("split", [name for name in PARTS if not name.startswith("dome ") or "2 + 3" in name])
def test_splitting_an_effect_changes_nothing_that_is_asked(split: str, whole: dict[str, Any]) -> None:
    for asked in ("dome radius", "strike", "sweep", "simulator export", "lumped", "drawings", "unusual"):
        assert_alike(ASKED[asked](scene(PARTS[split])), whole[asked])


def test_the_order_of_three_domes_changes_no_bit() -> None:
    domes = (cf.TipDome(1.1e-3), cf.TipDome(2.3e-3), cf.TipDome(5.7e-3))
    found = [outcome_numbers(cf.strike(scene(order), AT)) for order in permutations(domes)]
    for one in found[1:]:
        assert leaves(one) == leaves(found[0])


@pytest.mark.heavy
def test_a_raised_cue_with_two_domes() -> None:
    raised = cf.Elevation(0.1)
    one, two = (scene((*domes, raised)) for domes in ((cf.TipDome(9e-3),), (cf.TipDome(4e-3), cf.TipDome(5e-3))))
    few = cf.Resolution(1, 24, 4)
    assert_alike(outcome_numbers(cf.strike(two, few)), outcome_numbers(cf.strike(one, few)))


@pytest.mark.parametrize("command", ["strike", pytest.param("report", marks=pytest.mark.heavy)])
def test_the_commands_say_the_same_of_split_domes(command: str, tmp_path: Path) -> None:
    told = []
    for effects in (WHOLE, PARTS["dome 4 + 5 mm"]):
        cf.save(scene(effects), tmp_path / "scene.toml")
        status, out, err = call(
            command, tmp_path / "scene.toml", *(["--format", "pooltool"] if command == "strike" else []), "--json"
        )
        assert (status, err) == (0, "")
        told.append(json.loads(out))
        listing = told[-1].get("scene", {})
        listing.pop("effects", None)
        listing.pop("effects_at_tip", None)
    assert_alike(told[1], told[0])
