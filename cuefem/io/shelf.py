"""Shafts by name, from which a file puts a cue together: `shaft = "conical taper"`, with material, ferrule and bore.

The outside is usual and what is inside a commercial shaft is assumed: `source` says which, number by number.
"""

from __future__ import annotations

from collections.abc import Callable
from importlib.resources import files
from itertools import pairwise
from pathlib import Path
from typing import NamedTuple

from cuefem.cue import SOFT, Cue, Segment
from cuefem.cue.materials import MATERIALS
from cuefem.io.fittings import fitted, with_shaft_of
from cuefem.quantity.fields import nearest

_USUAL = "29 in, 12.75 mm and a joint of 21.5 mm: usual (meshes/README.md)"


class ShelfShaft(NamedTuple):
    """A shaft from the ferrule's front on: its source, and the corners of its taper, m, or the drawing that has it."""

    source: str
    corners: tuple[tuple[float, float], ...] = ()
    file: str = ""


SHAFTS = {
    "pro taper": ShelfShaft(
        "nearly one diameter to 12 to 14 in, then wider: published in kind (Alciatore, billiards.colostate.edu, cue "
        f"tapers). {_USUAL}; 13.3 mm at 13 in and 14.7 mm at 17 in: assumed there too. Solid hard maple",
        ((0.0, 0.01275), (0.025, 0.0128), (0.3242, 0.0133), (0.4233, 0.0147), (0.7306, 0.0215)),
    ),
    "conical taper": ShelfShaft(
        "one cone from ferrule to joint: published in kind (Alciatore, billiards.colostate.edu, cue tapers; also "
        f"called European). {_USUAL}. Solid hard maple",
        ((0.0, 0.01275), (0.7306, 0.0215)),
    ),
    "low deflection": ShelfShaft(
        "hollow-front maple, 11.85 mm: a size that is sold; bore, ferrule and taper are assumed: no maker tells them "
        "(meshes/README.md, pool_hollow.toml). It brings its ferrule",
        file="meshes/pool_hollow.toml",
    ),
    "carbon": ShelfShaft(
        "carbon tube with foam, 12.4 mm: a size that is sold; walls within what patents claim, layup, plate, plug and "
        "taper assumed (meshes/README.md, carbon.toml). It brings its ferrule",
        file="meshes/carbon.toml",
    ),
}


def folder() -> Path:
    """Where the ready files lie: in the package as it is installed, or in the clone."""
    inside = Path(str(files("cuefem"))) / "ready"
    return inside if inside.is_dir() else inside.parents[1]


def shaft_named(name: str, drawn: Callable[[Path], Cue]) -> Cue:
    """The shaft of this name, alone and without leather. drawn: reads a drawing. ValueError with the nearest names."""
    known = SHAFTS.get(" ".join(name.casefold().split()))
    if known is None:
        raise ValueError(f"must be one of {', '.join(SHAFTS)}; got {name!r}{nearest(name, SHAFTS)}")
    if known.file:
        return Cue(tuple(s for s in drawn(folder() / known.file).segments if s.material.E >= SOFT))
    maple = MATERIALS["hard maple"].material
    return Cue(tuple(Segment(x1 - x0, d0, d1, maple) for (x0, d0), (x1, d1) in pairwise(known.corners)))


def assembled(
    name: str, drawn: Callable[[Path], Cue], *, material: str | None, ferrule: str | None, bore: str | None
) -> Cue:
    """A shaft of the shelf in another wood, with a ferrule and a bore; ValueError says what cannot be."""
    cue = shaft_named(name, drawn)
    if material is not None:
        cue = with_shaft_of(cue, material)
    made: Cue = fitted(cue, ferrule=ferrule, bore=bore)
    return made
