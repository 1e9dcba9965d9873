"""A number added to the table of results alone is found everywhere: tables, pages, studies, frames (properties)."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

import cuefem as cf
from cuefem.designer.answers import answers, completed, with_end_mass
from cuefem.designer.design import Design
from cuefem.designer.numbers_panel import Column, csv_text, rows, table_markup
from cuefem.designer.unit_system import INCHES
from cuefem.frames import of_sweep
from cuefem.results.quantities import RESULTS, Result, of_drawing, of_strike
from tests.helpers.command_line import call
from tests.helpers.strike_scenes import kim_scene

WORDS = "sweet spot, from the tip"
STUDY = """
scene = "scene.toml"
responses = ["sweet_spot", "push(0.2)", "squirt(0.2)"]
[[vary]]
path = "cue.body_mass"
values = ["0.3 kg", "0.42 kg", "0.5 kg"]
"""


@pytest.fixture(autouse=True)
def made_up(monkeypatch: pytest.MonkeyPatch) -> None:
    """One of the drawing alone, and one of a strike."""
    spot = of_drawing(lambda scene: scene.shaft.length / 5)
    monkeypatch.setitem(RESULTS, "sweet_spot", Result(WORDS, "m", 2, heading="sweet spot", of=spot, better="higher"))
    push = of_strike(lambda outcome: 2 * outcome.ball_speed)
    monkeypatch.setitem(RESULTS, "push", Result("push", "m/s", 3, of=push, argument="offset", strikes=True))


@pytest.fixture
def file(tmp_path: Path) -> Path:
    cf.save(kim_scene(0.3), tmp_path / "scene.toml")
    return tmp_path / "scene.toml"


def test_a_report_tells_it_to_people_and_programs(file: Path) -> None:
    scene, told = kim_scene(0.3), " ".join(call("report", file)[1].split())
    assert f"{WORDS} {200 * scene.shaft.length:.2f} mm" in told
    assert f"push {2 * cf.strike(scene).ball_speed:.3f} m/s" in told
    found = json.loads(call("report", file, "--json")[1])
    assert found["numbers"]["sweet_spot"] == pytest.approx(scene.shaft.length / 5, rel=1e-12)
    assert found["numbers"]["push"] == pytest.approx(2 * cf.strike(scene).ball_speed, rel=1e-12)


def test_a_page_has_it(file: Path) -> None:
    page = file.with_suffix(".html")
    assert call("report", file, "-o", page)[0] == 0
    assert WORDS in page.read_text(encoding="utf-8")


def test_studies_ask_for_it(file: Path) -> None:
    study, table = file.with_name("study.toml"), file.with_name("table.csv")
    study.write_text(STUDY, encoding="utf-8")
    status, out, _ = call("sweep", study, "--export", table)
    assert status == 0
    assert "sweet spot, mm (higher is better)" in out
    assert {"sweet_spot", "push(0.2)"} <= {name.split(" [")[0] for name in table.read_text().splitlines()[0].split(",")}
    frame = of_sweep(study.with_suffix(".sqlite"))
    assert frame.attrs["units"]["sweet_spot"] == "m"
    assert frame["sweet_spot"].to_numpy() == pytest.approx(3 * [kim_scene(0.3).shaft.length / 5], rel=1e-12)
    assert (frame["push(0.2)"] > 0).all()


def test_the_designer_shows_it() -> None:
    scene = kim_scene(0.3)
    found = completed(with_end_mass(answers(scene)))
    (row,) = (one for one in rows(found) if one.name == "sweet_spot")
    assert row.text() == f"{200 * scene.shaft.length:.2f} mm"
    columns = [Column(Design.of("this", scene), found)]
    assert WORDS in table_markup(columns, 0)
    assert f"{200 * scene.shaft.length / 25.4:.4f}" in csv_text(columns, 0, INCHES)


def test_a_study_s_refusal_names_it(file: Path) -> None:
    study = file.with_name("study.toml")
    study.write_text(STUDY.replace('"sweet_spot"', '"sweet_spott"'), encoding="utf-8")
    assert "did you mean sweet_spot?" in call("sweep", study)[2]
