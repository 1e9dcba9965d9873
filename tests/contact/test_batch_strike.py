"""Verification: many strikes at once are the strikes one by one, on any number of threads."""

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
    *(leather_scene(offset, speed=speed) for offset, speed in ((0.0, 1.0), (0.3, 1.0), (0.45, 3.0))),
]


def numbers(outcome: cf.Outcome, i: int) -> dict[str, object]:
    """One strike's entries in the arrays."""
    found = {field.name: getattr(outcome, field.name) for field in fields(outcome)}
    left_out = ("phases", "history", "unknowns", "error", "energy")
    one = {name: value[i] for name, value in found.items() if name not in left_out}
    return one | {f"energy {name}": joules[i] for name, joules in outcome.energy.items()}


@pytest.mark.parametrize("at", [AT, None], ids=["given", "default"])
def test_many_strikes_are_the_strikes_one_by_one(at) -> None:
    scenes = SCENES if at is not None else SCENES[::6]
    together = cf.batch_strike(scenes, at)
    for i, scene in enumerate(scenes):
        alone, found = cf.strike(scene, at), numbers(together, i)
        for name, value in found.items():
            kind, _, part = name.partition(" ")
            wanted = alone.energy.get(part, 0.0) if part else getattr(alone, name)
            if kind in ("regime", "jam"):
                assert value == wanted
            else:
                np.testing.assert_allclose(value, wanted, rtol=1e-10, atol=1e-14)
    assert together.unknowns > 20


LEATHER = [
    *(leather_scene(offset, speed=speed) for offset, speed in ((0.0, 2.0), (0.3, 0.7), (-0.3, 2.0), (0.45, 6.0))),
    replace(leather_scene(0.2), ball=cf.Ball(mass=0.17, radius=0.028575)),
    leather_scene(0.45, cf.SecondHit(0.02)),
    leather_scene(0.4, leather=replace(leather_scene().leather, shear=1e6)),
]


@pytest.mark.parametrize("order", [1, -1])
def test_strikes_that_share_what_a_cue_does_are_the_strikes_one_by_one_to_the_bit(order: int) -> None:
    scenes = LEATHER[::order]
    together = cf.batch_strike(scenes, AT)
    for i, scene in enumerate(scenes):
        alone = cf.strike(scene, AT)
        for name, value in numbers(together, i).items():
            part = name.partition(" ")[2]
            assert np.array_equal(value, alone.energy.get(part, 0.0) if part else getattr(alone, name)), (i, name)


@pytest.mark.parametrize("threads", [2, 5])
def test_threads_change_nothing(threads: int) -> None:
    one, more = cf.batch_strike(SCENES, AT), cf.batch_strike(SCENES, AT, threads=threads)
    for i in range(len(SCENES)):
        for (name, value), other in zip(numbers(one, i).items(), numbers(more, i).values(), strict=True):
            assert np.array_equal(value, other), name


def test_the_modes_of_a_cue_are_solved_once(monkeypatch: pytest.MonkeyPatch) -> None:
    import cuefem.beam.modes as bending

    solve, calls = bending.solve, []
    monkeypatch.setattr(bending, "solve", lambda *args: calls.append(args) or solve(*args))
    cf.batch_strike([*SCENES[:19], *SCENES[19:21]], AT)
    assert len(calls) == 2  # a dome turns the contact: other tail, the modes once more


def test_errors_name_the_scene() -> None:
    with pytest.raises(TypeError, match=r"must be a sequence of Scene; got one Scene: write \[scene\], or cuefem."):
        cf.batch_strike(SCENES[0])  # type: ignore[arg-type]
    with pytest.raises(TypeError, match="batch_strike scenes must be a sequence of Scene; got 3"):
        cf.batch_strike(3)  # type: ignore[arg-type]
    with pytest.raises(ValueError, match="batch_strike takes one scene or more; got none"):
        cf.batch_strike([])
    with pytest.raises(TypeError, match="batch_strike scenes must be a Scene"):
        cf.batch_strike([SCENES[0], 3])
    with pytest.raises(ValueError, match=r"^scene 1: SecondHit takes a Tip.restitution"):
        cf.batch_strike([SCENES[0], replace(kim_scene(0.3, restitution=0.0), effects=(cf.SecondHit(0.01),))], AT)
    with pytest.raises(ValueError, match=r"batch_strike threads must be"):
        cf.batch_strike(SCENES, AT, threads=0)
