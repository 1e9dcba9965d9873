"""The table of commands: completion, help, common options, loading on demand (properties)."""

import sys
from types import ModuleType

import click
import pytest
from click.shell_completion import ShellComplete

from cuefem.cli import COMMANDS, main
from tests.helpers.command_line import call
from tests.helpers.invalid_input import assert_rejects


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


def test_unknown_command_suggests_nearest_name() -> None:
    assert_rejects("No such command 'endmass'; did you mean 'end-mass'? (`", "endmass", "scene.toml")
    assert_rejects("No such command 'xyzzy' (`", "xyzzy", "scene.toml")
