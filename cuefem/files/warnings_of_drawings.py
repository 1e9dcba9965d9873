"""Warnings of a drawing's file: columns that are not used, facets that are too few, gaps that are bridged."""

from __future__ import annotations

from pathlib import Path

from cuefem.files.csv_header import read_header
from cuefem.files.csv_reader import read_rows
from cuefem.files.cue_names import named_path
from cuefem.files.errors import quote
from cuefem.files.heading_words import Column
from cuefem.files.lathe_profile import SURFACE_EXTENSIONS
from cuefem.files.toml_reader import read_tables

COARSE = 0.01  # of the diameter: facets that err by more cause a warning


def drawing_warnings(path: Path) -> list[str]:
    """Warnings of a drawing, or of the drawing that a scene's file names; one line each."""
    ending = path.suffix.lower()
    if ending == ".csv":
        return _of_columns(path)
    if ending in SURFACE_EXTENSIONS:
        return _of_surface(path)
    cue = read_tables(path).get("cue") if ending == ".toml" else None
    return drawing_warnings(named_path(path.parent / cue)) if isinstance(cue, str) else []


def _of_columns(path: Path) -> list[str]:
    """The columns that are not used, and those that would be."""
    names = read_header(path, read_rows(path)).unused_names
    if not names:
        return []
    what = f"columns {', '.join(map(quote, names))} are" if len(names) > 1 else f"column {quote(names[0])} is"
    return [f"{what} not used; a profile may have columns {', '.join(Column)}"]


def _of_surface(path: Path) -> list[str]:
    """Gaps between bodies that are bridged, and facets whose corners lie off the circles that replace them."""
    from cuefem.files.surface_reader import read_surface  # meshio takes 0.1 s to load

    surface = read_surface(path)
    lines = [
        f"two bodies {gap.width:.4g} apart are read as one, {gap.position:.6g} from the thinner end in the file's unit"
        for gap in surface.gaps
    ]
    error = 2 * surface.facets / surface.widest
    if error > COARSE:
        percent = f"{100 * error:.2g} %"
        lines.append(f"its facets are coarse: corners lie up to {percent} of the diameter outside; use more facets")
    return lines
