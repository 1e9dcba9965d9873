"""`cuefem compare` of a measured cue: JSON, page, template, estimate (regression)."""

from dataclasses import replace
from pathlib import Path

import pytest

import cuefem as cf
from cuefem.measurements.measured_folder import load_measured
from cuefem.measurements.measurement_types import MEASUREMENT_TYPES
from tests.helpers.command_line import call
from tests.helpers.measured_cues import measured_folder


@pytest.mark.parametrize("drawing", ["cue.toml", "cue.csv"])
def test_compare_folder_with_drawing_alone_lists_measurement_types(tmp_path: Path, drawing: str) -> None:
    folder = measured_folder(tmp_path / "cue")
    (folder / "measured.toml").unlink()
    if drawing == "cue.csv":
        (folder / "cue.toml").unlink()
        (folder / "cue.csv").write_text("x [mm],diameter [mm]\n0,12.75\n730,21\n", encoding="utf-8")
    status, out, err = call("compare", folder)
    assert (status, err) == (0, "")
    assert all(kind.title in out for kind in MEASUREMENT_TYPES.values())


def test_load_measured_without_scene_has_default_stroke_of_game(tmp_path: Path) -> None:
    """The default stroke is that of every command, for the game of measured.toml."""
    folder = measured_folder(tmp_path / "cue")
    drawing = cf.load(folder / "cue.toml")
    assert isinstance(drawing, cf.Cue)
    for game in ("", "snooker"):
        (folder / "measured.toml").write_text(f'game = "{game}"\n' if game else "# none\n", encoding="utf-8")
        assert load_measured(folder)[0].scene == cf.usual_scene(drawing, game or "pool")
    (folder / "measured.toml").write_text('game = "pool"\n[tip]\nfriction = 0.5\n', encoding="utf-8")
    usual = cf.usual_scene(drawing)
    assert load_measured(folder)[0].scene == replace(usual, tip=replace(usual.tip, friction=0.5))
