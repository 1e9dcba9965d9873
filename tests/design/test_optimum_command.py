"""`cuefem optimize`: the committed study, what it writes, and a problem without exact gradients (regression)."""

from __future__ import annotations

import json
import re
from pathlib import Path

import numpy as np
import pytest

import cuefem as cf
from cuefem.cli.studies import _progress
from cuefem.design.evaluation import evaluate
from cuefem.design.optimum import optimum
from cuefem.io.study_files import load_optimum
from studies.pages import STUDIES
from tests.helpers.command_line import call
from tests.helpers.sweeps import OPTIMUM, written

STUDY = STUDIES / "design" / "optimum.toml"


def test_the_committed_study(tmp_path: Path) -> None:
    """The number of studies/design/low_squirt.md; the scene that is written is as stiff as was asked."""
    goal = tmp_path / "best.toml"
    code, out, err = call("optimize", STUDY, "--json", "-o", goal)
    assert (code, err) == (0, "")
    said = json.loads(out)
    assert said["value"] == pytest.approx(0.03952, abs=5e-6)
    assert (said["evaluations"], said["exact_gradients"]) == (18, True)
    assert said["objective"] == {"minimize": "squirt_slope"}
    assert said["active"][:2] == ["tip_stiffness >= 386.7", "wall >= 0.002"]
    wanted = {"squirt_slope": said["value"], "tip_stiffness": 386.7, "wall": 0.002}
    assert said["values"] == pytest.approx(wanted, rel=1e-6)
    assert said["units"]["tip_stiffness"] == "N/m"
    best = cf.load(goal)
    assert isinstance(best, cf.Scene)
    assert cf.CueBatch.of([best.cue]).tip_stiffness[0] == pytest.approx(386.7, rel=1e-6)
    assert best.cue.segments[0].tip_diameter == said["numbers"]["tip diameter"]
    assert max(map(len, re.findall(r"\d[\d.]*", goal.read_text(encoding="utf-8")))) <= 11  # nine digits and the point


def test_what_a_person_reads(tmp_path: Path) -> None:
    code, out, err = call("optimize", written(tmp_path, OPTIMUM))
    assert (code, err) == (0, "")
    lines = out.splitlines()
    assert lines[0].startswith("minimize squirt slope: ")
    assert lines[0].endswith("evaluations by exact gradients")
    assert [line.split(maxsplit=1)[1] for line in lines[2:4]] == ["9 mm", "10 mm"]
    assert re.fullmatch(r"stiffness at the tip +\d{3}\.\d{1,3} N/m", lines[5])
    assert "held by: bore <= 9 mm, tip >= 10 mm" in lines


def test_an_unfinished_optimum_says_so_in_words(tmp_path: Path) -> None:
    code, out, err = call("optimize", written(tmp_path, OPTIMUM), "--iterations", 1)
    assert (code, err) == (0, "")
    assert "not finished: Iteration limit reached; more --iterations may find a better design" in out.splitlines()
    code, out, err = call("optimize", STUDY, "--iterations", 1)  # a step that ends outside the limits
    assert (code, out) == (2, "")
    assert err.endswith("no design within tip_stiffness >= 386.7 was found: Iteration limit reached\n")


def test_progress_says_in_words_that_no_design_is_within_the_limits(tmp_path: Path) -> None:
    found: list[float] = []
    wanted = OPTIMUM.replace('minimize = "squirt_slope"', 'minimize = "squirt(0.3)"').replace("300 N/m", "1e6 N/m")
    with pytest.raises(ValueError, match="no design within tip_stiffness >= 1e"):
        optimum(load_optimum(written(tmp_path, wanted)), iterations=1, progress=lambda _, best: found.append(best))
    assert found
    assert np.isnan(found).all()
    assert _progress(30, found[0]) == "30 evaluations, no design within the limits yet"
    assert _progress(30, 0.0412345678) == "30 evaluations, 0.0412346"


def test_logarithmic_spacing_seeks_in_equal_ratios(tmp_path: Path) -> None:
    """The same optimum, and for a sample as many designs in each octave of the range."""
    plain = load_optimum(written(tmp_path, OPTIMUM))
    wanted = OPTIMUM.replace('low = "1 mm"\nhigh = "9 mm"', 'low = "1 mm"\nhigh = "9 mm"\nspacing = "logarithmic"')
    problem = load_optimum(written(tmp_path, wanted))
    bores, tips = problem.points(np.array([[0.0, 0.0], [0.25, 0.5], [0.5, 1.0], [1.0, 1.0]])).T
    assert bores == pytest.approx([1e-3, 1e-3 * 3**0.5, 3e-3, 9e-3], rel=1e-14)
    assert tips == pytest.approx([0.010, 0.0115, 0.013, 0.013], rel=1e-14)
    parts = np.array([[0.3, 0.7]])
    points = problem.points(parts)
    assert problem.parts(points) == pytest.approx(parts, rel=1e-13)
    slopes = (problem.points(parts + 1e-6) - problem.points(parts - 1e-6)) / 2e-6
    assert problem.stretch(points) == pytest.approx(slopes, rel=1e-9)
    assert optimum(problem).numbers == pytest.approx(optimum(plain).numbers, rel=1e-6)


def test_a_coupled_strike_has_no_exact_gradients(tmp_path: Path) -> None:
    """Squirt of a strike by differential evolution: within 3 % of that of the design of least squirt_slope."""
    study = written(tmp_path, OPTIMUM.replace('minimize = "squirt_slope"', 'minimize = "squirt(0.3)"'))
    code, out, err = call("optimize", study, "--json", "--iterations", 8, "--seed", 4)
    assert (code, err) == (0, "")
    said = json.loads(out)
    assert said["exact_gradients"] is False
    assert said["values"]["tip_stiffness"] >= 300
    exact = optimum(load_optimum(written(tmp_path, OPTIMUM, name="exact.toml"))).scene
    least = evaluate([exact], ["squirt(0.3)"], at=cf.Resolution(1, 8, 4)).values.item()
    assert least < said["value"] < 1.03 * least
    once, again, other = (call("optimize", study, "--json", "--iterations", 1, "--seed", n)[1] for n in (4, 4, 5))
    assert once == again != other


def test_a_drawing_is_not_replaced_unasked(tmp_path: Path) -> None:
    goal = tmp_path / "best.toml"
    goal.write_text("mine", encoding="utf-8")
    code, _, err = call("optimize", written(tmp_path, OPTIMUM), "-o", goal)
    assert code == 2
    assert "--force replaces it" in err
    assert goal.read_text(encoding="utf-8") == "mine"
    assert call("optimize", tmp_path / "study.toml", "-o", goal, "--force")[0] == 0
    assert isinstance(cf.load(goal), cf.Scene)
