"""Motion of a strike against the relative velocities of its history (verification)."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

import cuefem as cf
from cuefem.contact.motion_history import Motion, motion
from tests.helpers.strike_scenes import KIM

SCENE = cf.Scene(KIM, cf.Ball(0.17, 0.028575), cf.Tip(0.75, 0.7, 1e-3), cf.Stroke(2.0, 0.3))
AT = cf.Resolution(2, 12, 8, 1600)
EFFECTS: dict[str, tuple[Any, ...]] = {
    "bare": (),
    "shear": (cf.TipShear(1.5),),
    "support": (cf.Support(0.25, stiffness=1e4, dashpot=5.0),),
    "damping": (cf.StructuralDamping(),),
    "second hit": (cf.SecondHit(4e-3),),
    "thrust": (cf.GeometricStiffness(),),
    "power law, second hit, dome": (cf.PowerLawTip(1.5, 2.0), cf.SecondHit(4e-3), cf.TipDome(0.0095)),
}


def sliding_path(result: Motion, scene: cf.Scene) -> Any:
    """Displacement of the ball's contact point relative to the cue's, along (t, n), from positions alone."""
    phi, (w, theta) = np.arcsin(scene.stroke.offset), result.deflection(np.array(0.0))
    t, n = np.array([np.sin(phi), np.cos(phi)]), np.array([np.cos(phi), -np.sin(phi)])
    r = sum(effect.radius for effect in scene.effects if isinstance(effect, cf.TipDome))
    # where the dome touches, r (n - e_u) from the tip, and the ball, -R n from its centre: both turn about u x w
    on_cue = np.column_stack([result.axial, w]) + np.outer(-theta, r * np.array([-n[1], n[0] - 1]))
    ball = result.centre - result.centre[0]
    turning = np.outer(result.rotation, -scene.ball.radius * np.array([-n[1], n[0]]))
    return (ball + turning - on_cue) @ np.array([t, n]).T


@pytest.mark.parametrize("offset", [0.3, -0.4])
@pytest.mark.parametrize("name", EFFECTS)
def test_motion_relative_velocity_equals_history(name: str, offset: float) -> None:
    """The relative displacement is the integral of the velocity, within the error of the trapezoidal rule."""
    scene = replace(SCENE, stroke=replace(SCENE.stroke, offset=offset), effects=EFFECTS[name])
    outcome = cf.strike(scene, AT)
    times = outcome.history.ends[: int(0.8 * len(outcome.history.ends))]
    history, end = outcome.history(times), times[-1]
    expected = [np.trapezoid(history["velocity_t"], times), np.trapezoid(history["velocity_n"], times)]
    result = motion(scene, [0.0, end], AT)
    np.testing.assert_allclose(sliding_path(result, scene)[1], expected, rtol=0, atol=1e-5 * SCENE.stroke.speed * end)
    assert result.duration == outcome.phases[-1].end


def test_motion_is_continuous_at_separation() -> None:
    end = cf.strike(SCENE, AT).phases[-1].end
    result = motion(SCENE, [end - 1e-9, end + 1e-9], AT)
    moved = np.array([np.diff(result.axial), np.diff(result.deflection(np.array(0.0))[0])])
    assert np.abs(moved).max() < 2e-9 * 2 * SCENE.stroke.speed
