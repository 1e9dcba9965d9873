"""End masses with a dashpot on the cue, against small steps of scikit-fem's beam (verification)."""

from __future__ import annotations

import math

import numpy as np
import pytest
import scipy.linalg as la

from cuefem import Cue, Material, Resolution, Scene, Segment, Stroke, Support, Tip, end_mass
from tests.oracle.bending import bending

WOOD = Material(12.6e9, 0.84e9, 700.0)
SHAFT = Cue((Segment(0.7, 0.0125, 0.021, WOOD, kappa=0.9),), body_mass=0.42)
MODES = 12
AT = Resolution(3, 14, MODES)


def stepped_end_mass(scene: Scene, steps: int) -> float:
    """Sum of impulses, each at the middle of a step, after which the tip has the velocity (1 - cos(pi t/T))/2."""
    modes = bending(SHAFT, scene.cue_effects, MODES + 2)
    n, T = len(modes.omega), float(scene.contact_time)
    A = np.block([[np.zeros((n, n)), np.eye(n)], [-np.diag(modes.omega**2), -modes.damping]])
    half = la.expm(A * T / steps / 2)
    drive = np.concatenate([np.zeros(n), modes.deflection])
    sensor = drive @ half
    z, total = np.zeros(2 * n), 0.0
    for i in range(steps):
        z = half @ z
        impulse = ((1 - math.cos(math.pi * (i + 1) / steps)) / 2 - sensor @ z) / (sensor @ drive)
        total += float(impulse)
        z = half @ (z + drive * impulse)
    return total


@pytest.mark.parametrize(("contact_time", "dashpot"), [(0.5e-3, 5.0), (1e-3, 20.0), (2e-3, 60.0)])
def test_velocity_end_mass_equals_small_steps(contact_time: float, dashpot: float) -> None:
    hand = Support(0.1, 2e3, 0.0, dashpot)
    scene = Scene(SHAFT, tip=Tip(contact_time=contact_time), stroke=Stroke(1.0, 0.3), effects=(hand,))
    expected = end_mass(scene, "velocity", AT)
    assert stepped_end_mass(scene, 8000) == pytest.approx(expected, rel=1e-5)
