"""Catalogue of shafts by name, for files with `shaft = "conical taper"`, material, ferrule and bore.

Outer dimensions are typical; the interior of commercial shafts is assumed. `source` documents each number.
"""

from __future__ import annotations

from collections.abc import Callable
from importlib.resources import files
from itertools import pairwise
from pathlib import Path
from typing import NamedTuple

from cuefem.cue import MAX_LEATHER_MODULUS, Cue, Segment
from cuefem.cue.materials import MATERIALS
from cuefem.quantity.fields import suggestion

_USUAL = "29 in, 12.75 mm and a joint of 21.5 mm: usual (meshes/README.md)"


class CatalogueShaft(NamedTuple):
    """A shaft from the front of the ferrule: its source, and points (x, diameter) of its taper, m, or its drawing."""

    source: str
    corners: tuple[tuple[float, float], ...] = ()
    file: str = ""


CATALOGUE_SHAFTS = {
    "pro taper": CatalogueShaft(
        "nearly one diameter to 12 to 14 in, then wider: published in kind (Alciatore, billiards.colostate.edu, cue "
        f"tapers). {_USUAL}; 13.3 mm at 13 in and 14.7 mm at 17 in: assumed there too. Solid hard maple",
        ((0.0, 0.01275), (0.025, 0.0128), (0.3242, 0.0133), (0.4233, 0.0147), (0.7306, 0.0215)),
    ),
    "conical taper": CatalogueShaft(
        "one cone from ferrule to joint: published in kind (Alciatore, billiards.colostate.edu, cue tapers; also "
        f"called European). {_USUAL}. Solid hard maple",
        ((0.0, 0.01275), (0.7306, 0.0215)),
    ),
    "low deflection": CatalogueShaft(
        "hollow-front maple, 11.85 mm: a size that is sold; bore, ferrule and taper are assumed, since no maker "
        "publishes them (meshes/README.md, pool_hollow.toml). Includes its ferrule",
        file="meshes/pool_hollow.toml",
    ),
    "carbon": CatalogueShaft(
        "carbon tube with foam, 12.4 mm: a size that is sold; walls within what patents claim, layup, plate, plug and "
        "taper assumed (meshes/README.md, carbon.toml). Includes its ferrule",
        file="meshes/carbon.toml",
    ),
}


def data_folder() -> Path:
    """The data folder, with `meshes` and `studies`: in the installed package or in the repository."""
    inside = Path(str(files("cuefem"))) / "ready"
    return inside if inside.is_dir() else inside.parents[1]


def catalogue_shaft(name: str, drawn: Callable[[Path], Cue]) -> Cue:
    """The shaft of this name without leather; drawn: loads a drawing. ValueError with the nearest names."""
    known = CATALOGUE_SHAFTS.get(" ".join(name.casefold().split()))
    if known is None:
        raise ValueError(
            f"must be one of {', '.join(CATALOGUE_SHAFTS)}; got {name!r}{suggestion(name, CATALOGUE_SHAFTS)}"
        )
    if known.file:
        return Cue(tuple(s for s in drawn(data_folder() / known.file).segments if s.material.E >= MAX_LEATHER_MODULUS))
    maple = MATERIALS["hard maple"].material
    return Cue(tuple(Segment(x1 - x0, d0, d1, maple) for (x0, d0), (x1, d1) in pairwise(known.corners)))
