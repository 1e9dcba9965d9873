"""Bad input to a command: status 2, one line on stderr, no traceback, nothing on stdout, no file (regression)."""

from __future__ import annotations

import os
import shlex
import subprocess
import sys
from pathlib import Path

import pytest

import cuefem as cf
from cuefem.cue.materials import material
from tests.helpers.command_line import call
from tests.helpers.refusals import untouched

GOOD = """
[[segments]]
length = "700 mm"
tip_diameter = "12 mm"
butt_diameter = "21 mm"
tip_bore = "3 mm"
butt_bore = "4 mm"
material = { E = "12.6 GPa", G = "840 MPa", rho = "782 kg/m^3" }
"""
CSV = "x [mm],diameter [mm]\n"
SHAFT = cf.Cue((cf.Segment(0.7, 0.0118, 0.021, material("hard maple")),), 0.42)
FILES = {
    "good.toml": GOOD,
    "bad.toml": GOOD.replace("700 mm", "-700 mm"),
    "inn.toml": GOOD.replace("700 mm", "28 inn"),
    "lumped.toml": "game = 'kim'\n[cue]\nmass = '540 g'\nend_mass = '6 g'\n",
    "empty.toml": "",
    "off.toml": "cue = 'good.toml'\n[[effects]]\ntype = 'PointMass'\nposition = '29 in'\nmass = '5 g'\n",
    "of_none.toml": "cue = 'none.toml'\n",
    "of_bad.toml": "cue = 'bad.toml'\n",
    "bare.csv": CSV + "0,12\n700,21\n",
    "back.csv": CSV + "0,12\n700,21\n350,16\n",
    "headless.csv": "0,12\n700,21\n",
    **{f"kept.{suffix}": "somebody's work" for suffix in ("toml", "vtk", "vtu")},
}
SAVED = {
    "shaft.toml": SHAFT,
    "spring.toml": cf.Scene(SHAFT, stroke=cf.Stroke(offset=0.3)),
    "leather.toml": cf.usual_scene(SHAFT),
}
# Commands on these files, each with a part of the one line that says why they are refused.
COMMANDS = [
    # numbers and their units
    ("strike good.toml --offset 1", "good.toml: --offset: must be between -1 and 1; got 1.0"),
    ("strike good.toml --offset nan", "good.toml: --offset: must be between -1 and 1; got nan"),
    ("strike good.toml --offset half", "good.toml: --offset: must be a bare number, between -1 and 1, b/R, or a lengt"),
    ("strike shaft.toml --offset 0,3", "or a length such as \"8 mm\"; got '0,3'; a decimal point, no comma"),
    ("strike shaft.toml --offset '8 kg'", "b/R, or a length such as \"8 mm\"; got '8 kg'"),
    ("strike shaft.toml --offset '40 mm'", "1, or a length of less than 28.575 mm, the radius of the ball; got '40 mm"),
    ("strike shaft.toml --restitution 2", "shaft.toml: --restitution: must be 0 to 1; got 2.0"),
    ("strike shaft.toml --speed fast", "cuefem: shaft.toml: --speed: must be a speed with its unit, such as"),
    ("strike shaft.toml --speed 1e400", "a number that is not so large, with its unit; got 1e400"),
    ("end-mass good.toml --speed 2", '--speed: needs a unit: "4.5 mph" or'),
    ("report good.toml --speed '2 mm'", "--speed: must be a speed with its unit, such"),
    ("report good.toml --body-mass '-1 oz'", "good.toml: --body-mass: must be 0 oz or more; got -1 oz"),
    ("modes good.toml --near -250", "good.toml: --near: must be 0 Hz or more, such as 250 or \"0.25 kHz\"; got '-250'"),
    ("modes good.toml --near '3 mm'", "--near: must be 0 Hz or more, such as"),
    # the tip and the game
    ("report shaft.toml --game chess", "'chess' is not one of 'pool', 'carom', 'snooker' (`"),
    ("strike spring.toml --game pool", "--game: must be left out: FILE is a scene"),
    ("strike spring.toml --dome dime", "--dome: must be left out: the scene has no LeatherTip among its effects"),
    ("strike lumped.toml --leather soft", "--leather: must be left out: the scene has no LeatherTip"),
    ("strike shaft.toml --dome penny", 'such as "12 mm", or "dime", "nickel", "flat"; got \'penny\''),
    ("strike shaft.toml --leather sofd", "\"kamui hard\", ...; got 'sofd'"),
    ("strike shaft.toml --restitution 0.05", "Tip.restitution must be in [0.1, 1] beside LeatherTip; got 0.05: leathe"),
    ("modes shaft.toml --tip-height 40mm", "got 40 mm (--tip-height, --dome change it)"),
    ("strike leather.toml --tip-height 40mm", " mm high; got 40 mm"),
    ("strike shaft.toml --leather 1MPa", "further than its law is known"),
    ("strike shaft.toml --leather 1MPa", "(--tip-height, --leather, --speed)"),
    ("strike leather.toml --leather '0 MPa'", "--leather: must be more than 0 MPa; got 0 MPa"),
    # the drawing, and what is said beside it
    ("modes lumped.toml --material ash", "is a lumped cue, which has no material, ferrule, bore or body"),
    ("modes good.toml --begins ferrule", "has its own leather: begins is for .csv, .stl, .ply and .obj files alone; g"),
    ("modes bare.csv --begins leather", 'begins must be "ferrule" or the leather with its height, such as "leather 6 '),
    ("modes bare.csv --begins 'leather 40 mm'", "begins must have at most 30 mm of leather; got 'leather 40 mm'"),
    ("modes bare.csv --ferrule melamine", 'ferrule must be a length and a material, such as "25 mm melamine"; got'),
    ("modes bare.csv --ferrule '25 mm'", 'ferrule must be a length and a material, such as "25 mm melamine"; got'),
    ("modes bare.csv --ferrule '25 mm cheese'", "no material is called 'cheese'; "),
    ("modes bare.csv --ferrule '70 mm abs'", "ferrule must be at most 60 mm long; got '70 mm abs'"),
    ("modes bare.csv --ferrule '25 mm abs, tenon 14 mm'", "must be "),
    ("modes bare.csv --ferrule '25 mm abs, glued'", 'ferrule must be such as "25 mm melamine, tenon 8 mm" or "25 mm'),
    ("modes bare.csv --bore '6 mm'", 'bore must be a width and a depth, such as "6 mm wide, 127 mm deep"; got'),
    ("modes bare.csv --bore '6, 127 mm'", "bore must have lengths above 0 with a unit, "),
    ("modes bare.csv --bore '15 mm wide, 127 mm deep'", "the bore must be narrower than the cue, 12 mm there; got"),
    ("modes bare.csv --bore '6 mm wide, 2 m deep'", "the bore must be at most 700 mm deep; got 2000 mm"),
    ("modes back.csv", "back.csv: line 4, x: must be beyond 700 mm, the x of the line before"),
    ("modes headless.csv", 'headless.csv: line 1: must name the columns, such as "x [mm],diameter [mm]"'),
    ("modes bare.csv --material 'hard mapel'", "hard maple"),
    ("modes bare.csv --material 'hard mapel'", "see `cuefem parts`"),
    ("modes lumped.toml", "lumped.toml: Scene.cue must be a Cue of segments: its modes or its shape are needed; got"),
    ("modes lumped.toml --body-mass '1 kg'", "lumped.toml: --body-mass: must be left out: a lumped cue is whole"),
    ("convert lumped.toml out.toml --body-mass '1 kg'", "--body-mass: must be left out: a lumped cue is whole"),
    # files
    ("strike of_none.toml", "of_none.toml: cue: none.toml: cannot be read: No such file or directory"),
    ("strike of_bad.toml", "cuefem: bad.toml: segments[0].length: must be more than 0"),
    ("modes bad.toml", "bad.toml: segments[0].length: must be more than 0 and at most 1000 m; got -700 mm"),
    ("modes inn.toml", "a length with its unit, such as \"12 mm\"; got '28 inn': no unit is called 'inn'; did you"),
    *(
        (f"{command} off.toml", "cuefem: off.toml: effects[0].position: must be 0 to 700 mm, on the cue; got 736.6 mm")
        for command in ("strike", "effects", "report", "report -o page.html")
    ),
    ("report empty.toml", "cuefem: empty.toml: must hold a cue or a scene; got an empty file"),
    ("strike nowhere.toml", "cuefem: nowhere.toml: cannot be read: No such file or directory"),
    *(
        (f"convert bad.toml out.{kind}", "cuefem: bad.toml: segments[0].length: must ")
        for kind in ("toml", "vtk", "vtu")
    ),
    *((f"convert good.toml kept.{kind}", "is there already: --force replaces it") for kind in ("toml", "vtk", "vtu")),
    ("modes shaft.toml -o none/modes.html", "cuefem: none/modes.html: cannot be written: No such file or directory"),
    ("study none.toml -o x.sqlite", "--store names the file that keeps designs"),
    # wrong use
    ("strike", "--help` lists the options)"),
    ("nonsense", "--help` lists the options)"),
    ("--frog", "--frog"),
    ("modes shaft.toml --count 0", "--help` lists the options)"),
    ("strike shaft.toml --offset", "Option '--offset' requires an argument"),
]


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Everything that these commands are called on; each leaves it as it is."""
    folder = tmp_path_factory.mktemp("refused")
    for name, content in FILES.items():
        (folder / name).write_text(content)
    for name, thing in SAVED.items():
        cf.save(thing, folder / name)
    (folder / "empty").mkdir()
    return folder


@pytest.mark.parametrize(("command", "message"), COMMANDS)
def test_commands(folder: Path, monkeypatch: pytest.MonkeyPatch, command: str, message: str) -> None:
    monkeypatch.chdir(folder)
    untouched(folder, message, *shlex.split(command))


@pytest.mark.parametrize(
    ("file", "options"),
    [
        ("LONG = 1", []),
        ('cue = "x.toml"\n"\\u001b[31mLONG" = 1', []),
        ('[[segments]]\nlength = "DIGITS mm"', []),
        ('[[segments]]\nmaterial = "\\u001b[31m LONG"', []),
        (GOOD, ["--material", "\x1b[31mLONG"]),
        (GOOD, ["--leather", "\x1b[31m LONG"]),
        (GOOD, ["--game", "\x1b[31mLONG"]),
        (GOOD, ["--near\x1b[31mLONG"]),
    ],
)
def test_what_is_echoed_is_short_and_printable(file: str, options: list[str], tmp_path: Path) -> None:
    path = tmp_path / "x.toml"
    path.write_text(file.replace("LONG", "y" * 3000).replace("DIGITS", "9" * 150), encoding="utf-8")
    status, out, err = call("modes", path, *(option.replace("LONG", "y" * 3000) for option in options))
    assert (status, out, err.count("\n")) == (2, "", 1)
    assert err.removesuffix("\n").isprintable()
    assert len(err.replace(str(path), "")) < 420


def test_output_that_cannot_be_written() -> None:
    program = "from cuefem.cli import main; main()"
    environment = {**os.environ, "PYTHONPATH": str(Path(__file__).parents[2])}
    environment.pop("PYTHONUNBUFFERED", None)  # what stays in the buffer would fail once more at the end
    for arguments in (["parts"], ["--help"]):
        with open("/dev/full", "w") as full:
            done = subprocess.run(
                [sys.executable, "-c", program, *arguments], stdout=full, stderr=-1, text=True, env=environment
            )
        assert (done.returncode, done.stderr) == (1, "cuefem: cannot write: No space left on device\n")


@pytest.mark.parametrize(("was", "size"), [("700 mm", "1e-300 m"), ("782 kg/m^3", "1e308 kg/m^3")])
def test_sizes_out_of_all_proportion(was: str, size: str, tmp_path: Path) -> None:
    """In bounds, but no double holds what follows from them: status 2, said in one line, no traceback."""
    path = tmp_path / "cue.toml"
    path.write_text(GOOD.replace(was, size), encoding="utf-8")
    status, out, err = call("strike", path)
    *remarks, last = err.splitlines()
    assert (status, out) == (2, "")
    assert all(line.startswith("unusual") for line in remarks)
    assert "out of all proportion" in last


@pytest.mark.parametrize("command", ["report", "end-mass"])
def test_a_tip_as_thin_as_a_hair(tmp_path: Path, command: str) -> None:
    path = tmp_path / "cue.toml"
    path.write_text(GOOD.replace("tip_bore", "# tip_bore").replace("butt_bore", "# ").replace("12 mm", "0.012 mm"))
    status, out, err = call(command, path)
    first, *_, last = err.splitlines()
    assert (status, out) == (2, "")
    assert first.startswith("unusual: segments[0].tip_diameter 0.012 mm; check the unit")
    assert last.startswith(f"cuefem: {path}: a leather tip on 0.012 mm must be 0.0006 to 0.036 mm high; got 6 mm")


def test_more_memory_than_there_is(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def full(*_: object, **__: object) -> None:
        raise MemoryError

    monkeypatch.setattr("cuefem.cli.cue_commands.modes_record", full)
    path = tmp_path / "cue.toml"
    path.write_text(GOOD, encoding="utf-8")
    why = "this needs more memory than there is: ask for less, or check sizes, masses and times (MemoryError)"
    assert call("modes", path, "--count", "1000000") == (2, "", f"cuefem: {why}\n")
