"""Outcomes are values: they can be pickled, copied, compared and sent between processes, whatever acts in the scene."""

from __future__ import annotations

import pickle
import resource
import sys
from concurrent.futures import ProcessPoolExecutor
from copy import deepcopy
from dataclasses import replace
from multiprocessing import get_context

import numpy as np
import pytest

import cuefem as cf
from cuefem.contact.outcome import hits
from cuefem.contact.strike import strike_modes
from cuefem.tip_modes import tip_modes_of
from tests.helpers.leather_scenes import AT, LEATHER, leather_scene
from tests.helpers.strike_scenes import kim_scene

EFFECTS: list[tuple[cf.Effect, ...]] = [
    (),
    (cf.PointMass(0.1, 0.01),),
    (cf.Support(0.2, 5e3, 1.0, 20.0),),
    (cf.Joint(0.3, 1e-4, 1e-8),),
    (cf.StructuralDamping(0.02),),
    (cf.AxialWaves(),),
    (cf.TipShear(0.75),),
    (cf.TipDome(0.0095),),
    (cf.PowerLawTip(1.5),),
    (cf.RollingContact(),),
    (cf.SecondHit(),),
    (cf.Elevation(0.1),),
    (LEATHER,),
    (replace(LEATHER, surface_restitution=0.9),),
]
STRUCK = pytest.mark.parametrize(
    "effects", EFFECTS, ids=lambda effects: effects[0].__class__.__name__ if effects else ""
)


def struck(effects: tuple[cf.Effect, ...]) -> cf.Outcome:
    scene = leather_scene(0.3) if LEATHER.__class__ in map(type, effects) else kim_scene(0.3)
    return cf.strike(replace(scene, effects=effects), AT)


@STRUCK
def test_an_outcome_is_a_value(effects: tuple[cf.Effect, ...]) -> None:
    outcome = struck(effects)
    times = np.linspace(0, outcome.duration, 7)
    for other in (pickle.loads(pickle.dumps(outcome)), deepcopy(outcome), struck(effects)):
        assert other == outcome
        assert hits(other) == hits(outcome)
        assert all(np.array_equal(other.history(times)[name], force) for name, force in outcome.history(times).items())
    assert outcome != replace(outcome, squirt=np.nextafter(outcome.squirt, 1))
    assert outcome != replace(outcome, history=None)
    assert outcome != outcome.squirt
    history = replace(outcome.history, values=outcome.history.values * (1 + 1e-15))
    assert outcome != replace(outcome, history=history)


@STRUCK
def test_an_effect_that_is_listed_gives_another_outcome(effects: tuple[cf.Effect, ...]) -> None:
    assert (struck(effects) == struck(())) == (effects in ((), (cf.SecondHit(),)))


def test_outcomes_of_many_strikes_are_values() -> None:
    scenes = [kim_scene(offset) for offset in (0.1, 0.2, 0.3)]
    outcome = cf.batch_strike(scenes, AT)
    assert deepcopy(outcome) == pickle.loads(pickle.dumps(outcome)) == outcome == cf.batch_strike(scenes, AT)
    assert outcome != cf.batch_strike(scenes[:2], AT)
    striker = cf.Striker(mass=0.02, restitution=0.8, contact_time=1e-3)
    side = cf.side_strike(cf.SideStrike(kim_scene().cue, striker, effects=(cf.SecondHit(),)))
    assert deepcopy(side) == pickle.loads(pickle.dumps(side)) == side


def test_outcomes_come_back_from_other_processes() -> None:
    with ProcessPoolExecutor(1, mp_context=get_context("spawn")) as executor:
        for effects, outcome in zip(EFFECTS, executor.map(struck, EFFECTS), strict=True):
            assert outcome == struck(effects)


def grown(strikes: int) -> int:
    """By how many bytes the greatest memory of this process grows over so many strikes, recorded or not.

    One in eleven has leather, which takes ten times as long.
    """
    bare, few = kim_scene(0.3), cf.Resolution(2, 8, 4)
    scenes = [leather_scene(0.3, cf.SecondHit(5e-3)), bare, replace(bare, effects=(cf.TipShear(0.75),))]
    cues = [(scene, tip_modes_of(scene, few)) for scene in scenes]

    def strike(times: int) -> None:
        for i in range(times):
            for scene, tip in cues[i % 5 > 0 :]:
                strike_modes(scene, tip, recorded=i % 2 == 0)
            if i % 50 == 0:  # new cues, too
                cf.strike(replace(bare, effects=(cf.Elevation(0.1),)), few)

    strike(100)
    before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    strike(round(strikes / 2.2))
    return (resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before) * (1 if sys.platform == "darwin" else 1024)


def test_strikes_leave_no_memory_behind() -> None:
    assert grown(2_000) < 4e6


@pytest.mark.heavy
def test_a_hundred_thousand_strikes_leave_no_memory_behind() -> None:
    assert grown(100_000) < 4e6
