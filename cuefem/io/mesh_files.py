"""Cues as line meshes through meshio: a cell a segment, its drawing and materials as exact cell data."""

from __future__ import annotations

import contextlib
import io
import lzma
import threading
import warnings
import zlib
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import meshio
import numpy as np

from cuefem.cue import Cue, Material, Segment
from cuefem.io.errors import InputError, check_size, faults_of, shown
from cuefem.quantity.fields import MOST_SEGMENTS, quantities

# What a damaged mesh file makes meshio raise: it checks little itself.
DAMAGED = (
    *(meshio.ReadError, OSError, ValueError, LookupError, TypeError, AttributeError, ArithmeticError, AssertionError),
    *(SyntaxError, EOFError, MemoryError, RecursionError, zlib.error, lzma.LZMAError, SystemExit),
)
LARGEST_MESH = 20_000_000  # bytes of the file: ten times what any cue takes
_ALONE = threading.Lock()
_AGREES = 1e-9  # of the cue's length: a cell's stored length against its points


def _columns(kind: type, prefix: str = "") -> list[str]:
    return [prefix + name for name, *_ in quantities(kind)]


def _row(segment: Segment) -> dict[str, float]:
    """A segment as numbers; 0, which no such field can have, stands for a field that is not given."""
    row = {name: getattr(segment, name) or 0.0 for name in _columns(Segment)}
    row |= {name: getattr(segment.material, name) or 0.0 for name in _columns(Material)}
    core = segment.core
    return row | {f"core_{name}": (getattr(core, name) if core else None) or 0.0 for name in _columns(Material)}


def save_mesh(cue: Cue, path: Path) -> None:
    """Write a cue as .vtu, binary: ASCII would lose the last bits of its cell data."""
    rows = [_row(segment) | {"body_mass": cue.body_mass} for segment in cue.segments]
    points = np.zeros((len(cue.nodes), 3))
    points[:, 0] = cue.nodes
    cells = np.arange(len(rows))[:, None] + np.array([0, 1])
    data = {name: [np.array([row[name] for row in rows])] for name in rows[0]}
    mesh = meshio.Mesh(points, [("line", cells)], cell_data=data)
    meshio.vtu.write(str(path), mesh, binary=True)


@contextlib.contextmanager
def quiet() -> Iterator[None]:
    """Keep meshio quiet: a fault of a file is one InputError, and nothing goes to stdout or stderr.

    Overflows are not errors here, unlike in computations: meshio at first reads the text of an ASCII .stl as a number
    of triangles, on purpose. One file at a time, since output and warnings belong to the whole process.
    """
    nowhere = io.StringIO()
    with _ALONE, warnings.catch_warnings(), contextlib.redirect_stderr(nowhere), contextlib.redirect_stdout(nowhere):
        warnings.simplefilter("ignore")
        with np.errstate(all="ignore"):
            yield


def load_mesh(path: Path) -> Cue:
    """The cue of a line mesh with this module's cell data, cells from tip to butt."""
    check_size(path, LARGEST_MESH)
    try:
        with quiet():
            mesh = meshio.vtu.read(str(path))
        data = {name: np.concatenate(blocks).astype(float) for name, blocks in mesh.cell_data.items()}
        kinds, x = {block.type for block in mesh.cells}, np.asarray(mesh.points, float)[:, 0]
        cells = np.concatenate([block.data for block in mesh.cells])
    except DAMAGED as error:
        said = f"{type(error).__name__} {error}".strip()
        raise InputError(path, "", f"must be a .vtu mesh; got a file that meshio cannot read: {said}") from None
    if kinds != {"line"}:
        raise InputError(path, "cells", f"must be lines alone; got {shown(sorted(kinds))}")
    wanted = [*_columns(Segment), *_columns(Material), *_columns(Material, "core_"), "body_mass"]
    for name in wanted:
        if name not in data:
            raise InputError(path, f"cell data {name}", f"must be given, a number a cell; got {shown(sorted(data))}")
    if len(cells) > MOST_SEGMENTS:
        raise InputError(path, "cells", f"must be at most {MOST_SEGMENTS}; got {len(cells)}")
    lengths = x[cells[:, 1]] - x[cells[:, 0]]
    return _cue(path, {name: data[name] for name in wanted}, lengths)


def _cue(path: Path, data: dict[str, Any], lengths: Any) -> Cue:
    wrong = ~(np.abs(lengths - data["length"]) <= _AGREES * np.sum(lengths))
    if wrong.any():
        i = int(np.argmax(wrong))
        problem = f"must be {lengths[i]} m, the distance of the cell's points; got {data['length'][i]}"
        raise InputError(path, f"cell data length[{i}]", problem)
    rows = [{name: float(values[i]) for name, values in data.items()} for i in range(len(lengths))]
    segments = []
    for i, row in enumerate(rows):
        with faults_of(path, f"cell {i}"):
            segments.append(_segment(row))
    if len(set(data["body_mass"])) != 1:
        raise InputError(path, "cell data body_mass", f"must be one number; got {shown(data['body_mass'].tolist())}")
    with faults_of(path, "cell data body_mass"):
        return Cue(tuple(segments), rows[0]["body_mass"])


def _material(row: dict[str, float], prefix: str) -> Material | None:
    """The material of a cell, or None where it has no core; 0 stands for a constant that is not given."""
    if not row[f"{prefix}E"]:
        return None
    columns = [(name, row[prefix + name], may_be_none) for name, _, may_be_none, _ in quantities(Material)]
    return Material(**{name: value for name, value, may_be_none in columns if value or not may_be_none})


def _segment(row: dict[str, float]) -> Segment:
    geometry = {name: row[name] for name in _columns(Segment) if name != "kappa"}
    shell, core = (_material(row, prefix) for prefix in ("", "core_"))
    return Segment(**geometry, material=shell, core=core, kappa=row["kappa"] or None)  # type: ignore[arg-type]
