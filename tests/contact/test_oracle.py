"""Strikes of every kind, drawn at random, against the contact's one method in plain NumPy (tests/oracle)."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable
from dataclasses import replace
from itertools import groupby
from typing import Any

import numpy as np
import pytest

import cuefem as cf
from cuefem.contact import bent as bent_cue
from cuefem.contact.laws import model_of
from cuefem.contact.side_strike import solved_side
from cuefem.effects.base import TipEffect
from cuefem.effects.terms import ContactTerms
from cuefem.tip_modes import tip_modes_of
from tests.helpers.leather_scenes import LEATHER, SHAFT
from tests.helpers.strike_scenes import hollow_cue, kim_cue, pool_cue
from tests.oracle.contact import Contact
from tests.oracle.laws import oracle

AT = cf.Resolution(2, 10, 9)
CUES = [kim_cue(), pool_cue(), hollow_cue(), SHAFT]
# Phases may differ where they last no longer than this part of the contact: what rounding makes of a zero, or, on
# leather, a last slip whose forces are within what friction may pass its bound by.
SHORT, SHORT_ON_LEATHER = 1e-6, 1e-3


def bent(shift: float) -> cf.Effect:
    """A lever that changes with the contact's angle."""

    class Bent(TipEffect):
        def add_to_contact(self, terms: ContactTerms) -> None:
            terms.add_lever(lambda phi: (shift * math.cos(phi), -shift * math.sin(2 * phi)))

    return Bent()


def effects_of(kind: str, rng: Any) -> tuple[cf.Effect, ...]:
    dome, soft = cf.TipDome(float(rng.uniform(5e-3, 12e-3))), cf.PowerLawTip(float(rng.choice([1.25, 1.5, 2.0])))
    shear = cf.TipShear(float(np.exp(rng.uniform(-1.5, 1.5))))
    leather = replace(LEATHER, E=float(rng.uniform(1.2e8, 3e8)), dome_radius=float(rng.uniform(8e-3, 14e-3)))
    raised = cf.Elevation(float(rng.uniform(0, 0.9)), float(rng.choice([0.0, 0.1, 0.2, 0.5])))
    rolls, thrust, twice = cf.RollingContact(), cf.GeometricStiffness(), cf.SecondHit(5e-3)
    kinds: dict[str, Callable[[], tuple[cf.Effect, ...]]] = {
        "damped": lambda: (cf.AxialWaves(), cf.StructuralDamping(float(rng.uniform(0.005, 0.03))), dome),
        "shear": lambda: (shear, dome),
        "dead shear": lambda: (shear,),
        "second hit": lambda: (twice, dome),
        "power": lambda: (soft,),
        "power shear": lambda: (soft, shear),
        "second power hit": lambda: (twice, soft),
        "rolling": lambda: (rolls, dome),
        "rolling power": lambda: (rolls, soft, dome, cf.StructuralDamping(0.02)),
        "levers": lambda: (rolls, bent(float(rng.uniform(-3e-3, 3e-3)))),
        "spring": lambda: (replace(leather, shear=float(np.exp(rng.uniform(11.5, 16.0)))),),
        "spring twice": lambda: (replace(leather, shear=float(np.exp(rng.uniform(11.5, 16.0)))), twice),
        "rings": lambda: (replace(leather, rolls=bool(rng.random() < 0.5)),),
        "rings twice": lambda: (leather, twice),
        "rings that lose": lambda: (replace(leather, surface_restitution=float(rng.uniform(0.6, 1.0))),),
        "raised": lambda: (raised, dome),
        "raised power": lambda: (raised, soft),
        "thrust": lambda: (thrust, dome),
        "thrust with all": lambda: (thrust, cf.AxialWaves(), cf.StructuralDamping(0.01), rolls, shear),
        "thrust on rings": lambda: (thrust, leather),
        "thrust twice": lambda: (thrust, twice, dome),
        "thrust raised": lambda: (thrust, raised, dome),
    }
    return kinds[kind]() if kind in kinds else () if kind in ("linear", "lumped") else (dome,)


# What a kind may differ by, in units of what it is compared with. A nonlinear law is stepped to 1e-11 of the blow at
# each step, leather to 1e-10, whose friction may pass its bound by 20 times that for a step. What rings bear is a sum
# over the path from node to node: through other nodes the ball moves by 1e-6 and leaves by 1e-5 otherwise.
WITHIN = {
    **dict.fromkeys(("linear", "lumped", "dome", "dead", "endless", "damped", "shear", "second hit"), 1e-12),
    **dict.fromkeys(("dead shear", "power", "power shear", "rolling", "rolling power", "levers"), 1e-10),
    "second power hit": 3e-10,
    **dict.fromkeys(("raised", "raised power"), 2e-9),
    "spring": 3e-9,
    "spring twice": 1e-8,  # the flight between the touches makes more of a difference
    **dict.fromkeys(("rings", "rings twice", "rings that lose", "thrust on rings"), 3e-5),
    **dict.fromkeys(("thrust", "thrust with all", "thrust twice"), 1e-10),
    "thrust raised": 1e-6,
}


def random_scene(kind: str, seed: int) -> cf.Scene:
    rng = np.random.default_rng([seed, *kind.encode()])
    leather = bool({"spring", "rings"} & set(kind.split()))
    tip: dict[str, float] = {
        "restitution": 0.0 if kind.startswith("dead") else float(rng.uniform(0.5 if leather else 0.3, 1.0)),
        "friction": math.inf if kind == "endless" else float(rng.choice([0.1, 0.3, 0.6, 0.8, 1.5])),
    }
    if not leather:
        tip["contact_time"] = float(np.exp(rng.uniform(np.log(3e-4), np.log(3e-3))))
    speed = float(np.exp(rng.uniform(np.log(0.5), np.log(3.0 if leather else 10.0))))
    stroke = cf.Stroke(speed, float(rng.choice([-1, 1]) * rng.uniform(0.01, 0.65 if leather else 0.8)))
    cue: Any = CUES[rng.integers(len(CUES))]
    if leather:
        cue = SHAFT
    if kind == "lumped":
        cue = cf.LumpedCue(0.54, float(np.exp(rng.uniform(np.log(1e-3), np.log(0.1)))))
    ball = cf.Ball(float(rng.uniform(0.12, 0.24)), 0.028575)
    return cf.Scene(cue, ball, cf.Tip(**tip), stroke, effects_of(kind, rng))


def differences(scene: cf.Scene) -> tuple[dict[str, float], Any, Contact]:
    at = None if scene.lumped is not None else AT
    outcome = cf.strike(scene, at)
    model = model_of(scene, tip_modes_of(scene, at))
    mine = oracle(model)
    side, speed, R = math.copysign(1.0, scene.stroke.offset), scene.stroke.speed, scene.ball.radius
    initial, losses = outcome.energy["initial"], mine.losses
    names = {"friction loss": "friction", "tip shear": "shear", "table loss": "table", "damping loss": "damping"}
    off = {
        "duration": (outcome.duration - mine.time) / model.time,
        "tip loss": (outcome.energy["tip loss"] - model.law.loss(mine.deepest)) / initial,
    }
    off |= {name: (outcome.energy[name] - losses[of]) / initial for name, of in names.items() if name in outcome.energy}
    impulse = np.array(mine.impulse_on_ball) * (side, 1.0)
    off["ball"] = abs(outcome.impulse - impulse).max() / (scene.ball.mass * speed)
    off["spin"] = (outcome.spin - side * mine.twist / R) * R / speed
    return {name: abs(float(value)) for name, value in off.items()}, outcome, mine


def course(phases: Any, shortest: float, *, pressed: bool) -> list[tuple[str, ...]]:
    """The phases that last, by name; pressed: of how the tip is pressed alone."""
    names = [p[1:2] if pressed else tuple(p[:2]) for p in phases if p[0] == "blow" or p[3] - p[2] > shortest]
    return [name for name, _ in groupby(names)]


def agree(kind: str, seed: int) -> None:
    off, outcome, mine = differences(random_scene(kind, seed))
    assert max(off.values()) < WITHIN[kind], (seed, off)
    shortest = mine.time * (SHORT_ON_LEATHER if kind.startswith("spring") else SHORT)
    found, expected = (
        course(phases, shortest, pressed="rings" in kind.split()) for phases in (outcome.phases, mine.phases)
    )
    assert found == expected, seed


KINDS = [kind for kind in WITHIN if kind != "thrust raised"]  # of which the plain method takes minutes for a dozen
DAILY = [pytest.param(kind, [0], marks=[pytest.mark.heavy] * (kind == "thrust on rings")) for kind in KINDS]
MANY = [
    pytest.param(kind, range(1, 12 if kind.startswith(("rings", "thrust")) else 42), marks=pytest.mark.heavy)
    for kind in KINDS
]


@pytest.mark.parametrize(("kind", "seeds"), [*DAILY, *MANY])
def test_a_strike_is_what_the_plain_method_says(kind: str, seeds: Iterable[int]) -> None:
    for seed in seeds:
        agree(kind, seed)


@pytest.mark.heavy
def test_raised_strikes_with_thrust_are_what_the_plain_method_says(monkeypatch: pytest.MonkeyPatch) -> None:
    """With four rows of slopes in each plane."""
    monkeypatch.setattr(bent_cue, "MOST", 3)
    for seed in range(2):
        agree("thrust raised", seed)


STRIKERS: list[Callable[[Any], cf.Striker]] = [
    lambda rng: cf.Striker(float(rng.uniform(0.005, 0.1)), float(rng.uniform(0.3, 1.0)), contact_time=1e-3),
    lambda rng: cf.Striker(float(rng.uniform(0.005, 0.1)), 0.0, stiffness=float(rng.uniform(5e4, 1e6))),
    lambda rng: cf.Striker(0.028, float(rng.uniform(0.5, 1.0)), modulus=float(rng.uniform(1e9, 12e9)), radius=9.5e-3),
]


def agrees_from_the_side(seed: int) -> None:
    rng = np.random.default_rng(seed)
    cue, striker = CUES[rng.integers(len(CUES))], STRIKERS[seed % 3](rng)
    effects: tuple[cf.Effect, ...] = (cf.StructuralDamping(0.01),) if seed % 2 else ()
    if striker.restitution:
        effects = (*effects, cf.SecondHit(3e-3))
    scene = cf.SideStrike(cue, striker, float(rng.uniform(0, cue.length)), float(rng.uniform(0.5, 5)), effects)
    outcome = cf.side_strike(scene, AT)
    model = solved_side(scene, AT).model
    mine = oracle(model)
    off = {
        "rebound": outcome.rebound_speed / scene.speed - mine.ball[1] / scene.speed,
        "duration": (outcome.duration - mine.time) / model.time,
        "loss": (outcome.energy["contact loss"] - model.law.loss(mine.deepest)) / outcome.energy["initial"],
        "damping": (outcome.energy.get("damping loss", 0.0) - mine.losses["damping"]) / outcome.energy["initial"],
    }
    assert max(map(abs, off.values())) < (3e-10 if striker.modulus else 1e-12), (seed, off)
    shortest = SHORT * mine.time
    assert course(outcome.phases, shortest, pressed=True) == course(mine.phases, shortest, pressed=True), seed


@pytest.mark.parametrize("seeds", [range(3), pytest.param(range(3, 43), marks=pytest.mark.heavy)])
def test_a_strike_from_the_side_is_what_the_plain_method_says(seeds: Iterable[int]) -> None:
    for seed in seeds:
        agrees_from_the_side(seed)
