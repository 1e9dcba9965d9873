"""What every unreadable or unacceptable file raises: one line that names file, key, bound, unit and the value got."""

from __future__ import annotations

import os
import stat
from collections.abc import Iterator
from contextlib import contextmanager
from os import PathLike
from pathlib import Path

from cuefem.quantity.display import one_line, printable
from cuefem.quantity.fields import nearest, shown

__all__ = ["InputError", "check_size", "faults_of", "nearest", "read_bytes", "reason", "shown", "state_of"]


LARGEST_TEXT = 1_000_000  # bytes: five times what as many segments as there may be take


class InputError(ValueError):
    """Input from outside that cannot be used, said in one line: ``FILE: KEY.PATH: must be in BOUND UNIT; got VALUE``.

    file: as the user named it. key: path of the key inside the file, such as ``segments[0].length``; "" for the file
    as a whole. problem: what is wrong.
    """

    def __init__(self, file: str | PathLike[str], key: str, problem: str) -> None:
        self.file, self.key, self.problem = str(file), one_line(key), one_line(problem)
        super().__init__(": ".join(part for part in (printable(self.file), self.key, self.problem) if part))


@contextmanager
def faults_of(path: str | PathLike[str], key: str) -> Iterator[None]:
    """Say of what file and key a bad value is, unless that was said where it was noticed."""
    try:
        yield
    except InputError:
        raise
    except (TypeError, ValueError) as error:
        raise InputError(path, key, str(error)) from None


def state_of(path: Path) -> os.stat_result:
    """Size and time of a file; InputError if it is none, before it is opened: a pipe would wait for whoever writes."""
    try:
        state = path.stat()
    except OSError as error:
        raise InputError(path, "", f"cannot be read: {reason(error)}") from None
    if not stat.S_ISREG(state.st_mode):
        kind = "a folder" if stat.S_ISDIR(state.st_mode) else "a pipe or a device"
        raise InputError(path, "", f"must be a file; got {kind}")
    return state


def check_size(path: Path, most: int) -> None:
    """InputError if a file cannot be found, or holds more than ``most`` bytes."""
    if (size := state_of(path).st_size) > most:
        raise InputError(path, "", f"must be a file of at most {most / 1e6:g} MB; got {size / 1e6:.9g}")


def read_bytes(path: Path, most: int) -> bytes:
    """The bytes of a file; InputError if it cannot be read, or holds more than ``most``."""
    check_size(path, most)
    try:
        return path.read_bytes()
    except OSError as error:
        raise InputError(path, "", f"cannot be read: {reason(error)}") from None


def reason(error: OSError) -> str:
    """Why the system refused a file."""
    return error.strerror or type(error).__name__
