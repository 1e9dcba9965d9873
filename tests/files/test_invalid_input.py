"""Invalid files: one line with file, key path and limit (bad input).

Every declared field of every table: tests/quantity/test_declared_fields.py.
"""

import struct
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import cuefem as cf
from cuefem.designs import Levels, Response, Study, Vary
from cuefem.designs.store import SqliteStore
from cuefem.files import InputError
from cuefem.quantity.units import parse_number
from tests.helpers.command_line import call
from tests.helpers.invalid_input import assert_calls_refused, assert_refused, stored_rows
from tests.helpers.surfaces import revolve, two_bodies, write_surface


def rejection(path: Path) -> str:
    with pytest.raises(InputError) as caught:
        cf.load(path)
    text = str(caught.value)
    assert text.startswith(f"{path}: ")
    assert len(text.splitlines()) == 1
    return text.replace(f"{path.parent}/", "")


POINTS, FACES = revolve([(0, 0), (0, 0.006), (0.7, 0.0105), (0.7, 0)], 16)


def test_load_invalid_content_is_rejected(tmp_path: Path, request: pytest.FixtureRequest) -> None:
    """One error a line of tests/golden/refused_files.txt: extension, content (H is the header of a profile)."""
    messages = {}
    for i, row in enumerate(stored_rows("files")):
        end, content = (cell.strip() for cell in row.split("|"))
        path = tmp_path / str(i) / f"x.{end}"
        path.parent.mkdir()
        text = content.encode().decode("unicode_escape").encode("latin-1")
        path.write_bytes(b"x [mm],diameter [mm]\n" + text[1:] if text.startswith(b"H") else text)
        messages[row] = rejection(path)
        assert call("modes", path)[:2] == (2, "")
    assert_refused("files", messages, request)


BAR = revolve([(0, 0), *((x, 0.006) for x in np.linspace(0, 0.7, 30)), (0.7, 0)], 16)
CONE_AT_BUTT = revolve([(0, 0), (0, 0.006), (0.3, 0.006), (0.303, 0)], 16)
CONE_AT_TIP = revolve([(0.3035, 0), (0.306, 0.006), (0.7, 0.007), (0.7, 0)], 16)
SIGNALLING = struct.pack("<I", 1) + bytes(12) + struct.pack("<I", 0x7F80FF00) + bytes(34)


def surfaces_at_limits(share: float) -> dict[str, tuple[np.ndarray, np.ndarray]]:
    """Shafts at a share of each limit of length, roundness, straightness, facets and gaps."""
    points, faces = BAR
    across = points * (0, 1, 1)
    waves = np.cos(3 * np.arctan2(points[:, 2], points[:, 1]))
    return {
        "short": revolve([(0, 0), (0, 0.015), (0.15 / share, 0.015), (0.15 / share, 0)], 16),
        "oval": (points * (1, 1 + 0.01 * share, 1), faces),
        "bent": (points + 2.94e-3 * share * np.outer((points[:, 0] - 0.35) ** 2, (0, 0, 1)), faces),
        "wavy": (points + 0.0465 * share * across * waves[:, None], faces),
        "in two bodies": two_bodies(5e-4 * share),
    }


SURFACES = {
    "open": (POINTS, FACES[1:]),
    "a triangle turned": (POINTS, np.concatenate([FACES[:20], FACES[20:21, ::-1], FACES[21:]])),
    "no volume": (POINTS, np.concatenate([FACES[:8], FACES[:8, ::-1]])),
    **surfaces_at_limits(1.05),
    "square": revolve([(0, 0), (0, 0.006), (0.7, 0.006), (0.7, 0)], 4),
    "a gap between round ends": (
        np.concatenate([CONE_AT_BUTT[0], CONE_AT_TIP[0]]),
        np.concatenate([CONE_AT_BUTT[1], CONE_AT_TIP[1] + len(CONE_AT_BUTT[0])]),
    ),
    "two": (np.concatenate([POINTS, np.add(POINTS, (0, 0.03, 0))]), np.concatenate([FACES, FACES + len(POINTS)])),
}

# Of an ASCII file.
DAMAGED: dict[str, Callable[[bytes], bytes]] = {
    "decimal commas": lambda text: text.replace(b".", b","),
    "a corner lost": lambda text: text.replace(b"vertex", b"", 1),
    "a facet cut off": lambda text: text[: text.rindex(b"vertex")],
    "no facets": lambda text: text[:10],
    "binary, cut off": lambda text: bytes(80) + struct.pack("<I", 5) + bytes(60),
}


def test_load_surface_that_is_not_a_shaft_is_rejected(tmp_path: Path, request: pytest.FixtureRequest) -> None:
    path, damaged = tmp_path / "shaft.ply", tmp_path / "shaft.stl"
    messages = {name: rejection(write_surface(path, *surface, binary=False)) for name, surface in SURFACES.items()}
    damaged.write_bytes(bytes(80) + SIGNALLING)
    messages["a signalling NaN"] = rejection(damaged)
    text = write_surface(damaged, POINTS, FACES, binary=False).read_bytes()
    for name, content in DAMAGED.items():
        damaged.write_bytes(content(text))
        messages[name] = rejection(damaged)
    assert_refused("surfaces", messages, request)


@pytest.mark.filterwarnings("ignore::cuefem.PlausibilityWarning")
@pytest.mark.parametrize("surface", surfaces_at_limits(0.95).values(), ids=surfaces_at_limits(0.95))
def test_surface_just_within_its_limits_is_read(surface: tuple[np.ndarray, np.ndarray], tmp_path: Path) -> None:
    assert isinstance(cf.load(write_surface(tmp_path / "shaft.ply", *surface)), cf.Cue)


KIM = cf.load(Path(__file__).parents[2] / "meshes" / "kim.toml")


def open_store(path: Path) -> None:
    with SqliteStore(path, Study(cf.Scene(KIM), (Vary(("ball.mass",), Levels((0.16, 0.17))),), (Response("squirt"),))):
        pass


PIECE = '[[segments]]\nlength = "{}"\ntip_diameter = "{}"\nbutt_diameter = "21 mm"\nmaterial = "hard maple"\n'


def test_file_of_unlimited_time_or_memory_is_rejected(tmp_path: Path, request: pytest.FixtureRequest) -> None:
    """Each row: what a file holds, in Python."""
    path = tmp_path / "cue.toml"
    messages = {}
    for row in stored_rows("large_files"):
        path.write_text(eval(row), encoding="utf-8")
        messages[row] = rejection(path)
    assert_refused("large_files", messages, request)


LUMPED = cf.Scene(cf.LumpedCue(0.54, 0.01))
ASH = cf.Material(12e9, 8e8, 680.0)
BAR = cf.Cue((cf.Segment(0.7, 0.012, 0.021, ASH),))
STRUCK = cf.Scene(KIM, tip=cf.Tip(0.75, 0.7, 1e-3), stroke=cf.Stroke(2.0, 0.3))


@pytest.mark.filterwarnings("ignore::cuefem.PlausibilityWarning")
def test_call_on_another_kind_or_size_is_rejected(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, request: pytest.FixtureRequest
) -> None:
    (tmp_path / "studies").symlink_to(Path(__file__).parents[2] / "studies")
    (tmp_path / "folder.toml").mkdir()
    write_surface(tmp_path / "shaft.stl", POINTS, FACES)
    for name in ("shaft.xlsx", "shaft.txt"):
        (tmp_path / name).write_bytes(b"PK\x03\x04")
    (tmp_path / "shaft.csv").write_text("x [mm],diameter [mm]\n0,12\n700,21\n")
    cf.save(LUMPED, tmp_path / "lumped.toml")
    monkeypatch.chdir(tmp_path)
    assert_calls_refused("file_calls", globals() | {"replace": replace, "parse_number": parse_number}, request)
