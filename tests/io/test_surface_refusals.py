"""Surfaces that are no shaft, and files that are no surface: one clear line (regression)."""

from __future__ import annotations

import struct
from pathlib import Path

import numpy as np
import pytest

import cuefem as cf
from cuefem.io import InputError
from tests.helpers.command_line import call
from tests.helpers.surfaces import revolved, written

POINTS, FACES = revolved([(0, 0), (0, 0.006), (0.7, 0.0105), (0.7, 0)], 16)
BUTT = len(POINTS) - 1


def moved(*, across: float = 1.0, bend: float = 0.0) -> np.ndarray:
    points = revolved([(0, 0), *((x, 0.006) for x in np.linspace(0, 0.7, 30)), (0.7, 0)], 16)[0]
    points[:, 1] *= across
    points[:, 2] += bend * points[:, 0] ** 2
    return points


BAR = revolved([(0, 0), *((x, 0.006) for x in np.linspace(0, 0.7, 30)), (0.7, 0)], 16)[1]
BESIDE = np.concatenate([POINTS, POINTS + np.array([0, 0.03, 0])]), np.concatenate([FACES, FACES + len(POINTS)])
SHEET = np.concatenate([FACES[:8], FACES[:8, ::-1]])
SHORT = revolved([(0, 0), (0, 0.02), (0.15, 0.02), (0.15, 0)], 16)
TURNED = np.concatenate([FACES[:20], FACES[20:21, ::-1], FACES[21:]])

# One triangle, its first corner a signalling nan
SIGNALLING = bytes(80) + struct.pack("<I", 1) + bytes(12) + struct.pack("<I", 0x7F80FF00) + bytes(34)

SURFACES = {
    "open": (POINTS, FACES[1:], "must be closed, two triangles at every edge; got 3 loose edges, one at (0, 0, 0)"),
    "turned": (POINTS, TURNED, "must have its triangles turned the same way; got about "),
    "no volume": (POINTS, SHEET, "must enclose a volume; got a surface that encloses none"),
    "short": (*SHORT, "must be slender, at least 5 times as long as wide; got 150 by 40"),
    "flat": (
        moved(across=1.05),
        BAR,
        "must be round, second moments within 2 % of each other; got second moments 9.8 %",
    ),
    "square": (
        *revolved([(0, 0), (0, 0.006), (0.7, 0.006), (0.7, 0)], 4),
        "must be round, its second moment within 2 % of a disc's; got a section 4.7 % off at 0 from its thinner end",
    ),
    "bent": (
        moved(bend=0.003),
        BAR,
        "must be straight, its sections' centres within 2 % of the width of one axis; got ",
    ),
    "two beside each other": (*BESIDE, "must be one piece across the axis; got 2 outlines at 0 from its thinner end"),
}


def refused(path: Path, **options: str) -> str:
    with pytest.raises(InputError) as caught:
        cf.load(path, **options)
    said = str(caught.value)
    assert said.startswith(f"{path}: ")
    assert len(said.splitlines()) == 1
    return said.removeprefix(f"{path}: ")


@pytest.mark.parametrize("name", SURFACES)
def test_no_shaft(tmp_path: Path, name: str) -> None:
    points, faces, line = SURFACES[name]
    path = tmp_path / "shaft.ply"
    assert refused(written(path, points, faces, binary=False)).startswith(line)
    status, out, err = call("modes", path)
    assert (status, out) == (2, "")
    assert err.startswith(f"cuefem: {path}: {line}")


@pytest.mark.parametrize(
    ("name", "content", "line"),
    [
        ("shaft.stl", b"", None),
        ("shaft.stl", b"x" * 200, None),
        ("shaft.stl", b"solid nothing\nendsolid nothing\n" + 90 * b" ", None),
        ("shaft.ply", b"ply\nformat ascii 1.0\nend_header\n", None),
        ("shaft.ply", b"ply\nformat ascii 1.0\nelement vertex 3\n", "must be a .ply surface; got a file that meshio"),
        ("shaft.ply", b"solid\n", "must be a .ply surface; got a file that meshio cannot read"),
        ("shaft.obj", b"v 0 0 0\nv 1 0 0\nv 0 1 0\n", None),
        ("shaft.obj", b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\n", "faces: must name corners in [0, 3); got another"),
        ("shaft.obj", b"v 0 0 0\nv 1 0 0\nf 1 2\n", "faces: must have three corners or more; got one of fewer"),
        ("shaft.stl", SIGNALLING, "corners: must be finite x, y, z; got others"),
        ("shaft.obj", b"v 0 0 0\nv 1 nan 0\nv 0 1 0\nf 1 2 3\n", "corners: must be finite x, y, z; got others"),
    ],
)
def test_no_surface(tmp_path: Path, name: str, content: bytes, line: str | None) -> None:
    path = tmp_path / name
    path.write_bytes(content)
    said = refused(path)
    assert said.startswith(line or ("faces: must be triangles", "must be a .")), said


def test_no_file(tmp_path: Path) -> None:
    assert refused(tmp_path / "none.stl") == "cannot be read: No such file or directory"
    (tmp_path / "folder.stl").mkdir()
    assert refused(tmp_path / "folder.stl") == "cannot be read: Is a directory"


@pytest.mark.parametrize("unit", ["kg", "furlnog", "", "mm mm"])
def test_no_unit_of_length(tmp_path: Path, unit: str) -> None:
    path = written(tmp_path / "shaft.stl", POINTS, FACES)
    assert refused(path, length_unit=unit) == f"length unit: must be a unit of length, such as mm; got {unit!r}"


def test_options_are_for_the_files_that_lack_them(tmp_path: Path) -> None:
    path = tmp_path / "shaft.csv"
    path.write_text("x [mm],diameter [mm]\n0,12\n700,21\n")
    line = "has its own units of length: length_unit is for .stl, .ply and .obj files alone; got 'mm'"
    assert refused(path, length_unit="mm") == line
    path = written(tmp_path / "shaft.stl", POINTS, FACES)
    assert refused(path, material="hard mapel").startswith("material: no material is called 'hard mapel'")
