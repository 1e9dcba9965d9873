"""Strikes that break solvers: each case has its reason. None may raise, hang, return NaN or lose energy."""

from dataclasses import replace
from itertools import product
from math import inf
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from cuefem import Ball, Cue, LumpedCue, Outcome, Resolution, Scene, Segment, Stroke, Tip, impulse, load, strike
from cuefem.contact.impulse_space import inverse_mass
from cuefem.contact.strike import strike_modes
from tests.helpers.strike_scenes import (
    KIM,
    KIM_AT,
    hand_made,
    kim_scene,
    logarithmic,
    maple,
    pool_cue,
    sound,
    stepped_cue,
    uniform_rod,
    weighted_cue,
)

ROOT = Path(__file__).parents[2]
FEW = Resolution(4, 12, 12)
LEAST = 1e-4  # the smallest restitution but 0 that is followed in time


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
    "a dead tip that rides the waves of rods": (
        [scene for slenderness in (10, 100, 1e3, 1e4) for scene in on(uniform_rod(slenderness), 0.3, restitution=0.0)],
        FEW,
    ),
    "a miscue that presses a ringing tip on": (
        [kim_scene(b, restitution=e) for e, b in ((1e-3, 0.999), (1e-3, 0.9), (LEAST, 0.999))],
        FEW,
    ),
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
    assert abs(outcome.squirt - impulse(scene).squirt) < 1e-9
    assert len(outcome.phases) <= 6


def test_grazing():
    """|b/R| within 1e-12 of 1: the normal speed is 1e-6 of the cue's, the contact all slip."""
    for offset, cue in product((1 - 1e-6, 1 - 1e-9, 1 - 1e-12), (KIM, LumpedCue(0.54, 0.003))):
        outcome = hit(replace(kim_scene(offset), cue=cue), FEW)
        assert abs(np.tan(np.arcsin(offset) - outcome.squirt) - 0.7) < 1e-6


@st.composite
def loud_strikes(draw: st.DrawFn, restitution: st.SearchStrategy[float]) -> tuple:
    """Cues of a few modes of any frequency and loudness, with a coupled axial motion or without, made by hand."""
    count = draw(st.integers(1, 12))
    omega = sorted(draw(st.lists(logarithmic(100.0, 2e5), min_size=count, max_size=count)))
    across = draw(st.lists(st.floats(-20, 20), min_size=count, max_size=count))
    tip = hand_made(omega, across, mass=draw(logarithmic(0.03, 10.0)), rigid=draw(st.floats(0.1, 20.0)))
    if draw(st.booleans()):
        tip.amplitude[2:, 0] = draw(st.lists(st.floats(-5, 5), min_size=count, max_size=count))
    mu = draw(st.one_of(st.sampled_from([0.0, 1e-6, inf]), st.floats(0.01, 2)))
    offset = draw(st.one_of(st.sampled_from([1e-9, 0.999]), st.floats(1e-3, 0.95)))
    law = Tip(draw(restitution), mu, contact_time=draw(logarithmic(2e-4, 1e-2)))
    return Scene(LumpedCue(float(tip.approach @ tip.approach), 0.01), Ball(), law, Stroke(offset=offset)), tip


LIVELY = st.one_of(st.sampled_from([0.0, 1.0]), st.floats(0.05, 1))


@pytest.mark.parametrize(
    ("examples", "most"), [(50, 10), pytest.param(600, 50, marks=pytest.mark.heavy)], ids=["some", "many"]
)
def test_loud_cues(examples: int, most: int) -> None:
    @settings(max_examples=examples, deadline=None)
    @given(loud_strikes(LIVELY))
    def always(drawn: tuple) -> None:
        outcome = strike_modes(*drawn)
        sound(outcome)
        assert sum(phase.start == phase.end for phase in outcome.phases) < most

    always()


MESHES = sorted((ROOT / "meshes").glob("*.toml"))
EVERY = list(
    product((0.0, 1e-3, 0.5, 1.0), (0.0, 1e-6, 0.3, 5.0, inf), (0.0, 0.1, -0.4, 0.7, 0.999), (5e-5, 1e-3, 5e-2))
)


@pytest.mark.parametrize("step", [37, pytest.param(3, marks=pytest.mark.heavy)])
@pytest.mark.parametrize("path", MESHES, ids=lambda path: path.stem)
def test_strikes_on_every_cue_of_meshes(path, step):
    """e, mu, offset and contact time at the ends of their ranges; every third of the 300 strokes, and daily a few.

    Three cues have all of them.
    """
    loaded = load(path)
    cue = loaded.cue if isinstance(loaded, Scene) else loaded
    for e, mu, offset, time in EVERY[MESHES.index(path) % step :: step]:
        hit(Scene(cue, Ball(), Tip(e, mu, contact_time=time), Stroke(1.0, offset)), Resolution(4, 10, 24))
