"""Tips that the table does not hold: each is computed once, and kept as a file in the user's cache folder.

A file is named by what the tip is and by `VERSION`, is written beside its place and moved there whole, and is computed
again if it cannot be read or holds arrays of other shapes. Where nothing can be written, or the user has no home
folder, tips are computed anew by every process.
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

VERSION = 2  # of what a file holds, and of how it is computed


def folder() -> Path | None:
    """Where tables of tips are kept; None if the user has no home folder."""
    try:
        return platformdirs.user_cache_path("cuefem") / "tips"
    except RuntimeError:
        return None


def announcement() -> str:
    """The message printed while a tip is computed."""
    if folder() is None:
        return "computing this tip (about 10 s); it is not kept, for there is no home folder (XDG_CACHE_HOME gives one)"
    return "computing this tip once (about 10 s)"


@lru_cache(maxsize=64)
def own_table(tip: OwnTip) -> TipTable:
    """The table of one tip, read or computed."""
    computed = read(tip)
    if computed is None:
        from cuefem.solid.tip_compliance import own_tip

        computed = own_tip(tip)
        write(tip, computed)
    return computed


def file_of(tip: OwnTip, place: Path) -> Path:
    """Where the table of a tip is kept in a folder."""
    return place / f"{hashlib.sha256(repr((VERSION, *tip)).encode()).hexdigest()[:32]}.npz"


def read(tip: OwnTip) -> TipTable | None:
    """The table of a tip that was computed before; None if there is no file, or none that can be read."""
    if place := folder():
        with suppress(Exception), file_of(tip, place).open("rb") as stream, np.load(stream) as file:
            parts = LeatherTable(*(np.asarray(file[name], float) for name in LeatherTable._fields))
            like = all(part.shape == whole.shape[4:] for part, whole in zip(parts, table(), strict=True))
            if like and all(np.all(np.isfinite(part)) for part in parts):
                return TipTable(tip.curvature, tip.nu, *parts)
    return None


def write(tip: OwnTip, computed: TipTable) -> None:
    """Keep the table of a tip, if there is a place for it."""
    if place := folder():
        with suppress(OSError):
            place.mkdir(parents=True, exist_ok=True)
            partial = file_of(tip, place).with_suffix(f".{os.getpid()}.npz")
            np.savez_compressed(partial, patches=computed.patches, head_on=computed.head_on)
            partial.replace(file_of(tip, place))
