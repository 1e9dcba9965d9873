"""Leather tips outside the table: cache and invalid input (properties)."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import cuefem as cf
from cuefem.solid.tip_cache import cached_table
from cuefem.solid.tip_table import HEIGHT, TipTable, UntabulatedTip, table_of_tip
from tests.helpers.command_line import call

D = 12.75e-3
FLAT = cf.LeatherTip(height=1.5e-3, dome_radius=np.inf, E=100e6)  # lower than the table covers, and fastest to compute
PATCHES = np.array([1e-3, 2e-3, 3e-3])

SCENE = """
game = "pool"
cue = { shaft = "conical taper", material = "hard maple", body_mass = "400 g" }

[[effects]]
type = "LeatherTip"
dome_radius = "9.5 mm"
E = "100 MPa"
"""


@pytest.fixture
def cache(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """An empty cache folder; the process has no table in memory."""
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    cached_table.cache_clear()
    return tmp_path / "cache" / "cuefem" / "tips"


def contact_inputs(tip: cf.LeatherTip) -> list[np.ndarray]:
    """Everything that a contact takes from a tip: compliance, forces and depths, tangential stiffness."""
    return [
        tip.compliance(D, 0.375, PATCHES),
        np.array(tip.head_on(D, 0.0286)[1:])[:, 1:],
        tip.shear_stiffness(D, 0.375)[1][1:],
    ]


@pytest.fixture
def computed_tips(cache: Path, monkeypatch: pytest.MonkeyPatch) -> list[UntabulatedTip]:
    """The computed tips; each gets the package's table of the lowest tip instead of its own."""
    computed: list[UntabulatedTip] = []

    def compute_tip_table(tip: UntabulatedTip) -> TipTable:
        computed.append(tip)
        return table_of_tip(HEIGHT[0], 0.0, 0.4)

    monkeypatch.setattr("cuefem.solid.tip_compliance.compute_tip_table", compute_tip_table)
    return computed


def test_tip_cache_invalid_file_is_computed_again(cache: Path, computed_tips: list[UntabulatedTip]) -> None:
    """A stored table equals the computed one; truncated, empty, foreign files and other shapes are computed again."""
    assert not FLAT.is_cached(D)
    first = contact_inputs(FLAT)
    (file,) = cache.iterdir()
    cached_table.cache_clear()
    for result, expected in zip(contact_inputs(FLAT), first, strict=True):
        np.testing.assert_array_equal(result, expected)
    content, half = file.read_bytes(), len(file.read_bytes()) // 2
    with np.load(file) as stored:
        arrays = dict(stored)
    invalid = [content[:half], b"", b"hello", content[:half] + b"\0" * 40 + content[half + 40 :]]
    for replacement in (*invalid, *({name: arrays[name][..., :1]} for name in ("patches", "head_on"))):
        file.write_bytes(replacement) if isinstance(replacement, bytes) else np.savez(file, **arrays | replacement)
        cached_table.cache_clear()
        assert not FLAT.is_cached(D)
        for result, expected in zip(contact_inputs(FLAT), first, strict=True):
            np.testing.assert_array_equal(result, expected)
        assert FLAT.is_cached(D)
    assert len(computed_tips) == 7


@pytest.mark.parametrize("home", ["/proc/none", "file", "full disk"])
def test_tip_cache_that_cannot_be_written_stays_empty(
    home: str, cache: Path, computed_tips: list[UntabulatedTip], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A home that is read-only, no folder, or on a disk that is full in the middle of the file."""
    (tmp_path / "file").touch()

    def begin_and_fail(file: Path, **_: object) -> None:
        file.write_bytes(b"half")
        raise OSError(28, "No space left on device")

    if home == "full disk":
        monkeypatch.setattr("numpy.savez_compressed", begin_and_fail)
    else:
        monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / home))  # an absolute path replaces the folder
    contact_inputs(FLAT)
    assert len(computed_tips) == 1
    assert [path for path in tmp_path.rglob("*") if path.is_file()] == [tmp_path / "file"]


def test_tip_cache_without_home_folder_stores_nothing(
    cache: Path, computed_tips: list[UntabulatedTip], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def homeless(*_: object) -> Path:
        raise RuntimeError("could not determine the home directory")

    monkeypatch.setattr("platformdirs.user_cache_path", homeless)
    scene = tmp_path / "scene.toml"
    scene.write_text(SCENE.replace('"9.5 mm"', 'inf\nheight = "1.5 mm"'), encoding="utf-8")
    status, _, err = call("strike", scene)
    assert (status, len(computed_tips), cache.exists()) == (0, 1, False)
    assert "not stored" in err.splitlines()[0]
