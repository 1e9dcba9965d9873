"""A patch that slips ring by ring, against small steps, which have no phases:
across sliding as a whole, with the tip's rim, fast and slow (verification); and squirt over the offset, which has no
jump (property).
"""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from cuefem import LeatherTip, Scene, Tip, strike
from tests.oracle.ring_stepper import LEATHER, stepped, struck_scene

WITHIN = 5e-3
# A jump: squirt changes from one offset to the next by more than so many times what it does at either neighbour, and
# by a ten-thousandth of itself more: a curve whose slope changes by less than this factor within 1e-3 of b/R has none.
BEND = 1.5


def drawn(seed: int) -> Scene:
    """Friction 0.2 to 0.7, b/R 0.1 to 0.7, 0.8 to 7 m/s, restitution 0.5 to 0.9, soft to hard leather."""
    rng = np.random.default_rng([21, seed])
    tip = Tip(float(rng.uniform(0.5, 0.9)), float(rng.uniform(0.2, 0.7)))
    speed, E = float(np.exp(rng.uniform(math.log(0.8), math.log(7.0)))), float(rng.uniform(100e6, 400e6))
    return struck_scene(float(rng.uniform(0.1, 0.7)), speed, replace(LEATHER, E=E), tip=tip)


def off(scene: Scene, step: float = 1e-6) -> float:
    """Relative difference of squirt."""
    return stepped(scene, step) / math.degrees(strike(scene).squirt) - 1


@pytest.mark.parametrize(("friction", "offset"), [(0.3, 0.38), (0.4, 0.5), (0.5, 0.6)])
def test_sliding_as_a_whole_is_what_comes_out(friction: float, offset: float) -> None:
    scene = struck_scene(offset, leather=LEATHER, tip=Tip(0.73, friction))
    assert abs(off(scene, 2e-6)) < WITHIN


@pytest.mark.parametrize(("restitution", "offset"), [(0.95, 0.375), (0.7, 0.2), (0.5, 0.5)])
def test_leather_that_loses_along_its_surface_is_what_comes_out(restitution: float, offset: float) -> None:
    leather = replace(LEATHER, surface_restitution=restitution)
    assert abs(off(struck_scene(offset, leather=leather), 2e-6)) < WITHIN


@pytest.mark.nightly
def test_a_hundred_random_strikes() -> None:
    found = np.array([off(drawn(seed)) for seed in range(100)])
    wrong = np.flatnonzero(np.abs(found) >= WITHIN).tolist()
    print("worst", np.abs(found).max(), "median", np.median(np.abs(found)), "wrong", len(wrong))
    assert not wrong, {seed: float(found[seed]) for seed in wrong}


def jumps(offsets: np.ndarray, squirts: np.ndarray) -> list[float]:
    """Offsets between which squirt changes by far more than on both sides of them."""
    change = np.abs(np.diff(squirts))
    beside = np.maximum(np.r_[change[1:], 0.0], np.r_[0.0, change[:-1]])
    return offsets[:-1][change > BEND * beside + 1e-4 * np.abs(squirts[:-1])].tolist()


@pytest.mark.parametrize(
    ("leather", "friction", "offset"),
    [(LEATHER, 0.3, 0.3746), (LEATHER, 0.7, 0.671), (replace(LEATHER, shear=1e6), 0.7, 0.671)],
)
def test_it_has_none_where_it_once_had(leather: LeatherTip, friction: float, offset: float) -> None:
    """Where the rings began to slide as a whole, and where the contact begins on the tip's rim."""
    offsets = offset + np.arange(-5, 6) * 1e-3
    scenes = (struck_scene(float(b), 2.0, leather, tip=Tip(0.73, friction)) for b in offsets)
    squirts = np.array([strike(scene).squirt for scene in scenes])
    assert jumps(offsets, squirts) == []
