"""The designer's numbers are those of the commands, and its notes those of the piano (verification)."""

from __future__ import annotations

import csv
import io
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import cuefem as cf
from cuefem.design.batch import CueBatch
from cuefem.designer.answers import (
    CURVE_OFFSETS,
    Answers,
    answers,
    completed,
    coupled_points,
    density,
    with_end_mass,
)
from cuefem.designer.design import Design
from cuefem.designer.numbers_panel import (
    Column,
    NumberRow,
    compared,
    csv_text,
    difference,
    key_markup,
    rows,
    table_markup,
)
from cuefem.designer.pictures import limits_of, offset_charts
from cuefem.designer.ranges import knobs_of, turned
from cuefem.designer.start import first_scene
from cuefem.designer.unit_system import INCHES
from cuefem.report.end_mass import end_mass_record
from cuefem.report.modes_table import modes_record
from cuefem.report.strike_table import strike_record
from cuefem.results.quantities import RESULTS

SCENES = Path(__file__).parents[2] / "studies" / "scenes"


def loaded(name: str) -> cf.Scene:
    found = cf.load(SCENES / f"{name}.toml")
    assert isinstance(found, cf.Scene)
    return found


def designs() -> dict[str, cf.Scene]:
    first = first_scene()
    knobs = knobs_of(first) | dict(bore_depth=0.12, tip_diameter=0.012, leather=3e8)
    return {
        "first": first,
        "turned": turned(first, knobs),
        "kim": loaded("kim"),
        "clay": loaded("clay_on_shaft"),
        "head on": replace(loaded("kim"), stroke=cf.Stroke(1.0, 0.0)),
    }


def weighed(scene: cf.Scene) -> Answers:
    return with_end_mass(answers(scene))


@pytest.mark.heavy
@pytest.mark.parametrize("name", designs())
def test_the_numbers_are_the_commands_own(name: str) -> None:
    scene = designs()[name]
    found = completed(weighed(scene))
    masses = end_mass_record(scene)["drives"]
    assert found.end_masses == {drive: values["end_mass"] for drive, values in masses.items()}
    struck = strike_record(scene)["models"]["coupled"]
    for key in ("squirt", "pivot_length", "ball_speed", "spin", "regime"):
        assert found.strike[key] == struck[key]
    assert found.frequencies.tolist() == modes_record(scene, count=5, near=None)["frequencies"]


def test_the_static_stiffness_is_that_of_a_clamped_cue() -> None:
    scene = replace(first_scene(), effects=())
    exact = float(CueBatch.of([scene.cue]).tip_stiffness[0])
    assert weighed(scene).numbers["tip_stiffness"] == pytest.approx(exact, rel=1e-7)
    soft = replace(scene, effects=(cf.Joint(0.6, 1e-3),))
    added = 1e-3 * 0.6**2  # a hinge's: the load's moment there, turned through its lever
    assert 1 / weighed(soft).numbers["tip_stiffness"] - 1 / exact == pytest.approx(added, rel=1e-6)


@pytest.mark.parametrize(
    ("mine", "pinned", "words"),
    [
        (5.2e-3, 5.0e-3, "+0.200 g (+4.0\u00a0%)"),
        (5.0e-3, 5.2e-3, "−0.200 g (−3.8\u00a0%)"),
        (5.0e-3, 5.0e-3, "the same"),
        (1e-3, 0.0, "+1.00 g"),
        (5.001e-3, 5.0e-3, "+0.001 g (0.0\u00a0%)"),
        (5.0e-3 + 1.3e-9, 5.0e-3, "the same to four digits"),
        (None, 5.0e-3, "–"),
        (5.0e-3, np.inf, "–"),
    ],
)
def test_differences_are_those_of_the_numbers(mine: float | None, pinned: float | None, words: str) -> None:
    row = NumberRow("end_mass_stick", "end mass", mine, RESULTS["end_mass"])
    assert difference(row, row._replace(value=pinned)) == words


def test_designs_stand_side_by_side_like_with_like() -> None:
    scene = replace(loaded("kim"), effects=())
    own = Design.of("kim", scene)
    thin = replace(own, name='=1+"thin, new"', knobs={**own.knobs, "tip_diameter": own.knobs["tip_diameter"] - 5e-4})
    columns = [Column(own, weighed(scene)), Column(replace(own, name="b"), weighed(scene)), Column(thin, None)]
    columns.append(Column(thin, weighed(thin.scene)))
    lines = {line.name: line for line in compared(columns, 1, INCHES)}
    felt = [column.answers.end_masses["stick"] for column in (columns[0], columns[3]) if column.answers]
    assert lines["end_mass_stick"].parts[:3] == ["the same", "", "–"]
    part = float(lines["end_mass_stick"].parts[3].removesuffix("\u00a0%").replace("−", "-"))
    assert part == pytest.approx(100 * (felt[1] / felt[0] - 1), abs=0.051)
    assert float(lines["end_mass_stick"].numbers[0]) == pytest.approx(felt[0] / 28.349523125e-3, rel=1e-3)
    assert lines["tip_diameter"].unit == "in"
    assert "butt_diameter" not in lines  # alike in all
    rows_read = list(csv.reader(io.StringIO(csv_text(columns, 1))))
    assert rows_read[0][:6] == ["", "unit", "this design", "this design, % from b", "b", """'=1+"thin, new\""""]
    assert {len(row) for row in rows_read} == {9}
    squirt = next(row for row in rows_read if row[0].startswith("squirt"))
    assert float(squirt[7]) == pytest.approx(np.degrees(columns[3].answers.strike["squirt"]), abs=5e-4)  # type: ignore[union-attr]
    assert float(squirt[8]) < 0


def test_before_any_curve_is_known_nothing_is_drawn() -> None:
    found = answers(loaded("kim"))
    assert not found.complete
    assert offset_charts(found, None, [], current=False) == ""
    assert offset_charts(completed(with_end_mass(found)), None, [], current=False).count("<svg") > 1


def test_limits_are_shaded_and_said() -> None:
    found = answers(replace(loaded("kim"), effects=(), tip=cf.Tip(friction=0.5)))
    spans, said = limits_of(list(coupled_points(found)))
    assert "slips off the ball (a miscue) from b/R" in said
    assert spans[-1].style == "miss"
    assert spans[-1].end == CURVE_OFFSETS[-1]
    start = min(span.start for span in spans)
    safe = answers(replace(found.scene, stroke=replace(found.scene.stroke, offset=start - 0.03)))
    assert (safe.safety, "miscue" in key_markup(safe, None)) == ("safe", False)
    missed = answers(replace(found.scene, stroke=replace(found.scene.stroke, offset=0.75)))
    assert (missed.safety, "miscue" in key_markup(missed, None)) == ("miscue", True)


def test_the_density_of_a_scene_is_that_of_its_bare_cue() -> None:
    scene = first_scene()
    assert density(scene).end_mass == density(replace(scene, effects=())).end_mass


def test_every_number_of_a_design_is_written() -> None:
    found = completed(weighed(designs()["head on"]))
    written = {row.name: row.value for row in rows(found)}
    assert written["pivot"] is None
    assert written["squirt"] == 0
    assert written["mass"] == found.scene.cue.mass
    assert written["balance"] == found.scene.cue.balance_point
    mine = Design.of("mine", designs()["head on"])
    text = table_markup([Column(mine, found)], 0) + key_markup(found, found)
    assert "nan" not in text
    assert text.count("data-number") == len(written) == 20
    assert "the same" in text
