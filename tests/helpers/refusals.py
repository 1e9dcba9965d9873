"""What a table of refusals is checked with: a call and a part of its one line, or a command line and a part of its."""

from collections.abc import Callable
from pathlib import Path

import pytest

from tests.helpers.command_line import call


def refuses(ask: Callable[[], object], message: str) -> None:
    """The call raises ValueError, or TypeError if the message begins with that, in one line that holds the message."""
    words = message.removeprefix("TypeError: ")
    with pytest.raises(ValueError if words == message else TypeError) as refused:
        ask()
    said = str(refused.value)
    assert words in said
    assert len(said.splitlines()) == 1


def command_refuses(message: str, *arguments: object) -> None:
    """The command ends with status 2, nothing on stdout and one line on stderr that holds the message."""
    code, out, err = call(*arguments)
    assert (code, out) == (2, ""), err
    assert err.startswith("cuefem: ")
    assert len(err.splitlines()) == 1
    assert message in err


def untouched(folder: Path, message: str, *arguments: object) -> None:
    """The command refuses, and every file and folder inside the folder is as it was."""
    before = contents(folder)
    command_refuses(message, *arguments)
    assert contents(folder) == before


def contents(folder: Path) -> dict[Path, bytes]:
    """The bytes of every file inside a folder; none for a folder."""
    return {path: path.read_bytes() if path.is_file() else b"" for path in folder.rglob("*")}
