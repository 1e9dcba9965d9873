"""The designer's knobs: what they leave alone, and that they come back from what they made (properties)."""

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
from cuefem.designer.sliders import choices, sliders, without
from cuefem.designer.start import first_cue, first_scene
from cuefem.games import GAMES
from cuefem.materials import MATERIALS
from cuefem.parts import outer_diameter, taper_position
from cuefem.vary import FERRULES, SHAFTS, knobs_of, turned

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
    for slider in sliders(scene):
        assert slider.turned(knobs_of(scene), slider.shown(knobs_of(scene))) == knobs_of(scene)
        assert slider.low <= slider.shown(knobs_of(scene)) <= slider.high


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


@pytest.mark.parametrize("name", SCENES)
def test_what_has_no_knob_is_kept(name: str) -> None:
    scene = SCENES[name]
    own = knobs_of(scene)
    wanted = {**own, "tip_diameter": own["tip_diameter"] + 1e-4, "joint_compliance": 1e-4}
    made = turned(scene, wanted)
    assert made.cue.body_mass == scene.cue.body_mass
    assert {s.material for s in made.cue.segments if s.core} == {s.material for s in scene.cue.segments if s.core}
    assert [effect for effect in made.effects if not isinstance(effect, cf.Joint)] == list(scene.effects)
    assert made.stroke == scene.stroke
    assert made.tip == scene.tip


def of(scene: cf.Scene, wanted: dict[str, Any]) -> dict[str, Any]:
    """A scene's knobs where they are wanted; those that it does not have stay away."""
    own = knobs_of(scene)
    return {**own, **{name: value for name, value in wanted.items() if name in own}}


@st.composite
def knobs(draw: st.DrawFn) -> dict[str, Any]:
    def between(low: float, high: float) -> float:
        return draw(st.floats(low, high))

    return dict(
        tip_diameter=between(0.010, 0.014),
        taper_diameter=between(0.012, 0.016),
        butt_diameter=between(0.018, 0.024),
        bore_depth=between(0.01, 0.3),
        bore_width=between(0.002, 0.007),
        ferrule_length=between(0.002, 0.04),
        ferrule_material=MATERIALS[draw(st.sampled_from(FERRULES))].material,
        shaft_material=MATERIALS[draw(st.sampled_from(SHAFTS))].material,
        joint_position=between(0.1, 0.7),
        joint_compliance=between(1e-5, 5e-3),
        contact_time=between(6e-4, 3e-3),
        tip_height=between(0.004, 0.012),
        dome=between(0.0085, 0.02),
        leather=between(3e7, 4e8),
        restitution=between(0.5, 0.9),
        friction=between(0.3, 1.0),
        bridge_position=between(0.1, 0.5),
        bridge_stiffness=between(100.0, 1e4),
        speed=between(0.5, 10),
        offset=between(0, 0.6),
        body_mass=between(0, 0.6),
    )


@pytest.mark.parametrize("name", ["meshes/pool_maple", "meshes/pool_hollow", "scenes/snooker"])
@given(wanted=knobs())
def test_knobs_come_back_from_the_scene_they_made(name: str, wanted: dict[str, Any]) -> None:
    wanted = of(SCENES[name], wanted)
    made = turned(SCENES[name], wanted)
    found = knobs_of(made)
    assert close(found, wanted)
    assert turned(made, found) == made
    assert made.cue.length == pytest.approx(SCENES[name].cue.length, rel=1e-12)


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
    assert first_cue() == cf.load(ROOT / "meshes/pool_maple.toml")
    assert first_scene() == cf.usual_scene(first_cue())  # as `cuefem designer meshes/pool_maple.toml` opens it
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
    from cuefem.designer.design import Design
    from cuefem.designer.unit_system import INCHES
    from cuefem.designer.words import head_markup

    scene = replace(first_scene(), ball=cf.Ball(radius=0.05715))
    head = head_markup(Design.of("mine.toml", scene, ["material hard maple"]))
    assert "assumed: material hard maple<" in head
    assert ">unusual: ball radius 57.15 mm" in head
    assert "unusual" not in head_markup(Design.of("mine.toml", first_scene()))
    assert ">unusual: ball radius 2.250 in" in head_markup(Design.of("mine.toml", scene), INCHES)


@pytest.mark.parametrize("name", SCENES)
def test_sliders_in_inches_turn_the_same_knobs(name: str) -> None:
    from cuefem.designer.unit_system import INCHES

    own = knobs_of(SCENES[name])
    for slider, metric in zip(sliders(SCENES[name], INCHES), sliders(SCENES[name]), strict=True):
        assert slider.turned(own, slider.shown(own)) == own
        assert (slider.unit == "in") == (metric.unit == "mm")
        assert slider.low <= slider.shown(own) <= slider.high
        for mine, theirs in ((slider.most, metric.most), (slider.least, metric.least)):
            assert mine / slider.scale == pytest.approx(theirs / metric.scale, rel=1e-9, abs=1e-12)


def test_half_an_inch_is_saved_as_such() -> None:
    from cuefem.designer.unit_system import INCHES

    tip = sliders(first_scene(), INCHES)[0]
    assert tip.turned(knobs_of(first_scene()), 0.5)["tip_diameter"] == 0.0127


@pytest.mark.parametrize("game", GAMES)
def test_the_bounce_is_labelled_with_its_own_game(game: str) -> None:
    """What a tip by itself needs for a cue's 0.73 is another number in each game; without waves none stands."""
    scene = cf.usual_scene(first_cue(), game)
    (label,) = (slider.label for slider in sliders(scene) if slider.knob == "restitution")
    assert label == f"Bounce of the tip, e ({GAMES[game].tip_restitution:.2f} is a cue's 0.73)"
    still = replace(scene, effects=tuple(effect for effect in scene.effects if not isinstance(effect, cf.AxialWaves)))
    (label,) = (slider.label for slider in sliders(still) if slider.knob == "restitution")
    assert label == "Bounce of the tip, e"
