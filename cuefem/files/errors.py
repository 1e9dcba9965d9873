"""The error of invalid input: one line with file, key, limit, unit and value."""

from __future__ import annotations

import os
import stat
from collections.abc import Iterator
from contextlib import contextmanager
from os import PathLike
from pathlib import Path

from cuefem.quantity.display import one_line, printable
from cuefem.quantity.fields import quote, suggestion

__all__ = [
    "InputError",
    "as_input_error",
    "check_path",
    "check_size",
    "file_state",
    "os_error_text",
    "quote",
    "read_bytes",
    "suggestion",
]


LARGEST_TEXT = 1_000_000  # bytes: five times a file of the largest number of segments


class InputError(ValueError):
    """Invalid input, in one line: ``FILE: KEY.PATH: must be in BOUND UNIT; got VALUE``.

    Parameters
    ----------
    file : str or path
        The file, as the user typed it.
    key : str
        Path of the key in the file, such as ``segments[0].length``; "" for the whole file.
    problem : str
        Limit and value.

    Examples
    --------
    >>> import cuefem as cf
    >>> try:
    ...     cf.load("missing.toml")
    ... except cf.InputError as error:
    ...     print(error)
    ...     print(error.file, "|", error.problem)
    missing.toml: cannot be read: No such file or directory
    missing.toml | cannot be read: No such file or directory
    """

    def __init__(self, file: str | PathLike[str], key: str, problem: str) -> None:
        self.file, self.key, self.problem = str(file), one_line(key), one_line(problem)
        super().__init__(": ".join(part for part in (printable(self.file), self.key, self.problem) if part))


@contextmanager
def as_input_error(path: str | PathLike[str], key: str) -> Iterator[None]:
    """Turn a TypeError or ValueError into an InputError with file and key; an InputError passes unchanged."""
    try:
        yield
    except InputError:
        raise
    except (TypeError, ValueError) as error:
        raise InputError(path, key, str(error)) from None


@contextmanager
def errors_name_key(path: str | PathLike[str], key: str) -> Iterator[None]:
    """Prefix an InputError about a whole file with the file and the key that refer to it."""
    try:
        yield
    except InputError as error:
        raise error if error.key else InputError(path, key, str(error)) from None


def check_path(path: Path) -> None:
    """InputError if no file can have this path, before the operating system says so in the words of one Python."""
    if "\0" in str(path):
        raise InputError(path, "", "must be a path without null characters")


def file_state(path: Path) -> os.stat_result:
    """Size and time of a file; InputError if it is not a regular file (opening a pipe would block)."""
    check_path(path)
    try:
        state = path.stat()
    except OSError as error:
        raise InputError(path, "", f"cannot be read: {os_error_text(error)}") from None
    if not stat.S_ISREG(state.st_mode):
        kind = "a folder" if stat.S_ISDIR(state.st_mode) else "a pipe or a device"
        raise InputError(path, "", f"must be a file; got {kind}")
    return state


def check_size(path: Path, most: int) -> None:
    """InputError if a file does not exist or has more than ``most`` bytes."""
    if (size := file_state(path).st_size) > most:
        raise InputError(path, "", f"must be a file of at most {most / 1e6:g} MB; got {size / 1e6:.9g}")


def read_bytes(path: Path, most: int) -> bytes:
    """The bytes of a file; InputError if it cannot be read or has more than ``most``."""
    check_size(path, most)
    try:
        return path.read_bytes()
    except OSError as error:
        raise InputError(path, "", f"cannot be read: {os_error_text(error)}") from None


def os_error_text(error: OSError) -> str:
    """The operating system's message for a failed file operation."""
    return error.strerror or type(error).__name__
