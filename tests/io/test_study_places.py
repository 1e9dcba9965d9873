"""Places of a study's cue: segments count as in the cue's file, and the output names what varies."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

import cuefem as cf
from cuefem.io import InputError
from cuefem.io.study_files import load_study
from tests.helpers.command_line import call

SEGMENTS = {
    "leather": ("6 mm", "12.75 mm", "12.75 mm", ""),
    "melamine": ("20 mm", "12.75 mm", "12.8 mm", 'tip_bore = "8 mm", butt_bore = "8 mm", core = "hard maple", '),
    "hard maple": ("126 mm", "12.8 mm", "13 mm", 'tip_bore = "6 mm", butt_bore = "6 mm", '),
    "hard maple ": ("550 mm", "13 mm", "21.5 mm", ""),
}
CUE = "\n".join(
    f'[[segments]]\nlength = "{length}"\ntip_diameter = "{tip}"\nbutt_diameter = "{butt}"\n'
    + "\n".join(more.split(", "))
    + f'material = "{name.strip()}"\n'
    for name, (length, tip, butt, more) in SEGMENTS.items()
)
SCENE = 'game = "pool"\ncue = "cue.toml"\n[stroke]\nspeed = "3 m/s"\n'
# What each path varies: segment and field of the scene, value in the file, m, and the piece that the output names.
FERRULE, BORE = "ferrule of melamine, 0 to 20 mm", "bored shaft of hard maple, 20 to 146 mm"
PLACES = {
    "cue.segments[1].length": (0, "length", 0.020, FERRULE),
    "segments[2].tip_bore": (1, "tip_bore", 0.006, BORE),
    "ferrule length": (0, "length", 0.020, FERRULE),
    "bore": (1, "tip_bore", 0.006, BORE),
}


def study(folder: Path, path: str, *, of: str = "cue.toml", more: str = "") -> Path:
    (folder / "cue.toml").write_text(CUE, encoding="utf-8")
    (folder / "scene.toml").write_text(SCENE, encoding="utf-8")
    text = f'scene = "{of}"\nresponses = ["shaft_mass"]\n[[vary]]\npath = "{path}"\nvalues = ["5 mm", "7 mm"]\n{more}'
    (folder / "study.toml").write_text(text, encoding="utf-8")
    return folder / "study.toml"


@pytest.mark.parametrize("of", ["cue.toml", "scene.toml"])
@pytest.mark.parametrize("path", PLACES)
def test_segments_count_as_in_the_file(path: str, of: str, tmp_path: Path) -> None:
    i, field, before, _ = PLACES[path]
    wanted = load_study(study(tmp_path, path, of=of))
    assert isinstance(wanted.base.cue, cf.Cue)
    assert getattr(wanted.base.cue.segments[i], field) == pytest.approx(before)
    for value in (0.005, 0.007):
        cue = wanted.scene((value,)).cue
        assert getattr(cue.segments[i], field) == pytest.approx(value)
    assert wanted.columns[0] == path


@pytest.mark.parametrize("path", PLACES)
def test_output_names_the_varied_piece_and_its_extent(path: str, tmp_path: Path) -> None:
    status, out, _ = call("study", study(tmp_path, path), "--json")
    assert (status, json.loads(out)["varied"]) == (0, {path: [PLACES[path][-1]]})


def test_length_taken_from_a_segment_of_the_file(tmp_path: Path) -> None:
    wanted = load_study(study(tmp_path, "cue.segments[1].length", more='taken_from = "cue.segments[2].length"\n'))
    cue = wanted.scene((0.005,)).cue
    assert [segment.length for segment in cue.segments] == pytest.approx([0.005, 0.141, 0.55])


@pytest.mark.parametrize(
    ("path", "words"),
    [
        ("cue.segments[0].length", "must not name the drawn leather"),
        ("cue.segments[4].length", "segment of the cue's file, 0 to 3"),
    ],
)
def test_segments_off_the_modelled_cue_are_refused(path: str, words: str, tmp_path: Path) -> None:
    with pytest.raises(InputError, match=words):
        load_study(study(tmp_path, path))
