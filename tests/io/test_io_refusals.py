"""Every bad file in one clear line: file, key path, bound with unit, value got (regression)."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

import cuefem as cf
from cuefem.io import InputError

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
    (CUE, '"700 mm"', '"-700 mm"', "segments[0].length: must be in (0, 1000] m; got '-700 mm'"),
    (CUE, '"700 mm"', '"0 mm"', "segments[0].length: must be in (0, 1000] m; got '0 mm'"),
    (CUE, '"700 mm"', '"nan mm"', "segments[0].length: must be in (0, 1000] m; got 'nan mm'"),
    (CUE, '"700 mm"', '"inf mm"', "segments[0].length: must be in (0, 1000] m; got 'inf mm'"),
    (CUE, '"700 mm"', '"1e999 mm"', "segments[0].length: must be in (0, 1000] m; got '1e999 mm'"),
    (CUE, '"700 mm"', '"1e-999 mm"', "segments[0].length: must be in (0, 1000] m; got '1e-999 mm'"),
    (CUE, '"700 mm"', "700", f"segments[0].length: must be in (0, 1000] m, {LENGTH}; got 700"),
    (CUE, '"700 mm"', '"700"', f"segments[0].length: must be in (0, 1000] m, {LENGTH}; got '700'"),
    (CUE, '"700 mm"', '"mm"', f"segments[0].length: must be in (0, 1000] m, {LENGTH}; got 'mm'"),
    (CUE, '"700 mm"', '"700 g"', f"segments[0].length: must be in (0, 1000] m, {LENGTH}; got '700 g'"),
    (CUE, '"700 mm"', '"700 mmm"', f"segments[0].length: must be in (0, 1000] m, {LENGTH}; got '700 mmm'"),
    (CUE, '"700 mm"', '"700 m^9^9^9^9"', f"segments[0].length: must be in (0, 1000] m, {LENGTH}; got '700 m^9^9^9^9'"),
    (CUE, '"700 mm"', "true", f"segments[0].length: must be in (0, 1000] m, {LENGTH}; got True"),
    (CUE, '"700 mm"', "[]", f"segments[0].length: must be in (0, 1000] m, {LENGTH}; got []"),
    (CUE, 'length = "700 mm"\n', "", f"segments[0].length: must be given, in (0, 1000] m, {LENGTH}; got nothing"),
    (CUE, '"12 mm"', '"-12 mm"', "segments[0].tip_diameter: must be in (0, 10] m; got '-12 mm'"),
    (CUE, '"21 mm"', '"0 in"', "segments[0].butt_diameter: must be in (0, 10] m; got '0 in'"),
    (CUE, '"3 mm"', '"13 mm"', "segments[0].tip_bore: must be in [0, 0.012) m, its outer diameter; got 0.013"),
    (CUE, "kappa = 0.9", "kappa = 1.5", "segments[0].kappa: must be in (0, 1]; got 1.5"),
    (CUE, "kappa = 0.9", "kappa = nan", "segments[0].kappa: must be in (0, 1]; got nan"),
    (CUE, "kappa = 0.9", 'kappa = "0.9"', "segments[0].kappa: must be a bare number in (0, 1]; got '0.9'"),
    (CUE, "kappa = 0.9", f"kappa = {'9' * 400}", f"segments[0].kappa: must be in (0, 1]; got {'9' * 57}..."),
    (CUE, '"420 g"', '"-1 g"', "body_mass: must be in [0, inf) kg; got '-1 g'"),
    (CUE, '"12.6 GPa"', '"0 GPa"', "segments[0].material.E: must be in (0, inf) Pa; got '0 GPa'"),
    (
        CUE,
        '"840 MPa"',
        '"84 GPa"',
        "segments[0].material.G: must be in (0, 21000000000.0) Pa, E/(2 nu) of E = 12600000000.0 Pa, nu = 0.3; got",
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
        "segments[0].material.Rho: must be one of the keys E, G, rho, loss, nu; got Rho = '782 kg/m^3'; "
        "did you mean 'rho'?",
    ),
    (
        CUE,
        "body_mass",
        "bodymass",
        "bodymass: must be one of the keys segments, body_mass; got bodymass = '420 g'; did you mean 'body_mass'?",
    ),
    (
        CUE,
        "[[segments]]",
        "[[segment]]",
        "segment: must be one of the keys segments, cue, ball, tip, stroke, effects, accuracy; got segment = "
        "[{'length': '700 mm', 'tip_diameter': '12 mm', 'butt_diam...; did you mean 'segments'?",
    ),
    (CUE, "[[segments]]", "[segments]", "segments: must be an array of tables; got {'length': '700 mm'"),
    (CUE, '{ E = "12.6 GPa"', '"hard mapel" #', "segments[0].material: "),
    (CUE, "kappa = 0.9", "core = 3", "segments[0].core: must be a table with the keys E, G, rho, loss, nu"),
    (SCENE, "0.3", "1.5", "stroke.offset: must be in (-1, 1); got 1.5"),
    (SCENE, "0.3", "-1", "stroke.offset: must be in (-1, 1); got -1"),
    (SCENE, "0.3", "nan", "stroke.offset: must be in (-1, 1); got nan"),
    (SCENE, '"1 ms"', '"1 mm"', 'tip.contact_time: must be in [1e-6, 10] s, a time with its unit, such as "1.2 ms"'),
    (SCENE, '"1 ms"', '"1 ms"\nstiffness = "1e5 N/m"', "tip: Tip takes contact_time (s) or stiffness (N/m)"),
    (SCENE, "[ball]", "[bal]", "bal: must be one of the keys segments, cue, ball, tip, stroke, effects, accuracy; got"),
    (SCENE, "[ball]", "[accuracy]\nrtol=2\n[ball]", "accuracy.rtol: must be in (0, 1); got 2"),
    (SCENE, "[ball]", "[accuracy]\nrtl=2\n[ball]", "accuracy.rtl: must be one of the keys rtol; got rtl = 2"),
    (SCENE, "[cue]", "[cue]\ncoupling = '99 1/kg'", "cue.coupling: must be in ("),
    (SCENE, 'mass = "540 g"\n', "", "cue.mass: must be given, in (0, inf) kg, a mass with its unit"),
    (SCENE, "[cue]", "effects = 3\n[cue]", "effects: must be an array"),
    (SCENE, "[cue]", "effects = [{}]\n[cue]", "effects[0].type: must be one of "),
    (SCENE, "[cue]", "effects = [{type = 'PontMass'}]\n[cue]", "effects[0].type: must be one of "),
    (
        SCENE,
        "[cue]",
        "effects = [{type = 'Support', position = '8 in', stiffness = '1e999 N/m'}]\n[cue]",
        "effects[0].stiffness: must be in [0, inf] N/m; got '1e999 N/m'",
    ),
    (SCENE, "[cue]", "cue = 3\n[cew]", "cew: must be one of the keys"),
    (
        CUE,
        '"12 mm"',
        '"20,5 mm"',
        f"segments[0].tip_diameter: must be in (0, 10] m, {LENGTH}; got '20,5 mm'; a decimal",
    ),
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


def refused(path: Path) -> str:
    with pytest.raises(InputError) as caught:
        cf.load(path)
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


@pytest.mark.parametrize(
    ("content", "line"),
    [
        (b"", "must hold a cue or a scene; got an empty file"),
        (b" \n\n", "must hold a cue or a scene; got an empty file"),
        (b"\xff\xfe\x00", "must be UTF-8 text; got byte 0xff"),
        (b"length = \n", "must be TOML; got a syntax error: Invalid value (at line 1, column 10)"),
        (b"a = 1\na = 2\n", "must be TOML; got a syntax error: Cannot overwrite a value (at line 2, column 6)"),
        (b"a = " + b"[" * 5000, "must be TOML nested less deeply"),
        (b"# nothing\n", "cue: must be given: [[segments]] make a cue, [cue] a scene; got neither"),
        (b"cue = 3\n", "cue: must be a table or the path of a cue file; got 3"),
        (b"cue = 'missing.toml'\n", None),
        (b"segments = []\n", "segments: must hold at least one Segment; got none, a cue without mass"),
        (b"[[segments]]\n", "segments[0].length: must be given"),
    ],
)
def test_no_file_to_read(tmp_path: Path, content: bytes, line: str | None) -> None:
    path = tmp_path / "file.toml"
    path.write_bytes(content)
    if line is None:
        with pytest.raises(InputError, match=r"missing.toml: cannot be read: No such file or directory"):
            cf.load(path)
    else:
        assert refused(path).startswith(line)


def test_a_scene_is_no_cue_of_a_scene(tmp_path: Path) -> None:
    path = tmp_path / "file.toml"
    path.write_text("cue = 'file.toml'\n")
    assert refused(path).startswith("cue: must be absent here: a scene's cue is a cue file")


def test_no_file_at_all(tmp_path: Path) -> None:
    (tmp_path / "folder.toml").mkdir()
    assert refused(tmp_path / "none.toml") == "cannot be read: No such file or directory"
    assert refused(tmp_path / "none.vtu") == "cannot be read: No such file or directory"
    assert refused(tmp_path / "folder.toml") == "cannot be read: Is a directory"
    assert refused(tmp_path) == "cannot be read: it is a folder"
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


HEADER = "x [mm],diameter [mm]\n"


@pytest.mark.parametrize(
    ("content", "line"),
    [
        ("", "must hold a cue or a scene; got an empty file"),
        ("# x\n", 'must begin with the header "x [mm],diameter [mm]"; got comments alone'),
        ("0,12\n700,21\n", "line 1: must be the header \"x [mm],diameter [mm]\"; got '0,12'"),
        ("x,diameter\n0,12\n", "line 1: must be the header \"x [mm],diameter [mm]\"; got 'x,diameter'"),
        ("x [kg],diameter [mm]\n0,12\n", "line 1, x: must be in a unit of length, such as mm; got 'kg'"),
        (
            "x [mm];diameter [mm]\n0;12\n",
            "line 1: must be the header \"x [mm],diameter [mm]\"; got 'x [mm];diameter [mm]'; commas part the columns",
        ),
        (HEADER + "0;12\n700;21\n", "line 2: must be two numbers, x and diameter; got '0;12'; commas part the columns"),
        (
            HEADER + "0,12,5\n",
            "line 2: must be two numbers, x and diameter; got '0,12,5'; commas part the columns, numbers",
        ),
        (HEADER, "must hold at least 2 points; got 0"),
        (HEADER + "0,12\n", "must hold at least 2 points; got 1"),
        (HEADER + "0,12\n350\n", "line 3: must be two numbers, x and diameter; got '350'"),
        (HEADER + "0,12\n700,wide\n", "line 3, diameter: must be in (0, 10] m, a length"),
        (HEADER + "0,12\n\n700,-21\n", "line 4, diameter: must be in (0, 10] m; got '-21 mm'"),
        (HEADER + "0,12\n700,0\n", "line 3, diameter: must be in (0, 10] m; got '0 mm'"),
        (HEADER + "nan,12\n700,0\n", "line 2, x: must be in (-inf, inf) m; got 'nan mm'"),
        (
            HEADER + "0,12\n700,21\n350,16\n",
            "line 4, x: must be in (700, inf) mm, beyond the line before (points run from tip to butt); got '350 mm'",
        ),
        (HEADER + "0,12\n0,21\n", "line 3, x: must be in (0, inf) mm, beyond the line before"),
    ],
)
def test_profiles(tmp_path: Path, content: str, line: str) -> None:
    path = tmp_path / "shaft.csv"
    path.write_text(content)
    assert refused(path).startswith(line)


@pytest.mark.parametrize(
    ("old", "new", "line"),
    [
        ("body_mass 1 1", "body_mess 1 1", "cell data body_mass: must be given, a number a cell; got ["),
        ("length 1 1 double\n0.7", "length 1 1 double\n0.8", "cell data length[0]: must be 0.7 m, the distance of the"),
        (
            "tip_diameter 1 1 double\n0.0",
            "tip_diameter 1 1 double\n-0.0",
            "cell 0: Segment.tip_diameter must be in (",
        ),
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
