"""`cuefem cost`: its table, its chart and its recommendation (properties)."""

import re
from pathlib import Path

import pytest

import cuefem as cf
from cuefem.analysis.convergence_study import RECOMMENDED_RTOLS, ConvergenceStudy
from studies.strokes import MESHES
from tests.helpers.accuracy_scenes import scene
from tests.helpers.command_line import stdout_of

KIM = MESHES / "kim.toml"


@pytest.fixture(scope="module")
def found() -> ConvergenceStudy:
    return cf.convergence_study(scene("kim", 1e-3, 0.3), max_modes=60)


def test_recommended_resolution_equals_strike_to_that_rtol(found: ConvergenceStudy) -> None:
    assert [row["rtol"] for row in found.recommended_resolutions] == list(RECOMMENDED_RTOLS)
    for row in found.recommended_resolutions:
        if row["is_reached"]:
            result = cf.strike(scene("kim", 1e-3, 0.3), rtol=row["rtol"])
            assert (result.unknowns, result.error) == (row["unknowns"], row["estimate"])
    assert [row["is_reached"] for row in found.recommended_resolutions] == [True, True, False, False]
    best = min(level["estimate"] for level in found.levels)
    assert found.recommended_resolutions[-1]["estimate"] == best


def test_cost_command_prints_table_and_draws_chart(tmp_path: Path) -> None:
    assert "1e-06, not reached" in stdout_of("cost", KIM, "--max-modes", 24)
    stdout_of("cost", KIM, "--max-modes", 24, "--output", tmp_path / "cost.html")
    text = (tmp_path / "cost.html").read_text(encoding="utf-8")
    assert len(re.findall(r'<path class="curve c3"[^>]* d="M', text)) == 2  # with its legend
