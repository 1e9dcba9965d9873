"""Invalid input: calls and commands, and their one-line error messages, golden files for whole tables; no tests."""

import re
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any

import pytest

import cuefem
from tests.helpers.command_line import call
from tests.test_golden_files import GOLDEN, assert_golden

PROGRAM = re.compile(r"`[^`]*?( [a-z-]+)? --help`")  # tests run as another program


def assert_refused(table: str, messages: Mapping[str, str], request: pytest.FixtureRequest) -> None:
    """The messages, by the names of their rows, are tests/golden/refused_TABLE.txt, which `--update` writes."""
    text = "".join(f"{row}: {message}\n" for row, message in messages.items())
    assert_golden(f"refused_{table}.txt", text, request, exact=True)


def stored_rows(table: str) -> list[str]:
    """What the rows of tests/golden/refused_TABLE.txt try, before the first ": ".

    A new row is a line of that file without a message, which `--update` adds.
    """
    lines = (GOLDEN / f"refused_{table}.txt").read_text(encoding="utf-8").splitlines()
    return [line.partition(": ")[0] for line in lines]


def assert_calls_refused(table: str, names: dict[str, Any], request: pytest.FixtureRequest) -> None:
    """As `assert_refused`, of a table whose rows are calls in Python, with the package's names and a test file's."""
    names = {name: getattr(cuefem, name) for name in cuefem.__all__} | names
    assert_refused(table, {row: raised(lambda row=row: eval(row, names)) for row in stored_rows(table)}, request)


def raised(action: Callable[[], object]) -> str:
    """The type and the message, one line, of the exception that a call raises."""
    with pytest.raises((ValueError, TypeError, RuntimeError)) as error:
        action()
    text = str(error.value)
    assert len(text.splitlines()) == 1
    return f"{error.typename}: {text}"


def rejected(folder: Path, *arguments: object, adds: Sequence[str] = ()) -> str:
    """The one line on stderr of a command that exits with status 2, prints nothing else and changes no file.

    adds: names of files that the command adds to the folder.
    """
    before = file_contents(folder)
    line = error_line(*arguments)
    after = file_contents(folder)
    for name in adds:
        del after[folder / name]
    assert after == before
    return PROGRAM.sub(r"`cuefem\1 --help`", line.strip().replace(f"{folder}/", ""))


def error_line(*arguments: object) -> str:
    """The one line on stderr of a command that exits with status 2 and prints nothing else."""
    code, out, err = call(*arguments)
    assert (code, out) == (2, ""), err
    assert err.startswith("cuefem: ")
    assert len(err.splitlines()) == 1
    return err


def assert_rejects(message: str, *arguments: object) -> None:
    """The command exits with status 2, an empty stdout and one line on stderr that contains ``message``."""
    assert message in error_line(*arguments)


def assert_unchanged(folder: Path, message: str, *arguments: object) -> None:
    """The command rejects its input and changes no file or folder inside ``folder``."""
    before = file_contents(folder)
    assert_rejects(message, *arguments)
    assert file_contents(folder) == before


def file_contents(folder: Path) -> dict[Path, bytes]:
    """The bytes of every file inside a folder; none for a folder."""
    return {path: path.read_bytes() if path.is_file() else b"" for path in folder.rglob("*")}
