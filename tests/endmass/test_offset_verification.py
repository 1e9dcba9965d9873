"""The impulse solver with the end mass of the offset against the coupled strike, over contact times (verification)."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import cuefem as cf
from cuefem.contact.strike import strike_modes
from cuefem.endmass.definitions import stick, stick_at_offset
from cuefem.scene.solved_scene import Solved

MESHES = Path(__file__).parents[2] / "meshes"


def errors(name: str, times: np.ndarray, offset: float) -> np.ndarray:
    """Squirt of the impulse solver over the coupled strike's, minus 1: with the end mass of the offset, of stick."""
    cue = cf.load(MESHES / f"{name}.toml")
    assert isinstance(cue, cf.Cue)
    found = []
    for time in times:
        scene = cf.Scene(cue, tip=cf.Tip(contact_time=float(time)), stroke=cf.Stroke(1.0, offset))
        solved = Solved(scene)
        masses = (stick_at_offset(solved.tip_stuck, scene), stick(solved.tip_stuck, scene))
        lumped = [replace(scene, cue=cf.LumpedCue(cue.mass, mass)) for mass in masses]
        found.append([cf.impulse(one).squirt / strike_modes(scene, solved.tip).squirt - 1 for one in lumped])
    return np.abs(found).T


def test_impulse_squirt_kim_cue_within_1_percent_of_strike() -> None:
    own, small = errors("kim", np.array([1e-3]), 0.3)
    assert 0.005 < own[0] < 0.012
    assert 0.08 < small[0] < 0.11
    scene = cf.Scene(cf.load(MESHES / "kim.toml"), tip=cf.Tip(contact_time=1e-3), stroke=cf.Stroke(1.0, 0.3))
    assert abs(cf.impulse(scene).squirt / cf.strike(scene).squirt - 1) == pytest.approx(own[0], rel=1e-6)
