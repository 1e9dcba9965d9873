"""Bad input to a command: status 2, one line on stderr, no traceback, nothing on stdout, no file (regression)."""

from __future__ import annotations

import os
import shlex
import subprocess
import sys
from pathlib import Path

import pytest

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


def refused(*arguments: str | Path) -> str:
    """What a command says on stderr, once it is clear that it says nothing else and writes nothing."""
    status, out, err = call(*arguments)
    assert (status, out) == (2, "")
    assert err.count("\n") == 1
    assert err.startswith("cuefem: ")
    return err.removeprefix("cuefem: ").rstrip("\n")


FILES = {
    "good.toml": GOOD,
    "bad.toml": GOOD.replace("700 mm", "-700 mm"),
    "inn.toml": GOOD.replace("700 mm", "28 inn"),
    "lumped.toml": "game = 'kim'\n[cue]\nmass = '540 g'\nend_mass = '6 g'\n",
    "empty.toml": "",
    "off.toml": "cue = 'good.toml'\n[[effects]]\ntype = 'PointMass'\nposition = '29 in'\nmass = '5 g'\n",
    "of_none.toml": "cue = 'none.toml'\n",
    "of_bad.toml": "cue = 'bad.toml'\n",
    "shaft.csv": CSV + "0,12\n700,21\n",
    "back.csv": CSV + "0,12\n700,21\n350,16\n",
    "headless.csv": "0,12\n700,21\n",
    **{f"kept.{suffix}": "somebody's work" for suffix in ("toml", "vtk", "vtu")},
}
HERTZ = 'good.toml: --near: must be 0 Hz or more, such as 250 or "0.25 kHz"; got '
LENGTH = 'a length with its unit, such as "12 mm"; got '
# Commands on these files, each with a part of the one line that says why they are refused.
COMMANDS = [
    ("strike good.toml --offset 1", "good.toml: --offset: must be between -1 and 1; got 1.0"),
    ("strike good.toml --offset -1.5", "good.toml: --offset: must be between -1 and 1; got -1.5"),
    ("strike good.toml --offset nan", "good.toml: --offset: must be between -1 and 1; got nan"),
    (
        "strike good.toml --offset half",
        "good.toml: --offset: must be a bare number, between -1 and 1, b/R, or a length such as \"8 mm\"; got 'half'",
    ),
    ("end-mass good.toml --contact-time 2", "--contact-time: needs a unit: \"1.2 ms\"; got '2'"),
    ("end-mass good.toml --contact-time '-2 ms'", "good.toml: --contact-time: must be 0.001 to 10000 ms; got -2 ms"),
    ("report good.toml --contact-time '2 mm'", "--contact-time: must be a time with its unit, such"),
    ("report good.toml --body-mass '-1 oz'", "good.toml: --body-mass: must be 0 oz or more; got -1 oz"),
    ("modes good.toml --near -250", f"{HERTZ}'-250'"),
    ("modes good.toml --near abc", f"{HERTZ}'abc'"),
    ("modes good.toml --near '3 mm'", f"{HERTZ}'3 mm'"),
    ("modes lumped.toml --material ash", "is a lumped cue, which has no material, ferrule or bore"),
    (
        "modes good.toml --begins ferrule",
        "has its own leather: begins is for .csv, .stl, .ply and .obj files alone; got",
    ),
    (
        "modes shaft.csv --begins leather",
        'begins must be "ferrule" or the leather with its height, such as "leather 6 mm"',
    ),
    ("modes shaft.csv --begins 'leather 40 mm'", "begins must have at most 30 mm of leather; got 'leather 40 mm'"),
    ("modes shaft.csv --ferrule melamine", 'ferrule must be a length and a material, such as "25 mm melamine"; got'),
    ("modes shaft.csv --ferrule '25 mm'", 'ferrule must be a length and a material, such as "25 mm melamine"; got'),
    ("modes shaft.csv --ferrule '25 mm cheese'", "no material is called 'cheese'; "),
    ("modes shaft.csv --ferrule '70 mm abs'", "ferrule must be at most 60 mm long; got '70 mm abs'"),
    ("modes shaft.csv --ferrule '25 mm abs, tenon 14 mm'", "must be "),
    ("modes shaft.csv --ferrule '25 mm abs, glued'", 'ferrule must be such as "25 mm melamine, tenon 8 mm" or "25 mm'),
    ("modes shaft.csv --bore '6 mm'", 'bore must be a width and a depth, such as "6 mm wide, 127 mm deep"; got'),
    ("modes shaft.csv --bore '6, 127 mm'", "bore must have lengths above 0 with a unit, "),
    (
        "modes shaft.csv --bore '15 mm wide, 127 mm deep'",
        "the bore must be narrower than the cue, 12 mm there; got",
    ),
    ("modes shaft.csv --bore '6 mm wide, 2 m deep'", "the bore must be at most 700 mm deep; got 2000 mm"),
    ("modes back.csv", "back.csv: line 4, x: must be beyond 700 mm, the x of the line before"),
    ("modes headless.csv", 'headless.csv: line 1: must name the columns, such as "x [mm],diameter [mm]"'),
    ("modes shaft.csv --material 'hard mapel'", "hard maple"),
    ("modes shaft.csv --material 'hard mapel'", "see `cuefem materials`"),
    ("strike of_none.toml", "of_none.toml: cue: none.toml: cannot be read: No such file or directory"),
    ("strike of_bad.toml", "cuefem: bad.toml: segments[0].length: must be more than 0"),
    ("modes inn.toml", f"{LENGTH}'28 inn': no unit is called 'inn'; did you mean 'in'?"),
    ("modes lumped.toml", "lumped.toml: Scene.cue must be a Cue of segments: its modes or its shape are needed; got"),
    ("modes lumped.toml --body-mass '1 kg'", "lumped.toml: --body-mass: must be left out: a lumped cue is whole"),
    ("convert lumped.toml out.toml --body-mass '1 kg'", "--body-mass: must be left out: a lumped cue is whole"),
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
]


@pytest.mark.parametrize(("command", "message"), COMMANDS)
def test_commands(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, command: str, message: str) -> None:
    for name, content in FILES.items():
        (tmp_path / name).write_text(content)
    monkeypatch.chdir(tmp_path)
    untouched(tmp_path, message, *shlex.split(command))


def test_no_studies(tmp_path: Path) -> None:
    missing = tmp_path / "studies"
    where = "they are in a clone of cuefem's repository: run there, or name their folder with --studies"
    assert refused("validate", "--studies", missing) == f"{missing}: cannot be read: no such folder of studies; {where}"
    missing.mkdir()
    said = refused("validate", "--studies", missing)
    assert said == f"{missing}: must hold studies (.py) that define claims(), got none; {where}"


def test_wrong_use_ends_with_status_2() -> None:
    for arguments in (["strike"], ["nonsense"], ["modes", "file.toml", "--count", "0"]):
        status, out, err = call(*arguments)
        assert (status, out) == (2, "")
        (line,) = err.splitlines()
        assert line.startswith("cuefem: ")
        assert line.endswith("--help` lists the options)")


def test_output_that_cannot_be_written(tmp_path: Path) -> None:
    program = "from cuefem.cli import main; main()"
    environment = {**os.environ, "PYTHONPATH": str(Path(__file__).parents[2])}
    environment.pop("PYTHONUNBUFFERED", None)  # what stays in the buffer would fail once more at the end
    for arguments in (["schema"], ["materials"], ["--help"]):
        with open("/dev/full", "w") as full:
            done = subprocess.run(
                [sys.executable, "-c", program, *arguments], stdout=full, stderr=-1, text=True, env=environment
            )
        assert (done.returncode, done.stderr) == (1, "cuefem: cannot write: No space left on device\n")


def test_a_whole_process_says_one_line(tmp_path: Path) -> None:
    bad = tmp_path / "bad.toml"
    bad.write_text(GOOD.replace("700 mm", "-700 mm"))
    program = "from cuefem.cli import main; main()"
    environment = {**os.environ, "PYTHONPATH": str(Path(__file__).parents[2])}
    done = subprocess.run(
        [sys.executable, "-c", program, "modes", str(bad)], capture_output=True, text=True, env=environment
    )
    assert (done.returncode, done.stdout) == (2, "")
    assert done.stderr == f"cuefem: {bad}: segments[0].length: must be more than 0 and at most 1000 m; got -700 mm\n"


@pytest.mark.parametrize(("was", "size"), [("700 mm", "1e-300 m"), ("782 kg/m^3", "1e308 kg/m^3")])
def test_sizes_out_of_all_proportion(was: str, size: str, tmp_path: Path) -> None:
    """In bounds, but no double holds what follows from them: status 2, said in one line, no traceback."""
    path = tmp_path / "cue.toml"
    path.write_text(GOOD.replace(was, size), encoding="utf-8")
    status, out, err = call("strike", path)
    assert status == 2
    assert out == ""
    assert [line for line in err.splitlines() if not line.startswith("unusual")] == [err.splitlines()[-1]]
    assert "out of all proportion" in err


@pytest.mark.parametrize("command", ["report", "end-mass"])
def test_a_tip_as_thin_as_a_hair(tmp_path: Path, command: str) -> None:
    path = tmp_path / "cue.toml"
    path.write_text(GOOD.replace("tip_bore", "# tip_bore").replace("butt_bore", "# ").replace("12 mm", "0.012 mm"))
    status, out, err = call(command, path)
    assert (status, out) == (2, "")
    assert err.splitlines()[0].startswith("unusual: segments[0].tip_diameter 0.012 mm; check the unit")
    assert err.splitlines()[-1].startswith(
        f"cuefem: {path}: a leather tip on 0.012 mm must be 0.0006 to 0.036 mm high; got 6 mm"
    )
    status, out, err = call(command, path, "--contact-time", "2 ms", "--ball", "carom")
    assert (status, out) == (2, "")
    assert err.splitlines()[0].startswith("unusual: segments[0].tip_diameter 0.012 mm; check the unit")
    assert err.splitlines()[-1].startswith(f"cuefem: {path}: the end mass comes out as -")
    assert err.splitlines()[-1].endswith("check sizes, E and the contact time")


def test_more_memory_than_there_is(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def full(*_: object, **__: object) -> None:
        raise MemoryError

    monkeypatch.setattr("cuefem.cli.tones.modes_record", full)
    path = tmp_path / "cue.toml"
    path.write_text(GOOD, encoding="utf-8")
    said = (
        "cuefem: this needs more memory than there is: ask for less, or check sizes, masses and times (MemoryError)\n"
    )
    assert call("modes", path, "--count", "1000000") == (2, "", said)
