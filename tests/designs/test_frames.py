"""Pandas frames of studies: designs, responses and units (properties)."""

from pathlib import Path

import pytest

import cuefem as cf
from tests.helpers.sweeps import resolution, vary, write_study

pd = pytest.importorskip("pandas")

STUDY = 'scene = "scene.toml"\nresponses = ["end_mass", "mass"]\n' + resolution(8, 6)
STUDY += vary('"cue.segments[0].tip_diameter"', 'name = "tip"', 'low = "11 mm"', 'high = "13 mm"', "count = 3")
STUDY += vary('"cue.segments[0].material"', 'name = "wood"', 'values = ["hard maple", "ash"]')


def test_frame_has_designs_units_and_responses(tmp_path: Path) -> None:
    frame = cf.study(write_study(tmp_path, STUDY), store=tmp_path / "study.sqlite").to_frame()
    assert list(frame.columns) == ["tip", "wood", "end_mass", "mass", "failure"]
    assert frame.attrs["units"] == {"tip": "m", "wood": "", "end_mass": "kg", "mass": "kg"}
    assert (len(frame), frame.index.name, frame["failure"].notna().sum()) == (6, "design", 0)
