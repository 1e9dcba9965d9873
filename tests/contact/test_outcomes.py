"""Outcomes: equality, copies, other processes; a batch equals single strikes bit by bit (properties)."""

from __future__ import annotations

import pickle
import resource
import sys
from copy import deepcopy
from dataclasses import fields, replace

import numpy as np
import pytest

import cuefem as cf
from cuefem.contact.strike import strike_modes
from cuefem.scene.solved_scene import tip_modes_of
from tests.helpers.leather_scenes import AT, leather_scene
from tests.helpers.strike_scenes import kim_scene

SCENES = [
    *(kim_scene(offset) for offset in np.linspace(-0.5, 0.6, 19)),
    *(replace(kim_scene(offset), effects=(cf.TipShear(0.75), cf.TipDome(0.0095))) for offset in (0.2, 0.4)),
    replace(kim_scene(0.3), effects=(cf.StructuralDamping(0.02), cf.PointMass(position=0.1, mass=0.01))),
    replace(kim_scene(0.7), cue=cf.LumpedCue(0.54, 0.01)),
    *(leather_scene(offset, speed=speed) for offset, speed in ((0.0, 1.0), (0.3, 1.0), (-0.3, 2.0), (0.45, 6.0))),
    replace(leather_scene(0.2), ball=cf.Ball(mass=0.17, radius=0.028575)),
    leather_scene(0.45, cf.SecondHit(0.02)),
    leather_scene(0.4),
    replace(kim_scene(0.3), effects=(cf.Elevation(0.1),)),
]
EXCLUDED = ("phases", "history", "unknowns", "error", "energy")


def numbers(outcome: cf.Outcome) -> dict[str, object]:
    """Numbers of an outcome, and its energies, by name."""
    named = {field.name: getattr(outcome, field.name) for field in fields(outcome)} | outcome.energy
    return {name: value for name, value in named.items() if name not in EXCLUDED}


@pytest.mark.parametrize(("scenes", "at"), [(SCENES[::-1], AT), (SCENES[:22:6], None)], ids=["reverse", "default"])
def test_batch_strike_equals_single_strikes(scenes: list[cf.Scene], at: cf.Resolution | None) -> None:
    """Also for scenes that share a cue, in any order."""
    together = cf.batch_strike(scenes, at)
    for i, scene in enumerate(scenes):
        alone = numbers(cf.strike(scene, at))
        for name, values in numbers(together).items():
            assert np.array_equal(values[i], alone.get(name, 0.0)), (i, name)
        assert numbers(together[i]).items() >= {"squirt": alone["squirt"], "regime": alone["regime"]}.items()
    assert len(together) == len(scenes) == len(together.to_frame())
    assert together.unknowns > 20


@pytest.mark.parametrize(("offset", "window"), [(0.1, 1e-3), (0.1, 2e-2), (0.4, 0.15)])
def test_second_hit_that_does_not_occur_changes_nothing(offset: float, window: float) -> None:
    """On a bent shaft too: its slopes belong to the contact, and the cue turns by 0.3 rad in 0.15 s of free flight."""
    scene, at = leather_scene(offset, cf.GeometricStiffness(), speed=7.0), cf.Resolution(2, 12, 24)
    assert cf.strike(replace(scene, effects=(*scene.effects, cf.SecondHit(window))), at) == cf.strike(scene, at)


@pytest.mark.parametrize(("offset", "friction"), [(0.3, 0.345), (0.3, 0.348), (0.6, 0.768), (0.6, 0.77), (0.9, 3.0)])
def test_jam_is_a_slip_that_hastens_the_approach(offset: float, friction: float) -> None:
    scene = kim_scene(offset)
    outcome = cf.strike(replace(scene, tip=replace(scene.tip, friction=friction)), AT)
    first, second = -outcome.history(outcome.history.ends[:2])["velocity_n"]
    assert outcome.phases[0].state == "slip"
    assert outcome.jam == (second > first)


STRIKER = cf.Striker(mass=0.02, restitution=0.8, contact_time=1e-3)


def test_results_copy_pickle_and_compare() -> None:
    """Results of every kind are equal after a way to another process, and another where one part is another."""
    cue, outcome = kim_scene().cue, cf.strike(SCENES[0], AT)
    moved = cf.motion(kim_scene(0.3), [0.0, 1e-3], AT)
    results = (
        *(outcome, cf.batch_strike(SCENES[:3], AT), moved, cf.modes(cue, 3), cf.modes(cue, 3, near=600.0)),
        cf.side_strike(cf.SideStrike(cue, STRIKER, effects=(cf.SecondHit(),))),
        cf.BallMotion(np.array([0.0, 1.0, 0.0]), np.array([0.0, 0.0, 30.0])),
    )
    for result in results:
        assert deepcopy(result) == pickle.loads(pickle.dumps(result)) == result
    for part in fields(outcome):
        if getattr(outcome, part.name) is not None:
            assert replace(outcome, **{part.name: None}) != outcome != replace(outcome, **{part.name: (1.0,)})
    assert outcome != replace(outcome, squirt=np.nextafter(outcome.squirt, 1)) != outcome.squirt
    assert cf.modes(cue, 3) == cf.modes(cue, 3) != cf.modes(cue, 4)
    assert moved != cf.motion(kim_scene(0.31), [0.0, 1e-3], AT)
    assert np.array_equal(pickle.loads(pickle.dumps(cf.modes(cue, 3))).shape(0.1), cf.modes(cue, 3).shape(0.1))


@pytest.mark.nightly
def test_strike_repeated_does_not_leak_memory() -> None:
    """The maximum memory of the process grows by less than 4 MB over 8,900 rounds."""
    bare, few = kim_scene(0.3), cf.Resolution(2, 8, 4)
    scenes = [leather_scene(0.3, cf.SecondHit(5e-3)), bare, replace(bare, effects=(cf.TipShear(0.75),))]
    cues = [(scene, tip_modes_of(scene, few)) for scene in scenes]

    def memory_after(times: int) -> int:
        for i in range(times):
            for scene, tip in cues[i % 5 > 0 :]:
                strike_modes(scene, tip)
            if i % 50 == 0:  # new cues, too
                cf.strike(replace(bare, effects=(cf.Elevation(0.1),)), few)
        return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * (1 if sys.platform == "darwin" else 1024)

    assert -memory_after(100) + memory_after(9_000) < 4e6
