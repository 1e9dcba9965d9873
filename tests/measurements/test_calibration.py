"""A calibration on one shaft: its statistics, its file, and what is rejected (verification)."""

import math
import re
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import cuefem as cf
from cuefem.measurements.calibration import Calibration
from cuefem.results.closed_forms import pivot_length
from cuefem.results.uncertainty import MODEL_ERROR, RATIO_FLOOR, SHAFT_ERROR, squirt_of
from tests.helpers.command_line import as_json, call, stdout_of

PREDATOR = Path(__file__).parents[2] / "studies/measured/predator_z"
OLD = cf.usual_scene(cf.load("plain maple"))
NEW = cf.usual_scene(cf.load("low deflection"))
TIP = {"leather": OLD.leather_tip.E, "restitution": float(OLD.tip.restitution)}


def calibration(factor: float = 1.2, error: float = 0.06, scene: cf.Scene = OLD) -> Calibration:
    """A shaft whose squirt was measured with a relative error; the tip stays as it was drawn."""
    s2 = MODEL_ERROR**2
    gain = s2 / (s2 + error**2)
    covariance = np.diag([0.1**2, 0.03**2, s2 * (1 - gain)])
    return Calibration("old", scene, TIP, gain * math.log(factor), tuple(map(tuple, covariance.tolist())), ("pivot",))


@pytest.fixture(scope="module")
def file(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A file of a calibration."""
    path = tmp_path_factory.mktemp("calibration") / "old.toml"
    calibration().save(path)
    return path


def test_next_shaft_has_mean_and_variance_of_the_correlated_factor() -> None:
    made = calibration()
    found = made.squirt(NEW)
    ratio = math.log(squirt_of(NEW) / squirt_of(OLD))
    r = 1 - (SHAFT_ERROR * ratio) ** 2 / (2 * MODEL_ERROR**2)
    assert found.correlation == pytest.approx(r, rel=1e-9)
    assert found.factor == pytest.approx(math.exp(r * made.log_factor), rel=1e-9)
    assert found.squirt == pytest.approx(found.factor * squirt_of(NEW), rel=1e-9)
    assert made.measured_factor == pytest.approx(1.2, rel=1e-9)
    v = made.covariance[-1][-1]
    assert found.error > math.sqrt(r**2 * v + (1 - r**2) * MODEL_ERROR**2)
    assert found.error < found.uncalibrated_error - 0.05


def test_same_shaft_keeps_its_measured_squirt() -> None:
    found = calibration(error=0.01).squirt(OLD)
    assert found.correlation == pytest.approx(1 - RATIO_FLOOR**2 / (2 * MODEL_ERROR**2))
    assert found.squirt == pytest.approx(1.2 * squirt_of(OLD), rel=2e-3)


def test_calibration_without_information_equals_the_model() -> None:
    made = calibration(error=1.745)  # removes 1.05 % of the prior's variance
    unshared = replace(made, drawn={}, covariance=((made.covariance[-1][-1],),))
    found = unshared.squirt(NEW)
    assert found.error == pytest.approx(found.uncalibrated_error, rel=0.01)


def test_file_round_trips(file: Path) -> None:
    read = cf.load_calibration(file)
    assert read.squirt(NEW).squirt == pytest.approx(calibration().squirt(NEW).squirt, rel=1e-9)
    assert (read.name, read.unchecked) == ("old", ("pivot",))


def test_warning_beyond_plausible_factor() -> None:
    assert calibration(1.19).warnings == ("no other measurement of old checks pivot",)
    assert "1.21 times the computed one, a factor farther from 1 than 1/1.2 to 1.2" in calibration(1.21).warnings[0]
    assert "0.79 times the computed one" in calibration(0.79).warnings[0]


def test_shots_without_speed_warn_wherever_the_calibration_leads(tmp_path: Path) -> None:
    """Who strikes hard and gives no speed is off by 23 % with a calibration, 19 % without (studies/measured)."""
    made = replace(calibration(), without_speed=("squirt at b/R 0.4",))
    made.save(tmp_path / "old.toml")
    assert cf.load_calibration(tmp_path / "old.toml") == made
    (line,) = (line for line in made.squirt(NEW).warnings if "has no speed" in line)
    assert line.startswith("squirt at b/R 0.4 of old has no speed and counts as a stroke at 2 m/s ± 50 %")


@pytest.mark.heavy
def test_studies_have_the_calibrated_squirt_of_reports(file: Path, tmp_path: Path) -> None:
    """One store holds the designs of both, which are not mixed; the base is the report's cue."""
    study, table = tmp_path / "bore.toml", tmp_path / "bore.csv"
    cf.save(NEW, tmp_path / "new.toml")
    vary = '[[vary]]\npath = "bore depth"\nfactor = true\nvalues = [0.8, 1.0]\n'
    study.write_text(f'scene = "new.toml"\nresponses = ["squirt", "pivot_length(0.3)"]\n{vary}', "utf-8")
    _, plain = stdout_of("study", study, "-o", table), np.loadtxt(table, delimiter=",", skiprows=1, usecols=(2, 3))
    out = stdout_of("study", study, "--calibration", file, "-o", table)
    own = np.loadtxt(table, delimiter=",", skiprows=1, usecols=(2, 3))
    verdict = cf.verdict(NEW, calibration=cf.load_calibration(file))
    assert verdict.calibrated is not None
    assert own[1] == pytest.approx([verdict.squirt, pivot_length(NEW, verdict.squirt)], rel=1e-9)
    assert own[:, 0] / plain[:, 0] == pytest.approx(verdict.calibrated.factor, rel=1e-9)
    assert verdict.calibrated.origin() in re.sub(r"\s+", " ", out)
    assert f"calibrated: all squirt is {verdict.calibrated.factor:.2f} times the computed one" in out


@pytest.mark.heavy
def test_estimate_writes_a_calibration_that_every_command_takes(tmp_path: Path) -> None:
    """Predator Z: pivot length measured in 2007; 12 % for a bored shaft instead of 20 %."""
    path, page = tmp_path / "z.toml", tmp_path / "page.html"
    status, out, err = call("compare", PREDATOR, "--estimate", "-o", path)
    first, *others = err.splitlines()
    assert (status, first) == (
        0,
        "warning: no other measurement of Predator Z checks natural pivot length at b/R 0.375",
    )
    assert all("has no distance and counts as the ball's initial direction" in line for line in others[:2])
    assert f"cuefem report NEW.toml --calibration {path}" in out
    found = cf.load_calibration(path).squirt(NEW)
    assert (round(found.error, 2), round(found.uncalibrated_error, 2)) == (0.12, 0.20)
    line = found.origin()
    assert line in stdout_of("improve", "low deflection", "--calibration", path)
    assert line in stdout_of("compare", "low deflection", "plain maple", "--calibration", path)
    record = as_json("report", "low deflection", "--calibration", path)
    assert record["verdict"]["calibrated"]["squirt"] == pytest.approx(found.squirt, rel=1e-9)
    assert stdout_of("report", "low deflection", "--calibration", path, "-o", page)
    assert "calibrated on Predator Z" in page.read_text("utf-8")


@pytest.mark.heavy
def test_one_factor_scales_every_squirt_of_every_answer() -> None:
    """Squirt, its reference cues, curves and table times the factor; pivot length and end mass those of that squirt."""
    made = calibration()
    found = made.squirt(NEW)
    assert found.factor > 1.1

    plain, own = (cf.report(NEW, calibration=each, details=True).sections for each in (None, made))
    verdicts: list[Any] = [each["verdict"] for each in (plain, own)]
    numbers: list[Any] = [each["numbers"] for each in (plain, own)]
    curves: list[Any] = [each["squirt"].models["coupled, this cue"]["squirt"] for each in (plain, own)]  # type: ignore[attr-defined]
    changes = [cf.design_changes(NEW, calibration=each) for each in (None, made)]
    pairs = [cf.compare({"new": NEW, "old": OLD}, calibration=each) for each in (None, made)]
    tables = [cf.strike_table(NEW, (1.9, 2.1), calibration=each) for each in (None, made)]
    squirts = [
        [each.squirt for each in verdicts],
        [each.references["plain maple"]["squirt"] for each in verdicts],
        [each.numbers["squirt"] for each in numbers],
        [each[5] for each in curves],
        [each.unmodified["squirt"] for each in changes],
        [each.changes[0].squirt for each in changes],
        [each.cues["new"]["squirt"] for each in pairs],
        [each.cues["old"]["squirt"] for each in pairs],
        [each.at(2.0, 0.2).squirt for each in tables],
    ]
    for before, after in squirts:
        assert after / before == pytest.approx(found.factor, rel=2e-4)  # a table has four digits
    assert verdicts[1].squirt_error == pytest.approx(found.squirt_error, rel=1e-9)
    assert pairs[1].differences["old"]["squirt"] == pytest.approx(pairs[0].differences["old"]["squirt"], rel=1e-9)
    pivot = pivot_length(NEW, found.squirt)
    assert pairs[1].cues["new"]["pivot_length"] == pytest.approx(pivot, rel=1e-9)
    lumped = replace(NEW, cue=cf.LumpedCue(NEW.axial_mass, numbers[1].squirt_end_mass), effects=())
    assert float(cf.impulse(lumped).squirt) == pytest.approx(found.squirt, rel=1e-4)
