"""Default scenes of a cue: tip, ball, stroke and effects of the game (properties)."""

import math
from dataclasses import replace

import pytest

import cuefem as cf
from cuefem.cue.materials import LEATHERS, material
from cuefem.scene.default_scene import GAMES, default_tip

WOOD = cf.Segment(0.7, 0.0118, 0.021, material("hard maple"))


def leather(length: float) -> cf.Segment:
    return cf.Segment(length, 0.0118, 0.0118, material("leather"))


def test_default_tip_has_height_of_drawn_leather() -> None:
    cue = cf.Cue((leather(3e-3), leather(2e-3), WOOD), 0.4)
    scene = cf.usual_scene(cue)
    assert scene.cue == cf.Cue((WOOD,), 0.4)
    assert scene.leather_tip == replace(GAMES["pool"].tip, height=5e-3)
    assert default_tip(cue, "snooker").height == 5e-3
    assert cf.usual_scene(cue, tip=replace(scene.leather_tip, height=7e-3)).leather_tip.height == 7e-3


def test_axial_waves_short_butt_is_rigid_mass() -> None:
    """A cue drawn up to 3 mm before the butt, with 100 g behind it."""
    cue = cf.Cue((WOOD, cf.Segment(0.7702, 0.021, 0.031, material("hard maple"))), body_mass=0.1)
    scene = cf.usual_scene(cue)
    effects = tuple(cf.AxialWaves() if isinstance(effect, cf.AxialWaves) else effect for effect in scene.effects)
    rigid = replace(scene, effects=effects)
    assert cf.strike(scene).squirt == cf.strike(rigid).squirt


def test_restitution_of_stated_modulus_lies_between_named_leathers() -> None:
    """Equal to a named leather's at its modulus; without axial waves, the whole cue's."""

    def restitution(E: float) -> float:
        effects = (replace(GAMES["pool"].tip, E=E), cf.AxialWaves())
        return float(GAMES["pool"].tip_with(effects).restitution)

    for leather in LEATHERS.values():
        assert restitution(leather.E) == leather.restitution
    assert GAMES["pool"].tip_with((GAMES["pool"].tip,)) == cf.Tip(0.73, 0.7)
    assert LEATHERS["medium"].restitution < restitution(100e6) < LEATHERS["soft"].restitution == restitution(10e6)


@pytest.mark.parametrize("restitution", [0.3, 1.0])
def test_stiffness_and_contact_time_declare_one_tip(restitution: float) -> None:
    """A spring k between masses M and m_a loads for a quarter of its period; restitution scales the unloading."""
    timed = cf.Scene(cf.LumpedCue(0.5, 0.006), tip=cf.Tip(restitution, contact_time=1.2e-3))
    quarter = 1.2e-3 / (1 + restitution)
    assert timed.stiffness == pytest.approx((math.pi / 2 / quarter) ** 2 / (1 / timed.ball.mass + 1 / 0.5), rel=1e-12)
    stiff = replace(timed, tip=cf.Tip(restitution, stiffness=timed.stiffness))
    assert (stiff.contact_time, stiff.stiffness) == pytest.approx((1.2e-3, timed.stiffness), rel=1e-12)
    assert cf.strike(stiff).squirt == pytest.approx(cf.strike(timed).squirt, rel=1e-9)
