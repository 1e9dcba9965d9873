"""Strikes with effects on the cue, elevation or a second hit, against independent small steps (verification).

The beam (`tests.oracle.bending`) is scikit-fem's, the contact (`tests.oracle.small_steps`) has neither phases nor
events: slip, stick, separation and repeated contact follow from an impulse in each of some thousand equal steps. Both
have the same number of modes, so that they differ by the steps alone. Scenes are random: cue, ball, tip, stroke and
effect, with slips, sticks and miscues on both sides.

With 1,600 steps a contact time the maximum difference of 40 scenes a kind is 2e-5 (on the cue), 9e-5 (elevation) and
3e-4 (second hit), over a typical size (`differences`): the error of the small steps, which falls with the step. 23 of
40 second hits touch again, up to 17 times. `pytest -m nightly -s` prints the differences.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable
from dataclasses import replace
from typing import NamedTuple

import numpy as np
import pytest

import cuefem as cf
from cuefem.contact.outcome import Phase
from tests.oracle.small_steps import SmallStepsOutcome, solve_small_steps


class RandomScene:
    """Random numbers of one scene."""

    def __init__(self, seed: int) -> None:
        self.rng = np.random.default_rng([2026, seed])

    def between(self, low: float, high: float) -> float:
        return float(self.rng.uniform(low, high))

    def scaled(self, low: float, high: float) -> float:
        return float(np.exp(self.rng.uniform(np.log(low), np.log(high))))

    def often(self, probability: float) -> bool:
        return bool(self.rng.random() < probability)

    def cue(self) -> cf.Cue:
        """A ferrule and a shaft of two pieces, one of them bored and filled, with losses of their own."""
        front, E = self.between(0.011, 0.014), self.between(10e9, 16e9)
        wood = cf.Material(E, E / self.between(12, 17), self.between(600, 800), loss=self.between(0.005, 0.03))
        plastic = cf.Material(3e9, 1.1e9, 1200.0, loss=0.04)
        bore, middle = self.between(0.2, 0.6) * front, self.between(0.2, 0.4)
        return cf.Cue(
            (
                cf.Segment(self.between(0.01, 0.03), front, front, plastic, bore, bore, core=wood, kappa=0.9),
                cf.Segment(middle, front, 1.05 * front, wood, bore, bore, kappa=0.85),
                cf.Segment(0.75 - middle, 1.05 * front, self.between(0.018, 0.023), wood, kappa=0.9),
            ),
            body_mass=self.between(0.3, 0.5),
        )

    def tip(self, min_restitution: float = 0.3) -> cf.Tip:
        friction = self.between(0.1, 0.5) if self.often(0.4) else self.between(0.5, 0.9)
        return cf.Tip(self.between(min_restitution, 1.0), friction, contact_time=self.scaled(6e-4, 3e-3))

    def stroke(self, max_offset: float = 0.7) -> cf.Stroke:
        side = -1 if self.often(0.4) else 1
        return cf.Stroke(self.scaled(0.5, 6.0), side * self.between(0.05, max_offset))

    def scene(self, cue: cf.Cue | cf.LumpedCue, *effects: cf.Effect, tip: cf.Tip | None = None) -> cf.Scene:
        ball = cf.Ball(self.between(0.14, 0.22), self.between(0.026, 0.031), self.between(0.35, 0.45))
        tip_effects: tuple[cf.Effect, ...] = ()
        is_elevated = any(isinstance(effect, cf.Elevation) for effect in effects)
        if isinstance(cue, cf.Cue) and self.often(0.4):
            tip_effects = (cf.TipDome(self.between(5e-3, 12e-3)),)
        elif not is_elevated and self.often(0.4):
            tip_effects = (cf.TipShear(self.scaled(0.4, 2.0)),)
        return cf.Scene(cue, ball, tip or self.tip(), self.stroke(), (*effects, *tip_effects))


def with_support(draw: RandomScene) -> cf.Scene:
    """A spring and a dashpot near the tip, or a clamp."""
    cue = draw.cue()
    if draw.often(0.25):
        return draw.scene(cue, cf.Support(cue.length, math.inf, math.inf), cf.Support(0.2, draw.scaled(1e3, 1e5)))
    position = draw.between(0.04, 0.4)
    return draw.scene(cue, cf.Support(position, draw.scaled(1e3, 1e6), draw.scaled(0.1, 50.0), draw.scaled(1.0, 50.0)))


def all_cue_effects(draw: RandomScene) -> cf.Scene:
    """Loss of materials or one for all, a mass, a hand and a joint with one or two compliances, at one position."""
    position, mass = (
        draw.between(0.05, 0.3),
        cf.PointMass(position=draw.between(0.01, 0.1), mass=draw.scaled(1e-3, 2e-2), rotary_inertia=1e-6),
    )
    hand = cf.Support(position, draw.scaled(1e3, 1e5), 0.0, draw.scaled(1.0, 30.0))
    joint = cf.Joint(position, draw.scaled(1e-4, 1e-1), draw.scaled(1e-9, 1e-6) if draw.often(0.5) else 0.0)
    loss = cf.StructuralDamping(None if draw.often(0.5) else draw.scaled(1e-2, 0.3))
    return draw.scene(draw.cue(), loss, joint, mass, hand)


def elevated(draw: RandomScene) -> cf.Scene:
    """A raised cue on a table with or without friction."""
    table = 0.0 if draw.often(0.25) else draw.scaled(0.05, 2.0)
    cue = cf.LumpedCue(draw.between(0.45, 0.65), draw.scaled(3e-3, 0.05)) if draw.often(0.3) else draw.cue()
    return draw.scene(cue, cf.Elevation(draw.between(0.02, 0.5), table))


def elevated_and_stuck(draw: RandomScene) -> cf.Scene:
    """A steep cue whose tip never slips; its impulse presses the ball onto a table with friction."""
    tip, elevation = cf.Tip(0.75, math.inf, contact_time=1e-3), cf.Elevation(draw.between(0.4, 0.6), 0.2)
    return cf.Scene(draw.cue(), tip=tip, stroke=cf.Stroke(1.0, draw.between(0.5, 0.7)), effects=(elevation,))


def second_hit_scene(draw: RandomScene) -> cf.Scene:
    """A tip of low restitution on a vibrating, often heavy cue, which may hit the ball again."""
    cue = replace(draw.cue(), body_mass=draw.between(0.4, 2.0))
    tip = cf.Tip(draw.scaled(0.12, 0.6), draw.between(0.2, 0.9), contact_time=draw.scaled(1e-3, 8e-3))
    scene = draw.scene(cue, cf.SecondHit(draw.between(3e-3, 1e-2)), tip=tip)
    return replace(scene, stroke=draw.stroke(0.9))


def stiffening(draw: RandomScene) -> cf.Scene:
    """A tip whose force is a power of the indentation, beside a dome or a tangential spring of the base model."""
    return draw.scene(draw.cue(), cf.PowerLawTip(draw.between(1.0, 2.5), draw.scaled(0.5, 6.0)))


class Kind(NamedTuple):
    """A kind of scene, the tolerance of any number with ``STEPS`` steps, and seeds and steps of everyday tests."""

    make: Callable[[RandomScene], cf.Scene]
    within: float
    daily: tuple[int, ...]
    steps: int


MODES, STEPS = 12, 800
KINDS = {
    "Support": Kind(with_support, 1e-4, (0, 1, 2, 3), STEPS),
    "all on the cue": Kind(all_cue_effects, 1e-4, (0, 1, 2, 3), STEPS),
    "Elevation": Kind(elevated, 2e-4, (0, 3), STEPS // 4),
    "Elevation, infinite friction": Kind(elevated_and_stuck, 3e-3, (2,), STEPS // 4),
    "PowerLawTip": Kind(stiffening, 1e-4, (3, 5, 8), STEPS),
    "SecondHit": Kind(second_hit_scene, 5e-4, (6, 20, 24), STEPS),  # 2, 4 and 2 touches
}
AT = cf.Resolution(3, 14, MODES, 2 * STEPS)


def differences(scene: cf.Scene, outcome: cf.Outcome, reference: SmallStepsOutcome) -> dict[str, float]:
    """Difference of each number, over a typical size."""
    initial, speed = outcome.energy["initial"], outcome.ball_speed
    return {
        "squirt": abs(reference.squirt - outcome.squirt) / max(abs(outcome.squirt), 0.01),
        "ball speed": abs(reference.ball_speed / speed - 1),
        "spin": abs(reference.spin - outcome.spin) * scene.ball.radius / speed,
        "cue speed": abs(reference.cue_speed - outcome.cue_speed) / scene.stroke.speed,
        "duration": abs(reference.duration / outcome.duration - 1),
        "vibration": abs(reference.vibration - outcome.energy["cue vibration"] / initial),
        "damping loss": abs(reference.damping_loss - outcome.energy.get("damping loss", 0.0) / initial),
    }


def scene_differences(scene: cf.Scene, steps: int) -> dict[str, float]:
    """Differences of a strike from its small steps; both must have the same number of contacts."""
    outcome, reference = cf.strike(scene, AT), solve_small_steps(scene, MODES, steps)
    assert 1 + len(flights(outcome)) == len(reference.touches)
    return differences(scene, outcome, reference)


DAILY = [(name, [seed], kind.steps) for name, kind in KINDS.items() for seed in kind.daily]
HEAVY = [pytest.param(name, KINDS[name].daily, STEPS, marks=pytest.mark.heavy) for name in KINDS if "El" in name]
MANY = [pytest.param(name, range(40), 2 * STEPS, marks=pytest.mark.nightly) for name in KINDS]


def flights(outcome: cf.Outcome) -> list[Phase]:
    """The phases between separation and the next contact."""
    return [phase for phase in outcome.phases if phase.normal_phase == "free"]


@pytest.mark.parametrize(("kind", "seeds", "steps"), [*DAILY, *HEAVY, *MANY])
def test_strike_each_kind_of_effects_agrees_with_small_steps(kind: str, seeds: Iterable[int], steps: int) -> None:
    rows = [scene_differences(KINDS[kind].make(RandomScene(seed)), steps) for seed in seeds]
    worst = {name: max(row[name] for row in rows) for name in rows[0]}
    print(kind, len(rows), {name: f"{value:.1e}" for name, value in worst.items()})
    assert max(worst.values()) < KINDS[kind].within * max(1, STEPS / steps), worst


@pytest.mark.parametrize("seed", [1, 6, 20, 24])
def test_second_hit_window_counts_from_first_separation(seed: int) -> None:
    scene = second_hit_scene(RandomScene(seed))
    others = tuple(effect for effect in scene.effects if not isinstance(effect, cf.SecondHit))

    def within(window: float) -> cf.Outcome:
        return cf.strike(replace(scene, effects=(*others, cf.SecondHit(window))), AT)

    outcome = cf.strike(scene, AT)
    flight = flights(outcome)[0]
    impulse = np.sum([phase.impulse for phase in outcome.phases], axis=0)
    assert impulse == pytest.approx(outcome.impulse, rel=1e-12)
    wait = flight.end - flight.start
    assert wait > 0
    missed, alone = within(0.8 * wait), cf.strike(replace(scene, effects=others), AT)
    assert flights(within(1.2 * wait))[0] == flight
    assert not flights(missed)
    assert (missed.squirt, missed.duration) == (alone.squirt, alone.duration)
