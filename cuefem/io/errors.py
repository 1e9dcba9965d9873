"""What every unreadable or unacceptable file raises: one line that names file, key, bound, unit and the value got."""

from __future__ import annotations

import difflib
from collections.abc import Iterable
from os import PathLike
from pathlib import Path

from cuefem.quantity import shown

__all__ = ["InputError", "nearest", "read_bytes", "reason", "shown"]


class InputError(ValueError):
    """Input from outside that cannot be used, said in one line: ``FILE: KEY.PATH: must be in BOUND UNIT; got VALUE``.

    file: as the user named it. key: path of the key inside the file, such as ``segments[0].length``; "" for the file
    as a whole. problem: what is wrong.
    """

    def __init__(self, file: str | PathLike[str], key: str, problem: str) -> None:
        self.file, self.key, self.problem = str(file), key, problem
        parts = [part for part in (self.file, key, problem) if part]
        super().__init__(" ".join(": ".join(parts).split()))


def nearest(name: str, names: Iterable[str]) -> str:
    """A hint at the valid name that was probably meant, or nothing."""
    known = {known.casefold(): known for known in names}
    close = difflib.get_close_matches(name.casefold(), known, n=1, cutoff=0.5)
    return f"; did you mean {known[close[0]]!r}?" if close else ""


def read_bytes(path: Path, most: int) -> bytes:
    """The bytes of a file; OSError if it cannot be read, InputError if it holds more than ``most``."""
    with path.open("rb") as file:
        content = file.read(most + 1)
    if len(content) > most:
        size = path.stat().st_size
        got = f"{size / 1e6:.3g}" if size > most else "more"
        raise InputError(path, "", f"must be a file of at most {most / 1e6:g} MB; got {got}")
    return content


def reason(error: OSError) -> str:
    """Why the system refused a file."""
    return error.strerror or type(error).__name__
