"""Verification: a nearly dead tip, averaged over its ringing, against exact phases and a model written differently.

The exact phases (`cuefem.contact.linear.Exact`) follow every swing; where both can be had they must meet as e -> 0.
The oracle of a slipping tip steps the mean motion in displacements with scipy, and finds where tip and ball part from
the forces alone: the amplitude is what is left below the old peak by the largest mean force so far.
"""

import math
from itertools import pairwise

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from cuefem import Ball, LumpedCue, Outcome, Resolution, Scene, Stroke, Tip, strike
from cuefem.beam.tip import TipModes
from cuefem.contact.linear import Exact
from cuefem.contact.phases import run
from cuefem.contact.ringing_tip import AVERAGED, Ringing
from cuefem.contact.state import Laws
from cuefem.contact.strike import strike_modes
from cuefem.tip_modes import tip_modes_of
from tests.helpers.strike_scenes import hand_made, imbalance, kim_cue

AT = Resolution(4, 10, 24)


def slipping(e: float, offset: float = -0.4, friction: float = 1e-6, time: float = 1e-3) -> Scene:
    return Scene(kim_cue(), Ball(), Tip(e, friction, contact_time=time), Stroke(1.0, offset))


def averaged(outcome: Outcome) -> bool:
    return any(phase.press in AVERAGED for phase in outcome.phases)


@pytest.mark.parametrize("e", [1e-9, 1e-8, 1e-7, 1e-6])
def test_the_published_check_of_a_ringing_slip(e):
    """Kim's cue at b/R = -0.4 and e -> 0+, from an independent computation; at e = 0 it is 0.27977 m/s."""
    outcome = strike(slipping(e), AT)
    assert averaged(outcome)
    assert outcome.ball_speed == pytest.approx(0.2414679, abs=1e-7)
    assert outcome.squirt == pytest.approx(-0.411515846, abs=2e-9)
    assert outcome.duration == pytest.approx(1.649996e-3, abs=2e-9)
    assert strike(slipping(0.0), AT).ball_speed == pytest.approx(0.27977, abs=1e-5)


class Told(tuple):
    """Impulse (t, n), N s, and duration, s."""


def mean_motion(scene: Scene, tip: TipModes) -> Told:
    """A tip of e -> 0+ that slips all the time, in SI and displacements: loading, then the mean of the ringing."""
    phi, mu, M, k = math.asin(abs(scene.stroke.offset)), scene.tip.friction, scene.ball.mass, scene.stiffness
    t = tip.amplitude @ [math.sin(phi), math.cos(phi)]
    n = tip.amplitude @ [math.cos(phi), -math.sin(phi)]
    count, push = len(t), n + mu * t

    def closing(y: np.ndarray) -> float:
        return float(n @ y[count : 2 * count] - y[2 * count])

    def change(force):
        def rate(_: float, y: np.ndarray) -> np.ndarray:
            F = force(y)
            pulled = -(tip.omega**2) * y[:count] - push * F
            return np.concatenate([y[count : 2 * count], pulled, [F / M, closing(y), F]])

        return rate

    def held(y: np.ndarray) -> float:  # the force that keeps the two together
        return float(-(n @ (tip.omega**2 * y[:count])) / (1 / M + n @ push))

    def solved(force, y, start, event):
        event.terminal, event.direction = True, -1
        found = solve_ivp(
            change(force), (start, start + 0.1), y, "DOP853", events=event, rtol=1e-11, atol=1e-14, dense_output=True
        )
        return found, found.t[-1], found.y[:, -1]

    y = np.concatenate([np.zeros(count), scene.stroke.speed * tip.approach, np.zeros(3)])
    time = 0.0
    while True:
        _, time, y = solved(lambda y: k * y[2 * count + 1], y, time, lambda _, y: closing(y))
        peak, highest = k * y[2 * count + 1], held(y)
        if highest <= peak - highest:
            break
        run, *_ = solved(held, y, time, lambda _, y: held(y))  # as far as it could go; then the first of the two ends
        times = np.linspace(time, run.t[-1], 200_001)
        forces = -(n @ (tip.omega[:, None] ** 2 * run.sol(times)[:count])) / (1 / M + n @ push)
        tops = np.maximum.accumulate(forces)
        part = np.argmax(forces <= peak - tops)
        reload = np.argmax(forces >= peak) if (forces >= peak).any() else len(times)
        end = min(part, reload)
        over = (forces - peak + tops if part < reload else peak - forces)[end - 1 : end + 1]
        time = times[end - 1] + (times[end] - times[end - 1]) * over[0] / (over[0] - over[1])
        y = run.sol(time)
        if part < reload:
            break
        y[2 * count + 1] = peak / k
    return Told((mu * y[-1], y[-1], time))


@pytest.mark.parametrize(
    ("offset", "friction", "time"), [(0.4, 1e-6, 1e-3), (0.7, 0.02, 1e-3), (0.7, 0.3, 1e-3), (0.6, 0.1, 1e-3)]
)
def test_the_mean_motion_written_differently_tells_the_same(offset, friction, time):
    scene = slipping(1e-7, offset, friction, time)
    at = Resolution(4, 10, 8)
    tip = tip_modes_of(scene, at)
    outcome, told = strike_modes(scene, tip), mean_motion(scene, tip)
    assert averaged(outcome)
    assert outcome.impulse == pytest.approx(told[:2], rel=2e-6, abs=1e-12)
    assert outcome.duration == pytest.approx(told[2], rel=2e-5)


def both(scene: Scene, tip: TipModes) -> tuple[np.ndarray, np.ndarray]:
    """Impulse on the ball, averaged and exact, N s."""
    laws = Laws(
        math.asin(scene.stroke.offset),
        scene.ball.mass,
        scene.ball.inertia,
        scene.stiffness,
        scene.tip.restitution,
        scene.tip.friction,
        scene.contact_time,
        scene.stroke.speed,
    )
    found = []
    ringing, exact = Exact.of(tip, laws), Exact.of(tip, laws)
    ringing.ringing = Ringing(ringing)
    for kind in (ringing, exact):
        run(kind)
        found.append(np.array(kind.contact.impulse))
    return found[0], found[1]


def missed(scene: Scene, tip: TipModes) -> float:
    average, exact = both(scene, tip)
    return float(np.linalg.norm(average - exact) / np.linalg.norm(exact))


@pytest.mark.parametrize(("offset", "friction"), [(0.4, 0.02), (0.7, 0.3)])
def test_a_ringing_slip_converges_like_e(offset, friction):
    """Exact phases at e = 4e-2 to 2.5e-3: the error falls in proportion to e, and stays below e."""
    errors = []
    for e in (4e-2, 1e-2, 2.5e-3):
        scene = slipping(e, offset, friction)
        errors.append(missed(scene, tip_modes_of(scene, Resolution(4, 10, 8))))
        assert errors[-1] < e
    assert all(later < first / 2 for first, later in pairwise(errors))


# Cues of a few loud modes, made by hand, on whose ringing tip the contact sticks: (omega, across, along, mass, rigid),
# (friction, offset, contact time); which averaged phases it goes through.
LOUD = {
    "endless friction": (
        ([144.0, 1818.0, 4542.0], [17.4, -11.8, -14.5], [-0.16, 1.75, 2.93], 0.336, 10.4),
        (math.inf, 0.05, 1.18e-3),
        {"ringing", "capped"},
    ),
    "friction takes of the ringing": (
        ([476.5, 3687.0, 6427.0, 10310.0], [12.1, 15.5, 16.2, 16.2], [3.92, -0.807, -2.35, -4.8], 0.0555, 7.59),
        (0.7, 0.3, 4.69e-3),
        {"rubbed back"},
    ),
    "friction adds to the ringing": (
        ([2221.0, 5420.0], [15.5, 9.33], [3.72, -3.62], 0.331, 9.75),
        (0.3, 0.3, 2.01e-3),
        {"swinging"},
    ),
    "great friction adds to the ringing": (
        ([2148.0, 13610.0, 27350.0], [-14.0, -15.9, 14.1], [-3.21, -4.63, 2.69], 1.05, 19.5),
        (2.0, 0.3, 2.92e-3),
        {"ringing", "capped"},
    ),
}


def loud(name: str, e: float) -> tuple[Scene, TipModes]:
    (omega, across, along, mass, rigid), (friction, offset, time), _ = LOUD[name]
    tip = hand_made(omega, across, mass=mass, rigid=rigid)
    tip.amplitude[2:, 0] = along
    return Scene(LumpedCue(mass, 0.01), Ball(), Tip(e, friction, contact_time=time), Stroke(1.0, offset)), tip


@pytest.mark.parametrize("name", LOUD)
def test_a_ringing_stick_meets_the_exact_phases(name):
    """Exact phases at e = 1e-2 to 1e-3: the impulse is missed by no more than 0.1 sqrt(e)."""
    assert missed(*loud(name, 1e-3)) < 0.1 * math.sqrt(1e-3)
    scene, tip = loud(name, 1e-6)
    outcome = strike_modes(scene, tip)
    assert {phase.press for phase in outcome.phases} >= LOUD[name][2]
    assert imbalance(outcome) < 1e-9


@pytest.mark.heavy
@pytest.mark.parametrize("name", LOUD)
def test_a_ringing_stick_converges(name):
    """Ten times less e, less than half the error, down to e = 1e-4 where averaging begins by itself."""
    errors = [missed(*loud(name, e)) for e in (1e-3, 1e-4)]
    assert errors[1] < 1e-3
    assert errors[1] < max(0.6 * errors[0], 2e-4)
