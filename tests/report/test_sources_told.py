"""Numbers that pages show beside a cue's own say where they come from (validation)."""

from __future__ import annotations

import math

import pytest

from cuefem.report.page import A31_NAME, MEASURED_A31, SOURCES
from cuefem.report.record import scene_record
from cuefem.report.squirt import squirt_record, squirt_sheets
from cuefem.squirt import alciatore_a31_mass_ratio
from tests.helpers.leather_scenes import leather_scene


@pytest.mark.parametrize(("end", "offset", "degrees"), [(0, 0.453, 1.8), (1, 0.267, 2.4)], ids=["Predator", "Stinger"])
def test_measured_end_masses_are_those_of_a31(end: int, offset: float, degrees: float) -> None:
    felt = 0.170 / alciatore_a31_mass_ratio(offset, math.radians(degrees))
    assert MEASURED_A31[end] == pytest.approx(float(felt), rel=0.01)
    assert f"{degrees:g}° at b/R {offset:g}" in dict(SOURCES)[A31_NAME]


def test_the_paper_and_the_proof_are_named_where_their_numbers_stand() -> None:
    scene = leather_scene()
    table, _ = squirt_sheets(squirt_record(scene, (0.1, 0.3)), scene_record(scene))
    said = " ".join(table.notes)
    assert "in H.-C. Kim's paper (arXiv:2104.11232)" in said
    assert "technical proof A.31 (billiards.colostate.edu)" in said
    assert {name for name, _ in SOURCES} == {"the paper's 12 g", A31_NAME, "A.31"}
