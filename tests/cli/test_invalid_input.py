"""Invalid input of commands: status 2, one line on stderr, empty stdout, no file (bad input)."""

import os
import re
import shlex
import subprocess
import sys
from pathlib import Path

import pytest

import cuefem as cf
from cuefem.cue.materials import material
from tests.helpers.command_line import call
from tests.helpers.invalid_input import assert_unchanged

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
    "lumped.toml": "game = 'kim'\n[cue]\nmass = '540 g'\nend_mass = '6 g'\n",
    "off.toml": "cue = 'good.toml'\n[[effects]]\ntype = 'PointMass'\nposition = '29 in'\nmass = '5 g'\n",
    "of_bad.toml": "cue = 'bad.toml'\n",
    "bare.csv": CSV + "0,12\n700,21\n",
    "bored.csv": "x [mm],diameter [mm],bore [mm]\n0,12,6\n152,14,\n700,21,\n",
    "own.toml": "somebody's work",
}
SAVED = {"shaft.toml": SHAFT, "spring.toml": cf.Scene(SHAFT, stroke=cf.Stroke(offset=0.3))}
SAVED["ash.toml"] = cf.Cue((cf.Segment(0.7, 0.0118, 0.021, material("ash")),), 0.42)
# Commands on these files, each with a part of the error message.
COMMANDS = r"""
strike good.toml --offset nan | good.toml: --offset: must be b/R between -1 and 1
strike good.toml --offset half | or a length below 28.575 mm
strike shaft.toml --offset 0,3 | use a decimal point
strike shaft.toml --offset 8 | with its unit, such as "8 mm"; got '8'
strike shaft.toml --offset '40 mm' | or a length below 28.575 mm
strike shaft.toml --restitution 2 | shaft.toml: --restitution: must be 0 to 1
strike shaft.toml --speed fast | cuefem: shaft.toml: --speed: must be a speed with its unit
end-mass good.toml --speed 2 | --speed: needs a unit
end-mass good.toml --near 0 | --near: must be more than 0 Hz; got 0.0 Hz
end-mass good.toml --cue-end '-3 g' | --cue-end: must be
end-mass shaft.toml --cue-end '600 g' | shaft.toml: --cue-end: must be
modes good.toml --near -5 | --near: must be 0 Hz or more; got -5.0 Hz
guide bore -o bore.json | bore.json: --output: needs a CHAPTER or none; got 'bore'
report good.toml --body-mass '-1 oz' | good.toml: --body-mass: must be 0 oz or more
report shaft.toml --game chess | 'chess' is not one of 'pool', 'carom', 'snooker'
strike spring.toml --game pool | --game: does not apply: FILE is a scene
strike spring.toml --dome dime | --dome: does not apply: the scene has no LeatherTip
strike shaft.toml --dome penny | or "dime", "nickel", "flat"; got 'penny'
strike shaft.toml --leather sofd | got 'sofd'
strike shaft.toml --restitution 0.05 | --restitution: must be 0.1 to 1 for a contact computed in time; got 0.05
modes shaft.toml --tip-height 40mm | got 40 mm (options: --tip-height, --dome)
strike shaft.toml --leather 1MPa | (--tip-height, --leather, --speed)
modes lumped.toml --material ash | is a lumped cue, without material
modes good.toml --front ferrule | --front: is only for .csv
modes bare.csv --front leather | --front: must be "ferrule" or leather with a height
modes bare.csv --front 'leather 40 mm' | --front: must have at most 30 mm of leather
modes bare.csv --ferrule melamine | --ferrule: must be a length and a material
modes bare.csv --ferrule '25 mm cheese' | --ferrule: unknown material 'cheese'; choose hard maple, ash
modes bare.csv --ferrule '70 mm abs' | --ferrule: must be at most 60 mm long
modes bare.csv --ferrule '25 mm abs, tenon 14 mm' | must be
modes bare.csv --ferrule '25 mm abs, glued' | --ferrule: must be such as
modes bare.csv --bore '6 mm' | --bore: must be a width and a depth
modes bare.csv --bore '6 wide, 127 mm deep' | --bore: must have lengths above 0 with a unit
modes bare.csv --bore '15 mm wide, 127 mm deep' | narrower than the cue, 12 mm wide at 0 mm from the tip
modes bare.csv --bore '6 mm wide, 2 m deep' | the bore must be at most 700 mm deep
modes bored.csv --ferrule '25 mm abs, tenon 8 mm' | the shaft is bored there
modes bare.csv --material 'hard mapel' | --material: unknown material 'hard mapel'; did you mean 'hard maple'?; see
modes lumped.toml | lumped.toml: Scene.cue must be a Cue of segments
modes lumped.toml --body-mass '1 kg' | lumped.toml: --body-mass: does not apply
strike of_bad.toml | cuefem: bad.toml: segments[0].length: must be more than 0
report off.toml -o page.html | cuefem: off.toml: effects[0].position: must be 0 to 700 mm, on the cue
convert good.toml own.toml | already exists; --force overwrites it
report lumped.toml -o page.pdf | page.pdf: --output: must end in .html or .json
strike spring.toml --format pooltool --offset 0 | [A.31] has no squirt at offset 0
strike spring.toml --format pooltool -o cue.json --offset 0.9 | the stroke is a miscue at offset 0.9
report spring.toml -o page.html --offset 0.9 | miscue at b/R 0.9: no squirt is reported. Use a smaller offset
compare shaft.toml | needs another FILE
compare shaft.toml --speed '3 m/s' | need two or more FILEs
compare shaft.toml shaft.toml --shaft-mass '112 g' | must be set in each cue's file
compare shaft.toml shaft.toml --estimate | takes one FOLDER
compare shaft.toml shaft.toml shaft.toml shaft.toml shaft.toml shaft.toml | at most 5 cues
compare shaft.toml lumped.toml | LumpedCue
compare shaft.toml ash.toml --same-shaft | must be of one wood
compare shaft.toml lumped.toml ./shaft.toml | given twice
compare nowhere | got no folder
compare bare.csv 'predator z2' --material ash | predator z2: --material: would replace this file's own value: options of
guide glosary | got 'glosary'; the nearest chapters are glossary,
guide qqqq | CHAPTER must be a chapter, or a word of the handbook; got 'qqqq'
guide --print -o guide.html | cannot be combined with --print
guide -o guide.txt | must end in .html or .json; got '.txt'
improve spring.toml -o x.pdf | must end in .html or .json or .toml
modes good.toml --units imperial | 'imperial' is not one of 'metric', 'us'
report predator | predator: names 2 cues: write 'predator z' or 'predator z2'
report 'predator z-3' | predator z-3: must be a file, or a cue's name: plain maple, low deflection, carbon
report 'predatr z2' | got neither; did you mean 'predator z2'?
report carbon.csv | carbon.csv: cannot be read: No such file or directory
strike bare.csv --shaft-mass 112 | --shaft-mass: needs a unit
strike bare.csv --shaft-mass '0 g' | --shaft-mass: must be more than 0
convert bare.csv made.toml --shaft-mass '9 kg' | --shaft-mass: must be 3.068 to 3528 g (density
strike | --help` lists the options)
strike shaft.toml --offset | Option '--offset' requires an argument
""".strip().splitlines()


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The files of these commands, which change none of them."""
    folder = tmp_path_factory.mktemp("invalid")
    for name, content in FILES.items():
        (folder / name).write_text(content)
    for name, item in SAVED.items():
        cf.save(item, folder / name)
    return folder


@pytest.mark.parametrize("row", COMMANDS)
def test_command_invalid_input_prints_one_line(folder: Path, monkeypatch: pytest.MonkeyPatch, row: str) -> None:
    command, message = row.split(" | ")
    monkeypatch.chdir(folder)
    assert_unchanged(folder, message, *shlex.split(command))


ECHOED = [
    *((text, []) for text in ("LONG = 1", '[[segments]]\nlength = "DIGITS mm"')),
    *((text, []) for text in ('cue = "x.toml"\n"\\u001b[31mLONG" = 1', '[[segments]]\nmaterial = "\\u001b[31m LONG"')),
    *((GOOD, [option, "\x1b[31m LONG"]) for option in ("--material", "--leather", "--game")),
    (GOOD, ["--near\x1b[31mLONG"]),
]


@pytest.mark.parametrize(("file", "options"), ECHOED)
def test_error_message_of_long_text_is_short_and_printable(file: str, options: list[str], tmp_path: Path) -> None:
    path = tmp_path / "x.toml"
    path.write_text(file.replace("LONG", "y" * 3000).replace("DIGITS", "9" * 150), encoding="utf-8")
    status, out, err = call("modes", path, *(option.replace("LONG", "y" * 3000) for option in options))
    assert (status, out, err.count("\n")) == (2, "", 1)
    assert err.removesuffix("\n").isprintable()
    assert len(err.replace(str(path), "")) < 420


def test_command_on_full_disk_prints_one_line() -> None:
    program = "from cuefem.cli import main; main()"
    environment = {**os.environ, "PYTHONPATH": str(Path(__file__).parents[2])}
    environment.pop("PYTHONUNBUFFERED", None)  # a full buffer would raise again at exit
    with open("/dev/full", "w") as full:
        command = [sys.executable, "-c", program, "parts"]
        done = subprocess.run(command, stdout=full, stderr=-1, text=True, env=environment)
    assert (done.returncode, done.stderr) == (1, "cuefem: cannot write: No space left on device\n")


@pytest.mark.parametrize(
    ("command", "was", "size", "message"),
    [
        ("strike", "700 mm", "1e-300 m", "overflow"),
        ("report", "12 mm", "0.012 mm", "a leather tip on 0.012 mm must be 0.0006 to 0.036 mm high; got 6 mm"),
    ],
)
def test_command_extreme_size_prints_one_error(command: str, was: str, size: str, message: str, tmp_path: Path) -> None:
    """Valid values whose results overflow: status 2, and one line after the warnings."""
    path = tmp_path / "cue.toml"
    path.write_text(re.sub("(tip|butt)_bore.*", "", GOOD).replace(was, size), encoding="utf-8")
    status, out, err = call(command, path)
    *warnings, last = err.splitlines()
    assert (status, out) == (2, "")
    assert all(line.startswith("warning") for line in warnings)
    assert message in last


def test_command_out_of_memory_prints_one_line(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def full(*_: object, **__: object) -> None:
        raise MemoryError

    monkeypatch.setattr("cuefem.natural_frequencies", full)
    path = tmp_path / "cue.toml"
    path.write_text(GOOD, encoding="utf-8")
    why = "out of memory: request less, or check the units of sizes, masses and times (MemoryError)"
    assert call("modes", path, "--count", "1000000") == (2, "", f"cuefem: {why}\n")
