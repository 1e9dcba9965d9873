"""One table names all commands: a command is one file and one line of it (properties)."""

from __future__ import annotations

import ast
import json
import subprocess
import sys
from importlib import import_module
from pathlib import Path
from types import ModuleType

import click
import pytest
from click.shell_completion import ShellComplete

from cuefem.cli import COMMANDS, main
from cuefem.cli.printing import Output
from tests.helpers.command_line import call

FOLDER = Path(import_module("cuefem.cli").__file__).parent  # type: ignore[arg-type]


@pytest.mark.parametrize("name", COMMANDS)
def test_every_command_of_the_table_answers(name: str) -> None:
    status, out, err = call(name, "--help")
    assert (status, err) == (0, "")
    assert out.startswith("Usage: ")
    assert f" {name} " in out.splitlines()[0] + " "


def test_a_made_up_command_is_a_file_and_a_line(monkeypatch: pytest.MonkeyPatch) -> None:
    """It is listed, completed and called; and it is loaded when it is called, not before."""
    monkeypatch.setitem(COMMANDS, "sweet-spot", ("made_up_command:sweet_spot", "Places", "Where a hit stings least."))
    assert "Places:\n  sweet-spot  Where a hit stings least.\n" in call("--help")[1]
    with pytest.raises(ModuleNotFoundError):  # its file is not there yet
        main(["sweet-spot"])
    module = ModuleType("made_up_command")

    @click.command()
    def sweet_spot() -> None:
        """Say where."""
        click.echo("at 12 mm")

    module.sweet_spot = sweet_spot  # type: ignore[attr-defined]
    monkeypatch.setitem(sys.modules, "made_up_command", module)
    assert call("sweet-spot") == (0, "at 12 mm\n", "")
    completed = ShellComplete(main, {}, "cuefem", "_CUEFEM_COMPLETE").get_completions([], "sweet")
    assert [(one.value, one.help) for one in completed] == [(n, COMMANDS[n][2]) for n in ("sweet-spot",)]


@pytest.mark.parametrize(("name", "nearest"), [("strik", "'strike'"), ("endmass", "'end-mass'"), ("nonsense", None)])
def test_an_unknown_name_is_refused_with_the_nearest(name: str, nearest: str | None) -> None:
    hint = "" if nearest is None else f"; did you mean {nearest}?"
    status, out, err = call(name, "scene.toml")
    assert (status, out) == (2, "")
    assert err.startswith(f"cuefem: No such command {name!r}{hint} (`")


def test_help_shows_a_commands_own_options_first_and_shared_ones_under_headings() -> None:
    out = call("improve", "--help")[1]
    words = ("--take", "\nCue:", "--bore", "\nTip:", "--dome", "\nStroke:", "--speed", "\nOutput:", "--json")
    places = [out.index(word) for word in words]
    assert places == sorted(places)


def option_of(command: click.Command, name: str) -> click.Parameter | None:
    return next((one for one in command.params if name in one.opts), None)


@pytest.mark.parametrize("name", COMMANDS)
def test_every_command_takes_the_same_options(name: str) -> None:
    """--json is everywhere, and -o, which writes what the ending says; `convert` has a file of its own for that."""
    command = main.get_command(click.Context(main), name)
    assert command is not None
    program = option_of(command, "--json")
    assert program is not None
    assert (program.name, program.is_flag) == ("as_json", True)  # type: ignore[attr-defined]
    written = option_of(command, "-o")
    assert written is option_of(command, "--output")
    assert (written is None) is (name in ("convert", "designer"))
    assert [one.opts for one in command.params if isinstance(one.type, Output)] == (
        [] if written is None else [["-o", "--output"]]
    )
    assert written is None or ".html" in written.type.endings  # type: ignore[attr-defined]


def test_a_command_without_a_page_of_its_own_writes_what_it_prints(tmp_path: Path) -> None:
    page = tmp_path / "modes.html"
    shaft = Path(__file__).parents[2] / "meshes/kim.toml"
    assert call("modes", shaft, "-o", page) == (0, f"wrote {page}\n", "")
    text, told = page.read_text(encoding="utf-8"), json.loads(call("modes", shaft, "--json")[1])
    assert all(f"{hertz:.2f} Hz" in text for hertz in told["frequencies"])
    assert "<h2>Bending modes" in text


def test_a_list_of_the_commands_loads_none_of_them() -> None:
    program = "import sys; from cuefem.cli import main; main(['--help'], standalone_mode=False); print(*sys.modules)"
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True)
    loaded = {name for name in done.stdout.splitlines()[-1].split() if name.startswith("cuefem.cli.")}
    assert loaded == set()


def test_imports_stand_at_the_top_of_the_commands_files() -> None:
    """All but what is heavy and needed by one option of a command alone."""
    inside = [
        f"{path.name}: {ast.unparse(statement)}"
        for path in sorted(FOLDER.glob("*.py"))
        for function in ast.walk(ast.parse(path.read_text(encoding="utf-8")))
        if isinstance(function, ast.FunctionDef)
        for statement in ast.walk(function)
        if isinstance(statement, ast.Import | ast.ImportFrom) and path.name != "strokes.py"
    ]
    assert len(inside) <= 5, inside
