"""Invalid files: one line with file, key path and limit (bad input).

Every declared field of every table: tests/quantity/test_declared_fields.py.
"""

import struct
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

import cuefem as cf
from cuefem.designs import Levels, Response, Study, Vary
from cuefem.designs.store import SqliteStore
from cuefem.files import InputError
from tests.helpers.command_line import call
from tests.helpers.surfaces import revolve, write_surface


def rejection(path: Path, **options: str) -> str:
    with pytest.raises(InputError) as caught:
        cf.load(path, **options)
    text = str(caught.value)
    assert text.startswith(f"{path}: ")
    assert len(text.splitlines()) == 1
    return text.removeprefix(f"{path}: ").replace(f"{path.parent}/", "")


POINTS, FACES = revolve([(0, 0), (0, 0.006), (0.7, 0.0105), (0.7, 0)], 16)
# One error a line: file extension, content (H is the header of a profile), and the first words of the message.
CONTENTS = r"""
toml |                                      | must hold text or a table; got an empty file
toml | a = 1\na = 2\n                       | must be TOML; got a syntax error: Cannot overwrite a value (at line 2
toml | [[segments]]\nlength = 700 mm        | must be TOML; got a syntax error: Expected newline or end of document
toml | \xff\xfe                             | must hold text or a table; got an empty file
toml | # nothing                            | cue: must be given: [[segments]] make a cue, [cue] a scene; got nei
toml | cue = 3                              | cue: must be a table or the path of a cue file; got 3
toml | cue = 'x.toml'                       | cue: must be absent: the cue of a scene is a cue file
toml | cue = 'none.toml'                    | cue: none.toml: cannot be read: No such file or directory
toml | segments = []                        | segments: must hold at least one Segment; got none
toml | [segments]\nx = 1                    | segments: must be an array of tables, with [[ ]]; got {'x': 1}
toml | [accuracy]\nrtol = 2\n[cue]\nmass = '1 kg'\nend_mass = '6 g' | accuracy.rtol: must be between 0 and 1; got 2
toml | game = 'snoker'\n[cue]               | game: must be one of pool, carom, snooker, kim; got 'snoker'; did
toml | effects = 3\n[cue]\nmass = '1 kg'    | cue.end_mass: must be given
toml | effects = [{type = 'P'}]\n[cue]\nmass = '1 kg'\nend_mass = '6 g' | effects[0].type: must be one of
toml | [ball]\ndiameter = '6 mm'\n[cue]\nmass = '1 kg'\nend_mass = '6 g' | ball.diameter: unknown key;
toml | [cue]\nmass = '540 g'\nend_mass = '6 g'\ncoupling = '99 1/kg'     | cue.coupling: must be in (
toml | [tip]\ncontact_time = '1 ms'\nstiffness = '1e5 N/m'\n[cue]\nmass = '1 kg'\nend_mass = '6 g' | tip: Tip takes
toml | shaft = 3                            | shaft: must be text; got 3
toml | shaft = 'carbon'\nbody_mass = '15 oz'\nbore = 'wide' | shaft: bore: must be a width and a depth
toml | shaft = 'carbon'\nbody_mass = '15 oz'\nsegments = [] | segments: must be omitted with shaft, which defines
csv  |                                      | must hold text or a table; got an empty file
csv  | # x                                  | must begin with the header "x [mm],diameter [mm]"; got only
csv  | H0,12                                | must hold at least 2 points; got 1
csv  | H0,12\n\n700,-21                     | line 4, diameter: must be more than 0 and at most 10000 mm; got -21
csv  | Hnan,12\n700,1                       | line 2, x: must be a finite number of mm; got nan mm
csv  | H0,0,12,75\n330,0,13,2               | line 2: must have at most as many cells as the header, 2; got
csv  | H0,12.75\n736.6,21.5\n330,13.2       | line 4, x: must be beyond 736.6 mm, the x of the line before
csv  | H0,12.75\n330,about 13               | line 3, diameter: must be a number; got 'about 13'
csv  | x,diameter\n0,12.75\n700,21.5        | line 1: 'x,diameter' must name the unit: write "x [mm],diameter [mm]"
csv  | x [mm],diameter\n0,12.75\n700,21.5   | line 1: 'diameter' must name the unit: write "diameter [mm]"
csv  | 0,12.75\n700,21.5                    | line 1: must name a column for the position
csv  | x [mm],diamter [mm]\n0,12\n700,21    | line 1: must name a column for the position
csv  | a,b\n1,2                             | line 1: must name a column for the position along the shaft
csv  | x [mm],weight [g]\n0,12\n700,21       | line 1: must name a column for the position
csv  | no.,diameter [mm]\n0,12\n700,21       | line 1: must name a column for the position
csv  | x [mm],diameter [mm],Wandstärke\n0,12,3 | line 1: column 'Wandstärke' is a wall thickness: write a column bore
csv  | x [mm],diameter [mm],ferrule\n0,12,\n20,12,5 mm abs\n700,21, | line 3, ferrule: with a length must be the
csv  | x [kg],diameter [mm]\n0,12           | line 1, x: must be in a unit of length, such as mm; got 'kg'
csv  | x [mm],diameter 1 [mm],diameter 2 [mm]\n0,12.75,12.9\n700,21,22 | line 1: two columns may be the diameter,
csv  | x [mm],diameter [mm],bore [mm],hole [mm]\n0,12,6,7\n700,21,6,7 | line 1: two columns may be the bore, 'bore
csv  | x [mm],diameter [mm],material,wood\n0,12,ash,maple\n700,21, | line 1: two columns may be the material,
csv  | x [mm],diameter [mm],bore [mm]\n700,21,\n0,12,6  | line 1, x: must increase from tip to butt: bores and
csv  | x [mm],diameter [mm],bore [mm]\n0,12,12\n700,21, | line 2, bore: must be less than 12 mm, the diameter there;
csv  | x [mm],diameter [mm],bore [mm]\n0,12,6\n7,12,6\n7,12,5\n7,12,4\n700,21, | line 5, x: must have at most two rows
csv  | x [mm],diameter [mm],material\n0,12,hard mapel\n700,21, | line 2, material: unknown material 'hard mapel'
csv  | x [mm],diameter [mm],bor [mm]\n0,12,6\n700,21, | line 1: column 'bor [mm]' is unknown; did you mean 'bore'?
csv  | x [mm],diameter [mm],materail\n0,12,ash\n700,21, | line 1: column 'materail' is unknown; did you mean 'material'?
csv  | x [mm],diameter [mm],Ferule\n0,12,abs\n700,21, | line 1: column 'Ferule' is unknown; did you mean 'ferrule'?
csv  | x [mm],diameter [mm]\n0,12.4\n330,131\n700,21.3 | line 3, diameter: 131 mm between 12.4 and 21.3: decimal point?
csv  | x [mm],diameter [mm]\n0,12.4\nmass,104 g\n700,21.3 | line 3, x: must be a number; got 'mass'
csv  | x [mm],diameter [mm]\n0,12.4\n700,21.3\nl0,21 | line 4, x: must be a number; got 'l0'
toml | cue.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a = 1 | line 1: must have keys of at most 32
csv  | x [mm],diameter [mm],core\n0,12.75,foam\n736.6,21.5,foam | line 2, core: needs a bore in its row
csv  | x [mm],radius [mm],inner radius (mm)\n0,6.4,3\n700,10, | line 1, bore: must be a column of diameters
csv  | x [mm];diameter [mm]\n0;12.75\n330,5;13     | line 3, x: must be written with the decimal point of the other
csv  | PK\x03\x04xxxx                       | is a spreadsheet: export it as CSV
csv  | \x89PNG\r\n\x1a\n\x00\x01\x02        | must be text; got a file of another kind
stl  |                                      | faces: must be triangles or polygons; got none
ply  | solid                                | must be a .ply surface; got a file that meshio cannot read
obj  | v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9   | faces: must refer to corners in [0, 3); got another
obj  | v 0 0 0\nv 1 0 0\nf 1 2              | faces: must have at least three corners; got a face
obj  | v 0 0 0\nv 1 nan 0\nv 0 1 0\nf 1 2 3 | corners: must be finite x, y, z; got other
"""


@pytest.mark.parametrize("row", CONTENTS.strip().splitlines())
def test_load_invalid_content_is_rejected(tmp_path: Path, row: str) -> None:
    end, content, line = (cell.strip() for cell in row.split("|"))
    path = tmp_path / f"x.{end}"
    text = content.encode().decode("unicode_escape").encode("latin-1")
    path.write_bytes(b"x [mm],diameter [mm]\n" + text[1:] if text.startswith(b"H") else text)
    message = rejection(path)
    assert message.startswith(line), message
    assert call("modes", path)[:2] == (2, "")


BAR = revolve([(0, 0), *((x, 0.006) for x in np.linspace(0, 0.7, 30)), (0.7, 0)], 16)
SURFACES = {
    "must be closed": (POINTS, FACES[1:]),
    "must have consistently oriented triangles": (POINTS, np.concatenate([FACES[:20], FACES[20:21, ::-1], FACES[21:]])),
    "must enclose a volume": (POINTS, np.concatenate([FACES[:8], FACES[:8, ::-1]])),
    "must be slender, at least 5 times": revolve([(0, 0), (0, 0.02), (0.15, 0.02), (0.15, 0)], 16),
    "must be round, second moments": (BAR[0] * (1, 1.05, 1), BAR[1]),
    "must be round, its second moment within 2 % of a disc's; got a section 4.7 %": revolve(
        [(0, 0), (0, 0.006), (0.7, 0.006), (0.7, 0)], 4
    ),
    "must be straight": (BAR[0] + 0.003 * np.outer(BAR[0][:, 0] ** 2, (0, 0, 1)), BAR[1]),
    "must have one outer outline": (
        np.concatenate([POINTS, POINTS + np.array([0, 0.03, 0])]),
        np.concatenate([FACES, FACES + len(POINTS)]),
    ),
}


@pytest.mark.parametrize("line", SURFACES)
def test_load_surface_that_is_not_a_shaft_is_rejected(tmp_path: Path, line: str) -> None:
    assert rejection(write_surface(tmp_path / "shaft.ply", *SURFACES[line], binary=False)).startswith(line)


def test_load_signalling_nan_in_surface_is_rejected(tmp_path: Path) -> None:
    triangle = struct.pack("<I", 1) + bytes(12) + struct.pack("<I", 0x7F80FF00) + bytes(34)
    (tmp_path / "shaft.stl").write_bytes(bytes(80) + triangle)
    assert rejection(tmp_path / "shaft.stl").startswith("corners: must be finite")


KIM = cf.load(Path(__file__).parents[2] / "meshes" / "kim.toml")


def open_store(path: Path) -> None:
    with SqliteStore(path, Study(cf.Scene(KIM), (Vary(("ball.mass",), Levels((0.16, 0.17))),), (Response("squirt"),))):
        pass


@pytest.mark.parametrize("open_file", [cf.load, lambda path: cf.save(KIM, path), open_store])
def test_path_with_null_character_is_rejected(open_file: Callable[[Path], object]) -> None:
    """In words that do not depend on the version of Python."""
    with pytest.raises(InputError, match=r"^a\\x00.toml: must be a path without null characters$"):
        open_file(Path("a\0.toml"))


def test_load_missing_file_or_foreign_option_is_rejected(tmp_path: Path) -> None:
    (tmp_path / "folder.toml").mkdir()
    for name in ("none.toml", "none.stl"):
        assert rejection(tmp_path / name) == "cannot be read: No such file or directory"
    assert rejection(tmp_path / "folder.toml") == rejection(tmp_path) == "must be a file; got a folder"
    assert rejection(tmp_path / "cue.vtu").startswith("must end in .toml, .csv, .stl")
    shaft = write_surface(tmp_path / "shaft.stl", POINTS, FACES)
    for unit in ("kg", "1/2 in"):
        assert rejection(shaft, length_unit=unit).startswith("length_unit: must be a unit of length")
    for name in ("shaft.xlsx", "shaft.txt"):
        (tmp_path / name).write_bytes(b"PK\x03\x04")
        assert rejection(tmp_path / name).endswith("save the table as .csv")
    assert rejection(shaft, material="hard mapel").startswith("material: unknown material 'hard mapel'")
    (tmp_path / "shaft.csv").write_text("x [mm],diameter [mm]\n0,12\n700,21\n")
    assert rejection(tmp_path / "shaft.csv", length_unit="mm").startswith("already names its units")
