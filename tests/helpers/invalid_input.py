"""What a table of refusals is checked with: a call and a part of its one line, or a command line and a part of its."""

from collections.abc import Callable
from pathlib import Path

import pytest

from tests.helpers.command_line import call


def assert_raises(action: Callable[[], object], message: str) -> None:
    """The call raises ValueError, or TypeError if the message begins with that, in one line that holds the message."""
    start = message.removeprefix("TypeError: ")
    with pytest.raises(ValueError if start == message else TypeError) as error:
        action()
    text = str(error.value)
    assert start in text
    assert len(text.splitlines()) == 1


def assert_rejects(message: str, *arguments: object) -> None:
    """The command ends with status 2, nothing on stdout and one line on stderr that holds the message."""
    code, out, err = call(*arguments)
    assert (code, out) == (2, ""), err
    assert err.startswith("cuefem: ")
    assert len(err.splitlines()) == 1
    assert message in err


def assert_unchanged(folder: Path, message: str, *arguments: object) -> None:
    """The command refuses, and every file and folder inside the folder is as it was."""
    before = file_contents(folder)
    assert_rejects(message, *arguments)
    assert file_contents(folder) == before


def file_contents(folder: Path) -> dict[Path, bytes]:
    """The bytes of every file inside a folder; none for a folder."""
    return {path: path.read_bytes() if path.is_file() else b"" for path in folder.rglob("*")}
