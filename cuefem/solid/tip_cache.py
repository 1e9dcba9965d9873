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

from cuefem.solid.tip_table import LeatherTable, OwnTip, TipTable, table

VERSION = 2  # of the file's contents and of their computation


def folder() -> Path | None:
    """The folder of stored tables; None if the user has no home folder."""
    try:
        return platformdirs.user_cache_path("cuefem") / "tips"
    except RuntimeError:
        return None


def announcement() -> str:
    """The message printed while a tip is computed."""
    if folder() is None:
        return "computing this tip (about 10 s); not stored: no home folder (XDG_CACHE_HOME sets the cache folder)"
    return "computing this tip once (about 10 s)"


@lru_cache(maxsize=64)
def own_table(tip: OwnTip) -> TipTable:
    """The table of one tip, from its file or computed."""
    computed = read(tip)
    if computed is None:
        from cuefem.solid.tip_compliance import own_tip

        computed = own_tip(tip)
        write(tip, computed)
    return computed


def file_of(tip: OwnTip, place: Path) -> Path:
    """The file of a tip's table in a folder."""
    return place / f"{hashlib.sha256(repr((VERSION, *tip)).encode()).hexdigest()[:32]}.npz"


def read(tip: OwnTip) -> TipTable | None:
    """The stored table of a tip; None if its file is missing or invalid."""
    if place := folder():
        with suppress(Exception), file_of(tip, place).open("rb") as stream, np.load(stream) as file:
            parts = LeatherTable(*(np.asarray(file[name], float) for name in LeatherTable._fields))
            like = all(part.shape == whole.shape[4:] for part, whole in zip(parts, table(), strict=True))
            if like and all(np.all(np.isfinite(part)) for part in parts):
                return TipTable(tip.curvature, tip.nu, *parts)
    return None


def write(tip: OwnTip, computed: TipTable) -> None:
    """Store the table of a tip, if the folder is writable."""
    if place := folder():
        with suppress(OSError):
            place.mkdir(parents=True, exist_ok=True)
            partial = file_of(tip, place).with_suffix(f".{os.getpid()}.npz")
            np.savez_compressed(partial, patches=computed.patches, head_on=computed.head_on)
            partial.replace(file_of(tip, place))
