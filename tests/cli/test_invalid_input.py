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
from tests.helpers.invalid_input import assert_refused, rejected, stored_rows
from tests.measurements.test_calibration import calibration

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
    "shop/one.csv": CSV + "0,12\n700,21\n",
    "empty/notes.txt": "no drawing",
}
DAMAGED = {  # what replaces what in a calibration
    "blank": (".*", ""),
    "scene": (r"\[calibration\].*", ""),
    "far": ("log_factor = [^\n]*", "log_factor = 0.6"),
    "older": ("without_distance = [^\n]*\n", ""),
    "feather": ("leather =", "feather ="),
}
SAVED = {"shaft.toml": SHAFT, "spring.toml": cf.Scene(SHAFT, stroke=cf.Stroke(offset=0.3))}
SAVED["ash.toml"] = cf.Cue((cf.Segment(0.7, 0.0118, 0.021, material("ash")),), 0.42)


def test_command_invalid_input_prints_one_line(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, request: pytest.FixtureRequest
) -> None:
    """Commands on these files: the rows of tests/golden/refused_cli.txt."""
    calibration().save(tmp_path / "old.toml")
    text = (tmp_path / "old.toml").read_text(encoding="utf-8")
    damaged = {f"{name}.toml": re.sub(old, new, text, flags=re.DOTALL) for name, (old, new) in DAMAGED.items()}
    for name, content in (FILES | damaged).items():
        (tmp_path / name).parent.mkdir(exist_ok=True)
        (tmp_path / name).write_text(content)
    for name, item in SAVED.items():
        cf.save(item, tmp_path / name)
    monkeypatch.chdir(tmp_path)
    assert_refused("cli", {row: rejected(tmp_path, *shlex.split(row)) for row in stored_rows("cli")}, request)


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


@pytest.mark.heavy
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
