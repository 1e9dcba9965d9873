"""Surfaces in the formats of different programs are read (regression)."""

import re
from collections.abc import Callable
from pathlib import Path

import pytest

import cuefem as cf
from tests.helpers.surfaces import revolve, write_surface

SHAFT = revolve([(0, 0), (0, 0.006), (0.7, 0.0105), (0.7, 0)], 16)
# Extension, whether binary, and the difference from meshio's output.
FILES: dict[str, tuple[str, bool, Callable[[bytes], bytes]]] = {
    "ascii": ("stl", False, lambda text: text),
    "a long head": ("stl", False, lambda text: text.replace(b"solid", b"solid " + b"OpenSCAD_Model " * 12, 1)),
    "lines of Windows": ("stl", False, lambda text: text.replace(b"\n", b"\r\n")),
    "tabs": ("stl", False, lambda text: text.replace(b"  ", b"\t")),
    "a name like a corner": ("stl", False, lambda text: re.sub(b"solid[^\n]*", b"solid vertex 1 2 3", text, count=1)),
    "binary": ("stl", True, lambda text: text),
    "binary with an ASCII header": ("stl", True, lambda text: b"solid shaft".ljust(80) + text[80:]),
    "colours": ("stl", True, lambda text: text[:84] + re.sub(b"(.{48})..", b"\\1\xff\x8f", text[84:], flags=re.DOTALL)),
    "capitals": ("stl", False, bytes.upper),
    "words divided": (
        "stl",
        False,
        lambda text: text.replace(b"endloop", b"end loop").replace(b"endfacet", b"end facet"),
    ),
    "facet count 0": ("stl", True, lambda text: text[:80] + bytes(4) + text[84:]),
    "facet count too large": ("stl", True, lambda text: text[:80] + b"\xff\xff\x00\x00" + text[84:]),
    "bytes behind the end": ("stl", True, lambda text: text + b"written by a program"),
    "ply": ("ply", False, lambda text: text),
    "binary ply": ("ply", True, lambda text: text),
    "obj": ("obj", False, lambda text: text.replace(b"\n", b"\r\n")),
    "obj counted from its end": (
        "obj",
        False,
        lambda text: re.sub(
            rb"^f .*",
            lambda face: b"f " + b" ".join(b"%d" % (int(i) - 1 - len(SHAFT[0])) for i in face[0].split()[1:]),
            text,
            flags=re.MULTILINE,
        ),
    ),
    "obj with normals": (
        "obj",
        False,
        lambda text: b"vn 0 0 1\n" + re.sub(rb"(?<=f )(\d+) (\d+) (\d+)", rb"\1//1 \2//1 \3//1", text),
    ),
}


@pytest.mark.parametrize("name", FILES)
def test_surface_of_any_program_is_read(tmp_path: Path, name: str) -> None:
    suffix, binary, change = FILES[name]
    path = write_surface(tmp_path / f"shaft.{suffix}", *SHAFT, binary=binary)
    path.write_bytes(change(path.read_bytes()))
    result = cf.load(path)
    assert isinstance(result, cf.Cue)
    assert result.length == pytest.approx(0.7, rel=1e-6)
    sizes = result.segments[0].tip_diameter, result.segments[-1].butt_diameter
    assert sizes == pytest.approx((0.012, 0.021), rel=1e-4)
