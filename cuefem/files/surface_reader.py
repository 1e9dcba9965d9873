"""Reader of shafts as closed CAD surfaces; `slices` converts them to segments."""

from __future__ import annotations

import contextlib
import functools
import io
import re
import threading
import warnings
from collections.abc import Iterator
from pathlib import Path

import meshio
import numpy as np

from cuefem.cue import Array, Cue, Material, Segment
from cuefem.files.csv_header import length_unit_of
from cuefem.files.errors import InputError, as_input_error, check_size, file_state, quote
from cuefem.files.lathe_profile import DEFAULT_UNIT, SURFACE_EXTENSIONS
from cuefem.files.surface_sections import Index, SectionedShaft, aligned_surface, section_shaft
from cuefem.quantity.display_units import with_unit
from cuefem.quantity.units import conversion_factor

# Exceptions of meshio for damaged files, which it hardly checks.
_DAMAGED = (
    *(meshio.ReadError, OSError, ValueError, LookupError, TypeError, AttributeError, ArithmeticError, AssertionError),
    *(SyntaxError, EOFError, MemoryError, RecursionError, SystemExit),
)
_ALONE = threading.Lock()
LARGEST_SURFACE = 100_000_000  # bytes: two million triangles
MAX_GAP = 5e-4  # m between two bodies: what is left of a glue line or of a clearance
# Ignored cells beside the faces: corners and edges.
_IGNORED = ("vertex", "line")
_STL_HEAD = 84  # bytes before the facets of a binary .stl: a comment, and their number
_STL_RECORD = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])
_STL_FACET = re.compile(rb"^\s*facet\b", re.IGNORECASE | re.MULTILINE)
_STL_CORNER = re.compile(rb"^\s*vertex\s+(\S+)\s+(\S+)\s+(\S+)", re.IGNORECASE | re.MULTILINE)
_POLYGONS = ("triangle", "quad", "polygon")


@contextlib.contextmanager
def _quiet() -> Iterator[None]:
    """Suppress output and warnings of meshio, so that an invalid file gives one InputError and no other output.

    The lock is needed since stdout, stderr and warnings belong to the process.
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
    surface = read_surface(path)
    for gap in surface.gaps:
        if scale * gap.width > MAX_GAP:
            width, at, largest = (
                with_unit(size, "m", 6) for size in (scale * gap.width, scale * gap.position, MAX_GAP)
            )
            problem = (
                f"must be one body, with gaps of at most {largest}; got one of {width} at {at} from its thinner end"
            )
            raise InputError(path, "", f"{problem}: join the bodies in CAD")
    rows = [(scale * length, *np.multiply(scale, [*outer, *bore])) for length, outer, bore in surface.pieces]
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


def _read_stl(path: Path) -> meshio.Mesh:
    """Corners and facets of an .stl; meshio takes one dialect of the text, and trusts the count of a binary one."""
    content = path.read_bytes()
    is_text = content.lstrip()[:5].lower() == b"solid" and b"\0" not in content[:_STL_HEAD]
    points = _corners_of_text(content) if is_text else _corners_of_binary(content)
    return meshio.Mesh(points, [("triangle", np.arange(len(points), dtype=np.intp).reshape(-1, 3))])


def _corners_of_text(content: bytes) -> Array:
    """The corners of an ASCII .stl, three a facet."""
    corners = _STL_CORNER.findall(content)
    facets = len(_STL_FACET.findall(content))
    if len(corners) != 3 * facets:
        raise ValueError(f"it has {facets} facets and {len(corners)} corners, not 3 a facet")
    if any(b"," in number for corner in corners[:3] for number in corner):
        raise ValueError("its numbers have decimal commas; write decimal points")
    return np.array([[float(number) for number in corner] for corner in corners]).reshape(-1, 3)


def _corners_of_binary(content: bytes) -> Array:
    """The corners of a binary .stl: of the facets it counts, or of all that it has if it counts none or too many."""
    counted = int.from_bytes(content[_STL_HEAD - 4 : _STL_HEAD], "little")
    present = max(len(content) - _STL_HEAD, 0) // _STL_RECORD.itemsize
    count = counted if 0 < counted <= present else present
    records = np.frombuffer(content, _STL_RECORD, count, _STL_HEAD) if count else np.empty(0, _STL_RECORD)
    return records["corners"].astype(float).reshape(-1, 3)


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


_READERS = dict(zip(SURFACE_EXTENSIONS, (_read_stl, _read_ply, _read_obj), strict=True))


def _faces(path: Path) -> tuple[Array, Index]:
    """Corners and triangles of a surface file; polygons are divided into fans."""
    check_size(path, LARGEST_SURFACE)
    try:
        with _quiet():  # a signalling nan is rejected below
            mesh = _READERS[path.suffix.lower()](path)
            points = np.asarray(mesh.points, float)
        blocks = [(block.type, np.asarray(block.data, dtype=np.intp)) for block in mesh.cells]
    except _DAMAGED as error:
        detail = str(error) if path.suffix.lower() == ".stl" else f"{type(error).__name__} {error}".strip()
        problem = f"must be a {path.suffix} surface; got a file that cannot be read: {detail}"
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
