"""Steps of the contact solver: order, smoothness, extreme inputs, elevation with lifted balls (verification)."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Callable, Iterable, Iterator
from dataclasses import replace
from itertools import product

import numpy as np
import pytest

import cuefem as cf
from cuefem.beam.tip_modes import TipModes, lumped_tip_modes
from cuefem.contact.contact_model import model_of
from cuefem.contact.outcome import end_of_first_slip
from cuefem.contact.ports import Raised
from cuefem.contact.step_records import solve_contact
from cuefem.contact.strike import strike_modes
from cuefem.scene.solved_scene import tip_modes_of
from studies.strokes import cue as reference_cue
from tests.data.stored import strike_row, strikes
from tests.helpers.cues import rod, stiff_ferrule
from tests.helpers.orders import assert_error_falls_with_the_step
from tests.helpers.strike_scenes import (
    ENERGY_TOLERANCE,
    KIM,
    KIM_AT,
    assert_valid_outcome,
    custom_tip_modes,
    energy_residual,
    kim_scene,
    maple,
    stepped_cue,
    weighted_cue,
)

pytestmark = pytest.mark.filterwarnings("ignore::cuefem.PlausibilityWarning")
POOL, CARBON = reference_cue("pool_maple"), reference_cue("carbon")
TUBE = cf.usual_scene(CARBON).cue
# The position of an event in its step is random: the RMS of many errors has the order.
ORDER, WITHIN = 2.0, 0.4


def random_lumped(rng: np.random.Generator) -> cf.Scene:
    """A random lumped cue, tip and stroke; every regime occurs."""
    mass, end_mass = 10 ** rng.uniform((-1.3, -2.7), (0.3, 0.3))
    coupling = rng.uniform(-0.6, 0.6) / math.sqrt(mass * end_mass) * (rng.random() < 0.3)
    friction = float(rng.choice([rng.uniform(0.05, 0.8), 0.0, math.inf], p=[0.9, 0.05, 0.05]))
    tip = cf.Tip(float(rng.uniform(0.2, 1)), friction, contact_time=1e-3)
    return cf.Scene(
        cf.LumpedCue(mass, end_mass, coupling), tip=tip, stroke=cf.Stroke(1.3, float(rng.uniform(0.05, 0.8)))
    )


def test_strike_lumped_cue_converges_to_impulse_solver_second_order() -> None:
    rng, counts = np.random.default_rng(3), Counter()
    errors: dict[int, list[float]] = {250: [], 1000: []}
    for _ in range(80):
        scene = random_lumped(rng)
        exact = cf.impulse(replace(scene, effects=()))
        for steps, deviations in errors.items():
            outcome = cf.strike(scene, cf.Resolution(1, 1, 1, steps))
            errors_ = [outcome.squirt - exact.squirt, outcome.ball_speed / exact.ball_speed - 1]
            errors_ += [(outcome.energy[name] - e) / exact.energy["initial"] for name, e in exact.energy.items()]
            deviations.append(float(np.abs(errors_).max()))
        counts.update([exact.regime])
        assert end_of_first_slip(outcome.phases) == exact.regime
    coarse, fine = (np.array(values) for values in errors.values())
    assert coarse.max() < 2e-3
    assert np.log(np.sqrt(np.mean(coarse**2) / np.mean(fine**2))) / math.log(4) == pytest.approx(ORDER, abs=WITHIN)
    assert all(counts[regime] >= 2 for regime in ("stick", "late stick", "miscue", "slip reversal")), counts


# Stick, slip, partial slip, a default strike, a raised cue.
KINDS = (
    "linear",
    "rolling",
    "leather",
    "usual",
    "second hit",
    "raised",
    pytest.param("thrust", marks=pytest.mark.heavy),
)


@pytest.mark.parametrize("kind", KINDS)
def test_squirt_of_each_kind_converges_second_order(kind: str) -> None:
    """Thrust: from 3200 steps, since the stored strikes have a basis of 12 slopes, 8e-6 from the whole stiffness."""
    rows = [row for row in strikes() if row["kind"] == kind]
    exact = [strike_row(row, steps=3200).squirt if kind == "thrust" else row["answer"]["squirt"] for row in rows]
    errors: dict[int, list[float]] = {100: [], 400: []}
    for steps, found in errors.items():
        for count in (steps, round(1.1 * steps)):  # an event has another position in its step
            outcomes = [strike_row(row, steps=count) for row in rows]
            assert steps == 100 or max(map(energy_residual, outcomes)) < 1e-6
            for row, outcome, squirt in zip(rows, outcomes, exact, strict=True):
                found.append(abs(outcome.squirt - squirt) / abs(row["scene"]["stroke"][1]))
    coarse, fine = (float(np.median(found)) for found in errors.values())
    order = math.log(coarse / fine) / math.log(4)
    assert order == pytest.approx(ORDER, abs=WITHIN)


@pytest.mark.parametrize("position", [1e-9, 1e-6, 1e-4])
def test_clamp_behind_the_tip_is_nearly_one_at_the_tip(position: float) -> None:
    """The short end vibrates through many periods in a step, at any velocity; it is to leave squirt alone."""
    here, behind = (cf.Support(x, math.inf, math.inf) for x in (0.0, position))
    tip = cf.Tip(0.75, 0.7, contact_time=2e-3)
    squirts = [cf.strike(replace(kim_scene(0.3), tip=tip, effects=(clamp,))).squirt for clamp in (here, behind)]
    assert squirts[1] == pytest.approx(squirts[0], rel=1e-3)


THRUST = (cf.TipDome(0.0095), cf.AxialWaves(), cf.GeometricStiffness())
# Cue, tip, b/R, effects, modes, steps; squirt of many small steps, and the relative difference from it.
HARD: list[tuple[cf.Cue, cf.Tip, float, tuple[cf.Effect, ...], cf.Resolution | None, int | None, float, float]] = [
    # friction turns the front of the cue away from a ball that it has hardly moved; the cue follows, and hits again
    *(
        (CARBON, cf.Tip(0.85, friction, contact_time=1e-3), 0.82, (cf.TipDome(0.0095),), None, steps, 0.0808, 1e-2)
        for friction, steps in product((100.0, math.inf), (200, 800, 6400))
    ),
    # bare maple far off centre is hit again: 0.0472 after the first contact
    *(
        (POOL, cf.Tip(0.85, friction, contact_time=8e-4), 0.7, (cf.SecondHit(),), None, None, 0.0530, 2e-3)
        for friction in (1e4, math.inf)
    ),
    # low restitution and infinite friction
    (POOL, cf.Tip(0.2348983, 0.8133191, contact_time=7.0436e-4), -0.3755904, (), None, None, -0.0214451, 1e-3),
    (CARBON, cf.Tip(0.985, math.inf, contact_time=6.68e-4), -0.86355, (), None, None, -0.0162106, 1e-3),
    # the 300th mode swings through 10 rad in a step of 1/100 of the contact time
    (TUBE, cf.Tip(contact_time=1e-3), 0.3, THRUST, cf.Resolution(1, 40, 300), 100, 0.032486, 2e-3),
]


@pytest.mark.parametrize(("cue", "tip", "offset", "effects", "at", "steps", "squirt", "within"), HARD)
def test_squirt_of_hard_contacts_is_that_of_small_steps(
    cue: cf.Cue,
    tip: cf.Tip,
    offset: float,
    effects: tuple[cf.Effect, ...],
    at: cf.Resolution | None,
    steps: int | None,
    squirt: float,
    within: float,
) -> None:
    scene = cf.Scene(cue, cf.Ball(0.17, 0.028575), tip, cf.Stroke(2.0, offset), effects)
    outcome = strike_modes(scene, tip_modes_of(scene, at), steps=steps)
    assert outcome.squirt == pytest.approx(squirt, rel=within)
    assert energy_residual(outcome) < 1e-4


@pytest.mark.kernel
@pytest.mark.parametrize("effects", [(), (cf.Elevation(0.2),)], ids=["level", "raised"])
def test_step_without_forces_is_repeated_at_half_its_length(effects: tuple[cf.Effect, ...]) -> None:
    """Newton's method alternates where a law rises steeply, and then hardly: force = 3e4 N (indentation/m)^0.1."""
    scene = replace(kim_scene(0.3), effects=effects)
    model = model_of(scene, tip_modes_of(scene, KIM_AT))
    model = replace(model, tip=replace(model.tip, exponent=0.1, stiffness=3e4))
    halved = solve_contact(model, steps=20).steps
    halvings = round(math.log2(model.time / 20 / halved["length"][0]))
    assert halvings >= 1
    short = solve_contact(model, steps=20 * 2**halvings).steps[0]
    assert halved["length"][0] == pytest.approx(short["length"], rel=1e-12)
    assert halved["F"][0] == pytest.approx(short["F"], rel=1e-9)
    assert halvings == 1 or halved["length"][1] == 2 * halved["length"][0]  # the steps grow again


@pytest.mark.parametrize(("kind", "tolerance"), [("usual", 1e-5), ("bare", 2e-4)])
def test_squirt_over_offsets_is_smooth(kind: str, tolerance: float) -> None:
    """With all default effects, and with a spring tip, whose contact state changes abruptly."""
    scene = cf.usual_scene(POOL)
    if kind == "bare":
        scene = cf.Scene(POOL, scene.ball, cf.Tip(contact_time=1e-3), scene.stroke)
    tip, x = tip_modes_of(scene), np.linspace(0.30, 0.32, 41)
    strokes = (replace(scene.stroke, offset=float(b)) for b in x)
    squirts = np.array([strike_modes(replace(scene, stroke=stroke), tip).squirt for stroke in strokes])
    smooth = np.polyval(np.polyfit(x - 0.31, squirts, 4), x - 0.31)
    assert np.abs(squirts / smooth - 1).max() < tolerance


def light_cues() -> Iterator[tuple[cf.Scene, TipModes]]:
    """End masses down to 0.1 mg, level and raised."""
    for end_mass, mu, offset, e in product((1e-7, 1e-3, 2.0), (0.0, 0.7, 5.0), (1e-9, 0.9), (0.05, 1.0)):
        cue = cf.LumpedCue(0.54, end_mass)
        scene = cf.Scene(cue, tip=cf.Tip(e, mu, 1e-3), stroke=cf.Stroke(2.0, offset))
        for effects in ((), (cf.Elevation(0.3, 0.2),), (cf.SecondHit(),)):
            yield replace(scene, effects=effects), lumped_tip_modes(cue)


def odd_shafts() -> Iterator[tuple[cf.Scene, TipModes]]:
    """Thin, short, long, stepped and butt-heavy shafts; grazing offsets, and a miscue with a vibrating tip."""
    few = cf.Resolution(4, 12, 12)
    # 0.2 mm in diameter in front of the shaft: its own mode has tens of kHz, its mass is 1 mg
    needle = cf.Cue((cf.Segment(0.004, 0.0002, 0.0002, maple()), *KIM.segments), 0.42)
    for cue, offsets, at in (
        (stiff_ferrule(), (0.3,), None),
        (stepped_cue(), (0.1, 0.5), KIM_AT),
        (weighted_cue(), (0.3,), KIM_AT),
        (needle, (0.3,), KIM_AT),
        (rod(10), (0.3,), few),
        (rod(1e4), (0.3,), few),
        (KIM, (0.999, 0.9), few),
        (KIM, (1 - 1e-6, 1 - 1e-9, 1 - 1e-12), few),
    ):
        for offset in offsets:
            scene = replace(kim_scene(offset, restitution=0.05 if 0.6 < offset < 0.9999 else 0.75), cue=cue)
            yield scene, tip_modes_of(scene, at)


@pytest.mark.kernel
@pytest.mark.parametrize(("scenes", "within"), [(light_cues, 2e-5), (odd_shafts, ENERGY_TOLERANCE)])
def test_strike_extreme_inputs_conserves_energy(
    scenes: Callable[[], Iterable[tuple[cf.Scene, TipModes]]], within: float
) -> None:
    for scene, tip in scenes():
        outcome = strike_modes(scene, tip)
        if (
            chatters := scenes is not odd_shafts and energy_residual(outcome) > within
        ):  # a tip that chatters at e = 0.05 over modes of a megahertz
            assert energy_residual(outcome) < 3e-3, scene
            assert energy_residual(strike_modes(scene, tip, steps=6400)) < energy_residual(outcome) / 10
        assert_valid_outcome(outcome, within=3e-3 if chatters else within)
        if scene.stroke.offset > 0.9999:  # the normal speed is 1e-3 of the cue's and less, the contact all slip
            assert abs(np.tan(np.arcsin(scene.stroke.offset) - outcome.squirt) - 0.7) < 1e-6


@pytest.mark.parametrize(("e", "regime"), [(0.3, "miscue"), (0.9, "late stick")])
def test_infinite_friction_impact_may_separate_at_once(e: float, regime: str) -> None:
    """A light cue with infinite friction: the impulse alone is the contact, as in the impulse solver; at e it ends."""
    cue = cf.LumpedCue(0.05, 0.02, -0.8 / math.sqrt(0.05 * 0.02))
    scene = cf.Scene(cue, tip=cf.Tip(e, math.inf, contact_time=1e-3), stroke=cf.Stroke(1.0, 0.95))
    outcome, exact = cf.strike(scene), cf.impulse(scene)
    assert [phase.state for phase in outcome.phases] == ["impulse"]
    assert (outcome.regime, exact.regime, outcome.duration) == (regime, regime, 0)
    for name in ("squirt", "ball_speed", "spin", "cue_speed"):
        assert getattr(outcome, name) == pytest.approx(getattr(exact, name), rel=1e-12)


@pytest.mark.parametrize("exponent", [1.0, 1.5, 2.0, 3.7])
@pytest.mark.parametrize(("speed", "e"), [(0.2, 0.4), (1.0, 0.1), (7.0, 1.0)])
def test_central_impact_contact_time_falls_with_speed(exponent, speed, e):
    scene = cf.Scene(
        cf.LumpedCue(0.5, 0.005),
        tip=cf.Tip(e, contact_time=1.3e-3),
        stroke=cf.Stroke(speed),
        effects=(cf.PowerLawTip(exponent, speed=2.0),),
    )
    time = 1.3e-3 * (speed / 2.0) ** ((1 - exponent) / (1 + exponent))
    Q0 = 0.5 / 0.210

    def error(steps: int) -> float:
        outcome = cf.strike(scene, cf.Resolution(1, 1, 1, steps))
        leaves = outcome.ball_speed / (speed * (1 + e) * Q0 / (1 + Q0))
        return max(abs(outcome.duration / time - 1), abs(leaves - 1))

    assert_error_falls_with_the_step(error)


def test_elevation_table_friction_of_sliding_ball_equals_closed_form():
    """At offset 0 the ball's lowest point slides forward throughout: f = -mu N, N = F sin(a)."""
    angle, mu, e = 0.3, 0.15, 0.8
    scene = cf.Scene(cf.LumpedCue(0.5, 0.01), tip=cf.Tip(e, 0.0, 1e-3), stroke=cf.Stroke(1.0))
    outcome = cf.strike(replace(scene, effects=(cf.Elevation(angle, mu),)), cf.Resolution(1, 1, 1, 1600))
    assert outcome.regime == "miscue"  # the tip slides over the ball in the vertical plane alone
    M, along = scene.ball.mass, math.cos(angle) - mu * math.sin(angle)
    impulse = (1 + e) / (1 / 0.5 + math.cos(angle) * along / M)
    assert abs(outcome.ball_speed / (impulse * along / M) - 1) < 1e-5
    follow = mu * math.sin(angle) * impulse / (scene.ball.inertia * M * scene.ball.radius)
    assert abs(outcome.history.spin[0] / -follow - 1) < 1e-5  # forward roll turns about -x
    slide = impulse * along / M - follow * scene.ball.radius  # of the lowest point, at the end
    assert abs(outcome.energy["table loss"] / (mu * math.sin(angle) * impulse * slide / 2) - 1) < 1e-5


def test_elevation_lifted_ball_returns_to_table() -> None:
    """Friction of a vibrating cue lifts the ball; the table's normal force acts only at height 0."""
    tip = custom_tip_modes([8000.0], [15.0], rigid=1.0)
    law, stroke = cf.Tip(0.8, 3.0, contact_time=3e-3), cf.Stroke(1.0, 0.8)
    scene = cf.Scene(cf.LumpedCue(0.54, 0.01), tip=law, stroke=stroke, effects=(cf.Elevation(0.7, 0.2),))
    model = model_of(scene, tip)
    assert isinstance(model.ports, Raised)
    steps = solve_contact(model).steps
    rising = np.append(0.0, steps["ball"][:, :3] @ model.ports.axes[2])
    height = np.cumsum(steps["length"] * (rising[1:] + rising[:-1]) / 2)
    assert height.max() > 2e-5
    assert np.abs(height[steps["F"][:, 3] > 0]).max() < 1e-6
