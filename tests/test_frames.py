"""Tables of studies as pandas frames hold what the studies found (properties)."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import cuefem as cf
from cuefem.io import InputError

pd = pytest.importorskip("pandas")

CUE = """body_mass = "420 g"
[[segments]]
length = "700 mm"
tip_diameter = "12 mm"
butt_diameter = "21 mm"
material = "hard maple"
"""
COARSE = "[resolution]\nelements = 1\norder = 8\nmodes = 6\n"
TIP = '[[vary]]\nname = "tip"\npath = "cue.segments[0].tip_diameter"\nlow = "11 mm"\nhigh = "13 mm"\n'
STUDY = f"""scene = "cue.toml"
responses = ["end_mass", "mass"]
{COARSE}{TIP}count = 3
[[vary]]
name = "wood"
path = "cue.segments[0].material"
values = ["hard maple", "ash"]
"""


def study(folder: Path, text: str) -> Path:
    (folder / "cue.toml").write_text(CUE)
    (folder / "study.toml").write_text(text)
    return folder / "study.toml"


def test_a_sweep(tmp_path: Path) -> None:
    """The frame of its result, and that of its store; pandas takes it on."""
    found = cf.study(study(tmp_path, STUDY), store=tmp_path / "study.sqlite")
    frame = cf.frames.of_study(found)
    pd.testing.assert_frame_equal(frame, cf.frames.of_store(tmp_path / "study.sqlite"))
    assert list(frame.columns) == ["tip", "wood", "end_mass", "mass", "failure"]
    assert frame.attrs["units"] == {"tip": "m", "wood": "", "end_mass": "kg", "mass": "kg"}
    assert (len(frame), frame.index.name, frame["failure"].notna().sum()) == (6, "design", 0)
    grid = frame.pivot_table(index="tip", columns="wood", values="end_mass")
    assert grid.shape == (3, 2)
    assert np.all(np.diff(grid["ash"]) > 0)


def test_what_is_no_store(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="No such file"):
        cf.frames.of_store(tmp_path / "none.sqlite")
    (tmp_path / "text.sqlite").write_text("x" * 200)
    with pytest.raises(InputError, match="cannot be read or written as a database"):
        cf.frames.of_store(tmp_path / "text.sqlite")
