"""The committed table of side_strike.py derived again, and what its sentences say checked."""

import sys
from pathlib import Path

import matplotlib as mpl
import numpy as np
import pytest

from cuefem.validation import disagreements
from tests.helpers.half_order import spring_exact

mpl.use("Agg")
sys.path.append(str(Path(__file__).parents[2] / "studies"))
import side_strike as study

STUDIES = Path(study.__file__).parent
COMMITTED = (STUDIES / "side_strike.md").read_text(encoding="utf-8")


@pytest.mark.heavy
def test_committed_table():
    assert disagreements(COMMITTED, study.report()) == []


@pytest.mark.heavy
def test_figure_is_drawn(tmp_path):
    study.figures(tmp_path)
    assert (tmp_path / "side_strike.svg").stat().st_size < 150_000


def test_the_exact_curve_is_that_of_the_tests():
    for parameter in study.PARAMETERS[:-1]:
        assert study.exact(parameter) == pytest.approx(spring_exact(parameter)[0], abs=1e-12)


def test_above_its_limit_nothing_leaves():
    assert -0.7 < study.exact(3.58) < -0.6
    with pytest.raises(StopIteration):
        study.exact(3.6)


@pytest.mark.parametrize("name", study.CASES)
def test_a_far_clamp_changes_nothing_near_the_end(name):
    """What [Cross 1999] and [Nathan 2000] say of the hand."""
    rigid, free, held = study.bounces(name, study.CASES[name][2][1])
    assert abs(held - free) < 1e-3
    assert rigid - free > 0.1


def test_a_bat_is_rigid_only_over_a_part_of_its_barrel():
    values = np.array([study.bounces("bat", x)[:2] for x in (0.03, 0.16, 0.3)])
    assert list(np.abs(values[:, 0] - values[:, 1]) < 0.02) == [False, True, False]


def test_a_rectangular_beam_as_a_round_one():
    """EI, rhoA, rhoI and kappa G A of 60 x 27.8 mm of steel."""
    section = study.rectangular(0.06, 0.0278, 0.78, study.STEEL).section(0.1)
    area, inertia = 0.06 * 0.0278, 0.06 * 0.0278**3 / 12
    wanted = (206e9 * inertia, 7850 * area, 7850 * inertia, 5 / 6 * 79.4e9 * area)
    np.testing.assert_allclose([section.EI, section.rhoA, section.rhoI, section.kGA], wanted, rtol=1e-12)


@pytest.mark.heavy
def test_the_sphere_touches_several_times():
    touches, (first, free, wall) = study.fall()
    assert len(touches) > 2
    assert free < first < wall
    assert all(1e-5 < duration < 2e-3 for _, duration in touches)


def test_the_sources_are_named_with_what_is_missing():
    for name in ("Cross", "Nathan", "Lindsey", "Goldsmith", "could not be had"):
        assert name in COMMITTED
