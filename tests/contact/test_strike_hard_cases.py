"""Strikes that break solvers: each case has its reason. None may raise, hang, return NaN or lose energy."""

import json
import os
import subprocess
import sys
from dataclasses import replace
from itertools import product
from math import inf
from pathlib import Path
from time import perf_counter

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from cuefem import (
    Ball,
    Cue,
    Elevation,
    LumpedCue,
    Outcome,
    PowerLawTip,
    Resolution,
    RollingContact,
    Scene,
    SecondHit,
    Segment,
    Stroke,
    Tip,
    TipShear,
    impulse,
    load,
    strike,
)
from cuefem.beam.tip import TipModes
from cuefem.contact.impulse_space import inverse_mass
from cuefem.contact.strike import strike_modes
from tests.helpers.strike_scenes import (
    KIM,
    KIM_AT,
    hand_made,
    imbalance,
    kim_scene,
    logarithmic,
    maple,
    numbers,
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


@pytest.mark.parametrize("e", [0.0, 1.0])
@pytest.mark.parametrize("mu", [0.0, 1e-6, 0.7, inf])
@pytest.mark.parametrize("offset", [0.0, 1e-9, 0.5, 0.999])
def test_ends_of_every_range(e, mu, offset):
    """e = 0 has no unloading spring, e = 1 no loss; mu = 0 never sticks, mu = inf never slips; 0.999 barely touches."""
    outcome = hit(kim_scene(offset, restitution=e, friction=mu))
    if e == 1:
        assert outcome.energy["tip loss"] == 0
    if mu == 0:
        assert abs(outcome.squirt - np.arcsin(offset)) < 1e-12
        assert outcome.spin == 0
    if offset == 0:
        assert outcome.squirt == 0
    if offset == 1e-9:
        assert abs(outcome.squirt) <= 1e-9


@pytest.mark.parametrize("end_mass", [0.003, 0.05, 1.0])
def test_friction_of_exactly_mu_c(end_mass):
    """Stick needs exactly mu_c, so |F_t| = mu F_n for the whole of it, but for rounding: it must not chatter."""
    cue, ball = LumpedCue(0.54, end_mass), Ball()
    B = inverse_mass(cue, ball, 0.4)
    scene = Scene(cue, ball, Tip(0.75, abs(float(B.tn / B.tt))), Stroke(offset=0.4))
    outcome = hit(scene, None)
    assert abs(outcome.squirt - impulse(scene).squirt) < 1e-9
    assert len(outcome.phases) <= 6


@pytest.mark.parametrize("time", [0.05e-3, 0.2e-3, 10e-3, 50e-3])
@pytest.mark.parametrize("offset", [0.1, 0.5, 0.9])
def test_contact_times_from_0_05_to_50_ms(time, offset):
    """A thousandfold range of the tip's stiffness against modes from 100 Hz to 40 kHz."""
    outcome = hit(kim_scene(offset, contact_time=time), FEW)
    assert 0.05 * time < outcome.duration < 5 * time


@pytest.mark.parametrize("eps", [1e-9, 1e-6, 1e-3, 1.0, 10.0])
@pytest.mark.parametrize("ratio", [0.05, 18 / 7, 1e4])
@pytest.mark.parametrize("mu", [0.3, 0.7])
def test_end_mass_and_cue_mass_over_thirteen_decades(eps, ratio, mu):
    """eps = m_c/M and Q0 = M_c/M: at 1e-9 the contact's two directions are parallel but for 1e-9."""
    ball = Ball()
    cue = LumpedCue.two_part(ratio * ball.mass, eps * ball.mass)
    for offset in (1e-9, 0.3, 0.999):
        scene = Scene(cue, ball, Tip(0.75, mu), Stroke(offset=offset))
        outcome = hit(scene, None)
        assert abs(outcome.squirt - impulse(scene).squirt) < 1e-9


@pytest.mark.parametrize("offset", [0.05, 0.2, 0.4, 0.55])
def test_jam_grows_without_failing(offset):
    """In a jam the slip phase has a growing real mode: v_n grows while friction presses the tip further in."""
    outcome = hit(kim_scene(offset, friction=0.7))
    assert outcome.jam
    speeds = outcome.history(np.linspace(0, outcome.phases[0].end, 5))["velocity_n"]
    assert speeds[-1] < speeds[0]


def test_large_friction_grows_fast_and_tends_to_endless():
    """In a jam exp(+rate t) with a rate like sqrt(mu): the first slip is a boundary layer of length 1/sqrt(mu)."""
    endless = hit(kim_scene(0.5, friction=inf)).squirt
    friction = np.array([1e4, 1e5, 1e6, 1e8])
    outcomes = [hit(kim_scene(0.5, friction=mu)) for mu in friction]
    excess = np.array([outcome.squirt - endless for outcome in outcomes]) * np.sqrt(friction)
    layers = np.array([outcome.phases[0].end for outcome in outcomes]) * np.sqrt(friction)
    assert np.abs(excess[:-1] / excess[-1] - 1).max() < 0.02
    assert np.abs(layers / layers[-1] - 1).max() < 1e-4


def test_a_soft_leather_tip_on_a_ferrule_of_a_millimetre():
    """Leather 100 times softer than the wood on a 1 mm ferrule: local modes, and elements of very unlike length."""
    scene = replace(kim_scene(0.3), cue=pool_cue(ferrule=0.001))
    assert 0.5 < np.degrees(hit(scene).squirt) < 3
    hit(scene, None)


def test_radius_steps_of_five_to_one():
    """Bending stiffness jumps 625-fold at each joint: pieces that ring on their own."""
    for offset in (0.1, 0.5):
        hit(replace(kim_scene(offset), cue=stepped_cue()))


def test_a_heavy_point_at_the_butt():
    """0.3 kg on 4 mm (a point mass, but for its length) clamps the butt for the shaft's modes; squirt hardly moves."""
    heavy, light = hit(replace(kim_scene(0.3), cue=weighted_cue())), hit(kim_scene(0.3))
    assert 0.5 < heavy.squirt / light.squirt < 2


@pytest.mark.parametrize("offset", [0.3, 0.9])
def test_two_hundred_modes(offset):
    """Frequencies over six decades, 400 states, cells of 0.3 microseconds: rounding must not add up."""
    outcome = hit(kim_scene(offset), Resolution(16, 26, 200))
    assert outcome.unknowns == 2 * 200 + 3 + 3
    assert imbalance(outcome) < 1e-11


@pytest.mark.parametrize("slenderness", [10, 100, 1e3, 1e4])
def test_slenderness_from_10_to_10000(slenderness):
    """A stub of 6 cm rings far above the contact's frequency, a rod of 60 m far below; e = 0 then rides its waves."""
    for e in (0.0, 0.75):
        hit(replace(kim_scene(0.3, restitution=e), cue=uniform_rod(slenderness)), FEW)


@pytest.mark.parametrize("apart", [1e-6, 1e-12, 0.0])
@pytest.mark.parametrize("e", [0.0, 0.75])
def test_two_modes_a_millionth_apart(apart, e):
    """Nearly equal or equal frequencies make eigenvector bases of the slip phase useless; here nothing depends on them.

    Two modes at one frequency are one mode of amplitude sqrt(a^2 + b^2).
    """
    scene = Scene(LumpedCue(0.54, 0.01), Ball(), Tip(e, 0.7, contact_time=1e-3), Stroke(offset=0.3))
    two = strike_modes(scene, hand_made([6000.0, 6000.0 * (1 + apart)], [6.0, 8.0]))
    one = strike_modes(scene, hand_made([6000.0], [10.0]))
    sound(two)
    assert abs(two.squirt - one.squirt) < 1e-10 + apart


def test_reload_cycles():
    """A vibrating cue presses a dead tip again and again; the peak, and with it the loss, grows each time."""
    outcome = hit(kim_scene(0.999, restitution=0.01))
    presses = [phase.press for phase in outcome.phases]
    assert presses.count("load") >= 3
    peaks = [outcome.history(phase.end)["force_n"] for phase in outcome.phases if phase.press == "load"]
    assert np.all(np.diff(peaks) > 0)


LEAST = 1e-4  # the smallest restitution but 0 that is followed in time


@pytest.mark.parametrize("e", [1e-2, 1e-3])
def test_small_restitution(e):
    """The unloading spring k/e^2 rings 1/e times faster than the contact, but here the ball leaves at the peak.

    Towards e -> 0 the answer tends to a limit, linearly. It is not that of e = 0, which goes on pressing past the peak.
    """
    outcome, limit = hit(kim_scene(0.3, restitution=e)), hit(kim_scene(0.3, restitution=LEAST))
    assert abs(outcome.squirt - limit.squirt) < 0.1 * e


@pytest.mark.parametrize(("e", "offset"), [(1e-3, 0.999), (1e-3, 0.9), (LEAST, 0.999)])
def test_small_restitution_that_rings(e, offset):
    """A miscue presses the ringing tip on: dozens of reloads, and 1/e swings."""
    outcome = hit(kim_scene(offset, restitution=e), FEW)
    assert offset == 0.9 or sum(phase.press == "load" for phase in outcome.phases) > 10


@pytest.mark.parametrize("e", [9e-5, 1e-6, 1e-12, 5e-324])
@pytest.mark.parametrize(
    "effects",
    [(), (TipShear(0.75),), (RollingContact(),), (PowerLawTip(1.5),), (SecondHit(5e-3),), (Elevation(0.1),)],
    ids=repr,
)
def test_a_tip_that_gives_back_next_to_nothing_is_refused_at_once(e, effects):
    scene = replace(kim_scene(-0.4, restitution=e, friction=1e-6), effects=effects)
    with pytest.raises(ValueError, match=r"Tip\.restitution .*\[0\.0001, 1\].*; got "):
        strike(scene, FEW)


def jamming(seed: int) -> Outcome:
    """A strike with a dead tip of a cue of random modes that move its tip along and across."""
    rng = np.random.default_rng(seed)
    tip = hand_made(list(np.sort(10 ** rng.uniform(2.5, 4.5, 4))), list(rng.normal(size=4) * 10))
    tip.amplitude[2:, 0] = rng.normal(size=4)
    outcome = strike_modes(
        Scene(LumpedCue(0.54, 0.01), Ball(), Tip(0.0, 0.7, contact_time=5e-3), Stroke(1.0, 0.1)), tip
    )
    sound(outcome)
    assert len(outcome.phases) < 200
    return outcome


def test_a_dead_tip_in_a_jam_lets_go_instead_of_chattering():
    """e = 0: it sticks to a rigid tip until friction is used up, where slip in a jam has no stable force (Painleve)."""
    let_go = 0
    for seed in range(200):
        outcome = jamming(seed)
        last, now = outcome.phases[-1], outcome.history(outcome.duration * (1 - 1e-12))
        peak = max(outcome.history(phase.end)["force_n"] for phase in outcome.phases if phase.press == "load")
        if (last.grip, last.press) == ("stick", "rigid") and now["force_n"] > 1e-2 * peak:
            assert abs(now["force_t"]) == pytest.approx(0.7 * now["force_n"], rel=1e-6)
            let_go += 1
    assert let_go >= 3


def test_a_slow_mode_under_a_dead_tip():
    """e = 0 on a mode 100 times slower than the contact: the tip stays in touch for a quarter of its period."""
    scene = Scene(LumpedCue(0.54, 0.01), Ball(), Tip(0.0, 0.7, contact_time=1e-4), Stroke(offset=0.5))
    outcome = strike_modes(scene, hand_made([30.0], [1.0]))
    sound(outcome)
    assert outcome.duration > 200 * 1e-4


def test_grazing():
    """|b/R| within 1e-12 of 1: the normal speed is 1e-6 of the cue's, the contact all slip."""
    for offset in (1 - 1e-6, 1 - 1e-9, 1 - 1e-12):
        for cue in (KIM, LumpedCue(0.54, 0.003)):
            outcome = hit(replace(kim_scene(offset), cue=cue), FEW)
            assert abs(np.tan(np.arcsin(offset) - outcome.squirt) - 0.7) < 1e-6


THREADS = """
import json, sys
sys.path.insert(0, sys.argv[1])
from tests.helpers.strike_scenes import *
from cuefem import strike
found = []
for scene in (kim_scene(0.3), kim_scene(0.9, restitution=0.05), kim_scene(0.3, restitution=0.0), kim_scene(0.02)):
    found += list(numbers(strike(scene, Resolution(4, 24, 40))))
print(json.dumps(found))
"""


@pytest.mark.heavy
def test_the_answer_does_not_depend_on_the_number_of_blas_threads():
    """Threads change the order of sums: nothing may amplify that rounding."""
    answers = []
    for threads in ("1", "2"):
        names = ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS")
        environment = {**os.environ, **dict.fromkeys(names, threads), "PYTHONPATH": str(ROOT)}
        run = subprocess.run(
            [sys.executable, "-c", THREADS, str(ROOT)], capture_output=True, text=True, check=True, env=environment
        )
        answers.append(np.array(json.loads(run.stdout)))
    assert np.abs(answers[1] - answers[0]).max() < 1e-10 * np.abs(answers[0]).max()
    assert np.all(np.abs(answers[1] - answers[0]) < 1e-10 * np.maximum(np.abs(answers[0]), 1e-3))


@st.composite
def loud_strikes(draw: st.DrawFn) -> tuple:
    """Cues of a few modes of any frequency and loudness, with a coupled axial motion or without, made by hand."""
    count = draw(st.integers(1, 12))
    omega = sorted(draw(st.lists(logarithmic(100.0, 2e5), min_size=count, max_size=count)))
    across = draw(st.lists(st.floats(-20, 20), min_size=count, max_size=count))
    tip = hand_made(omega, across, mass=draw(logarithmic(0.03, 10.0)), rigid=draw(st.floats(0.1, 20.0)))
    if draw(st.booleans()):
        tip.amplitude[2:, 0] = draw(st.lists(st.floats(-5, 5), min_size=count, max_size=count))
    e = draw(st.one_of(st.sampled_from([0.0, 1.0]), st.floats(0.05, 1)))
    mu = draw(st.one_of(st.sampled_from([0.0, 1e-6, inf]), st.floats(0.01, 2)))
    offset = draw(st.one_of(st.sampled_from([1e-9, 0.999]), st.floats(1e-3, 0.95)))
    law = Tip(e, mu, contact_time=draw(logarithmic(2e-4, 1e-2)))
    return Scene(LumpedCue(float(tip.approach @ tip.approach), 0.01), Ball(), law, Stroke(offset=offset)), tip


@settings(max_examples=150, deadline=None)
@given(loud_strikes())
def test_loud_cues(drawn):
    outcome = strike_modes(*drawn)
    sound(outcome)
    assert sum(phase.start == phase.end for phase in outcome.phases) < 10


@pytest.mark.parametrize("e", [1e-2, 1e-3])
def test_loud_cues_under_a_nearly_dead_tip(e):
    """Twenty cues that press, slip and stick in every order on a ringing tip: none raises or loses energy."""
    rng = np.random.default_rng(11)
    for _ in range(20):
        count = rng.integers(1, 5)
        omega = list(np.sort(10 ** rng.uniform(2, 4.5, count)))
        tip = hand_made(omega, list(rng.uniform(-20, 20, count)), mass=10 ** rng.uniform(-1.5, 1))
        tip.amplitude[2:, 0] = rng.uniform(-5, 5, count)
        law = Tip(e, rng.choice([0.0, 0.05, 0.3, 2.0, inf]), contact_time=10 ** rng.uniform(-3.5, -2))
        scene = Scene(LumpedCue(float(tip.approach @ tip.approach), 0.01), Ball(), law, Stroke(offset=0.3))
        sound(strike_modes(scene, tip))


@pytest.mark.heavy
@settings(max_examples=600, deadline=None)
@given(loud_strikes())
def test_many_loud_cues(drawn):
    outcome = strike_modes(*drawn)
    sound(outcome)
    assert sum(phase.start == phase.end for phase in outcome.phases) < 50


@pytest.mark.parametrize("amplitude", [13.0, 100.0, 1000.0])
def test_a_dead_tip_leaves_a_slow_loud_mode_at_last(amplitude):
    """e = 0, mu = 0: the ball rides on the mode, whose swing its mass slows by the root of the mode's share of 1/m."""
    modes = np.array([[1.0, 0.0], [0.0, 1.0], [0.0, amplitude]])
    tip = TipModes(np.array([0.0, 0.0, 100.0]), modes, np.array([1.0, 0.0, 0.0]), np.zeros(3))
    tip_law = Tip(0.0, 0.0, contact_time=10**-3.5)
    outcome = strike_modes(Scene(LumpedCue(1.0, 0.01), Ball(), tip_law, Stroke(offset=0.999)), tip)
    sound(outcome)
    assert outcome.duration * 100.0 == pytest.approx(1.33 * amplitude, rel=0.05)


def test_zero_modes_and_more_than_the_mesh_holds_are_refused():
    with pytest.raises(ValueError, match=r"Resolution.modes.*0"):
        Resolution(4, 8, 0)
    with pytest.raises(ValueError, match=r"holds \d+ flexible modes.*500.*more elements or order"):
        strike(kim_scene(0.3), Resolution(2, 3, 500))


@pytest.mark.parametrize(
    ("field", "part"),
    [
        ("Stroke.offset", {"stroke": Stroke(offset=np.array([0.1, 0.2]))}),
        ("Stroke.speed", {"stroke": Stroke(speed=np.array([1.0, 2.0]))}),
        ("Ball.mass", {"ball": Ball(mass=np.array([0.2, 0.21]))}),
        ("Ball.inertia", {"ball": Ball(inertia=np.array([0.4, 0.5]))}),
        ("Ball.radius", {"ball": Ball(radius=np.array([0.03, 0.04]))}),
        ("Tip.friction", {"tip": Tip(friction=np.array([0.4, 0.5]))}),
        ("Tip.restitution", {"tip": Tip(np.array([0.4, 0.5]))}),
        ("LumpedCue.mass", {"cue": LumpedCue(np.array([0.5, 0.6]), 0.003)}),
        ("LumpedCue.end_mass", {"cue": LumpedCue(0.5, np.array([0.003, 0.004]))}),
    ],
)
@pytest.mark.parametrize("cue", [KIM, LumpedCue(0.54, 0.003)])
def test_fields_of_arrays_are_refused_by_name(field, part, cue):
    with pytest.raises((ValueError, TypeError), match=field):
        strike(replace(Scene(cue, stroke=Stroke(offset=0.3)), **part))


@pytest.mark.parametrize("limit", [("laws.LONGEST", 0.3), ("solve.MOST_PHASES", 0), ("solve.MOST_STEPS", 1)])
def test_a_strike_that_does_not_separate_says_so_with_its_state(monkeypatch, limit):
    name, most = limit
    monkeypatch.setattr(f"cuefem.contact.{name}", most)
    scene = Scene(LumpedCue(0.54, 0.003), stroke=Stroke(offset=0.3))
    message = r"does not leave the cue: after .* s and \d+ phases .*v_t = .*v_n = .*pressed by .* m; check restitution"
    with pytest.raises(RuntimeError, match=message):
        strike(scene)


def test_a_segment_may_be_short_and_thin():
    """A needle of 0.2 mm in front of the shaft: its own mode rings at tens of kHz and its mass is a milligram."""
    needle = Segment(0.004, 0.0002, 0.0002, maple())
    outcome = hit(replace(kim_scene(0.3), cue=Cue((needle, *KIM.segments), 0.42)))
    assert np.all(np.isfinite(numbers(outcome)))


MESHES = sorted((ROOT / "meshes").glob("*.toml"))
EVERY = list(
    product((0.0, 1e-3, 0.5, 1.0), (0.0, 1e-6, 0.3, 5.0, inf), (0.0, 0.1, -0.4, 0.7, 0.999), (5e-5, 1e-3, 5e-2))
)


def strike_all(path: Path, combinations: list[tuple[float, float, float, float]]) -> float:
    """Strikes of a cue of meshes/, each sound; seconds that the slowest took."""
    found, slowest = load(path), 0.0
    cue = found.cue if isinstance(found, Scene) else found
    for e, mu, offset, time in combinations:
        start = perf_counter()
        hit(Scene(cue, Ball(), Tip(e, mu, contact_time=time), Stroke(1.0, offset)), Resolution(4, 10, 24))
        slowest = max(slowest, perf_counter() - start)
    return slowest


@pytest.mark.parametrize("path", MESHES, ids=lambda path: path.stem)
def test_some_strikes_on_every_cue_of_meshes(path):
    strike_all(path, EVERY[MESHES.index(path) :: 37])


@pytest.mark.heavy
@pytest.mark.parametrize("path", MESHES, ids=lambda path: path.stem)
def test_a_hundred_strikes_on_every_cue_of_meshes(path):
    """e, mu, offset and contact time at the ends of their ranges: none raises, and energy is kept to 1e-9.

    Every third of the 300 strokes on each cue, so that three cues have all of them.
    """
    some = EVERY[MESHES.index(path) % 3 :: 3]
    assert len(EVERY) == 3 * len(some) == 300
    print(f"{path.stem}: the slowest of {len(some)} strikes took {strike_all(path, some):.3f} s")
