"""A lock on a file for one process at a time, which ends with its process, killed or not."""

from __future__ import annotations

import os
import sys
from contextlib import suppress
from pathlib import Path

from cuefem.io.errors import InputError, reason

# Where the byte stands that is locked: far behind the number of the process, which others may read.
PLACE = 1 << 30


class Lock:
    """A lock on a file, held until it is released, by one holder at a time: of this process or of any other.

    The system locks an empty file beside it, PATH.lock, and forgets the lock when the process ends; the file itself
    stays free for readers. InputError if another holder has it. If the lock's file cannot be made, no file can be made
    beside it, not even a database's journal: then nobody can write there, and nothing needs to be locked.
    """

    def __init__(self, path: Path) -> None:
        self.path = path.resolve()
        self.beside = self.path.with_name(self.path.name + ".lock")
        self._file: int | None = None
        while not self._taken(path):
            pass

    def _taken(self, path: Path) -> bool:
        """Whether the lock is held now, or none is needed; False if the locked file is gone already."""
        try:
            file = os.open(self.beside, os.O_RDWR | os.O_CREAT, 0o666)
        except OSError:
            return True
        try:
            _lock(file)
        except (BlockingIOError, PermissionError):
            holder = os.read(file, 20).decode(errors="replace").strip()
            os.close(file)
            by = f" (process {holder})" if holder.isdigit() else ""
            raise InputError(
                path, "", f"another sweep{by} is at work on it: let it end, or name another file"
            ) from None
        except OSError as error:
            os.close(file)
            raise InputError(path, "", f"cannot be locked against a second sweep: {reason(error)}") from None
        try:  # the holder before may have removed the file between opening and locking
            same = os.path.samestat(os.fstat(file), os.stat(self.beside))
        except OSError:
            same = False
        if not same:
            os.close(file)
            return False
        os.ftruncate(file, 0)
        os.write(file, f"{os.getpid()}\n".encode())
        self._file = file
        return True

    def release(self) -> None:
        """Let others have it; does nothing if it is released already."""
        if self._file is None:
            return
        file, self._file = self._file, None
        if sys.platform == "win32":  # there an open file cannot be removed, and one that another opened neither
            os.close(file)
            with suppress(OSError):
                self.beside.unlink()
        else:
            with suppress(OSError):
                self.beside.unlink()
            os.close(file)


if sys.platform == "win32":
    import msvcrt

    def _lock(file: int) -> None:
        os.lseek(file, PLACE, os.SEEK_SET)
        try:
            msvcrt.locking(file, msvcrt.LK_NBLCK, 1)
        finally:
            os.lseek(file, 0, os.SEEK_SET)

else:
    import fcntl

    def _lock(file: int) -> None:
        fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
