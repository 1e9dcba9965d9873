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
SCATTER = f"""scene = "cue.toml"
responses = ["end_mass"]
{COARSE}[tolerances]
count = 16
seed = 1
{TIP}[[vary]]
name = "butt"
path = "cue.segments[0].butt_diameter"
low = "20 mm"
high = "22 mm"
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


def test_a_scatter(tmp_path: Path) -> None:
    found = cf.study(study(tmp_path, SCATTER))
    frame, shares = cf.frames.of_study(found), cf.frames.of_drivers(found)
    assert (list(frame.columns), len(frame)) == (["tip", "butt", "end_mass", "failure"], 64)
    assert frame["end_mass"][:32].mean() == pytest.approx(found.spread["end_mass"]["mean"], rel=1e-12)
    assert shares.loc[("end_mass", "tip"), "total"] == found.drivers.total[0, 0]
    assert (shares["total_low"] <= shares["total_high"]).all()
    with pytest.raises(ValueError, match="takes a scatter, a study with tolerances; got one of kind sweep"):
        cf.frames.of_drivers(cf.study(study(tmp_path, STUDY)))


def test_a_batch() -> None:
    wood = cf.Material(12.6e9, 0.84e9, 700.0)
    batch = cf.CueBatch.of([cf.Cue((cf.Segment(0.74, d, 0.0215, wood),), 0.42) for d in (0.0115, 0.0135)])
    frame = cf.frames.of_batch(batch, end_mass=[0.005, 0.006])
    assert frame["tip_diameter"].tolist() == [0.0115, 0.0135]
    assert frame["mass"].tolist() == batch.mass.tolist()
    assert frame.attrs["units"] == {
        **dict.fromkeys(("length", "tip_diameter", "butt_diameter"), "m"),
        **dict.fromkeys(("shaft_mass", "mass", "body_mass"), "kg"),
    }
    with pytest.raises(ValueError, match=r"end_mass must have one number a cue, shape \(2,\); got \(3,\)"):
        cf.frames.of_batch(batch, end_mass=[1, 2, 3])


def test_what_is_no_store(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="No such file"):
        cf.frames.of_store(tmp_path / "none.sqlite")
    (tmp_path / "text.sqlite").write_text("x" * 200)
    with pytest.raises(InputError, match="cannot be read or written as a database"):
        cf.frames.of_store(tmp_path / "text.sqlite")
