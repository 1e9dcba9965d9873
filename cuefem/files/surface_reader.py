"""Reader of shafts as closed CAD surfaces (.stl, .ply, .obj); `slices` converts them to segments."""

from __future__ import annotations

import contextlib
import functools
import io
import threading
import warnings
from collections.abc import Iterator
from pathlib import Path

import meshio
import numpy as np

from cuefem.cue import Array, Cue, Material, Segment
from cuefem.files.csv_header import length_unit_of
from cuefem.files.errors import InputError, as_input_error, check_size, file_state, quote
from cuefem.files.lathe_profile import DEFAULT_UNIT
from cuefem.files.surface_sections import Index, SectionedShaft, aligned_surface, section_shaft
from cuefem.quantity.units import conversion_factor

# Exceptions of meshio for damaged files, which it hardly checks.
_DAMAGED = (
    *(meshio.ReadError, OSError, ValueError, LookupError, TypeError, AttributeError, ArithmeticError, AssertionError),
    *(SyntaxError, EOFError, MemoryError, RecursionError, SystemExit),
)
_ALONE = threading.Lock()
LARGEST_SURFACE = 100_000_000  # bytes: two million triangles
# Ignored cells beside the faces: corners and edges.
_IGNORED = ("vertex", "line")
_POLYGONS = ("triangle", "quad", "polygon")


@contextlib.contextmanager
def _quiet() -> Iterator[None]:
    """Suppress output and warnings of meshio, so that an invalid file gives one InputError and no other output.

    Overflows are allowed: meshio first reads the text of an ASCII .stl as a number of triangles. The lock is needed
    since stdout, stderr and warnings belong to the process.
    """
    nowhere = io.StringIO()
    with _ALONE, warnings.catch_warnings(), contextlib.redirect_stderr(nowhere), contextlib.redirect_stdout(nowhere):
        warnings.simplefilter("ignore")
        with np.errstate(all="ignore"):
            yield


def load_surface(path: Path, material: Material, length_unit: str | None = None) -> Cue:
    """Load the shaft inside a closed surface, of one material; its thinner end is the tip.

    length_unit: of the coordinates, mm by default. The segments approximate the exact slices of the facets to 5e-5 of
    the largest diameter. Where the corners of a slice lie on one circle, that circle is the section.
    """
    unit = DEFAULT_UNIT if length_unit is None else length_unit
    if not length_unit_of(unit):
        raise InputError(path, "length_unit", f"must be a unit of length, such as mm; got {quote(unit)}")
    scale = float(conversion_factor(length_unit_of(unit), "m"))
    rows = [(scale * length, *np.multiply(scale, [*outer, *bore])) for length, outer, bore in read_surface(path).pieces]
    with as_input_error(path, ""):
        return Cue(tuple(Segment(row[0], row[1], row[2], material, row[3], row[4]) for row in rows))


def read_surface(path: Path) -> SectionedShaft:
    """The conical pieces of a file, in its own unit; cached until the file changes."""
    state = file_state(path)
    return _read(path, state.st_mtime_ns, state.st_size)


@functools.lru_cache(maxsize=4)
def _read(path: Path, changed: int, size: int) -> SectionedShaft:
    points, triangles = _faces(path)
    with as_input_error(path, ""):
        return section_shaft(aligned_surface(points, triangles))


def _read_ply(path: Path) -> meshio.Mesh:
    if b"end_header" not in path.read_bytes():
        raise meshio.ReadError("its header does not end")  # meshio would not terminate
    return meshio.ply.read(str(path))


def _read_obj(path: Path) -> meshio.Mesh:
    """Corners and faces of an .obj; the reader of meshio requires a normal at every corner, which is rare."""
    points: list[list[float]] = []
    faces: dict[int, list[list[int]]] = {}
    for line in path.read_text("latin-1").replace("\\\n", " ").splitlines():
        kind, *words = line.split() or [""]
        if kind == "v":
            points.append([float(word) for word in words[:3]])
        elif kind == "f":
            corners = [int(word.split("/")[0]) for word in words]
            if 0 in corners:
                raise ValueError("a face names corner 0; corners are counted from 1")
            places = [corner - 1 if corner > 0 else len(points) + corner for corner in corners]
            faces.setdefault(len(places), []).append(places)
    cells = [("polygon", np.array(own, dtype=np.intp)) for own in faces.values()]
    return meshio.Mesh(np.array(points).reshape(-1, 3), cells)


_READERS = {".stl": meshio.stl.read, ".ply": _read_ply, ".obj": _read_obj}


def _faces(path: Path) -> tuple[Array, Index]:
    """Corners and triangles of a surface file; polygons are divided into fans."""
    check_size(path, LARGEST_SURFACE)
    try:
        with _quiet():  # a signalling nan is rejected below
            mesh = _READERS[path.suffix.lower()](path)
            points = np.asarray(mesh.points, float)
        blocks = [(block.type, np.asarray(block.data, dtype=np.intp)) for block in mesh.cells]
    except _DAMAGED as error:
        detail = f"{type(error).__name__} {error}".strip()
        problem = f"must be a {path.suffix} surface; got a file that meshio cannot read: {detail}"
        raise InputError(path, "", problem) from None
    kinds = sorted({kind for kind, _ in blocks} - {*_IGNORED, *_POLYGONS})
    faces = [cells for kind, cells in blocks if kind in _POLYGONS and cells.size]
    if any(cells.shape[1] < 3 for cells in faces):
        raise InputError(path, "faces", "must have at least three corners; got a face with fewer")
    if kinds or not faces:
        raise InputError(path, "faces", f"must be triangles or polygons; got {quote(kinds) if kinds else 'none'}")
    if points.ndim != 2 or points.shape[1] != 3 or not np.isfinite(points).all():
        raise InputError(path, "corners", "must be finite x, y, z; got other values")
    fans = [np.stack([f[:, [0, k, k + 1]] for k in range(1, f.shape[1] - 1)], axis=1).reshape(-1, 3) for f in faces]
    triangles = np.concatenate(fans)
    if triangles.min() < 0 or triangles.max() >= len(points):
        raise InputError(path, "faces", f"must refer to corners in [0, {len(points)}); got another number")
    return points, triangles
