"""Every field of a scene can be edited, and nothing else changes (properties)."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest

import cuefem as cf
from cuefem.designer import editing
from cuefem.designer.start import first_scene
from cuefem.effects import effect_kinds
from cuefem.games import GAMES
from cuefem.io.ready import PRESETS, opened
from cuefem.parts import materials_in
from cuefem.vary import knobs_of, replaced, turned, value_at

NAMES = [preset.name for preset in PRESETS]
ROOT = Path(__file__).parents[2]


@pytest.fixture(scope="module")
def scenes() -> dict[str, cf.Scene]:
    return {preset.name: opened(preset)[0] for preset in PRESETS}


def test_all_ready_cues_and_scenes_are_on_offer() -> None:
    names = {path.stem for folder in ("meshes", "studies/scenes") for path in (ROOT / folder).glob("*.toml")}
    assert {Path(preset.file).stem for preset in PRESETS} == names
    assert all(preset.measured for preset in PRESETS)


@pytest.mark.parametrize("name", NAMES)
def test_every_number_is_edited_where_it_is(scenes: dict[str, cf.Scene], name: str) -> None:
    scene = scenes[name]
    things = {("ball",): scene.ball, ("tip",): scene.tip, ("stroke",): scene.stroke}
    things |= {("cue", "segments", i): s for i, s in enumerate(scene.cue.segments)}
    things |= {("effects", i): e for i, e in enumerate(scene.effects)}
    for at, thing in things.items():
        for field in editing.fields_of(thing, at):
            assert value_at(scene, field.path) == field.value
            if field.value is None or field.value in (0.0, float("inf")):
                continue
            if field.path[-1] == "surface_restitution":  # below 1, its upper bound, it asks for rings that slip
                continue
            made = replaced(scene, {field.path: field.value * (1 + 1e-4)})
            assert value_at(made, field.path) == field.value * (1 + 1e-4)
            assert replaced(made, {field.path: field.value}) == scene


def test_segments_are_split_added_and_removed() -> None:
    scene = first_scene()
    halved = editing.split(scene, 1)
    assert halved.cue.length == pytest.approx(scene.cue.length, rel=1e-15)
    assert halved.cue.shaft_mass == pytest.approx(scene.cue.shaft_mass, rel=1e-12)
    longer = editing.added(scene, 3)
    assert longer.cue.length == pytest.approx(scene.cue.length + 0.05)
    assert editing.removed(longer, 4) == scene
    one = replace(scene, cue=replace(scene.cue, segments=scene.cue.segments[1:2]))
    with pytest.raises(ValueError, match=r"^a cue needs a segment: this is the last one$"):
        editing.removed(one, 0)


def test_a_material_of_ones_own_is_everywhere() -> None:
    scene = first_scene()
    i = [m.E for m in materials_in(scene.cue)].index(cf.load(ROOT / "meshes/pool_maple.toml").segments[2].material.E)
    made = replaced(scene, {("materials", i, "E"): 15e9})
    assert made.cue.segments[0].core == made.cue.segments[1].material == made.cue.segments[-1].material
    assert made.cue.segments[1].material.E == 15e9


@pytest.mark.parametrize("kind", effect_kinds())
def test_every_effect_is_switched_on_and_off(kind: str) -> None:
    scene = replace(first_scene(), effects=())
    made = editing.with_effect(scene, editing.new_effect(scene, kind))
    assert type(made.effects[-1]).__name__ == kind
    assert editing.without_effect(made, 0) == scene


@pytest.mark.parametrize("game", GAMES)
def test_a_game_is_chosen(game: str) -> None:
    maple = cf.load(ROOT / "meshes/pool_maple.toml")
    scene = turned(first_scene(), {**knobs_of(first_scene()), "bridge_stiffness": 5e3})
    if game == "snooker":  # its dome is too round for a tip so wide
        scene = turned(scene, {**knobs_of(scene), "tip_diameter": 0.0095, "tip_height": 0.004})
    made = editing.with_game(scene, game)
    assert editing.game_of(made) == game
    assert made.stroke.speed == GAMES[game].speed
    assert cf.Support(0.2032, 5e3) in made.effects
    assert maple.body_mass == made.cue.body_mass
