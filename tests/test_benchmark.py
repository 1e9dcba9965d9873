"""Benchmarks of the calls that everything else repeats: how long one warm call takes, on one thread.

The ordinary run only checks the answers. Numbers are printed by

    OMP_NUM_THREADS=1 OPENBLAS_NUM_THREADS=1 python -m pytest -n 0 --benchmark-enable tests/test_benchmark.py

(one thread: small dense solves on two may spike a hundredfold on a busy machine). No test asserts a time.
"""

from __future__ import annotations

from collections.abc import Callable
from statistics import median
from time import process_time
from typing import Any

import numpy as np
import pytest
from cuefem.contact.linear import Exact
from cuefem.contact.phases import run
from cuefem.contact.state import Contact, Laws

from cuefem import Cue, Resolution, end_mass, modes, resolve, strike
from cuefem.beam.modes import solve
from cuefem.beam.system import assemble
from cuefem.beam.tip import tip_modes
from cuefem.contact.strike import strike_modes
from cuefem.endmass.drives import stick
from cuefem.tip_modes import Solved, tip_modes_of
from tests.helpers.cues import kim, pool, scene
from tests.helpers.strike_scenes import KIM_AT, kim_scene


def test_modes_of_kim(benchmark: Any) -> None:
    """One warm `modes` call, f1 to f5 to 1e-6 (they hold to 1e-9)."""
    cue = kim()
    fine = modes(cue, 5, at=Resolution(4, 16, 5)).frequencies
    found = benchmark(modes, cue, 5)
    np.testing.assert_allclose(found.frequencies, fine, rtol=1e-6)


def test_modes_near(benchmark: Any) -> None:
    cue = kim()
    lowest = modes(cue, 3).frequencies
    found = benchmark(lambda: modes(cue, 2, near=250.0))
    np.testing.assert_allclose(found.frequencies, lowest[:2], rtol=1e-6)


@pytest.mark.parametrize("cue", [kim(), pool()], ids=["kim", "pool"])
def test_stick_end_mass(benchmark: Any, cue: Cue) -> None:
    """`end_mass` at the resolution left out, the beam included."""
    found = benchmark(end_mass, scene(cue, 2e-3))
    np.testing.assert_allclose(found, end_mass(scene(cue, 2e-3), at=Resolution(4, 16, 100)), rtol=0.02)


def test_stick_end_mass_from_tip_modes(benchmark: Any) -> None:
    """The closed form alone, its eigenproblem of the modes kept included."""
    found = scene(kim(), 2e-3)
    tip = Solved(found).tip_stuck
    np.testing.assert_allclose(benchmark(stick, tip, found), end_mass(found), rtol=1e-12)


def test_the_contact_alone(benchmark: Any) -> None:
    """A strike of 22 modes that are known."""
    struck = kim_scene()
    tip = tip_modes_of(struck, KIM_AT)
    assert benchmark(strike_modes, struck, tip).squirt == strike(struck, KIM_AT).squirt


def test_a_strike_from_the_drawing_on(benchmark: Any) -> None:
    struck = kim_scene()
    np.testing.assert_allclose(benchmark(strike, struck).squirt, resolve(struck, 1e-3).squirt, rtol=4e-3)


@pytest.mark.parametrize("rtol", [1e-2, 1e-3])
def test_an_accuracy_asked_for(benchmark: Any, rtol: float) -> None:
    assert benchmark(resolve, kim_scene(), rtol).error <= rtol


def test_a_bare_scene_costs_what_the_strike_costs(request: pytest.FixtureRequest) -> None:
    """`strike` of a scene that lists no effect, beside its parts called by hand: beam, modes and contact, no effects.

    The excess, a few per cent, is checks and the Outcome; with -s and --benchmark-enable it is printed.
    """
    scene = kim_scene()
    tip, speed = scene.tip, 1.0

    def alone() -> Contact:
        cue = scene.cue
        found = solve(assemble(cue, elements=KIM_AT.elements, order=KIM_AT.order), KIM_AT.modes)
        laws = Laws(
            phi=np.arcsin(scene.stroke.offset),
            ball_mass=scene.ball.mass,
            inertia=scene.ball.inertia,
            stiffness=scene.stiffness,
            restitution=tip.restitution,
            friction=tip.friction,
            time=scene.contact_time,
            speed=speed,
        )
        kind = Exact.of(tip_modes(found, cue.mass), laws)
        run(kind)
        return kind.contact

    def seconds(work: Callable[[], Any]) -> float:
        start = process_time()
        work()
        return process_time() - start

    np.testing.assert_allclose(alone().impulse, strike(scene, KIM_AT).impulse, rtol=1e-13)
    rounds = 400 if request.config.getoption("--benchmark-enable") else 1
    pairs = [(seconds(alone), seconds(lambda: strike(scene, KIM_AT))) for _ in range(rounds)]
    own, whole = (median(times) for times in zip(*pairs, strict=True))
    print(f"\nstrike of a bare scene: {whole * 1e3:.2f} ms, its parts by hand {own * 1e3:.2f} ms: {whole / own:.3f}")
