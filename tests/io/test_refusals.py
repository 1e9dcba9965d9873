"""What files are refused for: each with the one line that names file, key path, bound with unit and value got."""

from __future__ import annotations

import os
import struct
from pathlib import Path

import numpy as np
import pytest

import cuefem as cf
from cuefem.io import InputError
from tests.helpers.command_line import call
from tests.helpers.surfaces import revolved, written

CUE = """
body_mass = "420 g"
[[segments]]
length = "700 mm"
tip_diameter = "12 mm"
butt_diameter = "21 mm"
tip_bore = "3 mm"
kappa = 0.9
material = { E = "12.6 GPa", G = "840 MPa", rho = "782 kg/m^3" }
"""
SCENE = """
game = "kim"
[cue]
mass = "540 g"
end_mass = "6 g"
[ball]
mass = "210 g"
[tip]
contact_time = "1 ms"
[stroke]
offset = 0.3
"""
LENGTH = r'a length with its unit, such as "12 mm"'

# What is replaced in a good file, by what, and the line that says so.
CHANGES = [
    (CUE, '"700 mm"', '"-700 mm"', "segments[0].length: must be more than 0 and at most 1000 m; got -700 mm"),
    (CUE, '"700 mm"', '"inf mm"', "segments[0].length: must be more than 0 and at most 1000 m; got inf mm"),
    (CUE, '"700 mm"', '"1e999 mm"', "segments[0].length: must be a number that is not so large; got 1e999 mm"),
    (CUE, '"700 mm"', '"700"', 'segments[0].length: needs a unit: "0.5 in" or "12.7 mm"; got \'700\''),
    (CUE, '"700 mm"', '"700 m^9^9^9^9"', f"segments[0].length: must be {LENGTH}; got '700 m^9^9^9^9'"),
    (CUE, '"700 mm"', "[]", f"segments[0].length: must be {LENGTH}; got []"),
    (CUE, 'length = "700 mm"\n', "", f"segments[0].length: must be given, {LENGTH}; got nothing"),
    (CUE, '"21 mm"', '"0 in"', "segments[0].butt_diameter: must be more than 0 and at most 393.701 in; got 0 in"),
    (
        CUE,
        '"3 mm"',
        '"13 mm"',
        "segments[0].tip_bore: must be at least 0 and less than 12 mm, its outer diameter; got 13 mm",
    ),
    (CUE, "kappa = 0.9", "kappa = 1.5", "segments[0].kappa: must be more than 0 and at most 1; got 1.5"),
    (
        CUE,
        "kappa = 0.9",
        f"kappa = {'9' * 400}",
        f"segments[0].kappa: must be more than 0 and at most 1; got {'9' * 57}",
    ),
    (CUE, '"420 g"', '"-1 g"', "body_mass: must be 0 g or more; got -1 g"),
    (
        CUE,
        '"840 MPa"',
        '"84 GPa"',
        "segments[0].material.G: must be between 0 and 21 GPa, E/(2 nu) of E = 12600000000.0 Pa, nu = 0.3; got",
    ),
    (
        CUE,
        "length",
        "lenght",
        "segments[0].lenght: must be one of the keys length, tip_diameter, butt_diameter, material, tip_bore, "
        "butt_bore, core, kappa; got lenght = '700 mm'; did you mean 'length'?",
    ),
    (
        CUE,
        "rho",
        "Rho",
        "segments[0].material.Rho: must be one of the keys E, G, rho, loss, nu, across_ratio, nu_across; "
        "got Rho = '782 kg/m^3'; did you mean 'rho'?",
    ),
    (
        CUE,
        "body_mass",
        "bodymass",
        "bodymass: must be one of the keys segments, body_mass, weighed; got bodymass = '420 g'",
    ),
    (
        CUE,
        "[[segments]]",
        "[[segment]]",
        "segment: must be one of the keys segments, cue, ball, tip, stroke, effects, game, accuracy; got segment = "
        "[{'length': '700 mm', 'tip_diameter': '12 mm', 'butt_diam...; did you mean 'segments'?",
    ),
    (CUE, "[[segments]]", "[segments]", "segments: must be an array of tables; got {'length': '700 mm'"),
    (CUE, '{ E = "12.6 GPa"', '"hard mapel" #', "segments[0].material: "),
    (CUE, "kappa = 0.9", "core = 3", "segments[0].core: must be a table with the keys E, G, rho, loss, nu"),
    (SCENE, '"kim"', '"chess"', "game: must be one of pool, carom, snooker, kim; got 'chess'"),
    (
        SCENE,
        '"kim"',
        '"snoker"',
        "game: must be one of pool, carom, snooker, kim; got 'snoker'; did you mean 'snooker'?",
    ),
    (SCENE, '"kim"', "3", "game: must be one of pool, carom, snooker, kim; got 3"),
    (SCENE, "[ball]", "[bal]", "bal: must be one of the keys segments, cue, ball, tip, stroke"),
    (SCENE, "0.3", "1.5", "stroke.offset: must be between -1 and 1; got 1.5"),
    (SCENE, '"1 ms"', '"1 mm"', 'tip.contact_time: must be a time with its unit, such as "1.2 ms"'),
    (SCENE, '"1 ms"', '"1 ms"\nstiffness = "1e5 N/m"', "tip: Tip takes contact_time (s) or stiffness (N/m)"),
    (SCENE, "[ball]", "[accuracy]\nrtol=2\n[ball]", "accuracy.rtol: must be between 0 and 1; got 2"),
    (SCENE, "[cue]", "[cue]\ncoupling = '99 1/kg'", "cue.coupling: must be in ("),
    (SCENE, 'mass = "540 g"\n', "", "cue.mass: must be given, a mass with its unit"),
    (SCENE, "[cue]", "effects = 3\n[cue]", "effects: must be an array"),
    (SCENE, "[cue]", "effects = [{}]\n[cue]", "effects[0].type: must be one of "),
    (SCENE, "[cue]", "effects = [{type = 'PontMass'}]\n[cue]", "effects[0].type: must be one of "),
    (SCENE, "[cue]", "cue = 3\n[cew]", "cew: must be one of the keys"),
    (
        *(CUE, 'length = "700 mm"', "length = 700 mm"),
        "must be TOML; got a syntax error: Expected newline or end of document after a statement "
        "(at line 4, column 14); a value with a unit stands in quotes",
    ),
    (
        *(SCENE, 'mass = "210 g"', 'diameter = "61.5 mm"'),
        "ball.diameter: must be one of the keys mass, radius, inertia; got diameter = '61.5 mm'; "
        "did you mean 'radius', half of it?",
    ),
]


def refused(path: Path, **options: str) -> str:
    with pytest.raises(InputError) as caught:
        cf.load(path, **options)
    said = str(caught.value)
    assert said.startswith(f"{path}: ")
    assert len(said.splitlines()) == 1
    return said.removeprefix(f"{path}: ")


@pytest.mark.parametrize(("good", "old", "new", "line"), CHANGES)
def test_one_wrong_entry(tmp_path: Path, good: str, old: str, new: str, line: str) -> None:
    path = tmp_path / "file.toml"
    path.write_text(good)
    cf.load(path)
    assert old in good
    path.write_text(good.replace(old, new, 1))
    assert refused(path).startswith(line)


def test_a_scene_is_no_cue_of_a_scene(tmp_path: Path) -> None:
    path = tmp_path / "file.toml"
    path.write_text("cue = 'file.toml'\n")
    assert refused(path).startswith("cue: must be absent here: a scene's cue is a cue file")


def test_no_file_at_all(tmp_path: Path) -> None:
    (tmp_path / "folder.toml").mkdir()
    assert refused(tmp_path / "none.toml") == "cannot be read: No such file or directory"
    (tmp_path / "folder.stl").mkdir()
    assert refused(tmp_path / "folder.stl") == "must be a file; got a folder"
    assert refused(tmp_path / "none.stl") == "cannot be read: No such file or directory"
    assert refused(tmp_path / "none.vtu") == "cannot be read: No such file or directory"
    assert refused(tmp_path / "folder.toml") == "must be a file; got a folder"
    assert refused(tmp_path) == "must be a file; got a folder"
    assert refused(tmp_path / "cue.msh") == "must end in .toml, .csv, .vtk, .vtu, .stl, .ply or .obj; got '.msh'"


def test_a_file_without_permission(tmp_path: Path) -> None:
    path = tmp_path / "secret.toml"
    path.write_text(CUE)
    path.chmod(0)
    if os.access(path, os.R_OK):  # root reads everything: ask for a file that nobody can open
        path = tmp_path / f"{'n' * 300}.toml"
        assert refused(path) == "cannot be read: File name too long"
    else:
        assert refused(path) == "cannot be read: Permission denied"


@pytest.mark.parametrize(
    ("old", "new", "line"),
    [
        ("body_mass 1 1", "body_mess 1 1", "cell data body_mass: must be given, a number a cell; got ["),
        ("length 1 1 double\n0.7", "length 1 1 double\n0.8", "cell data length[0]: must be 0.7 m, the distance of the"),
        ("tip_diameter 1 1 double\n0.0", "tip_diameter 1 1 double\n-0.0", "cell 0: Segment.tip_diameter must be in ("),
        ("CELL_TYPES 1\n3", "CELL_TYPES 1\n5", "cells: must be lines alone; got ['triangle']"),
        ("DATASET", "DATTASET", "must be a .vtk mesh; got a file that meshio cannot read"),
    ],
)
def test_meshes(tmp_path: Path, old: str, new: str, line: str) -> None:
    (tmp_path / "cue.toml").write_text(CUE)
    path = tmp_path / "cue.vtk"
    cf.save(cf.load(tmp_path / "cue.toml"), path)
    content = path.read_text()
    assert old in content
    path.write_text(content.replace(old, new, 1))
    assert refused(path).startswith(line)


POINTS, FACES = revolved([(0, 0), (0, 0.006), (0.7, 0.0105), (0.7, 0)], 16)


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


@pytest.mark.parametrize("name", SURFACES)
def test_no_shaft(tmp_path: Path, name: str) -> None:
    points, faces, line = SURFACES[name]
    path = tmp_path / "shaft.ply"
    assert refused(written(path, points, faces, binary=False)).startswith(line)
    status, out, err = call("modes", path)
    assert (status, out) == (2, "")
    assert err.startswith(f"cuefem: {path}: {line}")


@pytest.mark.parametrize("unit", ["kg", "furlnog", "", "mm mm"])
def test_no_unit_of_length(tmp_path: Path, unit: str) -> None:
    path = written(tmp_path / "shaft.stl", POINTS, FACES)
    assert refused(path, length_unit=unit) == f"length unit: must be a unit of length, such as mm; got {unit!r}"


def test_options_are_for_the_files_that_lack_them(tmp_path: Path) -> None:
    path = tmp_path / "shaft.csv"
    path.write_text("x [mm],diameter [mm]\n0,12\n700,21\n")
    line = "names its units itself: length_unit is for a table without units; got 'mm'"
    assert refused(path, length_unit="mm") == line
    (tmp_path / "cue.toml").write_text(CUE)
    line = "has its own units of length: length_unit is for .csv, .stl, .ply and .obj files alone; got 'mm'"
    assert refused(tmp_path / "cue.toml", length_unit="mm") == line
    path = written(tmp_path / "shaft.stl", POINTS, FACES)
    assert refused(path, material="hard mapel").startswith("material: no material is called 'hard mapel'")


HEADER = "x [mm],diameter [mm]\n"
CONE = b'shaft = "conical taper"\nbody_mass = "15 oz"\n'
NO_FACES = "faces: must be triangles", "must be a ."
TOML: list[tuple[bytes, str]] = [
    (b"", "must hold a cue or a scene; got an empty file"),
    (b" \n\n", "must hold a cue or a scene; got an empty file"),
    (b"\xff\xfe\x00", "must be UTF-8 text; got byte 0xff"),
    (b"length = \n", "must be TOML; got a syntax error: Invalid value (at line 1, column 10)"),
    (b"a = 1\na = 2\n", "must be TOML; got a syntax error: Cannot overwrite a value (at line 2, column 6)"),
    (b"a = " + b"[" * 5000, "must be TOML nested less deeply"),
    (b"# nothing\n", "cue: must be given: [[segments]] make a cue, [cue] a scene; got neither"),
    (b"cue = 3\n", "cue: must be a table or the path of a cue file; got 3"),
    (b"cue = 'missing.toml'\n", "cue: missing.toml: cannot be read: No such file or directory"),
    (b"segments = []\n", "segments: must hold at least one Segment; got none, a cue without mass"),
    (b"[[segments]]\n", "segments[0].length: must be given"),
    (b"ball = 3\n[cue]\nmass = '540 g'\nend_mass = '6 g'\n", "ball: must be a table"),
    (
        b'shaft = "conical tapr"',
        "shaft: must be one of pro taper, conical taper, low deflection, carbon; got 'conical tapr'",
    ),
    (b'shaft = 3\nferrule = "25 mm melamine"', 'shaft: must be a text, such as "conical taper"; got 3'),
    (CONE + b'ferrule = "25 mm melamin"', "shaft: no material is called 'melamin'; nearest: melamine"),
    (CONE + b'material = "hard mapel"', "shaft: no material is called 'hard mapel'; nearest: hard maple"),
    (CONE + b'bore = "wide"', "shaft: bore must be a width and a depth"),
    (CONE + b"segments = []", "segments: must be left out beside shaft, which draws them"),
    (CONE + b'tip = "soft"', "tip: "),
]
PROFILES: list[tuple[str | bytes, str]] = [
    ("", "must hold a cue or a scene; got an empty file"),
    ("# x\n", 'must begin with the header "x [mm],diameter [mm]"; got comments alone'),
    (HEADER, "must hold at least 2 points; got 0"),
    (HEADER + "0,12\n", "must hold at least 2 points; got 1"),
    (HEADER + "0,12\n\n700,-21\n", "line 4, diameter: must be more than 0 and at most 10000 mm; got -21 mm"),
    (HEADER + "0,12\n700,0\n", "line 3, diameter: must be more than 0 and at most 10000 mm; got 0 mm"),
    (HEADER + "nan,12\n700,0\n", "line 2, x: must be a finite number of mm; got nan mm"),
    (
        "x,diameter\n0,12.75\n330,13.2\n736.6,21.5\n",
        'line 1: the columns have no unit: write "x [mm],diameter [mm]", if these are mm, or give --length-unit',
    ),
    (
        "x [mm],diameter\n0,0.5\n330,0.52\n736.6,0.85\n",
        "line 1: the column 'diameter' has no unit: write one in brackets, such as \"diameter [mm]\", or give --length",
    ),
    (
        "0,12.75\n330,13.2\n736.6,21.5\n",
        "line 1: must name the columns, such as \"x [mm],diameter [mm]\"; got numbers, '0,12.75'",
    ),
    (
        "a,b\n1,2\n3,4\n",
        "line 1: must name one column for the place along the shaft and one for the dia",
    ),
    (
        "x [mm],diameter [mm]\n0,0,12,75\n330,0,13,2\n736,6,21,5\n",
        "line 2: must have no more numbers than there are columns, 2; got '0,0,12,75'; where commas part the columns, "
        "write decimal points, or part the columns by semicolons",
    ),
    (b"PK\x03\x04" + bytes(60), "is a spreadsheet, not a .csv: in its program, save it as CSV"),
    (
        "distance from butt [mm],diameter [mm],bore [mm]\n0,21.5,\n736.6,12.75,6\n",
        "line 1, x: must run from tip to butt where a bore or a material stands beside it: each holds from its row on",
    ),
    (
        "x [mm],diameter [mm],bore [mm]\n736.6,21.5,\n0,12.75,6\n",
        "line 1, x: must run from tip to butt where a bore or a material stands beside it",
    ),
    (
        "x [mm],diameter [mm],bore\n0,12.75,6\n736.6,21.5,\n",
        "line 1: the column 'bore' has no unit: write one in brackets",
    ),
    (
        "x [mm],diameter [mm],bore [mm]\n0,12.75,12.75\n736.6,21.5,\n",
        "line 2, bore: must be less than 12.75 mm, the diameter there; got 12.75 mm",
    ),
    (
        "x [mm],diameter [mm],bore [mm]\n0,12.75,-6\n736.6,21.5,\n",
        "line 2, bore: must be 0 to 10000 mm; got -6 mm",
    ),
    (
        "x [mm],diameter [mm],material\n0,12.75,hard mapel\n736.6,21.5,\n",
        "line 2, material: no material is called 'hard mapel'; nearest: hard maple",
    ),
    (
        "x [mm],diameter 1 [mm],diameter 2 [mm]\n0,12.75,12.9\n736.6,21.5,21.4\n",
        "line 1: two columns may be the diameter, 'diameter 1 [mm]' and 'diameter 2 [mm]', and they differ: keep one",
    ),
    (
        "x [mm],diameter [mm]\n0,12.75\n736.6,21.5\n330,13.2\n",
        "line 4, x: must be beyond 736.6 mm, the x of the line before (points run from tip to butt); got '330 mm'",
    ),
    (
        "x [mm],diameter [mm]\n0,12.75\n25,12.75\n25,13\n736.6,21.5\n",
        "line 4, x: must be beyond 25 mm, the x of the line before (points run from tip to butt); got '25 mm'; a step "
        "in the diameter is two points a little apart, such as 25 and 25.1 mm",
    ),
    (
        "x [mm],diameter [mm]\n0,12.75\n330,about 13\n736.6,21.5\n",
        "line 3, diameter: must be a number; got 'about 13'",
    ),
    ("x [mm],diameter [mm]\n0,12.75\n330,\n736.6,21.5\n", "line 3, diameter: must be a number; got nothing"),
    (
        "x [mm];diameter [mm]\n0;12.75\n330,5;13.2\n736.6;21.5\n",
        "line 3, x: must be written with the decimal point of the other numbers; got '330,5'",
    ),
    (
        "x [kg],diameter [mm]\n0,12\n700,21\n",
        "line 1, x: must be in a unit of length, such as mm; got 'kg'",
    ),
    ("x [mm],diameter [mm]\n0," + 200_000 * "1" + "\n", "line 2: must be shorter; got "),
    (
        b"\x89PNG\r\n\x1a\n" + bytes(range(256)),
        "must be text, a table of numbers; got a file of another kind",
    ),
]
SURFACE_FILES: list[tuple[str, bytes, str | tuple[str, str]]] = [
    ("shaft.stl", b"", NO_FACES),
    ("shaft.stl", b"x" * 200, NO_FACES),
    ("shaft.stl", b"solid nothing\nendsolid nothing\n" + 90 * b" ", NO_FACES),
    ("shaft.ply", b"ply\nformat ascii 1.0\nend_header\n", NO_FACES),
    ("shaft.ply", b"ply\nformat ascii 1.0\nelement vertex 3\n", "must be a .ply surface; got a file that meshio"),
    ("shaft.ply", b"solid\n", "must be a .ply surface; got a file that meshio cannot read"),
    ("shaft.obj", b"v 0 0 0\nv 1 0 0\nv 0 1 0\n", NO_FACES),
    ("shaft.obj", b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\n", "faces: must name corners in [0, 3); got another"),
    ("shaft.obj", b"v 0 0 0\nv 1 0 0\nf 1 2\n", "faces: must have three corners or more; got one of fewer"),
    ("shaft.stl", SIGNALLING, "corners: must be finite x, y, z; got others"),
    ("shaft.obj", b"v 0 0 0\nv 1 nan 0\nv 0 1 0\nf 1 2 3\n", "corners: must be finite x, y, z; got others"),
]
FILES = [
    *(("file.toml", content, line) for content, line in TOML),
    *(("shaft.csv", c if isinstance(c, bytes) else c.encode(), line) for c, line in PROFILES),
    *SURFACE_FILES,
]


@pytest.mark.parametrize(("name", "content", "line"), FILES)
def test_contents(tmp_path: Path, name: str, content: bytes, line: str | tuple[str, str]) -> None:
    path = tmp_path / name
    path.write_bytes(content)
    said = refused(path)
    assert said.replace(f"{tmp_path}/", "").startswith(line)
    assert call("modes", path) == (2, "", f"cuefem: {path}: {said}\n")
