"""Cues as line meshes through meshio: a cell a segment, its drawing and materials as exact cell data."""

from __future__ import annotations

import contextlib
import io
import warnings
import zlib
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import meshio
import numpy as np

from cuefem.cue import Cue, Material, Segment
from cuefem.io.errors import InputError, reason, shown
from cuefem.quantity import quantities

# What a damaged mesh file makes meshio raise: it checks little itself.
DAMAGED = (
    *(meshio.ReadError, ValueError, LookupError, TypeError, AttributeError, ArithmeticError, AssertionError),
    *(SyntaxError, EOFError, MemoryError, RecursionError, zlib.error, SystemExit),
)
_AGREES = 1e-9  # of the cue's length: a cell's stored length against its points


def _columns(kind: type, prefix: str = "") -> list[str]:
    return [prefix + name for name, *_ in quantities(kind)]


def _row(segment: Segment) -> dict[str, float]:
    """A segment as numbers; 0, which no such field can have, stands for a field that is not given."""
    row = {name: getattr(segment, name) or 0.0 for name in _columns(Segment)}
    row |= {name: getattr(segment.material, name) for name in _columns(Material)}
    core = segment.core
    return row | {f"core_{name}": getattr(core, name) if core else 0.0 for name in _columns(Material)}


def save_mesh(cue: Cue, path: Path) -> None:
    """Write a cue as .vtk (ASCII) or .vtu (binary): the two of meshio's formats that keep every bit of cell data."""
    rows = [_row(segment) | {"body_mass": cue.body_mass} for segment in cue.segments]
    points = np.zeros((len(cue.nodes), 3))
    points[:, 0] = cue.nodes
    cells = np.arange(len(rows))[:, None] + np.array([0, 1])
    data = {name: [np.array([row[name] for row in rows])] for name in rows[0]}
    mesh = meshio.Mesh(points, [("line", cells)], cell_data=data)
    with quiet():  # meshio warns that ASCII is for debugging; here it is exact and can be compared line by line
        _format(path).write(str(path), mesh, binary=path.suffix.lower() == ".vtu")


@contextlib.contextmanager
def quiet() -> Iterator[None]:
    """Nothing of what meshio says on stdout and stderr: what is wrong with a file is said once, as an InputError."""
    nowhere = io.StringIO()
    with warnings.catch_warnings(), contextlib.redirect_stderr(nowhere), contextlib.redirect_stdout(nowhere):
        warnings.simplefilter("ignore")
        yield


def _format(path: Path) -> Any:
    return meshio.vtu if path.suffix.lower() == ".vtu" else meshio.vtk


def load_mesh(path: Path) -> Cue:
    """The cue of a line mesh with this module's cell data, cells from tip to butt."""
    try:
        with quiet():
            mesh = _format(path).read(str(path))
        data = {name: np.concatenate(blocks).astype(float) for name, blocks in mesh.cell_data.items()}
        kinds, x = {block.type for block in mesh.cells}, np.asarray(mesh.points, float)[:, 0]
        cells = np.concatenate([block.data for block in mesh.cells])
    except OSError as error:
        raise InputError(path, "", f"cannot be read: {reason(error)}") from None
    except DAMAGED as error:
        said = f"{type(error).__name__} {error}".strip()
        raise InputError(
            path, "", f"must be a {path.suffix} mesh; got a file that meshio cannot read: {said}"
        ) from None
    if kinds != {"line"}:
        raise InputError(path, "cells", f"must be lines alone; got {shown(sorted(kinds))}")
    wanted = [*_columns(Segment), *_columns(Material), *_columns(Material, "core_"), "body_mass"]
    for name in wanted:
        if name not in data:
            raise InputError(path, f"cell data {name}", f"must be given, a number a cell; got {shown(sorted(data))}")
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
        try:
            segments.append(_segment(row))
        except (ValueError, TypeError) as error:
            raise InputError(path, f"cell {i}", str(error)) from None
    if len(set(data["body_mass"])) != 1:
        raise InputError(path, "cell data body_mass", f"must be one number; got {shown(data['body_mass'].tolist())}")
    try:
        return Cue(tuple(segments), rows[0]["body_mass"])
    except ValueError as error:
        raise InputError(path, "cell data body_mass", str(error)) from None


def _segment(row: dict[str, float]) -> Segment:
    shell, core = (
        Material(**{name: row[prefix + name] for name in _columns(Material)}) if row[f"{prefix}E"] else None
        for prefix in ("", "core_")
    )
    geometry = {name: row[name] for name in _columns(Segment) if name != "kappa"}
    return Segment(**geometry, material=shell, core=core, kappa=row["kappa"] or None)  # type: ignore[arg-type]
