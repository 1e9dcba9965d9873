"""Assertions on invalid input: a call or a command, and a part of its one-line error message; no tests."""

from collections.abc import Callable
from pathlib import Path

import pytest

from tests.helpers.command_line import call


def assert_raises(action: Callable[[], object], message: str) -> None:
    """The call raises ValueError, or TypeError if ``message`` begins with it, in one line that contains ``message``."""
    start = message.removeprefix("TypeError: ")
    with pytest.raises(ValueError if start == message else TypeError) as error:
        action()
    text = str(error.value)
    assert start in text
    assert len(text.splitlines()) == 1


def assert_rejects(message: str, *arguments: object) -> None:
    """The command exits with status 2, an empty stdout and one line on stderr that contains ``message``."""
    code, out, err = call(*arguments)
    assert (code, out) == (2, ""), err
    assert err.startswith("cuefem: ")
    assert len(err.splitlines()) == 1
    assert message in err


def assert_unchanged(folder: Path, message: str, *arguments: object) -> None:
    """The command rejects its input and changes no file or folder inside ``folder``."""
    before = file_contents(folder)
    assert_rejects(message, *arguments)
    assert file_contents(folder) == before


def file_contents(folder: Path) -> dict[Path, bytes]:
    """The bytes of every file inside a folder; none for a folder."""
    return {path: path.read_bytes() if path.is_file() else b"" for path in folder.rglob("*")}
