"""The table of commands: completion, help, common options, loading on demand (properties)."""

import subprocess
import sys
from types import ModuleType

import click
import pytest
from click.shell_completion import ShellComplete

from cuefem.cli import COMMANDS, listed_commands, main
from cuefem.cli.output import Output
from tests.helpers.command_line import call


def test_added_command_is_listed_completed_and_loaded_at_call(monkeypatch: pytest.MonkeyPatch) -> None:
    """Its module is imported by its call, not before."""
    monkeypatch.setitem(COMMANDS, "sweet-spot", ("made_up_command:sweet_spot", "Places", "Where a hit stings least."))
    assert "Places:\n  sweet-spot  Where a hit stings least.\n" in call("--help")[1]
    with pytest.raises(ModuleNotFoundError):  # its file is not there yet
        main(["sweet-spot"])
    module = ModuleType("made_up_command")
    module.sweet_spot = click.command()(lambda: click.echo("at 12 mm"))  # type: ignore[attr-defined]
    monkeypatch.setitem(sys.modules, "made_up_command", module)
    assert call("sweet-spot") == (0, "at 12 mm\n", "")
    completed = ShellComplete(main, {}, "cuefem", "_CUEFEM_COMPLETE").get_completions([], "sweet")
    assert [(one.value, one.help) for one in completed] == [("sweet-spot", COMMANDS["sweet-spot"][2])]


@pytest.mark.parametrize(("name", "nearest"), [("endmass", "'end-mass'"), ("nonsense", None)])
def test_unknown_command_suggests_nearest_name(name: str, nearest: str | None) -> None:
    hint = "" if nearest is None else f"; did you mean {nearest}?"
    status, out, err = call(name, "scene.toml")
    assert (status, out) == (2, "")
    assert err.startswith(f"cuefem: No such command {name!r}{hint} (`")


@pytest.mark.parametrize("name", listed_commands())
def test_every_command_has_common_options(name: str) -> None:
    """Every command has --json, and all but `convert` and `designer` have -o."""
    status, out, err = call(name, "--help")
    assert (status, err) == (0, "")
    assert f" {name} " in f"{out.splitlines()[0]} "
    groups = [out.index(word) for word in ("\nCue:", "\nTip:", "\nStroke:", "\nOutput:") if word in out]
    assert groups == sorted(groups)
    command = main.get_command(click.Context(main), name)
    assert command is not None
    options = {opt: one for one in command.params for opt in one.opts}
    assert (options["--json"].name, options["--json"].is_flag) == ("as_json", True)  # type: ignore[attr-defined]
    written = options.get("-o")
    assert (written is None) is (name in ("convert", "designer"))
    assert [one for one in command.params if isinstance(one.type, Output)] == ([] if written is None else [written])
    assert written is None or (written.opts == ["-o", "--output"] and ".html" in written.type.extensions)  # type: ignore[attr-defined]


def test_help_loads_no_command_module() -> None:
    program = "import sys; from cuefem.cli import main; main(['--help'], standalone_mode=False); print(*sys.modules)"
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True)
    loaded = {name for name in done.stdout.splitlines()[-1].split() if name.startswith("cuefem.cli.")}
    assert loaded == {"cuefem.cli.pending_warnings"}  # which every command prints when it has ended
