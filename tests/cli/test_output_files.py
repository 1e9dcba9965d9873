"""Every format that a command's help names is written; names that a module promises exist; `modes` of a drawing."""

import json
import os
import shutil
import subprocess
import sys
from pathlib import Path

import click
import pytest

from cuefem.cli import listed_commands, main
from tests.helpers.command_line import as_json, stdout_of
from tests.helpers.full_disk import SHIM

KIM = Path("studies/scenes/kim.toml").resolve()
STUDY = f"""
scene = "{KIM.as_posix()}"
responses = ["squirt"]
[[vary]]
path = "stroke.speed"
low = "1 m/s"
high = "2 m/s"
count = 2
"""
ARGUMENTS = {"compare": (KIM, Path("meshes/kim.toml").resolve()), "parts": (), "guide": ("beam",)}
MORE = {("improve", ".toml"): ("--take", 1)}
ELSEWHERE = {
    ("compare", ".toml"),  # a calibration: tests/measurements/test_calibration.py
    ("compare", ".csv"),  # a list of shafts: tests/analysis/test_shop_list.py
}
HEAVY = {"report", "improve", "effects", "cost", "check", "compare"}


def formats() -> list[object]:
    """Commands and the extensions of their -o."""
    found = []
    for name in listed_commands():
        command = main.get_command(click.Context(main), name)
        assert command is not None
        for option in command.params:
            extensions = getattr(option.type, "extensions", ())
            marks = [pytest.mark.heavy] if name in HEAVY else []
            shown = [each for each in extensions if (name, each) not in ELSEWHERE]
            found += [pytest.param(name, extension, marks=marks) for extension in shown]
    return found


@pytest.mark.parametrize(("command", "extension"), formats())
def test_command_writes_every_format_of_its_help(command: str, extension: str, tmp_path: Path) -> None:
    if command == "study":
        (tmp_path / "study.toml").write_text(STUDY, encoding="utf-8")
    output = tmp_path / f"out{extension}"
    arguments = ARGUMENTS.get(command, (KIM,)) if command != "study" else (tmp_path / "study.toml",)
    out = stdout_of(command, *arguments, *MORE.get((command, extension), ()), "-o", output)
    assert f"wrote {output}" in " ".join(out.split())
    content = output.read_bytes()
    assert content
    if extension == ".json":
        assert json.loads(content)
    if extension == ".html":
        assert content.startswith(b"<!DOCTYPE html>")
        assert content.rstrip().endswith(b"</html>")


WRITING = {  # commands that write files in ways of their own, and files that a full disk may leave
    "modes KIM -o out.json": set[str](),
    "study study.toml -o out.csv": {"study.sqlite", "study.sqlite-journal"},  # what is computed stays
    "study study.toml -o out.parquet": set[str](),  # all is stored
}


@pytest.mark.nightly
@pytest.mark.skipif(sys.platform != "linux" or not shutil.which("cc"), reason="needs Linux and a C compiler")
def test_full_disk_at_any_write_prints_one_line_and_leaves_no_part(tmp_path: Path) -> None:
    """The n-th write fails, for every n; what a store keeps is read by the next run."""
    source, shim, folder = tmp_path / "full.c", tmp_path / "full.so", tmp_path / "work"
    source.write_text(SHIM)
    subprocess.run(["cc", "-shared", "-fPIC", "-Wall", "-Werror", "-o", shim, source], check=True)
    folder.mkdir()
    (folder / "study.toml").write_text(STUDY.replace("squirt", "mass"), encoding="utf-8")
    commands = {text: text.replace("KIM", str(KIM)).split() for text in WRITING}
    done = subprocess.run(
        [sys.executable, "-m", "tests.helpers.full_disk", folder],
        input=json.dumps(commands),
        env=os.environ | {"LD_PRELOAD": str(shim)},
        text=True,
        stdout=subprocess.PIPE,
        check=True,
    )
    rows = [json.loads(row) for row in done.stdout.splitlines()]
    assert {command for command, *_ in rows} == WRITING.keys()
    for command, n, status, err, left, again in rows:
        assert (status, again, err.count("\n")) == (2, 0, 1), (command, n, err)
        assert err.startswith("cuefem: ")
        assert "No space left on device" in err or "disk is full" in err
        assert set(left) <= WRITING[command], (command, n)


def test_template_prints_json(tmp_path: Path) -> None:
    assert as_json("compare", tmp_path / "cue", "--template") == {"output_folder": str(tmp_path / "cue")}


def test_json_with_page_prints_json_alone_and_the_typed_path(tmp_path: Path) -> None:
    assert as_json("end-mass", KIM, "-o", tmp_path / "page.html")["file"] == str(KIM)
    assert (tmp_path / "page.html").exists()
