"""Properties: designs that share a cue share what its strikes share, and nothing else."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from cuefem import Stroke
from cuefem.contact.propagator import ModalPropagator
from cuefem.design.evaluation import evaluate
from cuefem.designer.answers import CURVE_OFFSETS, answers, coupled_points
from tests.helpers.leather_scenes import AT, leather_scene

ASKED = ("squirt(0.3)", "squirt", "ball_speed", "vibration_energy(-0.2)")
# the fifth presses its leather deeper than its law is known, the last one has another cue
SCENES = [
    *(leather_scene(offset, speed=speed) for offset, speed in ((0.1, 2.0), (0.3, 0.7), (0.3, 2.0), (-0.4, 5.0))),
    leather_scene(0.1, speed=60.0),
    leather_scene(0.45, speed=3.0),
    leather_scene(0.2, cue=replace(leather_scene().cue, body_mass=0.3)),
]


@pytest.mark.parametrize("order", [1, -1])
def test_designs_of_one_cue_are_to_the_bit_what_each_is_alone(order: int) -> None:
    scenes = SCENES[::order]
    together = evaluate(scenes, ASKED, at=AT)
    for i, scene in enumerate(scenes):
        alone = evaluate([scene], ASKED, at=AT)
        assert np.array_equal(together.values[i], alone.values[0], equal_nan=True)
        assert together.reasons[i] == alone.reasons[0]
    (reason,) = (why for why in together.reasons if why)
    assert "further than its law is known" in reason


@pytest.fixture
def made(monkeypatch: pytest.MonkeyPatch) -> list[object]:
    """The cues whose modes are made ready for the compiled kernel."""
    cues: list[object] = []
    work = ModalPropagator.__init__
    monkeypatch.setattr(ModalPropagator, "__init__", lambda self, *args: cues.append(self) or work(self, *args))
    return cues


def test_what_a_cue_does_is_worked_out_once_for_all_its_designs(made: list[object]) -> None:
    good = [scene for scene in SCENES if scene.stroke.speed < 10]
    evaluate(good, ASKED, at=AT)
    assert len(made) == 2  # two cues


def test_the_curve_of_the_designer_works_it_out_once(made: list[object]) -> None:
    found = answers(replace(leather_scene(), stroke=Stroke(2.0, 0.3)))
    assert len(made) == 1
    points = list(coupled_points(found))
    assert 10 < len(points) <= len(CURVE_OFFSETS)
    assert len(made) == 2  # the first strike's was let go with its spectra; all points share one
    (again,) = [point for point in points if point.offset == pytest.approx(0.3)] or [points[0]]
    alone = answers(replace(found.scene, stroke=Stroke(2.0, again.offset)))
    assert again.squirt == alone.strike["squirt"]
