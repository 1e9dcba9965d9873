"""Verification: many strikes at once are the strikes one by one, to the bit, on any number of threads."""

from __future__ import annotations

from dataclasses import fields, replace

import numpy as np
import pytest

import cuefem as cf
from tests.helpers.leather_scenes import AT, leather_scene
from tests.helpers.strike_scenes import kim_scene

SCENES = [
    *(kim_scene(offset) for offset in np.linspace(-0.5, 0.6, 19)),
    *(replace(kim_scene(offset), effects=(cf.TipShear(0.75), cf.TipDome(0.0095))) for offset in (0.2, 0.4)),
    replace(kim_scene(0.3), effects=(cf.StructuralDamping(0.02), cf.PointMass(0.1, 0.01))),
    replace(kim_scene(0.7), cue=cf.LumpedCue(0.54, 0.01)),
    *(leather_scene(offset, speed=speed) for offset, speed in ((0.0, 1.0), (0.3, 1.0), (-0.3, 2.0), (0.45, 6.0))),
    replace(leather_scene(0.2), ball=cf.Ball(mass=0.17, radius=0.028575)),
    leather_scene(0.45, cf.SecondHit(0.02)),
    leather_scene(0.4, leather=replace(leather_scene().leather, shear=1e6)),
]
LEFT_OUT = ("phases", "history", "unknowns", "error", "energy")


def numbers(outcome: cf.Outcome) -> dict[str, object]:
    """What a strike says, and its energies, by name."""
    named = {field.name: getattr(outcome, field.name) for field in fields(outcome)} | outcome.energy
    return {name: value for name, value in named.items() if name not in LEFT_OUT}


@pytest.mark.parametrize(
    ("scenes", "at"), [(SCENES, AT), (SCENES[::-1], AT), (SCENES[:22:6], None)], ids=["given", "backwards", "default"]
)
def test_many_strikes_are_the_strikes_one_by_one(scenes: list[cf.Scene], at: cf.Resolution | None) -> None:
    """So are strikes that share what a cue does, in any order."""
    together = cf.batch_strike(scenes, at)
    for i, scene in enumerate(scenes):
        alone = numbers(cf.strike(scene, at))
        for name, values in numbers(together).items():
            assert np.array_equal(values[i], alone.get(name, 0.0)), (i, name)  # type: ignore[index]
    assert together.unknowns > 20


@pytest.mark.parametrize("threads", [2, 5])
def test_threads_change_nothing(threads: int) -> None:
    assert cf.batch_strike(SCENES, AT, threads=threads) == cf.batch_strike(SCENES, AT)
