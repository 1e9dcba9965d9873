"""Tips that the table does not hold: each is computed once, and kept as a file in the user's cache folder.

A file is named by what the tip is and by `VERSION`, is written beside its place and moved there whole, and is computed
again if it cannot be read or holds arrays of other shapes. Where nothing can be written, or the user has no home
folder, tips are computed anew by every process.
"""

from __future__ import annotations

import hashlib
import os
import tempfile
import zipfile
import zlib
from contextlib import suppress
from functools import lru_cache
from pathlib import Path

import numpy as np
import platformdirs

from cuefem.cue import Array
from cuefem.solid.leather_table import FLAT_HEIGHTS, HEIGHT, POISSON, OwnTip, TipTable, of_tip

VERSION = 1  # of what a file holds, and of how it is computed


def folder() -> Path | None:
    """Where tables of tips are kept; None if the user has no home folder."""
    try:
        return platformdirs.user_cache_path("cuefem") / "tips"
    except RuntimeError:
        return None


def announcement() -> str:
    """What a person is told while a tip is computed."""
    if folder() is None:
        return "computing this tip (about 10 s); it is not kept, for there is no home folder (XDG_CACHE_HOME gives one)"
    return "computing this tip once (about 10 s)"


def file_of(tip: OwnTip) -> Path | None:
    """Where the table of a tip is kept, if anywhere."""
    name, place = hashlib.sha256(repr((VERSION, *tip)).encode()).hexdigest()[:32], folder()
    return None if place is None else place / f"{name}.npz"


@lru_cache(maxsize=64)
def own_table(tip: OwnTip) -> TipTable:
    """The table of one tip, read or computed."""
    computed = read(tip)
    if computed is None:
        from cuefem.solid.tip_sheets import own_tip

        computed = own_tip(tip)
        write(tip, computed)
    return computed


def read(tip: OwnTip) -> TipTable | None:
    """The table of a tip that was computed before; None if there is no file, or none that can be read."""
    kept = file_of(tip)
    if kept is None:
        return None
    unreadable = (OSError, ValueError, KeyError, EOFError, zipfile.BadZipFile, zlib.error)
    with suppress(*unreadable), kept.open("rb") as stream, np.load(stream, allow_pickle=False) as file:
        parts = {name: np.asarray(file[name], float) for name in file.files}
        if _shapes(parts) == _shapes(_like(tip)) and all(np.all(np.isfinite(part)) for part in parts.values()):
            return TipTable(
                tip.curvature,
                tip.nu,
                **{name: parts[name] for name in ("whole", "cut", "head_on", "punch")},
                rim=parts.get("rim"),
                heights=(float(parts["heights"][0]), float(parts["heights"][1])),
            )
    return None


def _like(tip: OwnTip) -> dict[str, Array]:
    """Arrays as those of a tip's table are kept, by the package's table of a tip with the same dome."""
    like = of_tip(HEIGHT[0], tip.curvature, POISSON[0])
    parts = {"whole": like.whole, "cut": like.cut, "rim": like.rim, "head_on": like.head_on}
    flat, pair = np.zeros((FLAT_HEIGHTS, *like.punch.shape[1:])), np.zeros(2)
    return {name: part for name, part in (parts | {"punch": flat, "heights": pair}).items() if part is not None}


def _shapes(parts: dict[str, Array]) -> dict[str, tuple[int, ...]]:
    return {name: np.shape(part) for name, part in parts.items() if name not in ("curvature", "nu")}


def write(tip: OwnTip, table: TipTable) -> None:
    """Keep the table of a tip, if there is a place for it."""
    parts = {name: part for name, part in table._asdict().items() if part is not None}
    file = file_of(tip)
    if file is None:
        return
    with suppress(OSError):
        file.parent.mkdir(parents=True, exist_ok=True)
        handle, beside = tempfile.mkstemp(dir=file.parent, suffix=".part")
        try:
            with os.fdopen(handle, "wb") as stream:
                np.savez_compressed(stream, **parts)
            os.replace(beside, file)
        except BaseException:
            Path(beside).unlink(missing_ok=True)
            raise
