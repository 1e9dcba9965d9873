"""A session of the designer without a browser: changes, comparison, what is computed of them (properties)."""

from __future__ import annotations

from pathlib import Path

import pytest

import cuefem as cf
from cuefem.analysis.first_screen import comparison_lines, headline_markup
from cuefem.designer.session import OF_TAB, OPENED, Results, Session
from cuefem.designer.state import read_file, reference_design
from tests.measurements.test_calibration import calibration

FIRST = reference_design("plain maple")


def test_plan_ends_at_a_failed_strike() -> None:
    """Its first stage is the strike, whose result nobody stores here; then nothing follows."""
    session = Session(FIRST)
    stages = [[work.name for work in stage] for stage in session.plan("Curves", Results())]
    assert stages == [["solved_strike"]]
    session.compare_with(OPENED)
    stages = [[work.name for work in stage] for stage in session.plan("Curves", Results())]
    assert stages == [["solved_strike", "solved_strike"]]


def test_miscue_has_numbers_and_no_verdict() -> None:
    session = Session(FIRST)
    session.set_knob("offset", 0.66)
    assert session.compute("Changes") == []
    assert "miscue" in session.warning()
    assert not {"verdict", "changes"} & session.results.own.keys()
    assert {*OF_TAB} == {"Curves", "Changes", "Report"}


@pytest.mark.heavy
def test_calibration_shows_as_in_the_commands() -> None:
    """First screen, Changes and report have the calibrated squirt of the functions, and what it rests on."""
    made, session = calibration(scene=FIRST.scene), Session(FIRST)
    assert session.calibration_lines() == []
    session.calibrate(made)
    assert session.compute("Changes") == []
    verdict = cf.verdict(FIRST.scene, calibration=made)
    headline = session.headline_cue(0)
    assert headline is not None
    assert headline.verdict == verdict
    assert verdict.calibrated is not None
    assert verdict.squirt == pytest.approx(verdict.calibrated.factor * verdict.calibrated.computed)
    assert headline.numbers["squirt"] == pytest.approx(verdict.squirt)
    warning = "warning: no other measurement of old checks pivot"
    lines = comparison_lines(headline)
    assert verdict.calibrated.origin() in headline_markup(headline, lines).replace("\u00a0", " ")
    assert session.calibration_lines() == [verdict.calibrated.basis(), warning]
    assert session.results.own["changes"].calibrated == verdict.calibrated
    page = session.report_call()()
    assert "calibrated on old" in page
    assert "It rests on the squirt measured on old" in page
    assert warning in page


def test_opened_calibration_calibrates_and_another_is_rejected(tmp_path: Path) -> None:
    path, session = tmp_path / "old.toml", Session(FIRST)
    made = calibration(scene=FIRST.scene)
    made.save(path)
    read = read_file(path.name, path.read_bytes())
    session.open_file(read)
    assert session.history.calibration == read == made
    assert session.step.design == FIRST
    with pytest.raises(ValueError, match="another game: ball 142 g"):
        session.calibrate(calibration(scene=cf.usual_scene(cf.load("plain maple"), "snooker")))
    with pytest.raises(ValueError, match="no design to compare with"):
        session.compare_with_file(read)
    with pytest.raises(ValueError, match=r"^broken.toml: calibration: must be a table of name, "):
        read_file("broken.toml", b"[calibration]\nname = 'x'\n")
