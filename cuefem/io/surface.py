"""Shafts as closed surfaces out of CAD (.stl, .ply, .obj through meshio), which `slices` cuts into segments."""

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
from cuefem.io.errors import InputError, check_size, faults_of, shown, state_of
from cuefem.io.profile import DEFAULT_UNIT
from cuefem.io.slices import Index, Sliced, sliced, surface
from cuefem.quantity.units import number

# What a damaged mesh file makes meshio raise: it checks little itself.
_DAMAGED = (
    *(meshio.ReadError, OSError, ValueError, LookupError, TypeError, AttributeError, ArithmeticError, AssertionError),
    *(SyntaxError, EOFError, MemoryError, RecursionError, SystemExit),
)
_ALONE = threading.Lock()
LARGEST_SURFACE = 100_000_000  # bytes: two million triangles
# What a surface may hold beside faces: corners and edges that a program wrote too.
_PASSED_OVER = ("vertex", "line")
_POLYGONS = ("triangle", "quad", "polygon")


@contextlib.contextmanager
def _quiet() -> Iterator[None]:
    """Keep meshio quiet: a fault of a file is one InputError, and nothing goes to stdout or stderr.

    Overflows are not errors here, unlike in computations: meshio at first reads the text of an ASCII .stl as a number
    of triangles, on purpose. One file at a time, since output and warnings belong to the whole process.
    """
    nowhere = io.StringIO()
    with _ALONE, warnings.catch_warnings(), contextlib.redirect_stderr(nowhere), contextlib.redirect_stdout(nowhere):
        warnings.simplefilter("ignore")
        with np.errstate(all="ignore"):
            yield


def load_surface(path: Path, material: Material, length_unit: str | None = None) -> Cue:
    """The shaft that a closed surface bounds, in one material: its thinner end is the tip.

    A surface holds no unit: ``length_unit`` is that of its coordinates, mm by default. The segments follow the slices,
    which are exact for the facets, to 5e-5 of the widest diameter. If N facets a turn are inscribed in the true form,
    diameters come out too small by the part 3.3/N^2.
    """
    unit = DEFAULT_UNIT if length_unit is None else length_unit
    try:
        scale = number(f"1 {unit}", "m")
    except ValueError:
        raise InputError(path, "length unit", f"must be a unit of length, such as mm; got {shown(unit)}") from None
    rows = [(scale * length, *np.multiply(scale, [*outer, *bore])) for length, outer, bore in read_surface(path).pieces]
    with faults_of(path, ""):
        return Cue(tuple(Segment(row[0], row[1], row[2], material, row[3], row[4]) for row in rows))


def read_surface(path: Path) -> Sliced:
    """The slices of a file, in its own unit; read once as long as the file stays the same."""
    state = state_of(path)
    return _read(path, state.st_mtime_ns, state.st_size)


@functools.lru_cache(maxsize=4)
def _read(path: Path, changed: int, size: int) -> Sliced:
    points, triangles = _faces(path)
    with faults_of(path, ""):
        return sliced(surface(points, triangles))


def _read_ply(path: Path) -> meshio.Mesh:
    if b"end_header" not in path.read_bytes():
        raise meshio.ReadError("its header does not end")  # meshio would read on for ever
    return meshio.ply.read(str(path))


def _read_obj(path: Path) -> meshio.Mesh:
    """Corners and faces of an .obj; meshio wants a normal for every corner, which few programs write."""
    points: list[list[float]] = []
    faces: dict[int, list[list[int]]] = {}
    for line in path.read_text("latin-1").replace("\\\n", " ").splitlines():
        kind, *words = line.split() or [""]
        if kind == "v":
            points.append([float(word) for word in words[:3]])
        elif kind == "f":
            corners = [int(word.split("/")[0]) for word in words]
            if 0 in corners:
                raise ValueError("a face names corner 0, and corners are counted from 1")
            places = [corner - 1 if corner > 0 else len(points) + corner for corner in corners]
            faces.setdefault(len(places), []).append(places)
    cells = [("polygon", np.array(own, dtype=np.intp)) for own in faces.values()]
    return meshio.Mesh(np.array(points).reshape(-1, 3), cells)


_READERS = {".stl": meshio.stl.read, ".ply": _read_ply, ".obj": _read_obj}


def _faces(path: Path) -> tuple[Array, Index]:
    """Corners and triangles of a surface file; faces of more corners as fans."""
    check_size(path, LARGEST_SURFACE)
    try:
        with _quiet():  # a signalling nan in 32 bits is refused below
            mesh = _READERS[path.suffix.lower()](path)
            points = np.asarray(mesh.points, float)
        blocks = [(block.type, np.asarray(block.data, dtype=np.intp)) for block in mesh.cells]
    except _DAMAGED as error:
        said = f"{type(error).__name__} {error}".strip()
        problem = f"must be a {path.suffix} surface; got a file that meshio cannot read: {said}"
        raise InputError(path, "", problem) from None
    kinds = sorted({kind for kind, _ in blocks} - {*_PASSED_OVER, *_POLYGONS})
    faces = [cells for kind, cells in blocks if kind in _POLYGONS and cells.size]
    if any(cells.shape[1] < 3 for cells in faces):
        raise InputError(path, "faces", "must have three corners or more; got one of fewer")
    if kinds or not faces:
        raise InputError(path, "faces", f"must be triangles or polygons; got {shown(kinds) if kinds else 'none'}")
    if points.ndim != 2 or points.shape[1] != 3 or not np.isfinite(points).all():
        raise InputError(path, "corners", "must be finite x, y, z; got others")
    fans = [np.stack([f[:, [0, k, k + 1]] for k in range(1, f.shape[1] - 1)], axis=1).reshape(-1, 3) for f in faces]
    triangles = np.concatenate(fans)
    if triangles.min() < 0 or triangles.max() >= len(points):
        raise InputError(path, "faces", f"must name corners in [0, {len(points)}); got another")
    return points, triangles
