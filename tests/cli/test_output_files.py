"""Every format that a command's help names is written; names that a module promises exist; `modes` of a drawing."""

import json
from pathlib import Path

import click
import pytest

from cuefem.cli import listed_commands, main
from tests.helpers.command_line import as_json, stdout_of

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
    ("strike", ""),  # a folder of tables: tests/analysis/test_strike_table.py
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


def test_template_prints_json(tmp_path: Path) -> None:
    assert as_json("compare", tmp_path / "cue", "--template") == {"output_folder": str(tmp_path / "cue")}


def test_json_with_page_prints_json_alone_and_the_typed_path(tmp_path: Path) -> None:
    assert as_json("end-mass", KIM, "-o", tmp_path / "page.html")["file"] == str(KIM)
    assert (tmp_path / "page.html").exists()
