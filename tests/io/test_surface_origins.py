"""Surfaces as different programs write them, read by the commands (regression)."""

from __future__ import annotations

import struct
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

import cuefem as cf
from tests.helpers.command_line import call
from tests.helpers.surfaces import revolved

POINTS, FACES = revolved([(0, 0), (0, 6.0), (700, 10.5), (700, 0)], 16)  # mm


def ascii_stl(
    head: str = "solid shaft",
    form: str = "{:.6f}",
    end: str = "\n",
    tail: str = "endsolid shaft",
    *,
    upper: bool = False,
) -> bytes:
    lines = [head]
    for face in POINTS[FACES]:
        lines += ["  facet normal 0 0 0", "    outer loop"]
        lines += ["      vertex " + " ".join(form.format(v) for v in corner) for corner in face]
        lines += ["    endloop", "  endfacet"]
    text = end.join([*lines, tail, ""])
    return (text.upper() if upper else text).encode()


def binary_stl(head: bytes, attribute: int = 0) -> bytes:
    rows = [struct.pack("<12fH", *np.zeros(3), *POINTS[face].ravel(), attribute) for face in FACES]
    return head.ljust(80)[:80] + struct.pack("<I", len(FACES)) + b"".join(rows)


def ply(kind: str, end: str = "\n") -> bytes:
    counts = f"element vertex {len(POINTS)}", f"element face {len(FACES)}"
    axes = [f"property float {name}" for name in "xyz"]
    lines = ["ply", f"format {kind} 1.0", "comment made by hand", counts[0], *axes, counts[1]]
    head = end.join([*lines, "property list uchar int vertex_indices", "end_header", ""]).encode()
    if kind == "ascii":
        rows = [" ".join(f"{v:.6e}" for v in p) for p in POINTS] + ["3 " + " ".join(map(str, f)) for f in FACES]
        return head + end.join([*rows, ""]).encode()
    order = "<" if kind == "binary_little_endian" else ">"
    faces = b"".join(struct.pack(f"{order}B3i", 3, *face) for face in FACES)
    return head + POINTS.astype(f"{order}f4").tobytes() + faces


def obj(corner: str = "{}", end: str = "\n") -> bytes:
    lines = ["# by hand", "mtllib none.mtl", "o shaft", *("v " + " ".join(f"{v:.6E}" for v in p) for p in POINTS)]
    lines += ["vn 0 0 1", "g shaft", "s off", *("f " + " ".join(corner.format(i + 1) for i in f) for f in FACES)]
    return end.join([*lines, ""]).encode()


FILES: dict[str, tuple[str, Callable[[], bytes]]] = {
    "ascii": (".stl", ascii_stl),
    "ascii, long head": (".stl", lambda: ascii_stl("solid " + "OpenSCAD_Model " * 12)),
    "ascii, no name": (".stl", lambda: ascii_stl("solid", tail="endsolid")),
    "ascii, scientific": (".stl", lambda: ascii_stl(form="{:.8e}")),
    "ascii, lines of Windows": (".stl", lambda: ascii_stl("solid Exported from Blender-2.82", end="\r\n")),
    "ascii, tabs": (".stl", lambda: ascii_stl().replace(b"  ", b"\t")),
    "ascii, a name like a corner": (".stl", lambda: ascii_stl("solid vertex 1 2 3")),
    "binary": (".stl", lambda: binary_stl(b"STLB ATF 13.4.0.0 COLOR=")),
    "binary, solid": (".stl", lambda: binary_stl(b"solid shaft made by a program that says solid in binary files")),
    "binary, colours": (".stl", lambda: binary_stl(bytes(80), 0x8FFF)),
    "ply": (".ply", lambda: ply("ascii")),
    "ply, little": (".ply", lambda: ply("binary_little_endian")),
    "ply, big": (".ply", lambda: ply("binary_big_endian")),
    "obj": (".obj", obj),
    "obj, normals": (".obj", lambda: obj("{}//1")),
    "obj, lines of Windows": (".obj", lambda: obj(end="\r\n")),
}


@pytest.mark.parametrize("name", FILES)
def test_the_command_reads_it(tmp_path: Path, name: str) -> None:
    suffix, make = FILES[name]
    path, made = tmp_path / f"shaft{suffix}", tmp_path / "made.toml"
    path.write_bytes(make())
    status, _, err = call("convert", path, made)
    assert (status, err) == (0, "")
    found = cf.load(made)
    assert isinstance(found, cf.Cue)
    assert found.length == pytest.approx(0.7, rel=1e-6)
    sizes = found.segments[0].tip_diameter, found.segments[-1].butt_diameter
    round16 = np.sqrt(16 / 2 * np.sin(2 * np.pi / 16) / np.pi)  # of the disc that 16 facets are as large as
    assert sizes == pytest.approx((0.012 * round16, 0.021 * round16), rel=1e-4)
