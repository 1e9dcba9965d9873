"""Cache of tips that the table does not cover: each is computed once and stored in the user's cache folder.

The file's name is a hash of the tip and of `VERSION`. A file is written under another name and then renamed. A table is
computed again if its file cannot be read or has arrays of other shapes, and by every process if the folder is not
writable.
"""

from __future__ import annotations

import hashlib
import os
from contextlib import suppress
from functools import lru_cache
from pathlib import Path

import numpy as np
import platformdirs

from cuefem.solid.tip_table import LeatherTable, TipTable, UntabulatedTip, table

VERSION = 2  # of the file's contents and of their computation


def cache_folder() -> Path | None:
    """The folder of stored tables; None if the user has no home folder."""
    try:
        return platformdirs.user_cache_path("cuefem") / "tips"
    except RuntimeError:
        return None


def computing_message() -> str:
    """The message printed while a tip is computed."""
    if cache_folder() is None:
        return "computing this tip (about 10 s); not stored: no home folder (XDG_CACHE_HOME sets the cache folder)"
    return "computing this tip once (about 10 s)"


@lru_cache(maxsize=64)
def cached_table(tip: UntabulatedTip) -> TipTable:
    """The table of one tip, from its file or computed."""
    result = read_table(tip)
    if result is None:
        from cuefem.solid.tip_compliance import compute_tip_table

        result = compute_tip_table(tip)
        write_table(tip, result)
    return result


def cache_file(tip: UntabulatedTip, folder: Path) -> Path:
    """The file of a tip's table in a folder."""
    return folder / f"{hashlib.sha256(repr((VERSION, *tip)).encode()).hexdigest()[:32]}.npz"


def read_table(tip: UntabulatedTip) -> TipTable | None:
    """The stored table of a tip; None if its file is missing or invalid."""
    if folder := cache_folder():
        with suppress(Exception), cache_file(tip, folder).open("rb") as stream, np.load(stream) as file:
            arrays = LeatherTable(*(np.asarray(file[name], float) for name in LeatherTable._fields))
            shapes = [values.shape[4:] for values in table()]
            if [array.shape for array in arrays] == shapes and all(np.all(np.isfinite(array)) for array in arrays):
                return TipTable(tip.curvature, tip.nu, *arrays)
    return None


def write_table(tip: UntabulatedTip, result: TipTable) -> None:
    """Store the table of a tip, if the folder is writable."""
    if folder := cache_folder():
        with suppress(OSError):
            folder.mkdir(parents=True, exist_ok=True)
            temporary = cache_file(tip, folder).with_suffix(f".{os.getpid()}.npz")
            try:
                np.savez_compressed(temporary, patches=result.patches, head_on=result.head_on)
                temporary.replace(cache_file(tip, folder))
            finally:
                temporary.unlink(missing_ok=True)
