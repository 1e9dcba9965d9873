"""What a cue alone is given, by the game: a tip for the drawn leather, and times as published (properties)."""

from dataclasses import replace
from pathlib import Path

import pytest

import cuefem as cf
from cuefem.cue.materials import LEATHERS, material
from cuefem.scene.default_scene import GAMES, usual_tip
from tests.helpers.refusals import refuses

ROOT = Path(__file__).parents[2]
WOOD = cf.Segment(0.7, 0.0118, 0.021, material("hard maple"))


def leather(length: float) -> cf.Segment:
    return cf.Segment(length, 0.0118, 0.0118, material("leather"))


@pytest.mark.parametrize("name", LEATHERS)
def test_a_leather_touches_the_ball_as_long_as_it_says(name: str) -> None:
    scene = cf.load(ROOT / "studies/measured/leather_tip.toml")
    assert isinstance(scene, cf.Scene)
    known = LEATHERS[name]
    tip = replace(scene.leather, E=known.E, nu=known.nu, rho=known.rho)
    assert replace(scene, effects=(tip,)).contact_time == pytest.approx(known.contact_time, rel=3e-3)
    assert len(known.source) > 40


@pytest.mark.parametrize("game", GAMES)
def test_a_cue_without_leather_gets_the_game_s_tip_on_what_is_drawn(game: str) -> None:
    cue = cf.Cue((WOOD,), 0.4)
    scene, known = cf.usual_scene(cue, game), GAMES[game]
    assert scene.cue == cue
    waves = cf.AxialWaves(known.cue_length, known.butt_diameter, 4430.0)
    assert set(scene.effects) == {known.tip, waves, cf.GeometricStiffness()}
    assert (scene.ball, scene.stroke) == (known.ball, cf.Stroke(known.speed, known.offset))
    assert scene.tip == cf.Tip(known.tip_restitution, known.friction)
    assert known.tip.E == LEATHERS["medium"].E
    assert 2e-4 < scene.contact_time < 3e-3
    assert len(known.source) > 40


def test_the_drawn_leather_is_the_tip_s_height() -> None:
    drawn = cf.Cue((leather(3e-3), leather(2e-3), WOOD), 0.4)
    scene = cf.usual_scene(drawn)
    assert scene.cue == cf.Cue((WOOD,), 0.4)
    assert scene.leather == replace(GAMES["pool"].tip, height=5e-3)
    assert usual_tip(drawn, "snooker").height == 5e-3
    assert cf.usual_scene(drawn, tip=replace(scene.leather, height=7e-3)).leather.height == 7e-3


@pytest.mark.parametrize("game", GAMES)
def test_the_usual_cue_of_a_game_rebounds_as_measured(game: str) -> None:
    """The measured restitution is the whole cue's: the tip's own is derived from it, here again to its four digits."""
    known = GAMES[game]
    drawn = cf.load(ROOT / known.cue)
    scene = cf.usual_scene(drawn if isinstance(drawn, cf.Cue) else drawn.shaft, game)
    assert scene.tip.restitution == pytest.approx(cf.tip_restitution(scene, known.restitution), abs=5.1e-5)
    assert cf.rebound(scene) == pytest.approx(known.restitution, abs=1e-4)
    assert cf.rebound(replace(scene, effects=(scene.leather,))) == pytest.approx(scene.tip.restitution, rel=1e-4)


def test_a_rebound_that_no_tip_gives_is_refused() -> None:
    scene = cf.usual_scene(cf.Cue((WOOD,), 0.4))
    refuses(lambda: cf.tip_restitution(scene, 0.15), "tip_restitution measured must be in [0.")
    refuses(lambda: cf.tip_restitution(scene, 1.2), "tip_restitution measured must be in [0.1, 1]; got 1.2")


@pytest.mark.parametrize("game", GAMES)
def test_a_cue_whose_tip_is_drawn_is_struck_with_all_that_a_usual_stroke_has(game: str) -> None:
    bare = cf.usual_scene(cf.Cue((WOOD,), 0.4), game)
    drawn = cf.usual_scene(cf.Cue((leather(bare.leather.height), WOOD), 0.4), game)
    assert drawn == bare
    assert cf.strike(drawn).squirt == cf.strike(bare).squirt


def test_refusals() -> None:
    refuses(
        lambda: cf.usual_scene(cf.Cue((WOOD,)), "croquet"), "game must be one of pool, carom, snooker; got 'croquet'"
    )
    refuses(lambda: usual_tip(cf.Cue((WOOD,)), "golf"), "game must be one of pool, carom, snooker; got 'golf'")
    refuses(
        lambda: cf.usual_scene(cf.LumpedCue(0.5, 0.01)), "TypeError: usual_scene cue must be a Cue; got a LumpedCue"
    )
    refuses(lambda: cf.usual_scene(cf.Cue((leather(1e-3), WOOD))), "higher than 2.054 mm, the depth of its dome")
