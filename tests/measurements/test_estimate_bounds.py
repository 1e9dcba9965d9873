"""Estimates near the limits of what a cue can be: slopes are taken inside, so nothing is refused (properties)."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import pytest

from cuefem.io.measured_folder import load_measured
from cuefem.measurements.estimate import estimate
from cuefem.measurements.measured_cue import MeasuredCue, compare
from cuefem.measurements.measurement_types import Stiffness, Tone, Weight
from cuefem.measurements.uncertain_parameters import Prior
from cuefem.scene import Scene
from studies.pages import STUDIES
from tests.helpers.leather_scenes import leather_scene
from tests.helpers.measured_cues import SCENE

CHEAP = (
    Weight(value=0.1, error=5e-4),
    Tone(mode=1, value=95.0, error=0.2),
    Stiffness(free_length=0.2, value=4600.0, error=90.0),
)
FARTHEST = 12.0  # standard deviations of a prior: what has no limit within is not limited


def weighed(mass: float, error: float) -> MeasuredCue:
    """The published Predator Z-2, weighed too."""
    cue = load_measured(STUDIES / "measured" / "predator_z2")[0]
    return replace(cue, measurements=(*cue.measurements, Weight(value=mass, error=error)))


@pytest.mark.heavy
@pytest.mark.parametrize(("mass", "error"), [(0.1025, 1e-4), (0.1025, 3e-4), (0.100, 1e-4), (0.105, 1e-4)])
def test_a_bore_that_comes_near_the_outside(mass: float, error: float) -> None:
    """On its way the search meets bores within a tenth of a standard deviation of the outer diameter."""
    cue = weighed(mass, error)
    found = estimate(cue)
    bore = next(value for value in found.values if value.name == "bore width")
    assert found.converged
    assert bore.value < cue.scene.shaft.segments[0].tip_diameter
    assert found.rows[-1].computed == pytest.approx(mass, rel=0.02)
    assert np.isfinite(found.predicted(CHEAP[1])).all()


def limits(cue: MeasuredCue, i: int) -> list[float]:
    """Where the cue stops being possible along an uncertain parameter, in standard deviations of its prior."""
    ends = []
    for side in (-1.0, 1.0):
        inside, outside = 0.0, side * FARTHEST
        unit = np.eye(len(cue.parameters))[i]
        if setup_of(cue, outside * unit):
            continue
        while abs(outside - inside) > 1e-9:
            middle = (inside + outside) / 2
            inside, outside = (middle, outside) if setup_of(cue, middle * unit) else (inside, middle)
        ends.append(inside)
    return ends


def setup_of(cue: MeasuredCue, z: np.ndarray) -> bool:
    """Whether there can be such a cue."""
    try:
        return bool(cue.setup(z))
    except ValueError:
        return False


@pytest.mark.parametrize("name", ["E", pytest.param("bore width", marks=pytest.mark.heavy), "taper"])
def test_an_unknown_at_its_limits(name: str) -> None:
    at_limits(MeasuredCue("a cue", SCENE, CHEAP, (Prior("taper", 0.1),)), [name])


@pytest.mark.heavy
@pytest.mark.parametrize("scene", [SCENE, leather_scene()], ids=["plain tip", "leather tip"])
def test_every_unknown_at_its_limits(scene: Scene) -> None:
    cue = MeasuredCue("a cue", scene, CHEAP, (Prior("taper", 0.1),))
    assert at_limits(cue, [parameter.name for parameter in cue.parameters]) >= 3


def at_limits(cue: MeasuredCue, names: Sequence[str]) -> int:
    """Drawings at the limit of what can be, or a little inside, are compared and estimated like others."""
    met = 0
    for i, parameter in enumerate(cue.parameters):
        for end in limits(cue, i) if parameter.name in names else ():
            for inside in (0.0, 0.3):
                there = end - np.sign(end) * inside
                near = replace(cue, scene=parameter.setup(cue.setup(), float(there)).scene)
                assert np.isfinite([row.spread for row in compare(near)]).all()
                met += 1
            assert np.isfinite(estimate(near).covariance).all()
    return met
