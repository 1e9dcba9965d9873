"""Tables of studies as pandas and xarray objects hold what the studies found (properties)."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import cuefem as cf
from cuefem.design.scatter import drivers
from cuefem.io import InputError
from cuefem.io.study_files import load_scatter
from tests.helpers.command_line import call

pd = pytest.importorskip("pandas")
xr = pytest.importorskip("xarray")

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
SAMPLE = f"""scene = "cue.toml"
responses = ["end_mass"]
{COARSE}[sample]
method = "sobol"
count = 16
seed = 1
{TIP}[[vary]]
name = "butt"
path = "cue.segments[0].butt_diameter"
low = "20 mm"
high = "22 mm"
"""


def swept(folder: Path, study: str) -> Path:
    (folder / "cue.toml").write_text(CUE)
    (folder / "study.toml").write_text(study)
    assert call("sweep", folder / "study.toml")[0] == 0
    return folder / "study.sqlite"


def test_a_sweep_as_a_frame_and_as_a_grid(tmp_path: Path) -> None:
    path = swept(tmp_path, STUDY)
    frame = cf.frames.of_sweep(path)
    assert list(frame.columns) == ["tip", "wood", "end_mass", "mass", "failure"]
    assert frame.attrs["units"] == {"tip": "m", "wood": "", "end_mass": "kg", "mass": "kg"}
    assert (len(frame), frame.index.name, frame["failure"].notna().sum()) == (6, "design", 0)
    grid = cf.frames.sweep_grid(path)
    assert dict(grid.sizes) == {"tip": 3, "wood": 2}
    assert grid["end_mass"].attrs["units"] == "kg"
    for row in frame.itertuples():
        assert float(grid["end_mass"].sel(tip=row.tip, wood=row.wood)) == row.end_mass
    assert np.all(np.diff(grid["end_mass"].sel(wood="ash")) > 0)


def test_a_sample_is_no_grid(tmp_path: Path) -> None:
    path = swept(tmp_path, SAMPLE)
    assert cf.frames.of_sweep(path)["tip"].between(0.011, 0.013).all()
    with pytest.raises(ValueError, match="holds a sample and no grid"):
        cf.frames.sweep_grid(path)


def test_a_scatter(tmp_path: Path) -> None:
    (tmp_path / "cue.toml").write_text(CUE)
    (tmp_path / "study.toml").write_text(SAMPLE)
    wanted, sample = load_scatter(tmp_path / "study.toml")
    found = drivers(wanted, sample.count, seed=sample.seed)
    frame = cf.frames.of_scatter(wanted, found)
    assert list(frame.columns) == ["tip", "butt", "end_mass"]
    assert len(frame) == 32
    assert frame["end_mass"].mean() == pytest.approx(float(found.spread.mean[0]), rel=1e-12)
    shares = cf.frames.of_drivers(wanted, found)
    assert shares.loc[("end_mass", "tip"), "total"] == found.total[0, 0]
    assert (shares["total_low"] <= shares["total_high"]).all()


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


def test_what_is_no_sweep(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="no such file"):
        cf.frames.of_sweep(tmp_path / "none.sqlite")
    (tmp_path / "text.sqlite").write_text("x" * 200)
    with pytest.raises(InputError, match="cannot be read or written as a database"):
        cf.frames.of_sweep(tmp_path / "text.sqlite")
