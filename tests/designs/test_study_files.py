"""Study files: numbering of segments, default strokes, ranges (properties)."""

from pathlib import Path

import pytest

import cuefem as cf
from cuefem.designs import Normal, Span
from cuefem.designs.study_file import load_study
from cuefem.files import InputError
from tests.helpers.command_line import as_json, stdout_of
from tests.helpers.invalid_input import assert_refused, rejected, stored_rows
from tests.helpers.sweeps import GRID, SCENE, STRIKES, write_study

LEATHER = ("6 mm", "12.75 mm", "12.75 mm", 'material = "leather"')
TENON = 'tip_bore = "8 mm"\nbutt_bore = "8 mm"\ncore = "ash"\nmaterial = "melamine"'
FERRULED = ("20 mm", "12.75 mm", "12.8 mm", TENON)
BORED = ("126 mm", "12.8 mm", "13 mm", 'tip_bore = "6 mm"\nbutt_bore = "6 mm"\nmaterial = "hard maple"')
REST = ("550 mm", "13 mm", "21.5 mm", 'material = "hard maple"')
CUE = 'body_mass = "430 g"\n' + "".join(
    f'[[segments]]\nlength = "{length}"\ntip_diameter = "{tip}"\nbutt_diameter = "{butt}"\n{more}\n'
    for length, tip, butt, more in (LEATHER, FERRULED, BORED, REST)
)
OF_CUE = 'game = "pool"\ncue = "cue.toml"\n[stroke]\nspeed = "3 m/s"\n'
# What each path varies: segment and field of the scene, value in the file, m, and the piece that the output names.
FERRULE, BORE = "ferrule of melamine, 0 to 20 mm", "bored shaft of hard maple, 20 to 146 mm"
PATHS = {
    "cue.segments[1].length": (0, "length", 0.020, FERRULE),
    "segments[2].tip_bore": (1, "tip_bore", 0.006, BORE),
    "ferrule length": (0, "length", 0.020, FERRULE),
    "bore width": (1, "tip_bore", 0.006, BORE),
}


def varying(folder: Path, path: str, *, of: str = "cue.toml", more: str = "") -> Path:
    (folder / "cue.toml").write_text(CUE, encoding="utf-8")
    text = f'scene = "{of}"\nresponses = ["shaft_mass"]\n[[vary]]\npath = "{path}"\nvalues = ["5 mm", "7 mm"]\n{more}'
    return write_study(folder, text, OF_CUE)


@pytest.mark.parametrize("of", ["cue.toml", "scene.toml"])
@pytest.mark.parametrize("path", PATHS)
def test_study_segments_are_numbered_as_in_file(path: str, of: str, tmp_path: Path) -> None:
    i, field, before, piece = PATHS[path]
    expected = load_study(file := varying(tmp_path, path, of=of))
    assert getattr(expected.base.cue.segments[i], field) == pytest.approx(before)
    for value in (0.005, 0.007):
        assert getattr(expected.scene((value,)).cue.segments[i], field) == pytest.approx(value)
    assert as_json("study", file)["varied_fields"] == {path: [piece]}


@pytest.mark.parametrize(("segment", "problem"), [(0, "must not name the drawn leather"), (4, "cue's file, 0 to 3")])
def test_study_segment_off_the_modelled_cue_raises(segment: int, problem: str, tmp_path: Path) -> None:
    with pytest.raises(InputError, match=problem):
        load_study(varying(tmp_path, f"cue.segments[{segment}].length"))


def test_study_of_cue_has_default_stroke_of_game(tmp_path: Path) -> None:
    for game, usual in (("kim", lambda cue: cf.Scene(cue, stroke=cf.Stroke(offset=0.3))), ("", cf.usual_scene)):
        file = varying(tmp_path, "bore width")
        file.write_text((f'game = "{game}"\n' if game else "") + file.read_text(encoding="utf-8"), encoding="utf-8")
        assert load_study(file).base == usual(cf.load(tmp_path / "cue.toml"))
        assert f"cue speed {1 if game else 2} m/s" in as_json("study", file)["assumptions"]


PROFILE = "position [mm],diameter [mm]\n0,12.5\n330,13\n430,14\n740,21\n"
VARIED = 'responses = ["shaft_mass"]\n[[vary]]\npath = "tip diameter"\nvalues = ["12 mm"]\n'
OPTIONS = {
    "material": "ash",
    "front": "leather 6 mm",
    "ferrule": "25 mm melamine",
    "bore": "6 mm wide, 127 mm deep",
}


def of_profile(folder: Path, keys: str, profile: str = PROFILE) -> Path:
    """A study of a profile with some keys at its top."""
    (folder / "shaft.csv").write_text(profile, encoding="utf-8")
    (folder / "s.toml").write_text(f'scene = "shaft.csv"\n{keys}\n{VARIED}', encoding="utf-8")
    return folder / "s.toml"


@pytest.mark.filterwarnings("ignore::cuefem.PlausibilityWarning")
def test_options_of_the_cue_in_a_study_are_those_of_load(tmp_path: Path) -> None:
    keys = "".join(f'{name} = "{text}"\n' for name, text in OPTIONS.items())
    masses = 'body_mass = "15 oz"\nshaft_mass = "4 oz"\n'
    study = load_study(of_profile(tmp_path, f'game = "snooker"\n{keys}'))
    drawn = cf.load(tmp_path / "shaft.csv", **OPTIONS)
    assert study.base == cf.usual_scene(drawn, "snooker")
    weighed = load_study(of_profile(tmp_path, keys + masses)).base
    ounce = 0.028349523125
    assert weighed == cf.with_parameters(cf.usual_scene(drawn), {"body_mass": 15 * ounce, "shaft_mass": 4 * ounce})
    unnamed = PROFILE.replace(" [mm]", "")
    file = of_profile(tmp_path, 'length_unit = "mm"', unnamed)
    assert load_study(file).base == cf.usual_scene(cf.load(tmp_path / "shaft.csv", length_unit="mm"))


def test_invalid_key_of_the_cue_is_rejected(tmp_path: Path, request: pytest.FixtureRequest) -> None:
    messages = {}
    for row in stored_rows("study_keys"):
        profile = PROFILE.replace(" [mm]", "") if row.startswith("length_unit") else PROFILE
        messages[row] = rejected(tmp_path, "study", of_profile(tmp_path, row, profile))
    assert_refused("study_keys", messages, request)


@pytest.mark.filterwarnings("ignore::cuefem.PlausibilityWarning")  # the same cone twice, one behind the other
def test_study_file_ranges_are_read(tmp_path: Path) -> None:
    text = STRIKES.replace('low = "0 mm"\nhigh = "13 mm"', 'median = "5 mm"\nsd = "1 mm"')
    text = text.replace("low = 0.7\nhigh = 1.3", 'median = 1\nsd = 0.2\nspacing = "logarithmic"')
    text += '[[vary]]\npath = "cue.segments[0].length"\nlow = "-5 mm"\nhigh = "5 mm"\nshift = true\n'
    text += 'compensating_path = "cue.segments[1].length"\n'
    two = SCENE.replace("[tip]", SCENE[SCENE.index("[[") : SCENE.index("[tip]")] + "[tip]")
    result = load_study(write_study(tmp_path, text, two))
    bore, modulus, length = result.vary
    assert (bore.range, modulus.range) == (Normal(5e-3, 1e-3), Normal(1, 0.2, logarithmic=True))
    assert (length.range, length.shift) == (Span(-5e-3, 5e-3), True)
    assert length.compensating_path == ("cue.segments[1].length",)
    assert result.units[:3] == ("m", "", "m")


def test_result_saves_what_the_command_writes(tmp_path: Path) -> None:
    """Each output in its own units: a page in inches beside metric JSON; tables and the best design byte for byte."""
    path = write_study(tmp_path, GRID)
    outputs = {kind: tmp_path / f"asked.{kind}" for kind in ("html", "json", "csv", "toml")}
    text = stdout_of("study", path, "--units", "us", *(part for each in outputs.values() for part in ("-o", each)))
    assert ".472, .492 in" in text
    assert ".472" in outputs["html"].read_text(encoding="utf-8")
    assert "61.5 mm" in outputs["json"].read_text(encoding="utf-8")
    found = cf.study(path)
    for kind in ("csv", "toml"):
        found.save(tmp_path / f"saved.{kind}")
        assert (tmp_path / f"saved.{kind}").read_bytes() == outputs[kind].read_bytes()
