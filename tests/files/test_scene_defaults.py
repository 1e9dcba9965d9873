"""Missing keys of a scene file have the values of its game (properties)."""

import warnings
from dataclasses import replace
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

import cuefem as cf
from cuefem.scene.default_scene import GAMES
from tests.helpers.examples import examples

CUE = """
body_mass = "430 g"
segments = [
  { length = "5 mm", tip_diameter = "12.7 mm", butt_diameter = "12.7 mm", material = "leather" },
  { length = "700 mm", tip_diameter = "12.7 mm", butt_diameter = "21 mm", material = "hard maple" },
]
"""
TABLES = {
    "ball": {"mass": '"165 g"', "radius": '"28 mm"'},
    "tip": {"restitution": "0.8", "friction": "0.55"},
    "stroke": {"speed": '"2.5 m/s"', "offset": "0.21"},
}
KEYS = [(part, name) for part, names in TABLES.items() for name in names]


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    directory = tmp_path_factory.mktemp("scenes")
    (directory / "cue.toml").write_text(CUE, encoding="utf-8")
    return directory


def cue_of(folder: Path) -> cf.Cue:
    result = cf.load(folder / "cue.toml")
    assert isinstance(result, cf.Cue)
    return result


def loaded(folder: Path, text: str) -> cf.Scene:
    (folder / "scene.toml").write_text(f"{text.strip()}\n", encoding="utf-8")
    result = cf.load(folder / "scene.toml")
    assert isinstance(result, cf.Scene)
    return result


@examples(12)
@given(present=st.sets(st.sampled_from(KEYS)), effects=st.booleans(), game=st.sampled_from([*GAMES]))
def test_scene_missing_keys_default_to_the_game(folder: Path, present, effects, game) -> None:
    rows = [f'game = "{game}"', 'cue = "cue.toml"', *(["effects = []"] if effects else [])]
    for part in TABLES:
        inside = [f"{name} = {TABLES[part][name]}" for other, name in sorted(present) if other == part]
        rows += [f"[{part}]", *inside] if inside else []
    result, usual = loaded(folder, "\n".join(rows)), cf.usual_scene(cue_of(folder), game)
    if effects:  # without axial waves the tip has the restitution of the whole cue
        tip = replace(usual.tip, restitution=GAMES[game].restitution)
        usual = replace(usual, cue=cue_of(folder), tip=tip, effects=())
    values = {"mass": 0.165, "radius": 0.028, "restitution": 0.8, "friction": 0.55, "speed": 2.5, "offset": 0.21}
    for part in TABLES:
        changes = {name: values[name] for other, name in present if other == part}
        usual = replace(usual, **{part: replace(getattr(usual, part), **changes)})
    assert result == usual
    cf.save(result, folder / "again.toml")
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert cf.load(folder / "again.toml") == result


def test_scene_with_spring_tip_gets_no_leather(folder: Path) -> None:
    result = loaded(folder, 'game = "pool"\ncue = "cue.toml"\n[tip]\ncontact_time = "1.1 ms"')
    assert [type(effect).__name__ for effect in result.effects] == ["AxialWaves", "GeometricStiffness"]
    assert result.cue == cue_of(folder)
    lumped = loaded(folder, 'game = "pool"\n[cue]\nmass = "540 g"\nend_mass = "6 g"')
    assert lumped == cf.Scene(lumped.cue, GAMES["pool"].ball, cf.Tip(0.73, 0.7), cf.Stroke(2.0, 0.3))
