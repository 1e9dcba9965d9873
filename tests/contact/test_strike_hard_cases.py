"""Strikes that break solvers: each case has its reason. None may raise, hang, return NaN or lose energy."""

from dataclasses import replace
from itertools import product
from pathlib import Path

import numpy as np
import pytest

from cuefem import Ball, Cue, LumpedCue, Outcome, Resolution, Scene, Segment, Stroke, Tip, impulse, strike
from cuefem.contact.rigid_impact import inverse_mass
from tests.helpers.strike_scenes import (
    KIM,
    KIM_AT,
    kim_scene,
    maple,
    pool_cue,
    sound,
    stepped_cue,
    uniform_rod,
    weighted_cue,
)

ROOT = Path(__file__).parents[2]
FEW = Resolution(4, 12, 12)


def hit(scene: Scene, at: Resolution | None = KIM_AT) -> Outcome:
    outcome = strike(scene, at)
    sound(outcome)
    return outcome


def on(cue: Cue, *offsets: float, **tip: float) -> list[Scene]:
    return [replace(kim_scene(offset, **tip), cue=cue) for offset in offsets]


# A needle of 0.2 mm in front of the shaft: its own mode rings at tens of kHz, and its mass is a milligram.
NEEDLE = Cue((Segment(0.004, 0.0002, 0.0002, maple()), *KIM.segments), 0.42)
SOUND = {
    "leather 100 times softer than the wood on a ferrule of a millimetre": (on(pool_cue(ferrule=0.001), 0.3), KIM_AT),
    "the same with the modes of a default": (on(pool_cue(ferrule=0.001), 0.3), None),
    "radius steps of five to one, and bending stiffness of 625 to 1": (on(stepped_cue(), 0.1, 0.5), KIM_AT),
    "0.3 kg on the butt's last 4 mm": (on(weighted_cue(), 0.3), KIM_AT),
    "a segment short and thin": (on(NEEDLE, 0.3), KIM_AT),
    "a stub of 6 cm that rings far above the contact's frequency": (on(uniform_rod(10), 0.3), FEW),
    "a rod of 60 m far below it": (on(uniform_rod(1e4), 0.3), FEW),
    "a miscue that presses a ringing tip on": ([kim_scene(b, restitution=0.05) for b in (0.999, 0.9)], FEW),
}


@pytest.mark.parametrize("why", SOUND)
def test_it_is_sound(why: str) -> None:
    scenes, at = SOUND[why]
    squirts = [np.degrees(hit(scene, at).squirt) for scene in scenes]
    if why.startswith(("leather", "the same", "0.3 kg")):  # squirt hardly moves from that of Kim's shaft, 1.13
        assert 0.57 < squirts[0] < 2.2


@pytest.mark.parametrize("end_mass", [0.003, 0.05, 1.0])
def test_friction_of_exactly_mu_c(end_mass):
    """Stick needs exactly mu_c, so |F_t| = mu F_n for the whole of it, but for rounding: it must not chatter."""
    cue, ball = LumpedCue(0.54, end_mass), Ball()
    B = inverse_mass(cue, ball, 0.4)
    scene = Scene(cue, ball, Tip(0.75, abs(float(B.tn / B.tt))), Stroke(offset=0.4))
    outcome = hit(scene, None)
    assert abs(outcome.squirt - impulse(scene).squirt) < 1e-5
    assert len(outcome.phases) <= 6


def test_grazing():
    """|b/R| within 1e-12 of 1: the normal speed is 1e-6 of the cue's, the contact all slip."""
    for offset, cue in product((1 - 1e-6, 1 - 1e-9, 1 - 1e-12), (KIM, LumpedCue(0.54, 0.003))):
        outcome = hit(replace(kim_scene(offset), cue=cue), FEW)
        assert abs(np.tan(np.arcsin(offset) - outcome.squirt) - 0.7) < 1e-6
