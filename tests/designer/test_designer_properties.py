"""The designer's knobs and fields: what they move, what they leave alone, and that it comes back (properties)."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import cuefem as cf
from cuefem.cli.common import scene_of
from cuefem.designer import editing
from cuefem.designer.design import Design
from cuefem.designer.sliders import choices, sliders, without
from cuefem.designer.start import first_cue, first_scene
from cuefem.designer.unit_system import INCHES
from cuefem.designer.words import head_markup
from cuefem.effects import effect_kinds
from cuefem.games import GAMES
from cuefem.io.ready import PRESETS
from cuefem.materials import MATERIALS
from cuefem.parts import materials_in, outer_diameter, taper_position
from cuefem.vary import FERRULES, SHAFTS, knobs_of, replaced, turned, value_at

ROOT = Path(__file__).parents[2]
FILES = [*sorted((ROOT / "meshes").glob("*.toml")), *sorted((ROOT / "studies" / "scenes").glob("*.toml"))]
SCENES = {f"{path.parent.name}/{path.stem}": scene_of(path, {"body_mass": None, "material": None})[0] for path in FILES}


def close(a: dict[str, Any], b: dict[str, Any]) -> bool:
    def same(x: object, y: object) -> bool:
        return x == pytest.approx(y, rel=1e-9, abs=1e-12) if isinstance(x, float) else x == y

    return a.keys() == b.keys() and all(same(a[key], b[key]) for key in a)


@pytest.mark.parametrize("name", SCENES)
def test_knobs_where_they_stand_change_nothing(name: str) -> None:
    scene = SCENES[name]
    assert turned(scene, knobs_of(scene)) is scene
    own = knobs_of(scene)
    for slider, metric in zip(sliders(scene, INCHES), sliders(scene), strict=True):
        for each in (slider, metric):
            assert each.turned(own, each.shown(own)) == own
            assert each.low <= each.shown(own) <= each.high
        assert (slider.unit == "in") == (metric.unit == "mm")
        for mine, theirs in ((slider.most, metric.most), (slider.least, metric.least)):
            assert mine / slider.scale == pytest.approx(theirs / metric.scale, rel=1e-9, abs=1e-12)


@pytest.mark.parametrize("name", SCENES)
def test_every_slider_moves_what_it_says_and_nothing_else(name: str) -> None:
    scene = SCENES[name]
    own = knobs_of(scene)
    for slider in sliders(scene):
        if slider.knob in ("joint_position", "bridge_position"):  # there is none to move, or only a clamp
            continue
        here = slider.shown(own)
        there = here + slider.step if here + slider.step <= slider.high else here - slider.step
        if slider.knob == "bore_width" and own["bore_depth"] == 0:
            own = {**own, "bore_depth": 0.05}
        wanted = slider.turned(own, there)
        made = turned(scene, wanted)
        assert close(knobs_of(made), wanted), slider.knob
        assert made.cue.length == pytest.approx(scene.cue.length, rel=1e-12)
        assert made.ball == scene.ball
    # what has no knob stays, and what the others move
    made = turned(scene, {**knobs_of(scene), "tip_diameter": own["tip_diameter"] + 1e-4, "joint_compliance": 1e-4})
    assert made.cue.body_mass == scene.cue.body_mass
    assert {s.material for s in made.cue.segments if s.core} == {s.material for s in scene.cue.segments if s.core}
    assert [effect for effect in made.effects if not isinstance(effect, cf.Joint)] == list(scene.effects)
    assert (made.stroke, made.tip) == (scene.stroke, scene.tip)


RANGES = dict(
    tip_diameter=(0.010, 0.014),
    taper_diameter=(0.012, 0.016),
    butt_diameter=(0.018, 0.024),
    bore_depth=(0.01, 0.3),
    bore_width=(0.002, 0.007),
    ferrule_length=(0.002, 0.04),
    joint_position=(0.1, 0.7),
    joint_compliance=(1e-5, 5e-3),
    contact_time=(6e-4, 3e-3),
    tip_height=(0.004, 0.012),
    dome=(0.0085, 0.02),
    leather=(3e7, 4e8),
    restitution=(0.5, 0.9),
    friction=(0.3, 1.0),
    bridge_position=(0.1, 0.5),
    bridge_stiffness=(100.0, 1e4),
    speed=(0.5, 10.0),
    offset=(0.0, 0.6),
    body_mass=(0.0, 0.6),
)
WOODS = {"ferrule_material": FERRULES, "shaft_material": SHAFTS}
KNOBS = st.fixed_dictionaries(
    {knob: st.floats(*ends) for knob, ends in RANGES.items()}
    | {knob: st.sampled_from([MATERIALS[name].material for name in names]) for knob, names in WOODS.items()}
)


@pytest.mark.parametrize("name", ["meshes/pool_maple", "meshes/pool_hollow", "scenes/snooker"])
@given(wanted=KNOBS)
def test_knobs_come_back_from_the_scene_they_made(name: str, wanted: dict[str, Any]) -> None:
    scene = SCENES[name]
    own = knobs_of(scene)
    wanted = own | {knob: value for knob, value in wanted.items() if knob in own}
    made = turned(scene, wanted)
    assert close(knobs_of(made), wanted)
    assert turned(made, knobs_of(made)) == made
    assert made.cue.length == pytest.approx(scene.cue.length, rel=1e-12)


@pytest.mark.parametrize("name", SCENES)
def test_the_drawing_changes_only_between_the_knobs(name: str) -> None:
    scene = SCENES[name]
    cue, own = scene.cue, knobs_of(scene)
    thicker = turned(scene, {**own, "taper_diameter": own["taper_diameter"] + 1e-3}).cue
    for x in np.linspace(0, cue.length, 41):
        hat = np.interp(x, [0, taper_position(cue), cue.length], [0, 1e-3, 0])
        assert outer_diameter(thicker, x) == pytest.approx(outer_diameter(cue, x) + hat, rel=1e-9)


def test_a_whole_new_bore_takes_out_its_wood() -> None:
    scene = first_scene()
    made = turned(scene, {**knobs_of(scene), "bore_depth": 0.1, "bore_width": 0.006})
    gone = np.pi / 4 * 0.006**2 * 0.1 * MATERIALS["hard maple"].material.rho
    assert scene.cue.shaft_mass - made.cue.shaft_mass == pytest.approx(gone, rel=1e-9)
    assert [segment.tip_bore for segment in made.cue.segments] == [0.00794, 0.006, 0, 0, 0]


def test_the_first_scene_is_the_maple_shaft_of_meshes() -> None:
    assert first_scene() == SCENES["meshes/pool_maple"]


def test_what_cannot_be_turned_is_said() -> None:
    follows = "the contact time follows from the leather tip, so there is no knob for it"
    assert without(SCENES["meshes/carbon"]) == ["the bore behind the tip is filled, so it stays as it is", follows]
    assert without(SCENES["meshes/kim"]) == ["no ferrule is drawn behind the tip, so there is no knob for it", follows]
    assert without(SCENES["scenes/kim"]) == ["no ferrule is drawn behind the tip, so there is no knob for it"]


def test_the_files_own_materials_are_offered() -> None:
    own = SCENES["meshes/kim"]
    (shaft,) = choices(own)
    assert shaft.name(knobs_of(own)) == "the file's own (E 12.6 GPa)"
    ferrule, shaft = choices(first_scene())
    assert (ferrule.name(knobs_of(first_scene())), shaft.name(knobs_of(first_scene()))) == ("melamine", "hard maple")
    assert set(shaft.materials) | set(ferrule.materials) == set(MATERIALS) - {"leather", "foam"}


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"bore_depth": 0.1, "bore_width": 0.013}, "the bore must be narrower than the cue, 12.8 mm there; got 13 mm"),
        ({"bore_depth": 0.9}, "the bore must be at most 705.6 mm deep; got 900 mm"),
        (
            {"ferrule_length": 0.4},
            "more than 0 and less than 324.2 mm long, as its neighbours allow; got 400 mm",
        ),
        ({"butt_diameter": -0.001}, "the cue must be thicker than nothing; got -1 mm"),
        ({"joint_compliance": 1e-3, "joint_position": 0.8}, "must be in (0, 0.7306) m"),
        ({"tip_height": 0.1}, "must be 0.638 to 38.2 mm high; got 100 mm"),
        ({"restitution": 1.1}, "Tip.restitution must be in [0, 1]; got 1.1"),
    ],
)
def test_no_impossible_cue_is_made(changes: dict[str, float], words: str) -> None:
    scene = first_scene()
    with pytest.raises(ValueError, match=r"must") as refused:
        turned(scene, {**knobs_of(scene), **changes})
    assert words in str(refused.value)


def test_a_lumped_cue_has_no_knobs() -> None:
    with pytest.raises(
        ValueError, match=r"Scene.cue must be a Cue of segments: its modes or its shape are needed; got a LumpedCue"
    ):
        knobs_of(cf.Scene(cf.LumpedCue(0.5, 0.006)))


def test_what_is_unusual_is_not_said_to_be_assumed() -> None:
    scene = replace(first_scene(), ball=cf.Ball(radius=0.05715))
    head = head_markup(Design.of("mine.toml", scene, ["material hard maple"]))
    assert "assumed: material hard maple<" in head
    assert ">unusual: ball radius 57.15 mm" in head
    assert "unusual" not in head_markup(Design.of("mine.toml", first_scene()))
    assert ">unusual: ball radius 2.250 in" in head_markup(Design.of("mine.toml", scene), INCHES)


@pytest.mark.parametrize("game", GAMES)
def test_the_bounce_is_labelled_with_its_own_game(game: str) -> None:
    """What a tip by itself needs for a cue's 0.73 is another number in each game; without waves none stands."""
    scene = cf.usual_scene(first_cue(), game)
    (label,) = (slider.label for slider in sliders(scene) if slider.knob == "restitution")
    assert label == f"Bounce of the tip, e ({GAMES[game].tip_restitution:.2f} is a cue's 0.73)"
    still = replace(scene, effects=tuple(effect for effect in scene.effects if not isinstance(effect, cf.AxialWaves)))
    (label,) = (slider.label for slider in sliders(still) if slider.knob == "restitution")
    assert label == "Bounce of the tip, e"


def test_all_ready_cues_and_scenes_are_on_offer() -> None:
    assert {Path(preset.file).stem for preset in PRESETS} == {path.stem for path in FILES}
    assert all(preset.measured for preset in PRESETS)


@pytest.mark.parametrize("name", SCENES)
def test_every_number_is_edited_where_it_is(name: str) -> None:
    scene = SCENES[name]
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
    last = replace(scene, cue=replace(scene.cue, segments=scene.cue.segments[1:2]))
    with pytest.raises(ValueError, match=r"^a cue needs a segment: this is the last one$"):
        editing.removed(last, 0)


def test_a_material_of_ones_own_is_everywhere() -> None:
    scene = first_scene()
    i = [m.E for m in materials_in(scene.cue)].index(scene.cue.segments[2].material.E)
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
    scene = turned(first_scene(), {**knobs_of(first_scene()), "bridge_stiffness": 5e3})
    if game == "snooker":  # its dome is too round for a tip so wide
        scene = turned(scene, {**knobs_of(scene), "tip_diameter": 0.0095, "tip_height": 0.004})
    made = editing.with_game(scene, game)
    assert editing.game_of(made) == game
    assert made.stroke.speed == GAMES[game].speed
    assert cf.Support(0.2032, 5e3) in made.effects
    assert scene.cue.body_mass == made.cue.body_mass
