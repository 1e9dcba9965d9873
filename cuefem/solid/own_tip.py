"""Tips that the table does not hold: each is computed once, and kept as a file in the user's cache folder.

A file is named by what the tip is and by `VERSION`, is written beside its place and moved there whole, and is computed
again if it cannot be read. Where nothing can be written, tips are computed anew by every process.
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

from cuefem.solid.leather_table import OwnTip, TipTable

VERSION = 1  # of what a file holds, and of how it is computed
ONCE = "computing this tip once (about 10 s)"  # what a person is told meanwhile


def file_of(tip: OwnTip) -> Path:
    """Where the table of a tip is kept."""
    name = hashlib.sha256(repr((VERSION, *tip)).encode()).hexdigest()[:32]
    return platformdirs.user_cache_path("cuefem") / "tips" / f"{name}.npz"


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
    unreadable = (OSError, ValueError, KeyError, EOFError, zipfile.BadZipFile, zlib.error)
    with suppress(*unreadable), file_of(tip).open("rb") as stream, np.load(stream, allow_pickle=False) as file:
        parts = {name: np.asarray(file[name], float) for name in file.files}
        if all(np.all(np.isfinite(part)) for part in parts.values()):
            return TipTable(
                tip.curvature,
                tip.nu,
                **{name: parts[name] for name in ("whole", "cut", "head_on", "punch")},
                rim=parts.get("rim"),
                heights=(float(parts["heights"][0]), float(parts["heights"][1])),
            )
    return None


def write(tip: OwnTip, table: TipTable) -> None:
    """Keep the table of a tip, if there is a place for it."""
    parts = {name: part for name, part in table._asdict().items() if part is not None}
    file = file_of(tip)
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
